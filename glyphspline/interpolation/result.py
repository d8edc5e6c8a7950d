"""The result of an interpolation, and those of many as concatenated arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..curves.bspline import Spline
from ..types import FloatArray, IntArray, counted
from .found import Found, laid_out

NOTHING_MERGED = np.empty(0, dtype=np.int64)


class Unread:
    """What gets its fields when one is first read: a list of results costs little until then.

    Until then ``_source`` is the batch that knows the fields, and where they are in it.
    """

    if not TYPE_CHECKING:  # or any name would pass for an attribute

        def __getattr__(self, name: str) -> Any:
            """A field that has no value yet."""
            source = self.__dict__.get("_source")
            if source:
                batch, which = source
                self.__dict__.update(batch.fields(*which))
                self.__dict__.pop("_source", None)  # last: another thread may read the result, too
            try:
                return self.__dict__[name]
            except KeyError:
                raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}") from None

    def __getstate__(self) -> dict[str, Any]:
        """What is pickled: the fields, and not the whole batch."""
        return {field.name: getattr(self, field.name) for field in fields(self)}  # type: ignore[arg-type]


@dataclass(frozen=True, eq=False)
class Interpolation(Unread):
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
    uncertified: int | None = field(default_factory=lambda: None)  # a default would be found where it is unread
    history: tuple[tuple[FloatArray, FloatArray], ...] | None = None
    rate_observed: float | None = None
    spectral_radii: FloatArray | None = None
    points: FloatArray | None = field(default_factory=lambda: None)

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


class BatchedInterpolation(NamedTuple):
    """Results for K polygons as concatenated arrays; part k of ``points`` is ``offsets[k]:offsets[k + 1]``.

    Attributes:
        offsets: (K + 1,) of the points. dimension: d. closed: all polygons, or none.
        residuals: (iterations + 1) numbers a polygon, end to end.
        numbers, whole: what the :attr:`arrays` are views of.
    """

    offsets: IntArray
    dimension: int
    closed: bool
    residuals: FloatArray
    numbers: FloatArray
    whole: IntArray

    @property
    def arrays(self) -> Found:
        """The results."""
        total, count = int(self.offsets[-1]), len(self.offsets) - 1
        return laid_out(self.numbers, self.whole, total, count, self.closed, self.dimension)

    @property
    def last_residuals(self) -> FloatArray:
        """(K,) the residuals of the results; undefined for polygons that were refused."""
        return self.residuals[np.cumsum(self.arrays.whole[:, 2] + 1) - 1]

    def results(self, points: FloatArray | None = None) -> list[Any]:
        """All polygons' results, with views of the ``points`` (N, d) if given; None stands for one that was refused."""
        offsets, rows, first = self.offsets.tolist(), self.whole[: 6 * len(self.offsets) - 6].tolist(), 0
        found: list[Any] = []
        for k in range(len(offsets) - 1):
            row = rows[6 * k : 6 * k + 6]
            result = None if row[0] else Interpolation.__new__(Interpolation)
            if result is not None:
                result.__dict__["_source"] = self, (k, offsets[k], offsets[k + 1], row, first, points)
            found.append(result)
            first += row[2] + 1
        return found

    def first(self, points: FloatArray) -> Interpolation | None:
        """The result of the first polygon, whose points they are, as of :meth:`results`; its fields are there."""
        row = self.whole[:6].tolist()
        if row[0]:
            return None
        result = Interpolation.__new__(Interpolation)
        result.__dict__.update(self.fields(0, 0, len(points), row, 0, points))
        return result

    def fields(
        self, k: int, start: int, stop: int, row: Sequence[int], first: int, points: FloatArray | None
    ) -> dict[str, Any]:
        """The fields of the result of polygon k: what :attr:`arrays` has of it, without the arrays of the others.

        Args:
            start, stop: its ``offsets``. row: of ``Found.whole``. first: where its residuals begin.
            points: (N, d) of all polygons, or None.
        """
        offsets, d, closed, residuals, numbers, whole = self
        _, n, iterations, fallbacks, _, uncertified = row
        count = len(offsets) - 1
        total = len(whole) - 6 * count
        # Where knots, parameters, bounds and control points of it begin, as laid_out has them.
        u, t, ends = 2 * count + start + k, 3 * count + total + start, 0
        if not closed:
            u, t, ends = u - k, t - count, 2
        b, P = t + total + start, t + 3 * total - start + (start + ends * k) * d
        merged, own = NOTHING_MERGED, None if points is None else points[start:stop]
        if n < stop - start:
            kept = whole[6 * count + start :][:n]
            merged, own = np.setdiff1d(np.arange(stop - start), kept), None if own is None else own[kept]
        residuals = residuals[first : first + iterations + 1]
        controls = numbers[P : P + (n + ends) * d].reshape(n + ends, d)
        return {
            "spline": Spline.trusted(controls, numbers[u : u + n + closed], 3, closed),
            "parameters": numbers[t : t + n],
            "intervals": numbers[b : b + 2 * n].reshape(n, 2),
            "iterations": iterations,
            "residuals": residuals,
            "converged": residuals.item(iterations) < numbers.item(count + k),
            "fallbacks": fallbacks,
            "rate_bound": numbers.item(k),
            "merged": merged,
            "uncertified": uncertified,
            "points": own,
        }


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
