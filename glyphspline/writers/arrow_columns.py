"""Results of contours as Arrow columns, made from flat arrays: values end to end, and where each list begins."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np

from ..extras import need
from ..fitting.results import BOUNDS, ConvertedContours, Measures
from ..outlines.contour_arrays import offsets_of
from ..types import FloatArray, IntArray

POWERS = {
    "residual": 1, "deviation": 1, "deviation_bound": 1, "overshoot": 1, "length": 1, "area_change": 2,
    "bending_energy": -1, "max_curvature": -1,
}  # fmt: skip
"""Of the unit of length, in the measures that have one."""


def arrow() -> Any:
    """The module pyarrow.

    Raises:
        GlyphsplineError: it is not installed.
    """
    return need("parquet")


def source_types() -> dict[str, Any]:
    """Arrow types of the columns of the source contours."""
    pa = arrow()
    return {"source_degrees": pa.list_(pa.uint8()), "source_points": pa.list_(pa.list_(pa.float64(), 2))}


def fit_types() -> dict[str, Any]:
    """Arrow types of the columns of the fit."""
    pa = arrow()
    point, numbers = pa.list_(pa.float64(), 2), pa.list_(pa.float64())
    return {
        "polygon": pa.list_(point),
        "closed": pa.list_(pa.bool_()),
        "degree": pa.list_(pa.uint8()),
        "knots": pa.list_(numbers),
        "control_points": pa.list_(pa.list_(point)),
        "footpoints": pa.list_(numbers),
        "bezier_degrees": pa.list_(pa.uint8()),
        "bezier_points": pa.list_(point),
    }


def measure_types() -> dict[str, Any]:
    """Arrow types of the columns of the measures."""
    pa = arrow()
    types = {"int": pa.int64(), "float": pa.float64(), "bool": pa.bool_()}
    return {field.name: types[str(field.type).split(" | ")[0]] for field in fields(Measures)}


def nested(values: Any, *offsets: IntArray) -> Any:
    """Lists of an Arrow array, or lists of lists: the innermost offsets come first."""
    pa = arrow()
    for own in offsets:
        values = pa.ListArray.from_arrays(pa.array(own.astype(np.int32)), values)
    return values


def pairs(points: FloatArray) -> Any:
    """Points (N, 2) as an Arrow array of N lists of two."""
    pa = arrow()
    return pa.FixedSizeListArray.from_arrays(pa.array(points.ravel()), 2)


def source_columns(found: ConvertedContours, factors: FloatArray) -> dict[str, Any]:
    """The columns of :func:`source_types` for C contours; coordinates are multiplied by (C,) ``factors``."""
    pa, source = arrow(), found.source
    points = source.points * np.repeat(factors, np.diff(source.starts))[:, None]
    return {
        "source_degrees": nested(pa.array(source.degrees.astype(np.uint8)), source.offsets),
        "source_points": nested(pairs(points), source.starts),
    }


def fit_columns(found: ConvertedContours, factors: FloatArray) -> dict[str, Any]:
    """The columns of :func:`fit_types` for C contours; lengths, knots too, are multiplied by (C,) ``factors``."""
    pa, curves, polygons, controls = arrow(), found.curves, found.polygons, found.controls
    each = np.repeat(factors, np.diff(found.arc_offsets))
    splines = [arc.spline for arc in found.arcs]
    knots, at_knots = _numbers([spline.knots for spline in splines], each)
    feet, at_feet = _numbers([arc.parameters for arc in found.arcs], each)
    vertices = polygons.points * np.repeat(factors, np.diff(polygons.offsets))[:, None]
    beziers = curves.points * np.repeat(factors, np.diff(curves.starts))[:, None]
    rows = controls.points * np.repeat(each, np.diff(controls.offsets))[:, None]
    arcs = found.arc_offsets
    return {
        "polygon": nested(pairs(vertices), polygons.offsets),
        "closed": nested(pa.array(controls.closed), arcs),
        "degree": nested(pa.array([spline.degree for spline in splines], pa.uint8()), arcs),
        "knots": nested(knots, at_knots, arcs),
        "control_points": nested(pairs(rows), controls.offsets, arcs),
        "footpoints": nested(feet, at_feet, arcs),
        "bezier_degrees": nested(pa.array(curves.degrees.astype(np.uint8)), curves.offsets),
        "bezier_points": nested(pairs(beziers), curves.starts),
    }


def _numbers(parts: list[FloatArray], factors: FloatArray) -> tuple[Any, IntArray]:
    """Numbers of some arcs end to end, multiplied, and where each arc begins."""
    offsets = offsets_of([len(part) for part in parts])
    return arrow().array(np.concatenate([np.empty(0), *parts]) * np.repeat(factors, np.diff(offsets))), offsets


def measure_columns(found: ConvertedContours, factors: FloatArray) -> dict[str, Any]:
    """The measures of C contours, null where not computed, with lengths multiplied by (C,) ``factors``."""
    pa, columns = arrow(), {}
    scaled = bool((factors != 1.0).any())
    for name, kind in measure_types().items():
        values = found.measures.get(name)
        if values is None:
            columns[name] = pa.nulls(len(found), kind)
        elif scaled and name in POWERS:
            known = np.array([np.nan if value is None else value for value in values], dtype=np.float64)
            known = known * factors ** POWERS[name]
            if name in BOUNDS:
                known = np.nextafter(known, np.inf)  # the product may be rounded down
            columns[name] = pa.array(known, mask=np.array([value is None for value in values], dtype=np.bool_))
        else:
            columns[name] = pa.array(values, kind)
    return columns
