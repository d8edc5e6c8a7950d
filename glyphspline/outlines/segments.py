"""The segments of contours, compiled: as cubics, without those of no length, in canonical order."""

from __future__ import annotations

import numpy as np

from ..arrays import put
from ..compiled import compiled
from ..types import FloatArray, IntArray
from .contour_arrays import ContourArrays


@compiled
def contour_cubics(contours: ContourArrays, c: int) -> FloatArray:
    """(m, 4, 2) the segments of contour c as cubics."""
    points = contours.points[contours.starts[c] : contours.starts[c + 1]]
    degrees = contours.degrees[contours.offsets[c] : contours.offsets[c + 1]]
    m, n = len(degrees), len(points)
    cubics = np.empty((m, 4, 2))
    at = 0
    for s in range(m):
        d = degrees[s]
        for axis in range(2):
            a, b = points[at, axis], points[(at + d) % n, axis]
            cubics[s, 0, axis], cubics[s, 3, axis] = a, b
            if d == 3:
                cubics[s, 1, axis], cubics[s, 2, axis] = points[at + 1, axis], points[at + 2, axis]
            elif d == 2:
                q = points[at + 1, axis]
                cubics[s, 1, axis], cubics[s, 2, axis] = a + (q - a) * (2 / 3), b + (q - b) * (2 / 3)
            else:
                cubics[s, 1, axis], cubics[s, 2, axis] = a + (b - a) / 3, b + (a - b) / 3
        at += d
    return cubics


@compiled
def all_cubics(contours: ContourArrays) -> FloatArray:
    """(m, 4, 2) the segments of all contours as cubics; those of contour c begin at ``offsets[c]``."""
    cubics = np.empty((len(contours.degrees), 4, 2))
    for c in range(len(contours.offsets) - 1):
        put(contour_cubics(contours, c), cubics[contours.offsets[c] : contours.offsets[c + 1]])
    return cubics


@compiled
def lasting(cubics: FloatArray) -> IntArray:
    """Indices of the cubics (K, m, 4, 2) that are not a single point in all of K masters."""
    lasts = np.zeros(cubics.shape[1], dtype=np.bool_)
    for v in range(len(cubics)):
        for j in range(len(lasts)):
            b = cubics[v, j]
            for k in range(1, 4):
                lasts[j] = lasts[j] or b[k, 0] != b[0, 0] or b[k, 1] != b[0, 1]
    return np.flatnonzero(lasts)


@compiled
def keep_lasting(
    points: FloatArray, degrees: IntArray, repeats: IntArray, coincident: float, closed: bool
) -> tuple[int, int, float]:
    """Leave, at the front of the arrays, what a contour in K masters has without segments of no length.

    Such a segment has all its points within ``coincident``, in x and in y, of the end of the last one kept, in every
    master.

    Args:
        points: (K, N, 2) and degrees: (m,), as in :class:`.masters.MasterContour`.
        repeats: (m,) how many segments were left out where each begins; those left out here are added, in front too.
        closed: the last segment is a line that the reader has added: to leave it out does not count.

    Returns:
        The numbers of points and of segments left, 0 if the contour encloses nothing: its points lie on one line in all
        masters. They are -1 if a coordinate is not finite. The largest distance of a point that was dropped.
    """
    K, N, _ = points.shape
    n = m = first = left_out = 0
    dropped = 0.0
    for j in range(len(degrees)):
        left_out += repeats[j]
        end, lasts, away = first + degrees[j], False, 0.0
        for k in range(K):
            for i in range(first + 1, end + 1):
                to = i if i < N else 0
                x, y = points[k, to, 0] - points[k, n, 0], points[k, to, 1] - points[k, n, 1]
                lasts = lasts or not (abs(x) <= coincident and abs(y) <= coincident)
                away = max(away, x * x + y * y)
        if lasts:
            for k in range(K if n < first else 0):
                for i in range(1, min(end, N - 1) - first + 1):
                    points[k, n + i, 0], points[k, n + i, 1] = points[k, first + i, 0], points[k, first + i, 1]
            degrees[m], repeats[m], left_out = degrees[j], left_out, 0
            n, m = n + degrees[j], m + 1
        else:
            dropped = max(dropped, away)
            left_out += j < len(degrees) - 1 or not closed
        first = end
    if m:
        repeats[0] += left_out  # the end is the beginning
    encloses = False
    for k in range(K):
        square = far_x = far_y = 0.0
        for i in range(n):
            x, y = points[k, i, 0] - points[k, 0, 0], points[k, i, 1] - points[k, 0, 1]
            if not x * x + y * y < np.inf:
                return -1, -1, 0.0
            if x * x + y * y > square:
                square, far_x, far_y = x * x + y * y, x, y
        i = 0
        while not encloses and i < n:
            x, y = points[k, i, 0] - points[k, 0, 0], points[k, i, 1] - points[k, 0, 1]
            encloses = abs(x * far_y - y * far_x) > coincident * np.sqrt(square)
            i += 1
    return n if encloses else 0, m if encloses else 0, np.sqrt(dropped)


@compiled
def farthest_joint(joints: FloatArray) -> int:
    """Index of the joint (m, 2) farthest from the mean of all; ties go to the rightmost, then the uppermost."""
    m = len(joints)
    x = y = 0.0
    for j in range(m):
        x += joints[j, 0]
        y += joints[j, 1]
    x, y = x / m, y / m
    best, reached = 0, -1.0
    for j in range(m):
        reach = np.rint(np.hypot(joints[j, 0] - x, joints[j, 1] - y) * 1e6)
        x_ahead, y_ahead = joints[j, 0] - joints[best, 0], joints[j, 1] - joints[best, 1]
        if reach > reached or (reach == reached and (x_ahead > 0 or (x_ahead == 0 and y_ahead > 0))):
            best, reached = j, reach
    return best


@compiled
def is_backward(cubics: FloatArray) -> bool:
    """Whether a closed chain of cubics (m, 4, 2) runs against the direction in which it is fitted.

    The sign of a sum over the segments' chords decides. It changes with the direction, but not with the start point,
    nor with shift, rotation or reflection of the contour: the fit does not depend on how the font stores it.
    """
    total = 0.0
    before = np.hypot(cubics[0, 3, 0] - cubics[0, 0, 0], cubics[0, 3, 1] - cubics[0, 0, 1])
    for j in range(len(cubics)):
        k = (j + 1) % len(cubics)
        after = np.hypot(cubics[k, 3, 0] - cubics[k, 0, 0], cubics[k, 3, 1] - cubics[k, 0, 1])
        total += before * after * (before - after)
        before = after
    return total < 0
