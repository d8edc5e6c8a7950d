"""Points of a fixed number at equal arc lengths of contours, with tangents and curvature, compiled.

Arc length is integrated, not summed along chords: each segment is cut in halves until Gauss and Legendre's rule of
eight nodes over a part agrees with that over its two halves to ``EXACT`` of the segment's control polygon, twice in
turn: once they may agree by chance. A place is found by Newton's method in the part that holds it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...curves.comb import control_length
from ...curves.cubics import directions, jet, turns
from ...curves.nearest import search_place
from ...outlines.contour_arrays import ContourArrays, Polylines
from ...outlines.segments import contour_cubics
from ...types import BoolArray, FloatArray, IntArray
from .canonical_outlines import lower_left

NODES, WEIGHTS = np.polynomial.legendre.leggauss(8)

EXACT, DEPTH = 1e-9, 24
"""Error of the length of a part of a segment, relative to the length of the segment's control polygon. Most halvings of
a segment: about a cusp, what is left then is too short to matter."""


class Resampled(NamedTuple):
    """Points of C contours end to end.

    Attributes:
        points: (N, 2). tangents: (N, 2) of length 1, in the contour's direction; at a corner, of what follows.
        curvature: (N,) signed, in 1/unit, positive where the contour turns left; NaN at a cusp.
        corners: (N,) whether the point is the nearest, along the contour, of some corner.
        offsets: (C + 1,) where each contour begins in the points.
        lengths: (C,) arc lengths.
    """

    points: FloatArray
    tangents: FloatArray
    curvature: FloatArray
    corners: BoolArray
    offsets: IntArray
    lengths: FloatArray


@compiled
def resampled(contours: ContourArrays, count: int, corner_angle: float) -> Resampled:
    """``count`` points of each contour at equal arc lengths, from the one with the least x + y on.

    Args:
        contours: of segments that have lengths. count: at least 1.
        corner_angle: turn in radians from which a joint is a corner.
    """
    C = len(contours.offsets) - 1
    points, tangents, curvature = np.empty((C * count, 2)), np.empty((C * count, 2)), np.empty(C * count)
    corners, lengths = np.zeros(C * count, dtype=np.bool_), np.empty(C)
    for c in range(C):
        cubics = contour_cubics(contours, c)
        m, at = len(cubics), c * count
        table, places, firsts = _lengths(cubics)
        total = lengths[c] = table[-1]
        start, _, _ = lower_left(cubics)
        s = min(int(start), m - 1)
        k = firsts[s] + int(np.searchsorted(places[firsts[s] : firsts[s + 1]], start - s, side="right")) - 1
        first = table[k] + _length(cubics, s, places[k], start - s)
        for i in range(count):
            along = first + total * (i / count)
            if i == 0:
                x = start - s
            else:
                if along >= total:
                    along -= total
                k = min(int(np.searchsorted(table, along, side="right")) - 1, len(places) - 1)
                s = int(np.searchsorted(firsts, k, side="right")) - 1
                end = places[k + 1] if k + 1 < firsts[s + 1] else 1.0
                x = _place(cubics, s, places[k], end, along - table[k], table[k + 1] - table[k])
            line = contours.degrees[contours.offsets[c] + s] == 1
            curvature[at + i] = _frame(cubics, s, x, line, points[at + i], tangents[at + i])
        turned = turns(cubics, 0.0)
        for j in range(m):
            if abs(turned[j]) >= corner_angle:
                along = (table[firsts[j]] - first) / total * count
                corners[at + int(np.floor(along + 0.5)) % count] = True
    return Resampled(points, tangents, curvature, corners, count * np.arange(C + 1), lengths)


@compiled
def at_vertices(contours: ContourArrays, polygons: Polylines, corner_angle: float) -> Resampled:
    """The vertices of C polygons, with the tangents and curvatures of the contours where these are nearest.

    Each begins with its vertex of the least x + y. ``corners`` are the vertices nearest to corners of the contours.
    """
    C = len(contours.offsets) - 1
    N = len(polygons.points)
    points, tangents, curvature = np.empty((N, 2)), np.empty((N, 2)), np.empty(N)
    corners, lengths = np.zeros(N, dtype=np.bool_), np.empty(C)
    near = np.empty(2)
    for c in range(C):
        cubics = contour_cubics(contours, c)
        lengths[c] = _lengths(cubics)[0][-1]
        a, b = polygons.offsets[c], polygons.offsets[c + 1]
        own = polygons.points[a:b]
        ahead = own[:, 0] + own[:, 1]
        lowest = np.flatnonzero(ahead == ahead.min())
        first = lowest[np.argmin(own[lowest, 0])]
        own = np.concatenate((own[first:], own[:first]))
        for i in range(len(own)):
            x, y = own[i, 0], own[i, 1]
            joint = np.flatnonzero((cubics[:, 0, 0] == x) & (cubics[:, 0, 1] == y))
            if len(joint) > 0:
                place = float(joint[0])
            else:
                place = search_place(1, cubics, 0.0, float(len(cubics)), own.reshape(1, -1, 2), 0, i)
            s = min(int(place), len(cubics) - 1)
            line = contours.degrees[contours.offsets[c] + s] == 1
            curvature[a + i] = _frame(cubics, s, place - s, line, near, tangents[a + i])
            points[a + i, 0], points[a + i, 1] = x, y
        turned = turns(cubics, 0.0)
        for j in range(len(cubics)):
            if abs(turned[j]) >= corner_angle:
                x, y = own[:, 0] - cubics[j, 0, 0], own[:, 1] - cubics[j, 0, 1]
                corners[a + np.argmin(x * x + y * y)] = True
    return Resampled(points, tangents, curvature, corners, polygons.offsets, lengths)


@compiled
def _lengths(cubics: FloatArray) -> tuple[FloatArray, FloatArray, IntArray]:
    """Parts of segments whose lengths are exact.

    Returns:
        (P + 1,) arc length along the chain where each of P parts begins, and at the end; (P,) local parameter where it
        begins; (m + 1,) the first part of each segment, and P.
    """
    table, places, firsts = [0.0], [], np.zeros(len(cubics) + 1, dtype=np.int64)
    for s in range(len(cubics)):
        scale = control_length(cubics[s : s + 1])
        todo = [(0.0, 1.0, _length(cubics, s, 0.0, 1.0), 0, False)]
        while len(todo) > 0:
            a, b, whole, depth, agreed = todo.pop()
            middle = 0.5 * (a + b)
            one, two = _length(cubics, s, a, middle), _length(cubics, s, middle, b)
            agrees = abs(one + two - whole) <= EXACT * scale
            if (agrees and agreed) or depth == DEPTH:
                table.append(table[-1] + (one + two))
                places.append(a)
            else:
                todo.append((middle, b, two, depth + 1, agrees))
                todo.append((a, middle, one, depth + 1, agrees))
        firsts[s + 1] = len(places)
    return np.array(table), np.array(places), firsts


@compiled
def _length(cubics: FloatArray, s: int, a: float, b: float) -> float:
    """Length of a part of segment s by Gauss and Legendre's rule."""
    ax, ay = cubics[s, 1, 0] - cubics[s, 0, 0], cubics[s, 1, 1] - cubics[s, 0, 1]
    bx, by = cubics[s, 2, 0] - cubics[s, 1, 0] - ax, cubics[s, 2, 1] - cubics[s, 1, 1] - ay
    cx, cy = cubics[s, 3, 0] - cubics[s, 2, 0] - ax - 2 * bx, cubics[s, 3, 1] - cubics[s, 2, 1] - ay - 2 * by
    half, total = 0.5 * (b - a), 0.0
    for k in range(len(NODES)):
        x = a + half * (1.0 + NODES[k])
        dx, dy = ax + x * (2.0 * bx + x * cx), ay + x * (2.0 * by + x * cy)
        total += WEIGHTS[k] * np.sqrt(dx * dx + dy * dy)
    return 3.0 * half * total


@compiled
def _place(cubics: FloatArray, s: int, a: float, b: float, along: float, length: float) -> float:
    """The parameter in [a, b] of segment s at so much arc length from a: Newton's method, and bisection about cusps."""
    if not length > 0.0:
        return a
    low, high = a, b
    x = a + (b - a) * min(max(along / length, 0.0), 1.0)
    for _ in range(60):
        ahead = _length(cubics, s, a, x) - along
        if abs(ahead) <= EXACT * length:
            break
        if ahead > 0.0:
            high = x
        else:
            low = x
        _, _, dx, dy, _, _ = jet(cubics, s, x)
        x -= ahead / np.sqrt(dx * dx + dy * dy)
        if not low < x < high:
            x = 0.5 * (low + high)
    return x


@compiled
def _frame(cubics: FloatArray, s: int, x: float, line: bool, point: FloatArray, tangent: FloatArray) -> float:
    """Write point and unit tangent at a parameter of segment s; returns the curvature, 0 on a line."""
    point[0], point[1], dx, dy, ex, ey = jet(cubics, s, x)
    speed, scale = np.sqrt(dx * dx + dy * dy), 0.0
    for k in range(3):
        scale += abs(cubics[s, k + 1, 0] - cubics[s, k, 0]) + abs(cubics[s, k + 1, 1] - cubics[s, k, 1])
    # Speed relative to the control polygon's length below which a place has no curvature.
    if speed > 1e-9 * scale:
        tangent[0], tangent[1] = dx / speed, dy / speed
        return 0.0 if line else (tangent[0] * (ey / speed) - tangent[1] * (ex / speed)) / speed
    ax, ay, bx, by = directions(cubics, s, 0.0)
    if x < 0.5 and x > 1e-6:
        ax, ay = ex, ey  # a cusp inside: what follows it goes where the second derivative points
    elif x >= 0.5:
        ax, ay = (bx, by) if x > 1.0 - 1e-6 else (ex, ey)
    size = np.sqrt(ax * ax + ay * ay)
    tangent[0], tangent[1] = ax / size, ay / size
    return 0.0 if line else np.nan
