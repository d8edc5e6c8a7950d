"""Measures of curves through polygons, and the rows of tables. Lengths are in 1/1000 em, curvature is in 1/em."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import accumulate
from typing import Any

import numpy as np

from ...curves.bezier import cross, derivative_points, evaluate
from ...curves.integrals import NODES, WEIGHTS
from ...fitting.measures import geometry
from ...fitting.results import PER_EM, Quantity
from ...outlines.contour_arrays import cubic_contours
from ...report.data import plain
from ...types import FloatArray
from .methods import MethodCurve

PER_PIECE = 16
"""Points of a piece for distances."""

PARTS = 4
"""Parts of a piece for the integral of the variation, so that its nodes meet sharp turns."""

WILD = 1e3
"""Coordinates in em beyond which a curve that did not converge is not measured."""

THOUSANDTH = "1/1000 em"

QUANTITIES = {
    "vertices": Quantity("vertices", "", "of the polygon"),
    "iterations": Quantity("iterations", "", "updates of the control points"),
    "converged": Quantity("converged", "", "whether the residual is below the tolerance"),
    "residual": Quantity("residual", THOUSANDTH, "largest distance left between a vertex and its footpoint"),
    "rate_bound": Quantity("rate bound", "", "certified factor of the largest error (Theorem 2); none from 1 on"),
    "rate_observed": Quantity("rate observed", "", "mean factor of the largest error over the last steps"),
    "fallbacks": Quantity("without interval", "", "vertices for which Lemma 2 has no interval"),
    "bulge": Quantity("bulge", THOUSANDTH, "how far a span overshoots: its largest distance from its chord"),
    "overshoot": Quantity("overshoot", THOUSANDTH, "largest distance outside the convex hull of the polygon"),
    "max_curvature": Quantity("largest |κ|", PER_EM, "of the sharpest bend"),
    "bending_energy": Quantity("∫κ² ds", PER_EM, "less is rounder"),
    "curvature_variation": Quantity("∫(dκ/ds)² ds", "1/em³", "less is fairer; without measure at a near-cusp"),
    "curvature_extrema": Quantity("extrema of κ", "", "significant ones, along the contour; an ellipse has 4"),
    "length": Quantity("length", "em", "arc length"),
}  # fmt: skip
"""What a row has of a curve."""


def rows_of(
    polygons: Sequence[FloatArray], curves: Sequence[Mapping[str, MethodCurve]], em: float
) -> list[dict[str, Any]]:
    """A row for each contour and method; null is not computed, or not finite.

    Args:
        polygons: (n, 2) of each contour. curves: of each contour by method. em: units of both.
    """
    pairs = [(k, method, curve) for k, own in enumerate(curves) for method, curve in own.items()]
    shapes = iter(_shapes([(curve, polygons[k]) for k, _, curve in pairs if is_tame(curve.pieces, em)], em))
    rows = []
    for k, method, curve in pairs:
        shape = next(shapes) if is_tame(curve.pieces, em) else {}
        known = {"vertices": len(polygons[k]), **_steps(curve, em), **shape}
        rows.append({"contour": k, "method": method, **{name: plain(known.get(name)) for name in QUANTITIES}})
    return rows


def is_tame(pieces: FloatArray, em: float) -> bool:
    """Whether a curve is finite, and not far away, as those of variant 0 may be: it is measured and drawn."""
    return bool(np.abs(pieces).max() < WILD * em)


def _steps(curve: MethodCurve, em: float) -> dict[str, Any]:
    """What there is to say of an iteration."""
    if curve.residuals is None:
        return {}
    return {
        "iterations": len(curve.residuals) - 1, "converged": curve.converged,
        "residual": 1000 * float(curve.residuals[-1]) / em, "rate_bound": curve.rate_bound,
        "rate_observed": curve.rate_observed, "fallbacks": curve.fallbacks,
    }  # fmt: skip


def _shapes(measured: Sequence[tuple[MethodCurve, FloatArray]], em: float) -> list[dict[str, Any]]:
    """Measures of curves, each beside its polygon."""
    if not measured:
        return []
    pieces, polygons = [curve.pieces for curve, _ in measured], [polygon for _, polygon in measured]
    joints, ends = (np.array([0, *accumulate(map(len, parts))]) for parts in (pieces, polygons))
    arrays = cubic_contours(np.concatenate(pieces), joints)
    found = geometry(arrays, arrays, arrays, np.concatenate(polygons), ends)
    return [
        {
            "bulge": 1000 * bulge(curve.pieces, curve.places, polygon) / em,
            "overshoot": 1000 * float(found.overshoot[c]) / em,
            "max_curvature": float(found.max_curvature[c]) * em,
            "bending_energy": float(found.bending_energy[c]) * em,
            "curvature_variation": curvature_variation(curve.pieces) * em**3,
            "curvature_extrema": int(found.curvature_extrema[c]),
            "length": float(found.length[c]) / em,
        }
        for c, (curve, polygon) in enumerate(measured)
    ]


def span_points(pieces: FloatArray, places: FloatArray) -> FloatArray:
    """(n, PER_PIECE + 1, 2) points of the curve between the places of neighbouring vertices."""
    n = len(pieces)
    after = np.append(places[1:], places[0] + n)
    at = places[:, None] + (after - places)[:, None] * np.linspace(0, 1, PER_PIECE + 1)
    piece = np.floor(at).astype(np.int64)
    return evaluate(pieces[(piece % n).ravel()], (at - piece).ravel()).reshape(n, -1, 2)


def bulge(pieces: FloatArray, places: FloatArray, polygon: FloatArray) -> float:
    """Largest distance of the curve between two neighbouring vertices from the chord that joins them."""
    points = span_points(pieces, places)
    a = polygon[:, None]
    chord = np.roll(polygon, -1, axis=0)[:, None] - a
    along = np.clip(((points - a) * chord).sum(axis=2) / (chord**2).sum(axis=2), 0, 1)
    gap = points - a - along[..., None] * chord
    return float(np.hypot(gap[..., 0], gap[..., 1]).max())


def curvature_variation(cubics: FloatArray) -> float:
    """∫(dκ/ds)² ds in 1/unit³ along cubics (m, 4, 2), without the jumps of curvature between them; large at a cusp."""
    t = (np.arange(PARTS)[:, None] + (NODES + 1) / 2).ravel() / PARTS
    a, b, c = np.moveaxis(derivative_points(cubics), 1, 0)[:, :, None]  # of the velocity
    b, c = 2 * (b - a), c - 2 * b + a
    x = t[:, None]
    velocity, acceleration = a + x * (b + x * c), b + 2 * x * c
    bend, squared = cross(velocity, acceleration), (velocity**2).sum(axis=2)
    straight = np.abs(bend) <= 1e-12 * squared
    squared = np.where(straight, 1.0, squared)
    slope = cross(velocity, 2 * c + 0 * x) * squared - 3 * bend * (velocity * acceleration).sum(axis=2)
    with np.errstate(divide="ignore"):
        own = np.where(straight, 0.0, slope**2 / squared**5.5)
    return float((own * np.tile(WEIGHTS, PARTS)).sum() / (2 * PARTS))


def farthest_apart(curves: Sequence[Mapping[str, MethodCurve]], methods: Sequence[str]) -> tuple[float, FloatArray]:
    """The largest distance of a span of one method's curve from that of another, and where; by points of the spans."""
    most, where = -1.0, np.zeros(2)
    for own in curves:
        spans = [span_points(own[m].pieces, own[m].places) for m in methods if own[m].converged]
        for k, a in enumerate(spans):
            for b in spans[:k]:
                gap = np.linalg.norm(a[:, :, None] - b[:, None], axis=3).min(axis=2)
                if gap.max() > most:
                    span, point = divmod(int(gap.argmax()), gap.shape[1])
                    most, where = float(gap.max()), a[span, point]
    return most, where
