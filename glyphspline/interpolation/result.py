"""The result of an interpolation, and those of many as concatenated arrays."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from ..curves.bspline import Spline
from ..types import FloatArray, IntArray, counted

NOTHING_MERGED = np.empty(0, dtype=np.int64)


@dataclass(frozen=True, eq=False, slots=True)
class Interpolation:
    """The result of an interpolation; not converging is a result, not an error.

    Attributes:
        spline: the curve.
        parameters: (n,) footpoint of each vertex, unwrapped: those of p_0 may be negative.
        intervals: (n, 2) the search interval of each footpoint.
        iterations: number of updates made (of sweeps before the one that passed, in Algorithm 3).
        residuals: (iterations + 1,) largest distance of a vertex from its footpoint before each update;
            the last entry is that of the result.
        converged: whether the last residual is below the residual tolerance.
        fallbacks: number of vertices for which Lemma 2 has no interval (Remark 3).
        rate_bound: certified factor a step of the largest error (Theorem 2); 1 or more certifies nothing.
        merged: indices of the given vertices that were dropped as duplicates of the one before.
        uncertified: number of footpoints, over all passes, that are not certified to be the nearest points of their
            intervals (to within 1e-12 of the extent); None where no certificate is computed. It is 0 in ordinary runs:
            the search gives up only where the curve is not finite, or after many parts of an interval. ``converged``
            does not depend on it, as any footpoint is a point of the curve in its interval. ``rate_bound`` needs 0:
            in Theorem 2 a footpoint is no farther from its vertex than the curve at the parameter of the pass before.
        points: (n, d) the vertices, without those merged; None in fits of outlines, which have them end to end.
        history, rate_observed, spectral_radii: with ``diagnostics=True``, else None.
    """

    spline: Spline
    parameters: FloatArray
    intervals: FloatArray
    iterations: int
    residuals: FloatArray
    converged: bool
    fallbacks: int
    rate_bound: float
    merged: IntArray
    uncertified: int | None = None
    history: tuple[tuple[FloatArray, FloatArray], ...] | None = None
    rate_observed: float | None = None
    spectral_radii: FloatArray | None = None
    points: FloatArray | None = None

    def __repr__(self) -> str:
        kind, vertices = "closed" if self.spline.closed else "open", f"{len(self.parameters)} vertices"
        converged = "converged" if self.converged else "not converged"
        steps = counted(self.iterations, "iteration")
        doubt = f", {counted(self.uncertified, 'uncertified footpoint')}" if self.uncertified else ""
        return f"<Interpolation: {kind}, {vertices}, {converged}, {steps}, residual {self.max_error:.2g}{doubt}>"

    @property
    def max_error(self) -> float:
        """The largest distance of a vertex from its footpoint on the result."""
        return float(self.residuals[-1])


class Found(NamedTuple):
    """Results for K polygons with N vertices, which the compiled driver writes; parts as the polygons' ``offsets``.

    Of polygon k the knots begin at its offset, plus k if closed; its control points at its offset, plus 2 k if open.
    Where duplicates were merged, or a polygon was refused, the rest of its part is undefined.

    Attributes:
        knots, controls, parameters, bounds: as :class:`Interpolation` has them.
        kept: indices of the vertices that were not merged.
        whole: (K, 6) status (0 fine, 1 bad polygon, 2 bad knots), vertices kept, iterations, fallbacks, the
            footpoints that took a full search, and those that are not certified.
        rates: (K,) rate bounds.
    """

    knots: FloatArray
    controls: FloatArray
    parameters: FloatArray
    bounds: FloatArray
    kept: IntArray
    whole: IntArray
    rates: FloatArray

    @classmethod
    def empty(cls, total: int, count: int, closed: bool, d: int) -> Found:
        """Arrays for ``count`` polygons with ``total`` vertices in R^d."""
        new = np.empty
        return cls(
            new(total + count * closed), new((total + 2 * count * (not closed), d)), new(total), new((total, 2)),
            new(total, np.int64), new((count, 6), np.int64), new(count),
        )  # fmt: skip


@dataclass(frozen=True, eq=False)
class BatchedInterpolation:
    """Results for K polygons as concatenated arrays; part k of ``points`` is ``offsets[k]:offsets[k + 1]``.

    Attributes:
        offsets: (K + 1,) of the points. closed: all polygons, or none. arrays: the results.
        tolerances: (K,) residual tolerances. residuals: (iterations + 1) numbers a polygon, end to end.
    """

    offsets: IntArray
    closed: bool
    tolerances: FloatArray
    residuals: FloatArray
    arrays: Found

    def __len__(self) -> int:
        return len(self.offsets) - 1

    @property
    def last_residuals(self) -> FloatArray:
        """(K,) the residuals of the results; undefined for polygons that were refused."""
        return self.residuals[np.cumsum(self.arrays.whole[:, 2] + 1) - 1]

    def __getitem__(self, k: int) -> Interpolation:
        """The result of polygon k; its arrays are views."""
        k = range(len(self))[k]
        return next(self._results(k, int(self.arrays.whole[:k, 2].sum()) + k))

    def results(self, points: FloatArray | None = None) -> list[Interpolation]:
        """All polygons' results, with views of the ``points`` (N, d) if given; None stands for one that was refused."""
        return list(self._results(0, 0, points))

    def _results(self, k: int, first: int, points: FloatArray | None = None) -> Iterator[Any]:
        """Results from polygon k on, whose residuals begin at ``first``."""
        found, closed, tolerances = self.arrays, self.closed, self.tolerances[k:].tolist()
        offsets, whole, rates = self.offsets[k:].tolist(), found.whole[k:].tolist(), found.rates[k:].tolist()
        for start, stop, row, tolerance, rate in zip(offsets, offsets[1:], whole, tolerances, rates, strict=False):
            status, n, iterations, fallbacks, _, uncertified = row
            if status:
                yield None
            else:
                u, P, vertices = start + k * closed, start + 2 * k * (not closed), slice(start, start + n)
                merged, own = NOTHING_MERGED, None if points is None else points[start:stop]
                if n < stop - start:
                    merged = np.setdiff1d(np.arange(stop - start), found.kept[vertices])
                    own = None if own is None else own[found.kept[vertices]]
                residuals = self.residuals[first : first + iterations + 1]
                spline = Spline.trusted(
                    found.controls[P : P + n + 2 * (not closed)], found.knots[u : u + n + closed], 3, closed
                )
                yield Interpolation(
                    spline, found.parameters[vertices], found.bounds[vertices], iterations, residuals,
                    float(residuals[-1]) < tolerance, fallbacks, rate, merged, uncertified, points=own,
                )  # fmt: skip
            k, first = k + 1, first + iterations + 1


def reversed_interpolation(result: Interpolation) -> Interpolation:
    """The same closed curve for the reversed polygon with the same first vertex."""
    spline, t, ends = result.spline, result.parameters, result.intervals
    period = spline.knots[-1]
    parameters, intervals = turned(period - t), turned(period - ends[:, ::-1])
    parameters[0], intervals[0] = -t[0], -ends[0, ::-1]
    controls, knots = turned(spline.control_points), period - spline.knots[::-1]
    return replace(result, spline=Spline.trusted(controls, knots, 3, True), parameters=parameters, intervals=intervals)


def turned(rows: FloatArray) -> FloatArray:
    """The rows of a ring of vertices in the opposite direction, from the same first one."""
    return np.concatenate([rows[:1], rows[:0:-1]])
