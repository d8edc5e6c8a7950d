"""Many cubic polygons in one call, over threads: concatenated arrays go in and come out."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np

from ..types import BoolArray, FloatArray, IntArray
from .method import CHORD_EXPONENT, Method
from .plain import iterate, prepare
from .result import BatchedInterpolation, Found

GIVEN = -1.0
"""In place of a chord exponent: knots are given."""

LEAST_VERTICES = 1024
"""Minimum work of a thread at a time, some 0.3 ms: long compared with the cost of the exchange."""

NO_TANGENTS = np.empty((0, 2, 2))
NO_KNOTS = np.empty(0)
NONE_HELD = np.empty(0, dtype=np.bool_)


def run_batch(
    points: FloatArray,
    offsets: IntArray,
    method: Method,
    peak_shares: FloatArray,
    tolerances: FloatArray,
    knots: FloatArray | None,
    end_tangents: FloatArray | None,
    threads: int | None = 1,
    held: BoolArray = NONE_HELD,
) -> BatchedInterpolation:
    """Run the driver over concatenated polygons; arguments as :func:`.api.interpolate_batch` has them.

    Args:
        method: of degree 3, without diagnostics. peak_shares: (K,) :attr:`.Method.peak_share` of each polygon.
        tolerances: (K,) residual tolerances; NaN is replaced by the default one.
    """
    (total, d), count, closed = points.shape, len(offsets) - 1, method.closed
    tangents = NO_TANGENTS
    if not closed:
        tangents = np.full((count, 2, d), np.nan) if end_tangents is None else end_tangents
    exponent = GIVEN if method.knots is None else CHORD_EXPONENT[method.knots]
    found = Found.empty(total, count, closed, d)

    def work(part: tuple[int, int]) -> Any:
        prepare(
            *part, points, offsets, NO_KNOTS if knots is None else knots, tangents, held, peak_shares, tolerances,
            closed, method.variant, float(method.margin), exponent, found.knots, found.bounds, found.kept, found.whole,
            found.rates,
        )  # fmt: skip
        return iterate(
            *part, points, offsets, tangents, held, tolerances, closed, method.variant, method.max_iterations,
            found.knots, found.controls, found.parameters, found.bounds, found.kept, found.whole,
        )  # fmt: skip

    residuals = over_threads(work, _parts(offsets, threads), threads)
    joined = residuals[0] if len(residuals) == 1 else np.concatenate(residuals)
    return BatchedInterpolation(offsets, closed, tolerances, joined, found)


def _threads(threads: int | None) -> int:
    if threads:
        return threads
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _parts(offsets: IntArray, threads: int | None) -> list[tuple[int, int]]:
    """Ranges of polygons, each with half of a thread's share of the rest, ``LEAST_VERTICES`` or more.

    Sizes decrease, so that threads of unequal speed finish at almost the same time.
    """
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
    count = min(_threads(threads), len(items))
    return list((_pool(_threads(threads)).map if count > 1 else map)(work, items))


@cache
def _pool(threads: int) -> ThreadPoolExecutor:
    """A pool that is kept: starting threads takes longer than interpolating a glyph."""
    return ThreadPoolExecutor(threads, thread_name_prefix="glyphspline")
