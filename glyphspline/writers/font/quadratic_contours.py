"""Contours in quadratics, drawn anew as far as that does no harm: the points of ``glyf`` and ``gvar``."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from fontTools.ttLib.tables._g_l_y_f import Glyph, flagOnCurve
from fontTools.ttLib.tables.TupleVariation import TupleVariation
from fontTools.varLib.iup import iup_delta

from ...curves.cubics import turns
from ...curves.nearest import near_places
from ...curves.pairing import pair_instances
from ...outlines.masters import MasterContour, Masters, quadratics
from ...readers.pens import ContourPen
from ...types import BoolArray, FloatArray, IntArray
from .implied_quadratics import Arc, Fitted, fit
from .master_deltas import Redrawn, as_drawn, rounded_deltas
from .stretches import NEAR, is_own, locations, ranges_of, spans_of

LEVEL = np.radians(0.5)
"""Turn between a line and an arc up to which, if no master turns more, the arc begins along the line."""

SAMPLED, CLOSER = 0.98, 0.9
"""Shares of the tolerance for the distance seen: that which is certified is larger. Arcs that are not certified within
the first are fitted again within the second."""

PHANTOMS = 4
"""Points after those of the contours, which encode the advance and the bearings."""


@dataclass(frozen=True, eq=False)
class Own:
    """A contour as the font has it.

    Attributes:
        steps: (K, n, 2) the default and the deltas of its points, those that the font infers rounded. on: (n,) which of
            them are on the curve. place: their numbers in the glyph.
        first: (m,) for each segment the first point at its start or behind it; None if readers drop a segment.
        implied: (m,) whether it begins at an implied point.
        moved: (K, n, 2) by how much they are rounded.
        turned: whether the glyph's last point is the first here, as a control point cannot be the start.
    """

    steps: IntArray
    on: BoolArray
    place: slice
    first: IntArray | None
    implied: BoolArray
    moved: FloatArray
    turned: bool


def own_contours(
    masters: Masters, glyph: Glyph, moves: Sequence[tuple[int, TupleVariation]], shift: FloatArray
) -> dict[int, Own]:
    """The contours of a glyph, by their numbers in the masters; none that these do not have so.

    Args:
        moves: tuples of the glyph, and the numbers of their masters. shift: see :class:`Quadratic`.
    """
    if not glyph.numberOfContours:
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
    moved = as_drawn(masters, steps, 1) - points
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
        first = np.flatnonzero(on | (~on & ~np.roll(on, 1)))
        known = first if len(pen.stacks[number]) == len(degrees) else None
        found[number] = Own(steps[:, order], on, slice(a, b), known, implied, moved[:, order], bool(turned))
    return found


class Quadratic:
    """The plan of a contour in quadratics, within a tolerance if that can be had in whole units.

    An arc that is drawn anew has only implied points on the curve. Next to a joint that turns, its control point
    becomes the source's, and in the end the whole arc.

    Args:
        redrawn, c: which contour. owns: contours as the font has them.
        shift: (K,) from where a master is drawn to where it is stored, along x.
    """

    def __init__(self, redrawn: Redrawn, c: int, owns: Mapping[int, Own], shift: FloatArray, tolerance: float) -> None:
        self.masters, contour, inner = redrawn.masters, redrawn.contours[c], redrawn.inner[c]
        self._offset = shift[:, None, None] * np.array([1.0, 0.0])
        self._weights = self.masters.weights_at(locations(self.masters))
        self._fewest = redrawn.fewest
        self._tolerance = tolerance - redrawn.bounds[c] if redrawn.bounds else tolerance
        self._maybe = owns.get(redrawn.numbers[c]) if redrawn.bounds else None
        self._whole = False
        cubics, degrees = contour.cubics(), contour.degrees
        ring = [Arc(cubics, True, cubics[:, :2, 0])]
        self._arcs = ring if inner.all() else cut(cubics, degrees, inner, self._rounded)
        self._ranges: list[range] | None = None
        self._shares = [1.0] * len(self._arcs)
        kept = [False] * len(self._arcs)
        if self._maybe is not None:
            self._source = self.masters.contours[redrawn.numbers[c]]
            if self._maybe.first is not None:
                self._ranges = ranges_of(contour, inner, self._source)
        if self._ranges is not None:
            pairs = zip(spans_of(inner), self._ranges, strict=True)
            kept = [is_own(contour, span, self._source, own) for span, own in pairs]
            every = self._source.cubics()
            for k, own in enumerate(self._ranges):
                self._arcs[k] = replace(self._arcs[k], source=every[:, np.array(own) % len(self._source)])
            self._tolerance = tolerance  # which is measured from the source
            self._shares = [SAMPLED] * len(self._arcs)
        self._kept = kept
        self._fits: list[Fitted | None] = [None] * len(self._arcs)
        for k in range(len(self._arcs)):
            self._fit(k)

    @property
    def own(self) -> Own:
        """The contour as the font has it."""
        assert self._maybe is not None
        return self._maybe

    @property
    def is_own(self) -> bool:
        """Whether all of it stays as the font has it."""
        return self._whole or all(self._kept)

    @property
    def distance(self) -> float:
        """The largest from the contour that was given."""
        far = [each.distance for each in self._fits if each is not None]
        for k, arc in enumerate(self._arcs):
            if self._starts_there(k):
                far.append(float(np.hypot(*(self._weights @ (arc.ends[:, 0] - arc.cubics[:, 0, 0])).T).max()))
        if any(self._kept):
            far.append(float(np.linalg.norm(np.tensordot(self._weights, self.own.moved, axes=1), axis=2).max()))
        return max(far, default=0.0)

    @property
    def shortest(self) -> float:
        """The shortest leg of a quadratic at an implied point; infinite if there is none."""
        return min([each.shortest for each in self._fits if each is not None], default=np.inf)

    def _rounded(self, points: FloatArray, metric: FloatArray | None = None) -> FloatArray:
        steps = rounded_deltas(self.masters, points + self._offset, 1, metric)
        return as_drawn(self.masters, steps, 1) - self._offset

    def _fit(self, k: int) -> None:
        """Fit an arc, or leave it as the font has it."""
        arc, self._fits[k] = self._arcs[k], None
        if self._kept[k] or arc.straight:
            return
        most = None
        if self._fewest and self._maybe is not None:
            most = len(self._maybe.on) if self._ranges is None or arc.closed else len(self._points_of(k)) - 1
        near = self._shares[k] * self._tolerance
        self._fits[k] = found = fit(arc, self._weights, near, self._rounded, most)
        if found is None or (self._maybe is not None and found.distance > near):
            self._keep(k)

    def bound(self, given: float) -> float:
        """A bound of the distance from the source: certified where it is known what each arc replaces; or else, with
        what was ``given`` for the contour, the distance from that.
        """
        if self.is_own:
            return 0.0
        if self._ranges is None:
            return given + self.distance
        moved = float(np.linalg.norm(np.tensordot(self._weights, self.own.moved, axes=1), axis=2).max())
        return max(moved * any(self._kept), float(self._certified().max()))

    def too_far(self) -> bool:
        """Leave arcs as they are that are not certified within the tolerance; whether there were any."""
        if self.is_own or self._ranges is None:
            return False
        far = np.flatnonzero(self._certified() > self._tolerance).tolist()
        for k in far:
            if self._shares[k] > CLOSER and self._fits[k] is not None:
                self._shares[k] = CLOSER
                self._fit(k)
            else:
                self._keep(k)
        return bool(far)

    def _certified(self) -> FloatArray:
        """(P,) the certified distance of each stretch from the source, at every location; 0 for those that stay."""
        assert self._ranges is not None
        corners = np.unique(self.masters.weights_at(self.masters.grid()).round(12), axis=0)
        V, m = len(corners), len(self._source)
        results, sources = (
            np.ascontiguousarray(np.einsum("vk,kmpc->mvpc", corners, contour.cubics()).reshape(-1, 4, 2))
            for contour in (self.stored(), self._source)
        )
        starts = np.concatenate([[0], np.cumsum(self._counts())])
        count, closed = int(starts[-1]), self._arcs[0].closed
        places, arcs, bounds = np.empty(count), np.empty((count, 4)), np.zeros(count)
        low = float(self._ranges[0].start)
        for k, own in enumerate(self._ranges):
            a, b, high = int(starts[k]), int(starts[k + 1]), low + len(own)
            arcs[a:b] = (-np.inf, np.inf, -np.inf, np.inf) if closed else (a, b, low, high)
            fitted = self._fits[k]
            if fitted is None:  # a line, or segments that stay
                places[a:b] = low + np.arange(b - a) * (len(own) / (b - a))
            else:
                hints = np.ascontiguousarray(low + fitted.places)
                inner = 0 if closed else 1
                own_hints, begins = hints[inner:], results[V * (a + inner) : V * b]
                if len(own_hints):
                    near_places(V, sources, own_hints, begins, closed, low, high, own_hints)
                places[a:b] = hints
            if not closed:
                places[a] = low
            bounds[a:b] = 0.0 if self._kept[k] else np.nan
            low = high
        if closed:
            places += m * np.ceil(max(-places[0], 0.0) / m) - m * np.floor(max(places[0], 0.0) / m)
        anchors = np.stack([np.arange(count + 1.0), np.append(places, places[0] + m)], axis=1)
        ends = [np.array([0, each]) for each in (count, m, count + 1)]
        pair_instances(
            V, results, ends[0], sources, ends[1], anchors, ends[2], arcs, 0.0, self._tolerance, bounds, np.zeros(count)
        )
        return np.maximum.reduceat(bounds, starts[:-1])

    def _counts(self) -> list[int]:
        """The segments of each stretch as it is stored."""
        assert self._ranges is not None
        return [
            len(own) if kept else 1 if fitted is None else fitted.controls.shape[1]
            for own, kept, fitted in zip(self._ranges, self._kept, self._fits, strict=True)
        ]

    def _keep(self, k: int) -> None:
        self._fits[k] = None
        if self._ranges is None:
            self._whole = True
        else:
            self._kept[k] = True

    def _points_of(self, k: int) -> IntArray:
        """The numbers of the points of the font's contour that a stretch replaces, from its start on."""
        assert self._ranges is not None
        first, n = self.own.first, len(self.own.on)
        assert first is not None
        a, b = (int(first[j % len(first)]) for j in (self._ranges[k].start, self._ranges[k].stop))
        return np.arange(a, b if b > a else b + n) % n

    def _starts_there(self, k: int) -> bool:
        """Whether a stretch begins at a point on the curve that is rounded, besides those that the font has there."""
        if not self._kept[k]:
            return not self._arcs[k].closed
        assert self._ranges is not None
        return bool(self.own.implied[self._ranges[k].start % len(self.own.implied)]) and not self._kept[k - 1]

    def points(self) -> tuple[IntArray, BoolArray]:
        """(K, N, 2) the default and the deltas of its points, and which of them are on the curve."""
        if self.is_own:
            turn = -int(self.own.turned)
            return np.roll(self.own.steps, turn, axis=1), np.roll(self.own.on, turn)
        steps, on = [], []
        for k, arc in enumerate(self._arcs):
            if self._starts_there(k):
                steps.append(rounded_deltas(self.masters, arc.ends[:, :1] + self._offset, 1))
                on.append(True)
            if self._kept[k]:
                numbers = self._points_of(k)
                steps.append(self.own.steps[:, numbers])
                on += self.own.on[numbers].tolist()
            elif (fitted := self._fits[k]) is not None:
                steps.append(rounded_deltas(self.masters, fitted.controls + self._offset, 1))
                on += [False] * fitted.controls.shape[1]
        return np.concatenate(steps, axis=1), np.array(on)

    def _drawn(self) -> tuple[FloatArray, IntArray, BoolArray]:
        steps, on = self.points()
        return quadratics(as_drawn(self.masters, steps, 1) - self._offset, on)

    def stored(self) -> MasterContour:
        """See :class:`.stretches.Plan`."""
        if self.is_own:
            return self._source
        return MasterContour(*self._drawn()[:2])

    def inside(self) -> BoolArray:
        """(m,) whether a segment of :meth:`stored` begins at an implied point."""
        if self.is_own:
            return self.own.implied if self.own.first is not None else np.zeros(len(self._source), dtype=bool)
        return self._drawn()[2]

    def retreat(self, segment: int) -> bool:
        """See :class:`.stretches.Plan`."""
        if self._maybe is None or self.is_own:
            return False
        if self._ranges is None or self._arcs[0].closed:
            self._whole = True
            return True
        owners = np.repeat(np.arange(len(self._arcs)), self._counts()).tolist()
        before, after = owners[segment - 1], owners[segment]
        moved = False
        for k, at_end in ((before, True), (after, False)):
            if self._kept[k]:
                continue
            moved, arc, control = True, self._arcs[k], self._control(k, at_end)
            held = arc.last if at_end else arc.first
            if before == after or control is None or held is not None:
                self._keep(k)
            else:
                self._arcs[k] = replace(arc, last=control) if at_end else replace(arc, first=control)
                self._fit(k)
        if not moved:
            self._whole = True
        return True

    def _control(self, k: int, at_end: bool) -> FloatArray | None:
        """(K, 2) the source's first or last control point of an arc; None if it is none of an arc."""
        if self._arcs[k].straight:
            return None
        numbers = self._points_of(k)
        number = int(numbers[-1] if at_end else numbers[0])
        if not at_end and self.own.on[number]:
            number = (number + 1) % len(self.own.on)
        if self.own.on[number]:
            return None
        drawn = as_drawn(self.masters, self.own.steps[:, number : number + 1], 1) - self._offset
        return np.asarray(drawn[:, 0])


def cut(
    cubics: FloatArray, degrees: IntArray, inner: BoolArray, rounded: Callable[[FloatArray], FloatArray]
) -> list[Arc]:
    """The lines and arcs of a contour with corners, from its first end on, and their ends rounded."""
    starts = np.flatnonzero(~inner)
    counts = np.diff([*starts, starts[0] + len(degrees)])
    spans = [np.arange(start, start + count) % len(degrees) for start, count in zip(starts, counts, strict=True)]
    ends = rounded(cubics[:, starts, 0])
    straight = [len(span) == 1 and degrees[span[0]] == 1 for span in spans]
    level = np.array([np.abs(turns(master, 1e-9)) for master in cubics]).max(axis=0)[starts] < LEVEL
    arcs = []
    for k, span in enumerate(spans):
        here, there, beyond = ends[:, k], ends[:, (k + 1) % len(ends[0])], ends[:, (k + 2) % len(ends[0])]
        following = (k + 1) % len(spans)
        leaving = here - ends[:, k - 1] if straight[k - 1] and level[k] else None
        arriving = there - beyond if straight[following] and level[following] else None
        arcs.append(Arc(cubics[:, span], False, np.stack([here, there], axis=1), straight[k], leaving, arriving))
    return arcs
