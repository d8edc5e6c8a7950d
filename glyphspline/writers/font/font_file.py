"""A font with the interpolated outlines in place of the source's: OTF (CFF, cubic) or TTF (quadratic).

Converted glyphs get points at extrema. Advances, characters, kerning and features are kept. A variable font becomes
static at the source's location. Hints, bitmaps and SVG pictures, which belong to the old outlines, are removed; colour
layers (COLR) are kept.
Glyphs that were not converted keep their outlines: unchanged if the format is the source's, else converted to the
other format, within 1 unit. A composite with a replaced component is decomposed first, so it looks as before.
"""

from __future__ import annotations

import logging
from collections.abc import Iterable
from dataclasses import dataclass
from io import BytesIO
from itertools import pairwise
from pathlib import Path
from typing import Any

from fontTools.pens.ttGlyphPen import TTGlyphPointPen
from fontTools.ttLib import TTFont

from ...errors import GlyphsplineError
from ...fitting.results import GlyphResult
from ...outlines.outline import Outline
from ...readers import Source
from .font_glyphs import Drawn, Flavour, drawn_outline, drawn_result
from .font_tables import base_tables, become, rename

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class FontSummary:
    """The facts of a written font.

    Attributes:
        family: the new name. replaced: number of glyphs with new outlines.
        largest_error: bound of their distance from the source, in font units; None if not measured.
        beyond: names of the glyphs that may be farther from the source than their tolerance.
        extrema: number of points added at extrema.
    """

    family: str
    replaced: int
    largest_error: float | None
    beyond: tuple[str, ...]
    extrema: int


def to_font(
    source: Source,
    glyphs: Iterable[GlyphResult],
    flavour: Flavour,
    *,
    family: str | None = None,
    tolerance: float | None = None,
    extrema: bool = True,
) -> tuple[bytes, FontSummary]:
    """The font as a file's bytes; the same input gives the same bytes.

    Args:
        source: what the glyphs were read from. glyphs: results, each glyph once, read one by one.
        flavour: "otf" or "ttf". family: the new family name; None is the source's with "Spline".
        tolerance: largest distance of the written outlines from the source, in font units; None is each glyph's own.
            A TTF has whole units, so fit within :func:`.font_glyphs.fitting_tolerance`.
        extrema: whether points are added at horizontal and vertical extrema of the new outlines.

    Raises:
        GlyphsplineError: the source has no outlines, or a coordinate does not fit into a font.
    """
    family = family or f"{source.family} Spline"
    font = base_tables(source)
    in_place = ("glyf" if flavour == "ttf" else "CFF ") in font
    target = _InPlace(font, flavour) if in_place else _Rebuilt(font, source, flavour, family)
    beyond, errors, added = [], [], 0
    for result in glyphs:
        allowed = result.options.tolerance_for(source.metrics.units_per_em) if tolerance is None else tolerance
        drawn = target.replace(result, allowed, extrema)
        errors.append(drawn.error)
        added += drawn.extrema
        if drawn.error is not None and drawn.error > allowed:
            beyond.append(result.outline.name)
    target.finish()
    rename(font, family, source.style)
    largest = max((error for error in errors if error is not None), default=None)
    file = BytesIO()
    font.save(file, reorderTables=False)
    return file.getvalue(), FontSummary(family, len(errors), largest, tuple(beyond), added)


class _InPlace:
    """New glyphs in a copy of the source's own table."""

    def __init__(self, font: TTFont, flavour: Flavour) -> None:
        self.font, self.flavour = font, flavour
        self.names: list[str] = font.getGlyphOrder()
        self.new: dict[str, Any] = {}  # for "glyf", which is read until all glyphs are known
        if flavour == "otf":
            font["CFF "].cff.remove_hints()
            self.strings = font["CFF "].cff.topDictIndex[0].CharStrings

    def replace(self, result: GlyphResult, tolerance: float, extrema: bool) -> Drawn:
        name = self.names[result.outline.gid]
        drawn = drawn_result(result, tolerance, self.flavour, self._width(name), extrema)
        if self.flavour == "ttf":
            self.new[name] = drawn.data
        else:
            old = self.strings[name]
            drawn.data.private, drawn.data.globalSubrs = old.private, old.globalSubrs
            if self.strings.charStringsAreIndexed:
                self.strings.charStringsIndex[self.strings.charStrings[name]] = drawn.data
            else:
                self.strings[name] = drawn.data
        set_bearings(self.font, name, drawn, result.outline)
        return drawn

    def _width(self, name: str) -> float | None:
        """The advance as a char string stores it: relative to the nominal width, or None for the default."""
        if self.flavour == "ttf":
            return None
        private = self.strings[name].private
        advance = self.font["hmtx"][name][0]
        return None if advance == private.defaultWidthX else advance - private.nominalWidthX

    def finish(self) -> None:
        if self.flavour != "ttf":
            return
        glyf = self.font["glyf"]
        for name in self.names:
            if name in self.new:
                continue
            if glyf[name].isComposite() and self._touched(glyf, name, set()):
                self.new[name] = decomposed(glyf, name)
            else:
                glyf[name].removeHinting()
        for name, glyph in self.new.items():
            glyf[name] = glyph

    def _touched(self, glyf: Any, name: str, seen: set[str]) -> bool:
        """Whether the glyph is new or has a new component at any depth."""
        if name in self.new:
            return True
        if name in seen or not glyf[name].isComposite():
            return False
        seen.add(name)
        return any(self._touched(glyf, part.glyphName, seen) for part in glyf[name].components)


def decomposed(glyf: Any, name: str) -> Any:
    """A composite as a simple glyph whose contours begin on the curve, where they touch it."""
    points, ends, flags = glyf[name].getCoordinates(glyf)[:3]
    pen = TTGlyphPointPen(None)
    for start, stop in pairwise([0, *(end + 1 for end in ends)]):
        first = next((i for i in range(start, stop) if flags[i] & 1), start)
        pen.beginPath()
        for i in (*range(first, stop), *range(start, first)):
            pen.addPoint(points[i], "line" if flags[i] & 1 else None)
        pen.endPath()
    return pen.glyph()


class _Rebuilt:
    """All glyphs drawn again in the other format."""

    def __init__(self, font: TTFont, source: Source, flavour: Flavour, family: str) -> None:
        self.font, self.source, self.flavour, self.family = font, source, flavour, family
        self.of_name = {name: name for name in source.glyph_names}
        if font.getGlyphOrder()[0] == source.glyph_names[0]:  # names may differ, their order is the same
            self.of_name = dict(zip(source.glyph_names, font.getGlyphOrder(), strict=True))
        self.glyphs: dict[str, Any] = {}

    def replace(self, result: GlyphResult, tolerance: float, extrema: bool) -> Drawn:
        outline = result.outline
        drawn = drawn_result(result, tolerance, self.flavour, round(outline.advance), extrema)
        return self._put(drawn, outline)

    def _put(self, drawn: Drawn, outline: Outline) -> Drawn:
        name = self.of_name[outline.name]
        self.glyphs[name] = drawn.data
        set_bearings(self.font, name, drawn, outline)
        return drawn

    def finish(self) -> None:
        for name in self.source.glyph_names:
            if self.of_name[name] not in self.glyphs:
                outline = self._readable(name)
                self._put(drawn_outline(outline, self.flavour), outline)
        if ".notdef" not in self.glyphs:
            empty = Outline(".notdef", advance=self.source.metrics.units_per_em / 2)
            self.of_name[".notdef"] = ".notdef"
            self._put(drawn_outline(empty, self.flavour), empty)
        become(self.font, self.flavour, {name: self.glyphs[name] for name in self.font.getGlyphOrder()}, self.family)

    def _readable(self, name: str) -> Outline:
        try:
            return self.source.outline(name)
        except GlyphsplineError as error:
            log.warning("%s: left empty in the written font", error)
            return Outline(name, metrics=self.source.metrics)


def set_bearings(font: TTFont, name: str, drawn: Drawn, outline: Outline) -> None:
    """Set side bearings from the new bounds, by which renderers place an outline. The advance does not change."""
    metrics = font["hmtx"].metrics
    metrics[name] = (round(outline.advance), int(drawn.bounds[0]) if drawn.bounds else 0)
    if "vmtx" in font and drawn.bounds:
        height, top = font["vmtx"].metrics[name]
        ink = [contour.points[:, 1].max() for contour in outline.contours]
        if ink:
            font["vmtx"].metrics[name] = (height, top + round(float(max(ink))) - int(drawn.bounds[3]))


def write_font(
    source: Source,
    glyphs: Iterable[GlyphResult],
    path: str | Path,
    *,
    family: str | None = None,
    tolerance: float | None = None,
    extrema: bool = True,
) -> FontSummary:
    """Write the result of :func:`to_font` to a file, OTF or TTF by its suffix.

    Raises:
        GlyphsplineError: as in :func:`to_font`; or the suffix is neither. OSError: the file cannot be written.
    """
    path = Path(path)
    flavour = path.suffix.lower().lstrip(".")
    if flavour not in ("otf", "ttf"):
        raise GlyphsplineError("a font's file name ends in .otf or .ttf", font=str(path))
    chosen: Flavour = "otf" if flavour == "otf" else "ttf"
    data, summary = to_font(source, glyphs, chosen, family=family, tolerance=tolerance, extrema=extrema)
    path.write_bytes(data)
    return summary
