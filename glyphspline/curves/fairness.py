"""How fair a closed chain of cubics is: the significant extrema of its curvature."""

from __future__ import annotations

import numpy as np

from ..arrays import grown
from ..compiled import compiled
from ..types import FloatArray, IntArray
from .comb import frame, size_of
from .cubics import directions

SHARE = 0.1
"""Share of the larger of two curvatures by which they differ significantly. Coordinates in whole font units move the
curvature of smooth segments by a few percent."""

TURN = 1.0
"""Angle in radians by which the difference of two significantly different curvatures would turn the whole contour: the
absolute part of the threshold, without which every ripple of a nearly straight stretch would count."""

STRAIGHT, SLOW = 1e-9, 1e-8
"""Product of velocity and acceleration, of a piece of size 1, below which it is straight. Squared speed of a piece of
size 1 up to which its polynomials have too few digits for the curvature."""

CLOSE, ROUNDS = 1e-6, 60
"""Share of an interval by which the last step to an extremum inside moves. Maximum number of those steps; mostly it
takes eight."""

MOST = 64
"""Maximum number of places of a piece: its ends, five extrema, and where intervals with several of them are halved."""

Coefficients = tuple[float, ...]
"""Of a polynomial of the parameter, that of the constant first."""


@compiled
def extrema_of(values: FloatArray, n: int, least: float) -> int:
    """Number of significant extrema of the signed curvature along a closed contour: 0 of a circle, 4 of an ellipse.

    It is the largest number of places in order along the contour at which curvature alternately rises and falls
    significantly: by at least ``SHARE`` of the larger of both absolute values, and by ``TURN`` over the contour's
    length. This depends neither on start, direction, place and scale nor on how the contour is cut into pieces. Lines
    have curvature 0, joints without a corner have the two values of their sides, and a cusp that of the curve beside
    it.

    Corners have no curvature. They separate stretches, whose two outermost places do not count: curvature does
    not return beyond them. A polygon has none.

    Args:
        values, n: of :func:`curvatures`. least: ``TURN`` over the contour's length.
    """
    if n == 0:
        return 0
    start = int(np.argmax(values[:n]))  # the first corner, or else the largest of all; see ``swings``
    found = np.empty(n + 1, dtype=np.int64)
    if not np.isnan(values[start]):
        return swings(values, n, start, start + n + 1, 1.0, SHARE, least, found)
    count, first = 0, start + 1
    for i in range(start + 1, start + n + 1):
        if np.isnan(values[i % n]):
            count += max(swings(values, n, first, i, 1.0, SHARE, least, found) - 1, 0)
            first = i + 1
    return count


@compiled
def swings(
    values: FloatArray, n: int, first: int, last: int, sign: float, share: float, least: float, found: IntArray
) -> int:
    """How many times a sequence alternately rises and falls significantly.

    Of a closed one a lap from its largest value finds all: what is significantly below some value is so below a larger
    one.

    Args:
        values: n of them, taken around and times ``sign``, from place ``first`` up to ``last``, exclusive.
        share: of the larger of two absolute values by which they differ at least. least: difference at least.
        found: the place that each swing leaves, a largest or smallest value, is written here, and the one behind the
            last swing; one more than there are swings.
    """
    count = direction = 0
    low, high = np.inf, -np.inf
    lowest = highest = first
    for i in range(first, last):
        value = sign * values[i % n]
        if value < low:
            low, lowest = value, i
        if value > high:
            high, highest = value, i
        if direction <= 0 and value - low >= max(share * max(abs(low), abs(value)), least):
            found[count] = lowest
            count, direction, high, highest = count + 1, 1, value, i
        elif direction >= 0 and high - value >= max(share * max(abs(high), abs(value)), least):
            found[count] = highest
            count, direction, low, lowest = count + 1, -1, value, i
    found[count] = highest if direction > 0 else lowest
    return count


@compiled
def curvatures(cubics: FloatArray, length: float, corner: float) -> tuple[FloatArray, FloatArray, int]:
    """Signed curvature in order along a contour, at both ends and all extrema of each piece, NaN at each corner.

    The second array has where that is: j + t for local parameter t of piece j. Both have room to spare; the last value
    is the number of curvatures.

    Args:
        cubics: (m, 4, 2). length: of the contour. corner: cosine of the turn from which a joint is a corner.
    """
    m, n = len(cubics), 0
    values, where, places = np.empty(4 * m + MOST + 1), np.empty(4 * m + MOST + 1), np.zeros(MOST)
    # Share of the contour's length below which pieces and handles are rounding errors and passed over.
    least = 1e-9 * length
    ax = ay = 0.0
    for j in range(m - 1, -1, -1):  # where the last piece of any extent arrives
        if size_of(cubics, j) > least:
            _, _, ax, ay = directions(cubics, j, least)
            break
    for j in range(m):
        size = size_of(cubics, j)
        if not size > least:
            continue
        if n + MOST + 1 > len(values):
            values, where = grown(values, n + MOST + 1), grown(where, n + MOST + 1)
        bx, by, x, y = directions(cubics, j, least)
        if ax * bx + ay * by <= corner * np.sqrt((ax * ax + ay * ay) * (bx * bx + by * by)):
            values[n], where[n] = np.nan, j
            n += 1
        ax, ay = x, y
        bent, (x0, x1, x2), (s0, s1, s2, s3, s4), slope = _polynomials(cubics, j, size)
        for i in range(_places(slope, places) if bent else 1):
            t = places[i]
            where[n] = j + t
            square = s0 + t * (s1 + t * (s2 + t * (s3 + t * s4)))
            values[n] = (x0 + t * (x1 + t * x2)) / (square * np.sqrt(square) * size) if bent else 0.0
            if bent and not square > SLOW:
                _, _, _, _, values[n] = frame(cubics, j, t, size)
            n += 1
    return values, where, n


@compiled
def _polynomials(cubics: FloatArray, j: int, size: float) -> tuple[bool, Coefficients, Coefficients, Coefficients]:
    """Whether a piece is bent at all, and of the piece divided by its size three polynomials: the cross product of
    velocity and acceleration, the squared speed, and speed⁶ dκ/ds, whose roots are the extrema of curvature.
    """
    scale = 3 / size
    ax, ay = scale * (cubics[j, 1, 0] - cubics[j, 0, 0]), scale * (cubics[j, 1, 1] - cubics[j, 0, 1])
    bx, by = scale * (cubics[j, 2, 0] - cubics[j, 1, 0]), scale * (cubics[j, 2, 1] - cubics[j, 1, 1])
    cx, cy = scale * (cubics[j, 3, 0] - cubics[j, 2, 0]), scale * (cubics[j, 3, 1] - cubics[j, 2, 1])
    bx, by, cx, cy = 2 * (bx - ax), 2 * (by - ay), cx - 2 * bx + ax, cy - 2 * by + ay  # velocity a + b t + c t²
    # The cross product x, the squared speed s, and half of its derivative w: velocity times acceleration.
    x0, x1, x2 = ax * by - ay * bx, 2 * (ax * cy - ay * cx), bx * cy - by * cx
    s0, s1, s4 = ax * ax + ay * ay, 2 * (ax * bx + ay * by), cx * cx + cy * cy
    s2, s3 = bx * bx + by * by + 2 * (ax * cx + ay * cy), 2 * (bx * cx + by * cy)
    w0, w1, w2, w3 = s1 / 2, s2, 1.5 * s3, 2 * s4
    slope = (
        x1 * s0 - 3 * x0 * w0,
        x1 * s1 + 2 * x2 * s0 - 3 * (x0 * w1 + x1 * w0),
        x1 * s2 + 2 * x2 * s1 - 3 * (x0 * w2 + x1 * w1 + x2 * w0),
        x1 * s3 + 2 * x2 * s2 - 3 * (x0 * w3 + x1 * w2 + x2 * w1),
        x1 * s4 + 2 * x2 * s3 - 3 * (x1 * w3 + x2 * w2),
        2 * x2 * s4 - 3 * x2 * w3,
    )
    bent = max(abs(x0), max(abs(x1), abs(x2))) > STRAIGHT
    return bent, (x0, x1, x2), (s0, s1, s2, s3, s4), slope


@compiled
def _places(q: Coefficients, places: FloatArray) -> int:
    """Write 0, the roots of a quintic between 0 and 1, and 1 to ``places``, ascending; returns their number.

    Bernstein coefficients of one sign exclude a root, and one change of sign isolates it; other intervals are halved.
    Where intervals meet is a place too, as rounding errors may hide a root there from both.
    """
    places[0], n, t, width = 0.0, 1, 0.0, 1.0
    while t < 1.0 and n + 3 <= len(places):
        # The polynomial of x in [0, 1], by Taylor's formula at t, and its Bernstein coefficients.
        p0 = q[0] + t * (q[1] + t * (q[2] + t * (q[3] + t * (q[4] + t * q[5]))))
        p1 = width * (q[1] + t * (2 * q[2] + t * (3 * q[3] + t * (4 * q[4] + t * 5 * q[5]))))
        square = width * width
        p2 = square * (q[2] + t * (3 * q[3] + t * (6 * q[4] + t * 10 * q[5])))
        p3 = square * width * (q[3] + t * (4 * q[4] + t * 10 * q[5]))
        p4 = square * square * (q[4] + t * 5 * q[5])
        p5 = square * square * width * q[5]
        b1, b2, b3 = p0 + p1 / 5, p0 + 0.4 * p1 + p2 / 10, p0 + 0.6 * p1 + 0.3 * p2 + p3 / 10
        b4, b5 = p0 + 0.8 * p1 + 0.6 * p2 + 0.4 * p3 + p4 / 5, p0 + p1 + p2 + p3 + p4 + p5
        changes, last = 0, p0
        for b in (b1, b2, b3, b4, b5):
            if b != 0.0:
                changes += b * last < 0.0
                last = b
        alone = changes == 1 and p0 * b5 < 0.0
        # A shorter interval is not halved to separate extrema: rounding errors decide about these inside it.
        if changes > 0 and not alone and width > 2.0**-16:
            width /= 2
            continue
        if changes > 0:
            x0, f0, x1, f1 = 0.0, p0, 1.0, b5
            x = 0.5
            for _ in range(ROUNDS if alone else 0):  # regula falsi with the Illinois rule
                before, x = x, x1 - f1 * (x1 - x0) / (f1 - f0)
                f = p0 + x * (p1 + x * (p2 + x * (p3 + x * (p4 + x * p5))))
                passed = (f > 0.0) != (f1 > 0.0)
                if passed:
                    x0, f0 = x1, f1
                else:
                    f0 /= 2
                x1, f1 = x, f
                # A small step alone proves no root: beside a near-cusp an end is nearly one, and steps there are small.
                if (passed and abs(x - before) < CLOSE) or f == 0.0:
                    break
            places[n] = t + width * x
            n += 1
        t += width
        if t < 1.0:
            places[n] = t
            n += 1
            while t % (2 * width) == 0.0:
                width *= 2
    places[n] = 1.0
    return n + 1
