"""The places of a chain of cubics nearest to points, in V ≥ 1 instances at once: squared distances are summed.

A chain is an array (n V, 4, 2), with segment j in instance v in row j V + v. A point is number k of row p V + v of an
array (…, 4, 2) or (…, n, 2): a Bézier point of another chain, or the vertex of a polygon. A *place* j + x of a closed
chain is local parameter x of its segment j; places count on past n.
"""

from __future__ import annotations

import numpy as np

from ..compiled import compiled, inlined
from ..types import BoolArray, FloatArray
from .cubics import CLOSE, STEPS, jet, nearest, newton_step, square

COARSE = 8
"""Intervals a segment whose ends are compared for a first guess of the nearest point."""

TIE = 1e-9
"""Share of a squared distance by which a place in another segment has to be nearer. Inside a corner a curve is as far
from both sides, and rounding errors, which depend on where the outline lies, would decide."""


@compiled
def nearest_together(
    V: int, chain: FloatArray, s: int, low: float, high: float, guess: float, points: FloatArray, p: int, k: int
) -> float:
    """The parameter in [low, high] at which segment s is nearest to a point: Newton's method from a guess."""
    if V == 1:
        return nearest(chain[s], low, high, guess, points[p, k, 0], points[p, k, 1])
    at = guess
    for _ in range(STEPS):
        slope = speed = bend = 0.0
        for v in range(V):
            px, py, dx, dy, ax, ay = jet(chain, s * V + v, at)
            x, y, own = px - points[p * V + v, k, 0], py - points[p * V + v, k, 1], dx * dx + dy * dy
            slope, speed, bend = slope + x * dx + y * dy, speed + own, bend + own + x * ax + y * ay
        if speed <= 0.0:
            break
        before, at = at, newton_step(at, slope, speed, bend, low, high)
        if abs(at - before) < CLOSE:
            break
    return at


@inlined
def square_to(V: int, chain: FloatArray, s: int, z: float, points: FloatArray, p: int, k: int) -> float:
    """The squared distance of segment s at z from a point."""
    total = 0.0
    for v in range(V):
        px, py, _, _, _, _ = jet(chain, s * V + v, z)
        total += square(px - points[p * V + v, k, 0]) + square(py - points[p * V + v, k, 1])
    return total


@compiled
def search_place(
    V: int, chain: FloatArray, low: float, high: float, points: FloatArray, p: int, k: int
) -> float:  # fmt: skip
    """The place between two places of a closed chain that is nearest to a point, as far as coarse points tell."""
    n = len(chain) // V
    if high <= low:
        return low
    best, at = np.inf, low
    for s in range(int(np.floor(low)), int(np.ceil(high))):
        a, b = max(low - s, 0.0), min(high - s, 1.0)
        for step in range(COARSE + 1):
            z = a + (b - a) * step / COARSE
            d = square_to(V, chain, s % n, z, points, p, k)
            if d < best:
                best, at = d, s + z
    s = min(int(np.floor(at)), int(np.ceil(high)) - 1)
    z = nearest_together(V, chain, s % n, max(low - s, 0.0), min(high - s, 1.0), at - s, points, p, k)
    return s + z if square_to(V, chain, s % n, z, points, p, k) <= best else at


@compiled
def near_place(V: int, chain: FloatArray, place: float, low: float, high: float, other: FloatArray, p: int) -> float:
    """The place in [low, high] of a closed chain nearest to where segment p of another begins, from one in between."""
    n, best, at = len(chain) // V, np.inf, place
    for step in range(2):
        here = place
        for _ in range(3):
            s = int(np.floor(here))
            if step == 1 and s == here:
                s -= 1
            a, b = max(low, float(s)), min(high, s + 1.0)
            if b <= a:
                break
            z = nearest_together(V, chain, s % n, a - s, b - s, here - s, other, p, 0)
            d = square_to(V, chain, s % n, z, other, p, 0)
            if d < best * (1 - TIE):
                best, at = d, s + z
            end = b if step == 0 else a
            if s + z != end or end in (low, high):
                break
            here = end
        if place != np.floor(place) and at != np.floor(place):  # it may lie in the segment before
            break
    return at


@compiled
def near_places(
    V: int, chain: FloatArray, hints: FloatArray, other: FloatArray, skip: BoolArray, closed: bool, low: float,
    high: float, places: FloatArray,
) -> None:  # fmt: skip
    """Write the places nearest to where each segment of another chain begins, half-way at most to the next hints.

    Args:
        hints: (n,) increasing places. other: (n V, 4, 2). skip: (n,) which places are not sought, and stay as they are.
        closed: whether the first follows the last a lap later. low, high: bounds of all places, unless ``closed``.
        places: (n,), which may be the hints.
    """
    n, m = len(hints), len(chain) // V
    first, last = hints[0], hints[n - 1]
    before = last - m if closed else low
    for i in range(n):
        hint, after = hints[i], hints[i + 1] if i + 1 < n else first + m if closed else high
        if not skip[i]:
            places[i] = near_place(V, chain, hint, (before + hint) / 2, (hint + after) / 2, other, i)
        before = hint
