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

from ..curves.bezier import cross
from ..types import BoolArray, FloatArray, IntArray
from .joints import EXACT, Layout

SAMPLES = np.linspace(0.0, 1.0, 9)[1:-1]
"""Parameters of a segment at which it is to stay where it is."""

NODE = 4.0
"""Price of the square of a node's move, as a share of a handle's."""

ROUNDS = 16
"""Linearised problems that are solved; turns of a few degrees change by less than 1 % in the eighth, those of handles
of two units, which move by little at once, in the last."""

ROOM = 0.3
"""Share of a master's shortest handle by which its points move at most at once."""

NEAR = 0.5
"""Share of a bound from which a value counts as near it, in the rest of the search too."""

SETTLED = 1e-3
"""Radians, or share of curvature, by which bounds may be missed."""

SOFT = 1e-9
"""Share of the dual's diagonal that is added to it, as bounds may contradict each other."""

AROUND = (1, 2)
"""Steps of the grid around the best place within which ends of handles are sought: one, then two. With one alone 106
of 220 kinks of a degree or more of ten variable fonts are mended, with both 108, for up to twice the time."""

SWEEPS = 2
"""How often each handle is put on the grid."""

BEYOND = 1e3
"""Price of the square of a bound that is exceeded on the grid, in bounds."""

LEAST = 1e-3
"""Radians that the grid makes good for: turns below cost nothing."""


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


@np.errstate(invalid="ignore")
def turns_at(points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(…,) radians by which joints (…, 5, 2) turn, and their derivatives (…, 5, 2): not of handles without length."""
    a, b = points[..., 2, :] - points[..., 1, :], points[..., 3, :] - points[..., 2, :]
    by_a, by_b = (_turned(v) / (v * v).sum(axis=-1, keepdims=True) for v in (a, b))
    none = np.zeros_like(a)
    return np.arctan2(cross(a, b), (a * b).sum(axis=-1)), np.stack([none, by_a, -by_a - by_b, by_b, none], axis=-2)


def jumps_at(points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(…,) by how much curvature is larger behind joints (…, 5, 2) of cubics than before, and derivatives (…, 5, 2)."""
    before, by_before = _curvature(points[..., 2::-1, :])
    behind, by_behind = _curvature(points[..., 2:, :])
    slopes = np.zeros_like(points)
    slopes[..., 2::-1, :] = by_before
    slopes[..., 2:, :] += by_behind
    return behind + before, slopes


def curvatures_at(points: FloatArray) -> FloatArray:
    """(2, …) curvatures before and behind joints (…, 5, 2) of cubics."""
    return np.stack([-_curvature(points[..., 2::-1, :])[0], _curvature(points[..., 2:, :])[0]])


def _turned(v: FloatArray) -> FloatArray:
    """Vectors (…, 2) turned to the left."""
    return np.stack([-v[..., 1], v[..., 0]], axis=-1)


@np.errstate(divide="ignore", invalid="ignore")
def _curvature(points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(…,) curvature where a cubic begins, from its first three points (…, 3, 2), and derivatives (…, 3, 2)."""
    a, c = points[..., 1, :] - points[..., 0, :], points[..., 2, :] - points[..., 1, :]
    size = np.hypot(a[..., 0], a[..., 1])[..., None]
    value = 2 / 3 * cross(a, c)[..., None] / size**3
    by_a = -2 / 3 * _turned(c) / size**3 - 3 * value * a / size**2
    by_c = 2 / 3 * _turned(a) / size**3
    return value[..., 0], np.stack([-by_a, by_a - by_c, by_c], axis=-2)


class Stretch:
    """Some points of a contour that may move in all masters, and the joints that must stay or become smooth.

    Attributes:
        free: (S,) numbers of the points. spread: (N, S) how all points move with them. frozen: (K, S, 2) coordinates
            that stay, in which a handle is level. joints: numbers of those that are touched.
    """

    def __init__(self, layout: Layout, free: Sequence[int], stiff: float) -> None:
        self.layout, self.free = layout, np.array(sorted(set(free)))
        old = layout.points
        count = old.shape[1]
        self.spread = np.zeros((count, len(self.free)))
        self.spread[self.free, np.arange(len(self.free))] = 1.0
        at = np.flatnonzero(layout.implied)
        self.spread[at] = (self.spread[at - 1] + self.spread[(at + 1) % count]) / 2
        self.frozen = layout.frozen[:, self.free]
        moved: BoolArray = np.asarray(self.spread.any(axis=1))
        nodes = layout.starts
        touched = moved[nodes - 1] | moved[nodes] | moved[(nodes + 1) % count]
        self.joints = np.flatnonzero(touched & ~layout.implied[nodes])
        rows = []
        for segment, degree in enumerate(layout.degrees.tolist()):
            own = (nodes[segment] + np.arange(degree + 1)) % count
            if moved[own].any():
                basis, slopes = _BASES[degree]
                along = slopes @ old[:, own]
                size = np.hypot(along[..., 0], along[..., 1])[..., None]
                normals = _turned(along) / np.where(size > EXACT, size, np.inf)
                rows.append((basis @ self.spread[own])[None, :, :, None] * normals[:, :, None])
        each = np.concatenate(rows, axis=1)
        arms = old[:, layout.handles[self.joints]] - old[:, layout.starts[self.joints], None]
        self.room = ROOM * np.hypot(arms[..., 0], arms[..., 1]).min(axis=(1, 2), initial=np.inf)[:, None]
        self.samples = each.reshape(*each.shape[:2], -1)  # (K, M, 2 S) what they move by the points' moves
        price = np.repeat(np.where(layout.is_node[self.free], NODE, 1.0), 2) * stiff
        cost = np.swapaxes(self.samples, 1, 2) @ self.samples / len(SAMPLES) + np.diag(price)
        held = self.frozen.reshape(len(old), -1)
        self.cost = cost
        loose = cost + np.eye(len(price)) * np.where(held, 1e12, 0.0)[:, None]
        self.inverse = np.linalg.inv(loose) * ~(held[:, :, None] | held[:, None])  # (K, 2 S, 2 S)

    def places_of(self, x: FloatArray) -> FloatArray:
        """(K, N, 2) all points after moves (K, S, 2)."""
        moved: FloatArray = self.layout.points + self.spread @ x
        return moved

    def farthest(self, x: FloatArray) -> float:
        """The largest move of a sample across the curve in any master."""
        return float(np.abs(self.samples @ x.reshape(len(x), -1, 1)).max())

    def least(self, bounds: Sequence[Bound], weights: FloatArray) -> FloatArray:
        """(K, S, 2) the least moves that keep the bounds at places with weights (L, K)."""
        from scipy.linalg import solve_triangular
        from scipy.optimize import nnls

        K, size = len(self.inverse), self.inverse.shape[1]
        x, kept = np.zeros((K, size)), np.zeros((2, len(bounds), len(weights)), dtype=np.bool_)
        spread = [self.spread[bound.points] for bound in bounds]
        most, per = np.array([bound.most for bound in bounds]), np.array([bound.per for bound in bounds])
        for _ in range(ROUNDS):
            here = self.places_of(x.reshape(K, -1, 2))
            found = [
                (jumps_at if bound.is_jump else turns_at)(np.tensordot(weights, here[:, bound.points], axes=1))
                for bound in bounds
            ]
            values = np.array([value for value, _ in found]) / per
            if (np.abs(values) - most).max() < SETTLED:
                break
            kept[0] |= values < -NEAR * most
            kept[1] |= values > NEAR * most
            # Those with sign c + sign J x >= -most, linearised, are A x >= b.
            side, which, place = np.nonzero(kept)
            sign = np.array([1.0, -1.0])[side]
            slopes = np.empty((len(which), size))
            for n, part in enumerate(spread):
                by = found[n][1][place[which == n]]  # (R', 5, 2)
                slopes[which == n] = (part.T @ by).reshape(-1, size)
            scale = sign / per[which, place]
            if not (np.isfinite(slopes).all() and np.isfinite(values).all()):
                break  # a handle lost its length
            A = weights[place][:, :, None] * (slopes * scale[:, None])[:, None]  # (R, K, 2 S)
            b = (A * x).sum(axis=(1, 2)) - sign * values[which, place] - most[which, place]
            R = (self.inverse @ A[..., None])[..., 0]
            G = A.reshape(len(A), -1) @ R.reshape(len(A), -1).T
            G[np.diag_indices(len(G))] += SOFT * max(np.trace(G), 1e-30)
            L = np.linalg.cholesky(G)
            dual, _ = nnls(L.T, solve_triangular(L, b, lower=True))
            new = np.tensordot(dual, R, axes=1)
            share = np.minimum(1.0, self.room / np.maximum(np.abs(new - x).max(axis=1, keepdims=True), EXACT))
            x += share * (new - x)
        return x.reshape(K, -1, 2)

    def on_grid(
        self, x: FloatArray, bounds: Sequence[Bound], weights: FloatArray, step: float, around: int
    ) -> FloatArray:
        """(K, S, 2) moves to places on the grid so near those of ``x`` that keep the bounds best; see ``AROUND``."""
        old = self.layout.points[:, self.free]
        to = np.where(self.frozen, old, np.round((old + x) / step) * step)
        found, best = to - old, x
        steps = np.arange(-around, around + 1) * step
        none = np.zeros(1)
        index = {point: s for s, point in enumerate(self.free.tolist())}
        own = [[index[p] for p in pair if p in index] for pair in self.layout.handles[self.joints].tolist()]
        for _ in range(SWEEPS):
            before = found.copy()
            for pair in own:
                if not pair or self.layout.is_node[self.free[pair]].all():
                    continue
                for k in range(len(old)):
                    ways = [none if self.frozen[k, s, c] else steps for s in pair for c in range(2)]
                    near = np.stack(np.meshgrid(*ways, indexing="ij"), axis=-1).reshape(-1, len(pair), 2)
                    if len(near) == 1:
                        continue
                    tried = np.repeat(found[k][None], len(near), axis=0)
                    tried[:, pair] = (to - old)[k, pair] + near
                    found[k] = tried[self._merit(found, k, tried, best, bounds, weights, step).argmin()]
            if (before == found).all():
                break
        return found

    def _merit(
        self, x: FloatArray, k: int, tried: FloatArray, best: FloatArray, bounds: Sequence[Bound], weights: FloatArray,
        step: float,
    ) -> FloatArray:  # fmt: skip
        """(n,) prices of moves (n, S, 2) of master k beside those of all others."""
        off = tried.reshape(len(tried), -1)
        total = np.einsum("ns,st,nt->n", off, self.cost[k], off) / step**2
        here = self.places_of(x)
        acts = np.flatnonzero(weights[:, k])
        for bound in bounds:
            part = self.spread[bound.points]
            if not part.any():
                continue
            at = np.tensordot(weights[acts], here[:, bound.points], axes=1)  # (l, 5, 2)
            change = part @ (tried - x[k])  # (n, 5, 2)
            every = at + weights[acts, k][:, None, None] * change[:, None]  # (n, l, 5, 2)
            value = np.abs((jumps_at(every) if bound.is_jump else turns_at(every))[0] / bound.per[acts])
            most = bound.most[acts] + LEAST
            total += (BEYOND * np.maximum(value / most - 1, 0.0) ** 2 + (value / most) ** 2).sum(axis=1)
        return total


def _basis(degree: int) -> tuple[FloatArray, FloatArray]:
    """(T, degree + 1) Bernstein polynomials at the samples, and their derivatives."""
    from scipy.special import comb

    def values(n: int) -> FloatArray:
        k = np.arange(n + 1)
        return np.asarray(comb(n, k) * SAMPLES[:, None] ** k * (1 - SAMPLES[:, None]) ** (n - k), dtype=np.float64)

    return values(degree), degree * values(degree - 1) @ np.diff(np.eye(degree + 1), axis=0)


_BASES = {degree: _basis(degree) for degree in (1, 2, 3)}
