"""Anderson acceleration of the passes: the compiled equivalent of :class:`..driver.Anderson`.

The last MEMORY changes of the steps and of the updated control points are kept, row after row, for all polygons of a
group; of polygon q the columns hold x, then y, of its free vertices.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...types import FloatArray
from ..driver import DAMPING, FALL, MEMORY
from .blocks import (
    BLOCK, COUNT, EX, EY, HALO, INTERVALS, LANE, LANES, ORDER, PAD, PX, PY, Group,
)  # fmt: skip

STEP, UPDATED = 2 * MEMORY, 2 * MEMORY + 1
ROWS = 2 * MEMORY + 2
"""Rows of ``Group.memory``: changes of the steps, changes of the updated control points, the last ones of both."""

ERROR, TRYING, KNOWN, NEWEST, GRAM = range(5)
SYSTEM = GRAM + MEMORY * MEMORY
NUMBERS = SYSTEM + MEMORY * (MEMORY + 1)
"""Numbers of a polygon in ``Group.mixing``: the error of the pass before, whether the one since is a try, changes
in use, the row of the newest one, the products of changes of steps, and room for the normal equations.
"""


@compiled
def _products(a: FloatArray, b: FloatArray, c: FloatArray) -> tuple[float, float]:
    """The inner products of a and of b with c, each in four sums, as an addition waits for the one before."""
    w, x, y, z = 0.0, 0.0, 0.0, 0.0
    q, r, s, t = 0.0, 0.0, 0.0, 0.0
    quads = c.shape[0] // 4 * 4
    for j in range(0, quads, 4):
        c0, c1, c2, c3 = c[j], c[j + 1], c[j + 2], c[j + 3]
        w, x, y, z = w + a[j] * c0, x + a[j + 1] * c1, y + a[j + 2] * c2, z + a[j + 3] * c3
        q, r, s, t = q + b[j] * c0, r + b[j + 1] * c1, s + b[j + 2] * c2, t + b[j + 3] * c3
    for j in range(quads, c.shape[0]):
        w, q = w + a[j] * c[j], q + b[j] * c[j]
    return (w + x) + (y + z), (q + r) + (s + t)


@compiled
def _record(
    e: FloatArray, p: FloatArray, step: FloatArray, updated: FloatArray, change: FloatArray, change_up: FloatArray
) -> None:
    """The steps e from control points p, and how they have changed since the pass before."""
    for j in range(e.shape[0]):
        y = p[j] + e[j]
        change[j], change_up[j] = e[j] - step[j], y - updated[j]
        step[j], updated[j] = e[j], y


@compiled
def _subtract(e: FloatArray, a: FloatArray, weight: float) -> None:
    """e -= weight a"""
    for j in range(e.shape[0]):
        e[j] -= weight * a[j]


@compiled
def _weights(numbers: FloatArray, known: int, trace: float) -> None:
    """Solve the damped normal equations, positive definite, for the weights: the last column of the system."""
    A, width = numbers[SYSTEM:], MEMORY + 1
    for i in range(known):
        for k in range(known):
            A[i * width + k] = numbers[GRAM + i * MEMORY + k]
        A[i * width + i] += DAMPING * trace
    for i in range(known):
        for r in range(i + 1, known):
            factor = A[r * width + i] / A[i * width + i]
            for k in range(i, known):
                A[r * width + k] -= factor * A[i * width + k]
            A[r * width + MEMORY] -= factor * A[i * width + MEMORY]
    for i in range(known - 1, -1, -1):
        for k in range(i + 1, known):
            A[i * width + MEMORY] -= A[i * width + k] * A[k * width + MEMORY]
        A[i * width + MEMORY] /= A[i * width + i]


@compiled
def accelerate(group: Group, q: int, closed: bool, error: float, first: bool) -> None:
    """Replace the steps EX, EY of polygon q after a pass with ``error``, its ``first`` one or a later one."""
    n, order, lane0 = group.table[q, COUNT], group.table[q, ORDER], group.table[q, LANE] + HALO
    low, high = (0, n) if closed else (1, n - 1)
    free = high - low
    start = 2 * (group.table[q, INTERVALS] - 2 * PAD * order)
    stop = start + 2 * free
    memory, numbers = group.memory, group.mixing[order]
    back = not first and numbers[TRYING] > 0.0 and not error <= FALL * numbers[ERROR]
    known, newest = 0, -1
    if not first and not back:
        known, newest = min(int(numbers[KNOWN]) + 1, MEMORY), (int(numbers[NEWEST]) + 1) % MEMORY
    numbers[KNOWN], numbers[NEWEST], numbers[TRYING] = known, newest, 0.0
    row = max(newest, 0)  # of the first pass it is never read
    for b in range((n + LANES - 1) // LANES):
        here, there = max(low, b * LANES), min(high, (b + 1) * LANES)
        for axis in range(2):
            E, P = (EX, PX) if axis == 0 else (EY, PY)
            lane, at = b * BLOCK + lane0 + here - b * LANES, start + axis * free + here - low
            e, p = (
                group.blocks[E + np.uint64(lane) :][: there - here],
                group.blocks[P + np.uint64(lane) :][: there - here],
            )
            to = at + there - here
            if back:
                for j in range(there - here):
                    e[j] = memory[UPDATED, at + j] - p[j]
            else:
                _record(
                    e, p, memory[STEP, at:to], memory[UPDATED, at:to], memory[row, at:to], memory[MEMORY + row, at:to]
                )
    if back:
        return
    numbers[ERROR] = error
    trace = 0.0
    for k in range(known):
        products = _products(memory[row, start:stop], memory[STEP, start:stop], memory[k, start:stop])
        numbers[GRAM + k * MEMORY + row] = numbers[GRAM + row * MEMORY + k] = products[0]
        numbers[SYSTEM + k * (MEMORY + 1) + MEMORY] = products[1]
        trace += numbers[GRAM + k * MEMORY + k]
    if not trace > 0.0:
        return
    _weights(numbers, known, trace)
    numbers[TRYING] = 1.0
    for b in range((n + LANES - 1) // LANES):
        here, there = max(low, b * LANES), min(high, (b + 1) * LANES)
        for axis in range(2):
            lane, at = b * BLOCK + lane0 + here - b * LANES, start + axis * free + here - low
            e = group.blocks[(EX if axis == 0 else EY) + np.uint64(lane) :][: there - here]
            for k in range(known):
                weight = numbers[SYSTEM + k * (MEMORY + 1) + MEMORY]
                _subtract(e, memory[MEMORY + k, at : at + there - here], weight)
