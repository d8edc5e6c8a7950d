"""Glyphs and texts as DXF, the exchange format of CAD programs: splines as splines, by ezdxf (extra ``cad``).

What is written, so that all programs read the same curve:

- A contour is one SPLINE entity, a cubic, lines and corners included (:attr:`..fitting.results.ContourResult.spline`),
  with the knot of its seam inserted until it is clamped (:meth:`..curves.bspline.Spline.clamped`), first and last
  control point equal, flags (group code 70) planar only. The closed and the periodic flag are left away: with either of
  them one program or another wraps the control points once more, replaces the knots, or reads no curve.
  docs/formats.md says which. Knots have the scale of the drawing.
- "arcs": each straight line is a LINE, and what is between corners and lines a SPLINE. The entities of a
  contour follow each other, end in the same coordinates, and are a GROUP.
- An open path is one open SPLINE, clamped at its ends, in the layer of outlines.
- Spurs are left out, which solid modellers refuse: lines that run back over the line before them.
- Coordinates are doubles in full, not rounded to ``precision``.
- No text of the font is in the file, nor a date: the same result has the same bytes.
"""

from __future__ import annotations

import threading
from collections.abc import Sequence
from dataclasses import replace
from io import StringIO
from itertools import pairwise
from typing import Any

import numpy as np

from ...curves.bspline import Spline
from ...errors import require
from ...extras import need
from ...fitting.results import GlyphResult
from ...outlines.open_paths import are_open, paths
from ...outlines.outline import Contour, Contours
from ...outlines.polygons import flattened, polygons_of
from ...types import INCHES, BoolArray, FloatArray
from ...writers.settings import NO_HANDLE, SMOOTH, Appearance, DxfKind, Settings

UNITS = {None: 0, "in": 1, "mm": 4, "cm": 5}
"""Values of $INSUNITS. Other units of lengths are written as millimetres."""

OUTLINES, HOLES = LAYERS = ("outlines", "holes")
COLOURS = (7, 1)
"""Of the layers, as AutoCAD numbers them: black on white and white on black; red."""

PLANAR = 8
"""The flag of a SPLINE in a plane."""

STRAIGHT = 1e-9
"""Largest sine of the angle between two lines that run over each other."""

_metadata = threading.Lock()


Piece = tuple[FloatArray, FloatArray]
"""An entity to be, in font units: control points (n, 2) and knots (n + 4,) of a clamped SPLINE; or the points of a LINE
or an LWPOLYLINE, and no knots."""


def to_dxf(
    result: GlyphResult, *, size: str | None = None, dxf: DxfKind = "spline", flatness: float | None = None
) -> str:
    """A glyph, or a text, as a DXF drawing (R2000), y up; open paths stay open.

    Contours are in the layers "outlines" and "holes"; a hole is a contour about which there is ink. The origin of the
    glyph is that of the drawing.

    Args:
        result: of :func:`convert`.
        size: height from descender to ascender with its unit, as in "20mm", "2cm" or "1in"; DXF has no pt, pc and px:
            these become millimetres. None: a unit of the drawing is a font unit, and the drawing has no unit of length.
        dxf: "spline" writes a contour as one SPLINE, with triple knots at corners; "arcs" as one from corner to corner
            each, and straight lines as LINEs. Both are the curves as they are: within ``deviation_bound`` of the
            source, and the rounding to ``precision`` that this bound counts and the file does not have, at most 0.71 of
            the last decimal.
            "polyline" writes closed LWPOLYLINEs, within ``flatness`` of these curves.
        flatness: in font units; None is 1/2000 em.

    Raises:
        GlyphsplineError: ezdxf, of the extra ``cad``, is not installed.
        OptionError: a size, a kind or a flatness that is none.

    Example:
        >>> from glyphspline import convert, open_font, to_dxf
        >>> glyph = convert(open_font("fonts_test/kouzan-gyosho.ttf").outline("O"))
        >>> to_dxf(glyph, size="20mm").count("AcDbSpline"), len(glyph.contours)
        (2, 2)
    """
    return write(result, Settings(Appearance(size=size), flatness=flatness, dxf=dxf).scaled(result.outline.metrics))


def write(result: GlyphResult, settings: Settings) -> str:
    """The drawing of :func:`to_dxf`, in ASCII.

    Raises:
        GlyphsplineError: ezdxf, of the extra ``cad``, is not installed. OptionError: settings that are none.
    """
    require(settings.unit is None or settings.unit in INCHES, f"unit is one of {', '.join(INCHES)}", settings.unit)
    unit, scale = settings.unit, float(settings.scale)
    if unit not in UNITS:
        scale, unit = scale * INCHES[unit] / INCHES["mm"], "mm"  # type: ignore[index]
    opened = are_open(result.arrays.curves)
    given = [contour.curve for contour in result.contours]
    curves = Contours(c if cut else without_spurs(c) for c, cut in zip(given, opened.tolist(), strict=True)).arrays
    if settings.dxf == "polyline":
        flatness = settings.flatness_for(result.outline.metrics.units_per_em)
        drawn = [[(points, np.empty(0))] for points in polygons_of(flattened(paths(curves, opened), flatness)[0])]
    else:
        draw = _arcs if settings.dxf == "arcs" else _whole
        drawn = [draw(spline) if spline else [] for spline in replace(result.arrays, curves=curves).splines()]
    ezdxf = need("cad")
    with _metadata:  # the option is the process's: no date, no random number for the time of this drawing
        before = ezdxf.options.write_fixed_meta_data_for_testing
        ezdxf.options.write_fixed_meta_data_for_testing = True
        try:
            # The oldest version that has SPLINE, LWPOLYLINE and $INSUNITS; programs read it, whatever their age.
            document = ezdxf.new("R2000", units=UNITS[unit])
            document.header["$MEASUREMENT"] = int(unit != "in")
            for layer, colour in zip(LAYERS, COLOURS, strict=True):
                document.layers.add(layer, color=colour)
            _fill(document, drawn, holes(result), opened, scale, settings.dxf)
            text = StringIO()
            document.write(text)
        finally:
            ezdxf.options.write_fixed_meta_data_for_testing = before
    return text.getvalue()


def _fill(
    document: Any, drawn: Sequence[Sequence[Piece]], counters: BoolArray, opened: BoolArray, scale: float,
    kind: DxfKind,
) -> None:  # fmt: skip
    space = document.modelspace()
    low, high = np.full(2, np.inf), np.full(2, -np.inf)
    for number, (contour, hole, cut) in enumerate(zip(drawn, counters.tolist(), opened.tolist(), strict=True), 1):
        layer, entities = {"layer": HOLES if hole else OUTLINES}, []
        for control_points, knots in contour:
            points = control_points * scale + 0.0
            low, high = np.minimum(low, points.min(axis=0)), np.maximum(high, points.max(axis=0))
            if kind == "polyline":
                entities.append(space.add_lwpolyline(points.tolist(), "xy", close=not cut, dxfattribs=layer))
            elif not len(knots):
                entities.append(space.add_line(*points.tolist(), dxfattribs=layer))
            else:
                spline = space.add_spline(degree=3, dxfattribs={**layer, "flags": PLANAR})
                spline.control_points, spline.knots = points.tolist(), (knots * scale).tolist()
                entities.append(spline)
        if len(entities) > 1:
            document.groups.new(f"CONTOUR-{number}").extend(entities)
    if np.isfinite(low).all():  # control points are around the curve: a box a little larger than the drawing's
        (left, bottom), (right, top) = low.tolist(), high.tolist()
        space.dxf.extmin, space.dxf.extmax = (left, bottom, 0.0), (right, top, 0.0)
        height = max(top - bottom, right - left) * 1.1 or 1.0
        document.set_modelspace_vport(height, center=((left + right) / 2, (bottom + top) / 2))


def holes(result: GlyphResult) -> BoolArray:
    """(C,) which contours have their ink outside: under the nonzero rule, whichever way a font draws its outlines."""
    from ...curves.integrals import area  # here and not above: the package opens without a compiler
    from ...outlines.ink import ink_sides

    curves = result.arrays.curves
    if not curves.num_contours:
        return np.zeros(0, dtype=np.bool_)
    areas = np.array([area(contour.curve.cubics()) for contour in result.contours])
    return (ink_sides(curves) * areas < 0.0) & ~are_open(curves)


def _whole(spline: Spline) -> list[Piece]:
    clamped = spline.clamped()
    return [(clamped.control_points, clamped.full_knots)]


def _arcs(spline: Spline) -> list[Piece]:
    """The spline cut at corners and at the ends of lines, which are among its triple knots, and at its seam."""
    from ...curves.cubics import turns  # here and not above: the package opens without a compiler

    clamped = spline.clamped()
    points, knots = clamped.control_points, clamped.full_knots
    cubics, starts = spline.to_bezier(), spline.knots[spline.spans]
    bends = np.abs(np.diff(cubics, 2, axis=1)).max(axis=(1, 2))
    lines = bends <= STRAIGHT * np.abs(cubics[:, 3] - cubics[:, 0]).max(axis=1)
    broken = lines | np.roll(lines, 1) | (np.abs(turns(cubics, NO_HANDLE)) > SMOOTH)
    broken[0] = True
    joints = np.flatnonzero(knots[1:-3] == knots[3:-1])
    at = np.searchsorted(starts, knots[joints + 1])
    found = []
    for (a, first), (b, last) in pairwise([
        (j, k) for j, k in zip(joints.tolist(), at.tolist(), strict=True) if k == len(cubics) or broken[k]
    ]):  # fmt: skip
        if last - first == 1 and lines[first]:
            found.append((points[[a, b]], np.empty(0)))
        else:
            found.append((points[a : b + 1], knots[[a + 1, *range(a + 1, b + 4), b + 3]] - knots[a + 1]))
    return found


def without_spurs(contour: Contour) -> Contour:
    """The contour without lines that run back over the line before them, nor the part of it that they run over.

    These enclose nothing, and a modeller takes a face whose edge lies on itself for invalid. A contour that is nothing
    else is returned as it is.
    """
    kept: list[FloatArray] = []
    for segment in contour.segments():
        while kept and _runs_back(kept[-1], segment):
            segment = np.stack([kept.pop()[0], segment[1]])
        if len(segment) > 2 or (segment[0] != segment[1]).any():
            kept.append(segment)
    while len(kept) > 1 and _runs_back(kept[-1], kept[0]):  # at the seam
        last = np.stack([kept.pop()[0], kept.pop(0)[1]])
        kept += [last] if (last[0] != last[1]).any() else []
    return contour if not kept or len(kept) == len(contour) else Contour.from_segments(kept)


def _runs_back(one: FloatArray, other: FloatArray) -> bool:
    if len(one) > 2 or len(other) > 2:
        return False
    (dx, dy), (ex, ey) = (one[1] - one[0]).tolist(), (other[1] - other[0]).tolist()
    return bool(abs(dx * ey - dy * ex) <= -STRAIGHT * (dx * ex + dy * ey))
