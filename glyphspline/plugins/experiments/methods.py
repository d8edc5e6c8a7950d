"""Closed curves through one polygon: the variants of the paper, and what others put through the same points."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...curves.bspline import Spline
from ...interpolation.api import interpolate
from ...interpolation.method import Parametrisation
from ...interpolation.polygon import vertex_parameters
from ...interpolation.result import Interpolation
from ...outlines.outline import Outline
from ...types import FloatArray
from . import VARIANTS

MAX_ITERATIONS, CUT = 1000, 100
"""Steps at most; of variant 0, which may wander for ever, as many as are followed."""

TAIL = 30
"""Last steps over which the mean factor of a run is taken."""


@dataclass(frozen=True, eq=False)
class MethodCurve:
    """A closed curve through the n vertices of a polygon.

    Attributes:
        pieces: (m, 4, 2) its Bézier pieces. places: (n,) parameters of the vertices, counted in pieces.
        seconds: that it took. residuals: the largest error before each step, of iterations.
        converged, rate_bound, fallbacks: as :class:`.Interpolation` has them.
        radii: spectral radius of the composite matrix after each step, if asked for.
    """

    pieces: FloatArray
    places: FloatArray
    seconds: float
    residuals: FloatArray | None = None
    converged: bool | None = None
    rate_bound: float | None = None
    fallbacks: int | None = None
    radii: FloatArray | None = None

    @property
    def rate_observed(self) -> float | None:
        """Mean factor of the error over the last steps."""
        if self.residuals is None or not (steps := min(TAIL, (len(self.residuals) - 1) // 2)):
            return None
        with np.errstate(all="ignore"):
            return float((self.residuals[-1] / self.residuals[-1 - steps]) ** (1 / steps))


@dataclass(frozen=True, eq=False, repr=False)
class Interpolated:
    """The fields of :class:`.api.Experiment`."""

    outline: Outline
    polygons: tuple[FloatArray, ...]
    curves: tuple[Mapping[str, MethodCurve], ...]
    tolerance: float

    @property
    def em(self) -> float:
        """Font units of an em."""
        return self.outline.metrics.units_per_em


def curve_through(polygon: FloatArray, method: str, tolerance: float, radii: bool = False) -> MethodCurve:
    """The curve of a method, one of ``VARIANTS`` or ``PEERS``.

    Args:
        polygon: (n, 2), consecutive vertices distinct. tolerance: below which an iteration ends, in its units.
        radii: whether the composite matrices of a variant are followed, which takes seconds.
    """
    places = np.arange(len(polygon), dtype=np.float64)
    started = time.perf_counter()
    if method in VARIANTS:
        v = VARIANTS.index(method)
        found = interpolate(polygon, v, residual_tolerance=tolerance, max_iterations=CUT if v == 0 else MAX_ITERATIONS)
        seconds = time.perf_counter() - started
        return MethodCurve(
            found.spline.to_bezier(), places_of(found.spline, found.parameters), seconds, found.residuals,
            found.converged, found.rate_bound, found.fallbacks,
            composite_radii(polygon, v, tolerance) if radii else None,
        )  # fmt: skip
    if method == "PIA":
        spline, residuals = iterated(polygon, tolerance)
        seconds = time.perf_counter() - started
        return MethodCurve(spline.to_bezier(), places, seconds, residuals, bool(residuals[-1] < tolerance))
    if method == "splprep":
        pieces = splprep_pieces(polygon)
    else:
        pieces = scipy_pieces(polygon, "centripetal" if method == "centripetal" else "chord")
    return MethodCurve(pieces, places, time.perf_counter() - started)


def places_of(spline: Spline, t: FloatArray) -> FloatArray:
    """Parameters of a closed spline as piece number plus fraction of the piece; those before 0 stay negative."""
    n, T = len(spline.knots) - 1, spline.period
    lap = np.floor(t / T)
    return np.asarray(lap * n + np.interp(t - lap * T, spline.knots, np.arange(n + 1)))


def iterated(polygon: FloatArray, tolerance: float) -> tuple[Spline, FloatArray]:
    """PIA: every control point moves by its vertex's error at its own knot, all at once. The spline and its errors."""
    u, P, residuals = vertex_parameters(polygon), polygon.copy(), list[float]()
    columns, values = Spline(P, u).basis_rows(u[:-1])
    while True:
        error = polygon - (values[..., None] * P[columns]).sum(axis=1)
        residuals.append(float(np.hypot(*error.T).max()))
        if residuals[-1] < tolerance or len(residuals) > MAX_ITERATIONS:
            return Spline(P, u), np.array(residuals)
        P = P + error


def scipy_pieces(polygon: FloatArray, knots: Parametrisation) -> FloatArray:
    """(n, 4, 2) Bézier pieces of SciPy's periodic interpolating cubic."""
    from scipy.interpolate import make_interp_spline

    u = vertex_parameters(polygon, knots)
    curve = make_interp_spline(u, _closed(polygon), k=3, bc_type="periodic")
    return _by_slopes(u, curve(u), curve(u, 1))


def splprep_pieces(polygon: FloatArray) -> FloatArray:
    """(n, 4, 2) Bézier pieces of FITPACK's periodic cubic through all points."""
    from scipy.interpolate import splev, splprep

    u = vertex_parameters(polygon)
    curve, _ = splprep(_closed(polygon).T, u=u, s=0, per=1, k=3)
    values: Any = splev(u, curve), splev(u, curve, der=1)
    return _by_slopes(u, *(np.stack(each, axis=1) for each in values))


def _closed(polygon: FloatArray) -> FloatArray:
    return np.concatenate([polygon, polygon[:1]])


def _by_slopes(u: FloatArray, value: FloatArray, slope: FloatArray) -> FloatArray:
    """(n, 4, 2) Bézier pieces from values and slopes (n + 1, 2) at the knots."""
    h = np.diff(u)[:, None]
    return np.stack([value[:-1], value[:-1] + h / 3 * slope[:-1], value[1:] - h / 3 * slope[1:], value[1:]], axis=1)


def composite_radii(polygon: FloatArray, variant: int, tolerance: float) -> FloatArray:
    """(iterations,) spectral radius of the composite matrix, the product of all I - B so far, after each step (Fig. 5).

    Variant 3 never moves its footpoints: the matrix is a power there.
    """
    how: Any = {"residual_tolerance": tolerance, "max_iterations": CUT if variant == 0 else MAX_ITERATIONS}
    found: Interpolation = interpolate(polygon, variant, diagnostics=variant != 3, **how)
    if found.spectral_radii is not None:
        return found.spectral_radii
    factor = np.eye(len(polygon)) - found.spline.basis(found.parameters)
    return np.asarray(float(np.abs(np.linalg.eigvals(factor)).max()) ** np.arange(1, found.iterations + 1))
