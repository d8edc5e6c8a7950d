"""Samples along cubic pieces for curvature combs, compiled: where they stand, and the curve's frame there."""

# mypy: disable-error-code="no-untyped-def, no-any-return"

from __future__ import annotations

import numpy as np

from ..compiled import compiled
from .bezier import NUDGE, SLOW

TABLE = 16
"""Chords of a piece by which arc length is measured; half as many make teeth visibly uneven on an S-shaped piece."""

LEAST = 2
"""Intervals that even the shortest piece is given: with one, a short piece would show no curvature inside."""

TAME_RATIO, TAME_SINE = 1.2, 0.2
"""Where the legs of a control polygon differ no more, and turn no more, from one to the next, the curve's speed is
within a fifth of even and its curvature nearly linear: samples at even parameters are even along the curve, and a short
piece needs none inside. Most pieces are so, where vertices are dense."""

TIE = 1e-6
"""Intervals to a piece may be this much longer than asked: rounding errors should not decide how many there are."""

TINY = 1e-280
"""Squares below this have lost digits."""

SHARES, LENGTHS, DX, DY, CHORD, BEND = range(6)
"""Rows of the table of a piece's chords."""

X, Y, NX, NY, CURVATURE, WEIGHT = range(6)
"""Columns of the samples: point, unit normal to the left, signed curvature, arc length that the sample stands for."""


@compiled
def sampled(cubics, spacing, angle, flat):
    """Samples of all pieces in order, both ends of each included.

    Args:
        cubics: (m, 4, 2). spacing: the largest distance along the curve. angle: the largest turn, in radians.
        flat: tame pieces of no more curvature get samples at their ends alone.

    Returns:
        (k, 6) samples; (m + 1,) where those of each piece begin.
    """
    m = len(cubics)
    starts = np.zeros(m + 1, dtype=np.int64)
    samples = np.empty((4 * m + 64, 6))
    table = np.empty((6, TABLE + 1))
    used = 0
    for j in range(m):
        piece = (
            cubics[j, 0, 0], cubics[j, 0, 1], cubics[j, 1, 0], cubics[j, 1, 1],
            cubics[j, 2, 0], cubics[j, 2, 1], cubics[j, 3, 0], cubics[j, 3, 1],
        )  # fmt: skip
        length, turn = _even(piece)
        even = length > 0.0
        if not even:
            wanted = _measure(piece, table, spacing, angle)
        elif abs(_curvature(piece, False)) < flat and abs(_curvature(piece, True)) < flat:
            wanted = 1.0
        else:
            wanted = max(length / spacing, turn / angle)
        n = max(int(np.ceil(wanted - TIE)), 1 if even else LEAST)
        while used + n + 1 > len(samples):
            larger = np.empty((2 * len(samples), 6))
            larger[:used] = samples[:used]
            samples = larger
        if even:
            _sample_evenly(piece, length, n, samples, used)
        else:
            _sample(piece, table, n, samples, used)
        used += n + 1
        starts[j + 1] = used
    return samples[:used], starts


@compiled
def _legs(piece):
    """The three sides of a control polygon."""
    x0, y0, x1, y1, x2, y2, x3, y3 = piece
    return x1 - x0, y1 - y0, x2 - x1, y2 - y1, x3 - x2, y3 - y2


@compiled
def _even(piece):
    """Length and turn of a tame piece; -1 and 0 for another."""
    ax, ay, bx, by, cx, cy = _legs(piece)
    a, b, c = ax * ax + ay * ay, bx * bx + by * by, cx * cx + cy * cy
    if not (min(a, b, c) > TINY and max(a, b, c) <= TAME_RATIO * TAME_RATIO * min(a, b, c)):
        return -1.0, 0.0
    la, lb, lc = np.sqrt(a), np.sqrt(b), np.sqrt(c)
    first, second = abs(ax * by - ay * bx) / (la * lb), abs(bx * cy - by * cx) / (lb * lc)  # sines of the turns
    if not (max(first, second) <= TAME_SINE and ax * bx + ay * by > 0.0 and bx * cx + by * cy > 0.0):
        return -1.0, 0.0
    x, y = ax + 2.0 * bx + cx, ay + 2.0 * by + cy
    turn = first + second
    # Simpson's rule; and no less than the sum of the two arcsines
    return 0.5 * (la + np.sqrt(x * x + y * y) + lc), turn * (1.0 + turn * turn / 5.0)


@compiled
def _curvature(piece, end):
    """Curvature where a piece begins or ends, which has to be one that does not stand still there."""
    ax, ay, bx, by, cx, cy = _legs(piece)
    if end:
        ax, ay, bx, by = bx, by, cx, cy
    dx, dy = (bx, by) if end else (ax, ay)
    square = dx * dx + dy * dy
    return (2.0 / 3.0) * (ax * by - ay * bx) / (square * np.sqrt(square))


@compiled
def _sample_evenly(piece, length, n, samples, used):
    """Frames at n + 1 even parameters of a piece that stands still nowhere, into ``samples`` from ``used`` on."""
    x0, y0, x1, y1, x2, y2, x3, y3 = piece
    ax, ay, bx, by, cx, cy = _legs(piece)
    for i in range(n + 1):
        t = i / n
        s = 1.0 - t
        u, v, w = s * s, 2.0 * s * t, t * t
        dx, dy = u * ax + v * bx + w * cx, u * ay + v * by + w * cy
        ex, ey = s * (bx - ax) + t * (cx - bx), s * (by - ay) + t * (cy - by)
        inverse = 1.0 / np.sqrt(dx * dx + dy * dy)
        tx, ty = dx * inverse, dy * inverse
        u, v, w, z = s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t
        samples[used + i, X] = u * x0 + v * x1 + w * x2 + z * x3
        samples[used + i, Y] = u * y0 + v * y1 + w * y2 + z * y3
        samples[used + i, NX], samples[used + i, NY] = -ty, tx
        samples[used + i, CURVATURE] = (tx * ey - ty * ex) * inverse * inverse * (2.0 / 3.0)
        samples[used + i, WEIGHT] = length / n
    samples[used, WEIGHT] = samples[used + n, WEIGHT] = 0.5 * (length / n)


@compiled
def _measure(piece, table, spacing, angle):
    """Samples that a piece asks for, by its chords. Rows of the table, TABLE + 1 long: before each chord's end the
    samples, then the length; the others are room to work in."""
    x0, y0, x1, y1, x2, y2, x3, y3 = piece
    for i in range(TABLE + 1):
        t = i / TABLE
        s = 1.0 - t
        u, v, w, z = s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t
        table[DX, i] = u * x0 + v * x1 + w * x2 + z * x3
        table[DY, i] = u * y0 + v * y1 + w * y2 + z * y3
    for i in range(TABLE):
        dx, dy = table[DX, i + 1] - table[DX, i], table[DY, i + 1] - table[DY, i]
        table[DX, i], table[DY, i], table[CHORD, i] = dx, dy, np.sqrt(dx * dx + dy * dy)
    for i in range(TABLE - 1):
        ax, ay, bx, by = table[DX, i], table[DY, i], table[DX, i + 1], table[DY, i + 1]
        along = ax * bx + ay * by
        whole = table[CHORD, i] * table[CHORD, i + 1] + along
        # twice the tangent of half the turn: the turn and a little more. Half of it counts for either chord.
        table[BEND, i] = min(abs(ax * by - ay * bx) / max(whole, TINY), np.pi / 2) if along > 0.0 else np.pi / 2
    samples = length = 0.0
    before = table[BEND, 0]  # the halves at both ends of the piece, as if it went on like that
    table[SHARES, 0] = table[LENGTHS, 0] = 0.0
    for i in range(TABLE):
        after = table[BEND, min(i, TABLE - 2)]
        samples += max(table[CHORD, i] / spacing, (before + after) / angle)
        length += table[CHORD, i]
        table[SHARES, i + 1], table[LENGTHS, i + 1] = samples, length
        before = after
    return samples


@compiled
def _point(piece, t):
    x0, y0, x1, y1, x2, y2, x3, y3 = piece
    s = 1.0 - t
    ax, ay = s * x0 + t * x1, s * y0 + t * y1
    bx, by = s * x1 + t * x2, s * y1 + t * y2
    cx, cy = s * x2 + t * x3, s * y2 + t * y3
    return s * (s * ax + t * bx) + t * (s * bx + t * cx), s * (s * ay + t * by) + t * (s * by + t * cy)


@compiled
def _sample(piece, table, n, samples, used):
    """Frames at the n + 1 places that divide a piece evenly by its table."""
    x0, y0, x1, y1, x2, y2, x3, y3 = piece
    size = max(abs(x1 - x0), abs(y1 - y0), abs(x2 - x0), abs(y2 - y0), abs(x3 - x0), abs(y3 - y0))
    whole = table[SHARES, TABLE]
    cell = 0
    behind = 0.0
    for i in range(n + 1):
        share = i / n * whole
        while cell < TABLE - 1 and table[SHARES, cell + 1] < share:
            cell += 1
        width = table[SHARES, cell + 1] - table[SHARES, cell]
        part = min((share - table[SHARES, cell]) / width, 1.0) if width > 0.0 else 0.0
        length = table[LENGTHS, cell] + part * (table[LENGTHS, cell + 1] - table[LENGTHS, cell])
        t = (cell + part) / TABLE
        if i == n:
            t, length = 1.0, table[LENGTHS, TABLE]
        elif whole == 0.0:
            t = i / n
        samples[used + i, X], samples[used + i, Y] = _point(piece, t)
        samples[used + i, NX], samples[used + i, NY], samples[used + i, CURVATURE] = _frame(piece, t, size)
        samples[used + i, WEIGHT] = 0.5 * (length - behind)
        if i:
            samples[used + i - 1, WEIGHT] += samples[used + i, WEIGHT]
        behind = length


@compiled
def _frame(piece, t, size):
    """Normal and curvature. Where the piece stands still they are those beside the point; a piece without extent has
    zeros."""
    dx, dy, ex, ey = _derivatives(piece, t)
    speed = _size(dx, dy)
    if speed <= SLOW * size:
        dx, dy, ex, ey = _derivatives(piece, t + NUDGE if t < 0.5 else t - NUDGE)
        speed = _size(dx, dy)
    if speed > SLOW * NUDGE * size:  # a nudged sample has a speed of the order of NUDGE squared
        inverse = 1.0 / speed
        tx, ty = dx * inverse, dy * inverse
        return -ty, tx, (tx * (ey * inverse) - ty * (ex * inverse)) * inverse
    return 0.0, 0.0, 0.0


@compiled
def _size(x, y):
    """Length of a vector, however small."""
    square = x * x + y * y
    return np.sqrt(square) if square > TINY else np.hypot(x, y)


@compiled
def _derivatives(piece, t):
    """First and second derivative by the local parameter."""
    ax, ay, bx, by, cx, cy = _legs(piece)
    s = 1.0 - t
    dx, dy = s * (s * ax + t * bx) + t * (s * bx + t * cx), s * (s * ay + t * by) + t * (s * by + t * cy)
    return 3.0 * dx, 3.0 * dy, 6.0 * (s * (bx - ax) + t * (cx - bx)), 6.0 * (s * (by - ay) + t * (cy - by))


@compiled
def control_length(cubics):
    """Length of all control polygons, which is no less than that of the curves."""
    length = 0.0
    for j in range(len(cubics)):
        for k in range(3):
            dx, dy = cubics[j, k + 1, 0] - cubics[j, k, 0], cubics[j, k + 1, 1] - cubics[j, k, 1]
            length += np.sqrt(dx * dx + dy * dy)
    return length
