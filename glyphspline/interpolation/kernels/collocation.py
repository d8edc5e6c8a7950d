"""The control points whose curve passes through every vertex at given parameters: a cyclic banded system, in O(n).

Row i has B_j(t_i), |j - i| ≤ 2. With t_i in Lemma 2's interval the diagonal is at least 1/2 and outweighs the rest of
the row, so elimination needs no exchange of rows. A closed curve's corners are cut off by keeping the last two unknowns
for the end: the band of the others is eliminated with them as two more right-hand sides, which leaves a 2 x 2 system.

A row of the array ``rows`` holds the five diagonals, the main one at number 2, then four right-hand sides: errors in x
and y, and the coefficients of the two unknowns kept for the end.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...intrinsics import select
from ...types import FloatArray
from .blocks import (
    BLOCK, COUNT, EX, EY, HALF, HALO, INTERVALS, LANE, LANES, NATURAL, ONE, PAD, RATE, THIRD, TWO, Group, X,
)  # fmt: skip

BAND, RIGHT, ROW = 5, 5, 9
SMALLEST_PIVOT = 1e-14


@compiled
def _collocation(group: Group, q: int) -> None:
    """B_{i-2} … B_{i+2} at u_i + x and the errors of every vertex, into rows: Cox and de Boor on the span of u_i + x.

    The reciprocals are those that a block keeps: of one, two and three knot intervals.
    """
    n, h = group.table[q, COUNT], group.h[group.table[q, INTERVALS] :]
    for b in range((n + LANES - 1) // LANES):
        block = group.blocks[b * BLOCK : (b + 1) * BLOCK]
        for i in range(min(LANES, n - b * LANES)):
            row = group.rows[b * LANES + i]
            lane = np.uint64(group.table[q, LANE] + i + HALO)
            x = block[X + lane]
            right = x >= 0.0
            k = b * LANES + i + PAD - (0 if right else 1)
            j = lane - select(right, np.uint64(0), ONE)
            before, here, after = h[k - 1], h[k], h[k + 1]
            a = x if right else x + here  # from the span's left end; b to its right end
            b_ = here - a
            third, third1, third2 = block[RATE + j] / 3.0, block[RATE + j + ONE] / 3.0, block[RATE + j + TWO] / 3.0
            inverse = 3.0 * block[THIRD + j]
            p0, p1 = b_ * inverse * block[HALF + j], a * inverse * block[HALF + j + ONE]
            m0, m1, m2 = b_ * p0 * third, ((a + before) * p0 + (b_ + after) * p1) * third1, a * p1 * third2
            n0, n3 = b_ * m0, a * m2
            n1 = (a + h[k - 2] + before) * m0 + (b_ + after) * m1
            n2 = (a + before) * m1 + (b_ + after + h[k + 2]) * m2
            row[0] = select(right, 0.0, n0)
            row[1] = select(right, n0, n1)
            row[2] = select(right, n1, n2)
            row[3] = select(right, n2, n3)
            row[4] = select(right, n3, 0.0)
            row[5], row[6], row[7], row[8] = block[EX + lane], block[EY + lane], 0.0, 0.0


@compiled
def _eliminate(rows: FloatArray) -> bool:
    """Solve the band for all four right-hand sides, in place. False if a pivot vanishes.

    The two previous rows are kept in scalars: inverse pivot, two entries above the diagonal, right-hand sides.
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
def _eliminate_cyclic(rows: FloatArray, n: int) -> bool:
    """Solve with rows that wrap around, n ≥ 5. The solution is in columns 5 and 6 of each row."""
    m = n - 2
    for i in (0, 1, m - 2, m - 1):
        for k in range(BAND):
            j = i + k - 2
            if (j < 0 or j >= m) and rows[i, k] != 0.0:
                rows[i, RIGHT + 2 + (j + n if j < 0 else j) - m] += rows[i, k]
                rows[i, k] = 0.0
    if not _eliminate(rows[:m]):
        return False
    s = rows[n + 4 : n + 6]  # the last two rows, with the others' solution put in
    for k in range(ROW):
        s[0, k] = s[1, k] = 0.0
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
def _eliminate_dense(rows: FloatArray, n: int) -> bool:
    """Solve for n < 5, where a row has an unknown twice, by Gaussian elimination with pivoting."""
    A = rows[n : 2 * n]
    for i in range(n):
        for k in range(ROW):
            A[i, k] = 0.0
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
def solve(group: Group, q: int, closed: bool) -> bool:
    """Corrections that take the curve of polygon q through every vertex at its present parameter, into EX and EY.

    False if the system is singular; the corrections are 0 then.
    """
    n, rows = group.table[q, COUNT], group.rows
    _collocation(group, q)
    if closed:
        good = _eliminate_cyclic(rows, n) if n > 4 else _eliminate_dense(rows, n)
    else:
        # Take the fixed control points out; beside natural ends they follow their neighbours.
        for r in (1, 2, n - 3, n - 2):
            for k in range(BAND if 1 <= r <= n - 2 else 0):
                j = r + k - 2
                if 1 <= j <= n - 2:
                    continue
                weight = rows[r, k]
                rows[r, k] = 0.0
                if j == 0:
                    rows[r, 3 - r] += group.numbers[q, NATURAL] * weight
                elif j == n - 1:
                    rows[r, n - r] += group.numbers[q, NATURAL + 1] * weight
        good = _eliminate(rows[1 : n - 1])
    for i in range(0 if closed else 1, n if closed else n - 1):
        block, lane = group.blocks[i // LANES * BLOCK :], np.uint64(group.table[q, LANE] + i % LANES + HALO)
        block[EX + lane], block[EY + lane] = rows[i, RIGHT] if good else 0.0, rows[i, RIGHT + 1] if good else 0.0
    return good
