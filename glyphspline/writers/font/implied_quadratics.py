"""Arcs as quadratics that meet midway between their control points, fitted to cubics in all masters at once.

A TrueType contour leaves out a point on the curve that lies midway between two control points. Where only such points
are inside an arc, the arc is a quadratic B-spline of uniform knots: it has no kink there in any master, nor in any
instance, wherever its control points are rounded to.

All masters are fitted by least squares at the same parameters, so that an instance of the font is the fit of the
instance. Errors along the curve, which nobody sees, count little.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...curves.bezier import cross, evaluate
from ...types import BoolArray, FloatArray, IntArray

TANGENT = 0.1
"""Weight of an error along the curve against one across it. Larger: control points cannot move to where few of them
suffice. Smaller: nothing spaces them evenly."""

STEEPEST = 0.7
"""Change of the length of a span per unit of length, at most: neighbours that meet midway are of like size."""

SAMPLES = 8
"""Samples of a cubic to which an arc is fitted; the distance is measured at four times as many."""

EVEN = 1e-4
"""Weight of second differences of control points. Smaller: rounds around tight bends do not settle."""

ROUNDS = 3
"""Least-squares fits, each followed by a step of the parameters towards the footpoints of the samples."""


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
    """The fewest control points found within ``tolerance`` of the arc, or else the nearest found.

    Their number is doubled until they are within the tolerance, and then halved down to the least that is.

    Args:
        weights: (V, K) of the masters at the locations where the distance is measured.
        tolerance: in font units.
        rounded: control points (K, n, 2) as they are stored, from those wanted and a metric (K, 2n, 2n) of their error.
    """
    fitting = _Fitting(arc)
    found: list[Fitted] = []

    def near(count: int) -> bool:
        controls, metric, t = fitting.solve(count)
        controls = rounded(controls, metric)
        mixed = np.einsum("vk,knc->vnc", weights, controls)
        legs = np.diff(np.concatenate([mixed, mixed[:, :1]], axis=1) if arc.closed else mixed, axis=1)
        shortest = float(np.hypot(legs[..., 0], legs[..., 1]).min(initial=np.inf) / 2)
        found.append(Fitted(controls, fitting.distance(controls, t, weights), shortest))
        return found[-1].distance <= tolerance

    low, count = fitting.least - 1, fitting.least
    while not (enough := near(count)) and count < fitting.most:
        low, count = count, min(2 * count, fitting.most)
    while enough and count - low > 1:
        middle = (low + count) // 2
        low, count = (low, middle) if near(middle) else (middle, count)
    return min(found, key=lambda each: (max(each.distance, tolerance), each.controls.shape[1]))


class _Fitting:
    """The samples of an arc, and how dense spans are along it."""

    def __init__(self, arc: Arc) -> None:
        self.arc = arc
        self.per = SAMPLES * max(1, -(-6 // arc.cubics.shape[1]))
        self.points, tangents = sampled(arc.cubics, self.per, arc.closed)
        points, along = self.points, tangents
        if arc.closed:
            points, along = (np.concatenate([each, each[:, :1]], axis=1) for each in (points, along))
        steps, here, there = np.diff(points, axis=1), along[:, :-1], along[:, 1:]
        turns = np.abs(np.arctan2(cross(here, there), (here * there).sum(axis=2)))
        lengths = np.sqrt((steps**2).sum(axis=2).mean(axis=0)) + 1e-9  # RMS over the masters
        turn = np.sqrt((turns**2).mean(axis=0))
        share = lengths / lengths.sum()
        density = (turn / max(turn.sum(), 1e-9)) ** 0.7 * share**0.3 + 0.3 * share
        self.lengths, self.density = lengths, density / density.sum()
        mass = lengths if arc.closed else (np.r_[lengths, 0.0] + np.r_[0.0, lengths])
        x, y = tangents[..., 0], tangents[..., 1]
        across = np.stack([np.stack([y * y, -x * y], -1), np.stack([-x * y, x * x], -1)], -2)
        self.metric = (TANGENT**2 * np.eye(2) + (1 - TANGENT**2) * across) * (mass / mass.sum())[:, None, None]
        bound = 4 if arc.closed else 1 + (arc.leaving is not None and arc.arriving is not None)
        self.least = max(bound, int(np.ceil(turns.sum(axis=1).max() / np.radians(60))))
        self.most = max(self.least, self.points.shape[1] // 3)

    def _start(self, count: int) -> FloatArray:
        """(N,) parameters 0 … n of the samples: spans of the density, graded."""
        lengths = self.lengths
        at = np.cumsum(lengths) - lengths / 2
        gap = np.abs(at[:, None] - at)
        if self.arc.closed:
            gap = np.minimum(gap, lengths.sum() - gap)
        spans = lengths / (lengths / (count * self.density) + STEEPEST * gap).min(axis=1)
        along = np.r_[0.0, np.cumsum(spans) * (count / spans.sum())]
        return along[:-1] if self.arc.closed else ordered(along, count, False)

    def solve(self, count: int) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Control points (K, n, 2) without the ends, the quadratic form of their error (K, 2n, 2n), and the (N,)
        parameters 0 … n of the samples."""
        arc = self.arc
        t = self._start(count)
        for _ in range(ROUNDS):
            controls, form = self._least_squares(t, count)
            t = self._towards_footpoints(t, controls)
        inside = slice(None) if arc.closed else slice(1, -1)
        form = form[:, inside, :, inside].reshape(len(form), 2 * count, -1)
        return controls[:, inside], form + self._beside_lines(form), t

    def _least_squares(self, t: FloatArray, count: int) -> tuple[FloatArray, FloatArray]:
        """(K, n, 2) control points with the ends, nearest the samples at (N,) parameters, and the quadratic form."""
        arc, masters = self.arc, len(self.points)
        index, weight, _ = basis(t, count, arc.closed)
        n = count + (0 if arc.closed else 2)
        form, right = np.zeros((n, n, masters, 2, 2)), np.zeros((n, masters, 2))
        pairs = weight[:, :, None] * weight[:, None, :]
        metric = self.metric.transpose(1, 0, 2, 3)  # (N, K, 2, 2)
        wanted = (self.metric @ self.points[..., None])[..., 0].transpose(1, 0, 2)
        np.add.at(form, (index[:, :, None], index[:, None, :]), pairs[..., None, None, None] * metric[:, None, None])
        np.add.at(right, index, weight[..., None, None] * wanted[:, None])
        form, right = form.transpose(2, 0, 3, 1, 4), right.transpose(1, 0, 2)
        second = 2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)
        if arc.closed:
            second[-1, 0] = second[0, -1] = -1
        else:
            second[[0, -1]] = 0
        size = np.einsum("kacac->k", form)[:, None, None, None, None] / (2 * n)
        even = EVEN * second.T @ second + 1e-9 * np.eye(n)  # the latter for what no sample sees
        form = form + size * even[:, None, :, None] * np.eye(2)[:, None, :]
        whole = np.zeros((masters, n, 2))
        known = np.zeros(n, dtype=bool)
        if not arc.closed:
            whole[:, [0, -1]], known[[0, -1]] = arc.ends, True
        whole = _solved(form, right, whole, known)
        for j, line, end in self._held(n):
            along = ((whole[:, j] - end) * line).sum(axis=1) / np.maximum((line**2).sum(axis=1), 1e-12)
            if not parallel(line):  # one length for all masters: only so the joint has no turn between them either
                along = np.full(masters, ((whole[:, j] - end) * line).sum() / max(float((line**2).sum()), 1e-12))
            whole[:, j], known[j] = end + np.maximum(along, 0.0)[:, None] * line, True
        return (_solved(form, right, whole, known) if known[1:-1].any() else whole), form

    def _towards_footpoints(self, t: FloatArray, controls: FloatArray) -> FloatArray:
        """A step of the parameters (N,), which all masters share, towards the footpoints of the samples."""
        closed = self.arc.closed
        count = controls.shape[1] - (0 if closed else 2)
        at, slope = spline(controls, t[None], count, closed)
        off, size = ((self.points - at) * slope).sum(axis=(0, 2)), (slope**2).sum(axis=(0, 2))
        t = t + np.clip(off / np.maximum(size, 1e-4 * size.mean() + 1e-12), -0.3, 0.3)
        return ordered(t, count, closed)

    def _held(self, n: int) -> list[tuple[int, FloatArray, FloatArray]]:
        """The control points that are to be on the lines before and after the arc: index, line and end."""
        lines = ((1, self.arc.leaving, 0), (n - 2, self.arc.arriving, 1))
        return [(j, line, self.arc.ends[:, side]) for j, line, side in lines if line is not None]

    def _beside_lines(self, form: FloatArray) -> FloatArray:
        """A penalty on control points beside the lines that they are to be on: rounding would turn the joint."""
        penalty = np.zeros_like(form)
        count = form.shape[1] // 2
        for j, line, _ in self._held(count + 2):
            across = np.stack([-line[:, 1], line[:, 0]], axis=1) / np.maximum(np.hypot(*line.T), 1e-12)[:, None]
            block = slice(2 * j - 2, 2 * j)
            size = np.trace(form, axis1=1, axis2=2)[:, None, None] / count
            penalty[:, block, block] += 4 * size * across[:, :, None] * across[:, None, :]
        return penalty

    def distance(self, controls: FloatArray, t: FloatArray, weights: FloatArray) -> float:
        """The largest distance from the cubics at locations (V, K), from samples.

        Each location has its own footpoints; they run forward along the arc, so that the distance is one in both
        directions, up to what lies between two samples.
        """
        arc, count, closed = self.arc, controls.shape[1], self.arc.closed
        if not closed:
            controls = np.concatenate([arc.ends[:, :1], controls, arc.ends[:, 1:]], axis=1)
        targets = np.einsum("vk,knc->vnc", weights, sampled(arc.cubics, 4 * self.per, closed)[0])
        mixed = np.einsum("vk,knc->vnc", weights, controls)
        known = np.r_[t, t[0] + count] if closed else t
        at = np.broadcast_to(
            np.interp(np.arange(targets.shape[1]) / 4, np.arange(len(known)), known), targets.shape[:2]
        )
        for _ in range(3):
            points, slope = spline(mixed, at, count, closed)
            size = (slope**2).sum(axis=2)
            move = ((targets - points) * slope).sum(axis=2) / np.maximum(size, 1e-12)
            at = ordered(at + np.clip(move, -0.4, 0.4), count, closed)
        far = np.hypot(*np.moveaxis(spline(mixed, at, count, closed)[0] - targets, -1, 0)).max()
        # Of the spline between these places, the distance from the chord.
        if closed:
            at, targets = np.c_[at, at[:, :1] + count], np.concatenate([targets, targets[:, :1]], axis=1)
        arms = np.diff(targets, axis=1)
        for share in (0.25, 0.5, 0.75):
            off = spline(mixed, (1 - share) * at[:, :-1] + share * at[:, 1:], count, closed)[0] - targets[:, :-1]
            x = np.clip((off * arms).sum(axis=2) / np.maximum((arms**2).sum(axis=2), 1e-12), 0, 1)
            far = max(far, np.hypot(*np.moveaxis(off - x[..., None] * arms, -1, 0)).max())
        return float(far)


def _solved(form: FloatArray, right: FloatArray, whole: FloatArray, known: BoolArray) -> FloatArray:
    """The control points (K, n, 2) of least error, of which those ``known`` stay as they are."""
    found, free = whole.copy(), ~known
    if free.any():
        rest = right[:, free] - np.einsum("kacbd,kbd->kac", form[:, free][:, :, :, known], whole[:, known])
        size = 2 * int(free.sum())
        left = form[:, free][:, :, :, free].reshape(len(form), size, size)
        found[:, free] = np.linalg.solve(left, rest.reshape(len(form), size, 1)).reshape(len(form), -1, 2)
    return found


def ordered(t: FloatArray, count: int, closed: bool) -> FloatArray:
    """Parameters (…, N) that never run back, and of an arc with ends from 0 to ``count``."""
    if not closed:
        t = np.clip(t, 0, count)
        t[..., 0], t[..., -1] = 0, count
    return np.asarray(np.maximum.accumulate(t, axis=-1))


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


def basis(t: FloatArray, count: int, closed: bool) -> tuple[IntArray, FloatArray, FloatArray]:
    """(…, 3) indices of the control points at parameters t, their weights, and the weights' derivatives."""
    span = np.floor(t).astype(np.int64)
    if not closed:
        span = np.clip(span, 0, count - 1)
    x = t - span
    first = np.where((span == 0) & (not closed), 1.0, 0.5)
    last = np.where((span == count - 1) & (not closed), 1.0, 0.5)
    y = 1 - x
    weight = np.stack([first * y * y, 2 * x * y + (1 - first) * y * y + (1 - last) * x * x, last * x * x], axis=-1)
    slope = np.stack([-2 * first * y, 2 - 4 * x - 2 * (1 - first) * y + 2 * (1 - last) * x, 2 * last * x], axis=-1)
    index = span[..., None] + np.arange(3)
    return (index - 1) % count if closed else index, weight, slope


def spline(controls: FloatArray, t: FloatArray, count: int, closed: bool) -> tuple[FloatArray, FloatArray]:
    """(L, N, 2) points and first derivatives of splines of (L, n, 2) controls at parameters (L or 1, N)."""
    index, *weights = basis(t, count, closed)
    chosen = controls[np.arange(len(controls))[:, None, None], index]
    at, slope = [np.squeeze(each[..., None, :] @ chosen, axis=2) for each in weights]
    return at, slope
