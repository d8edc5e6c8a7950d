"""Moves put on the grid: master by master and joint by joint, to the places that cost least beside all others.

A place costs what curves move, and what it uses of the bounds; :mod:`.balance` has both. The places of the three points
around a joint are tried together, all of them: most are passed over, as what they cost at least, wherever the others
are, is more than the best so far.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...arrays import ascending
from ...compiled import compiled
from ...outlines.flaws.joints import end_curvature, turn_of
from ...types import BoolArray, ComplexArray, FloatArray, IntArray

SWEEPS = 3
"""How often each handle is put on the grid at most."""

SHORT, FAR, NEAR = 20.0, 8, 3
"""Steps along its curve by which a point is put elsewhere: ``FAR`` where a handle is shorter than ``SHORT`` steps."""

ACROSS = 1.0
"""Steps by which that is across the curve at most."""

BEYOND = 1e3
"""Price of the square of a bound that is exceeded on the grid, in bounds."""

SURELY = 1 + 1e-9
"""Times the best price above which another one is higher, also after rounding."""

LEAST = 1e-3
"""Radians that the grid makes good for: turns below cost nothing."""

Near = tuple[IntArray, IntArray, ComplexArray]
"""Numbers (b,) of bounds and (l,) of places, and (b, l, 5) sums of points: see :func:`around`."""


class Rounding(NamedTuple):
    """What the grid is to keep, for K masters of N points, S of which move.

    Attributes:
        old, best: (K, N) points before, and where they are to be. number: (N,) of the points that move, -1 of others.
        implied: (N,) points midway between their neighbours. frozen: (K, S, 2) coordinates that stay.
        triples: (J, 3) numbers of the points around the joints.
        weights: (L, K) of the masters at places of the design space. joints: (B, 5) points around those that are
            bounded. is_jump, most, per: (B,), (B, L) and (B, L), see :class:`.balance.Bounds`.
        cost: (K, 2 S, 2 S) price of moves. samples: (R, K, 2 S) by how much samples of curves move, ``limit`` at most.
        step: of the grid. most_move: of a point.
    """

    old: ComplexArray
    best: ComplexArray
    number: IntArray
    implied: BoolArray
    frozen: BoolArray
    triples: IntArray
    weights: FloatArray
    joints: IntArray
    is_jump: BoolArray
    most: FloatArray
    per: FloatArray
    cost: FloatArray
    samples: FloatArray
    limit: float
    step: float
    most_move: float


@compiled
def settle(points: ComplexArray, of: Rounding) -> None:
    """Put points (K, N), which are on the grid, where they cost less, until nothing moves."""
    moves = np.zeros(len(of.samples))
    for k in range(len(points)):
        for i in range(points.shape[1]):
            if of.number[i] >= 0:
                slide(moves, of, k, i, points[k, i] - of.old[k, i])
    for _ in range(SWEEPS):
        moved = False
        for triple in of.triples:
            if max(of.number[triple[0]], of.number[triple[1]], of.number[triple[2]]) >= 0:
                for k in range(len(points)):
                    moved |= settle_joint(points, moves, of, k, triple)
        if not moved:
            break


@compiled
def slide(moves: FloatArray, of: Rounding, k: int, i: int, way: complex) -> None:
    """Add to the moves of samples what they move by one point's."""
    s = of.number[i]
    for r in range(len(moves)):
        moves[r] += of.samples[r, k, 2 * s] * way.real + of.samples[r, k, 2 * s + 1] * way.imag


@compiled
def put(points: ComplexArray, implied: BoolArray, k: int, i: int, place: complex) -> None:
    """Put a point somewhere, and those midway between it and others."""
    count = points.shape[1]
    points[k, i] = place
    for j in ((i - 1) % count, (i + 1) % count):
        if implied[j]:
            points[k, j] = (points[k, j - 1] + points[k, (j + 1) % count]) / 2


@compiled
def places_near(points: ComplexArray, of: Rounding, k: int, triple: IntArray, n: int) -> ComplexArray:
    """Places on the grid for one of the points around a joint, the nearest to where it is to be first."""
    i, step = triple[n], of.step
    s = of.number[i]
    if s < 0:
        return points[k, i : i + 1].copy()
    best, old, now = of.best[k, i], of.old[k, i], points[k, i]
    arm, along = np.inf, of.best[k, triple[2]] - of.best[k, triple[0]]
    for m in range(max(n - 1, 0), min(n + 1, 2)):
        arm = min(arm, abs(of.best[k, triple[m + 1]] - of.best[k, triple[m]]) / step)
    reach = FAR if arm <= SHORT else NEAR
    x, y = 0 if of.frozen[k, s, 0] else reach, 0 if of.frozen[k, s, 1] else reach
    middle = complex(
        old.real if x == 0 else np.round(best.real / step) * step,
        old.imag if y == 0 else np.round(best.imag / step) * step,
    )
    found, count = np.empty((2 * x + 1) * (2 * y + 1) + 1, dtype=np.complex128), 1
    found[0] = now
    for u in range(-x, x + 1):
        for v in range(-y, y + 1):
            way = step * complex(u, v)
            across = abs((along.conjugate() * way).imag)
            if across <= ACROSS * step * abs(along) and abs(middle + way - old) <= of.most_move and middle + way != now:
                found[count] = middle + way
                count += 1
    return found[ascending(np.abs(found[:count] - best))]


@compiled
def settle_joint(points: ComplexArray, moves: FloatArray, of: Rounding, k: int, triple: IntArray) -> bool:
    """Put the points around one joint in one master where they cost least; returns whether they were elsewhere."""
    first, node, last = [places_near(points, of, k, triple, n) for n in range(3)]
    if len(first) * len(node) * len(last) == 1:
        return False
    S, size = of.frozen.shape[1], 1 / (of.step * of.step)
    now, best, cost = points[k, triple], np.zeros(3, dtype=np.complex128), np.zeros((6, 6))
    off = np.zeros(2 * S)  # what others are off their best places
    for i in range(points.shape[1]):
        s = of.number[i]
        if s >= 0 and i != triple[0] and i != triple[1] and i != triple[2]:
            off[2 * s], off[2 * s + 1] = points[k, i].real - of.best[k, i].real, points[k, i].imag - of.best[k, i].imag
    base, pull = 0.0, np.zeros(2 * S)
    for s in range(2 * S):
        for t in range(2 * S):
            pull[s] += of.cost[k, s, t] * off[t]
        base, pull[s] = base + size * off[s] * pull[s], 2 * size * pull[s]
    pulls, slopes = np.zeros(6), np.zeros((len(moves), 6))
    for n in range(3):
        best[n], s = of.best[k, triple[n]], of.number[triple[n]]
        if s >= 0:
            pulls[2 * n : 2 * n + 2] = pull[2 * s : 2 * s + 2]
            slopes[:, 2 * n : 2 * n + 2] = of.samples[:, k, 2 * s : 2 * s + 2]
            for m in range(3):
                t = of.number[triple[m]]
                if t >= 0:
                    cost[2 * n : 2 * n + 2, 2 * m : 2 * m + 2] = size * of.cost[k, 2 * s : 2 * s + 2, 2 * t : 2 * t + 2]
    near = around(points, of, k, triple)
    rows = np.array([r for r in range(len(moves)) if np.any(slopes[r])], dtype=np.int64)
    slopes, moved = slopes[rows], moves[rows]
    found, least = now.copy(), np.inf
    of_two = without_last(base, pulls, cost)
    of_one = without_last(*of_two)
    way, change = np.zeros(6), np.zeros(6)
    for stage in range(2):  # where they are now, and then elsewhere
        for a in first if stage else now[:1]:
            put(points, of.implied, k, triple[0], a)
            way[0], way[1] = a.real - best[0].real, a.imag - best[0].imag
            change[0], change[1] = a.real - now[0].real, a.imag - now[0].imag
            if not price_of(way[:2], *of_one) < least * SURELY:
                continue
            for b in node if stage else now[1:2]:
                put(points, of.implied, k, triple[1], b)
                way[2], way[3] = b.real - best[1].real, b.imag - best[1].imag
                change[2], change[3] = b.real - now[1].real, b.imag - now[1].imag
                if not price_of(way[:4], *of_two) < least * SURELY:
                    continue
                for c in last if stage else now[2:]:
                    way[4], way[5] = c.real - best[2].real, c.imag - best[2].imag
                    total = price_of(way, base, pulls, cost)
                    if not total < least:
                        continue
                    change[4], change[5] = c.real - now[2].real, c.imag - now[2].imag
                    put(points, of.implied, k, triple[2], c)
                    total = with_bounds(total, least, points, of, k, near)
                    if total < least:
                        total = with_samples(total, least, of.limit, moved, slopes, change)
                    if total < least:
                        least, found[0], found[1], found[2] = total, a, b, c
    for n in range(3):
        put(points, of.implied, k, triple[n], found[n])
        if found[n] != now[n]:
            slide(moves, of, k, triple[n], found[n] - now[n])
    return bool((found != now).any())


@compiled
def price_of(way: FloatArray, base: float, pulls: FloatArray, cost: FloatArray) -> float:
    """What moves (n,) cost: ``base + pulls way + way cost way``, the cost (n, n) being symmetric."""
    total = base
    for n in range(len(way)):
        for m in range(n):
            total += 2 * cost[n, m] * way[m] * way[n]
        total += (pulls[n] + cost[n, n] * way[n]) * way[n]
    return total


@compiled
def without_last(base: float, pulls: FloatArray, cost: FloatArray) -> tuple[float, FloatArray, FloatArray]:
    """The least price over the last two of all moves, as one of the others; see :func:`price_of`."""
    n = len(pulls) - 2
    own, mixed = cost[n:, n:], cost[n:, :n]
    size = own[0, 0] * own[1, 1] - own[0, 1] * own[1, 0]
    if size <= 0:  # of a point that does not move
        return base, pulls[:n].copy(), cost[:n, :n].copy()
    x = (own[1, 1] * pulls[n] - own[0, 1] * pulls[n + 1]) / size
    y = (own[0, 0] * pulls[n + 1] - own[1, 0] * pulls[n]) / size
    left, by_others = pulls[:n].copy(), cost[:n, :n].copy()
    for i in range(n):
        left[i] -= x * mixed[0, i] + y * mixed[1, i]
        u, v = own[1, 1] * mixed[0, i] - own[0, 1] * mixed[1, i], own[0, 0] * mixed[1, i] - own[1, 0] * mixed[0, i]
        for j in range(n):
            by_others[j, i] -= (mixed[0, j] * u + mixed[1, j] * v) / size
    return base - (x * pulls[n] + y * pulls[n + 1]) / 4, left, by_others


@compiled
def around(points: ComplexArray, of: Rounding, k: int, triple: IntArray) -> Near:
    """Bounds in which the points around a joint have a part, where their master has one, and what others add there."""
    count = points.shape[1]
    near = np.zeros(count, dtype=np.bool_)
    for i in triple:
        if of.number[i] >= 0:
            near[i] = True
            for j in ((i - 1) % count, (i + 1) % count):
                near[j] |= of.implied[j]
    bounds = np.array([b for b in range(len(of.joints)) if near[of.joints[b]].any()], dtype=np.int64)
    acts = np.flatnonzero(of.weights[:, k])
    others = np.zeros((len(bounds), len(acts), 5), dtype=np.complex128)
    for n, b in enumerate(bounds):
        for m, place in enumerate(acts):
            for other in range(len(points)):
                if other != k and of.weights[place, other] != 0:
                    for i in range(5):
                        others[n, m, i] += of.weights[place, other] * points[other, of.joints[b, i]]
    return bounds, acts, others


@compiled
def with_bounds(total: float, most: float, points: ComplexArray, of: Rounding, k: int, near: Near) -> float:
    """A price with that of bounds near a joint, see :func:`around`; infinite once it reaches ``most``."""
    bounds, acts, others = near
    for n, b in enumerate(bounds):
        own = of.joints[b]
        for m, place in enumerate(acts):
            w, rest = of.weights[place, k], others[n, m]
            x, y, z = rest[1] + w * points[k, own[1]], rest[2] + w * points[k, own[2]], rest[3] + w * points[k, own[3]]
            if of.is_jump[b]:
                u, v = rest[0] + w * points[k, own[0]], rest[4] + w * points[k, own[4]]
                value = abs(end_curvature(y, z, v) + end_curvature(y, x, u)) / of.per[b, place]
            else:
                value = abs(turn_of(y - x, z - y))
            share = value / (of.most[b, place] + LEAST)
            beyond = max(share - 1, 0.0)
            total += share * share + BEYOND * beyond * beyond
            if not total < most:
                return np.inf
    return total


@compiled
def with_samples(
    total: float, most: float, limit: float, moved: FloatArray, slopes: FloatArray, change: FloatArray
) -> float:
    """A price with that of samples that move beyond a limit; infinite once it reaches ``most``."""
    for r in range(len(moved)):
        way = moved[r]
        for n in range(6):
            way += slopes[r, n] * change[n]
        beyond = max(abs(way) / limit - 1, 0.0)
        total += BEYOND * beyond * beyond
        if not total < most:
            return np.inf
    return total
