"""The table in which compiled code hands findings on."""

from __future__ import annotations

import numpy as np

from ..compiled import compiled
from ..types import FloatArray

COLUMNS = 6
WHAT, CONTOUR, PLACE, VALUE, DETAIL, OTHER = range(COLUMNS)
"""Columns of a table of findings (n, 6): number of the kind; contour; place on it, segment and local parameter; value
in the kind's unit, curvatures in 1/unit; second number, or NaN; another contour, or -1."""


@compiled
def add(
    table: FloatArray, count: int, what: int, contour: int, place: float, value: float, detail: float, other: int
) -> FloatArray:
    """The table with one more row after ``count``; in a larger array if need be."""
    if count == len(table):
        longer = np.empty((2 * count + 16, COLUMNS))
        for i in range(count):
            for k in range(COLUMNS):
                longer[i, k] = table[i, k]
        table = longer
    row = table[count]
    row[WHAT], row[CONTOUR], row[PLACE] = what, contour, place
    row[VALUE], row[DETAIL], row[OTHER] = value, detail, other
    return table
