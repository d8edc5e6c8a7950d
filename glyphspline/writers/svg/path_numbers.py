"""The numbers of SVG path data, compiled: a curvature map has thousands. Python calls it through :mod:`.path_data`."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...compiled import compiled
from ...types import FloatArray, IntArray


@compiled
def path_numbers(moves: FloatArray, letters: IntArray, precision: int) -> tuple[NDArray[np.uint8], IntArray]:
    """Commands and their pairs of numbers, separated by a space or a minus, without zeros that say nothing.

    Args:
        moves: (n, 2) whole numbers of fewer than 17 digits, in units of the last decimal, y up.
        letters: (n,) codes of the commands; those of one that goes on are 0. precision: decimals.

    Returns:
        Text as bytes; (n + 1,) where each pair begins.
    """
    widest = 20 + precision  # characters of a number with its command
    text, starts = np.empty(2 * widest * len(moves), dtype=np.uint8), np.zeros(len(moves) + 1, dtype=np.int64)
    at = 0
    for i in range(len(moves)):
        for axis in range(2):
            value = int(-moves[i, 1] if axis else moves[i, 0])
            letter = 0 if axis else letters[i]
            if letter or value >= 0:
                text[at] = letter if letter else 32  # a space
                at += 1
            if value < 0:
                text[at] = 45  # a minus
                at += 1
            value, decimals = abs(value), precision
            while decimals and value % 10 == 0:
                value //= 10
                decimals -= 1
            width, rest = 1, value // 10
            while rest:
                width += 1
                rest //= 10
            width = max(width, decimals)
            k = at = at + width + (decimals > 0)
            for digit in range(width):
                if decimals and digit == decimals:
                    k -= 1
                    text[k] = 46  # a point
                k -= 1
                text[k] = 48 + value % 10
                value //= 10
            if decimals and width == decimals:
                text[k - 1] = 46
        starts[i + 1] = at
    return text[:at], starts
