"""Samples along cubic pieces for curvature combs, compiled: their parameters, and the curve's frame there."""

from __future__ import annotations

import numpy as np

from ..arrays import grown
from ..compiled import compiled
from ..types import FloatArray, IntArray
from .cubics import jet

SLOW, NUDGE = 1e-7, 1e-3
"""Ratio of speed to a piece's size below which its tangent is not used: rounding errors decide the direction there.
Local parameter by which a sample moves off a point of zero speed: the comb shows the limit beside a cusp."""

TABLE = 16
"""Number of chords that measure a piece's arc length; half as many make teeth visibly uneven on an S-shaped piece."""

TAME_RATIO, TAME_SINE = 1.2, 0.2
"""A piece is tame if the lengths of its control polygon's legs and the sines of the turns between them are within these
limits. Its speed is then within a fifth of constant and its curvature nearly linear: samples at even parameters are
even along the curve, and a short piece needs none inside. Most pieces are tame where vertices are dense."""

TINY = 1e-280
"""Squares below this have lost digits."""

SHARES, LENGTHS, DX, DY, CHORD, BEND = range(6)
"""Rows of the table of a piece's chords."""

X, Y, NX, NY, CURVATURE, WEIGHT = range(6)
"""Columns of the samples: point, unit normal to the left, signed curvature, arc length that the sample represents."""


@compiled
def sampled(cubics: FloatArray, spacing: float, angle: float, flat: float) -> tuple[FloatArray, IntArray]:
    """Sample all pieces in order, both ends of each included.

    Args:
        cubics: (m, 4, 2). spacing: the largest distance along the curve. angle: the largest turn, in radians.
        flat: tame pieces of less curvature get samples at their ends only.

    Returns:
        (k, 6) samples; (m + 1,) index of the first sample of each piece.
    """
    m = len(cubics)
    starts, samples, table = np.empty(m + 1, dtype=np.int64), np.empty((4 * m + 64, 6)), np.empty((6, TABLE + 1))
    starts[0] = 0
    for j in range(m):
        length, wanted = tame_samples(cubics, j, spacing, angle, flat)
        even = length > 0.0
        if not even:
            wanted = measure(cubics, j, table, spacing, angle)
        # A piece that is not tame has two intervals at least: one shows no curvature inside. A millionth of an interval
        # is ignored where their number is rounded up: rounding errors do not decide it.
        n = max(int(np.ceil(wanted - 1e-6)), 1 if even else 2)
        stop = starts[j] + n + 1
        samples = grown(samples, stop)
        if even:
            sample_evenly(cubics, j, length, n, samples[starts[j] : stop])
        else:
            sample_by_length(cubics, j, table, n, samples[starts[j] : stop])
        starts[j + 1] = stop
    return samples[: starts[m]], starts


@compiled
def tame_samples(cubics: FloatArray, j: int, spacing: float, angle: float, flat: float) -> tuple[float, float]:
    """Length of a tame piece and the number of intervals it needs; -1 and 0 for other pieces."""
    ax, ay = cubics[j, 1, 0] - cubics[j, 0, 0], cubics[j, 1, 1] - cubics[j, 0, 1]
    bx, by = cubics[j, 2, 0] - cubics[j, 1, 0], cubics[j, 2, 1] - cubics[j, 1, 1]
    cx, cy = cubics[j, 3, 0] - cubics[j, 2, 0], cubics[j, 3, 1] - cubics[j, 2, 1]
    a, b, c = ax * ax + ay * ay, bx * bx + by * by, cx * cx + cy * cy
    least, most = min(a, min(b, c)), max(a, max(b, c))
    if not (least > TINY and most <= TAME_RATIO * TAME_RATIO * least):
        return -1.0, 0.0
    la, lb, lc = np.sqrt(a), np.sqrt(b), np.sqrt(c)
    before, after = ax * by - ay * bx, bx * cy - by * cx
    first, second = abs(before) / (la * lb), abs(after) / (lb * lc)  # sines of the turns
    if not (max(first, second) <= TAME_SINE and ax * bx + ay * by > 0.0 and bx * cx + by * cy > 0.0):
        return -1.0, 0.0
    x, y = ax + 2.0 * bx + cx, ay + 2.0 * by + cy
    length = 0.5 * (la + np.sqrt(x * x + y * y) + lc)  # Simpson's rule
    if abs((2.0 / 3.0) * before / (a * la)) < flat and abs((2.0 / 3.0) * after / (c * lc)) < flat:
        return length, 1.0
    turn = first + second
    turn = turn * (1.0 + turn * turn / 5.0)  # no less than the sum of the two arcsines
    return length, max(length / spacing, turn / angle)


@compiled
def sample_evenly(cubics: FloatArray, j: int, length: float, n: int, samples: FloatArray) -> None:
    """Write frames at n + 1 even parameters of a piece without zero speed to ``samples`` (n + 1, 6)."""
    x0, y0, x1, y1 = cubics[j, 0, 0], cubics[j, 0, 1], cubics[j, 1, 0], cubics[j, 1, 1]
    x2, y2, x3, y3 = cubics[j, 2, 0], cubics[j, 2, 1], cubics[j, 3, 0], cubics[j, 3, 1]
    ax, ay, bx, by, cx, cy = x1 - x0, y1 - y0, x2 - x1, y2 - y1, x3 - x2, y3 - y2
    for i in range(n + 1):
        t = i / n
        s = 1.0 - t
        u, v, w = s * s, 2.0 * s * t, t * t
        dx, dy = u * ax + v * bx + w * cx, u * ay + v * by + w * cy
        ex, ey = s * (bx - ax) + t * (cx - bx), s * (by - ay) + t * (cy - by)
        inverse = 1.0 / np.sqrt(dx * dx + dy * dy)
        tx, ty = dx * inverse, dy * inverse
        u, v, w, z = s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t
        samples[i, X] = u * x0 + v * x1 + w * x2 + z * x3
        samples[i, Y] = u * y0 + v * y1 + w * y2 + z * y3
        samples[i, NX], samples[i, NY] = -ty, tx
        samples[i, CURVATURE] = (tx * ey - ty * ex) * inverse * inverse * (2.0 / 3.0)
        samples[i, WEIGHT] = length / n
    samples[0, WEIGHT] = samples[n, WEIGHT] = 0.5 * (length / n)


@compiled
def measure(cubics: FloatArray, j: int, table: FloatArray, spacing: float, angle: float) -> float:
    """Number of intervals that a piece needs, from its chords.

    Writes the table: rows ``SHARES`` and ``LENGTHS`` hold the intervals and the length up to each chord's end; the
    other rows are scratch.
    """
    x0, y0, x1, y1 = cubics[j, 0, 0], cubics[j, 0, 1], cubics[j, 1, 0], cubics[j, 1, 1]
    x2, y2, x3, y3 = cubics[j, 2, 0], cubics[j, 2, 1], cubics[j, 3, 0], cubics[j, 3, 1]
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
        # Twice the tangent of half the turn is slightly more than the turn. Each of the two chords counts half of it.
        table[BEND, i] = min(abs(ax * by - ay * bx) / max(whole, TINY), np.pi / 2) if along > 0.0 else np.pi / 2
    samples = length = 0.0
    before = table[BEND, 0]  # the piece continues in the same way beyond both ends
    table[SHARES, 0] = table[LENGTHS, 0] = 0.0
    for i in range(TABLE):
        after = table[BEND, min(i, TABLE - 2)]
        samples += max(table[CHORD, i] / spacing, (before + after) / angle)
        length += table[CHORD, i]
        table[SHARES, i + 1], table[LENGTHS, i + 1] = samples, length
        before = after
    return samples


@compiled
def sample_by_length(cubics: FloatArray, j: int, table: FloatArray, n: int, samples: FloatArray) -> None:
    """Write frames at the n + 1 points that divide a piece evenly by its table to ``samples`` (n + 1, 6)."""
    size, whole = size_of(cubics, j), table[SHARES, TABLE]
    cell, behind = 0, 0.0
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
        samples[i, X], samples[i, Y], samples[i, NX], samples[i, NY], samples[i, CURVATURE] = frame(cubics, j, t, size)
        samples[i, WEIGHT] = 0.5 * (length - behind)
        if i:
            samples[i - 1, WEIGHT] += samples[i, WEIGHT]
        behind = length


@compiled
def size_of(cubics: FloatArray, j: int) -> float:
    """Largest distance, along either axis, of a control point of piece j from its first."""
    size = 0.0
    for k in range(1, 4):
        for axis in range(2):
            size = max(size, abs(cubics[j, k, axis] - cubics[j, 0, axis]))
    return size


@compiled
def frame(cubics: FloatArray, j: int, t: float, size: float) -> tuple[float, float, float, float, float]:
    """Point, unit normal to the left and signed curvature of piece j, whose :func:`size_of` is ``size``.

    At zero speed (a cusp, or a handle on its end), normal and curvature are those beside the point; a piece without
    extent has zeros.
    """
    x, y, dx, dy, ex, ey = jet(cubics, j, t)
    speed = np.hypot(dx, dy)
    if speed <= SLOW * size:
        _, _, dx, dy, ex, ey = jet(cubics, j, t + NUDGE if t < 0.5 else t - NUDGE)
        speed = np.hypot(dx, dy)
    if speed > SLOW * NUDGE * size:  # a nudged sample has a speed of the order of NUDGE squared
        inverse = 1.0 / speed
        tx, ty = dx * inverse, dy * inverse
        return x, y, -ty, tx, (tx * (ey * inverse) - ty * (ex * inverse)) * inverse
    return x, y, 0.0, 0.0, 0.0


def end_curvatures(cubics: FloatArray) -> FloatArray:
    """(m, 2) signed curvature at the start and the end of each piece."""
    sizes = np.abs(cubics - cubics[:, :1]).max(axis=(1, 2))
    rows = [[frame(cubics, j, t, size)[4] for t in (0.0, 1.0)] for j, size in enumerate(sizes.tolist())]
    return np.array(rows).reshape(-1, 2)


@compiled
def control_length(cubics: FloatArray) -> float:
    """Total length of the control polygons, an upper bound of the length of the curves."""
    length = 0.0
    for j in range(len(cubics)):
        for k in range(3):
            dx, dy = cubics[j, k + 1, 0] - cubics[j, k, 0], cubics[j, k + 1, 1] - cubics[j, k, 1]
            length += np.sqrt(dx * dx + dy * dy)
    return length
