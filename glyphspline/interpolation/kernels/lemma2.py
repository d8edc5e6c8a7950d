"""Where the footpoints of a block are sought: Lemma 2's interval of every cubic B_i, for SIMD as in ``lanes``.

On the spans a, b | c, d around its knot B_i is given by Bernstein coefficients, ``top`` at the knot and three more to
either side. Its peak is on the side where it rises from the knot; the interval has one end beyond the peak, and the
other on the far side of the knot, or between knot and peak if the knot itself lies outside. Both are zeros of cubics
that are monotone between known ends: Newton's method within a bracket, all vertices at once.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled, fma, inlined, select, wide_vectors
from . import blocks as fields
from .blocks import HALO, LANES, STRIDE
from .layout import PAD
from .newton_simd import cubic

ONE, TWO, FOUR, EIGHT = (np.uint64(k) for k in (1, 2, 4, 8))
LOW, HIGH, X = np.uint64(fields.LOW), np.uint64(fields.HIGH), np.uint64(fields.X)
# Fields of the scratch block: top, right, left side; the two problems: coefficients, bracket and estimate of each.
TOP, R1, R2, R3, L1, L2, L3, PEAK, HIGHEST, LEVEL, RISING = (np.uint64(k * STRIDE) for k in range(11))
PROBLEM_A, PROBLEM_B = np.uint64(11 * STRIDE), np.uint64(16 * STRIDE)
B1, B2, B3, INSIDE, OUTSIDE = (np.uint64(k * STRIDE) for k in range(5))
STEPS = 40
CLOSE = 1e-9
"""A Newton step of this share of the span is the last: its square is what is left."""


@inlined
def _prepare(h, S, m, margin, peak_share, step):
    """Coefficients, peak and level of every basis function; h[0] is the interval two before the first vertex's knot."""
    for j in range(TWO * step, np.uint64(m) + TWO * step):
        a, b, c, d = h[j - TWO * step], h[j - step], h[j], h[j + step]
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
def _prepare_1(h, S, m, margin, peak_share):
    wide_vectors()
    _prepare(h, S, m, margin, peak_share, ONE)


@compiled
def _prepare_4(h, S, m, margin, peak_share):
    wide_vectors()
    _prepare(h, S, m, margin, peak_share, FOUR)


@compiled
def _prepare_8(h, S, m, margin, peak_share):
    wide_vectors()
    _prepare(h, S, m, margin, peak_share, EIGHT)


@compiled
def _start(S, problem, first, m):
    """First estimates, into R1: halfway. R2 says which have arrived: those without a crossing have from the start."""
    for j in range(first, np.uint64(m) + first):
        inside, outside = S[problem + INSIDE + j], S[problem + OUTSIDE + j]
        last, level = S[problem + B3 + j], S[LEVEL + j]
        without = ((outside > 0.5) & (last >= level)) | (S[HIGHEST + j] <= level)
        S[R1 + j] = select(without, outside, 0.5 * (inside + outside))
        S[R2 + j] = select(without, 1.0, 0.0)


@compiled
def _newton(S, problem, first, m):
    """One step for every crossing; the number of those still under way."""
    wide_vectors()
    pending = 0
    for j in range(first, np.uint64(m) + first):
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
        under_way = (moved > CLOSE) & (done == 0.0)
        S[R2 + j] = select(under_way, 0.0, 1.0)
        pending += select(under_way, 1, 0)
    return pending


@compiled
def _crossings(S, problem, result, first, m):
    _start(S, problem, first, m)
    for _ in range(STEPS):
        if _newton(S, problem, first, m) == 0:
            break
    for j in range(first, np.uint64(m) + first):
        S[result + j] = S[R1 + j]


@compiled
def _combine(S, j, b, c, peak_share):
    """One vertex's interval about its knot, the least value of B_i on it, and whether B_i nowhere exceeds 1/2."""
    top, highest, level = S[TOP + j], S[HIGHEST + j], S[LEVEL + j]
    rising, low = S[RISING + j] > 0.0, S[HIGHEST + j] <= 0.5
    if low and peak_share == 0.0:
        return 0.0, 0.0, top, True
    along, back = (c, -b) if rising else (-b, c)
    if highest <= level:
        return S[PEAK + j] * along, S[PEAK + j] * along, highest, low
    far, near = S[L1 + j], S[L2 + j]
    # B_i is at the level at either end, or above it where the interval is clipped
    beyond = S[PROBLEM_A + B3 + j] if far == 1.0 else level
    before = S[PROBLEM_B + B3 + j] if near == 1.0 else level
    end, other = far * along, near * (along if top < level else back)
    return min(end, other), max(end, other), min(beyond, before), low


@compiled
def _prepared(h, S, first, m, margin, peak_share):
    """Coefficients and crossings of all basis functions of a block."""
    if first == TWO:
        _prepare_1(h, S, m, margin, peak_share)
    elif first == EIGHT:
        _prepare_4(h, S, m, margin, peak_share)
    else:
        _prepare_8(h, S, m, margin, peak_share)
    _crossings(S, PROBLEM_A, L1, first, m)
    _crossings(S, PROBLEM_B, L2, first, m)


@compiled
def _interval(S, lane, a, b, c, d, variant, peak_share):
    """The interval about the knot between b and c, the least value of B_i on it, and whether Lemma 2 has none."""
    if variant == 1:
        return -b, c, min(a / (a + b) * (a / (a + b + c)), d / (c + d) * (d / (b + c + d))), False
    if variant == 3:
        share = b / (b + c)
        return 0.0, 0.0, (1.0 - share) * ((a + b) / (a + b + c)) + share * ((c + d) / (b + c + d)), False
    return _combine(S, lane, b, c, peak_share)


@compiled
def fill_intervals(blocks, scratch, n, first, last, h, variant, margin, peak_share):
    """Where every footpoint is sought, relative to its knot. Returns the fallbacks and the least value of any B_i."""
    fallbacks, least = 0, 1.0
    for first_of_block in range(0, n, LANES):
        block, count = blocks[first_of_block // LANES], min(LANES, n - first_of_block)
        if variant == 2:
            _prepared(h[PAD + first_of_block - 2 :], scratch, TWO, (count + 7) // 8 * 8, margin, peak_share)
        for k in range(count):
            i, lane = first_of_block + k, np.uint64(k + HALO)
            low = high = 0.0
            if first <= i < last:
                a, b, c, d = h[PAD + i - 2], h[PAD + i - 1], h[PAD + i], h[PAD + i + 1]
                low, high, value, missing = _interval(scratch, lane, a, b, c, d, variant, peak_share)
                fallbacks += missing
                least = min(least, value)
            block[LOW + lane], block[HIGH + lane], block[X + lane] = low, high, 0.0
    return fallbacks, least


@compiled
def fill_intervals_side_by_side(block, scratch, step, counts, h, variant, margin, peak_share, fallbacks, least):
    """The same for closed polygons of ``counts`` vertices in one block, whose intervals h lie as they do.

    Fallbacks and least values of a B_i are left in the arrays of these names, one number for each polygon.
    """
    first = HALO * step
    if variant == 2:
        m = (counts.max() * step + 7) // 8 * 8
        _prepared(h[(PAD - HALO) * step :], scratch, np.uint64(first), m, margin, peak_share)
    for k in range(counts.shape[0]):
        fallbacks[k], least[k] = 0, 1.0
        for i in range(counts[k]):
            lane, at = np.uint64(first + i * step + k), (PAD + i) * step + k
            a, b, c, d = h[at - 2 * step], h[at - step], h[at], h[at + step]
            low, high, value, missing = _interval(scratch, lane, a, b, c, d, variant, peak_share)
            fallbacks[k] += missing
            least[k] = min(least[k], value)
            block[LOW + lane], block[HIGH + lane], block[X + lane] = low, high, 0.0
