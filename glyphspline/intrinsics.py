"""Instructions of LLVM that Python has no words for: what they compute in Python. :mod:`.llvm` has the instructions."""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np

Value = TypeVar("Value")


def borrowed(value: Value) -> Value:
    """The same array, or named tuple of such, without a count of references; slices are not counted either.

    Counting is atomic, some 5 ns up and 5 ns down for each argument and each slice: half of the time that setting up a
    polygon of ten vertices took. The owner keeps the array until the last use, by :func:`keep_alive`.
    """
    return value


def keep_alive(owners: Any) -> None:
    """Do nothing, but use the arrays: they live at least until here."""


def chosen(condition: Any, a: Any, b: Any) -> Any:
    """One of two numbers, without a branch; with arrays of conditions, an array."""
    return np.where(condition, a, b) if isinstance(condition, np.ndarray) else (a if condition else b)
