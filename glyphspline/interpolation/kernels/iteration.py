"""The iteration of one polygon in its blocks: Algorithm 2 on a cubic, and the frozen solve.

A pass first carries out the moves that the one before it found, a block ahead of the block whose footpoints are
sought, so that each block comes through the cache once a pass.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled, select
from . import blocks as fields
from .blocks import HALO, LANES
from .certificate import flagged
from .collocation import solve
from .newton_simd import errors_at, seek, whole_vectors

PX, PY, EX, EY, DD = (np.uint64(k) for k in (fields.PX, fields.PY, fields.EX, fields.EY, fields.DD))
TWO, FOUR = np.uint64(2), np.uint64(4)
POLISHED = 1e-14
"""A frozen solve whose error is not below this share of the extent is done a second time, for its rounding errors."""


@compiled
def halos(blocks, n, b, closed):
    """Copy control points beyond either end of block b, in a ring if closed."""
    block = blocks[b]
    if closed and n <= LANES:
        for field in (fields.PX, fields.PY):
            block[field], block[field + 1] = block[field + n], block[field + n + 1]
            block[field + n + 2], block[field + n + 3] = block[field + 2], block[field + 3]
        return
    inside = min(LANES, n - b * LANES)
    for k in range(4):
        lane = k if k < 2 else inside + k
        i = b * LANES + lane - HALO
        if closed:
            i %= n
        elif i < 0 or i > n:
            continue
        # an open arc has one control point more, kept beyond the last vertex in its block
        owner = i if i < n else n - 1
        source, at = blocks[owner // LANES], owner % LANES + HALO + i - owner
        block[fields.PX + lane] = source[fields.PX + at]
        block[fields.PY + lane] = source[fields.PY + at]


@compiled
def _natural_end(blocks, n, end, natural, base):
    """The fixed control point beside a natural end, which follows the first (last) free one."""
    if n < 3:
        return
    fixed, free = (0, 1) if end == 0 else (n - 1, n - 2)
    B, F = blocks[fixed // LANES], blocks[free // LANES]
    at, by = fixed % LANES + HALO, free % LANES + HALO
    B[fields.PX + at] = base[end, 0] + natural[end] * F[fields.PX + by]
    B[fields.PY + at] = base[end, 1] + natural[end] * F[fields.PY + by]


@compiled
def _move(blocks, n, first, last, b):
    """P_i += p_i - C(t_i) for the free control points of block b."""
    block = blocks[b]
    inside = min(LANES, n - b * LANES)
    for lane in range(
        np.uint64(max(first - b * LANES, 0) + HALO), np.uint64(max(min(last - b * LANES, inside), 0) + HALO)
    ):
        block[PX + lane] += block[EX + lane]
        block[PY + lane] += block[EY + lane]


@compiled
def _largest(block, low, high):
    """The largest squared distance in lanes low to high - 1, by four, as each comparison waits for the one before."""
    a, b, c, d = 0.0, 0.0, 0.0, 0.0
    start, stop = DD + np.uint64(low), DD + np.uint64(high)
    quads = start + (stop - start) // FOUR * FOUR
    for j in range(start, quads, FOUR):
        w, x, y, z = block[j], block[j + np.uint64(1)], block[j + np.uint64(2)], block[j + np.uint64(3)]
        a, b, c, d = select(w > a, w, a), select(x > b, x, b), select(y > c, y, c), select(z > d, z, d)
    for j in range(quads, stop):
        a = max(a, block[j])
    return max(max(a, b), max(c, d))


@compiled
def _one_pass(blocks, scratch, n, closed, natural, base, moves, search, tie):
    """Moves, if there are any, then footpoints of all vertices.

    Returns:
        The largest squared distance, inf if one is not finite, and the number of full searches.
    """
    first, last = (0, n) if closed else (1, n - 1)
    count = (n + LANES - 1) // LANES
    ahead = count - 1 if closed else count  # a closed polygon's last block is moved before its first, which needs it
    if moves and closed:
        _move(blocks, n, first, last, count - 1)
    if moves and ahead > 0:
        _move(blocks, n, first, last, 0)
    if moves and not closed:
        _natural_end(blocks, n, 0, natural, base)
    largest, searched = 0.0, 0
    for b in range(count):
        if moves and b + 1 < ahead:
            _move(blocks, n, first, last, b + 1)
        if moves and not closed and (b + 2 == count or count == 1):
            _natural_end(blocks, n, 1, natural, base)
        halos(blocks, n, b, closed)
        block = blocks[b]
        inside = min(LANES, n - b * LANES)
        m, bad = whole_vectors(inside), 0
        if search:
            bad, wild = seek(block, scratch, TWO, m)
        else:
            wild = errors_at(block, scratch, TWO, m)
        if wild > 0:
            return np.inf, searched
        if bad > 0:
            searched += flagged(block, scratch, TWO, m, tie)
        start, stop = max(first - b * LANES, 0), min(last - b * LANES, inside)
        if stop > start:
            largest = max(largest, _largest(block, start + HALO, stop + HALO))
    return largest, searched


@compiled
def grown(array, size):
    """The array, or one twice as large as need be that begins with it."""
    if array.shape[0] >= size:
        return array
    larger = np.empty(2 * size)
    larger[: array.shape[0]] = array
    return larger


@compiled
def iterate(
    blocks, scratch, n, closed, natural, base, search, limit, tie, max_iterations, residuals, used, passes
):  # fmt: skip
    """Algorithm 2, of which ``passes`` passes have been made; all errors go to ``residuals`` from ``used`` on.

    Args:
        limit: distance to stop below.

    Returns:
        The residuals, which may have moved to a larger array, the passes in all and the full searches.
    """
    searched = 0
    while True:
        D, more = _one_pass(blocks, scratch, n, closed, natural, base, passes > 0, search, tie)
        residuals = grown(residuals, used + passes + 2)
        residuals[used + passes] = np.sqrt(D)
        passes += 1
        searched += more
        if np.sqrt(D) < limit or passes > max_iterations or not np.inf > D:
            return residuals, passes, searched


@compiled
def freeze(blocks, scratch, n, closed, h, natural, base, tie, rows):
    """The control points whose curve passes through every vertex at the footpoints found last, and the error left.

    Args:
        rows: (n, …) room for the solve.
    """
    D = 0.0
    for _ in range(2):
        found = solve(blocks, n, h, closed, natural, rows)
        D, _more = _one_pass(blocks, scratch, n, closed, natural, base, found, False, tie)
        if np.sqrt(D) < POLISHED or not found:
            break
    return np.sqrt(D)
