"""Arrays in compiled code: with room for more rows, and the order of numbers."""

from __future__ import annotations

import numpy as np

from .compiled import compiled, inlined
from .types import FloatArray, IntArray


@compiled
def grown(values: FloatArray, size: int) -> FloatArray:
    """The array, or, if it has fewer than ``size`` rows, one of twice as many that begins with it."""
    if len(values) >= size:
        return values
    larger = np.empty((2 * size, *values.shape[1:]))
    put(values, larger[: len(values)])
    return larger


@inlined
def cut(values: FloatArray, size: int) -> tuple[FloatArray, FloatArray]:
    """The first ``size`` numbers, and the rest."""
    return values[:size], values[size:]


@compiled
def put(values: FloatArray, into: FloatArray) -> None:
    """Copy an array into another one of the same shape, both contiguous, from the first number to the last.

    The assignment of slices compiles for seconds: it brings code that composes messages for shapes that differ.
    """
    old, new = values.reshape(-1), into.reshape(-1)
    for i in range(len(old)):
        new[i] = old[i]


@compiled
def ascending(values: FloatArray) -> IntArray:
    """(n,) the order of (n,) numbers; equal ones keep theirs. NumPy's ``argsort`` compiles for ten seconds: once."""
    return np.argsort(values, kind="mergesort")
