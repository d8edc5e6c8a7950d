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

import numpy as np

from ...curves.bezier import cross, evaluate
from ...types import BoolArray, FloatArray, IntArray

TANGENT = 0.1
"""Weight of an error along the curve against one across it. Larger: control points cannot move to where few of them
suffice. Smaller: nothing spaces them evenly."""


@dataclass(frozen=True, eq=False)
class Arc:
    """What is fitted.

    Attributes:
        cubics: (K, m, 4, 2) in the masters. closed: whether the arc is a whole contour without ends.
        ends: (K, 2, 2) where it begins and ends, already rounded; not read if closed.
        straight: whether it is a line, which needs no fit.
        leaving, arriving: (K, 2) the lines before and after it, pointing into the arc, where it is to begin and end
            along them; else None.
        source: (K, s, 4, 2) what the distance is measured from, if that is not ``cubics``.
        first, last: (K, 2) its first and last control points where they are to be the source's; else None.
    """

    cubics: FloatArray
    closed: bool
    ends: FloatArray
    straight: bool = False
    leaving: FloatArray | None = None
    arriving: FloatArray | None = None
    source: FloatArray | None = None
    first: FloatArray | None = None
    last: FloatArray | None = None


@dataclass(frozen=True, eq=False)
class Fitted:
    """The control points of an arc: (K, n, 2) rounded, without its ends.

    Also their largest distance from the source, their shortest leg at an implied point at any location, and near which
    (n,) places of the source the quadratics begin, counted in its cubics.
    """

    controls: FloatArray
    distance: float
    shortest: float
    places: FloatArray


def fit(
    arc: Arc, weights: FloatArray, tolerance: float, rounded: Callable[[FloatArray, FloatArray], FloatArray],
    most: int | None = None,
) -> Fitted | None:  # fmt: skip
    """The fewest control points found within ``tolerance`` of the arc, or else the nearest found.

    Their number is doubled until they are within the tolerance, and then halved down to the least that is.

    Args:
        weights: (V, K) of the masters at the locations where the distance is measured.
        tolerance: in font units.
        rounded: control points (K, n, 2) as they are stored, from those wanted and a metric (K, 2n, 2n) of their error.
        most: control points allowed; if even these are too few, None is returned.
    """
    fitting = _Fitting(arc)
    limit = fitting.most if most is None else min(most, fitting.most)
    if limit < fitting.least:
        return None
    found: list[Fitted] = []

    def near(count: int) -> bool:
        controls, metric, t = fitting.solve(count)
        controls = rounded(controls, metric)
        mixed = np.einsum("vk,knc->vnc", weights, controls)
        legs = np.diff(np.concatenate([mixed, mixed[:, :1]], axis=1) if arc.closed else mixed, axis=1)
        shortest = float(np.hypot(legs[..., 0], legs[..., 1]).min(initial=np.inf) / 2)
        far, places = fitting.distance(controls, t, weights)
        found.append(Fitted(controls, far, shortest, places))
        return found[-1].distance <= tolerance

    low, count = fitting.least - 1, fitting.least
    while not (enough := near(count)) and count < limit:
        low, count = count, min(2 * count, limit)
    if not enough and most is not None:
        return None
    while enough and count - low > 1:
        middle = (low + count) // 2
        low, count = (low, middle) if near(middle) else (middle, count)
    return min(found, key=lambda each: (max(each.distance, tolerance), each.controls.shape[1]))


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
        self.shares = np.concatenate([[0.0], np.cumsum(share)])  # of the length, at the samples
        self._targets: tuple[FloatArray, FloatArray] | None = None
        mass = lengths if arc.closed else np.append(lengths, 0.0) + np.append(0.0, lengths)
        normals = np.stack([-tangents[..., 1], tangents[..., 0]], axis=-1)
        across = normals[..., :, None] * normals[..., None, :]
        self.metric = (TANGENT**2 * np.eye(2) + (1 - TANGENT**2) * across) * (mass / mass.sum())[:, None, None]
        bound = 4 if arc.closed else 1 + sum(each is not None for each in (arc.first, arc.last))
        if arc.leaving is not None and arc.arriving is not None:
            bound = max(bound, 2)
        self.least = max(bound, int(np.ceil(turns.sum(axis=1).max() / np.radians(60))))
        self.most = max(self.least, self.points.shape[1] // 3)

    def solve(self, count: int) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Control points (K, n, 2) without the ends, the quadratic form of their error (K, 2n, 2n), and the (N,)
        parameters 0 … n of the samples."""
        closed = self.arc.closed
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
        form = np.einsum("ia,ib,kicd->kacbd", weight, weight, self.metric, optimize=True)
        right = np.einsum("ia,kicd,kid->kac", weight, self.metric, self.points, optimize=True)
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

    def targets(self, weights: FloatArray) -> tuple[FloatArray, FloatArray]:
        """(V, N, 2) samples of the source at locations (V, K), and the (N,) places at which they are, ascending.

        Of a closed curve the first is near where the cubics begin.
        """
        if self._targets is None:
            source, closed = self.arc.cubics if self.arc.source is None else self.arc.source, self.arc.closed
            per = 8 * max(1, -(-20 // source.shape[1]))
            samples = sampled(source, per, closed)[0]
            begin = 0
            if closed:
                begin = int(((samples - self.arc.cubics[:, :1, 0]) ** 2).sum(axis=(0, 2)).argmin())
                samples = np.roll(samples, -begin, axis=1)
            self._targets = np.tensordot(weights, samples, axes=1), (begin + np.arange(samples.shape[1])) / per
        return self._targets

    def distance(self, controls: FloatArray, t: FloatArray, weights: FloatArray) -> tuple[float, FloatArray]:
        """The largest distance from the source at locations (V, K), from samples; near which (n,) places of it the
        quadratics begin.

        Each location has its own footpoints; they run forward along the arc, so that the distance is one in both
        directions, up to what lies between two samples.
        """
        arc, count, closed = self.arc, controls.shape[1], self.arc.closed
        if not closed:
            controls = np.concatenate([arc.ends[:, :1], controls, arc.ends[:, 1:]], axis=1)
        targets, places = self.targets(weights)
        mixed = np.tensordot(weights, controls, axes=1)
        steps = np.sqrt((np.diff(around(targets) if closed else targets, axis=1) ** 2).sum(axis=2).mean(axis=0)) + 1e-9
        shares = np.concatenate([[0.0], np.cumsum(steps / steps.sum())])[: targets.shape[1]]
        at = np.interp(shares, self.shares, np.append(t, t[0] + count) if closed else t)
        at = np.broadcast_to(at, targets.shape[:2])
        for _ in range(4):
            points, slope = at_parameters(mixed, at, count, closed)
            move = ((targets - points) * slope).sum(axis=2) / np.maximum((slope**2).sum(axis=2), 1e-12)
            at = ordered(at + np.clip(move, -0.4, 0.4), count, closed)
        far = np.linalg.norm(at_parameters(mixed, at, count, closed)[0] - targets, axis=2).max()
        # Of the spline between these places, the distance from the chord.
        if closed:
            at, targets = np.c_[at, at[:, :1] + count], around(targets)
            places = np.append(places, places[0] + (self.arc.cubics if arc.source is None else arc.source).shape[1])
        arms = np.diff(targets, axis=1)
        for share in (0.25, 0.5, 0.75):
            between = (1 - share) * at[:, :-1] + share * at[:, 1:]
            off = at_parameters(mixed, between, count, closed)[0] - targets[:, :-1]
            x = np.clip((off * arms).sum(axis=2) / np.maximum((arms**2).sum(axis=2), 1e-12), 0, 1)
            far = max(far, np.linalg.norm(off - x[..., None] * arms, axis=2).max())
        middle = at.mean(axis=0)
        begins = np.arange(float(count))
        early = begins < middle[0] if closed else np.zeros(count, dtype=bool)  # they are at the end of the lap
        laps = early * (places[-1] - places[0])
        return float(far), np.interp(begins + count * early, middle, places) - laps


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


def at_parameters(controls: FloatArray, t: FloatArray, count: int, closed: bool) -> tuple[FloatArray, FloatArray]:
    """(V, N, 2) points and derivatives of splines (V, n, 2), each at its own parameters (V, N)."""
    weight, slope, index = local_basis(t, count, closed)
    own = controls[np.arange(len(controls))[:, None, None], index]
    return (weight[..., None] * own).sum(axis=2), (slope[..., None] * own).sum(axis=2)


def basis(t: FloatArray, count: int, closed: bool) -> tuple[FloatArray, FloatArray]:
    """(N, n) weights of the control points at parameters (N,), and the weights' derivatives."""
    weight, slope, index = local_basis(t, count, closed)
    found = np.zeros((2, *t.shape, count if closed else count + 2))
    for values, own in zip((weight, slope), found, strict=True):
        np.put_along_axis(own, index, values, -1)
    return found[0], found[1]
