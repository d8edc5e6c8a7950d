"""Two cubics paired at equal parameters: what certified distances rest on.

Let A and B be the polynomials of two cubic sections, both over [0, 1]. Their difference at equal parameters is a cubic
with Bézier points A_k - B_k, and lies in the convex hull of these. So every point of A has a point of B within
``max |A_k - B_k|``, and vice versa.

Floating point: a Bézier point of a section is a convex combination of convex combinations, three for the section and
three for each halving, of points of size at most L. ``ROUNDING`` times L, more than all such triples can cost, is added
to every bound.
"""

from __future__ import annotations

from ..compiled import compiled
from ..types import FloatArray
from .cubics import length

ROUNDING = 1e-13
"""Share of the largest coordinate added to a bound for floating point."""


@compiled
def points_apart(A: FloatArray, B: FloatArray, first: int, last: int) -> float:
    """Largest distance of the Bézier points (4, 2) of two cubics, of those from ``first`` up to ``last``."""
    most = 0.0
    for k in range(first, last):
        most = max(most, length(A[k, 0] - B[k, 0], A[k, 1] - B[k, 1]))
    return most
