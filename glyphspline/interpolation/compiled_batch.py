"""Many cubic polygons in one compiled call, over threads: arrays laid end to end go in and come out."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor, wait
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from typing import Any, cast

import numpy as np

from ..curves.bspline import Spline
from ..curves.choices import CHORD_EXPONENT
from ..types import FloatArray, IntArray
from .method import SETTLED, Method, Tangents
from .polygon import as_tangent
from .result import NOTHING_MERGED, Interpolation

GIVEN = -1.0
"""In place of a chord exponent: knots are given."""

LEAST_VERTICES = 1024
"""Minimum work of a thread at a time, some 0.3 ms: long compared with the cost of the exchange."""

NO_TANGENTS = np.empty((0, 2, 2))
NO_KNOTS = np.empty(0)


@dataclass(frozen=True, eq=False)
class BatchedInterpolation:
    """Results for K polygons as arrays laid end to end; part k of ``points`` is ``offsets[k]:offsets[k + 1]``.

    Where duplicates were merged, or a polygon was refused, the rest of its part is undefined.

    Attributes:
        offsets: (K + 1,) of the points. Of polygon k, if closed, the knots begin at ``offsets[k] + k``; if open, the
            control points at ``offsets[k] + 2 k``.
        knots, controls, parameters, bounds: as :class:`Interpolation` has them.
        kept: indices of the vertices that were not merged.
        whole: (K, 6) status (0 fine, 1 bad polygon, 2 bad knots), vertices kept, iterations, fallbacks, the
            footpoints that took a full search, and those that are not certified.
        rates: (K,) rate bounds.
        residuals: (iterations + 1) numbers a polygon, end to end.
        tolerances: (K,) residual tolerances.
        closed: of all polygons.
    """

    offsets: IntArray
    knots: FloatArray
    controls: FloatArray
    parameters: FloatArray
    bounds: FloatArray
    kept: IntArray
    whole: IntArray
    rates: FloatArray
    residuals: FloatArray
    tolerances: FloatArray
    closed: bool

    def __len__(self) -> int:
        return len(self.offsets) - 1

    @property
    def last_residuals(self) -> FloatArray:
        """(K,) the residuals of the results; undefined for polygons that were refused."""
        return self.residuals[np.cumsum(self.whole[:, 2] + 1) - 1]

    def __getitem__(self, k: int) -> Interpolation:
        """The result of polygon k; its arrays are views."""
        k = range(len(self))[k]
        start, stop = self.offsets[k : k + 2].tolist()
        first = int(self.whole[:k, 2].sum()) + k
        return self._result(
            k, start, stop, self.whole[k].tolist(), first, float(self.tolerances[k]), float(self.rates[k])
        )

    def results(self) -> list[Interpolation]:
        """All polygons' results; None stands for one that was refused."""
        starts, whole, found, first = self.offsets.tolist(), self.whole.tolist(), [], 0
        rows = zip(starts, starts[1:], whole, self.tolerances.tolist(), self.rates.tolist(), strict=False)
        for k, (start, stop, row, tolerance, rate) in enumerate(rows):
            found.append(cast(Any, None) if row[0] else self._result(k, start, stop, row, first, tolerance, rate))
            first += row[2] + 1
        return found

    def _result(
        self, k: int, start: int, stop: int, whole: list[int], first: int, tolerance: float, rate: float
    ) -> Interpolation:
        _, n, iterations, fallbacks, _, uncertified = whole
        if self.closed:
            knots, controls = self.knots[start + k : start + k + n + 1], self.controls[start : start + n]
        else:
            knots, controls = self.knots[start : start + n], self.controls[start + 2 * k : start + 2 * k + n + 2]
        merged = NOTHING_MERGED
        if n < stop - start:
            merged = np.setdiff1d(np.arange(stop - start), self.kept[start : start + n])
        residuals = self.residuals[first : first + iterations + 1]
        spline, vertices = Spline.trusted(controls, knots, 3, self.closed), slice(start, start + n)
        return Interpolation(
            spline, self.parameters[vertices], self.bounds[vertices], iterations, residuals,
            float(residuals[-1]) < tolerance, fallbacks, rate, merged, uncertified,
        )  # fmt: skip


def run_batch(
    points: FloatArray,
    offsets: IntArray,
    method: Method,
    *,
    peak_shares: FloatArray,
    knots: FloatArray | None = None,
    end_tangents: FloatArray | None = None,
    residual_tolerances: FloatArray | None = None,
    threads: int | None = None,
) -> BatchedInterpolation:
    """Run the compiled driver over polygons laid end to end; arguments as :func:`.batched.interpolate_batch` has them.

    Args:
        method: of degree 3, variant 1 to 3. peak_shares: (K,) :attr:`.Method.peak_share` of each polygon.
    """
    (total, d), count, closed = points.shape, len(offsets) - 1, method.closed
    tangents = NO_TANGENTS
    if not closed:
        tangents = np.full((count, 2, d), np.nan) if end_tangents is None else end_tangents
    tolerance = np.nan if method.residual_tolerance is None else method.residual_tolerance
    tolerances = filled(count, tolerance) if residual_tolerances is None else residual_tolerances.copy()
    kernels = _compiled()
    given = kernels.Given(
        points, offsets, NO_KNOTS if knots is None else knots, tangents, closed, method.variant, float(method.margin),
        GIVEN if method.knots is None else CHORD_EXPONENT[method.knots], peak_shares, tolerances,
        method.max_iterations, SETTLED if method.finish == "solve" else 0.0,
    )  # fmt: skip
    found = kernels.Found(*empty_results(total, count, closed, d))

    def work(part: tuple[int, int]) -> Any:
        return kernels.run(*part, given, found, _memory(offsets, *part, d))

    residuals = over_threads(work, _parts(offsets, threads), threads)
    joined = residuals[0] if len(residuals) == 1 else np.concatenate(residuals)
    u, P, parameters, bounds, kept, whole, rates = found
    return BatchedInterpolation(offsets, u, P, parameters, bounds, kept, whole, rates, joined, tolerances, closed)


def filled(count: int, value: float) -> FloatArray:
    """An array of one value, in a third of the time of ``numpy.full``."""
    array = np.empty(count)
    array.fill(value)
    return array


def _memory(offsets: IntArray, first: int, stop: int, d: int) -> FloatArray:
    """Memory for the blocks of the largest polygon.

    NumPy asks for huge pages, which compiled code does not: passes over 60,000 vertices take a fifth less time.
    """
    most = int(offsets[stop] - offsets[first])
    if stop > first + 1:
        most = int((offsets[first + 1 : stop + 1] - offsets[first:stop]).max())
    kernels = _compiled()
    return np.empty(-(-max(most, 1) // kernels.LANES) * (kernels.BLOCK + 3 * kernels.STRIDE * (d + d % 2)))


def _threads(threads: int | None) -> int:
    if threads:
        return threads
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _parts(offsets: IntArray, threads: int | None) -> list[tuple[int, int]]:
    """Ranges of polygons, each with half of a thread's share of the rest, ``LEAST_VERTICES`` or more.

    Sizes decrease, so that threads of unequal speed finish at almost the same time.
    """
    count, total, workers = len(offsets) - 1, int(offsets[-1]), _threads(threads)
    if workers == 1 or total < 4 * LEAST_VERTICES or count < 2:
        return [(0, count)]
    cuts = [0]
    while cuts[-1] < total:
        cuts.append(cuts[-1] + max((total - cuts[-1]) // (2 * workers), LEAST_VERTICES))
    ends = np.unique([*np.searchsorted(offsets, np.minimum(cuts, total)), count])
    return [(int(a), int(b)) for a, b in pairwise(ends)]


def empty_results(total: int, count: int, closed: bool, d: int) -> tuple[Any, ...]:
    """Empty arrays for knots, control points, parameters, intervals, vertices kept, whole numbers and rates."""
    return (
        np.empty(total + count if closed else total),
        np.empty((total if closed else total + 2 * count, d)),
        np.empty(total),
        np.empty((total, 2)),
        np.empty(total, dtype=np.int64),
        np.empty((count, 6), dtype=np.int64),
        np.empty(count),
    )


@cache
def _compiled() -> Any:
    """The compiled driver, imported at the first call, as it imports the compiler."""
    from .kernels import driver

    return driver


def as_tangents(tangents: Sequence[Tangents | None], d: int) -> FloatArray:
    """End tangents of K arcs as (K, 2, d), NaN for natural ends."""
    array = np.full((len(tangents), 2, d), np.nan)
    for k, pair in enumerate(tangents):
        for end, tangent in enumerate(pair or ()):
            if tangent is not None:
                array[k, end] = as_tangent(tangent, d)
    return array


def over_threads(work: Callable[[Any], Any], items: Sequence[Any], threads: int | None = None) -> list[Any]:
    """``work`` of each item, in order, on several threads; ``work`` should release the interpreter's lock.

    The calling thread works too. Each thread takes the next item when it has finished one.
    """
    helpers = min(_threads(threads), len(items)) - 1
    if helpers < 1:
        return [work(item) for item in items]
    results: list[Any] = [None] * len(items)
    left = iter(range(len(items)))

    def take() -> None:
        for i in left:
            results[i] = work(items[i])

    running = [_pool(_threads(threads)).submit(take) for _ in range(helpers)]
    try:
        take()
    finally:
        wait([helper for helper in running if not helper.cancel()])
    for helper in running:
        if not helper.cancelled():
            helper.result()
    return results


@cache
def _pool(threads: int) -> ThreadPoolExecutor:
    """A pool that is kept: starting threads takes longer than interpolating a glyph."""
    return ThreadPoolExecutor(threads, thread_name_prefix="glyphspline")
