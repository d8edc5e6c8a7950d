"""What an interpolation returns."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

from ..curves.bspline import Spline
from ..types import FloatArray, IntArray


class Shared(Protocol):
    """Results of many polygons in common arrays."""

    def read(self, k: int) -> dict[str, Any]:
        """The attributes of polygon k's :class:`Interpolation`."""


@dataclass(frozen=True, eq=False)
class Interpolation:
    """What an interpolation came to; not converging is a result, not an error.

    Attributes:
        spline: the curve.
        parameters: (n,) footpoint of each vertex, unwrapped: those of p_0 may be negative.
        intervals: (n, 2) the interval each footpoint was sought in.
        iterations: number of updates made (of sweeps before the one that passed, in Algorithm 3).
        residuals: (iterations + 1,) largest distance of a vertex from its footpoint before each update;
            the last entry is that of the result.
        converged: whether the last residual is below the residual tolerance.
        fallbacks: number of vertices for which Lemma 2 has no interval (Remark 3).
        rate_bound: certified factor a step of the largest error (Theorem 2); 1 or more certifies nothing.
        merged: indices of the given vertices that were dropped as duplicates of the one before.
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
    history: tuple[tuple[FloatArray, FloatArray], ...] | None = None
    rate_observed: float | None = None
    spectral_radii: FloatArray | None = None

    @classmethod
    def trusted(cls, attributes: dict[str, Any]) -> Interpolation:
        """The same, built in a third of the time: it matters beside a contour of 20 vertices."""
        result = cls.__new__(cls)
        result.__dict__.update(attributes)
        return result

    @classmethod
    def shared(cls, source: Shared, k: int) -> Interpolation:
        """The result of polygon k, read from ``source`` when an attribute is first asked for: most never are."""
        result = cls.__new__(cls)
        object.__setattr__(result, "_source", source)  # without touching __dict__, which would make one
        object.__setattr__(result, "_row", k)
        return result

    @classmethod
    def all_shared(cls, source: Shared, count: int) -> list[Interpolation]:
        """The results of polygons 0 to ``count - 1``, as :meth:`shared` makes them one by one."""
        results, place = [cls.__new__(cls) for _ in range(count)], object.__setattr__
        for k, result in enumerate(results):
            place(result, "_source", source)
            place(result, "_row", k)
        return results

    def __getstate__(self) -> dict[str, Any]:
        source = self.__dict__.get("_source")
        if source is not None:
            self.__dict__.update(source.read(self.__dict__["_row"]), _source=None)
        return {name: value for name, value in self.__dict__.items() if name not in ("_source", "_row")}

    if not TYPE_CHECKING:  # a checker should go by the attributes listed above

        def __getattr__(self, name: str) -> Any:
            try:
                return self.__getstate__()[name]
            except KeyError:
                raise AttributeError(f"'Interpolation' object has no attribute {name!r}") from None

    @property
    def max_error(self) -> float:
        """The largest distance of a vertex from its footpoint on the result."""
        return float(self.residuals[-1])
