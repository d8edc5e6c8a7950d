"""Tables of figures, from which compiled code writes numbers: see ``digits``.

An ordinary number is written as two words, its whole part and its decimals: "12" and ".5", or nothing and ".5", as a
zero before the point is left out. A word is characters in order, lowest byte first, and how many they are in the
highest byte.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

WHOLE = 10_000
"""Whole parts below this are looked up."""

MOST_DECIMALS = 4
"""Decimals up to this are looked up."""


class Figures(NamedTuple):
    """What numbers of so many decimals are written with.

    Attributes:
        precision: decimals. power: 10**precision. limit: smaller values are looked up.
        words: those of whole parts, then those of decimals with the point before them: first as they follow a whole
            part of 0, then as they follow another.
    """

    precision: int
    power: int
    limit: int
    words: NDArray[np.uint64]


@cache
def figures(precision: int) -> Figures:
    """The tables for a number of decimals."""
    power = 10**precision
    looked_up = precision <= MOST_DECIMALS
    parts = [f".{value:0{precision}d}".rstrip("0").rstrip(".") for value in range(power if looked_up else 0)]
    texts = ["", *map(str, range(1, WHOLE)), *(part or "0" for part in parts), *parts]
    words = [int.from_bytes(text.encode(), "little") | len(text) << 56 for text in texts]
    return Figures(precision, power, WHOLE * power if looked_up else 0, np.array(words, dtype=np.uint64))
