"""The control points whose curve passes through every vertex at given parameters: a cyclic banded system, in O(n).

Row i has B_j(t_i), |j - i| ≤ 2. With t_i in Lemma 2's interval the diagonal is at least 1/2 and outweighs the rest of
the row, so elimination needs no exchange of rows. A closed curve's corners are cut off by keeping the last two unknowns
for the end: the band of the others is eliminated with them as two more right-hand sides, which leaves a 2 x 2 system.

A row of the array ``rows`` holds the five diagonals, the main one at number 2, then four right-hand sides: errors in x
and y, and the coefficients of the two unknowns kept for the end.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled, select
from . import blocks as fields
from .blocks import HALO, LANES
from .layout import PAD

BAND, RIGHT, ROW = 5, 5, 9
X, EX, EY, RATE, HALF, THIRD = (
    np.uint64(k) for k in (fields.X, fields.EX, fields.EY, fields.RATE, fields.HALF, fields.THIRD)
)
ONE, TWO = np.uint64(1), np.uint64(2)
SMALLEST_PIVOT = 1e-14


@compiled
def collocation(blocks, n, h, rows):
    """B_{i-2} … B_{i+2} at u_i + x and the errors of every vertex, into rows: Cox and de Boor on the span of u_i + x.

    The reciprocals are those that a block keeps: of one, two and three knot intervals.
    """
    for b in range((n + LANES - 1) // LANES):
        block = blocks[b]
        for lane in range(min(LANES, n - b * LANES)):
            row = rows[b * LANES + lane]
            j = np.uint64(lane + HALO)
            x = block[X + j]
            right = x >= 0.0
            k = b * LANES + lane + PAD - (0 if right else 1)
            j -= select(right, np.uint64(0), ONE)
            before, here, after = h[k - 1], h[k], h[k + 1]
            a = x if right else x + here  # from the span's left end; b to its right end
            b_ = here - a
            third, third1, third2 = block[RATE + j] / 3.0, block[RATE + j + ONE] / 3.0, block[RATE + j + TWO] / 3.0
            inverse = 3.0 * block[THIRD + j]
            p, q = b_ * inverse * block[HALF + j], a * inverse * block[HALF + j + ONE]
            m0, m1, m2 = b_ * p * third, ((a + before) * p + (b_ + after) * q) * third1, a * q * third2
            n0, n3 = b_ * m0, a * m2
            n1 = (a + h[k - 2] + before) * m0 + (b_ + after) * m1
            n2 = (a + before) * m1 + (b_ + after + h[k + 2]) * m2
            row[0] = select(right, 0.0, n0)
            row[1] = select(right, n0, n1)
            row[2] = select(right, n1, n2)
            row[3] = select(right, n2, n3)
            row[4] = select(right, n3, 0.0)
            j = np.uint64(lane + HALO)
            row[5], row[6], row[7], row[8] = block[EX + j], block[EY + j], 0.0, 0.0


@compiled
def eliminate(rows):
    """Solve the band for all four right-hand sides, in place. False if a pivot vanishes.

    The two rows before travel along as numbers: inverse pivot, two entries above the diagonal, right-hand sides.
    """
    i1 = e1 = f1 = p0 = p1 = p2 = p3 = 0.0
    i2 = e2 = f2 = q0 = q1 = q2 = q3 = 0.0
    for i in range(rows.shape[0]):
        row = rows[i]
        far = row[0] * i2
        near = (row[1] - far * e2) * i1
        pivot = row[2] - far * f2 - near * e1
        if not abs(pivot) > SMALLEST_PIVOT:
            return False
        e2, f2, i2 = e1, f1, i1
        e1, f1, i1 = row[3] - near * f1, row[4], 1.0 / pivot
        q0, p0 = p0, row[5] - near * p0 - far * q0
        q1, p1 = p1, row[6] - near * p1 - far * q1
        q2, p2 = p2, row[7] - near * p2 - far * q2
        q3, p3 = p3, row[8] - near * p3 - far * q3
        row[2], row[3] = i1, e1
        row[5], row[6], row[7], row[8] = p0, p1, p2, p3
    p0 = p1 = p2 = p3 = q0 = q1 = q2 = q3 = 0.0
    for i in range(rows.shape[0] - 1, -1, -1):
        row = rows[i]
        inverse, near, far = row[2], row[3], row[4]
        q0, p0 = p0, (row[5] - near * p0 - far * q0) * inverse
        q1, p1 = p1, (row[6] - near * p1 - far * q1) * inverse
        q2, p2 = p2, (row[7] - near * p2 - far * q2) * inverse
        q3, p3 = p3, (row[8] - near * p3 - far * q3) * inverse
        row[5], row[6], row[7], row[8] = p0, p1, p2, p3
    return True


@compiled
def eliminate_cyclic(rows, n):
    """The same with rows that wrap around, n ≥ 5. The solution is at numbers 5 and 6 of each row."""
    m = n - 2
    for i in (0, 1, m - 2, m - 1):
        for k in range(BAND):
            j = i + k - 2
            if (j < 0 or j >= m) and rows[i, k] != 0.0:
                rows[i, RIGHT + 2 + (j + n if j < 0 else j) - m] += rows[i, k]
                rows[i, k] = 0.0
    if not eliminate(rows[:m]):
        return False
    s = np.zeros((2, 4))  # the last two rows, with the others' solution put in
    for r in range(2):
        i = m + r
        s[r, 2], s[r, 3] = rows[i, RIGHT], rows[i, RIGHT + 1]
        for k in range(BAND):
            j = (i + k - 2) % n
            weight = rows[i, k]
            if j >= m:
                s[r, j - m] += weight
            else:
                s[r, 0] -= weight * rows[j, RIGHT + 2]
                s[r, 1] -= weight * rows[j, RIGHT + 3]
                s[r, 2] -= weight * rows[j, RIGHT]
                s[r, 3] -= weight * rows[j, RIGHT + 1]
    det = s[0, 0] * s[1, 1] - s[0, 1] * s[1, 0]
    if not abs(det) > SMALLEST_PIVOT:
        return False
    for w in range(2):
        first = (s[0, 2 + w] * s[1, 1] - s[0, 1] * s[1, 2 + w]) / det
        second = (s[0, 0] * s[1, 2 + w] - s[0, 2 + w] * s[1, 0]) / det
        for i in range(m):
            rows[i, RIGHT + w] -= rows[i, RIGHT + 2] * first + rows[i, RIGHT + 3] * second
        rows[m, RIGHT + w], rows[m + 1, RIGHT + w] = first, second
    return True


@compiled
def eliminate_dense(rows, n):
    """The same for n < 5, where a row meets an unknown twice: Gauss with exchange of rows."""
    A = np.zeros((n, n + 2))
    for i in range(n):
        for k in range(BAND):
            A[i, (i + k - 2) % n] += rows[i, k]
        A[i, n], A[i, n + 1] = rows[i, RIGHT], rows[i, RIGHT + 1]
    for i in range(n):
        best = i
        for r in range(i + 1, n):
            if abs(A[r, i]) > abs(A[best, i]):
                best = r
        if not abs(A[best, i]) > SMALLEST_PIVOT:
            return False
        for c in range(n + 2):
            A[i, c], A[best, c] = A[best, c], A[i, c]
        for r in range(n):
            if r != i:
                factor = A[r, i] / A[i, i]
                for c in range(i, n + 2):
                    A[r, c] -= factor * A[i, c]
    for i in range(n):
        rows[i, RIGHT], rows[i, RIGHT + 1] = A[i, n] / A[i, i], A[i, n + 1] / A[i, i]
    return True


@compiled
def _fold_ends(rows, n, natural):
    """Take the fixed control points out of an open arc's system; beside natural ends they follow their neighbours."""
    for r in (1, 2, n - 3, n - 2):
        if r < 1 or r > n - 2:
            continue
        for k in range(BAND):
            j = r + k - 2
            if 1 <= j <= n - 2:
                continue
            weight = rows[r, k]
            rows[r, k] = 0.0
            if j == 0:
                rows[r, 3 - r] += natural[0] * weight
            elif j == n - 1:
                rows[r, n - r] += natural[1] * weight


@compiled
def solve(blocks, n, h, closed, natural, rows):
    """Corrections that take the curve through every vertex at its present parameter, into EX and EY.

    False, and nothing done, if the system is singular.
    """
    collocation(blocks, n, h, rows)
    if closed:
        good = eliminate_cyclic(rows, n) if n > 4 else eliminate_dense(rows, n)
    else:
        _fold_ends(rows, n, natural)
        good = eliminate(rows[1 : n - 1])
    if good:
        for i in range(0 if closed else 1, n if closed else n - 1):
            block, lane = blocks[i // LANES], np.uint64(i % LANES + HALO)
            block[EX + lane], block[EY + lane] = rows[i, RIGHT], rows[i, RIGHT + 1]
    return good
