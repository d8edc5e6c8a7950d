"""Open paths, as contours that go along a path and back on itself.

Fonts have no other: the strokes of a single-line font are drawn there and back, and enclose nothing. An open contour of
a UFO becomes the same here. So all that is done to closed contours can be done to it; fits and writers ask
:func:`are_open`, and take the way there.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from ..types import BoolArray, FloatArray, IntArray
from .contour_arrays import ContourArrays, end_to_end, offsets_of

Path = tuple[FloatArray, IntArray]
"""Points (..., N + 1, 2), and degrees (m,) whose sum is N, of an open path."""


def there_and_back(points: FloatArray, degrees: IntArray) -> Path:
    """Points (..., 2 N, 2) and degrees (2 m,) of the contour of a path (..., N + 1, 2)."""
    return np.concatenate([points, points[..., -2:0:-1, :]], axis=-2), np.concatenate([degrees, degrees[::-1]])


def are_open(contours: ContourArrays) -> BoolArray:
    """(C,) which contours go along a path and back, from one of its ends on, point by point."""
    points, degrees, offsets, starts = contours
    if not len(points):
        return np.zeros(contours.num_contours, dtype=np.bool_)
    second, last = (points.take(at, axis=0, mode="clip") for at in (starts[:-1] + 1, starts[1:] - 1))
    found: BoolArray = (second[:, 0] == last[:, 0]) & (second[:, 1] == last[:, 1])
    for c in np.flatnonzero(found).tolist():
        own, kinds = points[starts[c] : starts[c + 1]], degrees[offsets[c] : offsets[c + 1]]
        back = np.array_equal(kinds, kinds[::-1]) and np.array_equal(own[1:], own[:0:-1])
        found[c] = len(kinds) % 2 == 0 and back and np.isfinite(own).all() and (own != own[:1]).any()
    return found


def paths(contours: ContourArrays, opened: BoolArray) -> ContourArrays:
    """The contours with the way there, and a line back from its end, in the place of those that are ``opened``."""
    if not opened.any():
        return contours
    points, degrees, offsets, starts = contours
    found = []
    for (i, j), (a, b), cut in zip(pairwise(offsets.tolist()), pairwise(starts.tolist()), opened.tolist(), strict=True):
        own, kinds = points[a:b], degrees[i:j]
        found.append((own[: (b - a) // 2 + 1], np.append(kinds[: (j - i) // 2], 1)) if cut else (own, kinds))
    return end_to_end(found)


def by_kind(opened: BoolArray, glyphs: IntArray) -> Iterator[tuple[IntArray, IntArray]]:
    """Of closed contours, and then of open ones: their numbers, and (G + 1,) where those of each glyph begin."""
    for which in (np.flatnonzero(~opened), np.flatnonzero(opened)):
        yield which, np.searchsorted(which, glyphs)


def lasting_path(points: FloatArray, degrees: IntArray, coincident: float) -> tuple[Path | None, float]:
    """A path in K masters (K, N + 1, 2) without segments whose points all coincide, None if nothing is left; and the
    largest distance of a point that was dropped.
    """
    kept, kinds, first, dropped = [0], list[int](), 0, 0.0
    for degree in degrees.tolist():
        own = range(first + 1, first + degree + 1)
        away = np.abs(points[:, own] - points[:, kept[-1:]])
        if (away <= coincident).all():
            dropped = max(dropped, float(np.hypot(*away.max(axis=(0, 1)))))
        else:
            kept += own
            kinds.append(degree)
        first += degree
    return ((points[:, kept], np.array(kinds, dtype=np.int64)) if kinds else None), dropped


def retraced(points: FloatArray, degrees: IntArray, coincident: float) -> list[Path]:
    """The strokes of a closed contour in K masters (K, N, 2) that runs over each of its segments once each way.

    From a joint where it turns back on, what it has not run over before are strokes: one of a path there and back,
    several where it branches. Of any other contour there are none.
    """
    if not without_area(points[0], np.array([0, points.shape[1]]))[0]:
        return []
    path, _ = lasting_path(np.concatenate([points, points[:, :1]], axis=1) + 0.0, degrees, coincident)
    if path is None:
        return []
    closed, degrees = path
    closed[:, -1] = closed[:, 0]
    segments = [closed[:, a : b + 1] for a, b in pairwise(offsets_of(degrees).tolist())]
    forth = [each.tobytes() for each in segments]
    back = [np.ascontiguousarray(each[:, ::-1]).tobytes() for each in segments]
    tips = [j for j in range(len(forth)) if forth[j] == back[j - 1]]
    found, waiting, goes_on = list[list[int]](), Counter[bytes](), False
    for j in (*range(tips[0], len(forth)), *range(tips[0])) if tips else ():
        is_new = not waiting[forth[j]]
        if is_new:
            waiting[back[j]] += 1
            found += [] if goes_on else [[]]
            found[-1].append(j)
        else:
            waiting[forth[j]] -= 1
        goes_on = is_new
    if waiting.total():
        return []
    return [
        (np.concatenate([*(segments[j][:, :-1] for j in each), segments[each[-1]][:, -1:]], axis=1), degrees[each])
        for each in found
    ]


def without_area(points: FloatArray, starts: IntArray) -> BoolArray:
    """(C,) which control polygons, that begin at (C + 1,) in points (N, 2), have no area but for rounding errors."""
    after = np.arange(1, len(points) + 1)
    after[starts[1:] - 1] = starts[:-1]
    with np.errstate(all="ignore"):  # coordinates that are not finite are refused later
        (x, y), (u, v) = points.T, points[after].T
        products = x * v - u * y
        areas, sums = (np.add.reduceat(each, starts[:-1]) for each in (products, np.abs(products)))
        return np.asarray(np.abs(areas) <= 1e-9 * sums)
