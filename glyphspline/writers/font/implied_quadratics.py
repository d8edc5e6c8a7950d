"""Arcs as quadratics that meet midway between their control points, fitted to cubics in all masters at once.

A TrueType contour leaves out a point on the curve that lies midway between two control points. Where only such points
are inside an arc, the arc is a quadratic B-spline of uniform knots: it has no kink there in any master, nor in any
instance, wherever its control points are rounded to.

All masters are fitted by least squares at the same parameters, so that an instance of the font is the fit of the
instance. Errors along the curve, which are invisible, count little.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from operator import attrgetter
from typing import NamedTuple

import numpy as np

from ...curves.bezier import cross, evaluate
from ...curves.nearest import near_places
from ...curves.pairing import pair_instances
from ...types import BoolArray, FloatArray, IntArray

TANGENTS = (0.1, 0.4)
"""Weights of an error along the curve against one across it. Larger: control points cannot move to where few of them
suffice. Smaller: nothing spaces them evenly, and masters that do so unlike each other have no certificate: the second
is for these."""


@dataclass(frozen=True, eq=False)
class Arc:
    """What is fitted.

    Attributes:
        cubics: (K, m, 4, 2) in the masters, which the distance is measured from.
        closed: whether the arc is a whole contour without ends.
        ends: (K, 2, 2) where it begins and ends, already rounded; not read if closed.
        straight: whether it is a line, which needs no fit.
        leaving, arriving: (K, 2) the lines before and after it, pointing into the arc, where it is to begin and end
            along them; else None.
        first, last: (K, 2) its first and last control points where they are known; else None.
        count: how many control points these were made for; with more or less of them they would be elsewhere.
    """

    cubics: FloatArray
    closed: bool
    ends: FloatArray
    straight: bool = False
    leaving: FloatArray | None = None
    arriving: FloatArray | None = None
    first: FloatArray | None = None
    last: FloatArray | None = None
    count: int | None = None


class Fitted(NamedTuple):
    """The control points of an arc: (K, n, 2) rounded, without its ends; and their certified distance from it."""

    controls: FloatArray
    distance: float


def fit(
    arc: Arc, weights: FloatArray, tolerance: float, rounded: Callable[[FloatArray, FloatArray], FloatArray],
    most: int | None = None,
) -> Fitted | None:  # fmt: skip
    """The fewest control points found within ``tolerance`` of the arc, or else the nearest found.

    Their number is doubled until they are within the tolerance, and then halved down to the least that is.

    Args:
        weights: (V, K) of the masters at the corners of the design space's grid.
        tolerance: in font units, at every location.
        rounded: control points (K, n, 2) as they are stored, from those wanted and a metric (K, 2n, 2n) of their error.
        most: control points allowed; if even these are too few, None is returned.
    """
    fitting = _Fitting(arc)
    limit = fitting.most if most is None else min(most, fitting.most)
    if limit < fitting.least:
        return None
    source = chain_of(weights, arc.cubics)
    found: list[Fitted] = []

    def near(count: int) -> bool:
        for tangent in TANGENTS:
            controls, metric, t = fitting.solve(count, tangent)
            if most is not None and fitting.off(controls, t) > tolerance:
                return False
            controls = rounded(controls, metric)
            found.append(Fitted(controls, fitting.distance(controls, t, weights, source, tolerance)))
            if found[-1].distance <= tolerance or fitting.off(controls, t) > tolerance:
                break
        return found[-1].distance <= tolerance

    if arc.count is not None:
        any(near(count) for count in (arc.count, arc.count + 1, max(arc.count - 1, fitting.least)))
        return min(found, key=attrgetter("distance"))
    low, count = fitting.least - 1, fitting.least if most is None else limit
    while not (enough := near(count)) and count < limit:
        low, count = count, min(2 * count, limit)
    if not enough and most is not None:
        return None
    while enough and count - low > 1:
        middle = (low + count) // 2
        low, count = (low, middle) if near(middle) else (middle, count)
    return min(found, key=lambda each: (max(each.distance, tolerance), each.controls.shape[1]))


def chain_of(weights: FloatArray, cubics: FloatArray) -> FloatArray:
    """(m V, 4, 2) cubics (K, m, 4, 2) with each of (V, K) weights, those of one segment together."""
    mixed = np.tensordot(weights, cubics, axes=1)
    return np.ascontiguousarray(np.swapaxes(mixed, 0, 1)).reshape(-1, 4, 2)


def as_cubics(ends: FloatArray, controls: FloatArray, closed: bool) -> FloatArray:
    """(K, n, 4, 2) the quadratics of control points (K, n, 2), which meet midway between them."""
    before = np.roll(controls, 1, axis=1) if closed else controls[:, :-1]
    nodes = (before + (controls if closed else controls[:, 1:])) / 2
    nodes = around(nodes) if closed else np.concatenate([ends[:, :1], nodes, ends[:, 1:]], axis=1)
    a, b = nodes[:, :-1], nodes[:, 1:]
    return np.stack([a, a + (controls - a) * (2 / 3), b + (controls - b) * (2 / 3), b], axis=2)


class _Fitting:
    """The samples of an arc, and how dense spans are along it."""

    def __init__(self, arc: Arc) -> None:
        self.arc = arc
        self.points, tangents = sampled(arc.cubics, 8 * max(1, -(-6 // arc.cubics.shape[1])), arc.closed)
        points, along = (around(each) if arc.closed else each for each in (self.points, tangents))
        steps, here, there = np.diff(points, axis=1), along[:, :-1], along[:, 1:]
        turns = np.abs(np.arctan2(cross(here, there), (here * there).sum(axis=2)))
        lengths = np.sqrt((steps**2).sum(axis=2).mean(axis=0)) + 1e-9  # RMS over the masters
        turn, share = np.sqrt((turns**2).mean(axis=0)), lengths / lengths.sum()
        # Spans are short where the arc turns, and none is much longer than its neighbours.
        density = np.sqrt(turn / max(turn.sum(), 1e-9) * share) + 0.1 * share
        self.places = np.concatenate([[0.0], np.cumsum(density / density.sum())])
        mass = lengths if arc.closed else np.append(lengths, 0.0) + np.append(0.0, lengths)
        self.normals = normals = np.stack([-tangents[..., 1], tangents[..., 0]], axis=-1)
        self.across = normals[..., :, None] * normals[..., None, :]
        self.mass = (mass / mass.sum())[:, None, None]
        bound = 4 if arc.closed else max(1, sum(each is not None for each in (arc.first, arc.last)))
        if arc.leaving is not None and arc.arriving is not None:
            bound = max(bound, 2)
        self.least = max(bound, int(np.ceil(turns.sum(axis=1).max() / np.radians(60))))
        self.most = max(self.least, self.points.shape[1] // 3)

    def solve(self, count: int, tangent: float) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Control points (K, n, 2) without the ends, the quadratic form of their error (K, 2n, 2n), and the (N,)
        parameters 0 … n of the samples, with the weight of errors along the curve."""
        closed = self.arc.closed
        self.metric = (tangent**2 * np.eye(2) + (1 - tangent**2) * self.across) * self.mass
        self.pull = (self.metric @ self.points[..., None])[..., 0]
        t = count * (self.places[:-1] if closed else self.places)
        for _ in range(4):  # the parameters, which all masters share, step towards the footpoints of the samples
            controls, form = self._least_squares(t, count)
            at, slope = (weight @ controls for weight in basis(t, count, closed))
            off, size = ((self.points - at) * slope).sum(axis=(0, 2)), (slope**2).sum(axis=(0, 2))
            t = ordered(t + np.clip(off / np.maximum(size, 1e-4 * size.mean() + 1e-12), -0.3, 0.3), count, closed)
        inside = slice(None) if closed else slice(1, -1)
        form = form[:, inside, :, inside].reshape(len(form), 2 * count, -1)
        # Control points that are to be on a line are dear beside it: rounding would turn the joint.
        size = 4 * np.trace(form, axis1=1, axis2=2)[:, None, None] / count
        for j, _ in self._fixed(count):
            form[:, 2 * j : 2 * j + 2, 2 * j : 2 * j + 2] += 1e6 * size * np.eye(2)
        for j, line, _ in self._held(count + 2):
            across = np.stack([-line[:, 1], line[:, 0]], axis=1) / np.maximum(np.hypot(*line.T), 1e-12)[:, None]
            form[:, 2 * j - 2 : 2 * j, 2 * j - 2 : 2 * j] += size * across[:, :, None] * across[:, None, :]
        return controls[:, inside], form, t

    def _least_squares(self, t: FloatArray, count: int) -> tuple[FloatArray, FloatArray]:
        """(K, n, 2) control points with the ends, nearest the samples at (N,) parameters, and the quadratic form."""
        arc, masters = self.arc, len(self.points)
        weight, _ = basis(t, count, arc.closed)
        n = weight.shape[1]
        pairs = (weight[:, :, None] * weight[:, None, :]).reshape(len(weight), -1)
        form = np.tensordot(pairs, self.metric, axes=(0, 1)).reshape(n, n, masters, 2, 2).transpose(2, 0, 3, 1, 4)
        right = np.tensordot(weight, self.pull, axes=(0, 1)).transpose(1, 0, 2)
        second = 2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)
        if arc.closed:
            second[-1, 0] = second[0, -1] = -1
        else:
            second[[0, -1]] = 0
        # Even control points where samples leave a choice, as about tight bends, and some where there are no samples.
        size = np.einsum("kacac->k", form)[:, None, None, None, None] / (2 * n)
        form = form + size * (1e-4 * second.T @ second + 1e-9 * np.eye(n))[:, None, :, None] * np.eye(2)[:, None, :]
        whole, known = np.zeros((masters, n, 2)), np.zeros(n, dtype=bool)
        if not arc.closed:
            whole[:, [0, -1]], known[[0, -1]] = arc.ends, True
            for j, point in self._fixed(n - 2):
                whole[:, j + 1], known[j + 1] = point, True
        whole = _solved(form, right, whole, known)
        for j, line, end in self._held(n):
            along = ((whole[:, j] - end) * line).sum(axis=1)
            size = (line**2).sum(axis=1)
            if not parallel(line):  # one length for all masters: only so the joint has no turn between them either
                along, size = along.sum(keepdims=True), size.sum(keepdims=True)
            whole[:, j] = end + np.maximum(along / np.maximum(size, 1e-12), 0.0)[:, None] * line
            known[j] = True
        return (_solved(form, right, whole, known) if self._held(n) else whole), form

    def _fixed(self, count: int) -> list[tuple[int, FloatArray]]:
        """The control points that are the source's: number and place."""
        ends = ((0, self.arc.first), (count - 1, self.arc.last))
        return [(j, point) for j, point in ends if point is not None]

    def _held(self, n: int) -> list[tuple[int, FloatArray, FloatArray]]:
        """The control points that are to be on the lines before and after the arc: index, line and end."""
        arc = self.arc
        lines = ((1, arc.leaving, arc.first, 0), (n - 2, arc.arriving, arc.last, 1))
        return [(j, line, arc.ends[:, side]) for j, line, fixed, side in lines if line is not None and fixed is None]

    def off(self, controls: FloatArray, t: FloatArray) -> float:
        """The largest distance of samples from the quadratics across these, in any master."""
        whole = controls if self.arc.closed else np.concatenate(
            [self.arc.ends[:, :1], controls, self.arc.ends[:, 1:]], axis=1
        )  # fmt: skip
        weight, _ = basis(t, controls.shape[1], self.arc.closed)
        return float(np.abs(((weight @ whole - self.points) * self.normals).sum(axis=2)).max())

    def distance(
        self, controls: FloatArray, t: FloatArray, weights: FloatArray, source: FloatArray, tolerance: float
    ) -> float:
        """A bound of the distance of control points from the ``source`` at every location, certified up to tolerance.

        Args:
            t: parameters of the samples. source: the arc's cubics at the corners of the grid, (V, K) ``weights``.
        """
        arc, count, m, V = self.arc, controls.shape[1], self.arc.cubics.shape[1], len(weights)
        result = chain_of(weights, as_cubics(arc.ends, controls, arc.closed))
        every = np.arange(len(t)) / (len(t) / m if arc.closed else (len(t) - 1) / m)
        if arc.closed:
            t, every = np.concatenate([t - count, t, t + count]), np.concatenate([every - m, every, every + m])
        begins = np.arange(float(count))
        places = np.interp(begins if arc.closed else begins[1:], t, every)
        begins = result if arc.closed else result[V:]
        if len(places):
            near_places(V, source, places, begins, arc.closed, 0.0, float(m), places)
        if arc.closed:
            places += m * np.ceil(max(-places[0], 0.0) / m) - m * np.floor(max(places[0], 0.0) / m)
        else:
            places = np.append(0.0, places)
        anchors = np.column_stack([np.arange(count + 1.0), np.append(places, places[0] + m)])
        limits = np.tile((-np.inf, np.inf, -np.inf, np.inf) if arc.closed else (0.0, count, 0.0, m), (count, 1))
        bounds, ends = np.full(count, np.nan), [np.array([0, each]) for each in (count, m, count + 1)]
        pair_instances(
            V, result, ends[0], source, ends[1], anchors, ends[2], limits, 0.0, tolerance, bounds, np.zeros(count)
        )
        return float(bounds.max())


def _solved(form: FloatArray, right: FloatArray, whole: FloatArray, known: BoolArray) -> FloatArray:
    """The control points (K, n, 2) of least error; those ``known`` stay as they are."""
    found, free = whole.copy(), ~known
    if free.any():
        rest = right[:, free] - np.einsum("kacbd,kbd->kac", form[:, free][:, :, :, known], whole[:, known])
        size = 2 * int(free.sum())
        left = form[:, free][:, :, :, free].reshape(len(form), size, size)
        found[:, free] = np.linalg.solve(left, rest.reshape(len(form), size, 1)).reshape(len(form), -1, 2)
    return found


def around(points: FloatArray) -> FloatArray:
    """(K, N + 1, 2) points with the first again at the end."""
    return np.concatenate([points, points[:, :1]], axis=1)


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
    places, pieces = np.tile(np.arange(per) / per, count), np.repeat(np.arange(count), per)
    if not closed:
        places, pieces = np.append(places, 1.0), np.append(pieces, count - 1)
    chosen = cubics[:, pieces].reshape(-1, 4, 2)
    # A chord through the neighbourhood is a direction also where a handle has no length.
    before, points, after = (
        evaluate(chosen, np.tile(np.clip(places + move, 0, 1), masters)).reshape(masters, -1, 2)
        for move in (-1e-3, 0.0, 1e-3)
    )
    chords = after - before
    sizes = np.hypot(chords[..., 0], chords[..., 1])[..., None]
    return points, np.where(sizes > 0, chords / np.maximum(sizes, 1e-300), [1.0, 0.0])


def local_basis(t: FloatArray, count: int, closed: bool) -> tuple[FloatArray, FloatArray, IntArray]:
    """(…, 3) weights of the control points that count at parameters (…,), the weights' derivatives, and which points
    these are.
    """
    span = np.floor(t).astype(np.int64)
    if not closed:
        span = np.clip(span, 0, count - 1)
    x = t - span
    first = np.where((span == 0) & (not closed), 1.0, 0.5)
    last = np.where((span == count - 1) & (not closed), 1.0, 0.5)
    y = 1 - x
    weight = [first * y * y, 2 * x * y + (1 - first) * y * y + (1 - last) * x * x, last * x * x]
    slope = [-2 * first * y, 2 - 4 * x - 2 * (1 - first) * y + 2 * (1 - last) * x, 2 * last * x]
    index = span[..., None] + np.arange(3)
    return np.stack(weight, axis=-1), np.stack(slope, axis=-1), (index - 1) % count if closed else index


def basis(t: FloatArray, count: int, closed: bool) -> tuple[FloatArray, FloatArray]:
    """(N, n) weights of the control points at parameters (N,), and the weights' derivatives."""
    weight, slope, index = local_basis(t, count, closed)
    found = np.zeros((2, *t.shape, count if closed else count + 2))
    for values, own in zip((weight, slope), found, strict=True):
        np.put_along_axis(own, index, values, -1)
    return found[0], found[1]
