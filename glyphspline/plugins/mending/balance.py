"""The least moves of handles and nodes after which joints turn, and their curvature jumps, by no more than they may.

All points that may move, in all masters, are found together. The curves are to stay where they are: the sum of squares
of what samples move across them is least. At places of the design space, the masters, the axes and pairs of axes
between them, turns and jumps are bounded; they are no linear functions of the points, so that the bounds are linearised
and the problem is solved again. Its dual has one unknown a bound and is one of least squares with no negative ones.

What comes out is put on the grid, handle by handle and master by master, each where joints turn least.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...curves.bezier import cross
from ...types import BoolArray, ComplexArray, FloatArray, IntArray
from .grid import LEAST, Rounding, settle
from .joints import EXACT, ContourLayout
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


LEFT = np.array([[0.0, 1.0], [-1.0, 0.0]])
"""Turns vectors (…, 2) to the left."""


class Bounds(NamedTuple):
    """What B joints may turn, or their curvatures jump, at L places.

    Attributes:
        joints: (B, 5) numbers of the points around each: two before, the node and two behind.
        is_jump: (B,) whether curvature is bounded, as a share of the larger one in the beginning.
        most: (B, L) absolute values in radians, or shares. per: (B, L) by what values are divided: 1, or curvatures.
    """

    joints: IntArray
    is_jump: BoolArray
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


@np.errstate(divide="ignore", invalid="ignore")
def _curvature(points: FloatArray) -> FloatArray:
    """(…,) curvature where a cubic begins, from its first three points (…, 3, 2)."""
    a, c = points[..., 1, :] - points[..., 0, :], points[..., 2, :] - points[..., 1, :]
    value: FloatArray = 2 / 3 * cross(a, c) / np.hypot(a[..., 0], a[..., 1]) ** 3
    return value


def bounded(points: FloatArray, of: Bounds, weights: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(B, L) turns in radians and jumps, as shares of ``per``, and (B, L, 5, 2) the points around joints at each place.

    Args:
        points: (K, N, 2). weights: (L, K) of the masters at the places.
    """
    around = np.zeros((*of.per.shape, 5, 2))
    for own, share in zip(points[:, of.joints], weights.T, strict=True):
        around += share[:, None, None] * own[:, None]
    return np.where(of.is_jump[:, None], jumps_at(around), turns_at(around)) / of.per, around


@np.errstate(divide="ignore", invalid="ignore")
def slopes_of(
    around: FloatArray, which: IntArray, place: IntArray, scale: FloatArray, of: Bounds, weights: FloatArray,
    spread: FloatArray,
) -> FloatArray:  # fmt: skip
    """(R, K, 2 S) derivatives of what :func:`bounded` has, by moves of points, times a scale (R,).

    Args:
        around: (B, L, 5, 2). which, place: (R,) numbers of bounds and places. spread: (N, S).
    """
    at, jumps = around[which, place], np.zeros((len(which), 5, 2))
    for way in (-1, 1):
        a, c = at[:, 2 + way] - at[:, 2], at[:, 2 + 2 * way] - at[:, 2 + way]
        size = np.hypot(*a.T)[:, None]
        by_c = 2 / 3 * (a @ LEFT) / size**3
        by_a = -2 / 3 * (c @ LEFT) / size**3 - 3 * _curvature(at[:, 2::way][:, :3])[:, None] * a / size**2
        jumps[:, 2] -= by_a
        jumps[:, 2 + way] += by_a - by_c
        jumps[:, 2 + 2 * way] += by_c
    first, last = (
        each @ LEFT / np.square(each).sum(axis=1)[:, None] for each in np.diff(at[:, 1:4], axis=1).swapaxes(0, 1)
    )
    none = np.zeros_like(first)
    slopes = np.where(of.is_jump[which, None, None], jumps, np.stack([none, first, -first - last, last, none], axis=1))
    own = np.zeros((len(which), spread.shape[1], 2))
    for number, slope in zip(of.joints[which].T, slopes.swapaxes(0, 1), strict=True):
        own += (scale[:, None] * spread[number])[..., None] * slope[:, None]
    found: FloatArray = weights[place][:, :, None] * own.reshape(len(own), 1, -1)
    return found


def _complex(points: FloatArray) -> ComplexArray:
    """(…,) points as complex numbers, from (…, 2)."""
    return np.ascontiguousarray(points).view(np.complex128)[..., 0]


class FreePoints:
    """Some points of a contour that may move in all masters, and the joints that must stay or become smooth.

    Attributes:
        free: (S,) numbers of the points. spread: (N, S) how all points move with them. frozen: (K, S, 2) coordinates
            that stay, in which a handle is level. joints: numbers of those that are touched. samples: (R, K, 2 S) what
            samples of curves move across them by the points' moves, at the corners of the design space and, of two
            corners that slip along their curves apart, between them, as :mod:`.slip` has it.
    """

    def __init__(self, layout: ContourLayout, free: Sequence[int], design: Design) -> None:
        self.layout, self.free, self.design = layout, np.array(sorted(set(free))), design
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
                across = (basis @ self.spread[own])[None, :, :, None] * (along @ LEFT)[:, :, None]
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

    def excess(self, x: FloatArray, bounds: Bounds) -> float:
        """How many times what they may be turns, jumps and moves of samples are at most, after moves (K, S, 2)."""
        return self._excess(self._values(x, bounds)[0], self.moves(x), bounds.most)

    def _excess(self, values: FloatArray, moves: FloatArray, most: FloatArray) -> float:
        """The same of values (B, L) and moves (R,) that are known."""
        far = np.abs(moves).max() / self.design.tolerance
        return float(max(far, (np.abs(values) / np.maximum(most, LEAST)).max(initial=0.0)))

    def _values(self, x: FloatArray, bounds: Bounds) -> tuple[FloatArray, FloatArray]:
        """See :func:`bounded`, after moves."""
        return bounded(self.places_of(x), bounds, self.design.places)

    def least(self, bounds: Bounds, most_move: float) -> FloatArray:
        """(K, S, 2) the least moves that keep the bounds, and curves within the tolerance."""
        from scipy.linalg import solve_triangular
        from scipy.optimize import nnls

        most, (K, size) = bounds.most, self.inverse.shape[:2]
        x, kept = np.zeros((K, size)), np.zeros((2, *most.shape), dtype=np.bool_)
        far, beyond = np.zeros((2, len(self.samples)), dtype=np.bool_), np.zeros((2, K, size), dtype=np.bool_)
        limit = HELD * self.design.tolerance
        sign = np.array([1.0, -1.0])
        excess = list[float]()
        for _ in range(ROUNDS):
            values, at = self._values(x.reshape(K, -1, 2), bounds)
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
            scale = sign[side] / bounds.per[which, place]
            A = slopes_of(at, which, place, scale, bounds, self.design.places, self.spread)
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

    def on_grid(self, x: FloatArray, bounds: Bounds, most_move: float) -> FloatArray:
        """(K, S, 2) moves to places on the grid so near those of ``x`` that keep the bounds best; see :mod:`.grid`."""
        layout, design = self.layout, self.design
        old = layout.points[:, self.free]
        near = np.where(self.frozen, 0.0, np.round((old + x) / design.step) * design.step - old)
        number = np.full(layout.points.shape[1], -1)
        number[self.free] = np.arange(len(self.free))
        before, best, points = map(_complex, (layout.points, self.places_of(x), self.places_of(near)))
        contiguous = np.ascontiguousarray
        settle(points, Rounding(
            before, best, number, layout.implied, contiguous(self.frozen),
            np.array([layout.around(joint)[1:4] for joint in self.joints.tolist()]), contiguous(design.places), *bounds,
            contiguous(self.cost), contiguous(self.samples), LAST * design.tolerance, design.step, most_move,
        ))  # fmt: skip
        return (points - before)[:, self.free, None].view(np.float64)


def _basis(degree: int) -> tuple[FloatArray, FloatArray]:
    """(T, degree + 1) Bernstein polynomials at the samples, and their derivatives."""

    def values(n: int) -> FloatArray:
        k, choices = np.arange(n + 1), np.array([math.comb(n, k) for k in range(n + 1)], dtype=np.float64)
        return choices * SAMPLES[:, None] ** k * (1 - SAMPLES[:, None]) ** (n - k)

    return values(degree), degree * values(degree - 1) @ np.diff(np.eye(degree + 1), axis=0)


_BASES = {degree: _basis(degree) for degree in (1, 2, 3)}
