"""The result of an interpolation."""

from __future__ import annotations

from dataclasses import dataclass, replace

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
