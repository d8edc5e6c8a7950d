"""Results as JSON for the page: path data and lists of points, y down, with two decimals."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from functools import lru_cache
from typing import Any

import numpy as np

from ..fitting.convert_masters import MastersResult
from ..fitting.results import GlyphResult
from ..interpolation.result import Interpolation
from ..outlines.joins import joins
from ..outlines.masters import MasterContour
from ..outlines.outline import Contour, Outline
from ..types import BoolArray, FloatArray, rounded_up
from ..writers.svg.markup import code_points
from ..writers.svg.path_data import path_data, polyline_data
from .conversion import is_smooth, shown_steps, updates_of

DIGITS = 2

INSTANCE_DIGITS = 4
"""Decimals of instances: with fewer, combs of short segments are uneven."""

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


def instance_payload(result: MastersResult, location: Mapping[str, float]) -> dict[str, Any]:
    """A glyph converted in all masters, as it is at a location: source and result."""
    masters, curves = result.masters, [contour.curve for contour in result.contours]
    weights = masters.weights(location)
    every = np.concatenate([np.zeros((0, 2)), *(contour.points.reshape(-1, 2) for contour in masters.contours)])
    return {
        "glyph": masters.name,
        "gid": masters.gid,
        "unicodes": code_points(result.mixed(weights)),
        "masters": len(masters),
        "corners": points(np.array([every.min(axis=0), every.max(axis=0)])) if len(every) else [],
        "source": side_payload(masters.contours, weights),
        "result": side_payload(curves, weights),
        "bound": rounded_up(max((contour.deviation_bound for contour in result.contours), default=0.0), 3),
        "notes": list(result.notes),
    }


def side_payload(contours: Sequence[MasterContour], weights: FloatArray) -> dict[str, Any]:
    """The path of contours with weights of the masters, and where the joint turns most that is smooth in every master.

    The turn is in degrees; None without such a joint.
    """
    drawn = [contour.mixed(weights) for contour in contours]
    found = [joins(contour) for contour in drawn]
    turned = np.degrees(np.abs(np.concatenate([np.zeros(0), *(each.turns for each in found)])))
    turned[~np.concatenate([np.zeros(0, np.bool_), *map(smooth_joints, contours)])] = -1.0
    side: dict[str, Any] = {
        "path": path_data(drawn, INSTANCE_DIGITS),
        "segments": sum(map(len, contours)),
        "turn": None,
    }
    if turned.max(initial=-1.0) >= 0.0:
        worst = int(turned.argmax())
        place = np.concatenate([each.points for each in found])[worst : worst + 1]
        side |= {"turn": float(turned[worst]), "point": points(place)[0]}
    return side


@lru_cache(maxsize=256)
def smooth_joints(contour: MasterContour) -> BoolArray:
    """(m,) which joints are smooth in every master."""
    masters = [Contour(each, contour.degrees) for each in contour.points]
    corners = np.array([joins(master).of("corner", 0.0) for master in masters])
    return np.asarray(~corners.any(axis=0), dtype=np.bool_)


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
