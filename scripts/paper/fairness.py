"""Measures of fairness of a curve through a polygon, for the method and for SciPy's periodic cubics."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import make_interp_spline
from scipy.spatial import ConvexHull

import glyphspline as gs
from glyphspline.curves.bezier import cross, evaluate
from glyphspline.curves.fairness import curvature_variation
from glyphspline.curves.integrals import shape
from glyphspline.interpolation.method import Parametrisation
from glyphspline.interpolation.polygon import vertex_parameters
from glyphspline.types import FloatArray

METHODS = ("variant 1", "variant 2", "variant 3", "SciPy chord", "SciPy centripetal", "SciPy uniform")
MEASURES = ("∫κ² ds", "∫(dκ/ds)² ds", "max |κ|", "bulge", "overshoot", "self-crossings")
Quality = dict[str, float]

PER_PIECE = 16
"""Points of a piece for distances and crossings."""


def scipy_pieces(polygon: FloatArray, knots: Parametrisation) -> FloatArray:
    """(n, 4, 2) Bézier pieces of SciPy's periodic interpolating cubic, from its values and slopes at the knots."""
    u = vertex_parameters(polygon, knots)
    curve = make_interp_spline(u, np.concatenate([polygon, polygon[:1]]), k=3, bc_type="periodic")
    value, slope, h = curve(u), curve(u, 1), np.diff(u)[:, None]
    return np.stack([value[:-1], value[:-1] + h / 3 * slope[:-1], value[1:] - h / 3 * slope[1:], value[1:]], axis=1)


def curves_of(polygon: FloatArray, tolerance: float) -> dict[str, tuple[FloatArray, FloatArray]]:
    """For each method its Bézier pieces, and the parameters of the vertices counted in pieces."""
    places = np.arange(len(polygon), dtype=np.float64)
    curves: dict[str, tuple[FloatArray, FloatArray]] = {}
    for v in (1, 2, 3):
        r = gs.interpolate(polygon, v, residual_tolerance=tolerance)
        curves[f"variant {v}"] = r.spline.to_bezier(), _places(r.spline, r.parameters)
    ways: tuple[Parametrisation, ...] = ("chord", "centripetal", "uniform")
    for knots in ways:
        curves[f"SciPy {knots}"] = scipy_pieces(polygon, knots), places
    return curves


def _places(spline: gs.Spline, t: FloatArray) -> FloatArray:
    """Parameters as piece number plus fraction of the piece; those before 0 stay negative."""
    n, T = len(spline.knots) - 1, spline.period
    lap = np.floor(t / T)
    return np.asarray(lap * n + np.interp(t - lap * T, spline.knots, np.arange(n + 1)))


def _span_points(pieces: FloatArray, places: FloatArray) -> FloatArray:
    """(n, PER_PIECE + 1, 2) points of the curve between the places of neighbouring vertices."""
    n = len(pieces)
    after = np.append(places[1:], places[0] + n)
    at = places[:, None] + (after - places)[:, None] * np.linspace(0, 1, PER_PIECE + 1)
    piece = np.floor(at).astype(np.int64)
    return evaluate(pieces[(piece % n).ravel()], (at - piece).ravel()).reshape(n, -1, 2)


def bulge(pieces: FloatArray, places: FloatArray, polygon: FloatArray) -> float:
    """Largest distance of the curve between two neighbouring vertices from the chord that joins them."""
    points = _span_points(pieces, places)
    a = polygon[:, None]
    chord = np.roll(polygon, -1, axis=0)[:, None] - a
    along = np.clip(((points - a) * chord).sum(axis=2) / (chord**2).sum(axis=2), 0, 1)
    gap = points - a - along[..., None] * chord
    return float(np.hypot(gap[..., 0], gap[..., 1]).max())


def result_bulge(result: gs.Interpolation, polygon: FloatArray) -> float:
    """:func:`bulge` of an interpolation."""
    return bulge(result.spline.to_bezier(), _places(result.spline, result.parameters), polygon)


def result_quality(result: gs.Interpolation, polygon: FloatArray) -> Quality:
    """:func:`quality` of an interpolation."""
    return quality(result.spline.to_bezier(), _places(result.spline, result.parameters), polygon)


def overshoot(points: FloatArray, polygon: FloatArray) -> float:
    """How far the curve leaves the polygon's convex hull."""
    planes = ConvexHull(polygon).equations
    return float(max((points @ planes[:, :2].T + planes[:, 2]).max(), 0.0))


def self_crossings(line: FloatArray) -> int:
    """Pairs of edges of a closed polyline that cross each other."""
    a, b = line, np.roll(line, -1, axis=0)
    low, high = np.minimum(a, b), np.maximum(a, b)
    count = 0
    for i in range(len(line) - 2):
        near = np.arange(i + 2, len(line) - (i == 0))
        near = near[((low[near] <= high[i]) & (high[near] >= low[i])).all(axis=1)]
        edge = b[i] - a[i]
        sides = cross(edge, a[near] - a[i]) * cross(edge, b[near] - a[i])
        other = b[near] - a[near]
        count += int(((sides < 0) & (cross(other, a[i] - a[near]) * cross(other, b[i] - a[near]) < 0)).sum())
    return count


def quality(pieces: FloatArray, places: FloatArray, polygon: FloatArray) -> Quality:
    """All measures of one curve."""
    line = _span_points(pieces, places)[:, :-1].reshape(-1, 2)
    measured = shape(pieces)
    return {
        "∫κ² ds": measured.bending_energy,
        "∫(dκ/ds)² ds": curvature_variation(pieces),
        "max |κ|": measured.max_curvature,
        "bulge": bulge(pieces, places, polygon),
        "overshoot": overshoot(line, polygon),
        "self-crossings": float(self_crossings(line)),
    }


def all_qualities(polygon: FloatArray, tolerance: float) -> dict[str, Quality]:
    """All measures for all methods."""
    return {m: quality(*curve, polygon) for m, curve in curves_of(polygon, tolerance).items()}


def relative_to(values: dict[str, Quality], reference: str) -> dict[str, Quality]:
    """Each measure divided by that of the reference; measures that are 0 there are left out."""
    base = values[reference]
    return {m: {k: q[k] / base[k] for k in q if base[k] > 0} for m, q in values.items()}
