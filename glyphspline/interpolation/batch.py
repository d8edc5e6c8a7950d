"""Many cubic polygons in one call, over threads: concatenated arrays go in and come out."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np

from ..types import IntArray
from .found import room_for
from .method import Method
from .plain import interpolate
from .polygon import Polygons
from .result import BatchedInterpolation

LEAST_VERTICES = 1024
"""Minimum work of a thread at a time, some 0.3 ms: long compared with the cost of the exchange."""


def interpolate_batch(polygons: Polygons, method: Method, threads: int | None = None) -> BatchedInterpolation:
    """Interpolate many polygons in shared arrays. A bad polygon has a status and raises no exception.

    Args:
        polygons: their points are (N, d) float64, contiguous, d ≥ 2.
        method: of degree 3, without diagnostics.
        threads: number of threads; None for one a core. Results do not depend on it.
    """
    (total, d), offsets = polygons.points.shape, polygons.offsets
    if not method.closed and not len(polygons.tangents):
        polygons = polygons._replace(tangents=np.full((len(offsets) - 1, 2, d), np.nan))
    numbers, whole = room_for(total, len(offsets) - 1, method.closed, d)

    given: tuple[Any, ...] = (*polygons, method.numbers, numbers, whole)
    parts = _parts(offsets, threads)
    if len(parts) == 1:
        residuals = interpolate(*parts[0], *given)
    else:
        residuals = np.concatenate(over_threads(lambda part: interpolate(*part, *given), parts, threads))
    return BatchedInterpolation(offsets, d, method.closed, residuals, numbers, whole)


def _threads(threads: int | None) -> int:
    if threads:
        return threads
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _parts(offsets: IntArray, threads: int | None) -> list[tuple[int, int]]:
    """Ranges of polygons, each half a thread's share of the rest: they shrink, so that all threads end together."""
    count, total = len(offsets) - 1, int(offsets[-1])
    if count < 2 or total < 4 * LEAST_VERTICES or _threads(threads) == 1:
        return [(0, count)]
    cuts = [0]
    while cuts[-1] < total:
        cuts.append(cuts[-1] + max((total - cuts[-1]) // (2 * _threads(threads)), LEAST_VERTICES))
    ends = np.unique([*np.searchsorted(offsets, np.minimum(cuts, total)), count])
    return [(int(a), int(b)) for a, b in pairwise(ends)]


def over_threads(work: Callable[[Any], Any], items: Sequence[Any], threads: int | None = None) -> list[Any]:
    """``work`` of each item, in order, on several threads; ``work`` should release the interpreter's lock."""
    if len(items) < 2 or _threads(threads) == 1:
        return [work(item) for item in items]
    return list(_pool(_threads(threads)).map(work, items))


@cache
def _pool(threads: int) -> ThreadPoolExecutor:
    """A pool that is kept: starting threads takes longer than interpolating a glyph."""
    return ThreadPoolExecutor(threads, thread_name_prefix="glyphspline")
