"""The least moves of handles and nodes after which joints turn, and their curvature jumps, by no more than they may.

All points that may move, in all masters, are found together. The curves are to stay where they are: the sum of squares
of what samples move across them is least. At places of the design space, the masters, the axes and pairs of axes
between them, turns and jumps are bounded; they are no linear functions of the points, so that the bounds are linearised
and the problem is solved again. Its dual has one unknown a bound and is one of least squares with no negative ones.

What comes out is put on the grid, handle by handle and master by master, each where joints turn least.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..checks.segments import end_curvature
from ..compiled import compiled
from ..curves.bezier import cross
from ..types import BoolArray, ComplexArray, FloatArray, IntArray
from .grid import LEAST, Rounding, settle
from .joints import EXACT, Layout
from .state import Design

SAMPLES = np.linspace(0.0, 1.0, 9)[1:-1]
"""Parameters of a segment at which it is to stay where it is."""

NODE = 4.0
"""Price of the square of a node's move, as a share of a handle's."""

ROUNDS = 16
"""Linearised problems that are solved; turns of a few degrees change by less than 1 % in the eighth, those of handles
of two units, which move by little at once, in the last."""

HOPELESS, FAR, STUCK = 5, 2.0, 0.95
"""Rounds after which the search ends where values are still so many times what they may be, and two rounds more made
this no less than that share of it: of 527 searches in four fonts, none that succeeded."""

ROOM = 0.3
"""Share of a master's shortest handle by which its points move at most at once."""

NEAR = 0.5
"""Share of a bound from which a value counts as near it, in the rest of the search too."""

SETTLED = 1e-3
"""Radians, or share of curvature, by which bounds may be missed."""

STILL = 1e-3
"""Steps of the grid by which points move at most in a round that is the last one: bounds may contradict each other."""

SOFT = 1e-9
"""Share of the dual's diagonal that is added to it, for the same reason."""

HELD, LAST = 0.7, 0.8
"""Shares of the tolerance by which samples of curves move at most: before rounding, which adds to it, and after."""

WORST = 16
"""Samples and coordinates at most, those that move by the most too much, that a round bounds besides others."""

STIFF = 0.1
"""Price of the square of a handle's move against the mean square of what curves move."""


class Bound(NamedTuple):
    """What one joint may turn, or its curvature jump, at L places.

    Attributes:
        joint: number of the segment that begins there. points: (5,) numbers of the points around it: two before, the
            node and two behind. is_jump: whether curvature is bounded, as a share of the larger one in the beginning.
        most: (L,) absolute values in radians, or shares. per: (L,) by what values are divided: 1, or curvatures.
    """

    joint: int
    points: IntArray
    is_jump: bool
    most: FloatArray
    per: FloatArray


def turns_at(points: FloatArray) -> FloatArray:
    """(…,) radians by which joints (…, 5, 2) turn."""
    a, b = points[..., 2, :] - points[..., 1, :], points[..., 3, :] - points[..., 2, :]
    turns: FloatArray = np.arctan2(cross(a, b), (a * b).sum(axis=-1))
    return turns


def jumps_at(points: FloatArray) -> FloatArray:
    """(…,) by how much curvature is larger behind joints (…, 5, 2) of cubics than before."""
    return _curvature(points[..., 2:, :]) + _curvature(points[..., 2::-1, :])


def curvatures_at(points: FloatArray) -> FloatArray:
    """(2, …) curvatures before and behind joints (…, 5, 2) of cubics."""
    return np.stack([-_curvature(points[..., 2::-1, :]), _curvature(points[..., 2:, :])])


def _turned(v: FloatArray) -> FloatArray:
    """Vectors (…, 2) turned to the left."""
    return np.stack([-v[..., 1], v[..., 0]], axis=-1)


@np.errstate(divide="ignore", invalid="ignore")
def _curvature(points: FloatArray) -> FloatArray:
    """(…,) curvature where a cubic begins, from its first three points (…, 3, 2)."""
    a, c = points[..., 1, :] - points[..., 0, :], points[..., 2, :] - points[..., 1, :]
    value: FloatArray = 2 / 3 * cross(a, c) / np.hypot(a[..., 0], a[..., 1]) ** 3
    return value


@compiled
def bounded(
    points: ComplexArray, joints: IntArray, is_jump: BoolArray, weights: FloatArray, per: FloatArray
) -> tuple[FloatArray, ComplexArray]:
    """(B, L) turns in radians and jumps, as shares of ``per``, and (B, L, 5) the points around joints at each place.

    Args:
        points: (K, N). joints: (B, 5) numbers of points. weights: (L, K) of the masters at the places. per: (B, L).
    """
    values, around = np.empty(per.shape), np.zeros((*per.shape, 5), dtype=np.complex128)
    for b in range(len(joints)):
        for m in range(len(weights)):
            for k in range(len(points)):
                if weights[m, k] != 0:
                    for i in range(5):
                        around[b, m, i] += weights[m, k] * points[k, joints[b, i]]
            at = around[b, m]
            if is_jump[b]:
                value = end_curvature(at[2], at[3], at[4]) + end_curvature(at[2], at[1], at[0])
            else:
                both = (at[2] - at[1]).conjugate() * (at[3] - at[2])
                value = np.arctan2(both.imag, both.real)
            values[b, m] = value / per[b, m]
    return values, around


@compiled
def slopes_of(
    around: ComplexArray, which: IntArray, place: IntArray, scale: FloatArray, joints: IntArray, is_jump: BoolArray,
    weights: FloatArray, spread: FloatArray,
) -> FloatArray:  # fmt: skip
    """(R, K, 2 S) derivatives of what :func:`bounded` has, by moves of points, times a scale (R,).

    Args:
        around: (B, L, 5). which, place: (R,) numbers of bounds and places. spread: (N, S).
    """
    count = spread.shape[1]
    found, slope = np.zeros((len(which), weights.shape[1], 2 * count)), np.empty(5, dtype=np.complex128)
    own = np.empty(count, dtype=np.complex128)
    for row in range(len(which)):
        b, at = which[row], around[which[row], place[row]]
        slope[:] = 0
        if is_jump[b]:
            for way in (-1, 1):
                a, c = at[2 + way] - at[2], at[2 + 2 * way] - at[2 + way]
                size = abs(a)
                by_c = 2 / 3 * 1j * a / size**3
                by_a = -2 / 3 * 1j * c / size**3 - 3 * end_curvature(at[2], at[2 + way], at[2 + 2 * way]) * a / size**2
                slope[2] -= by_a
                slope[2 + way] += by_a - by_c
                slope[2 + 2 * way] += by_c
        else:
            a, c = at[2] - at[1], at[3] - at[2]
            slope[1], slope[3] = 1j * a / (a * a.conjugate()).real, 1j * c / (c * c.conjugate()).real
            slope[2] = -slope[1] - slope[3]
        own[:] = 0
        for i in range(5):
            for s in range(count):
                own[s] += scale[row] * spread[joints[b, i], s] * slope[i]
        for k in range(weights.shape[1]):
            w = weights[place[row], k]
            if w != 0:
                for s in range(count):
                    found[row, k, 2 * s], found[row, k, 2 * s + 1] = w * own[s].real, w * own[s].imag
    return found


class _Arrays(NamedTuple):
    """Several :class:`Bound`, attribute by attribute."""

    joints: IntArray
    is_jump: BoolArray
    most: FloatArray
    per: FloatArray

    @classmethod
    def of(cls, bounds: Sequence[Bound]) -> _Arrays:
        """Put them together."""
        _, joints, is_jump, most, per = zip(*bounds, strict=True)
        return cls(np.array(joints), np.array(is_jump), np.array(most), np.array(per))


def _complex(points: FloatArray) -> ComplexArray:
    """(…,) points as complex numbers, from (…, 2)."""
    return np.ascontiguousarray(points).view(np.complex128)[..., 0]


class Stretch:
    """Some points of a contour that may move in all masters, and the joints that must stay or become smooth.

    Attributes:
        free: (S,) numbers of the points. spread: (N, S) how all points move with them. frozen: (K, S, 2) coordinates
            that stay, in which a handle is level. joints: numbers of those that are touched. samples: (R, K, 2 S) what
            samples of curves move across them by the points' moves, at the corners of the design space and, of two
            corners that slip along their curves apart, between them, as :mod:`.slip` has it.
    """

    def __init__(self, layout: Layout, free: Sequence[int], design: Design) -> None:
        self.layout, self.free, self.design = layout, np.array(sorted(set(free))), design
        self.places = np.ascontiguousarray(design.places)
        count = layout.points.shape[1]
        self.spread = np.zeros((count, len(self.free)))
        self.spread[self.free, np.arange(len(self.free))] = 1.0
        at = np.flatnonzero(layout.implied)
        self.spread[at] = (self.spread[at - 1] + self.spread[(at + 1) % count]) / 2
        self.frozen = layout.frozen[:, self.free]
        moved: BoolArray = np.asarray(self.spread.any(axis=1))
        nodes = layout.starts
        touched = moved[nodes - 1] | moved[nodes] | moved[(nodes + 1) % count]
        self.joints = np.flatnonzero(touched & ~layout.implied[nodes])
        corners = design.corners
        one, other = (each[::-1] for each in np.tril_indices(len(corners)))
        rows, squares, old = (
            [],
            np.zeros((len(corners), *2 * (2 * len(self.free),))),
            np.tensordot(corners, layout.points, axes=1),
        )
        for segment, degree in enumerate(layout.degrees.tolist()):
            own = (nodes[segment] + np.arange(degree + 1)) % count
            if moved[own].any():
                basis, slopes = _BASES[degree]
                along = slopes @ old[:, own]
                size = np.hypot(along[..., 0], along[..., 1])[..., None]
                across = (basis @ self.spread[own])[None, :, :, None] * _turned(along)[:, :, None]
                across = across.reshape(*across.shape[:2], -1)  # (V, T, 2 S)
                mixed = (
                    corners[other][:, None, :, None] * across[one][:, :, None]
                    + corners[one][:, None, :, None] * across[other][:, :, None]
                ) / np.maximum(size[one] + size[other], EXACT)[..., None]
                rows.append(mixed.reshape(-1, *mixed.shape[2:]))
                normal = across / np.where(size > EXACT, size, np.inf)
                squares += np.swapaxes(normal, 1, 2) @ normal / len(SAMPLES)
        self.samples = np.concatenate(rows)
        arms = layout.points[:, layout.handles[self.joints]] - layout.points[:, layout.starts[self.joints], None]
        self.room = ROOM * np.hypot(arms[..., 0], arms[..., 1]).min(axis=(1, 2), initial=np.inf)[:, None]
        price = np.repeat(np.where(layout.is_node[self.free], NODE, 1.0), 2) * STIFF
        self.cost = np.tensordot(corners.T**2, squares, axes=1) + np.diag(price)  # (K, 2 S, 2 S)
        held = self.frozen.reshape(len(self.cost), -1)
        loose = self.cost + np.eye(len(price)) * np.where(held, 1e12, 0.0)[:, None]
        self.inverse = np.linalg.inv(loose) * ~(held[:, :, None] | held[:, None])

    def places_of(self, x: FloatArray) -> FloatArray:
        """(K, N, 2) all points after moves (K, S, 2)."""
        moved: FloatArray = self.layout.points + self.spread @ x
        return moved

    def moves(self, x: FloatArray) -> FloatArray:
        """(R,) what samples move across the curves by moves of points (K, S, 2)."""
        found: FloatArray = self.samples.reshape(len(self.samples), -1) @ x.ravel()
        return found

    def excess(self, x: FloatArray, bounds: Sequence[Bound]) -> float:
        """How many times what they may be turns, jumps and moves of samples are at most."""
        of = _Arrays.of(bounds)
        return self._excess(self._values(x, of)[0], self.moves(x), of.most)

    def _excess(self, values: FloatArray, moves: FloatArray, most: FloatArray) -> float:
        """The same of values (B, L) and moves (R,) that are known."""
        far = np.abs(moves).max() / self.design.tolerance
        return float(max(far, (np.abs(values) / np.maximum(most, LEAST)).max(initial=0.0)))

    def _values(self, x: FloatArray, of: _Arrays) -> tuple[FloatArray, ComplexArray]:
        """(B, L) what is bounded after moves, and (B, L, 5) the points around each joint at each place."""
        return bounded(_complex(self.places_of(x)), of.joints, of.is_jump, self.places, of.per)

    def least(self, bounds: Sequence[Bound], most_move: float) -> FloatArray:
        """(K, S, 2) the least moves that keep the bounds, and curves within the tolerance."""
        from scipy.linalg import solve_triangular
        from scipy.optimize import nnls

        of, most = _Arrays.of(bounds), _Arrays.of(bounds).most
        K, size = len(self.inverse), self.inverse.shape[1]
        x, kept = np.zeros((K, size)), np.zeros((2, *most.shape), dtype=np.bool_)
        far, beyond = np.zeros((2, len(self.samples)), dtype=np.bool_), np.zeros((2, K, size), dtype=np.bool_)
        limit = HELD * self.design.tolerance
        sign = np.array([1.0, -1.0])
        excess = list[float]()
        for _ in range(ROUNDS):
            values, at = self._values(x.reshape(K, -1, 2), of)
            moves = self.moves(x)
            excess.append(self._excess(values, moves, most))
            if len(excess) > HOPELESS and min(excess) > FAR and min(excess[-2:]) > STUCK * min(excess[:-2]):
                break
            over = np.abs(moves).max() - limit, np.abs(x).max() - most_move
            if (np.abs(values) - most).max() < SETTLED and max(over) < SETTLED * limit:
                break
            kept[0] |= values < -NEAR * most
            kept[1] |= values > NEAR * most
            for held, value, allowed in ((far, moves, limit), (beyond, x, most_move)):
                over_by = np.abs(value).ravel() - allowed
                worst = np.argsort(-over_by)[:WORST]
                worst = worst[over_by[worst] > 0]
                held.reshape(2, -1)[(value.ravel()[worst] > 0).astype(np.int64), worst] = True
            # Those with sign c + sign J x >= -most, linearised, are A x >= b.
            side, which, place = np.nonzero(kept)
            scale = sign[side] / of.per[which, place]
            A = slopes_of(at, which, place, scale, of.joints, of.is_jump, self.places, self.spread)
            if not (np.isfinite(A).all() and np.isfinite(values).all()):
                break  # a handle lost its length
            b = A.reshape(len(A), -1) @ x.ravel() - sign[side] * values[which, place] - most[which, place]
            side, sample = np.nonzero(far)
            of_curves = sign[side, None, None] * self.samples[sample]
            side, k, which = np.nonzero(beyond)
            of_points = np.zeros((len(k), K, size))
            of_points[np.arange(len(k)), k, which] = sign[side]
            A = np.concatenate([A, of_curves, of_points])
            b = np.concatenate([b, np.full(len(of_curves), -limit), np.full(len(of_points), -most_move)])
            R = np.swapaxes(np.swapaxes(A, 0, 1) @ self.inverse, 0, 1)  # of symmetric matrices
            G = A.reshape(len(A), -1) @ R.reshape(len(A), -1).T
            G[np.diag_indices(len(G))] += SOFT * max(np.trace(G), 1e-30)
            L = np.linalg.cholesky(G)
            dual, _ = nnls(L.T, solve_triangular(L, b, lower=True))
            new, first = np.tensordot(dual, R, axes=1), len(place)
            for held, rows in ((far, len(of_curves)), (beyond, len(of_points))):
                held[held] = dual[first : first + rows] > 0
                first += rows
            share = np.minimum(1.0, self.room / np.maximum(np.abs(new - x).max(axis=1, keepdims=True), EXACT))
            change = share * (new - x)
            x += change
            if np.abs(change).max() < STILL * self.design.step:
                break
        return x.reshape(K, -1, 2)

    def on_grid(self, x: FloatArray, bounds: Sequence[Bound], most_move: float) -> FloatArray:
        """(K, S, 2) moves to places on the grid so near those of ``x`` that keep the bounds best; see :mod:`.grid`."""
        layout, design = self.layout, self.design
        old = layout.points[:, self.free]
        near = np.where(self.frozen, 0.0, np.round((old + x) / design.step) * design.step - old)
        number = np.full(layout.points.shape[1], -1)
        number[self.free] = np.arange(len(self.free))
        before, best, points = map(_complex, (layout.points, self.places_of(x), self.places_of(near)))
        of = _Arrays.of(bounds)
        contiguous = np.ascontiguousarray
        settle(points, Rounding(
            before, best, number, layout.implied, contiguous(self.frozen),
            np.array([layout.around(joint)[1:4] for joint in self.joints.tolist()]), self.places, *of,
            contiguous(self.cost), contiguous(self.samples), LAST * design.tolerance, design.step, most_move,
        ))  # fmt: skip
        return (points - before)[:, self.free, None].view(np.float64)


def _basis(degree: int) -> tuple[FloatArray, FloatArray]:
    """(T, degree + 1) Bernstein polynomials at the samples, and their derivatives."""
    from scipy.special import comb

    def values(n: int) -> FloatArray:
        k = np.arange(n + 1)
        return np.asarray(comb(n, k) * SAMPLES[:, None] ** k * (1 - SAMPLES[:, None]) ** (n - k), dtype=np.float64)

    return values(degree), degree * values(degree - 1) @ np.diff(np.eye(degree + 1), axis=0)


_BASES = {degree: _basis(degree) for degree in (1, 2, 3)}
