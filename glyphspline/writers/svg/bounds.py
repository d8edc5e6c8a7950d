"""The tight box around curves, compiled."""

# mypy: disable-error-code="no-untyped-def, no-any-return"

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...curves.cubics import raised


@compiled
def ink_box(cubics):
    """(4,) left, bottom, right, top of the curves of pieces (m, 4, 2); infinite the wrong way round without any."""
    box = np.array([np.inf, np.inf, -np.inf, -np.inf])
    for j in range(len(cubics)):
        for axis in range(2):
            low, high = min(cubics[j, 0, axis], cubics[j, 3, axis]), max(cubics[j, 0, axis], cubics[j, 3, axis])
            box[axis], box[axis + 2] = min(box[axis], low), max(box[axis + 2], high)
    for j in range(len(cubics)):
        for axis in range(2):
            p0, p1, p2, p3 = cubics[j, 0, axis], cubics[j, 1, axis], cubics[j, 2, axis], cubics[j, 3, axis]
            if min(p1, p2) < box[axis] or max(p1, p2) > box[axis + 2]:
                for value in _turning(p0, p1, p2, p3):
                    box[axis], box[axis + 2] = min(box[axis], value), max(box[axis + 2], value)
    return box


@compiled
def contours_box(points, degrees, contours):
    """The same around closed contours one after the other: ``points`` (N, 2), ``degrees`` (m,), and (c + 1,) where
    those of each contour begin among these."""
    box = np.array([np.inf, np.inf, -np.inf, -np.inf])
    first = 0
    for c in range(len(contours) - 1):
        own = degrees[contours[c] : contours[c + 1]]
        n = own.sum()
        if n:
            around = ink_box(raised(points[first : first + n], own))
            for k in range(2):
                box[k], box[k + 2] = min(box[k], around[k]), max(box[k + 2], around[k + 2])
        first += n
    return box


@compiled
def _turning(p0, p1, p2, p3):
    """Both values of a cubic where its derivative is zero, or at an end where there is no such place."""
    a, half_b, c = p3 - 3.0 * p2 + 3.0 * p1 - p0, p2 - 2.0 * p1 + p0, p1 - p0
    root = np.sqrt(max(half_b * half_b - a * c, 0.0))
    # The stable pair q/a and c/q: neither loses digits when a is small, as on a line or a quadratic raised.
    q = -(half_b - root if half_b < 0.0 else half_b + root)
    return _at(p0, p1, p2, p3, q, a), _at(p0, p1, p2, p3, c, q)


@compiled
def _at(p0, p1, p2, p3, numerator, denominator):
    """The cubic at a quotient, if that is between 0 and 1, or else at the nearer end."""
    x = numerator / denominator if abs(denominator) > abs(numerator) else 0.0
    x = min(max(x, 0.0), 1.0)
    y = 1.0 - x
    return y * y * y * p0 + 3.0 * y * y * x * p1 + 3.0 * y * x * x * p2 + x * x * x * p3
