"""Numbers as text, compiled: whole numbers of the last digit in, ASCII bytes out.

Whole part and decimals of an ordinary number are looked up (see ``figures``). Places in texts and tables are addresses
(see ``words``).
"""

# mypy: disable-error-code="no-untyped-def, no-any-return"

from __future__ import annotations

import numpy as np

from ...compiled import compiled, load, store
from .digit_tables import WHOLE

WIDEST = 20
"""Characters of the longest number written, with what separates it from the next."""

LARGEST = 1e15
"""Rounded coordinates, in units of the last digit, have to be below this: as doubles they are whole numbers there."""

SLACK = 8
"""Room needed beyond the end of a text: words are stored whole."""

MINUS, SPACE, POINT = (np.uint8(ord(c)) for c in "- .")
ONE, EIGHT, TOP = np.uint64(1), np.uint64(8), np.uint64(56)
PARTS = np.uint64(8 * WHOLE)


@compiled
def decimal(at, value, figures):
    """Write value / power with no zeros at its end, and none before its point.

    Args:
        at: address. value: int64. figures: what :class:`.digit_tables.Figures` has, but of the words their address.

    Returns:
        The address of the next character.
    """
    precision, power, limit, words = figures
    store(at, MINUS)
    at += np.uint64(value < 0)  # no branch: signs cannot be foreseen
    value = abs(value)
    if np.uint64(value) >= np.uint64(limit):
        return by_digits(at, value, precision, power)
    whole = np.uint64(value) // np.uint64(power)
    part = np.uint64(value) - whole * np.uint64(power)
    word = load(words + EIGHT * whole)
    store(at, word)
    at += word >> TOP
    word = load(words + PARTS + EIGHT * (part + np.uint64(power) * np.uint64(whole > 0)))
    store(at, word)
    return at + (word >> TOP)


@compiled
def by_digits(at, value, precision, power):
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
