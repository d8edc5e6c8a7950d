"""Sorting for compiled code: NumPy's compiles a dozen functions for each kind of array."""

from __future__ import annotations

import numpy as np

from ..compiled import compiled
from ..types import FloatArray, IntArray


@compiled
def ascending(keys: FloatArray) -> IntArray:
    """Indices that sort some keys (n,), by Shell's method; of equal ones the first comes first."""
    n = len(keys)
    order = np.empty(n, dtype=np.int64)
    for i in range(n):
        order[i] = i
    gap = 1
    while gap < n // 9:
        gap = 3 * gap + 1
    while gap > 0:
        for i in range(gap, n):
            own, j = order[i], i
            while j >= gap:
                other = order[j - gap]
                if keys[other] < keys[own] or (keys[other] == keys[own] and other < own):
                    break
                order[j] = other
                j -= gap
            order[j] = own
        gap //= 3
    return order


@compiled
def in_order(values: FloatArray) -> FloatArray:
    """Values (n,), sorted."""
    order, result = ascending(values), np.empty(len(values))
    for i in range(len(values)):
        result[i] = values[order[i]]
    return result
