"""Arcs as quadratics that meet midway between their control points, fitted to cubics in all masters at once.

A TrueType contour leaves out a point on the curve that lies midway between two control points. Where only such points
are inside an arc, the arc is a quadratic B-spline of uniform knots: it has no kink there in any master, nor in any
instance, wherever its control points are rounded to.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from operator import itemgetter

import numpy as np

from ...curves.bezier import evaluate
from ...types import BoolArray, FloatArray, IntArray

SAMPLES = 8
"""Samples of each cubic while its arc is fitted."""

FEWEST = 48
"""Samples of an arc, at least."""

TANGENT = 0.1
"""Weight of residuals along the curve once every master may slip, against those across it."""

SLIPPING, OWN, ROUNDS = 2, 5, 9
"""Rounds of least squares: from the first of these on points may slip, from the second on each master by itself."""

SLIP = 0.5
"""Spans by which a master's own parameters differ from the common ones at most."""

EVEN = 1e-4
"""Weight of second differences of control points against the distance, once each master has its own footpoints."""

SHORTEST = 1.5
"""Leg of a quadratic in font units below which other numbers of points are tried: renderers place implied points in
single precision, which turns a short leg."""

LEVEL = 4.0
"""Weight of what rounding moves off a line's direction, against what it moves off the curve."""

STEEPEST = 0.7
"""Most by which the length of a span changes per unit of length: neighbours are of like size, as they meet midway."""

FUTILE = 4
"""Tries that came no nearer, or were near enough before rounding, after which more points are not tried."""

SLACK = 0.35
"""Share of the tolerance under which the error before rounding is not what keeps an arc from its tolerance."""


@dataclass(frozen=True, eq=False)
class Arc:
    """What is fitted.

    Attributes:
        cubics: (K, m, 4, 2) in the masters. closed: whether the arc is a whole contour without ends.
        ends: (K, 2, 2) where it begins and ends, already rounded; not read if closed.
        straight: whether it is a line, of which there is nothing to fit.
        leaving, arriving: (K, 2) the lines before and after it, pointing into the arc, where it is to begin and end
            along them; else None.
    """

    cubics: FloatArray
    closed: bool
    ends: FloatArray
    straight: bool = False
    leaving: FloatArray | None = None
    arriving: FloatArray | None = None


@dataclass(frozen=True, eq=False)
class Fitted:
    """The control points of an arc: (K, n, 2) rounded, without its ends.

    Also their largest distance from the cubics, and their shortest leg at an implied point at any location.
    """

    controls: FloatArray
    distance: float
    shortest: float


def fit(
    arc: Arc, weights: FloatArray, tolerance: float, rounded: Callable[[FloatArray, FloatArray], FloatArray]
) -> Fitted:
    """The fewest control points found within ``tolerance`` of the arc and not too close, or else the nearest found.

    Args:
        weights: (V, K) of the masters at the locations where the distance is measured.
        tolerance: in font units.
        rounded: control points (K, n, 2) as they are stored, from those wanted and a metric (K, 2n, 2n) of their error.
    """
    fitting = _Fitting(arc, weights)
    found: list[tuple[tuple[float, float, int], Fitted]] = []

    def tried(count: int) -> tuple[bool, float]:
        """Whether so many points are near enough, and their distance before rounding."""
        smooth, error = fitting.solve(count)
        plain = np.broadcast_to(np.eye(2 * count), fitting.metric.shape)
        for metric in (fitting.metric, plain):
            controls = rounded(smooth, metric)
            distance = fitting.distance(controls)
            if distance <= max(tolerance, min((rank[0] for rank, _ in found), default=np.inf)):
                distance = fitting.fine_distance(controls)  # of what may be the result
            near = distance <= tolerance
            shortest = fitting.shortest(controls)
            # Of those that are near, one without short legs, and then the one of fewest points.
            rank = (0.0 if near else distance, -min(shortest, SHORTEST), count)
            found.append((rank, Fitted(controls, distance, shortest)))
            if near:
                break
        return near, error

    count, low, futile = fitting.least, fitting.least - 1, 0
    while True:
        before = min((rank[0] for rank, _ in found), default=np.inf)
        near, error = tried(count)
        gained = min(rank[0] for rank, _ in found) < 0.98 * before
        futile += error < SLACK * tolerance or not gained
        if near or count >= fitting.most or futile == FUTILE:
            break
        low = count
        growth = (error / (SLACK * tolerance)) ** (1 / 3)
        count = min(max(count + 1 + count // 8, int(count * min(growth, 2.0))), fitting.most)
    while near and count - low > 1:  # between a count that failed and one that did not
        middle = (low + count) // 2
        if tried(middle)[0]:
            count = middle
        else:
            low = middle
    for more in (-1, 1, 2, 3):
        if near and -min(rank for rank, _ in found)[1] < SHORTEST and count + more >= fitting.least:
            tried(count + more)
    return min(found, key=itemgetter(0))[1]


class _Fitting:
    """The samples of an arc, and how dense spans are to be along it."""

    def __init__(self, arc: Arc, weights: FloatArray) -> None:
        self.arc, self.weights = arc, weights
        count = arc.cubics.shape[1]
        self.per = max(SAMPLES, -(-FEWEST // count))
        self.points, self.tangents = sampled(arc.cubics, self.per, arc.closed)
        self.targets = np.einsum("vk,knc->vnc", weights, self.points)
        steps = np.diff(
            np.concatenate([self.points, self.points[:, :1]], axis=1) if arc.closed else self.points, axis=1
        )
        self.lengths = np.sqrt((steps**2).sum(axis=2).mean(axis=0)) + 1e-9  # RMS over the masters
        ahead = np.roll(self.tangents, -1, axis=1) if arc.closed else self.tangents[:, 1:]
        here = self.tangents if arc.closed else self.tangents[:, :-1]
        cross = here[..., 0] * ahead[..., 1] - here[..., 1] * ahead[..., 0]
        turns = np.abs(np.arctan2(cross, (here * ahead).sum(axis=2)))
        self.turn = float(turns.sum(axis=1).max())
        turn = np.sqrt((turns**2).mean(axis=0))
        share = self.lengths / self.lengths.sum()
        self.density = (turn / max(turn.sum(), 1e-9)) ** 0.7 * share**0.3 + 0.3 * share
        bound = 4 if arc.closed else 1 + (arc.leaving is not None and arc.arriving is not None)
        self.least = max(bound, int(np.ceil(self.turn / np.radians(60))))
        self.most = self.least + 6 * count + 8
        mass = (
            self.lengths
            if arc.closed
            else np.r_[self.lengths[0], self.lengths[1:] + self.lengths[:-1], self.lengths[-1]]
        )
        self.mass = mass / mass.sum()
        self.t, self.metric = np.empty(0), np.empty((0, 0, 0))

    def _start(self, count: int) -> FloatArray:
        """(N,) parameters 0 … n of the samples: spans of the density, graded."""
        density = self.density / self.density.sum()
        at = np.cumsum(self.lengths) - self.lengths / 2
        size = self.lengths / (count * density)  # of a span there
        gap = np.abs(at[:, None] - at)
        if self.arc.closed:
            gap = np.minimum(gap, self.lengths.sum() - gap)
        graded = self.lengths / (size + STEEPEST * gap).min(axis=1)
        along = np.cumsum(graded) * (count / graded.sum())
        return along - along[0] if self.arc.closed else np.r_[0.0, along]

    def solve(self, count: int) -> tuple[FloatArray, float]:
        """(K, n, 2) the control points of a fit, and its largest error.

        First all masters have one parameter a sample, then each its own footpoints, so that their points may slip
        along the outline. ``metric`` (K, 2n, 2n) is then the quadratic form of the error.
        """
        t = self._start(count)[None, :]
        error, best = np.inf, (np.empty((0, 0, 0)), np.empty((0, 0, 0)), np.empty(0))
        for stage in range(ROUNDS):
            if stage == OWN:
                common = t
                t = np.repeat(t, len(self.points), axis=0)
            controls = self._least_squares(t, count, 1.0 if stage < SLIPPING else TANGENT)
            t = self._project(t, controls)
            if stage >= OWN:  # no span is to be left without samples
                t = np.clip(t, common - SLIP, common + SLIP)
            if stage in (OWN - 1, ROUNDS - 1):
                self.t = t.mean(axis=0)
                distance = self.distance(controls)
                if distance < error:
                    error, best = distance, (controls, self.metric, self.t)
        controls, self.metric, self.t = best
        return controls, error

    def _whole(self, controls: FloatArray) -> FloatArray:
        """The control points with the ends."""
        if self.arc.closed:
            return controls
        return np.concatenate([self.arc.ends[:, :1], controls, self.arc.ends[:, 1:]], axis=1)

    def _project(self, t: FloatArray, controls: FloatArray) -> FloatArray:
        """A step of parameters (1 or K, N), common or each master's own, towards the footpoints of the samples."""
        count = controls.shape[1]
        at, slope, _ = spline(self._whole(controls), t, count, self.arc.closed)
        off, size = ((self.points - at) * slope).sum(axis=2), (slope**2).sum(axis=2)
        if len(t) == 1:
            off, size = off.sum(axis=0, keepdims=True), size.sum(axis=0, keepdims=True)
        least = 1e-4 * size.mean() + 1e-12  # where a master's arc is a point, parameters stay
        t = t + np.clip(off / np.maximum(size, least), -0.3, 0.3)
        if not self.arc.closed:
            t = np.clip(t, 0, count)
            t[:, 0], t[:, -1] = 0, count
        return np.asarray(np.maximum.accumulate(t, axis=1))

    def _least_squares(self, t: FloatArray, count: int, along: float) -> FloatArray:
        """(K, n, 2) control points nearest the samples at parameters (1 or K, N)."""
        arc, masters, samples = self.arc, len(self.points), t.shape[1]
        index, weight, _, _ = basis(t, count, arc.closed)
        matrix = np.zeros((len(t), samples, count + (0 if arc.closed else 2)))
        np.add.at(matrix, (np.arange(len(t))[:, None, None], np.arange(samples)[:, None], index), weight)
        wanted = self.points
        if not arc.closed:
            wanted = wanted - matrix[:, :, :1] * arc.ends[:, :1] - matrix[:, :, -1:] * arc.ends[:, 1:]
            matrix = matrix[:, :, 1:-1]
        metric = (along**2 * np.eye(2) + (1 - along**2) * self._across) * self.mass[:, None, None]
        pairs = (matrix[:, :, :, None] * matrix[:, :, None, :]).reshape(len(t), samples, -1)
        normal = np.swapaxes(pairs, 1, 2) @ metric.reshape(masters, samples, 4)
        normal = normal.reshape(masters, count, count, 2, 2).transpose(0, 1, 3, 2, 4).reshape(masters, 2 * count, -1)
        right = np.swapaxes(matrix, 1, 2) @ (metric @ wanted[..., None])[..., 0]
        normal = normal + self._stiffness(count, normal, EVEN if len(t) > 1 else 0.0)
        self.metric = normal + self._beside_lines(count, normal)
        return self._solved(normal, right.reshape(masters, -1), count)

    def _held(self, count: int) -> list[tuple[int, FloatArray, FloatArray]]:
        """The control points that are to be on the lines before and after the arc: index, line and end."""
        lines = ((0, self.arc.leaving, 0), (count - 1, self.arc.arriving, 1))
        return [(j, line, self.arc.ends[:, side]) for j, line, side in lines if line is not None]

    def _beside_lines(self, count: int, normal: FloatArray) -> FloatArray:
        """A penalty on control points beside the lines that they are to be on: rounding would turn the joint."""
        penalty = np.zeros_like(normal)
        for j, line, _ in self._held(count):
            across = np.stack([-line[:, 1], line[:, 0]], axis=1) / np.maximum(np.hypot(*line.T), 1e-12)[:, None]
            block = slice(2 * j, 2 * j + 2)
            size = np.trace(normal, axis1=1, axis2=2)[:, None, None] / count
            penalty[:, block, block] += LEVEL * size * across[:, :, None] * across[:, None, :]
        return penalty

    @cached_property
    def _across(self) -> FloatArray:
        """(K, N, 2, 2) projection to the normal of the cubics at each sample."""
        x, y = self.tangents[..., 0], self.tangents[..., 1]
        rows: FloatArray = np.stack([np.stack([y * y, -x * y], -1), np.stack([-x * y, x * x], -1)], -2)
        return rows

    def _stiffness(self, count: int, normal: FloatArray, even: float) -> FloatArray:
        """A penalty on second differences, which spaces points evenly along the curve; a trace of it on first ones
        and on all, which keeps what no sample sees in place."""
        first = np.eye(count) - np.eye(count, k=1)
        second = 2 * np.eye(count) - np.eye(count, k=1) - np.eye(count, k=-1)
        if self.arc.closed:
            first[-1, 0] = second[0, -1] = second[-1, 0] = -1
        else:
            first[-1] = second[0] = second[-1] = 0
        form = 1e-7 * (first.T @ first + 1e-3 * np.eye(count)) + even * second.T @ second
        return np.asarray(np.kron(form, np.eye(2)) * np.trace(normal, axis1=1, axis2=2)[:, None, None] / (2 * count))

    def _solved(self, normal: FloatArray, right: FloatArray, count: int) -> FloatArray:
        """The solution, its first and last control point on the lines before and after the arc."""
        masters = len(self.points)
        held = self._held(count)
        if not held:
            return np.asarray(np.linalg.solve(normal, right[..., None])).reshape(masters, count, 2)
        fixed = np.zeros((masters, count, 2))
        keep = [np.eye(2 * count)[:, c] for c in range(2 * count) if not any(c // 2 == j for j, _, _ in held)]
        free = np.broadcast_to(np.array(keep).T.reshape(2 * count, -1), (masters, 2 * count, len(keep)))
        columns = []
        for j, line, end in held:
            fixed[:, j] = end
            column = np.zeros((masters, count, 2))
            column[:, j] = line
            columns.append(column.reshape(masters, -1, 1))
        found = _constrained(normal, right, fixed, np.concatenate([free, *columns], axis=2))
        stay = []
        for number, (j, line, end) in enumerate(held):
            if parallel(line):
                stay.append(columns[number])
                continue
            # One length for all masters: only so the joint has no turn between them either.
            along = ((found[:, j] - end) * line).sum() / max(float((line**2).sum()), 1e-12)
            fixed[:, j] = end + max(along, 0.0) * line
        return _constrained(normal, right, fixed, np.concatenate([free, *stay], axis=2))

    def distance(self, controls: FloatArray) -> float:
        """The largest distance from the cubics at all locations.

        Each location has its own footpoints; they run forward along the arc, so that the distance is one in both
        directions, up to what lies between two samples.
        """
        return self._farthest(controls, self.t, self.targets)

    def shortest(self, controls: FloatArray) -> float:
        """The shortest leg of a quadratic at a joint inside the arc, at any location."""
        whole = np.einsum("vk,knc->vnc", self.weights, controls)
        if self.arc.closed:
            whole = np.concatenate([whole, whole[:, :1]], axis=1)
        arms = np.diff(whole, axis=1)
        return float(np.hypot(arms[..., 0], arms[..., 1]).min(initial=np.inf) / 2)

    def fine_distance(self, controls: FloatArray) -> float:
        """The largest distance from four times as many samples."""
        arc, count, t = self.arc, controls.shape[1], self.t
        points = sampled(arc.cubics, 4 * self.per, arc.closed)[0]
        known = np.r_[t, t[0] + count] if arc.closed else t
        t = np.interp(np.arange(points.shape[1]) / 4, np.arange(len(known)), known)
        targets = np.einsum("vk,knc->vnc", self.weights, points)
        return self._farthest(controls, t, targets)

    def _farthest(self, controls: FloatArray, t: FloatArray, targets: FloatArray) -> float:
        """The largest distance of targets from the spline, and of the spline between them from the targets' chords."""
        count, closed = controls.shape[1], self.arc.closed
        whole = np.einsum("vk,knc->vnc", self.weights, self._whole(controls))
        t, at = footpoints(targets, whole, t, count, closed)
        far = np.hypot(*np.moveaxis(at - targets, -1, 0)).max()
        if closed:
            t, targets = np.c_[t, t[:, :1] + count], np.concatenate([targets, targets[:, :1]], axis=1)
        arms = np.diff(targets, axis=1)
        for share in (0.25, 0.5, 0.75):
            off = spline(whole, (1 - share) * t[:, :-1] + share * t[:, 1:], count, closed)[0] - targets[:, :-1]
            x = np.clip((off * arms).sum(axis=2) / np.maximum((arms**2).sum(axis=2), 1e-12), 0, 1)
            far = max(far, np.hypot(*np.moveaxis(off - x[..., None] * arms, -1, 0)).max())
        return float(far)


def _constrained(normal: FloatArray, right: FloatArray, fixed: FloatArray, free: FloatArray) -> FloatArray:
    """The solution (K, n, 2) of the form ``fixed + free @ y``."""
    base = fixed.reshape(len(fixed), -1, 1)
    if not free.shape[2]:
        return fixed
    left = np.swapaxes(free, 1, 2)
    y = np.linalg.solve(left @ normal @ free, left @ (right[..., None] - normal @ base))
    return (base + free @ y).reshape(fixed.shape)


def parallel(directions: FloatArray) -> bool:
    """Whether (K, 2) directions are one, within 0.05 degrees."""
    unit = directions / np.maximum(np.hypot(*directions.T), 1e-12)[:, None]
    mean = unit.sum(axis=0)
    mean = mean / max(float(np.hypot(*mean)), 1e-12)
    return bool(((unit @ mean) > np.cos(np.radians(0.05))).all())


def sampled(cubics: FloatArray, per: int, closed: bool) -> tuple[FloatArray, FloatArray]:
    """(K, N, 2) points and unit tangents at ``per`` places of each cubic; also at the end unless closed."""
    masters, count = cubics.shape[:2]
    x = np.arange(per) / per
    places = np.tile(x, count)
    pieces = np.repeat(np.arange(count), per)
    if not closed:
        places, pieces = np.r_[places, 1.0], np.r_[pieces, count - 1]
    chosen = cubics[:, pieces].reshape(-1, 4, 2)
    points = evaluate(chosen, np.tile(places, masters)).reshape(masters, -1, 2)
    # A chord through the neighbourhood is a direction also where a handle has no length.
    near = np.clip(places[:, None] + [-1e-3, 1e-3], 0, 1)
    ends = [evaluate(chosen, np.tile(near[:, k], masters)).reshape(masters, -1, 2) for k in (0, 1)]
    chords = ends[1] - ends[0]
    sizes = np.hypot(chords[..., 0], chords[..., 1])[..., None]
    return points, np.where(sizes > 0, chords / np.maximum(sizes, 1e-300), [1.0, 0.0])


def basis(t: FloatArray, count: int, closed: bool) -> tuple[IntArray, FloatArray, FloatArray, FloatArray]:
    """(…, 3) indices of the control points at parameters t, their weights, and first and second derivatives."""
    span = np.floor(t).astype(np.int64)
    if not closed:
        span = np.clip(span, 0, count - 1)
    x = t - span
    first = np.where((span == 0) & (not closed), 1.0, 0.5)
    last = np.where((span == count - 1) & (not closed), 1.0, 0.5)
    y = 1 - x
    weight = np.stack([first * y * y, 2 * x * y + (1 - first) * y * y + (1 - last) * x * x, last * x * x], axis=-1)
    slope = np.stack([-2 * first * y, 2 - 4 * x - 2 * (1 - first) * y + 2 * (1 - last) * x, 2 * last * x], axis=-1)
    bend = np.stack([2 * first, -4 + 2 * (1 - first) + 2 * (1 - last), 2 * last], axis=-1) + 0 * weight
    index = span[..., None] + np.arange(3)
    return (index - 1) % count if closed else index, weight, slope, bend


def spline(controls: FloatArray, t: FloatArray, count: int, closed: bool) -> tuple[FloatArray, FloatArray, FloatArray]:
    """(L, N, 2) points, first and second derivatives of splines of (L, n, 2) controls at parameters (L or 1, N)."""
    index, *weights = basis(t, count, closed)
    rows = np.arange(len(controls))[:, None, None]
    chosen = controls[rows, index]
    at, first, second = [np.squeeze(each[..., None, :] @ chosen, axis=2) for each in weights]
    return at, first, second


def footpoints(
    targets: FloatArray, controls: FloatArray, t: FloatArray, count: int, closed: bool
) -> tuple[FloatArray, FloatArray]:
    """(V, N) parameters near (N,) given ones, in their order, where splines of (V, n, 2) controls are near targets.

    Also (V, N, 2) the points there.
    """
    t = np.broadcast_to(t, targets.shape[:2])
    for _ in range(2):
        at, first, second = spline(controls, t, count, closed)
        off = at - targets
        size = (first**2).sum(axis=2)
        full = size + (off * second).sum(axis=2)
        move = (off * first).sum(axis=2) / np.where(full > 0.3 * size, full, np.maximum(size, 1e-12))
        t = t - np.clip(move, -0.4, 0.4)
        if not closed:
            t = np.clip(t, 0, count)
    if not closed:
        t = np.concatenate([np.zeros((len(t), 1)), t[:, 1:-1], np.full((len(t), 1), float(count))], axis=1)
    t = np.maximum.accumulate(t, axis=1)
    return t, spline(controls, t, count, closed)[0]


def quadratics(points: FloatArray, on: BoolArray) -> tuple[FloatArray, IntArray, BoolArray]:
    """A TrueType contour (K, N, 2) with all points on the curve explicit, from the first of them, and its degrees.

    Also (m,) whether a segment begins at an implied point.
    """
    after, on_after = np.roll(points, -1, axis=1), np.roll(on, -1)
    whole: list[FloatArray] = []
    kinds: list[str] = []
    for j in range(len(on)):
        whole.append(points[:, j])
        kinds.append("on" if on[j] else "off")
        if not on[j] and not on_after[j]:
            whole.append((points[:, j] + after[:, j]) / 2)
            kinds.append("implied")
    first = min(j for j, kind in enumerate(kinds) if kind != "off")
    whole, kinds = whole[first:] + whole[:first], kinds[first:] + kinds[:first]
    starts = [j for j, kind in enumerate(kinds) if kind != "off"]
    degrees = np.diff([*starts, len(kinds)]).astype(np.int64)
    return np.stack(whole, axis=1), degrees, np.array([kinds[j] == "implied" for j in starts])
