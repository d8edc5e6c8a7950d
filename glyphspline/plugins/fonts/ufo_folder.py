"""Outlines as UFO 3 folders, for font editors; they contain converted glyphs only.

A result: cubics are those of the splines, split exactly at extrema (those of continuity "g2" have points where the
source has them), with points marked smooth where the curve is. The
layer ``public.background`` contains the polygon of each contour; each glyph's ``lib`` contains, under
``org.glyphspline.contours``, the splines' knots, footpoint parameters and measures.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, astuple
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
from fontTools.ufoLib import UFOWriter

from ...errors import OutputError
from ...fitting.results import ContourResult, GlyphResult
from ...outlines.open_paths import there_and_back
from ...outlines.outline import Contour
from ...readers import Source
from ...writers.json_file import finite
from .back.nodes import as_number, nodes_of, smooth_ends
from .extrema import with_extrema

LIB_KEY = "org.glyphspline.contours"
OPTIONS_KEY = "org.glyphspline.options"
BACKGROUND = "public.background"


def write_ufo(source: Source, glyphs: Iterable[GlyphResult], path: str | Path, *, family: str | None = None) -> int:
    """Write the folder, replacing an older one; returns the number of glyphs.

    Args:
        source: what the glyphs were read from. glyphs: results, each glyph once, read one by one.
        path: the folder. family: the name; None is the source's with "Spline".

    Raises:
        OutputError: something at ``path`` is not a UFO. OSError: it cannot be written.
    """
    path = Path(path)
    with replacing(path, "is no UFO", "metainfo.plist") as partial:
        writer = writer_of(partial, source, family or f"{source.family} Spline", source.style)
        layers = [writer.getGlyphSet(), writer.getGlyphSet(layerName=BACKGROUND, defaultLayer=False)]
        order = []
        for result in glyphs:
            order.append(result.outline.name)
            write_glyph(result, *layers)
        close(writer, {"public.default": layers[0], BACKGROUND: layers[1]}, order)
    return len(order)


@contextmanager
def replacing(folder: Path, otherwise: str, *marks: str) -> Iterator[Path]:
    """A folder beside another one, to be filled within; it then takes that one's place.

    Raises:
        OutputError: what is there has none of the files ``marks``, which the error says in the words ``otherwise``.
    """
    if folder.is_symlink() or (folder.exists() and not any(any(folder.glob(mark)) for mark in marks)):
        raise OutputError(f"is there already, and {otherwise}", font=str(folder))
    partial = folder.with_name(f".{folder.name}.part")
    shutil.rmtree(partial, ignore_errors=True)
    yield partial
    if folder.exists():
        shutil.rmtree(folder)
    partial.replace(folder)


def writer_of(path: Path, source: Source, family: str, style: str) -> UFOWriter:
    """A UFO in the making, with names and metrics of the source."""
    writer = UFOWriter(path, fileCreator="org.glyphspline", validate=True)
    em, ascender, descender = map(as_number, astuple(source.metrics))
    metrics = {"unitsPerEm": em, "ascender": ascender, "descender": descender}
    writer.writeInfo(SimpleNamespace(familyName=family, styleName=style, **metrics))
    return writer


def close(writer: UFOWriter, layers: Mapping[str, Any], order: Sequence[str]) -> None:
    """Write what a UFO has besides glyphs: lists of its layers, of their glyphs, and their order."""
    for glyphs in layers.values():
        glyphs.writeContents()
    writer.writeLib({"public.glyphOrder": list(order)})
    writer.writeLayerContents(list(layers))
    writer.close()


def write_glyph(result: GlyphResult, front: Any, back: Any) -> None:
    """Write one glyph to the default layer and its polygons to the background."""
    outline, digits = result.outline, result.options.precision
    curves = [[curve] for curve in stored_curves(result)]
    lines = [[_polygon(contour)] for contour in result.contours if len(contour.polygon)]
    lib = {LIB_KEY: [_lib_entry(contour) for contour in result.contours], OPTIONS_KEY: _plain(result.options.facts())}
    width, note = as_number(outline.advance), "\n".join(result.notes) or None
    glyph = SimpleNamespace(width=width, unicodes=list(outline.unicodes), note=note, lib=lib)
    front.writeGlyph(outline.name, glyph, lambda pen: draw(curves, digits, pen))
    back.writeGlyph(outline.name, SimpleNamespace(width=width), lambda pen: draw(lines, digits, pen))


def stored_curves(result: GlyphResult) -> list[Contour]:
    """The contours of a result as a UFO stores them: with points at extrema, but for open paths. Those for fonts have
    them already.
    """
    curves, em = [contour.curve for contour in result.contours], result.outline.metrics.units_per_em
    return [c if result.options.is_for_fonts or c.is_open else with_extrema(c, em) for c in curves]


def _polygon(contour: ContourResult) -> Contour:
    """The polygon of a result, an open one of an open path."""
    points, lines = contour.polygon, np.ones(len(contour.polygon), dtype=np.int64)
    return Contour(*there_and_back(points, lines[1:])) if contour.curve.is_open else Contour(points, lines)


def draw(contours: Iterable[Sequence[Contour]], digits: int, pen: Any, master: int = 0) -> None:
    """Draw contours with a point pen in one of their masters, rounded; open paths as such."""
    for masters in contours:
        pen.beginPath()
        nodes = nodes_of(masters[master].rounded(digits), smooth_ends(masters))
        if masters[0].is_open:
            nodes = [nodes[0]._replace(kind="move"), *nodes[1 : len(nodes) // 2 + 1]]
        for node in nodes:
            pen.addPoint(node.at, node.kind, node.smooth)
        pen.endPath()


def _lib_entry(contour: ContourResult) -> dict[str, Any]:
    splines = [
        {"closed": s.closed, "degree": s.degree, "knots": s.knots.tolist(), "parameters": one.parameters.tolist()}
        for one in contour.interpolations
        for s in [one.spline]
    ]
    return {"splines": splines, "measures": _plain(asdict(contour.measures))}


def _plain(values: dict[str, Any]) -> dict[str, Any]:
    """The values that a property list can store: neither None nor infinite."""
    return {name: value for name, value in values.items() if finite(value) is not None}
