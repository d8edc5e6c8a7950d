"""Instructions of LLVM that Python has no words for: what they compute in Python. :mod:`.llvm` has the instructions."""

from __future__ import annotations

from typing import Any, TypeVar

Value = TypeVar("Value")


def fma(a: float, b: float, c: float) -> float:
    """a b + c, rounded once in compiled code: half the instructions of a product and a sum.

    A compiler that may fuse products by itself does so differently in code just compiled and in code out of the cache.
    Asked for one by one, the fused operations are what IEEE 754 says they are.
    """
    return a * b + c


def select(condition: bool, a: Value, b: Value) -> Value:
    """``a if condition else b`` of two numbers of one type, both computed, without a branch.

    Python's conditional expression becomes a branch, and a loop with branches does not become SIMD.
    """
    return a if condition else b


def wide_vectors() -> None:
    """Do nothing, but compile the calling function for the widest vectors of the processor.

    LLVM stays at half of AVX-512 otherwise; the passes of the interpolation gain a tenth.
    """


def borrowed(value: Value) -> Value:
    """The same array, or named tuple of such, without a count of references; slices are not counted either.

    Counting is atomic, some 5 ns up and 5 ns down for each argument and each slice: half of the time that setting up a
    polygon of ten vertices took. The owner keeps the array until the last use, by :func:`keep_alive`.
    """
    return value


def keep_alive(owners: Any) -> None:
    """Do nothing, but use the arrays: they live at least until here."""
