"""Results as JSON for the page: path data and lists of points, y down, with two decimals."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np

from ..fitting.convert_masters import MastersResult
from ..fitting.results import GlyphResult
from ..interpolation.result import Interpolation
from ..outlines.masters import MasterContour
from ..outlines.outline import Contour, Outline
from ..types import FloatArray, rounded_up
from ..writers.svg.markup import code_points
from ..writers.svg.path_data import path_data, polyline_data
from .conversion import is_smooth, shown_steps, updates_of

DIGITS = 2

MASTER_DIGITS = 4
"""Decimals of masters: with fewer, combs of short segments are uneven."""

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


def masters_payload(result: MastersResult) -> dict[str, Any]:
    """A glyph in all masters, source and result, and what the page needs to mix them at any location."""
    masters = result.masters
    return {
        "glyph": masters.name,
        "gid": masters.gid,
        "unicodes": code_points(result.mixed(np.eye(len(masters))[0])),
        "axes": [
            {"tag": a.tag, "minimum": a.minimum, "default": a.default, "maximum": a.maximum, "mapping": a.mapping}
            for a in masters.axes
        ],
        "regions": masters.regions.tolist(),
        "inverse": np.linalg.inv(masters.scalars(masters.peaks)).tolist(),
        "source": [master_contour(contour) for contour in masters.contours],
        "result": [master_contour(contour.curve) for contour in result.contours],
        "bound": rounded_up(max((contour.deviation_bound for contour in result.contours), default=0.0), 3),
        "notes": list(result.notes),
    }


def master_contour(contour: MasterContour) -> dict[str, Any]:
    """Degrees of its segments, and its points in each master, x and y in turn, y down."""
    points = np.round(contour.points * (1, -1), MASTER_DIGITS) + 0.0
    return {"degrees": contour.degrees.tolist(), "points": points.reshape(len(points), -1).tolist()}


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
