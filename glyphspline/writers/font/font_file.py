"""A font with the interpolated outlines in place of the source's: OTF (CFF, cubic) or TTF (quadratic).

What is not about outlines stays: advances, characters, kerning, features. Of a variable font the written one is
static, at the source's location. Hints go, and so do bitmaps and SVG pictures, which would hide the new outlines;
colour layers (COLR) are made of outlines and stay. Glyphs that were not converted are kept: as they are stored if
the format is the source's, else as the same outlines in the other format, within 1 unit. Components of composites
are kept too, so a composite of a replaced glyph is taken apart first and looks as before.
"""

from __future__ import annotations

import logging
from collections.abc import Iterable
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any

from fontTools.pens.ttGlyphPen import TTGlyphPen
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
    """What a written font came to.

    Attributes:
        family: its new name. replaced: number of glyphs with new outlines.
        largest_error: bound, in font units, of the distance of any of them from the source; None if not measured.
        beyond: names of those that may be farther from the source than their tolerance.
    """

    family: str
    replaced: int
    largest_error: float | None
    beyond: tuple[str, ...]


def to_font(
    source: Source,
    glyphs: Iterable[GlyphResult],
    flavour: Flavour,
    *,
    family: str | None = None,
    tolerance: float | None = None,
) -> tuple[bytes, FontSummary]:
    """The font as a file's bytes; the same input gives the same bytes.

    Args:
        source: what the glyphs were read from.
        glyphs: results, each glyph once; they are taken one by one.
        flavour: "otf" or "ttf".
        family: the new family name; None is the source's with "Spline".
        tolerance: distance from the source allowed to the written outlines, in font units; None is each glyph's own.
            Coordinates in a TTF are whole units: leave room for that when fitting, see
            :func:`.font_glyphs.fitting_tolerance`.

    Raises:
        GlyphsplineError: the source has no outlines, or a coordinate does not fit into a font.
    """
    family = family or f"{source.family} Spline"
    font = base_tables(source)
    in_place = ("glyf" if flavour == "ttf" else "CFF ") in font
    target = _InPlace(font, source, flavour) if in_place else _Rebuilt(font, source, flavour, family)
    beyond, errors = [], []
    for result in glyphs:
        allowed = result.options.tolerance_for(source.metrics.units_per_em) if tolerance is None else tolerance
        drawn = target.replace(result, allowed)
        errors.append(drawn.error)
        if drawn.error is not None and drawn.error > allowed:
            beyond.append(result.outline.name)
    target.finish()
    rename(font, family, source.style)
    largest = max((error for error in errors if error is not None), default=None)
    return compiled(font), FontSummary(family, len(errors), largest, tuple(beyond))


def compiled(font: TTFont) -> bytes:
    """The font's bytes, with bounds and maxima counted anew."""
    file = BytesIO()
    font.save(file, reorderTables=False)
    return file.getvalue()


class _InPlace:
    """New glyphs in a copy of the source's own table."""

    def __init__(self, font: TTFont, source: Source, flavour: Flavour) -> None:
        self.font, self.source, self.flavour = font, source, flavour
        self.names: list[str] = font.getGlyphOrder()
        self.replaced: set[str] = set()
        self.new: dict[str, Any] = {}
        if flavour == "otf":
            font["CFF "].cff.remove_hints()
            self.strings = font["CFF "].cff.topDictIndex[0].CharStrings

    def replace(self, result: GlyphResult, tolerance: float) -> Drawn:
        name = self.names[result.outline.gid]
        drawn = drawn_result(result, tolerance, self.flavour, self._width(name))
        self.replaced.add(name)
        if self.flavour == "ttf":
            self.new[name] = drawn.data
        else:
            old = self.strings[name]
            drawn.data.private, drawn.data.globalSubrs = old.private, old.globalSubrs
            if self.strings.charStringsAreIndexed:
                self.strings.charStringsIndex[self.strings.charStrings[name]] = drawn.data
            else:
                self.strings[name] = drawn.data
        set_bearings(self.font, self.source, name, drawn, result.outline)
        return drawn

    def _width(self, name: str) -> float | None:
        """The advance as it stands in a char string: less the nominal one, or left out where it is the default."""
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
            if name not in self.replaced:
                self._keep(glyf, name)
        for name, glyph in self.new.items():
            glyf[name] = glyph

    def _keep(self, glyf: Any, name: str) -> None:
        """Without instructions, and without components that are not what they were."""
        glyph = glyf[name]
        if glyph.isComposite() and self._touched(glyf, name, set()):
            pen = TTGlyphPen(None)
            coordinates, ends, flags = glyph.getCoordinates(glyf)[:3]
            start = 0
            for end in ends:
                draw_points(pen, coordinates[start : end + 1], flags[start : end + 1])
                start = end + 1
            self.new[name] = pen.glyph()
        else:
            glyph.removeHinting()

    def _touched(self, glyf: Any, name: str, seen: set[str]) -> bool:
        if name in self.replaced:
            return True
        if name in seen or not glyf[name].isComposite():
            return False
        seen.add(name)
        return any(self._touched(glyf, part.glyphName, seen) for part in glyf[name].components)


def draw_points(pen: TTGlyphPen, points: Any, flags: Any) -> None:
    """A contour of a TrueType glyph, as its table has it, with a pen that makes one."""
    on = [bool(flag & 1) for flag in flags]
    if not any(on):
        pen.qCurveTo(*points, None)
        pen.closePath()
        return
    first = on.index(True)
    points = [*points[first:], *points[:first]]
    on = [*on[first:], *on[:first]]
    pen.moveTo(points[0])
    waiting: list[Any] = []
    for point, is_on in zip([*points[1:], points[0]], [*on[1:], True], strict=True):
        waiting.append(point)
        if is_on:
            (pen.qCurveTo if len(waiting) > 1 else pen.lineTo)(*waiting)
            waiting = []
    pen.closePath()


class _Rebuilt:
    """All glyphs drawn anew in the other format."""

    def __init__(self, font: TTFont, source: Source, flavour: Flavour, family: str) -> None:
        self.font, self.source, self.flavour, self.family = font, source, flavour, family
        self.of_name = {name: name for name in source.glyph_names}
        if font.getGlyphOrder()[0] == source.glyph_names[0]:  # names in the file may differ, their order cannot
            self.of_name = dict(zip(source.glyph_names, font.getGlyphOrder(), strict=True))
        self.glyphs: dict[str, Any] = {}

    def replace(self, result: GlyphResult, tolerance: float) -> Drawn:
        return self._put(drawn_result(result, tolerance, self.flavour, self._width(result.outline)), result.outline)

    def _width(self, outline: Outline) -> float | None:
        return round(outline.advance) if self.flavour == "otf" else None

    def _put(self, drawn: Drawn, outline: Outline) -> Drawn:
        name = self.of_name[outline.name]
        self.glyphs[name] = drawn.data
        set_bearings(self.font, self.source, name, drawn, outline)
        return drawn

    def finish(self) -> None:
        for name in self.source.glyph_names:
            if self.of_name[name] not in self.glyphs:
                outline = self._readable(name)
                self._put(drawn_outline(outline, self.flavour, self._width(outline)), outline)
        if ".notdef" not in self.glyphs:
            empty = Outline(".notdef", advance=self.source.metrics.units_per_em / 2)
            self.of_name[".notdef"] = ".notdef"
            self._put(drawn_outline(empty, self.flavour, self._width(empty)), empty)
        become(self.font, self.flavour, {name: self.glyphs[name] for name in self.font.getGlyphOrder()}, self.family)

    def _readable(self, name: str) -> Outline:
        try:
            return self.source.outline(name)
        except GlyphsplineError as error:
            log.warning("%s: left empty in the written font", error)
            return Outline(name, metrics=self.source.metrics)


def set_bearings(font: TTFont, source: Source, name: str, drawn: Drawn, outline: Outline) -> None:
    """Side bearings as the new bounds ask for: renderers place an outline by them. The advance stays."""
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
) -> FontSummary:
    """:func:`to_font` into a file, OTF or TTF by its suffix.

    Raises:
        GlyphsplineError: as there; or the suffix is neither. OSError: the file cannot be written.
    """
    path = Path(path)
    flavour = path.suffix.lower().lstrip(".")
    if flavour not in ("otf", "ttf"):
        raise GlyphsplineError("a font's file name ends in .otf or .ttf", font=str(path))
    data, summary = to_font(source, glyphs, flavour, family=family, tolerance=tolerance)  # type: ignore[arg-type]
    path.write_bytes(data)
    return summary
