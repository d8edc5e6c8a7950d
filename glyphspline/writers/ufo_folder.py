"""Interpolated outlines as a UFO 3 folder, for font editors; it contains converted glyphs only.

Cubics are those of the splines, split exactly at extrema, with points marked smooth where the curve is. The layer
``public.background`` contains the polygon of each contour; each glyph's ``lib`` contains, under
``org.glyphspline.contours``, the splines' knots, footpoint parameters and measures.
"""

from __future__ import annotations

import math
import shutil
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, astuple
from itertools import islice
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
from fontTools.ufoLib import UFOWriter

from ..curves.cubics import turns
from ..errors import GlyphsplineError
from ..fitting.results import ContourResult, GlyphResult
from ..outlines.extrema import with_extrema
from ..outlines.outline import Contour
from ..readers import Source

LIB_KEY = "org.glyphspline.contours"
OPTIONS_KEY = "org.glyphspline.options"
BACKGROUND = "public.background"

SMOOTH = 1e-3
"""Radians of turn below which a join is smooth: rounding to 1/100 unit turns handles of 10 units by as much."""

NO_HANDLE = 1e-9
"""Handles up to this length in font units may be rounding errors and have no direction."""


def write_ufo(source: Source, glyphs: Iterable[GlyphResult], path: str | Path, *, family: str | None = None) -> int:
    """Write the folder, replacing an older one; returns the number of glyphs.

    Args:
        source: what the glyphs were read from. glyphs: results, each glyph once, read one by one.
        path: the folder. family: the name; None is the source's with "Spline".

    Raises:
        GlyphsplineError: something at ``path`` is not a UFO. OSError: it cannot be written.
    """
    path = Path(path)
    if path.is_symlink() or (path.exists() and not (path / "metainfo.plist").exists()):
        raise GlyphsplineError("is there already, and is no UFO", font=str(path))
    with replacing(path) as partial:
        return _write(source, glyphs, partial, family or f"{source.family} Spline")


@contextmanager
def replacing(folder: Path) -> Iterator[Path]:
    """A folder beside another one, to be filled within; it then takes that one's place."""
    partial = folder.with_name(f".{folder.name}.part")
    shutil.rmtree(partial, ignore_errors=True)
    yield partial
    if folder.exists():
        shutil.rmtree(folder)
    partial.replace(folder)


def _write(source: Source, glyphs: Iterable[GlyphResult], path: Path, family: str) -> int:
    writer = UFOWriter(path, fileCreator="org.glyphspline", validate=True)
    em, ascender, descender = map(as_number, astuple(source.metrics))
    metrics = {"unitsPerEm": em, "ascender": ascender, "descender": descender}
    writer.writeInfo(SimpleNamespace(familyName=family, styleName=source.style, **metrics))
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
    """Write one glyph to the default layer and its polygons to the background."""
    outline, digits = result.outline, result.options.precision
    curves = [with_extrema(contour.curve, outline.metrics.units_per_em) for contour in result.contours]
    lines = [Contour(c.polygon, np.ones(len(c.polygon), dtype=np.int64)) for c in result.contours if len(c.polygon)]
    lib = {LIB_KEY: [_lib_entry(contour) for contour in result.contours], OPTIONS_KEY: _plain(asdict(result.options))}
    width, note = as_number(outline.advance), "\n".join(result.notes) or None
    glyph = SimpleNamespace(width=width, unicodes=list(outline.unicodes), note=note, lib=lib)
    front.writeGlyph(outline.name, glyph, lambda pen: draw(curves, digits, pen))
    back.writeGlyph(outline.name, SimpleNamespace(width=width), lambda pen: draw(lines, digits, pen))


def draw(contours: Sequence[Contour], digits: int, pen: Any, flags: Sequence[Sequence[bool]] | None = None) -> None:
    """Draw contours with a point pen, rounded; ``flags`` says which points are smooth, by default where they are."""
    kinds = (None, "line", "qcurve", "curve")
    for contour, smooth_points in zip(contours, flags or map(smooth_ends, contours), strict=True):
        points = iter(contour.rounded(digits).points.tolist())
        arriving = np.roll(contour.degrees, 1).tolist()
        pen.beginPath()
        for before, degree, smooth in zip(arriving, contour.degrees.tolist(), smooth_points, strict=True):
            pen.addPoint(tuple(map(as_number, next(points))), kinds[before], smooth)
            for point in islice(points, degree - 1):
                pen.addPoint(tuple(map(as_number, point)))
        pen.endPath()


def smooth_ends(contour: Contour) -> list[bool]:
    """Whether the tangent is continuous at the beginning of each segment; False between two lines."""
    curved = np.maximum(contour.degrees, np.roll(contour.degrees, 1)) > 1
    return ((np.abs(turns(contour.cubics(), NO_HANDLE)) < SMOOTH) & curved).tolist()


def _lib_entry(contour: ContourResult) -> dict[str, Any]:
    splines = [
        {"closed": s.closed, "degree": s.degree, "knots": s.knots.tolist(), "parameters": one.parameters.tolist()}
        for one in contour.interpolations
        for s in [one.spline]
    ]
    return {"splines": splines, "measures": _plain(asdict(contour.measures))}


def _plain(values: dict[str, Any]) -> dict[str, Any]:
    """The values that a property list can store: neither None nor infinite."""
    return {k: v for k, v in values.items() if not (v is None or (isinstance(v, float) and not math.isfinite(v)))}


def as_number(value: float) -> float | int:
    """A number as a property list has it: an int if it is whole."""
    return int(value) if float(value).is_integer() else float(value)
