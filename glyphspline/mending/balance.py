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
from .state import Design

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

ALONG = ((20.0, 8), (np.inf, 3))
"""Steps along its curve by which a point is put elsewhere, by the length of its shortest handle, in steps, too."""

ACROSS = 1.0
"""Steps by which that is across the curve at most."""

TRIED = 200
"""Places of the points around a joint, those that seem best, for which all its bounds are computed."""

AS_FOUND = 4.0
"""Price of the square of what such a joint turns otherwise than before rounding, in what it may turn."""

HELD, LAST = 0.7, 0.9
"""Shares of the tolerance by which samples of curves move at most: before rounding, which adds to it, and after."""

WORST = 16
"""Samples and coordinates at most, those that move by the most too much, that a round bounds besides others."""

STIFF = 0.1
"""Price of the square of a handle's move against the mean square of what curves move."""

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
    return _turns(points), np.stack([none, by_a, -by_a - by_b, by_b, none], axis=-2)


def _turns(points: FloatArray) -> FloatArray:
    """The turns alone."""
    a, b = points[..., 2, :] - points[..., 1, :], points[..., 3, :] - points[..., 2, :]
    return np.arctan2(cross(a, b), (a * b).sum(axis=-1))


def jumps_at(points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(…,) by how much curvature is larger behind joints (…, 5, 2) of cubics than before, and derivatives (…, 5, 2)."""
    slopes = np.zeros_like(points)
    slopes[..., 2::-1, :] = _curvature_slopes(points[..., 2::-1, :])
    slopes[..., 2:, :] += _curvature_slopes(points[..., 2:, :])
    return _jumps(points), slopes


def _jumps(points: FloatArray) -> FloatArray:
    """The jumps alone."""
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


@np.errstate(divide="ignore", invalid="ignore")
def _curvature_slopes(points: FloatArray) -> FloatArray:
    """(…, 3, 2) derivatives of :func:`_curvature`."""
    a, c = points[..., 1, :] - points[..., 0, :], points[..., 2, :] - points[..., 1, :]
    size = np.hypot(a[..., 0], a[..., 1])[..., None]
    by_a = -2 / 3 * _turned(c) / size**3 - 3 * _curvature(points)[..., None] * a / size**2
    by_c = 2 / 3 * _turned(a) / size**3
    return np.stack([-by_a, by_a - by_c, by_c], axis=-2)


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
        here, weights = self.places_of(x), self.design.places
        found = [float(np.abs(self.moves(x)).max() / self.design.tolerance)]
        for bound in bounds:
            at = np.tensordot(weights, here[:, bound.points], axes=1)
            values = (_jumps if bound.is_jump else _turns)(at) / bound.per
            found.append(float((np.abs(values) / np.maximum(bound.most, LEAST)).max()))
        return max(found)

    def least(self, bounds: Sequence[Bound], most_move: float) -> FloatArray:
        """(K, S, 2) the least moves that keep the bounds, and curves within the tolerance."""
        from scipy.linalg import solve_triangular
        from scipy.optimize import nnls

        weights = self.design.places
        K, size = len(self.inverse), self.inverse.shape[1]
        x, kept = np.zeros((K, size)), np.zeros((2, len(bounds), len(weights)), dtype=np.bool_)
        spread = [self.spread[bound.points] for bound in bounds]
        most, per = np.array([bound.most for bound in bounds]), np.array([bound.per for bound in bounds])
        far, beyond = np.zeros((2, len(self.samples)), dtype=np.bool_), np.zeros((2, K, size), dtype=np.bool_)
        limit = HELD * self.design.tolerance
        sign = np.array([1.0, -1.0])
        for _ in range(ROUNDS):
            here = self.places_of(x.reshape(K, -1, 2))
            found = [
                (jumps_at if bound.is_jump else turns_at)(np.tensordot(weights, here[:, bound.points], axes=1))
                for bound in bounds
            ]
            values, moves = np.array([value for value, _ in found]) / per, self.moves(x)
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
            slopes = np.empty((len(which), size))
            for n, part in enumerate(spread):
                by = found[n][1][place[which == n]]  # (R', 5, 2)
                slopes[which == n] = (part.T @ by).reshape(-1, size)
            scale = sign[side] / per[which, place]
            if not (np.isfinite(slopes).all() and np.isfinite(values).all()):
                break  # a handle lost its length
            A = weights[place][:, :, None] * (slopes * scale[:, None])[:, None]  # (R, K, 2 S)
            b = (A * x).sum(axis=(1, 2)) - sign[side] * values[which, place] - most[which, place]
            side, sample = np.nonzero(far)
            of_curves = sign[side, None, None] * self.samples[sample]
            side, k, which = np.nonzero(beyond)
            of_points = np.zeros((len(k), K, size))
            of_points[np.arange(len(k)), k, which] = sign[side]
            A = np.concatenate([A, of_curves, of_points])
            b = np.concatenate([b, np.full(len(of_curves), -limit), np.full(len(of_points), -most_move)])
            R = (self.inverse @ A[..., None])[..., 0]
            G = A.reshape(len(A), -1) @ R.reshape(len(A), -1).T
            G[np.diag_indices(len(G))] += SOFT * max(np.trace(G), 1e-30)
            L = np.linalg.cholesky(G)
            dual, _ = nnls(L.T, solve_triangular(L, b, lower=True))
            new, first = np.tensordot(dual, R, axes=1), len(place)
            for held, rows in ((far, len(of_curves)), (beyond, len(of_points))):
                held[held] = dual[first : first + rows] > 0
                first += rows
            share = np.minimum(1.0, self.room / np.maximum(np.abs(new - x).max(axis=1, keepdims=True), EXACT))
            x += share * (new - x)
        return x.reshape(K, -1, 2)

    def on_grid(self, x: FloatArray, bounds: Sequence[Bound], most_move: float) -> FloatArray:
        """(K, S, 2) moves to places on the grid so near those of ``x`` that keep the bounds best; see ``ALONG``."""
        old, step = self.layout.points[:, self.free], self.design.step
        found = np.where(self.frozen, 0.0, np.round((old + x) / step) * step - old)
        turns = {bound.joint: bound.most for bound in bounds if not bound.is_jump}
        index = {point: s for s, point in enumerate(self.free.tolist())}
        for _ in range(SWEEPS):
            before = found.copy()
            for joint in self.joints.tolist():
                around = self.layout.around(joint)[1:4].tolist()
                own = [index.get(point, -1) for point in around]
                if max(own) < 0:
                    continue
                for k in range(len(old)):
                    most = turns[joint][self.design.places[:, k].argmax()] if joint in turns else np.pi
                    tried = self._near(found, k, x, around, own, most, most_move)
                    if len(tried) > 1:
                        found[k] = tried[self._merit(found, k, tried, x, bounds).argmin()]
            if (before == found).all():
                break
        return found

    def _near(
        self, found: FloatArray, k: int, x: FloatArray, around: Sequence[int], own: Sequence[int], most: float,
        most_move: float,
    ) -> FloatArray:  # fmt: skip
        """(n, S, 2) moves of master k of which the points around one joint are put on other places on the grid.

        They are the ``TRIED`` for which the joint turns little in this master, and curves move by little.
        """
        step, points = self.design.step, self.layout.points[k, around]
        best = points + [x[k, s] if s >= 0 else np.zeros(2) for s in own]
        arms = np.hypot(*np.diff(best, axis=0).T) / step
        along = best[2] - best[0]
        along = along / max(float(np.hypot(*along)), EXACT)
        sets = []
        for n, s in enumerate(own):
            if s < 0:
                sets.append(points[n : n + 1])
                continue
            reach = next(reach for length, reach in ALONG if arms[max(n - 1, 0) : n + 1].min() <= length)
            steps = np.arange(-reach, reach + 1) * step
            middle = np.where(self.frozen[k, s], points[n], np.round(best[n] / step) * step)
            axes = [np.zeros(1) if held else steps for held in self.frozen[k, s]]
            near = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2) + middle
            keep = (np.abs(cross(near - middle, along)) <= ACROSS * step) & (
                np.hypot(*(near - points[n]).T) <= most_move
            )
            keep |= (near == points[n] + found[k, s]).all(axis=1)
            sets.append(near[keep])
        at = np.stack(np.meshgrid(*(np.arange(len(each)) for each in sets), indexing="ij"), axis=-1).reshape(-1, 3)
        places = np.stack([each[at[:, n]] for n, each in enumerate(sets)], axis=1)  # (n, 3, 2)
        a, b = np.swapaxes(np.diff(np.concatenate([best[None], places]), axis=1), 0, 1)
        turn = np.arctan2(cross(a, b), (a * b).sum(axis=1))
        price = (AS_FOUND * (turn[1:] - turn[0]) / (most + LEAST)) ** 2
        chosen = [n for n, s in enumerate(own) if s >= 0]
        free = [own[n] for n in chosen]
        off = (found[k] - x[k]).copy()
        off[free] = 0.0
        cost = self.cost[k].reshape(len(off), 2, len(off), 2)
        moved = (places[:, chosen] - best[chosen]).reshape(len(places), -1)
        block = cost[free][:, :, free].reshape(moved.shape[1], -1)
        pull = np.tensordot(off, cost[:, :, free], axes=2).reshape(-1)
        price += (((moved @ block) + 2 * pull) * moved).sum(axis=1) / step**2
        if len(price) > TRIED:
            places = places[np.argpartition(price, TRIED)[:TRIED]]
        tried = np.repeat(found[k][None], len(places), axis=0)
        tried[:, free] = places[:, chosen] - points[chosen]
        return tried

    def _merit(self, x: FloatArray, k: int, tried: FloatArray, best: FloatArray, bounds: Sequence[Bound]) -> FloatArray:
        """(n,) prices of moves (n, S, 2) of master k beside those of all others."""
        off, weights = (tried - best[k]).reshape(len(tried), -1), self.design.places
        total = ((off @ self.cost[k]) * off).sum(axis=1) / self.design.step**2
        here, change = self.places_of(x), tried - x[k]
        acts, moved = np.flatnonzero(weights[:, k]), np.flatnonzero(change.any(axis=(0, 2)))
        change = change[:, moved]
        slopes = self.samples[:, k].reshape(-1, len(self.free), 2)[:, moved].reshape(-1, 2 * len(moved))
        own = slopes.any(axis=1)  # what does not depend on the points that are tried is the same for all
        moves = self.moves(x)[own] + change.reshape(len(tried), -1) @ slopes[own].T  # (n, R')
        total += BEYOND * (np.maximum(np.abs(moves) / (LAST * self.design.tolerance) - 1, 0.0) ** 2).sum(axis=1)
        for bound in bounds:
            part = self.spread[bound.points][:, moved]
            if not part.any():
                continue
            at = np.tensordot(weights[acts], here[:, bound.points], axes=1)  # (l, 5, 2)
            every = at + weights[acts, k][:, None, None] * (part @ change)[:, None]  # (n, l, 5, 2)
            value = np.abs((_jumps if bound.is_jump else _turns)(every) / bound.per[acts])
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
