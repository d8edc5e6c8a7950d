"""Search intervals of footpoints: Lemma 2's interval of a cubic B_i, and those of the other variants.

On the two spans beside its knot B_i is given by Bernstein coefficients. It has one peak, on the side on which it rises
from the knot, the *main side*; y runs away from the knot there. Where it is as high as the level, 1/2 + c, is an
interval with one end beyond the peak, and the other on the far side of the knot, or between knot and peak if the knot
itself lies outside.

Vertices are taken ``TOGETHER``, one stage after another, without branches: a compiler can do with several vertices what
is written for one, and :mod:`..plain` calls the stages with arrays. For the first and the last two vertices of an arc
W_i = B_i + F_i/2 takes the place of B_i (:mod:`..intervals`): they are done one by one.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled, inlined
from ...intrinsics import chosen
from ...types import FloatArray, Real
from ..method import END_MARGIN
from ..found import Rule

TOGETHER, ROW = 64, 132
"""Vertices taken together, and the distance of their rows, which have room for two crossings a vertex."""

# Rows of room. Of each crossing: powers of the function less the level, what bounds it on both sides, where it is, and
# whether that is final. Of each vertex: whether the main side is that behind the knot, the sign of the second crossing;
# the least value on the interval, and 1 where Lemma 2 has none.
K0, K1, K2, K3, INSIDE, OUTSIDE, AT, FINAL, BEHIND, SIGN, LEAST, MISSING = (k * ROW for k in range(12))
ROOM = 12 * ROW

STEPS = 60
CLOSE = 1e-6
"""A step this small (share of the span) is the last of Halley's method: what it leaves is the cube of that."""

Function = tuple[Real, Real, Real, Real, Real, Real, Real]
"""Bernstein coefficients of a function on the spans before and behind its knot, which share the fourth."""

Crossing = tuple[Real, Real, Real, Real, Real, Real, Real, Real]
"""What the rows of a crossing have."""


@compiled
def set_intervals(h: FloatArray, k: int, rule: Rule, peak_share: float, bounds: FloatArray, R: FloatArray) -> None:
    """Write the intervals (m, 2) of m vertices from k on, about their knots, and the rows ``LEAST`` and ``MISSING``.

    Args:
        h: knot intervals; h[j] is the one after u_j. m is ``TOGETHER`` at most.
        peak_share: of ``fallback="peak"``, 0 for "knot".
        R: ``ROOM`` numbers.
    """
    m = bounds.shape[0]
    if rule.variant in (0, 1, 3):
        for j in range(m):
            i = k + j
            bounds[j, 0], bounds[j, 1], R[LEAST + j] = simple(h[i - 2], h[i - 1], h[i], h[i + 1], rule.variant)
            R[MISSING + j] = 0.0
        return
    for j in range(m):
        i, n = k + j, TOGETHER + j
        first, second, (R[BEHIND + j], R[SIGN + j], R[LEAST + j], R[MISSING + j], _) = begin(
            coefficients(h[i - 2], h[i - 1], h[i], h[i + 1]), rule.margin, peak_share
        )
        R[K0 + j], R[K1 + j], R[K2 + j], R[K3 + j], R[INSIDE + j], R[OUTSIDE + j], R[AT + j], R[FINAL + j] = first
        R[K0 + n], R[K1 + n], R[K2 + n], R[K3 + n], R[INSIDE + n], R[OUTSIDE + n], R[AT + n], R[FINAL + n] = second
    for first_row in (0, TOGETHER):
        _cross(R[first_row:], m)
    for j in range(m):
        none = (R[MISSING + j] > 0.0) & (peak_share == 0.0)
        bounds[j, 0], bounds[j, 1] = finish(
            R[AT + j], R[AT + TOGETHER + j], R[BEHIND + j], R[SIGN + j], none, h[k + j - 1], h[k + j]
        )


@compiled
def _cross(R: FloatArray, m: int) -> None:
    """Halley's method for m crossings, until all are final."""
    for _ in range(STEPS):
        pending = 0
        for j in range(m):
            done, x = R[FINAL + j] > 0.0, R[AT + j]
            new, R[INSIDE + j], R[OUTSIDE + j], final = halley(
                R[K0 + j], R[K1 + j], R[K2 + j], R[K3 + j], R[INSIDE + j], R[OUTSIDE + j], x
            )
            R[AT + j], R[FINAL + j] = (x if done else new), (1.0 if done | final else 0.0)
            pending += 0 if done | final else 1
        if pending == 0:
            break


@inlined
def simple(a: Real, b: Real, c: Real, d: Real, variant: int) -> tuple[Real, Real, Real]:
    """The interval of variant 0, 1 or 3 for a vertex among spans a, b, c and d, and the least value of B_i on it."""
    before, _, _, knot, _, _, after = coefficients(a, b, c, d)
    if variant == 0:
        return -(a + b), c + d, 0.0 * knot
    if variant == 1:
        return -b, c, chosen(after < before, after, before)
    return 0.0 * knot, 0.0 * knot, knot


@inlined
def begin(
    function: Function, margin: float, peak_share: Real
) -> tuple[Crossing, Crossing, tuple[Real, Real, Real, Real, Real]]:
    """Lemma 2 for a vertex's function: its two crossings before the first step, the rows of the vertex, the level."""
    before0, before1, before2, knot, behind1, behind2, behind3 = function
    behind = behind1 > knot
    c1, o1 = chosen(behind, behind1, before2), chosen(behind, before2, behind1)
    c2, o2 = chosen(behind, behind2, before1), chosen(behind, before1, behind2)
    c3, o3 = chosen(behind, behind3, before0), chosen(behind, before0, behind3)
    d0, d1, d2 = c1 - knot, c2 - c1, c3 - c2
    square = d1 * d1 - d0 * d2
    # Fixed functions may raise the end of a side again, where W_i is below 1/2.
    y = chosen((square < 0.0) | ((d1 >= 0.0) & (d2 > 0.0)), 1.0, d0 / (d0 - d1 + np.sqrt(square)))
    y = chosen(d0 <= 0.0, 0.0, y)
    x = 1.0 - y
    top = x * x * (x * knot + 3.0 * y * c1) + y * y * (3.0 * x * c2 + y * c3)
    level = 0.5 + margin
    level = chosen((peak_share > 0.0) & (peak_share * top < level), peak_share * top, level)
    alone, outside, whole = top <= level, knot < level, c3 >= level
    clipped = (knot >= level) & (o3 >= level)
    final = chosen(alone | whole, 1.0, 0.0)
    at = chosen(alone, y, chosen(whole, 1.0, 0.5 * (y + 1.0)))
    first = (*powers(knot, c1, c2, c3, level), y, 1.0 + 0.0 * y, at, final)
    b1, b2, b3 = chosen(outside, c1, o1), chosen(outside, c2, o2), chosen(outside, c3, o3)
    inside, limit = chosen(outside, y, 0.0), chosen(outside, 0.0, 1.0)
    at = chosen(alone, y, chosen(clipped, 1.0, 0.5 * (inside + limit)))
    second = (*powers(knot, b1, b2, b3, level), inside, limit, at, chosen(alone | clipped, 1.0, 0.0))
    main, other = chosen(whole, c3, level), chosen(clipped, o3, level)
    missing = top <= 0.5
    least = chosen(alone, top, chosen(other < main, other, main))
    least = chosen(missing & (peak_share == 0.0), knot, least)
    return (
        first,
        second,
        (chosen(behind, 1.0, 0.0), chosen(alone | outside, 1.0, -1.0), least, chosen(missing, 1.0, 0.0), level),
    )


@inlined
def finish(x: Real, y: Real, behind: Real, sign: Real, none: Real, b: Real, c: Real) -> tuple[Real, Real]:
    """The interval of a vertex between spans b and c: from its crossings, or, where there is none, the knot."""
    far, near = x, sign * y
    low, high = chosen(behind > 0.0, near, -far), chosen(behind > 0.0, far, -near)
    low, high = chosen(none, 0.0, low), chosen(none, 0.0, high)
    return low * chosen(low < 0.0, b, c), high * chosen(high < 0.0, b, c)


@compiled
def arc_interval(
    h: FloatArray, j: int, i: int, n: int, rule: Rule, peak_share: float, natural: FloatArray, sides: FloatArray
) -> tuple[float, float, float, bool]:
    """The interval of vertex i of an arc of n, of the first or the last two inner ones, by W_i, in variants 2 to 4.

    Args:
        h: knot intervals; h[j] is the one after u_i.
        peak_share: of ``fallback="peak"``, 0 for "knot".
        natural: (2,) see :func:`add_fixed`. sides: (2, 4) scratch.

    Returns:
        The interval about the knot, the least value on it, and whether it stands in place of that of B_i.
    """
    left, right, before, after = h[j - 1], h[j], sides[0], sides[1]
    before[0], before[1], before[2], before[3], after[1], after[2], after[3] = coefficients(
        h[j - 2], left, right, h[j + 1]
    )
    after[0] = before[3]
    c = add_fixed(h, j - 1, i, n, natural[0], natural[1], rule.margin, before, after)
    if rule.variant == 3:
        return 0.0, 0.0, before[3], True
    low, high, least, found = one_interval(before, after, c, peak_share)
    return low * (left if low < 0.0 else right), high * (left if high < 0.0 else right), least, found


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
def one_interval(a: FloatArray, b: FloatArray, margin: float, peak_share: float) -> tuple[float, float, float, bool]:
    """Lemma 2 for one vertex: where its function is at least 1/2 + c, or as high as it gets if that is lower.

    Args:
        a, b: (4,) Bernstein coefficients of the function on the span before u_i and on the span after it.
        margin: c of the lemma. peak_share: of ``fallback="peak"``, 0 for "knot".

    Returns:
        The interval's ends, each as a signed share of its span (-1 is u_{i-1}, +1 is u_{i+1}), the least value on it,
        and whether that is an interval of the lemma: 0, 0, the value at u_i and False where the function does not rise
        above 1/2, or the level is below.
    """
    function = a[0], a[1], a[2], b[0], b[1], b[2], b[3]
    first, second, (behind, sign, least, missing, level) = begin(function, margin, peak_share)
    if missing > 0.0 or level < 0.5:
        return 0.0, 0.0, b[0], False
    low, high = finish(crossing(first), crossing(second), behind, sign, False, 1.0, 1.0)
    return low, high, least, True


@inlined
def crossing(begun: Crossing) -> float:
    """Where a crossing is in the end."""
    k0, k1, k2, k3, inside, outside, x, final = begun
    for _ in range(STEPS):
        if final > 0.0:
            break
        x, inside, outside, last = halley(k0, k1, k2, k3, inside, outside, x)
        final = 1.0 if last else 0.0
    return x


@inlined
def powers(c0: Real, c1: Real, c2: Real, c3: Real, level: Real) -> tuple[Real, Real, Real, Real]:
    """A cubic in Bernstein form, less a level, by powers."""
    k1 = 3.0 * (c1 - c0)
    return c0 - level, k1, 3.0 * (c2 - c1) - k1, c3 - c0 + 3.0 * (c1 - c2)


@inlined
def halley(
    k0: Real, k1: Real, k2: Real, k3: Real, inside: Real, outside: Real, x: Real
) -> tuple[Real, Real, Real, Real]:
    """A step of Halley's method from x, what bounds the crossing then, and whether it was the last one."""
    excess, bend = k0 + x * (k1 + x * (k2 + x * k3)), k2 + 3.0 * x * k3
    slope = k1 + x * (k2 + bend)
    above = excess >= 0.0
    inside, outside = chosen(above, x, inside), chosen(above, outside, x)
    steep = slope * slope - excess * bend
    new = x - excess * slope / chosen(steep != 0.0, steep, 1.0)
    near, rising = abs(new - x) <= CLOSE, inside < outside
    between = (chosen(rising, inside, outside) < new) & (new < chosen(rising, outside, inside))
    new = chosen(near | between, new, 0.5 * (inside + outside))
    return new, inside, outside, near | (new == x)
