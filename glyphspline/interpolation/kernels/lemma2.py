"""Search intervals of a group's footpoints: Lemma 2's interval of every cubic B_i, for SIMD as in ``newton_simd``.

On the spans a, b | c, d around its knot B_i is given by Bernstein coefficients, ``top`` at the knot and three more to
either side. Its peak is on the side where it rises from the knot; the interval has one end beyond the peak, and the
other on the far side of the knot, or between knot and peak if the knot itself lies outside. Both are zeros of cubics
that are monotone between known ends: Newton's method within a bracket, all vertices at once.

The few vertices next to the ends of arcs are looked at one by one: their row of I - B has the absolute sum 2 (1 - W_i)
with W_i = B_i + F_i/2 (:mod:`..intervals`). Fits take intervals one by one too.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled, inlined
from ...intrinsics import fma, select, wide_vectors
from ...types import FloatArray
from ..intervals import END_MARGIN
from ..result import Found
from .blocks import (
    BLOCK, COUNT, FALLBACKS, HALO, HIGH, INTERVALS, LANE, LANES, LEAST, LOW, NATURAL, ONE, PAD, POLYGON, STRIDE, THREE,
    TWO, WIDTH, Given, Group, X, lanes_used, whole_vectors,
)  # fmt: skip
from .newton_simd import cubic

# Fields of the scratch block: top, right, left side; the two problems: coefficients, bracket and estimate of each.
TOP, R1, R2, R3, L1, L2, L3, PEAK, HIGHEST, LEVEL, RISING = (np.uint64(k * STRIDE) for k in range(11))
PROBLEM_A, PROBLEM_B = np.uint64(11 * STRIDE), np.uint64(16 * STRIDE)
B1, B2, B3, INSIDE, OUTSIDE = (np.uint64(k * STRIDE) for k in range(5))
STEPS = 40


@compiled
def _prepare(h: FloatArray, S: FloatArray, first: np.uint64, count: int, margin: float, peak_share: float) -> None:
    """Coefficients, peak and level of the basis functions of ``count`` lanes; h[0] is two intervals before the knot of
    the first.
    """
    wide_vectors()
    for i in range(np.uint64(0), np.uint64(count)):
        j = first + i
        a, b, c, d = h[i], h[i + ONE], h[i + TWO], h[i + THREE]
        left, right = 1.0 / (a + b + c), 1.0 / (b + c + d)
        l1, l2 = (a + b) * left, a * left
        r1, r2 = (c + d) * right, d * right
        l3, r3 = l2 * a / (a + b), r2 * d / (c + d)
        k = b / (b + c)
        top = (1.0 - k) * l1 + k * r1
        rising = r1 > l1
        p1, p2, p3 = select(rising, r1, l1), select(rising, r2, l2), select(rising, r3, l3)
        q1, q2, q3 = select(rising, l1, r1), select(rising, l2, r2), select(rising, l3, r3)
        d0, d1, d2 = p1 - top, p2 - p1, p3 - p2
        root = d1 * d1 - d0 * d2
        root = np.sqrt(select(root > 0.0, root, 0.0))
        y = select(d0 > 0.0, d0 / (d0 - d1 + root), 0.0)
        z = 1.0 - y
        highest = z * z * (z * top + 3.0 * y * p1) + y * y * (3.0 * z * p2 + y * p3)
        level = 0.5 + margin
        share = peak_share * highest
        level = select((peak_share > 0.0) & (share < level), share, level)
        S[TOP + j], S[PEAK + j], S[HIGHEST + j], S[LEVEL + j] = top, y, highest, level
        S[RISING + j] = select(rising, 1.0, 0.0)
        S[PROBLEM_A + B1 + j], S[PROBLEM_A + B2 + j], S[PROBLEM_A + B3 + j] = p1, p2, p3
        S[PROBLEM_A + INSIDE + j] = y
        S[PROBLEM_A + OUTSIDE + j] = 1.0
        outside = top < level  # the knot
        S[PROBLEM_B + B1 + j] = select(outside, p1, q1)
        S[PROBLEM_B + B2 + j] = select(outside, p2, q2)
        S[PROBLEM_B + B3 + j] = select(outside, p3, q3)
        S[PROBLEM_B + INSIDE + j] = select(outside, y, 0.0)
        S[PROBLEM_B + OUTSIDE + j] = select(outside, 0.0, 1.0)


@compiled
def _crossings(S: FloatArray, problem: np.uint64, result: np.uint64, m: int) -> None:
    """Write where every basis function crosses its level to a field, from halfway by at most ``STEPS`` steps.

    R1: estimates. R2: whether converged, which those without a crossing are from the start.
    """
    wide_vectors()
    for j in range(TWO, np.uint64(m) + TWO):
        inside, outside = S[problem + INSIDE + j], S[problem + OUTSIDE + j]
        last, level = S[problem + B3 + j], S[LEVEL + j]
        without = ((outside > 0.5) & (last >= level)) | (S[HIGHEST + j] <= level)
        S[R1 + j] = select(without, outside, 0.5 * (inside + outside))
        S[R2 + j] = select(without, 1.0, 0.0)
    for _ in range(STEPS):
        pending = 0
        for j in range(TWO, np.uint64(m) + TWO):
            b0, b1, b2, b3 = S[TOP + j], S[problem + B1 + j], S[problem + B2 + j], S[problem + B3 + j]
            inside, outside, y, done = S[problem + INSIDE + j], S[problem + OUTSIDE + j], S[R1 + j], S[R2 + j]
            d0, d1 = b1 - b0, b2 - b1
            c1, c2, c3 = 3.0 * d0, 3.0 * (d1 - d0), fma(-3.0, d1, b3 - b0)
            excess = cubic(b0 - S[LEVEL + j], c1, c2, c3, y)
            slope = fma(fma(3.0, c3 * y, 2.0 * c2), y, c1)
            enough = excess >= 0.0
            inside, outside = select(enough, y, inside), select(enough, outside, y)
            step = excess / select(slope == 0.0, 1.0, slope)
            new = y - step
            low, high = select(inside < outside, inside, outside), select(inside < outside, outside, inside)
            new = select((new >= low) & (new <= high) & (slope != 0.0), new, 0.5 * (low + high))
            moved = new - y
            moved = select(moved > 0.0, moved, -moved)
            arrived = done > 0.0
            S[problem + INSIDE + j], S[problem + OUTSIDE + j] = inside, outside
            S[R1 + j] = select(arrived, y, new)
            under_way = (moved > 1e-9) & (done == 0.0)  # the error left is the square of the last step
            S[R2 + j] = select(under_way, 0.0, 1.0)
            pending += select(under_way, 1, 0)
        if pending == 0:
            break
    for j in range(TWO, np.uint64(m) + TWO):
        S[result + j] = S[R1 + j]


@compiled
def _interval(
    S: FloatArray, lane: np.uint64, a: float, b: float, c: float, d: float, variant: int, peak_share: float
) -> tuple[float, float, float, bool]:
    """A vertex's interval about its knot, the least value of B_i on it, and whether Lemma 2 has none.

    a, b | c, d are the knot intervals around the knot.
    """
    if variant == 1:
        return -b, c, min(a / (a + b) * (a / (a + b + c)), d / (c + d) * (d / (b + c + d))), False
    if variant == 3:
        share = b / (b + c)
        return 0.0, 0.0, (1.0 - share) * ((a + b) / (a + b + c)) + share * ((c + d) / (b + c + d)), False
    top, highest, level = S[TOP + lane], S[HIGHEST + lane], S[LEVEL + lane]
    rising, low = S[RISING + lane] > 0.0, S[HIGHEST + lane] <= 0.5
    if low and peak_share == 0.0:
        return 0.0, 0.0, top, True
    along, back = (c, -b) if rising else (-b, c)
    if highest <= level:
        return S[PEAK + lane] * along, S[PEAK + lane] * along, highest, low
    far, near = S[L1 + lane], S[L2 + lane]
    # B_i is at the level at either end, or above it where the interval is clipped
    beyond = S[PROBLEM_A + B3 + lane] if far == 1.0 else level
    before = S[PROBLEM_B + B3 + lane] if near == 1.0 else level
    end, other = far * along, near * (along if top < level else back)
    return min(end, other), max(end, other), min(beyond, before), low


@compiled
def _end_interval(
    given: Given, group: Group, q: int, h: FloatArray, i: int, low: float, high: float, value: float, missing: bool
) -> tuple[float, float, float, bool]:
    """What :func:`_interval` has, for vertex i of an arc near its end; low, …, missing are what B_i alone gives.

    h[0] is the knot interval two before u_i. Where W_i has no interval, or only one below 1/2, B_i alone decides.
    """
    n, row, share = group.table[q, COUNT], group.numbers[q], given.peak_shares[group.table[q, POLYGON]]
    a, b, c, d = h[0], h[1], h[2], h[3]
    left, right, k = 1.0 / (a + b + c), 1.0 / (b + c + d), b / (b + c)
    before, after = np.empty(4), np.empty(4)  # Bernstein coefficients on the spans around the knot
    before[1], before[2], after[1], after[2] = a * left, (a + b) * left, (c + d) * right, d * right
    before[0], after[3] = before[1] * a / (a + b), after[2] * d / (c + d)
    before[3] = after[0] = (1.0 - k) * before[2] + k * after[1]
    margin = add_fixed(h, 1, i, n, row[NATURAL], row[NATURAL + 1], given.margin, before, after)
    if given.variant == 3:
        return low, high, before[3], missing
    first, last, least, found = one_interval(before, after, margin, share if share > 0.0 else 1.0)
    if not found:
        return low, high, value, missing
    return first * (b if first < 0.0 else c), last * (b if last < 0.0 else c), least, False


@compiled
def fill_intervals(given: Given, found: Found, group: Group, slots: int) -> None:
    """Write search intervals, relative to their knots, to the blocks; fallbacks and least values of B_i to the group.

    The lanes between polygons, and beyond the last one, have no crossing.
    """
    S = group.scratch
    for q in range(slots):
        group.table[q, FALLBACKS], group.numbers[q, LEAST] = 0, 1.0
    for b in range(-(-group.table[0, COUNT] // LANES)):
        block, at = group.blocks[b * BLOCK : (b + 1) * BLOCK], b * LANES
        if given.variant == 2:
            for q in range(slots):
                first, inside = group.table[q, LANE] + HALO, min(LANES, group.table[q, COUNT] - at)
                h = group.h[group.table[q, INTERVALS] + at + PAD - 2 :]
                share = given.peak_shares[group.table[q, POLYGON]]
                _prepare(h, S, np.uint64(first), whole_vectors(inside), given.margin, share)
                beyond = first + inside
                for j in range(np.uint64(beyond), np.uint64(min(beyond + WIDTH + 2 * HALO, STRIDE))):
                    S[HIGHEST + j], S[LEVEL + j] = 0.0, 1.0
            m = lanes_used(group, slots, b)
            _crossings(S, PROBLEM_A, L1, m)
            _crossings(S, PROBLEM_B, L2, m)
        for q in range(slots):
            k, n = group.table[q, POLYGON], group.table[q, COUNT]
            h, inside = group.h[group.table[q, INTERVALS] + at + PAD - 2 :], min(LANES, n - at)
            for i in range(inside):
                lane, low, high = np.uint64(group.table[q, LANE] + HALO + i), 0.0, 0.0
                if given.held.shape[0] > 0 and given.held[given.offsets[k] + found.kept[given.offsets[k] + at + i]]:
                    block[LOW + lane] = block[HIGH + lane] = block[X + lane] = 0.0
                    continue
                if given.closed or 0 < at + i < n - 1:
                    low, high, value, missing = _interval(
                        S, lane, h[i], h[i + 1], h[i + 2], h[i + 3], given.variant, given.peak_shares[k]
                    )
                    # A fixed function of an arc reaches no other intervals.
                    if not given.closed and given.variant > 1 and not 2 < at + i < n - 3:
                        low, high, value, missing = _end_interval(
                            given, group, q, h[i:], at + i, low, high, value, missing
                        )
                    group.table[q, FALLBACKS] += missing
                    group.numbers[q, LEAST] = min(group.numbers[q, LEAST], value)
                block[LOW + lane], block[HIGH + lane], block[X + lane] = low, high, 0.0


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


@inlined
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
    right = b[1] > b[0]
    c0, c1, c2, c3 = (b[0], b[1], b[2], b[3]) if right else (a[3], a[2], a[1], a[0])  # away from u_i, rising
    d0, d1, d2 = c1 - c0, c2 - c1, c3 - c2
    square = d1 * d1 - d0 * d2
    if d0 <= 0.0:
        peak = 0.0
    elif square < 0.0 or (d1 >= 0.0 and d2 > 0.0):  # fixed functions may raise the end again, where W_i is below 1/2
        peak = 1.0
    else:
        peak = d0 / (d0 - d1 + np.sqrt(square))
    c, peak = (b, peak) if right else (a, -peak)
    top = _bernstein(c[0], c[1], c[2], c[3], peak if right else peak + 1)
    level = min(0.5 + margin, share * top)
    if top <= 0.5 or level < 0.5:
        return 0.0, 0.0, b[0], False
    if top <= level:
        return peak, peak, top, True
    low, high = -1.0, 1.0
    if a[0] < level:
        before = a[3] >= level or not right  # the function rises to the level on the span before u_i
        c = a if before else b
        stop = 1.0 if a[3] >= level and right else (peak if right else peak + 1)
        low = _crossing(c[0], c[1], c[2], c[3], level, 0.0, stop) - (1.0 if before else 0.0)
    if b[3] < level:
        after = b[0] >= level or right
        c = b if after else a
        start = 0.0 if b[0] >= level and not right else (peak if right else peak + 1)
        high = _crossing(c[0], c[1], c[2], c[3], level, start, 1.0) - (0.0 if after else 1.0)
    return low, high, min(max(a[0], level), max(b[3], level)), True


@inlined
def _bernstein(c0: float, c1: float, c2: float, c3: float, x: float) -> float:
    y = 1 - x
    return y * y * (y * c0 + 3 * x * c1) + x * x * (3 * y * c2 + x * c3)


@compiled
def _crossing(c0: float, c1: float, c2: float, c3: float, level: float, low: float, high: float) -> float:
    """Where a cubic takes a value between those at ``low`` and ``high``, which it does only once between them."""
    rising = _bernstein(c0, c1, c2, c3, high) > _bernstein(c0, c1, c2, c3, low)
    x = (low + high) / 2
    for _ in range(60):
        f = _bernstein(c0, c1, c2, c3, x) - level
        if (f > 0) == rising:
            high = x
        else:
            low = x
        y = 1 - x
        slope = 3 * (y * y * (c1 - c0) + 2 * x * y * (c2 - c1) + x * x * (c3 - c2))
        new = x - f / slope if slope != 0 else (low + high) / 2
        if not low < new < high:
            new = (low + high) / 2
        if abs(new - x) < 1e-12:
            return new
        x = new
    return x
