"""Search intervals of footpoints: Lemma 2's interval of a cubic B_i, and those of the other variants.

On the two spans beside its knot B_i is given by Bernstein coefficients. It has one peak, on the side on which it rises
from the knot, the *main side*; y runs away from the knot there. Where it is as high as the level, 1/2 + c, is an
interval with one end beyond the peak, and the other on the far side of the knot, or between knot and peak if the knot
itself lies outside.

For the first and the last two vertices of an arc W_i = B_i + F_i/2 takes the place of B_i (:mod:`..intervals`).
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...types import FloatArray, Real
from ..method import END_MARGIN, Rule

STEPS = 60
CLOSE = 1e-6
"""A step this small (share of the span) is the last of Halley's method: what it leaves is the cube of that."""

Side = tuple[float, float, float]
"""Bernstein coefficients of a function on one side of its knot, from there outwards."""


@compiled
def vertex_interval(
    h: FloatArray, j: int, i: int, n: int, rule: Rule, peak_share: float, natural: FloatArray, sides: FloatArray
) -> tuple[float, float, float, bool]:
    """The interval of vertex i of n about its knot, the least value of B_i on it, and whether Lemma 2 has none.

    Args:
        h: knot intervals; h[j] is the one after u_i.
        peak_share: of ``fallback="peak"``, 0 for "knot".
        natural: (2,) see :func:`add_fixed`. sides: (2, 4) scratch.
    """
    left, right, variant = h[j - 1], h[j], rule.variant
    if variant == 0:
        return -(h[j - 2] + left), right + h[j + 1], 0.0, False
    a0, a1, a2, knot, b1, b2, b3 = coefficients(h[j - 2], left, right, h[j + 1])
    if variant == 1:
        return -left, right, min(a0, b3), False
    if not rule.closed and not 2 < i < n - 3:  # a fixed function of an arc reaches no other intervals
        before, after = sides[0], sides[1]
        before[0], before[1], before[2], before[3] = a0, a1, a2, knot
        after[0], after[1], after[2], after[3] = knot, b1, b2, b3
        c = add_fixed(h, j - 1, i, n, natural[0], natural[1], rule.margin, before, after)
        if variant == 3:
            return 0.0, 0.0, before[3], False
        low, high, least, found = one_interval(before, after, c, peak_share if peak_share > 0.0 else 1.0)
        if found:
            return low * (left if low < 0.0 else right), high * (left if high < 0.0 else right), least, False
    if variant == 3:
        return 0.0, 0.0, knot, False
    rises, before_knot, behind_knot = b1 > knot, (a2, a1, a0), (b1, b2, b3)
    main, other = (behind_knot, before_knot) if rises else (before_knot, behind_knot)
    y, top = peak_of(knot, main)
    if top <= 0.5 and peak_share == 0.0:
        return 0.0, 0.0, knot, True
    level = 0.5 + rule.margin
    if peak_share > 0.0:
        level = min(level, peak_share * top)
    near, far, least = level_interval(knot, main, other, y, top, level)
    low, high = (near, far) if rises else (-far, -near)
    return low * (left if low < 0.0 else right), high * (left if high < 0.0 else right), least, top <= 0.5


@compiled
def coefficients(a: Real, b: Real, c: Real, d: Real) -> tuple[Real, Real, Real, Real, Real, Real, Real]:
    """Bernstein coefficients of a cubic basis function on its inner spans b and c, of four; they share the fourth."""
    left, right, share = 1.0 / (a + b + c), 1.0 / (b + c + d), b / (b + c)
    before1, before2, after1, after2 = a * left, (a + b) * left, (c + d) * right, d * right
    top = (1.0 - share) * before2 + share * after1
    return before1 * a / (a + b), before1, before2, top, after1, after2, after2 * d / (c + d)


@compiled
def add_fixed(
    h: FloatArray, at: int, i: int, n: int, first: float, last: float, margin: float, before: FloatArray,
    after: FloatArray,
) -> float:  # fmt: skip
    """Make W_i of B_i, for inner vertex i of an arc of n vertices; they differ for the first two and the last two.

    Returns the margin of the vertex: ``END_MARGIN`` at least for the first and the last of the inner ones.

    Args:
        h: knot intervals; h[at] is the one before u_i.
        first, last: weights of the first and the last free control point in those beside them; 0 for end tangents.
        before, after: (4,) Bernstein coefficients on the spans before and after u_i.
    """
    if i == 1:
        a, b, c = end_shares(h[at], h[at + 1], 1.0 + first)
        before[0] += 0.5
        before[1] += a
        before[2] += b
        before[3] += c
        after[0] += c
    if i == 2:
        before[0] += end_shares(h[at - 1], h[at], 1.0 - first)[2]
    if i == n - 2:
        a, b, c = end_shares(h[at + 1], h[at], 1.0 + last)
        after[3] += 0.5
        after[2] += a
        after[1] += b
        after[0] += c
        before[3] += c
    if i == n - 3:
        after[3] += end_shares(h[at + 2], h[at + 1], 1.0 - last)[2]
    return max(margin, END_MARGIN) if i in (1, n - 2) else margin


@compiled
def end_shares(nearest: float, beyond: float, weight: float) -> tuple[float, float, float]:
    """Bernstein coefficients 1 to 3, on the span at an end of an arc, of half the function beside that of the end.

    Args:
        nearest, beyond: the knot intervals at the end. weight: of the function in F_i.
    """
    half, share = 0.5 * weight, beyond / (nearest + beyond)
    return half, half * share, half * share * share


@compiled
def one_interval(a: FloatArray, b: FloatArray, margin: float, share: float) -> tuple[float, float, float, bool]:
    """Lemma 2 for one vertex: where its function is at least 1/2 + c, or as high as it gets if that is lower.

    Args:
        a, b: (4,) Bernstein coefficients of the function on the span before u_i and on the span after it.
        margin: c of the lemma.
        share: of the peak, a bound on the level (``fallback="peak"``); 1 is ``fallback="knot"``.

    Returns:
        The interval's ends, each as a signed share of its span (-1 is u_{i-1}, +1 is u_{i+1}), the least value on it,
        and whether that is an interval of the lemma: 0, 0, the value at u_i and False where the function does not rise
        above 1/2, or the level is below.
    """
    rises = b[1] > b[0]
    before, behind = (a[2], a[1], a[0]), (b[1], b[2], b[3])
    main, other = (behind, before) if rises else (before, behind)
    y, top = peak_of(b[0], main)
    level = min(0.5 + margin, share * top)
    if top <= 0.5 or level < 0.5:
        return 0.0, 0.0, b[0], False
    near, far, least = level_interval(b[0], main, other, y, top, level)
    low, high = (near, far) if rises else (-far, -near)
    return low, high, least, True


@compiled
def peak_of(knot: float, main: Side) -> tuple[float, float]:
    """Where on the main side a function is highest, and how high it is there."""
    c1, c2, c3 = main
    d0, d1, d2 = c1 - knot, c2 - c1, c3 - c2
    square = d1 * d1 - d0 * d2
    if d0 <= 0.0:
        y = 0.0
    elif square < 0.0 or (d1 >= 0.0 and d2 > 0.0):  # fixed functions may raise the end again, where W_i is below 1/2
        y = 1.0
    else:
        y = d0 / (d0 - d1 + np.sqrt(square))
    return y, value_at(knot, c1, c2, c3, y)


@compiled
def level_interval(
    knot: float, main: Side, other: Side, y: float, top: float, level: float
) -> tuple[float, float, float]:
    """The ends of the interval on which a function is at least ``level``, as shares along the main side; its least.

    Args:
        knot: the function there.
        y, top: its peak, as :func:`peak_of` has it; where ``top`` is not above the level, the interval is that alone.
    """
    (c1, c2, c3), (o1, o2, o3) = main, other
    if top <= level:
        return y, y, top
    far = 1.0 if c3 >= level else crossing(knot, c1, c2, c3, level, y, 1.0)
    least = c3 if c3 >= level else level
    if knot < level:
        return crossing(knot, c1, c2, c3, level, y, 0.0), far, min(least, level)
    near = -1.0 if o3 >= level else -crossing(knot, o1, o2, o3, level, 0.0, 1.0)
    return near, far, min(least, o3 if o3 >= level else level)


@compiled
def value_at(c0: Real, c1: Real, c2: Real, c3: Real, x: Real) -> Real:
    """A cubic in Bernstein form."""
    y = 1.0 - x
    return y * y * (y * c0 + 3.0 * x * c1) + x * x * (3.0 * y * c2 + x * c3)


@compiled
def crossing(c0: float, c1: float, c2: float, c3: float, level: float, inside: float, outside: float) -> float:
    """Where a cubic falls below a level, once between ``inside``, where it is as high, and ``outside``."""
    k0, k1, k3 = c0 - level, 3.0 * (c1 - c0), c3 - c0 + 3.0 * (c1 - c2)
    k2 = 3.0 * (c2 - c1) - k1
    x = 0.5 * (inside + outside)
    for _ in range(STEPS):
        excess, bend = k0 + x * (k1 + x * (k2 + x * k3)), k2 + 3.0 * x * k3
        slope = k1 + x * (k2 + bend)
        if excess >= 0.0:
            inside = x
        else:
            outside = x
        steep = slope * slope - excess * bend
        before, x = x, x - excess * slope / (steep if steep != 0.0 else 1.0)
        if abs(x - before) <= CLOSE:
            break
        if not min(inside, outside) < x < max(inside, outside):
            x = 0.5 * (inside + outside)
        if x == before:
            break
    return x
