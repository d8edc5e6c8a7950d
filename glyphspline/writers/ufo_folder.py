"""Interpolated outlines as a UFO 3 folder, to be opened in font editors.

Cubics as the splines have them, with points at the extrema put in by exact splitting, and points marked smooth where
the curve is. The polygon of each contour is kept in the layer ``public.background``; each glyph's ``lib`` has, under
``org.glyphspline.contours``, the splines' knots, footpoint parameters and measures. Only converted glyphs are in it.
"""

from __future__ import annotations

import math
import shutil
from collections.abc import Iterable, Iterator
from dataclasses import asdict
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
from fontTools.ufoLib import UFOWriter

from ..curves.bezier import split
from ..curves.cubics import turns
from ..errors import GlyphsplineError
from ..fitting.results import ContourResult, GlyphResult
from ..outlines.outline import Contour
from ..readers import Source
from ..types import FloatArray

LIB_KEY = "org.glyphspline.contours"
OPTIONS_KEY = "org.glyphspline.options"
BACKGROUND = "public.background"

SMOOTH = 1e-3
"""Radians. A join turning by less is smooth: rounding to 1/100 unit turns handles of 10 units by as much."""

NO_HANDLE = 1e-9
"""Handles up to this long, in font units, may be rounding's alone, and give no direction."""

AT_END = 1e-3
"""An extremum as near to an end of its segment, as a share of it, is that end's own."""


def write_ufo(source: Source, glyphs: Iterable[GlyphResult], path: str | Path, *, family: str | None = None) -> int:
    """Write the folder, in the place of one that may be there; returns the number of glyphs.

    Args:
        source: what the glyphs were read from. glyphs: results, each glyph once; they are taken one by one.
        path: the folder to be. family: the name; None is the source's with "Spline".

    Raises:
        GlyphsplineError: there is something at ``path`` that is no UFO. OSError: it cannot be written.
    """
    path = Path(path)
    if path.is_symlink() or (path.exists() and not (path / "metainfo.plist").exists()):
        raise GlyphsplineError("is there already, and is no UFO", font=str(path))
    partial = path.with_name(f".{path.name}.part")
    shutil.rmtree(partial, ignore_errors=True)
    count = _write(source, glyphs, partial, family or f"{source.family} Spline")
    if path.exists():
        shutil.rmtree(path)
    partial.replace(path)
    return count


def _write(source: Source, glyphs: Iterable[GlyphResult], path: Path, family: str) -> int:
    writer = UFOWriter(path, fileCreator="org.glyphspline", validate=True)
    metrics = source.metrics
    writer.writeInfo(
        SimpleNamespace(
            familyName=family,
            styleName=source.style,
            unitsPerEm=_number(metrics.units_per_em),
            ascender=_number(metrics.ascender),
            descender=_number(metrics.descender),
        )
    )
    front = writer.getGlyphSet()
    back = writer.getGlyphSet(layerName=BACKGROUND, defaultLayer=False)
    order = []
    for result in glyphs:
        order.append(result.outline.name)
        write_glyph(result, front, back)
    front.writeContents()
    back.writeContents()
    writer.writeLib({"public.glyphOrder": order})
    writer.writeLayerContents(["public.default", BACKGROUND])
    writer.close()
    return len(order)


def write_glyph(result: GlyphResult, front: Any, back: Any) -> None:
    """One glyph into the default layer, and its polygons into the background."""
    outline, digits = result.outline, result.options.precision
    curves = [with_extrema(contour.curve) for contour in result.contours]
    lib = {LIB_KEY: [_lib_entry(contour) for contour in result.contours], OPTIONS_KEY: _plain(asdict(result.options))}
    glyph = SimpleNamespace(
        width=_number(outline.advance), unicodes=list(outline.unicodes), note="\n".join(result.notes) or None, lib=lib
    )

    def draw_front(pen: Any) -> None:
        for curve in curves:
            draw_curve(curve, digits, pen)

    def draw_back(pen: Any) -> None:
        for contour in result.contours:
            draw_polygon(contour.polygon, digits, pen)

    front.writeGlyph(outline.name, glyph, draw_front)
    back.writeGlyph(outline.name, SimpleNamespace(width=_number(outline.advance)), draw_back)


def with_extrema(contour: Contour) -> Contour:
    """The same curve, its cubics and quadratics split where they are highest, lowest, leftmost and rightmost."""
    return Contour.from_segments(piece for segment in contour.segments() for piece in split_at_extrema(segment))


def split_at_extrema(segment: FloatArray) -> Iterator[FloatArray]:
    """The parts of a Bézier segment between its extrema in x and y."""
    degree = len(segment) - 1
    cuts: list[float] = []
    if degree > 1:
        d = np.diff(segment, axis=0)
        for k in (0, 1):
            power = [d[0, k], d[1, k] - d[0, k]] if degree == 2 else [
                d[0, k], 2 * (d[1, k] - d[0, k]), d[0, k] - 2 * d[1, k] + d[2, k]]  # fmt: skip
            cuts += [float(t) for t in real_roots(power) if AT_END < t < 1 - AT_END]
    done = 0.0
    for t in sorted(cuts):
        if t - done > AT_END:
            left, segment = split(segment, (t - done) / (1 - done))
            yield left
            done = t
    yield segment


def real_roots(power: list[float]) -> list[float]:
    """Real roots of a polynomial of degree 2 at most, by ascending powers; double ones left out."""
    c, b, a = [*power, 0.0][:3]
    if abs(a) <= 1e-12 * (abs(b) + abs(c)):
        return [-c / b] if b else []
    discriminant = b * b - 4 * a * c
    if discriminant <= 0:
        return []  # a double root is an inflection with that tangent, no extremum
    q = -0.5 * (b + math.copysign(math.sqrt(discriminant), b))
    return [q / a, c / q] if q else [q / a]


def draw_curve(contour: Contour, digits: int, pen: Any) -> None:
    """A contour with a point pen, rounded, with smooth flags."""
    smooth = smooth_ends(contour)
    points = (np.round(contour.points, digits) + 0.0).tolist()
    kinds = (None, "line", "qcurve", "curve")
    pen.beginPath()
    for j, (offset, degree) in enumerate(zip(contour.offsets.tolist(), contour.degrees.tolist(), strict=True)):
        arriving = kinds[int(contour.degrees[j - 1])]
        pen.addPoint(_pair(points[offset]), arriving, bool(smooth[j]))
        for k in range(1, degree):
            pen.addPoint(_pair(points[offset + k]))
    pen.endPath()


def smooth_ends(contour: Contour) -> list[bool]:
    """Whether the curve goes straight on at the beginning of each segment; between two lines none is smooth."""
    curved = np.maximum(contour.degrees, np.roll(contour.degrees, 1)) > 1
    return ((np.abs(turns(contour.cubics(), NO_HANDLE)) < SMOOTH) & curved).tolist()


def draw_polygon(polygon: FloatArray, digits: int, pen: Any) -> None:
    """A polygon with a point pen."""
    if not len(polygon):
        return
    pen.beginPath()
    for point in (np.round(polygon, digits) + 0.0).tolist():
        pen.addPoint(_pair(point), "line")
    pen.endPath()


def _lib_entry(contour: ContourResult) -> dict[str, Any]:
    splines = [
        {
            "closed": one.spline.closed,
            "degree": one.spline.degree,
            "knots": one.spline.knots.tolist(),
            "parameters": one.parameters.tolist(),
        }
        for one in contour.interpolations
    ]
    return {"splines": splines, "measures": _plain(asdict(contour.measures))}


def _plain(values: dict[str, Any]) -> dict[str, Any]:
    """What a property list can hold: no nulls, no infinities."""
    return {
        name: value
        for name, value in values.items()
        if value is not None and not (isinstance(value, float) and not math.isfinite(value))
    }


def _number(value: float) -> float | int:
    return int(value) if float(value).is_integer() else float(value)


def _pair(point: list[float]) -> tuple[float | int, float | int]:
    return _number(point[0]), _number(point[1])
