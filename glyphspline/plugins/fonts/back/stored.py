"""The contours of a glyph as a font stores them: which ones of its outline they are, and how they take other points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ....outlines.masters import Masters
from ....types import FloatArray, IntArray

NEAR = 2e-3
"""Units within which a contour as it is stored is the one that was read."""

OTHERWISE = "is read otherwise than it is stored"
REGIONS = "varies in regions that its masters have not"


class StoredContours:
    """The contours of a glyph that a font stores in its record; this one stores none.

    Attributes:
        owns: the number that each stored contour has in the outline; None of one left out there.
        why: why others of the outline's contours cannot be written, by number.
    """

    def __init__(self, owns: Sequence[int | None] = (), why: Mapping[int, str] | None = None) -> None:
        self.owns = owns
        self.why = why or {}

    def masters(self, new: Masters) -> Masters:
        """What the font makes of the glyph with other points: numbers rounded."""
        return new

    def put(self, new: Masters) -> None:
        """Put the glyph with other points into the font."""
        raise AssertionError("a glyph without contours of its own has nothing to put")


def matched(glyph: Masters, stored: Sequence[tuple[FloatArray, IntArray]]) -> tuple[list[int | None], dict[int, str]]:
    """The numbers of stored contours in the outline, and the contours of that which are none of them."""
    owns: list[int | None] = []
    at = 0
    for points, degrees in stored:
        own = glyph.contours[at] if at < len(glyph.contours) else None
        alike = own is not None and own.points.shape == points.shape and np.array_equal(own.degrees, degrees)
        if alike and own is not None and np.allclose(own.points, points, rtol=0, atol=NEAR):
            owns.append(at)
            at += 1
        else:
            owns.append(None)
    return owns, dict.fromkeys(range(at, len(glyph.contours)), OTHERWISE)
