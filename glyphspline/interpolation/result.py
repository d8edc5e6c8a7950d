"""The result of an interpolation, and those of many as concatenated arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from ..compiled import inlined
from ..curves.bspline import Spline
from ..types import FloatArray, IntArray, counted

NOTHING_MERGED = np.empty(0, dtype=np.int64)


class Unread:
    """What gets its fields when one is first read: a list of results costs little until then.

    Until then ``_source`` is the batch that knows the fields, and what it needs to find them.
    """

    def __getattr__(self, name: str) -> Any:
        """A field that has no value yet."""
        batch, *which = self.__dict__.get("_source", (None,))
        if batch:
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


class Found(NamedTuple):
    """Results for K polygons with N vertices, which the compiled driver writes; parts as the polygons' ``offsets``.

    Of polygon k the knots begin at its offset, plus k if closed; its control points at its offset, plus 2 k if open.
    Where duplicates were merged, or a polygon was refused, the rest of its part is undefined.

    Attributes:
        knots, controls, parameters, bounds: as :class:`Interpolation` has them.
        kept: indices of the vertices that were not merged.
        whole: (K, 6) status (0 fine, 1 bad polygon, 2 bad knots), vertices kept, iterations, fallbacks, the
            footpoints that took a full search, and those that are not certified.
        rates, tolerances: (K,) rate bounds, and residual tolerances.
    """

    knots: FloatArray
    controls: FloatArray
    parameters: FloatArray
    bounds: FloatArray
    kept: IntArray
    whole: IntArray
    rates: FloatArray
    tolerances: FloatArray


def room_for(total: int, count: int, closed: bool, d: int) -> tuple[FloatArray, IntArray]:
    """The two arrays in which :func:`laid_out` finds a :class:`Found`: they are made and handed over in less time."""
    numbers = total * (d + 4) + count * (3 if closed else 2 + 2 * d)
    return np.empty(numbers), np.empty(total + 6 * count, np.int64)


@inlined
def laid_out(numbers: FloatArray, whole: IntArray, total: int, count: int, closed: bool, d: int) -> Found:
    """Results for ``count`` polygons with ``total`` vertices in R^d, as views of arrays of :func:`room_for`."""
    more, ends = total + count if closed else total, total if closed else total + 2 * count
    a, b, c = 2 * count, 2 * count + more, 2 * count + more + total
    return Found(
        numbers[a:b], numbers[c + 2 * total :].reshape((ends, d)), numbers[b:c],
        numbers[c : c + 2 * total].reshape((total, 2)), whole[6 * count :], whole[: 6 * count].reshape((count, 6)),
        numbers[:count], numbers[count:a],
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class BatchedInterpolation:
    """Results for K polygons as concatenated arrays; part k of ``points`` is ``offsets[k]:offsets[k + 1]``.

    Attributes:
        offsets: (K + 1,) of the points. dimension: d. closed: all polygons, or none.
        residuals: (iterations + 1) numbers a polygon, end to end. room: what the ``arrays`` are views of.
    """

    offsets: IntArray
    dimension: int
    closed: bool
    residuals: FloatArray
    room: tuple[FloatArray, IntArray]

    def __len__(self) -> int:
        return len(self.offsets) - 1

    @cached_property
    def arrays(self) -> Found:
        """The results."""
        return laid_out(*self.room, int(self.offsets[-1]), len(self), self.closed, self.dimension)

    @property
    def last_residuals(self) -> FloatArray:
        """(K,) the residuals of the results; undefined for polygons that were refused."""
        return self.residuals[np.cumsum(self.arrays.whole[:, 2] + 1) - 1]

    def __getitem__(self, k: int) -> Interpolation:
        """The result of polygon k; its arrays are views."""
        k = range(len(self))[k]
        whole = self.arrays.whole
        return self._unread(k, whole[k].tolist(), int(whole[:k, 2].sum()) + k, None)

    def results(self, points: FloatArray | None = None) -> list[Interpolation | None]:
        """All polygons' results, with views of the ``points`` (N, d) if given; None stands for one that was refused."""
        found: list[Interpolation | None] = []
        first, numbers = 0, self.room[1][: 6 * len(self)].tolist()
        for k in range(len(self)):
            row = numbers[6 * k : 6 * k + 6]
            found.append(None if row[0] else self._unread(k, row, first, points))
            first += row[2] + 1
        return found

    def _unread(self, *which: Any) -> Interpolation:
        result = Interpolation.__new__(Interpolation)
        result.__dict__["_source"] = (self, *which)
        return result

    def fields(self, k: int, row: Sequence[int], first: int, points: FloatArray | None) -> dict[str, Any]:
        """The fields of the result of polygon k: what :attr:`arrays` has of it, without the arrays of the others.

        Args:
            row: of ``Found.whole``, of a polygon that was not refused. first: where its residuals begin.
            points: (N, d) of all polygons, or None.
        """
        (numbers, integers), count, closed, d = self.room, len(self), self.closed, self.dimension
        start, stop, total = self.offsets[k : k + 2].tolist() + self.offsets[-1:].tolist()
        _, n, iterations, fallbacks, _, uncertified = row
        more, ends = (count, 0) if closed else (0, 2)
        u, t = 2 * count + start + (k if closed else 0), 2 * count + more + total + start
        b, P = t + total + start, 2 * count + more + 4 * total + (start + ends * k) * d
        merged, own = NOTHING_MERGED, None if points is None else points[start:stop]
        if n < stop - start:
            kept = integers[6 * count + start :][:n]
            merged, own = np.setdiff1d(np.arange(stop - start), kept), None if own is None else own[kept]
        residuals = self.residuals[first : first + iterations + 1]
        controls = numbers[P : P + (n + ends) * d].reshape(n + ends, d)
        return {
            "spline": Spline.trusted(controls, numbers[u : u + n + closed], 3, closed),
            "parameters": numbers[t : t + n],
            "intervals": numbers[b : b + 2 * n].reshape(n, 2),
            "iterations": iterations,
            "residuals": residuals,
            "converged": bool(residuals[-1] < numbers[count + k]),
            "fallbacks": fallbacks,
            "rate_bound": float(numbers[k]),
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
