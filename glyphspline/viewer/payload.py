"""Results as JSON for the page: path data and lists of points, y down, with two decimals."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np

from ..fitting.results import GlyphResult
from ..interpolation.result import Interpolation
from ..outlines.outline import Contour, Outline
from ..types import FloatArray
from ..writers.svg.markup import code_points
from ..writers.svg.path_data import path_data, polyline_data
from .conversion import is_smooth, shown_steps, updates_of

DIGITS = 2

ARC = 7
"""Points of the polyline that shows the interval of a footpoint."""


def glyph_payload(outline: Outline) -> dict[str, Any]:
    """The source outline and the facts of the glyph."""
    return {
        "glyph": outline.name,
        "gid": outline.gid,
        "unicodes": code_points(outline),
        "advance": outline.advance,
        "source": path_data(outline.contours, DIGITS),
    }


def result_payload(result: GlyphResult) -> dict[str, Any]:
    """The result: its path, polygons, control polygons, footpoints and measures."""
    arcs = [arc for contour in result.contours for arc in contour.interpolations]
    return {
        "variant": result.options.variant,
        "result": path_data((contour.curve for contour in result.contours), DIGITS),
        "polygons": [points(contour.polygon) for contour in result.contours],
        "movable": [is_smooth(contour) for contour in result.contours],
        "notes": list(result.notes),
        "steps": len(shown_steps(updates_of(result))),
        "residuals": [[finite(error) for error in arc.residuals.tolist()] for arc in arcs],
        "intervals": "".join(interval_data(arc) for arc in arcs),
        "measures": [{k: finite(v) for k, v in asdict(contour.measures).items()} for contour in result.contours],
        **curves_payload(arcs),
    }


def curves_payload(arcs: list[Interpolation]) -> dict[str, Any]:
    """Control polygons and footpoints of curves."""
    return {
        "control": "".join(polyline_data(arc.spline.control_points, DIGITS, closed=arc.spline.closed) for arc in arcs),
        "controls": [point for arc in arcs for point in points(arc.spline.control_points)],
        "feet": [point for arc in arcs for point in points(arc.spline(arc.parameters))],
    }


def step_payload(updates: int, curves: list[Interpolation]) -> dict[str, Any]:
    """The curves after a number of updates."""
    shapes = [Contour.from_segments(curve.spline.to_bezier()) for curve in curves]
    error = max((curve.max_error for curve in curves), default=0.0)
    return {"step": updates, "error": error, "result": path_data(shapes, DIGITS), **curves_payload(curves)}


def interval_data(arc: Interpolation) -> str:
    """The parts of the curve searched for footpoints, as path data, without those of a single point."""
    wide = arc.intervals[:, 1] > arc.intervals[:, 0]
    a, b = arc.intervals[wide].T
    t = a[:, None] + (b - a)[:, None] * np.linspace(0, 1, ARC)
    return "".join(polyline_data(part, DIGITS) for part in arc.spline(t))


def points(array: FloatArray) -> list[list[float]]:
    """(n, 2) as pairs, y down."""
    return (np.round(array * (1, -1), DIGITS) + 0.0).tolist()


def finite(value: Any) -> Any:
    """The value, or None for a float that JSON cannot express."""
    return None if isinstance(value, float) and not np.isfinite(value) else value
