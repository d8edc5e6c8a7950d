"""The fewest spans with which one spline of variant 2 follows a stretch of outline.

A first guess comes from the density of vertices that the curvature asks for. Spans that stay too far off are cut in
two, vertices that seem unnecessary are taken out, and after every change the vertices move to where they serve best:
see :mod:`.vertex_steps`. What decides is here, in Python; what computes is compiled.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import inf
from typing import NamedTuple, TypeAlias

from ...types import FloatArray
from ..first_good import first_good
from ..ladders import STARTS
from .corners import Joints
from .cubics import fit_cubic
from .feet import Samples, places_beside
from .pieces import Piece
from .settings import SharpSettings
from .spline_curve import FREE, numbers_for, set_tips, tried_in
from .vertex_steps import move_vertices
from .vertices import cheap_removals, insert_vertices, place_vertices, samples_between, without

PATIENCE = 12
"""Insertions after a first guess from which on all spans that miss the tolerance are cut.

On long stretches of fine detail very many miss it by little, and would get two or three vertices at a time. It saves 13
of 35,142 segments.
"""

LONG = 8
"""Spans of a single outline's curve beyond which vertices are added twice as fast: each try of a long one takes long,
and removals come later. Without it 60 glyphs of a brush face take a tenth more time, and have 92 of 6,991 segments
more."""

SLOW = 3
"""Curves in a row, each with more vertices, that are hardly nearer than the best before, after which a guess is given
up."""

MOST = 1000
"""Spans of one spline at most: what needs more stays as the source has it."""


Vertices: TypeAlias = tuple[int, FloatArray]
"""How many spans a curve has, and its numbers with the vertices set: see :func:`.spline_curve.tried_in`."""


class TriedCurve(NamedTuple):
    """A curve of k spans whose vertices have moved.

    Attributes:
        spans: k. numbers: see :func:`.spline_curve.tried_in`. error: the largest distance of a sample.
    """

    spans: int
    numbers: FloatArray
    error: float


def fit_spline(
    joints: Joints, piece: Piece, near: float, settings: SharpSettings, given: bool, most: int = MOST
) -> Piece:  # fmt: skip
    """One spline, of as few spans as the search finds, in the place of a piece; with an infinite error there is none.

    Args:
        near: how near all samples have to be. given: begin from the piece's own vertices and tangents.
        most: spans. With a limit of its own the search begins there: what that many do not follow, few would.
    """
    k, closed, limited = piece.spans, piece.closed, most < MOST
    missed, begun = piece.error if k == 1 else inf, k if given else 0
    samples = samples_between(joints[:], *piece.joints, closed)
    alone, most = len(samples.Q) == 1, min(most, len(samples.places) - 1)
    if begun == 1 and alone:
        free, tangents = (bool(samples.free[0] == FREE), bool(samples.free[1] == FREE)), piece.tangents.copy()
        missed = fit_cubic(samples.Q[0], samples.directions[0], free, near, settings.cubic_rounds, tangents[0])
        if missed <= near:
            return piece._replace(tangents=tangents, error=missed)
        begun = 0
    wanted = round(settings.guess * min(float(samples.D[-1]), len(samples.places)))
    least = 4 if closed else (2 if alone else 1)
    most = min(2 * max(wanted, 4, begun) + 16, most)
    # A cubic that misses the tolerance by less than this factor is followed by a try with two spans: this saves 483
    # segments with "fast"; without a limit 289 more, for 1.4 times the time.
    guess = most if limited else 2 if not closed and missed < 30.0 * near else max(least, wanted)
    if max(guess, least, begun) > most:
        return piece._replace(error=inf)
    search = Search(samples, closed, near, settings, most)
    first = vertices_of(piece) if begun else None
    starts = STARTS if given or not alone else 1  # a stretch that none follows is cut in two, and its parts begin anew
    best = first_good(search.curves(first, guess, wanted, starts), lambda curve: (int(not curve.error <= near),))
    if not best.error <= near:
        return piece._replace(error=inf)
    found = search.piece(piece, search.thinned(best, max(least, begun)) if best.spans > begun else best)
    if begun and found.spans > begun:  # more were put between old ones than a new guess may take
        other = fit_spline(joints, piece, near, settings, given=False)
        return other if other.error <= near and other.spans < found.spans else found
    return found


def vertices_of(piece: Piece) -> Vertices:
    """The vertices and end handles of a piece that is an arc or a closed curve."""
    numbers = numbers_for(piece.vertices.shape[1], piece.spans, piece.closed)
    p, tips, _, _, _ = tried_in(numbers, piece.vertices.shape[1], piece.spans, piece.closed)
    p[:] = piece.vertices.swapaxes(0, 1)
    if not piece.closed:
        set_tips(p, piece.tangents, tips)
    return piece.spans, numbers


class Search:
    """The search for the spline of a stretch.

    Attributes:
        samples: of the stretch, in ``masters``. closed: 1 for a closed curve, or else 0. most: spans.
        near: how near all samples have to be. limits: the same, and margin and residual of the interpolation.
        outline: what is followed. alone: whether there is one master.
        guessed: numbers of spans that a guess was made with.
    """

    def __init__(self, samples: Samples, closed: int, near: float, settings: SharpSettings, most: int) -> None:
        self.samples, self.closed, self.near, self.settings, self.most = samples, closed, near, settings, most
        self.limits = near, settings.margin, settings.residual
        self.outline, self.masters = (samples.Q, samples.directions, samples.free), len(samples.Q)
        self.alone = self.masters == 1
        self.guessed = set[int]()

    def curves(self, first: Vertices | None, guess: int, wanted: int, starts: int) -> Iterator[TriedCurve]:
        """Curves whose vertices have moved, each with more vertices where the last one misses the tolerance; where that
        leads nowhere, from a new guess on.

        Args:
            first: the vertices to begin with; None to begin with ``guess`` spans, and then with more.
            wanted: spans by the density. starts: most guesses.
        """
        settings = self.settings
        for start in range(1 if first else starts):
            if start > 0:
                guess = max(wanted, guess + 2) + start - 1
            vertices = first or (self.placed(guess) if guess <= self.most else None)
            slow, insertions, least = 0, 0, inf
            while vertices is not None:
                curve = self.moved(vertices, settings.rounds)
                yield curve
                # Masters stay off by some tolerances for long, and may yet pass.
                near = 0.0 if self.alone else 4 * self.near
                slow = slow + 1 if curve.error > max(0.9 * least, near) else 0
                least = min(least, curve.error)
                if curve.error == inf or slow == SLOW:
                    break
                insertions += 1
                growth = settings.growth * (2 if self.alone and curve.spans > LONG else 1)
                vertices = self.with_more(curve, growth if insertions <= PATIENCE else inf)

    def thinned(self, best: TriedCurve, least: int) -> TriedCurve:
        """A curve with vertices taken out, the cheapest first, as long as what is left passes.

        One curve loses vertices, and is not chosen among several. In a pass each is tried once, until several in a row
        fail. After a pass that took any out another one follows. Where none can be taken out, a new guess has one less,
        unless it was made before.
        """
        settings = self.settings
        for n in range(settings.passes if best.spans > least else 0):
            before, tried, failed = best.spans, False, 0
            left, cheapest = [True] * before, self.cheapest(best)
            while failed < settings.failures and best.spans > least:
                i = next((i for i in cheapest if left[i]), None)
                if i is None:
                    break
                tried = True
                curve = self.moved(self.with_less(best, i), settings.removal_rounds, i, settings.reach)
                if curve.error <= self.near:
                    best, cheapest, failed = curve, self.cheapest(curve), 0
                    del left[i]
                else:
                    left[i], failed = False, failed + 1
            k = best.spans - 1
            if k < least or (tried and n == settings.passes - 1):
                return best
            if not tried or k + 1 == before:
                if k in self.guessed:  # it was not near enough
                    return best
                curve = self.moved(self.placed(k), settings.rounds)
                if not curve.error <= self.near:
                    return best
                best = curve
        return best

    def placed(self, k: int) -> Vertices:
        """Vertices of k spans on the outline."""
        self.guessed.add(k)
        return k, place_vertices(self.outline, self.samples.D, k, self.closed)

    def with_more(self, curve: TriedCurve, growth: float) -> Vertices | None:
        """The vertices of a curve, and more in its worst spans; None if these are too many."""
        if curve.spans >= self.most:
            return None
        return insert_vertices(curve.numbers, self.masters, curve.spans, self.closed, self.near, growth, self.most)

    def with_less(self, curve: TriedCurve, i: int) -> Vertices:
        """The vertices of a curve but for vertex i."""
        return curve.spans - 1, without(curve.numbers, self.masters, curve.spans, self.closed, i)

    def cheapest(self, curve: TriedCurve) -> Iterator[int]:
        """The vertices of a curve that are worth a try to take out."""
        dear = self.settings.dear * self.near
        return iter(cheap_removals(curve.numbers, self.masters, curve.spans, self.closed, dear).tolist())

    def moved(self, vertices: Vertices, rounds: int, i: int = 0, reach: int | None = None) -> TriedCurve:
        """The curve once its vertices have moved, in ``rounds`` steps at most: up to ``reach`` on either side of vertex
        i, or all."""
        k, numbers = vertices
        steps = self.settings.few_rounds if k <= 3 else rounds
        steps = steps if self.alone else 4 * steps // 3  # masters get near later
        reach = k if reach is None else reach
        error = move_vertices(numbers, k, self.closed, self.outline, self.limits, steps, i, reach)
        return TriedCurve(k, numbers, error)

    def piece(self, piece: Piece, curve: TriedCurve) -> Piece:
        """The curve in the place of a piece."""
        samples, k, closed = self.samples, curve.spans, self.closed
        error, points, places, tangents = places_beside(
            samples.Q, samples.places, samples.lap, curve.numbers, k, closed, self.near
        )
        return Piece(piece.contour, piece.joints, k, closed, points.swapaxes(0, 1), places, tangents, error)
