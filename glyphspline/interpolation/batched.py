"""From arrays to the compiled core and back: many polygons in one call, over threads."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor, wait
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..curves.bspline import Spline
from ..curves.parameters import CHORD_EXPONENT, vertex_parameters
from ..errors import PolygonError
from ..types import FloatArray, IntArray
from .intervals import PEAK_SHARE, Fallback
from .polygon import clean_polygon
from .result import Interpolation

GIVEN = -1.0
"""In place of a chord exponent: the knots are the caller's."""

LEAST_VERTICES = 1024
"""The least work handed to a thread at a time, some 0.3 ms: enough to hide the hand-over."""

LARGE = 30_000
"""Polygons of so many vertices get their room from NumPy, which asks for large pages: the processor can remember
where few pages are, but not where many small ones are, and all of the room is gone through in every pass.
"""

WHOLE = 5
"""Where among the arrays of :func:`_results` the whole numbers are."""

NO_TANGENTS = np.empty((0, 2, 2))
NO_KNOTS = np.empty(0)
NO_ROOM = np.empty((0, 0))
NOTHING_MERGED = np.empty(0, dtype=np.int64)


@dataclass(frozen=True, eq=False)
class Ragged:
    """Results for K polygons as arrays laid end to end; part k of ``points`` is ``offsets[k]:offsets[k + 1]``.

    Where duplicates were merged, or a polygon was refused, the rest of its part is undefined.

    Attributes:
        offsets: (K + 1,) of the points. Of polygon k, if closed, the knots begin at ``offsets[k] + k``; if open, the
            control points at ``offsets[k] + 2 k``.
        knots, controls, parameters, bounds: as :class:`Interpolation` has them.
        kept: indices of the vertices that were not merged.
        whole: (K, 5) status (0 fine, 1 bad polygon, 2 bad knots), vertices kept, iterations, fallbacks, and the
            footpoints that took a full search.
        rates: (K,) rate bounds.
        residuals, residual_offsets: ragged, (iterations + 1) numbers a polygon.
        tolerances: (K,) what the last residual has to be below.
        closed: of all of them.
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
    residual_offsets: IntArray
    tolerances: FloatArray
    closed: bool

    def __len__(self) -> int:
        return len(self.offsets) - 1

    def result(self, k: int) -> Interpolation:
        """Polygon k's share, as an object of its own."""
        return Interpolation.shared(self, k)

    def results(self) -> list[Interpolation]:
        """All polygons' shares."""
        return Interpolation.all_shared(self, len(self))

    def read(self, k: int) -> dict[str, Any]:
        """The attributes of that object (views of the arrays)."""
        start, stop = int(self.offsets[k]), int(self.offsets[k + 1])
        n, _, fallbacks = self.whole[k, 1:4].tolist()
        if self.closed:
            knots, controls = self.knots[start + k : start + k + n + 1], self.controls[start : start + n]
        else:
            knots, controls = self.knots[start : start + n], self.controls[start + 2 * k : start + 2 * k + n + 2]
        residuals = self.residuals[self.residual_offsets[k] : self.residual_offsets[k + 1]]
        merged = NOTHING_MERGED
        if n < stop - start:
            merged = np.setdiff1d(np.arange(stop - start), self.kept[start : start + n])
        return _attributes(
            controls, knots, self.closed, self.parameters[start : start + n], self.bounds[start : start + n], residuals,
            float(self.tolerances[k]), fallbacks, float(self.rates[k]), merged,
        )  # fmt: skip


def _attributes(
    controls: FloatArray,
    knots: FloatArray,
    closed: bool,
    parameters: FloatArray,
    intervals: FloatArray,
    residuals: FloatArray,
    tolerance: float,
    fallbacks: int,
    rate_bound: float,
    merged: IntArray,
) -> dict[str, Any]:
    return {
        "spline": Spline.trusted(controls, knots, 3, closed),
        "parameters": parameters,
        "intervals": intervals,
        "iterations": len(residuals) - 1,
        "residuals": residuals,
        "converged": bool(residuals[-1] < tolerance),
        "fallbacks": fallbacks,
        "rate_bound": rate_bound,
        "merged": merged,
    }


def interpolate_ragged(
    points: FloatArray,
    offsets: IntArray,
    variant: int = 2,
    *,
    margin: float = 0.0,
    knots: str | FloatArray = "chord",
    fallback: Fallback = "knot",
    residual_tolerance: float | FloatArray = 1e-6,
    max_iterations: int = 1000,
    closed: bool = True,
    end_tangents: FloatArray | None = None,
    finish: str = "iterate",
    threads: int | None = None,
) -> Ragged:
    """Cubic interpolation of many polygons laid end to end, variants 1 to 3. No exception for a bad polygon.

    Args:
        points: (N, 2) float64, contiguous; offsets: (K + 1,) int64, where each polygon begins, and N.
        knots: a rule, or all polygons' own parameters end to end (n + 1 each if closed, n if open).
        residual_tolerance: one, or (K,).
        end_tangents: (K, 2, 2) of open arcs, NaN where the end is natural; None: all are.
        threads: as many at once; None for one a core. The results have the same bits whatever the number.
    """
    run = _compiled()
    count, total = len(offsets) - 1, len(points)
    tangents = NO_TANGENTS
    if not closed:
        tangents = np.full((count, 2, 2), np.nan) if end_tangents is None else end_tangents
    tolerances: FloatArray = np.empty(count)
    tolerances[:] = residual_tolerance
    given, exponent = (NO_KNOTS, CHORD_EXPONENT[knots]) if isinstance(knots, str) else (knots, GIVEN)
    out = _results(total, count, closed)
    peak_share = PEAK_SHARE if fallback == "peak" else 0.0

    def work(part: tuple[int, int]) -> Any:
        most = int(np.diff(offsets[part[0] : part[1] + 1]).max(initial=0))
        return run(
            part[0], part[1], points, offsets, given, tangents, closed, variant, float(margin), exponent, peak_share,
            tolerances, max_iterations, finish == "solve", _room(most), *out,
        )  # fmt: skip

    residuals = over_threads(work, _parts(offsets, threads), threads)
    u, P, parameters, bounds, kept, whole, rates = out
    lengths = np.where(whole[:, 2] < 0, 0, whole[:, 2] + 1)
    residual_offsets = np.zeros(count + 1, dtype=np.int64)
    np.cumsum(lengths, out=residual_offsets[1:])
    joined = residuals[0] if len(residuals) == 1 else np.concatenate(residuals)
    return Ragged(offsets, u, P, parameters, bounds, kept, whole, rates, joined, residual_offsets, tolerances, closed)


def _threads(threads: int | None) -> int:
    if threads:
        return threads
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _parts(offsets: IntArray, threads: int | None) -> list[tuple[int, int]]:
    """Runs of polygons, large ones first: each has half of a thread's share of what is left, LEAST_VERTICES or more.

    So that threads are done at almost the same time, however fast each of them gets on.
    """
    count, total, workers = len(offsets) - 1, int(offsets[-1]), _threads(threads)
    if workers == 1 or total < 4 * LEAST_VERTICES or count < 2:
        return [(0, count)]
    cuts = [0]
    while cuts[-1] < total:
        cuts.append(cuts[-1] + max((total - cuts[-1]) // (2 * workers), LEAST_VERTICES))
    ends = np.unique([*np.searchsorted(offsets, np.minimum(cuts, total)), count])
    return [(int(a), int(b)) for a, b in pairwise(ends)]


def _room(most: int) -> FloatArray:
    """Room for a large polygon, or none: the compiled code finds small ones their own."""
    if most < LARGE:
        return NO_ROOM
    from .kernels.blocks import BLOCK, LANES

    return np.empty((-(-most // LANES), BLOCK))


def _results(total: int, count: int, closed: bool) -> tuple[Any, ...]:
    """Room for knots, control points, parameters, intervals, vertices kept, whole numbers and rates."""
    return (
        np.empty(total + count if closed else total),
        np.empty((total if closed else total + 2 * count, 2)),
        np.empty(total),
        np.empty((total, 2)),
        np.empty(total, dtype=np.int64),
        np.empty((count, 5), dtype=np.int64),
        np.empty(count),
    )


class Single:
    """What the compiled core left of one polygon, made into the result's attributes when one is first asked for."""

    __slots__ = ("closed", "out", "residuals", "tolerance")

    def __init__(self, out: tuple[Any, ...], residuals: FloatArray, tolerance: float, closed: bool) -> None:
        self.out, self.residuals, self.tolerance, self.closed = out, residuals, tolerance, closed

    def read(self, k: int) -> dict[str, Any]:
        """The attributes (``k`` is 0, there being one polygon)."""
        u, P, parameters, bounds, kept, whole, rates = self.out
        _, n, _, fallbacks, _ = whole[k].tolist()
        merged = NOTHING_MERGED
        if n < len(parameters):
            merged = np.setdiff1d(np.arange(len(parameters)), kept[:n])
            u, parameters, bounds = u[: n + self.closed], parameters[:n], bounds[:n]
            P = P[: n if self.closed else n + 2]
        return _attributes(
            P, u, self.closed, parameters, bounds, self.residuals, self.tolerance, fallbacks, float(rates[k]), merged
        )


def interpolate_one(
    points: FloatArray,
    variant: int,
    margin: float,
    knots: str | FloatArray,
    fallback: str,
    tolerance: float,
    max_iterations: int,
    closed: bool,
    tangents: FloatArray,
    finish: str,
) -> Interpolation | None:
    """:func:`interpolate_ragged` of a single polygon with as little around it as can be; None if it was refused."""
    n = len(points)
    out = _results(n, 1, closed)
    given, exponent = (NO_KNOTS, CHORD_EXPONENT[knots]) if isinstance(knots, str) else (knots, GIVEN)
    residuals = _compiled()(
        0, 1, points, np.array((0, n)), given, tangents, closed, variant, margin, exponent,
        PEAK_SHARE if fallback == "peak" else 0.0, np.array((tolerance,)), max_iterations, finish == "solve", _room(n),
        *out,
    )  # fmt: skip
    if out[WHOLE][0, 0]:
        return None
    return Interpolation.shared(Single(out, residuals, tolerance, closed), 0)


@cache
def _compiled() -> Any:
    """The compiled core, imported when it is first wanted."""
    from .kernels.run import run

    return run


def over_threads(work: Callable[[Any], Any], items: Sequence[Any], threads: int | None = None) -> list[Any]:
    """``work`` of each item, in order; worth it where work lets go of the interpreter's lock.

    The caller's thread works too, which saves waking another one; each takes the next item when it is done with one.
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
    """Kept from call to call: threads cost more to start than a glyph to interpolate."""
    return ThreadPoolExecutor(threads, thread_name_prefix="glyphspline")


def explain(points: ArrayLike, knots: Any, closed: bool) -> PolygonError:
    """The error that a polygon refused by the compiled core deserves, in words."""
    try:
        p, merged = clean_polygon(points, closed)
        if not isinstance(knots, str):
            knots = np.delete(np.asarray(knots, dtype=np.float64), merged)
        vertex_parameters(p, knots, closed)
    except PolygonError as error:
        return error
    return PolygonError(
        "neighbouring vertices are so close, beside the polygon's length, that their knots fall together"
    )
