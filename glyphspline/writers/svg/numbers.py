"""Numbers as ASCII text, compiled: a coordinate is an integer, in units of the last decimal.

An ordinary number is looked up and stored as two words: its integer part and its decimals, "12" and ".5", or nothing
and ".5", since a zero before the point is left out. A word holds its characters in order, lowest byte first, and their
number in the highest byte. Texts and tables are addresses (see :func:`glyphspline.compiled.store`).
"""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np

from ...compiled import compiled
from ...intrinsics import load, store

INTEGERS = 10_000
"""Integer parts below this are looked up."""

MOST_DECIMALS = 4
"""Numbers with more decimals are written digit by digit."""

WIDEST = 20
"""Characters of the longest number written, with its separator."""

LARGEST = 1e15
"""Coordinates, in units of the last decimal, have to be below this: as doubles they are integers there."""

SLACK = 8
"""Bytes needed beyond the end of a text: words are stored whole."""

MINUS, SPACE, POINT = (np.uint8(ord(c)) for c in "- .")
ONE, EIGHT, TOP = np.uint64(1), np.uint64(8), np.uint64(56)
PARTS = np.uint64(8 * INTEGERS)


class Figures(NamedTuple):
    """Tables for numbers of so many decimals.

    Attributes:
        precision: decimals. power: 10**precision. limit: smaller values are looked up.
        words: of integer parts, then of decimals with the point before them: first those that follow an integer part
            of 0, then those that follow another.
    """

    precision: int
    power: int
    limit: int
    words: Any  # (n,) uint64


@cache
def figures(precision: int) -> Figures:
    """The tables for a number of decimals."""
    power = 10**precision
    looked_up = precision <= MOST_DECIMALS
    parts = [f".{value:0{precision}d}".rstrip("0").rstrip(".") for value in range(power if looked_up else 0)]
    texts = ["", *map(str, range(1, INTEGERS)), *(part or "0" for part in parts), *parts]
    words = [int.from_bytes(text.encode(), "little") | len(text) << 56 for text in texts]
    return Figures(precision, power, INTEGERS * power if looked_up else 0, np.array(words, dtype=np.uint64))


@compiled
def decimal(at: np.uint64, value: np.int64, figures: Figures) -> np.uint64:
    """Write value / power with no zeros at its end, and none before its point.

    Args:
        at: address. value: np.int6464. figures: the tables; of ``words`` the address.

    Returns:
        The address of the next character.
    """
    precision, power, limit, words = figures
    store(at, MINUS)
    at += np.uint64(value < 0)  # no branch: signs cannot be predicted
    value = abs(value)
    if np.uint64(value) >= np.uint64(limit):
        return _by_digits(at, value, precision, power)
    whole = np.uint64(value) // np.uint64(power)
    part = np.uint64(value) - whole * np.uint64(power)
    word = load(words + EIGHT * whole)
    store(at, word)
    at += word >> TOP
    word = load(words + PARTS + EIGHT * (part + np.uint64(power) * np.uint64(whole > 0)))
    store(at, word)
    return at + (word >> TOP)


@compiled
def _by_digits(at: np.uint64, value: np.int64, precision: int, power: int) -> np.uint64:
    """The same digit by digit, for any value from 0 up and any number of decimals."""
    whole = value // power
    part = value - whole * power
    digits = 1
    rest = whole
    while rest >= 10:
        rest //= 10
        digits += 1
    for k in range(digits):
        store(at + np.uint64(digits - 1 - k), np.uint8(48 + whole % 10))
        whole //= 10
    at += np.uint64(digits if value >= power or part == 0 else 0)
    if part:
        decimals = precision
        while part % 10 == 0:
            part //= 10
            decimals -= 1
        store(at, POINT)
        for k in range(decimals):
            store(at + np.uint64(decimals - k), np.uint8(48 + part % 10))
            part //= 10
        at += np.uint64(decimals + 1)
    return at
