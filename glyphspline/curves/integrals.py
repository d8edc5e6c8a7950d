"""Length, area and curvature of a closed chain of cubics."""

from __future__ import annotations

import numpy as np

from ..compiled import compiled
from ..types import FloatArray, IntArray

NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)
"""For integrals over a Bézier piece; converged but at near-cusps."""

CURVATURE_STEPS = 32
"""Steps a piece at whose ends curvature is looked at for its maximum."""

PLACES = np.concatenate([(NODES + 1) / 2, np.arange(CURVATURE_STEPS + 1) / CURVATURE_STEPS])
"""Parameters at which speed and curvature are looked at: for integrals, then for the largest curvature."""


@compiled
def integrals(pieces: FloatArray) -> tuple[float, float, float]:
    """Arc length, bending energy, and largest absolute curvature of some cubics (m, 4, 2), closed or not.

    The energy is the integral of the squared curvature over arc length, in 1/unit. It and the curvature are infinite at
    a cusp.

    The loops over places become SIMD.
    """
    length = energy = highest = 0.0
    count, nodes = len(PLACES), len(NODES)
    speeds, bends = np.empty(count), np.empty(count)
    for s in range(len(pieces)):
        c = pieces[s]
        ax, ay = 3 * (c[1, 0] - c[0, 0]), 3 * (c[1, 1] - c[0, 1])
        bx, by = 3 * (c[2, 0] - c[1, 0]) - ax, 3 * (c[2, 1] - c[1, 1]) - ay
        ex, ey = 3 * (c[3, 0] - c[2, 0]) - ax - 2 * bx, 3 * (c[3, 1] - c[2, 1]) - ay - 2 * by
        for k in range(count):
            x = PLACES[k]
            dx, dy = ax + x * (2 * bx + x * ex), ay + x * (2 * by + x * ey)
            hx, hy = 2 * (bx + x * ex), 2 * (by + x * ey)
            speed = np.sqrt(dx * dx + dy * dy)
            # Dividing by the speed three times keeps tiny and huge curves from under- and overflow.
            inverse = 1 / speed
            speeds[k] = speed
            bends[k] = abs(dx * inverse * (hy * inverse) - dy * inverse * (hx * inverse)) * inverse
        for k in range(nodes):
            length += WEIGHTS[k] * speeds[k] / 2
            energy += WEIGHTS[k] * bends[k] * bends[k] * speeds[k] / 2 if speeds[k] > 0 else np.inf
        for k in range(nodes, count):
            highest = max(highest, bends[k] if speeds[k] > 0 else np.inf)
    return length, energy, highest


@compiled
def area(cubics: FloatArray) -> float:
    """Signed area of a closed chain of cubics (m, 4, 2), positive if it runs counter-clockwise.

    It is a quadratic form of the Bézier points, taken from the first one: what the position adds is rounding.
    """
    total = 0.0
    for s in range(len(cubics)):
        for i, j, weight in ((0, 1, 6), (0, 2, 3), (0, 3, 1), (1, 2, 3), (1, 3, 3), (2, 3, 6)):
            ax, ay = cubics[s, i, 0] - cubics[0, 0, 0], cubics[s, i, 1] - cubics[0, 0, 1]
            bx, by = cubics[s, j, 0] - cubics[0, 0, 0], cubics[s, j, 1] - cubics[0, 0, 1]
            total += weight * (ax * by - ay * bx)
    return total / 20


@compiled
def areas(cubics: FloatArray, offsets: IntArray) -> FloatArray:
    """(C,) the areas of chains of cubics (m, 4, 2), each from its offset (C + 1,) on."""
    found = np.empty(len(offsets) - 1)
    for c in range(len(found)):
        found[c] = area(cubics[offsets[c] : offsets[c + 1]])
    return found
