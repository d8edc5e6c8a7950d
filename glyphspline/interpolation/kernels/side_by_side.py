"""Short closed polygons in one block, 8 or 4 at a time: the passes of ``passes.py`` over blocks as ``fields`` has them.

A polygon of ten vertices alone spends most of a pass on beginning and ending loops. Its numbers are the same in
company: no lane looks at another polygon's. A polygon that has arrived is taken out as it is; the last ones under way
are taken out too, to go on alone.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled, select
from . import blocks as fields
from .blocks import FIELDS, HALO, LESS_SHORT, SHORT, STRIDE
from .certificate import SEARCHED, flagged
from .layout import PAD
from .newton_simd import BAD, WIDTH, errors_at, seek, whole_vectors

PX, PY, EX, EY, DD = (np.uint64(k) for k in (fields.PX, fields.PY, fields.EX, fields.EY, fields.DD))
INTERVALS = 256
"""Room for the knot intervals of a block's polygons."""


@compiled
def places(n):
    """How many polygons of about n vertices are taken together: 1, 4 or 8."""
    return 8 if n <= SHORT else 4 if n <= LESS_SHORT else 1


@compiled
def place(block, H, step, k, p, n, unit, h):
    """Vertices, control points and knot intervals of polygon k into block and H, as yet without rates and bounds."""
    for i in range(n):
        lane = np.uint64((HALO + i) * step + k)
        x, y = (p[i, 0] - p[0, 0]) * unit, (p[i, 1] - p[0, 1]) * unit
        block[np.uint64(fields.QX) + lane] = block[PX + lane] = x
        block[np.uint64(fields.QY) + lane] = block[PY + lane] = y
    for i in range(n + 2 * PAD):
        H[i * step + k] = h[i]


@compiled
def take_out(block, step, k, n, alone, everything):
    """Polygon k out of the block, into a block of its own: all fields, or those that results are read from."""
    for field in (fields.PX, fields.PY, fields.LOW, fields.HIGH, fields.X):
        for row in range(HALO, HALO + n):
            alone[field + row] = block[field + row * step + k]
    if everything:
        for field in range(0, FIELDS * STRIDE, STRIDE):
            for row in range(n + 2 * HALO):
                alone[field + row] = block[field + row * step + k]
            for row in range(n + 2 * HALO, n + 2 * HALO + WIDTH):  # loops of whole vectors go that far
                alone[field + row] = 0.0


@compiled
def _clear(block, step, k, n):
    """Zeros in the place of polygon k: they stay zeros, and take no Newton steps."""
    for field in (fields.PX, fields.PY, fields.QX, fields.QY, fields.LOW, fields.HIGH, fields.X, fields.EX, fields.EY):
        for row in range(n + 2 * HALO):
            block[field + row * step + k] = 0.0


@compiled
def _halos(block, step, counts):
    for k in range(step):
        n = counts[k]
        if n > 0:
            for field in (fields.PX, fields.PY):
                low, high = field + k, field + k + n * step
                block[low], block[low + step] = block[high], block[high + step]
                block[high + 2 * step], block[high + 3 * step] = block[low + 2 * step], block[low + 3 * step]


@compiled
def _rows(step, counts):
    """Rows that all polygons have, and the longest one's."""
    least, most = STRIDE, 0
    for k in range(step):
        if counts[k] > 0:
            least, most = min(least, counts[k]), max(most, counts[k])
    return least, most


@compiled
def _move(block, step, counts):
    """P_i += p_i - C(t_i). Beyond a polygon's last vertex nothing moves."""
    least = _rows(step, counts)[0]
    for lane in range(np.uint64(HALO * step), np.uint64((HALO + least) * step)):
        block[PX + lane] += block[EX + lane]
        block[PY + lane] += block[EY + lane]
    for k in range(step):
        for i in range(least, counts[k]):
            at = np.uint64((HALO + i) * step + k)
            block[PX + at] += block[EX + at]
            block[PY + at] += block[EY + at]


@compiled
def _largest(block, step, counts, largest):
    """The largest squared distance of each polygon."""
    least = _rows(step, counts)[0]
    largest[:] = 0.0
    for i in range(least):
        for k in range(step):
            D = block[DD + np.uint64((HALO + i) * step + k)]
            largest[k] = select(largest[k] < D, D, largest[k])
    for k in range(step):
        for i in range(least, counts[k]):
            largest[k] = max(largest[k], block[DD + np.uint64((HALO + i) * step + k)])


@compiled
def _not_finite(block, S, step, counts, lost):
    """Which polygons have a distance that is not; these are not searched."""
    for k in range(step):
        lost[k] = False
        for i in range(counts[k]):
            lost[k] |= not np.inf > block[DD + np.uint64((HALO + i) * step + k)]
        if lost[k]:
            for i in range(counts[k]):
                S[BAD + np.uint64((HALO + i) * step + k)] = 0.0


@compiled
def _one_pass(block, S, step, counts, search, tie, largest, lost, searched):
    """Footpoints of all vertices; each polygon's largest squared distance, and its full searches added to."""
    _halos(block, step, counts)
    first, m = np.uint64(HALO * step), whole_vectors(_rows(step, counts)[1] * step)
    bad = 0
    if search:
        bad, wild = seek(block, S, first, m)
    else:
        wild = errors_at(block, S, first, m)
    if wild > 0:
        _not_finite(block, S, step, counts, lost)
    if bad > 0 and flagged(block, S, first, m, tie) > 0:
        for k in range(step):
            for i in range(counts[k]):
                searched[k] += S[BAD + np.uint64((HALO + i) * step + k)] == SEARCHED
    _largest(block, step, counts, largest)
    if wild > 0:
        for k in range(step):
            if lost[k]:
                largest[k] = np.inf


@compiled
def iterate_together(
    block, S, step, counts, limits, search, tie, max_iterations, few, solve, alone, history, passes, searched
):  # fmt: skip
    """Algorithm 2 on polygons side by side, until no more than ``few`` of them are under way.

    Args:
        counts: (8,) vertices of each, 0 where there is none.
        limits: (8,) distance to stop below.
        solve: whether the frozen system is to be solved afterwards.
        alone: (8, …) a block for each, where it is left.
        history: (…, 8) errors, pass by pass.
        passes, searched: (8,) how many were made, of passes and of full searches. Those of a polygon that has not
            arrived are negative, less 1.

    Returns:
        The history, which may have moved to a larger array.
    """
    counts = counts.copy()
    largest, lost = np.zeros(8), np.zeros(8, dtype=np.bool_)
    under_way, made = 0, 0
    for k in range(step):
        under_way += counts[k] > 0
        searched[k] = 0
    while under_way > few:
        if made > 0:
            _move(block, step, counts)
        _one_pass(block, S, step, counts, search, tie, largest, lost, searched)
        if made == history.shape[0]:
            larger = np.empty((2 * made, 8))
            larger[:made] = history
            history = larger
        for k in range(step):
            history[made, k] = np.sqrt(largest[k])
        made += 1
        for k in range(step):
            error = np.sqrt(largest[k])
            if counts[k] > 0 and (error < limits[k] or made > max_iterations or not np.inf > error):
                take_out(block, step, k, counts[k], alone[k], solve)
                _clear(block, step, k, counts[k])
                counts[k], passes[k] = 0, made
                under_way -= 1
    for k in range(step):
        if counts[k] > 0:
            take_out(block, step, k, counts[k], alone[k], True)
            passes[k] = -1 - made
    return history
