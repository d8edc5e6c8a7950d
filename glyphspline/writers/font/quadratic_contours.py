"""Contours in quadratics, drawn anew as far as that does no harm: the points of ``glyf`` and ``gvar``."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import astuple, dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from fontTools.ttLib.tables._g_l_y_f import Glyph, flagOnCurve
from fontTools.ttLib.tables.TupleVariation import TupleVariation
from fontTools.varLib.iup import iup_delta

from ...checks.kinds import THRESHOLDS
from ...checks.turns import joint_controls, turns_of
from ...curves.bezier import cross
from ...curves.cubics import turns
from ...outlines.masters import MasterContour, Masters, quadratics
from ...readers.pens import ContourPen
from ...types import BoolArray, FloatArray, IntArray
from .implied_quadratics import Arc, Fitted, fit
from .master_deltas import Redrawn, as_drawn, rounded_deltas
from .stretches import NEAR, is_own, locations, ranges_of, spans_of

LEVEL = np.radians(0.5)
"""Turn between a line and an arc up to which, if no master turns more, the arc begins along the line."""

AIMS = 6
"""How far a control point may move along x and y so that a joint turns less, in units; further needs other legs."""

SHARES = (1.0, 0.5)
"""Of the turn that is no new kink: what is aimed at, on each try."""

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

    def as_stored(self) -> tuple[IntArray, BoolArray]:
        """Steps, and which points are on the curve, in the font's order."""
        return np.roll(self.steps, -int(self.turned), axis=1), np.roll(self.on, -int(self.turned))


def own_contours(
    masters: Masters, glyph: Glyph, moves: Sequence[tuple[int, TupleVariation]], shift: FloatArray
) -> dict[int, Own]:
    """The contours of a glyph, by their numbers in the masters; none that these do not have so.

    Args:
        moves: tuples of the glyph, and the numbers of their masters. shift: see :class:`Quadratic`.
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
    becomes the source's, and in the end the whole arc. Where the font has no such contour, it becomes one that turns
    less, and in the end what meets there becomes one arc, lines too: it turns nowhere.

    Args:
        redrawn, c: which contour. owns: contours as the font has them.
        shift: (K,) from where a master is drawn to where it is stored, along x.
    """

    def __init__(self, redrawn: Redrawn, c: int, owns: Mapping[int, Own], shift: FloatArray, tolerance: float) -> None:
        self.masters, self._contour, self._inner = redrawn.masters, redrawn.contours[c], redrawn.inner[c].copy()
        self._offset = shift[:, None, None] * np.array([1.0, 0.0])
        self._weights = np.unique(self.masters.weights_at(self.masters.grid()).round(12), axis=0)
        self._fewest = redrawn.fewest
        self._tolerance, self._given = tolerance, 0.0
        self._maybe = owns.get(redrawn.numbers[c]) if redrawn.bounds else None
        self._whole = False
        # By joints of what is given: control points beside them that are chosen; and those that nothing helps.
        self._aims, self._left = dict[int, tuple[bool, FloatArray, int] | None](), set[int]()
        self._tries = dict[int, int]()
        self._known = dict[Any, Fitted | None]()
        self._ranges: list[range] | None = None
        if self._maybe is not None:
            self._source = self.masters.contours[redrawn.numbers[c]]
            if self._maybe.first is not None:
                self._ranges = ranges_of(self._contour, self._inner, self._source)
        if redrawn.bounds and self._ranges is None:  # the distance is measured from what is given
            self._given = redrawn.bounds[c]
        self._divided: list[int] = []
        self._cut()
        if redrawn.bounds and self._maybe is None:
            self._divide()

    def _divide(self) -> None:
        """Divide arcs that are too far at a joint of theirs, whose point on the curve is stored: the level one, if any,
        that is nearest to the middle. The grid has the directions of its handles.
        """
        legs = np.abs(self._contour.cubics()[:, :, 1] - self._contour.cubics()[:, :, 0])
        slanted = (legs.min(axis=2) > LEVEL * legs.max(axis=2)).any(axis=0)
        while True:
            every = zip(spans_of(self._inner), self._fits, strict=True)
            far = [span for span, each in every if len(span) > 1 and each and self._misses(each)]
            if not far:
                return
            for span in far:
                middle = np.abs(np.arange(1, len(span)) - len(span) / 2)
                joint = int(span[1 + np.lexsort((middle, slanted[span[1:]]))[0]])
                self._divided.append(joint)
                self._inner[joint] = False
            self._cut()

    def _misses(self, fitted: Fitted) -> bool:
        return fitted.distance > self._tolerance - self._given

    def _cut(self) -> None:
        """Cut the contour into its lines and arcs, and fit these."""
        contour, inner = self._contour, self._inner
        cubics = contour.cubics()
        ring = [Arc(cubics, True, cubics[:, :2, 0])]
        self._arcs = ring if inner.all() else cut(cubics, contour.degrees, inner, self._rounded, self._divided)
        self._kept = [False] * len(self._arcs)
        if self._ranges is not None:
            every = self._source.cubics()
            for k, (span, own) in enumerate(zip(spans_of(inner), self._ranges, strict=True)):
                self._arcs[k] = replace(self._arcs[k], cubics=every[:, np.array(own) % len(self._source)])
                self._kept[k] = len(span) == 1 and is_own(contour, span, self._source, own)
        firsts = [int(span[0]) for span in spans_of(inner)]
        for joint, aimed in self._aims.items():
            if aimed is not None:
                (at_end, point, count), k = aimed, firsts.index(joint)
                k -= at_end
                arc = replace(self._arcs[k], count=count)
                self._arcs[k] = replace(arc, last=point) if at_end else replace(arc, first=point)
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
    def held(self) -> int:
        """How many curves of the source stay."""
        if self.is_own:
            return int((self._contour.degrees > 1).sum())
        own = [np.array(each) for each, kept in zip(self._ranges or (), self._kept, strict=False) if kept]
        return sum(int((self._source.degrees[each % len(self._source)] > 1).sum()) for each in own)

    @property
    def distance(self) -> float:
        """A bound of the distance from the source, where it is known what each arc replaces; or from what was given."""
        if self.is_own:
            return 0.0
        far = [each.distance for each in self._fits if each is not None]
        for k, arc in enumerate(self._arcs):
            if self._starts_there(k):
                far.append(float(np.hypot(*(self._weights @ (arc.ends[:, 0] - arc.cubics[:, 0, 0])).T).max()))
        if any(self._kept):
            far.append(float(np.linalg.norm(np.tensordot(self._weights, self.own.moved, axes=1), axis=2).max()))
        return max(far)

    @property
    def bound(self) -> float:
        """A bound of the distance from the source."""
        return 0.0 if self.is_own else self._given + self.distance

    @property
    def shortest(self) -> float:
        """The shortest leg of a quadratic at an implied point; infinite if there is none."""
        legs = [np.inf]
        for arc, fitted in zip(self._arcs, self._fits, strict=True):
            if fitted is not None:
                mixed = np.tensordot(self.masters.weights_at(locations(self.masters)), fitted.controls, axes=1)
                steps = np.diff(np.concatenate([mixed, mixed[:, : int(arc.closed)]], axis=1), axis=1)
                legs.append(float(np.hypot(steps[..., 0], steps[..., 1]).min(initial=np.inf) / 2))
        return min(legs)

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
        key = tuple(each.tobytes() if isinstance(each, np.ndarray) else each for each in astuple(arc))
        if key not in self._known:
            self._known[key] = fit(arc, self._weights, self._tolerance - self._given, self._rounded, most)
        self._fits[k] = found = self._known[key]
        if found is None or (self._maybe is not None and self._misses(found)):
            self._keep(k)

    def _counts(self) -> list[int]:
        """The segments of each stretch as it is stored."""
        own = [1] * len(self._fits) if self._ranges is None else [len(each) for each in self._ranges]
        fits = zip(self._fits, self._kept, own, strict=True)
        return [count if kept else 1 if each is None else each.controls.shape[1] for each, kept, count in fits]

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
            return self.own.as_stored()
        drawn, on = [], []
        for k, arc in enumerate(self._arcs):
            if self._starts_there(k):
                drawn.append(self._rounded(arc.ends[:, :1]))
                on.append(True)
            if self._kept[k]:
                numbers = self._points_of(k)
                drawn.append(as_drawn(self.masters, self.own.steps[:, numbers], 1) - self._offset)
                on += self.own.on[numbers].tolist()
            elif (fitted := self._fits[k]) is not None:
                drawn.append(fitted.controls)
                on += [False] * fitted.controls.shape[1]
        return steps_of(self.masters, np.concatenate(drawn, axis=1) + self._offset), np.array(on)

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

    def retreat(self, segments: Sequence[int]) -> bool:
        """See :class:`.stretches.Plan`."""
        if self.is_own:
            return False
        if self._maybe is None:
            return self._soften(segments)
        if self._ranges is None or self._arcs[0].closed:
            self._whole = True
            return True
        owners = np.repeat(np.arange(len(self._arcs)), self._counts()).tolist()
        for before, after in dict.fromkeys((owners[segment - 1], owners[segment]) for segment in segments):
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
            self._whole |= not moved
        return True

    def _soften(self, segments: Sequence[int]) -> bool:
        """Let curves where segments of :meth:`stored` begin take the direction of what is beyond, as nearly as the grid
        has it; where that was in vain, let what meets there be one arc, lines too, if it is near enough.
        """
        if self._inner.all():
            return False
        starts, firsts = np.cumsum([0, *self._counts()])[:-1].tolist(), [int(each[0]) for each in spans_of(self._inner)]
        turns_there = np.abs(turns_of(joint_controls(self._contour)))
        tried = list[int]()
        for k in [starts.index(segment) for segment in segments if segment in starts]:
            joint = firsts[k]
            if joint in self._left or not (turns_there[:, joint] < THRESHOLDS.corner_angle).all():
                continue
            tries = self._tries[joint] = self._tries.get(joint, -1) + 1
            limit = max(float(turns_there[:, joint].max()) - 0.1, 0.8 * THRESHOLDS.kink)
            self._aims[joint] = self._aimed(k, SHARES[tries] * limit) if tries < len(SHARES) else None
            self._inner[joint] = self._aims[joint] is None
            tried.append(joint)
            if self._inner[joint]:  # its other ends are those of another arc now
                for other in (firsts[k - 1], firsts[(k + 1) % len(firsts)]):
                    if self._aims.get(other) is not None:
                        del self._aims[other], self._tries[other]
        if not tried:
            return False
        self._cut()
        vain = [joint for joint in tried if self._is_far(joint)]
        if vain:
            for joint in vain:
                if self._aims[joint] is None:
                    self._left.add(joint)
                self._aims[joint], self._inner[joint] = None, False
            self._cut()
        return True

    def _is_far(self, joint: int) -> bool:
        """Whether an arc that ends at a joint, or goes through it, is too far."""
        every = zip(spans_of(self._inner), self._fits, strict=True)
        far = [span for span, each in every if each is not None and self._misses(each)]
        return any(joint in span or joint == (span[-1] + 1) % len(self._inner) for span in far)

    def _aimed(self, k: int, most: float) -> tuple[bool, FloatArray, int] | None:
        """Whether the end of the arc before joint k is to be elsewhere, or else the beginning of that behind it; where:
        near by in each master, with at ``most`` so many degrees of turn; and its number of control points. None if both
        are lines.
        """
        before, after = self._fits[k - 1], self._fits[k]
        if before is None and after is None:
            return None
        at_end, node = after is None, self._arcs[k].ends[:, 0]
        own, other, arc = (before, after, self._arcs[k]) if at_end else (after, before, self._arcs[k - 1])
        assert own is not None
        there = arc.ends[:, int(at_end)] if other is None else other.controls[:, 0 if at_end else -1]
        here = own.controls[:, -1 if at_end else 0]
        u, v = np.mgrid[-AIMS : AIMS + 1, -AIMS : AIMS + 1]
        legs = (here - node)[:, None] + np.stack([u.ravel(), v.ravel()], axis=1)  # (K, C, 2)
        beyond = (node - there)[:, None]
        sine, cosine = cross(beyond, legs), (beyond * legs).sum(axis=2)
        off = np.degrees(np.abs(np.arctan2(sine, cosine))) - most
        unit = (here - node) / np.maximum(np.hypot(*(here - node).T), 1e-9)[:, None]
        along, across = (legs - legs[:, [len(u) ** 2 // 2]]) @ unit[:, :, None], cross(unit[:, None], legs)
        cost = (along[..., 0] / AIMS) ** 2 + across**2 / 4 + (np.maximum(off, 0.0) / 0.1) ** 2
        best = legs[np.arange(len(legs)), cost.argmin(axis=1)]
        return at_end, self._rounded((node + best)[:, None])[:, 0], own.controls.shape[1]

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


class Final:
    """A contour that is as ``glyf`` stores it, in the place of its plan.

    Args:
        redrawn, c, owns, shift: see :class:`Quadratic`.
    """

    distance, shortest = 0.0, np.inf

    def __init__(self, redrawn: Redrawn, c: int, owns: Mapping[int, Own], shift: FloatArray) -> None:
        self._masters, self._contour, self._inner = redrawn.masters, redrawn.contours[c], redrawn.inner[c]
        self._offset, self.bound = shift[:, None, None] * np.array([1.0, 0.0]), redrawn.bounds[c]
        self._maybe, source = owns.get(redrawn.numbers[c]), redrawn.masters.contours[redrawn.numbers[c]]
        self.is_own = self._maybe is not None and np.array_equal(source.points, self._contour.points)

    @property
    def own(self) -> Own:
        """See :class:`Quadratic`."""
        assert self._maybe is not None
        return self._maybe

    def points(self) -> tuple[IntArray, BoolArray]:
        """See :class:`Quadratic`."""
        if self.is_own:
            return self.own.as_stored()
        starts = np.cumsum(self._contour.degrees) - self._contour.degrees
        on = np.isin(np.arange(self._contour.points.shape[1]), starts)
        left = np.delete(np.arange(len(on)), starts[self._inner])
        return steps_of(self._masters, self._contour.points[:, left] + self._offset), on[left]

    def stored(self) -> MasterContour:
        """See :class:`Quadratic`."""
        return self._contour

    def inside(self) -> BoolArray:
        """See :class:`Quadratic`."""
        return self._inner


def steps_of(masters: Masters, points: FloatArray) -> IntArray:
    """(K, N, 2) the default and the deltas of points that are rounded in all masters."""
    steps = np.linalg.solve(masters.at_peaks, points.reshape(len(points), -1)).reshape(points.shape)
    return np.rint(steps).astype(np.int64)


def cut(
    cubics: FloatArray, degrees: IntArray, inner: BoolArray, rounded: Callable[[FloatArray], FloatArray],
    divided: Sequence[int] = (),
) -> list[Arc]:  # fmt: skip
    """The lines and arcs of a contour with corners, from its first end on, and their ends rounded.

    At joints that are ``divided``, inside what could be an arc, both arcs have the source's tangent.
    """
    starts = np.flatnonzero(~inner)
    counts = np.diff([*starts, starts[0] + len(degrees)])
    spans = [np.arange(start, start + count) % len(degrees) for start, count in zip(starts, counts, strict=True)]
    ends = rounded(cubics[:, starts, 0])
    straight = [len(span) == 1 and degrees[span[0]] == 1 for span in spans]
    level = np.array([np.abs(turns(master, 1e-9)) for master in cubics]).max(axis=0)[starts] < LEVEL
    tangents = cubics[:, starts, 1] - cubics[:, starts, 0]
    tangents[np.abs(tangents) < LEVEL * np.abs(tangents).max(axis=2, keepdims=True)] = 0.0
    arcs = []
    for k, span in enumerate(spans):
        following = (k + 1) % len(spans)
        here, there, beyond = ends[:, k], ends[:, following], ends[:, (k + 2) % len(spans)]
        leaving = arriving = None
        if level[k] and (straight[k - 1] or starts[k] in divided):
            leaving = here - ends[:, k - 1] if straight[k - 1] else tangents[:, k]
        if level[following] and (straight[following] or starts[following] in divided):
            arriving = there - beyond if straight[following] else -tangents[:, following]
        arcs.append(Arc(cubics[:, span], False, np.stack([here, there], axis=1), straight[k], leaving, arriving))
    return arcs
