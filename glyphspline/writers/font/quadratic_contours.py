"""Contours in quadratics, in all masters at once: what follows curves, and the points of ``glyf`` and ``gvar``.

What is stored is certified, and compared with the source as ``check`` sees it: a contour that would turn where the
source does not, or need more points, stays as the font has it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from fontTools.ttLib.tables._g_l_y_f import Glyph, flagOnCurve
from fontTools.ttLib.tables.TupleVariation import TupleVariation
from fontTools.varLib.iup import iup_delta

from ...fitting.options import Options
from ...outlines.masters import MasterContour, Masters, quadratics
from ...outlines.outline import Contours
from ...readers.pens import ContourPen
from ...types import BoolArray, FloatArray, IntArray
from .font_glyphs import FONTS, ROUNDING
from .master_deltas import Redrawn, as_drawn, rounded_deltas
from .stretches import NEAR, Turning, locations, tally, vanished

PHANTOMS = 4
"""Points after those of the contours, which encode the advance and the bearings."""


@dataclass(frozen=True, eq=False)
class Own:
    """A contour as the font has it.

    Attributes:
        steps: (K, n, 2) the default and the deltas of its points, those that the font infers rounded. on: (n,) which of
            them are on the curve. place: their numbers in the glyph.
        known: whether readers drop no segment. implied: (m,) whether a segment begins at an implied point, if so.
        turned: whether the glyph's last point is the first here, as a control point cannot be the start.
    """

    steps: IntArray
    on: BoolArray
    place: slice
    known: bool
    implied: BoolArray
    turned: bool

    def as_stored(self) -> tuple[IntArray, BoolArray]:
        """Steps, and which points are on the curve, in the font's order."""
        return np.roll(self.steps, -int(self.turned), axis=1), np.roll(self.on, -int(self.turned))


def own_contours(
    masters: Masters, glyph: Glyph, moves: Sequence[tuple[int, TupleVariation]], shift: FloatArray
) -> dict[int, Own]:
    """The contours of a glyph, by their numbers in the masters; none that these do not have so.

    Args:
        moves: tuples of the glyph, and the numbers of their masters. shift: see :func:`in_quadratics`.
    """
    if glyph.numberOfContours < 1:
        return {}
    places = np.array(glyph.coordinates, dtype=np.float64)
    deltas = np.zeros((len(masters), *places.shape))
    deltas[0] = places
    whole = [*map(tuple, places.tolist()), *[(0.0, 0.0)] * PHANTOMS]
    for k, variation in moves:
        inferred = iup_delta(variation.coordinates, whole, glyph.endPtsOfContours)
        deltas[k] += np.array(inferred[:-PHANTOMS], dtype=np.float64)
    points = np.einsum("kj,jnc->knc", masters.scalars(masters.peaks), deltas)
    steps = rounded_deltas(masters, points, 1)
    points[..., 0] -= shift[:, None]
    every = np.array([bool(flag & flagOnCurve) for flag in glyph.flags])
    found, pen = dict[int, Own](), ContourPen(masters=len(masters))
    for a, b in pairwise([0, *(end + 1 for end in glyph.endPtsOfContours)]):
        turned = every[b - 1] and not every[a]
        whole_points, degrees, implied = quadratics(points[:, a:b], every[a:b])
        number = len(pen.stacks)
        pen.contour(whole_points, degrees)
        if len(pen.stacks) == number:
            continue
        read, wanted = pen.stacks[number].points, [each.points for each in masters.contours[number : number + 1]]
        if not any(read.shape == each.shape and np.abs(read - each).max() <= NEAR for each in wanted):
            return {}
        order = np.roll(np.arange(a, b), 1) if turned else np.arange(a, b)
        on = every[order]
        known = len(pen.stacks[number]) == len(degrees)
        implied = implied if known else np.zeros(len(pen.stacks[number]), dtype=bool)
        found[number] = Own(steps[:, order], on, slice(a, b), known, implied, bool(turned))
    return found


def in_quadratics(
    new: Redrawn, owns: Mapping[int, Own], shift: FloatArray, tolerance: float, options: Options = FONTS
) -> Redrawn:
    """A glyph in quadratics as ``glyf`` stores them, within the tolerance of the source if whole units have them.

    Args:
        new: the contours that they follow. Where it has no bounds, what is certified is the distance from these.
        owns: the contours as the font has them, by their numbers in the masters. shift: (K,) from where a master is
            drawn to where it is stored, along x.
    """
    from ...fitting.sharp.font_points import quadratic_contour  # compiles more than others need

    masters, offset = new.masters, shift[:, None, None] * np.array([1.0, 0.0])
    corners = np.unique(masters.weights_at(masters.grid()).round(12), axis=0)
    looks = masters.weights_at(np.vstack([masters.places(), locations(masters)]))
    em = masters.metrics.units_per_em
    numbers, count = new.numbers or (-1,) * len(new.contours), len(new.contours)
    before, wanted = [owns.get(number) for number in numbers], new.bounds or (0.0,) * count
    contours, inner = list(new.contours), list(new.inner)
    bounds, sizes, stays = [0.0] * count, [0] * count, [np.zeros(len(each), dtype=bool) for each in contours]
    source = Turning(masters)
    # Where regions overlap at each other's peaks, not every master can have whole units.
    rest = ROUNDING if np.abs(masters.at_peaks % 1).any() else 0.0

    def is_stored(c: int) -> bool:
        own, contour = before[c], new.contours[c]
        return own is not None and own.known and np.array_equal(contour.points, masters.contours[numbers[c]].points)

    def fit(c: int) -> None:
        own, moved = before[c], MasterContour(new.contours[c].points + offset, new.contours[c].degrees)
        stored = (as_drawn(masters, own.steps, 1), own.on) if own and is_stored(c) else None
        sources = [Contours([moved.mixed(weights)]).arrays for weights in np.eye(len(masters))]
        room = tolerance - wanted[c]
        room = max(room - rest, room / 2)
        points, on, far = quadratic_contour(sources, stored, corners, looks, options, room, em, stays[c])
        drawn = as_drawn(masters, rounded_deltas(masters, points, 1), 1)
        bounds[c] = wanted[c] + far + float(np.linalg.norm(drawn - points, axis=2).max(initial=0.0))
        whole, degrees, inner[c] = quadratics(drawn - offset, on)
        contours[c], sizes[c] = MasterContour(whole, degrees), len(on)
        more = len(on) - len(own.on) if own else 0
        if bounds[c] > tolerance or (more > 0 and new.fewest) or (more == 0 and is_stored(c)):
            keep(c)

    def keep(c: int) -> bool:
        """Let a contour stay as the font has it; whether it can, and has not."""
        own, whole = before[c], masters.contours[numbers[c]]
        if own is None or contours[c] is whole:
            return False
        contours[c], inner[c], sizes[c], bounds[c] = whole, own.implied, len(own.on), 0.0
        return True

    def retreat(c: int, segments: Sequence[int]) -> bool:
        """Let what meets where segments begin stay as the font has it, or else the contour; whether it has not."""
        if contours[c] is not masters.contours[numbers[c]] and is_stored(c):
            there, here = masters.contours[numbers[c]].cubics()[:, :, 0], contours[c].cubics()[:, segments, 0]
            near = np.abs(there[:, :, None] - here[:, None]).max(axis=(0, 3)) <= 1.0
            more = near.any(axis=1) | np.roll(near.any(axis=1), -1)
            if near.any(axis=0).all() and (more & ~stays[c]).any():
                stays[c] |= more
                fit(c)
                return True
        return keep(c)

    for c in range(count):
        fit(c)
    while True:
        found = Turning(replace(masters, contours=contours, repeats=None))
        bad = found.not_in(source)
        segments = [[s for owner, s in bad if owner == c] + vanished(each) for c, each in enumerate(contours)]
        if not any([retreat(c, own) for c, own in enumerate(segments) if own]):  # noqa: C419 (all)
            break
    many = sum(len(own.on) for own in before if own) or sum(len(c.points[0]) for c in masters.contours)
    return Redrawn(
        masters, tuple(contours), tuple(inner), tuple(bounds), numbers, new.fewest,
        tally((many, sum(sizes)), (source, found), False),
    )  # fmt: skip


def unchanged(masters: Masters, contours: Sequence[MasterContour] | None = None) -> Redrawn:
    """A glyph, or some of its contours, as it is."""
    some = tuple(masters.contours if contours is None else contours)
    return Redrawn(masters, some, tuple(np.zeros(len(contour), dtype=bool) for contour in some))


class Final:
    """A contour that is as ``glyf`` stores it, in the place of its plan.

    Args:
        redrawn, owns, shift: see :func:`in_quadratics`. c: which contour.
    """

    def __init__(self, redrawn: Redrawn, c: int, owns: Mapping[int, Own], shift: FloatArray) -> None:
        self._masters, self._contour, self._inner = redrawn.masters, redrawn.contours[c], redrawn.inner[c]
        self._offset = shift[:, None, None] * np.array([1.0, 0.0])
        number = redrawn.numbers[c]
        self._maybe = owns.get(number)
        self.is_own = self._maybe is not None and np.array_equal(
            redrawn.masters.contours[number].points, self._contour.points
        )

    @property
    def own(self) -> Own:
        """The contour as the font has it."""
        assert self._maybe is not None
        return self._maybe

    def points(self) -> tuple[IntArray, BoolArray]:
        """(K, N, 2) the default and the deltas of its points, and which of them are on the curve."""
        if self.is_own:
            return self.own.as_stored()
        starts = np.cumsum(self._contour.degrees) - self._contour.degrees
        on = np.isin(np.arange(self._contour.points.shape[1]), starts)
        left = np.delete(np.arange(len(on)), starts[self._inner])
        return steps_of(self._masters, self._contour.points[:, left] + self._offset), on[left]


def steps_of(masters: Masters, points: FloatArray) -> IntArray:
    """(K, N, 2) the default and the deltas of points that are rounded in all masters."""
    steps = np.linalg.solve(masters.at_peaks, points.reshape(len(points), -1)).reshape(points.shape)
    return np.rint(steps).astype(np.int64)
