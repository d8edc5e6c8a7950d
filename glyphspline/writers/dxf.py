"""Glyphs and texts as DXF, the exchange format of CAD programs: splines as splines, by ezdxf (extra ``cad``).

What is written, so that all programs read the same curve:

- A closed smooth contour is one SPLINE entity: the spline itself with the knot of its seam inserted until it is clamped
  (:meth:`..curves.bspline.Spline.clamped`), first and last control point equal, flags (group code 70) planar only. The
  closed and the periodic flag are left away: with either of them one program or another wraps the control points once
  more, replaces the knots, or reads no curve. docs/formats.md says which. Knots have the scale of the drawing.
- Of a contour with corners each arc is a SPLINE and each straight line a LINE. Cubics that only share tangents, and
  contours kept from the source, are one SPLINE from corner to corner, with triple knots where cubics meet. Quadratics
  are raised to cubics. The entities of a contour follow each other, end in the same coordinates, and are a GROUP.
- Coordinates are doubles in full, not rounded to ``precision``.
- No text of the font is in the file, nor a date: the same result has the same bytes.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator, Sequence
from io import StringIO
from itertools import islice, pairwise
from typing import Any, NamedTuple

import numpy as np

from ..curves.bspline import Spline
from ..errors import require
from ..extras import need
from ..fitting.results import ContourResult, GlyphResult
from ..outlines.outline import Contour
from ..outlines.polygons import flattened, polygons_of
from ..types import INCHES, BoolArray, FloatArray
from .settings import NO_HANDLE, SMOOTH, Appearance, DxfKind, Settings

VERSION = "R2000"
"""The oldest version that has SPLINE, LWPOLYLINE and $INSUNITS; programs read it, whatever their age."""

UNITS = {None: 0, "in": 1, "mm": 4, "cm": 5}
"""Values of $INSUNITS. Other units of lengths are written as millimetres."""

OUTLINES, HOLES = LAYERS = ("outlines", "holes")
COLOURS = (7, 1)
"""Of the layers, as AutoCAD numbers them: black on white and white on black; red."""

PLANAR = 8
"""The flag of a SPLINE in a plane."""

_metadata = threading.Lock()


class Piece(NamedTuple):
    """An entity to be: a LINE if ``degree`` is 1, else a clamped SPLINE.

    Attributes:
        points: (n, 2) control points in font units. knots: (n + degree + 1,), the first one 0.
    """

    degree: int
    points: FloatArray
    knots: FloatArray


def to_dxf(
    result: GlyphResult, *, size: str | None = None, dxf: DxfKind = "spline", flatness: float | None = None
) -> str:
    """A glyph, or a text, as a DXF drawing (R2000), y up.

    Contours are in the layers "outlines" and "holes"; a hole is a contour about which there is ink. A smooth contour is
    exactly one SPLINE. The origin of the glyph is that of the drawing.

    Args:
        result: of :func:`convert`.
        size: height from descender to ascender with its unit, as in "20mm", "2cm" or "1in"; DXF has no pt, pc and px:
            these become millimetres. None: a unit of the drawing is a font unit, and the drawing has no unit of length.
        dxf: "spline" writes the curves as they are: within ``deviation_bound`` of the source, and the rounding to
            ``precision`` that this bound counts and the file does not have, at most 0.71 of the last decimal.
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
    g1 = (result.options.corners, result.options.continuity) == ("sharp", "g1")
    drawn: Iterator[Sequence[Piece] | FloatArray]
    drawn = (pieces(contour, g1) for contour in result.contours)
    if settings.dxf == "polyline":
        flatness = settings.flatness_for(result.outline.metrics.units_per_em)
        drawn = iter(polygons_of(flattened(result.arrays.curves, flatness)[0]))
    ezdxf = need("cad")
    with _metadata:  # the option is the process's: no date, no random number for the time of this drawing
        before = ezdxf.options.write_fixed_meta_data_for_testing
        ezdxf.options.write_fixed_meta_data_for_testing = True
        try:
            document = ezdxf.new(VERSION, units=UNITS[unit])
            document.header["$MEASUREMENT"] = int(unit != "in")
            for layer, colour in zip(LAYERS, COLOURS, strict=True):
                document.layers.add(layer, color=colour)
            _fill(document, drawn, holes(result), scale)
            text = StringIO()
            document.write(text)
        finally:
            ezdxf.options.write_fixed_meta_data_for_testing = before
    return text.getvalue()


def _fill(document: Any, drawn: Iterator[Sequence[Piece] | FloatArray], counters: BoolArray, scale: float) -> None:
    space = document.modelspace()
    low, high = np.full(2, np.inf), np.full(2, -np.inf)
    for number, (contour, hole) in enumerate(zip(drawn, counters.tolist(), strict=True), 1):
        layer = {"layer": HOLES if hole else OUTLINES}
        if isinstance(contour, np.ndarray):
            points = contour * scale + 0.0
            space.add_lwpolyline(points.tolist(), "xy", close=True, dxfattribs=layer)
            low, high = np.minimum(low, points.min(axis=0)), np.maximum(high, points.max(axis=0))
            continue
        entities = []
        for piece in contour:
            points = piece.points * scale + 0.0
            low, high = np.minimum(low, points.min(axis=0)), np.maximum(high, points.max(axis=0))
            if piece.degree == 1:
                start, end = points.tolist()
                entities.append(space.add_line(start, end, dxfattribs=layer))
                continue
            spline = space.add_spline(degree=piece.degree, dxfattribs={**layer, "flags": PLANAR})
            spline.control_points, spline.knots = points.tolist(), (piece.knots * scale).tolist()
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
    from ..curves.integrals import area  # here and not above: the package opens without a compiler
    from ..outlines.ink import ink_sides

    curves = result.arrays.curves
    if not curves.num_contours:
        return np.zeros(0, dtype=np.bool_)
    areas = np.array([area(contour.curve.cubics()) for contour in result.contours])
    return ink_sides(curves) * areas < 0.0


def pieces(contour: ContourResult, g1: bool = False) -> list[Piece]:
    """The entities of a contour in order, each from the very point where the one before ends.

    Args:
        g1: whether its cubics only share tangents. They are drawn from corner to corner, as are contours that have no
            interpolations.
    """
    splines = [arc.spline for arc in contour.interpolations]
    spans = sum(len(spline.knots) - 1 for spline in splines)
    if g1 or spans == 0 or spans != np.count_nonzero(contour.curve.degrees > 1):
        return _chains(contour.curve)
    if splines[0].closed:
        return [_clamped(splines[0].clamped())]
    return _arcs(contour.curve, splines)


def _clamped(spline: Spline) -> Piece:
    return Piece(spline.degree, spline.control_points, spline.full_knots - spline.knots[0])


def _line(ends: FloatArray) -> Piece:
    return Piece(1, ends, np.array([0.0, 0.0, 1.0, 1.0]))


def _arcs(curve: Contour, splines: Sequence[Spline]) -> list[Piece]:
    """Arcs and lines, in the order of the curve, which passes through the same ends up to rounding."""
    found, left = [], iter(splines)
    segments = curve.segments()
    for segment in segments:
        if len(segment) == 2:
            found.append(_line(segment))
            continue
        spline = next(left)
        for last in islice(segments, len(spline.knots) - 2):
            segment = np.concatenate([segment[:1], last[1:]])
        piece = _clamped(spline)
        found.append(piece._replace(points=np.concatenate([segment[:1], piece.points[1:-1], segment[-1:]])))
    return found


def _chains(curve: Contour) -> list[Piece]:
    """Lines, and from corner to corner or line one spline of all cubics, in knots as long as their control polygons."""
    from ..curves.cubics import turns  # here and not above: the package opens without a compiler

    cubics = curve.cubics()
    legs = np.hypot(*np.moveaxis(np.diff(cubics, axis=1), 2, 0)).sum(axis=1)
    cubics, lines, legs = cubics[legs > 0.0], (curve.degrees == 1)[legs > 0.0], legs[legs > 0.0]
    broken = lines | np.roll(lines, 1) | (np.abs(turns(cubics, NO_HANDLE)) > SMOOTH)
    first = int(np.argmax(broken))
    cubics, lines, legs, broken = (np.roll(each, -first, axis=0) for each in (cubics, lines, legs, broken))
    found = []
    for a, b in pairwise([*np.flatnonzero(broken | (np.arange(len(broken)) == 0)).tolist(), len(broken)]):
        if lines[a]:
            found.append(_line(cubics[a, [0, 3]]))
            continue
        ends = np.concatenate([[0.0], np.cumsum(legs[a:b])])
        knots = np.concatenate([ends[:1], np.repeat(ends, 3), ends[-1:]])
        found.append(Piece(3, np.concatenate([cubics[a:b, :3].reshape(-1, 2), cubics[b - 1, 3:]]), knots))
    return found
