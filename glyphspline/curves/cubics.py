"""Plane cubics, compiled: evaluation, nearest points, subdivision, tangents, lengths.

A chain of cubics is an array (m, 4, 2). A *place* j + x of a closed chain is local parameter x of its segment j; places
count on past m.
"""

from __future__ import annotations

import numpy as np

from ..compiled import compiled, inlined
from ..types import FloatArray

CONVEX = 0.2
"""Newton's method for a nearest point takes the second derivative of the squared distance only where it exceeds this
share of the squared speed; elsewhere the Gauss-Newton step is shorter and always goes downhill."""

STEPS = 4
"""Newton steps to a nearest point: from the guesses here, the fourth moves by less than 1e-12."""

CLOSE = 1e-6
"""A Newton step shorter than this is the last: the next one would move by its square."""


@inlined
def square(x: float) -> float:
    """The product that compiled code makes of ``x ** 2``, and Python with an error in one of a thousand."""
    return x * x


@compiled
def length(x: float, y: float) -> float:
    """Length of a vector whose square neither over- nor underflows: in a third of the time of ``hypot``."""
    return np.sqrt(x * x + y * y)


@compiled
def jet(cubics: FloatArray, s: int, x: float) -> tuple[float, float, float, float, float, float]:
    """Position, first and second derivative by the local parameter of segment s."""
    y = 1 - x
    ax, ay = cubics[s, 1, 0] - cubics[s, 0, 0], cubics[s, 1, 1] - cubics[s, 0, 1]
    bx, by = cubics[s, 2, 0] - cubics[s, 1, 0], cubics[s, 2, 1] - cubics[s, 1, 1]
    cx, cy = cubics[s, 3, 0] - cubics[s, 2, 0], cubics[s, 3, 1] - cubics[s, 2, 1]
    lx, ly = y * ax + x * bx, y * ay + x * by
    rx, ry = y * bx + x * cx, y * by + x * cy
    dx, dy = 3 * (y * lx + x * rx), 3 * (y * ly + x * ry)
    y3, x3 = y * y * y, x * x * x
    px = y3 * cubics[s, 0, 0] + 3 * y * y * x * cubics[s, 1, 0] + 3 * y * x * x * cubics[s, 2, 0] + x3 * cubics[s, 3, 0]
    py = y3 * cubics[s, 0, 1] + 3 * y * y * x * cubics[s, 1, 1] + 3 * y * x * x * cubics[s, 2, 1] + x3 * cubics[s, 3, 1]
    return px, py, dx, dy, 6 * (rx - lx), 6 * (ry - ly)


@compiled
def newton_step(at: float, slope: float, speed: float, bend: float, low: float, high: float) -> float:
    """Newton's next estimate of a nearest point, in [low, high]; Gauss and Newton's where the distance is not convex.

    Args:
        slope, bend: half the first and second derivative of the squared distance. speed: the square of it, positive.
    """
    return min(max(at - slope / (bend if bend > CONVEX * speed else speed), low), high)


@compiled
def nearest(cubic: FloatArray, low: float, high: float, guess: float, x: float, y: float) -> float:
    """The parameter in [low, high] at which a cubic (4, 2) is nearest (x, y): Newton's method from a guess.

    It writes out :func:`jet`, with the position in fewer products: subdivision asks it again and again.
    """
    x0, y0, x1, y1 = cubic[0, 0], cubic[0, 1], cubic[1, 0], cubic[1, 1]
    x2, y2, x3, y3 = cubic[2, 0], cubic[2, 1], cubic[3, 0], cubic[3, 1]
    ax, ay, bx, by, cx, cy = x1 - x0, y1 - y0, x2 - x1, y2 - y1, x3 - x2, y3 - y2
    at = guess
    for _ in range(STEPS):
        z = 1 - at
        lx, ly, rx, ry = z * ax + at * bx, z * ay + at * by, z * bx + at * cx, z * by + at * cy
        dx, dy = 3 * (z * lx + at * rx), 3 * (z * ly + at * ry)
        qx = z * z * (z * x0 + 3 * at * x1) + at * at * (3 * z * x2 + at * x3) - x
        qy = z * z * (z * y0 + 3 * at * y1) + at * at * (3 * z * y2 + at * y3) - y
        speed = dx * dx + dy * dy
        if speed <= 0:
            break
        bend = speed + 6 * (qx * (rx - lx) + qy * (ry - ly))
        before, at = at, newton_step(at, qx * dx + qy * dy, speed, bend, low, high)
        if abs(at - before) < CLOSE:
            break
    return at


@compiled
def split(cubic: FloatArray, x: float, first: FloatArray) -> None:
    """Cut a cubic (4, 2) by de Casteljau's rule: its part before x into ``first``, that after x in its own place."""
    for k in range(2):
        a, b, d, e = cubic[0, k], cubic[1, k], cubic[2, k], cubic[3, k]
        ab, bd, de = a + x * (b - a), b + x * (d - b), d + x * (e - d)
        abd, bde = ab + x * (bd - ab), bd + x * (de - bd)
        middle = abd + x * (bde - abd)
        first[0, k], first[1, k], first[2, k], first[3, k] = a, ab, abd, middle
        cubic[0, k], cubic[1, k], cubic[2, k], cubic[3, k] = middle, bde, de, e


@compiled
def section(cubic: FloatArray, x0: float, x1: float, out: FloatArray) -> None:
    """Bézier points (4, 2) of a cubic between two parameters, by blossoming."""
    for c in range(2):
        a, b, d, e = cubic[0, c], cubic[1, c], cubic[2, c], cubic[3, c]
        for k in range(4):
            x = x1 if k > 2 else x0
            p, q, r = a + x * (b - a), b + x * (d - b), d + x * (e - d)
            x = x1 if k > 1 else x0
            p, q = p + x * (q - p), q + x * (r - q)
            x = x1 if k > 0 else x0
            out[k, c] = p + x * (q - p)


@compiled
def extent(cubics: FloatArray) -> float:
    """The largest coordinate of (m, 4, 2) Bézier points."""
    most = 0.0
    for s in range(len(cubics)):
        for k in range(4):
            most = max(most, max(abs(cubics[s, k, 0]), abs(cubics[s, k, 1])))
    return most


@compiled
def directions(cubics: FloatArray, s: int, least: float) -> tuple[float, float, float, float]:
    """Where segment s leaves its first point, and where it arrives at its last: vectors along the tangents.

    They run to and from the nearest control point whose coordinates differ by more than ``least`` in sum; (0, 0) if
    there is none.
    """
    ax = ay = bx = by = 0.0
    for j in range(3, 0, -1):
        x, y = cubics[s, j, 0] - cubics[s, 0, 0], cubics[s, j, 1] - cubics[s, 0, 1]
        if abs(x) + abs(y) > least:
            ax, ay = x, y
        x, y = cubics[s, 3, 0] - cubics[s, 3 - j, 0], cubics[s, 3, 1] - cubics[s, 3 - j, 1]
        if abs(x) + abs(y) > least:
            bx, by = x, y
    return ax, ay, bx, by


@compiled
def turns(cubics: FloatArray, least: float) -> FloatArray:
    """(m,) angle by which the tangent of a closed chain turns where each segment begins, positive to the left.

    Control points within ``least`` of an end are passed over.
    """
    m = len(cubics)
    found = np.empty(m)
    ax = ay = 0.0
    for j in range(-1, m):
        bx, by, cx, cy = directions(cubics, j, least)
        if j >= 0:
            found[j] = np.arctan2(ax * by - ay * bx, ax * bx + ay * by)
        ax, ay = cx, cy
    return found


def bernstein(steps: int) -> FloatArray:
    """(4, steps + 1) the cubic Bernstein polynomials at even parameters."""
    t = np.arange(steps + 1) / steps
    s = 1 - t
    return np.array([s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t])


@compiled
def length_table(cubics: FloatArray, weights: FloatArray) -> FloatArray:
    """(m steps + 1,) chord lengths summed along a chain, at even parameters of each segment.

    Args:
        weights: from :func:`bernstein`.
    """
    m, steps = len(cubics), weights.shape[1] - 1
    table, xs, ys, chords = np.empty(m * steps + 1), np.empty(steps + 1), np.empty(steps + 1), np.empty(steps)
    table[0] = total = 0.0
    for j in range(m):
        ax, ay, bx, by = cubics[j, 0, 0], cubics[j, 0, 1], cubics[j, 1, 0], cubics[j, 1, 1]
        cx, cy, dx, dy = cubics[j, 2, 0], cubics[j, 2, 1], cubics[j, 3, 0], cubics[j, 3, 1]
        for i in range(steps + 1):  # one kind of work a loop: such loops become SIMD
            xs[i] = weights[0, i] * ax + weights[1, i] * bx + weights[2, i] * cx + weights[3, i] * dx
            ys[i] = weights[0, i] * ay + weights[1, i] * by + weights[2, i] * cy + weights[3, i] * dy
        for i in range(steps):
            chords[i] = np.sqrt(square(xs[i + 1] - xs[i]) + square(ys[i + 1] - ys[i]))
        for i in range(steps):
            total += chords[i]
            table[j * steps + 1 + i] = total
    return table
