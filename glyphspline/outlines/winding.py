"""How often contours run around points: exact, by the control polygons of their segments."""

from __future__ import annotations

from ..compiled import compiled
from ..curves.cubics import split
from ..types import FloatArray

MOST_HALVINGS = 128
"""Of a segment for a ray: those around the ray's beginning are points by then."""


@compiled
def winding(cubics: FloatArray, first: int, last: int, x: float, y: float, pieces: FloatArray) -> int:
    """How often the contour of the segments from ``first`` up to ``last`` runs around a point, counter-clockwise.

    Args:
        pieces: (MOST_HALVINGS + 1, 4, 2), for the halves of a segment that the ray to the right of the point may meet.
    """
    found = 0
    for s in range(first, last):
        for k in range(8):
            pieces[0, k // 2, k % 2] = cubics[s, k // 2, k % 2]
        top, halvings = 0, 0
        while top >= 0:
            b = pieces[top]
            left = right = above = 0
            for k in range(4):
                left += b[k, 0] < x
                right += b[k, 0] > x
                above += b[k, 1] > y
            if left == 4 or above == 0 or above == 4:
                top -= 1
            elif right == 4 or halvings == MOST_HALVINGS:
                found += int(b[3, 1] > y) - int(b[0, 1] > y)
                top -= 1
            else:
                for k in range(8):
                    pieces[top + 1, k // 2, k % 2] = pieces[top, k // 2, k % 2]
                split(pieces[top + 1], 0.5, pieces[top])
                top, halvings = top + 1, halvings + 1
    return found
