"""A font with the interpolated outlines in place of the source's: OTF (CFF, cubic) or TTF (quadratic).

Converted glyphs get points at extrema. Advances, characters, kerning and features are kept. A variable font becomes
static at the source's location. Hints, bitmaps and SVG pictures, which belong to the old outlines, are removed; colour
layers (COLR) are kept.
Glyphs that were not converted keep their outlines: unchanged if the format is the source's, else converted to the
other format, within 1 unit. A composite with a replaced component is decomposed first, so it looks as before; with
continuity "g2" it keeps its components.
"""

from __future__ import annotations

import logging
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import Any

from fontTools.fontBuilder import FontBuilder
from fontTools.misc.psCharStrings import T2WidthExtractor
from fontTools.pens.basePen import NullPen
from fontTools.ttLib import TTFont, newTable

from ....errors import FontError, GlyphsplineError
from ....extras import need
from ....fitting.results import GlyphResult
from ....outlines.outline import Outline
from ....readers import Font, Source
from ....readers.opentype.font import unused
from ....readers.source import library_words, reusing
from ..read_back import Held, Promise, held
from .font_glyphs import (
    GRID,
    Drawn,
    Flavour,
    decomposed,
    drawn_outline,
    drawn_result,
    drop_endless,
    put_string,
    scales,
    stays,
    users,
)
from .variable_glyf import placed_by_points

log = logging.getLogger(__name__)

HINTS = ("cvt ", "cvar", "fpgm", "prep", "gasp", "hdmx", "VDMX", "LTSH", "TSI0", "TSI1", "TSI2", "TSI3", "TSI5", "TSIV")
"""Hints, which refer to points of the old outlines."""

ZONES = ("BlueValues", "OtherBlues", "FamilyBlues", "FamilyOtherBlues", "StdHW", "StdVW", "StemSnapH", "StemSnapV")
"""What hinters read of a font: heights, which outlines keep, and widths of stems. By itself it hints nothing."""

PICTURES = ("EBDT", "EBLC", "EBSC", "CBDT", "CBLC", "sbix", "SVG ", "bdat", "bloc")
"""Pictures of glyphs, which renderers prefer to outlines."""

SPENT = ("DSIG", "STAT", "MERG", "VORG")
"""A signature, names of axes, and values derived from the old outlines."""

TRADEMARK, STYLES, PREFIX = 7, (17, 2), 25
FAMILY, WITH_STYLE, POSTSCRIPT = (1, 16, 21), (3, 4, 18), (6, 20)
"""Numbers of names; ``PREFIX``: of the PostScript names of instances."""

DATE = 3_786_912_000
"""2024-01-01 in a font's seconds, for sources without a date: the bytes must not depend on the clock."""


@dataclass(frozen=True)
class FontSummary:
    """The facts of a written font.

    Attributes:
        family: the new name. replaced: number of glyphs with new outlines.
        largest_error: the largest of ``bounds``; None if there are none.
        beyond: names of the glyphs that are farther from the source than their tolerance.
        extrema: number of points added at extrema.
        bounds: by name, certified bounds of the glyphs' distances from the source, in both directions, in font units,
            as the font draws them. Of glyphs whose conversion measured their distance, and of composites of these.
    """

    family: str
    replaced: int
    largest_error: float | None
    beyond: tuple[str, ...]
    extrema: int
    bounds: Mapping[str, float] = field(default_factory=dict)


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
        GlyphsplineError: the source has no outlines, or is broken.
    """
    family = family or f"{source.family} Spline"
    promises, replaced, added = dict[int, Promise](), 0, 0
    with reusing(source.path, source.kind):
        font = base_tables(source)
        if "glyf" in font:
            drop_endless(font)
        in_place = ("glyf" if flavour == "ttf" else "CFF ") in font
        target = _InPlace(font, flavour) if in_place else _Rebuilt(font, source, flavour, family)
        for result in glyphs:
            allowed = result.options.tolerance_for(source.metrics.units_per_em) if tolerance is None else tolerance
            try:
                drawn = target.replace(result, allowed, extrema)
            except GlyphsplineError as error:
                log.warning("%s: not replaced", error)
                continue
            replaced += 1
            added += drawn.extrema
            if drawn.promise is not None:
                promises[target.gid(result.outline)] = drawn.promise
        followed = target.finish()
        rename(font, family, source.style)
        data = saved(font)
        if flavour == "otf" and _grew(font, data) and share_subroutines(font):
            data = saved(font)
        found = measured(source, data, promises, followed)
    return data, FontSummary(family, replaced, found.largest, tuple(found.beyond), added, found.bounds)


def measured(source: Source, data: bytes, promises: Mapping[int, Promise], followed: Sequence[int]) -> Held:
    """What a font's bytes hold of what was promised, by index.

    Composites of ``followed``, which are drawn with other components than before, are promised as much.
    """
    if not promises:
        return Held({}, ())
    allowed = max(each.tolerance for each in promises.values())
    others = source.outlines([gid for gid in followed if gid not in promises], errors="return")
    more = {each.gid: Promise(each, allowed) for each in others if isinstance(each, Outline)}
    return held(Font(source.path, data, 0, None), {**promises, **more})


class _InPlace:
    """New glyphs in a copy of the source's own table."""

    def __init__(self, font: TTFont, flavour: Flavour) -> None:
        self.font, self.flavour = font, flavour
        self.names: list[str] = font.getGlyphOrder()
        self.is_g2 = False
        self.new: dict[str, Any] = {}  # for "glyf", which is read until all glyphs are known
        if flavour == "otf":
            top = font["CFF "].cff.topDictIndex[0]
            self.strings = top.CharStrings
            fonts = [each.Private for each in getattr(top, "FDArray", [top])]
            zones = [{key: getattr(each, key, None) for key in ZONES} for each in fonts]
            try:
                font["CFF "].cff.remove_hints()
            except Exception:  # of a broken glyph, as in readers
                _empty_broken(self.strings)
                font["CFF "].cff.remove_hints()
            for private, values in zip(fonts, zones, strict=True):
                for key, value in values.items():
                    if value is not None:
                        setattr(private, key, value)

    def gid(self, outline: Outline) -> int:
        """The index of a glyph in the font."""
        return outline.gid

    def replace(self, result: GlyphResult, tolerance: float, extrema: bool) -> Drawn:
        name = self.names[result.outline.gid]
        self.is_g2 = self.is_g2 or result.options.is_for_fonts
        if stays(result, self.flavour):
            return Drawn(None, None, Promise(result.outline, tolerance))
        width = stored_width(self.font, name, self.strings[name].private) if self.flavour == "otf" else None
        drawn = drawn_result(result, tolerance, self.flavour, width, extrema, in_place=True)
        if self.flavour == "ttf":
            self.new[name] = drawn.data
        else:
            old = self.strings[name]
            drawn.data.private, drawn.data.globalSubrs = old.private, old.globalSubrs
            put_string(self.strings, name, drawn.data)
        set_bearings(self.font, name, drawn, result.outline)
        return drawn

    def finish(self) -> list[int]:
        """Store what follows; the indices of the composites that are drawn with new components."""
        if self.flavour != "ttf":
            self.font["CFF "].cff.remove_unused_subroutines()
            return []
        glyf = self.font["glyf"]
        touched = [name for name in users(self.font, self.new) if name not in self.new]
        counted = placed_by_points(self.font) if self.is_g2 else {}
        whole = [name for name in touched if not self.is_g2 or not self._follows(name, counted)]
        self.new |= {name: decomposed(glyf, name) for name in whole}
        lefts = {name: glyf[name].xMin for name in touched if name not in self.new}
        for name in self.names:
            if name not in self.new:
                glyf[name].removeHinting()
        for name, glyph in self.new.items():
            glyf[name] = glyph
        metrics = self.font["hmtx"].metrics
        for name, left in lefts.items():  # rasterisers place an outline by its left side bearing
            glyf[name].recalcBounds(glyf)
            metrics[name] = (metrics[name][0], metrics[name][1] + glyf[name].xMin - left)
        return [self.font.getGlyphID(name) for name in lefts]

    def _follows(self, name: str, counted: Mapping[str, str]) -> bool:
        """Whether a composite keeps its components: none is drawn larger than it is, nor placed by points."""
        parts = scales(self.font, name)
        return max(parts.values()) <= 1 + GRID and counted.keys().isdisjoint(parts)


def saved(font: TTFont) -> bytes:
    """The font as a file's bytes."""
    file = BytesIO()
    font.save(file, reorderTables=False)
    return file.getvalue()


def _grew(font: TTFont, data: bytes) -> bool:
    """Whether the char strings of a saved font take more than the source's, or the source has none."""
    before, after = font.reader, TTFont(BytesIO(data), lazy=True).reader
    return before is None or "CFF " not in before or after.tables["CFF "].length > before.tables["CFF "].length


def share_subroutines(font: TTFont) -> bool:
    """Store what char strings have in common once, as subroutines, by Adobe's ``tx``: new char strings have none.

    Those with decimals, which ``tx`` rounds to hundredths, are put back as they were, and share nothing. Returns
    whether ``tx`` could do it; if not, the font is not to be written.
    """
    tx, exact = need("fonts"), _with_decimals(font)
    try:
        tx.subroutinize(font)
    except tx.Error as error:
        log.warning("char strings share no subroutines: %s", error)
        return False
    strings = font["CFF "].cff.topDictIndex[0].CharStrings
    for name, drawing in exact.items():
        width = stored_width(font, name, strings[name].private)
        strings[name].setProgram([*([] if width is None else [width]), *drawing])
    return True


def _with_decimals(font: TTFont) -> dict[str, list[Any]]:
    """The char strings that have decimals, without subroutines and without their widths, by the names of the glyphs."""
    top = font["CFF "].cff.topDictIndex[0]
    privates = [each.Private for each in getattr(top, "FDArray", [top])]
    parts = [top.GlobalSubrs, *(each.Subrs for each in privates if hasattr(each, "Subrs")), top.CharStrings.values()]
    programs = [string for part in parts for string in part]
    for string in programs:
        string.decompile()
    if not any(map(has_decimals, programs)):
        return {}
    font["CFF "].cff.desubroutinize()
    found = {}
    for name in top.CharStrings.keys():  # noqa: SIM118 (CharStrings iterates by numbers)
        string = top.CharStrings[name]
        if has_decimals(string):
            extractor = T2WidthExtractor([], [], 0, math.inf)
            extractor.execute(string)
            found[name] = string.program[extractor.width < math.inf :]
    return found


def has_decimals(string: Any) -> bool:
    """Whether a number of a char string is not whole."""
    return any(isinstance(token, float) for token in string.program)


def stored_width(font: TTFont, name: str, private: Any) -> float | None:
    """The advance as a char string stores it: relative to the nominal width, or None for the default."""
    advance = font["hmtx"][name][0]
    return None if advance == private.defaultWidthX else advance - private.nominalWidthX


def _empty_broken(strings: Any) -> None:
    """Empty the glyphs of a CFF table that cannot be drawn."""
    for name in strings.keys():  # noqa: SIM118 (CharStrings iterates by numbers)
        try:
            strings[name].draw(NullPen())
        except Exception as error:  # as in readers
            log.warning("glyph %r cannot be drawn: %s: left empty in the written font", name, library_words(error))
            strings[name].setProgram(["endchar"])


class _Rebuilt:
    """All glyphs drawn again in the other format."""

    def __init__(self, font: TTFont, source: Source, flavour: Flavour, family: str) -> None:
        self.font, self.source, self.flavour, self.family = font, source, flavour, family
        self.of_name = stored_names(source, font)
        self.glyphs: dict[str, Any] = {}

    def gid(self, outline: Outline) -> int:
        """The index of a glyph in the font."""
        return int(self.font.getGlyphID(self.of_name[outline.name]))

    def replace(self, result: GlyphResult, tolerance: float, extrema: bool) -> Drawn:
        outline = result.outline
        drawn = drawn_result(result, tolerance, self.flavour, round(outline.advance), extrema)
        return self._put(drawn, outline)

    def _put(self, drawn: Drawn, outline: Outline) -> Drawn:
        name = self.of_name[outline.name]
        self.glyphs[name] = drawn.data
        set_bearings(self.font, name, drawn, outline)
        return drawn

    def finish(self) -> list[int]:
        """Draw all other glyphs; none of them follows those that were replaced."""
        for name in self.source.glyph_names:
            if self.of_name[name] not in self.glyphs:
                self._put(*self._drawn(name))
        if ".notdef" not in self.glyphs:
            empty = Outline(".notdef", advance=self.source.metrics.units_per_em / 2)
            self.of_name[".notdef"] = ".notdef"
            self._put(drawn_outline(empty, self.flavour), empty)
        become(self.font, self.flavour, {name: self.glyphs[name] for name in self.font.getGlyphOrder()}, self.family)
        return []

    def _drawn(self, name: str) -> tuple[Drawn, Outline]:
        """A glyph that was not converted."""
        try:
            outline = self.source.outline(name)
            return drawn_outline(outline, self.flavour), outline
        except GlyphsplineError as error:
            log.warning("%s: left empty in the written font", error)
            empty = Outline(name, metrics=self.source.metrics)
            return drawn_outline(empty, self.flavour), empty


def stored_names(source: Source, font: TTFont) -> dict[str, str]:
    """Names of the source's glyphs to those in the font, whose order is the source's if that is a font's."""
    if isinstance(source, Font):
        return dict(zip(source.glyph_names, font.getGlyphOrder(), strict=True))
    return storable_names(source)


def storable_names(source: Source) -> dict[str, str]:
    """Names of a source's glyphs, .notdef first, to those that tables of fonts have letters and room for."""
    names = dict.fromkeys([".notdef", *source.glyph_names])
    found, taken = dict[str, str](), set(names)
    for number, name in enumerate(names):
        code = min(source.unicodes.get(name, ()), default=None)
        new = f"glyph{number:05}" if code is None else f"uni{code:04X}" if code < 0x10000 else f"u{code:X}"
        fits = len(name) < 256 and all(letter <= "\xff" for letter in name)
        found[name] = name if fits else unused(new, taken)
    return found


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


def drop(font: TTFont, *tags: str) -> None:
    """Remove those of the tables that the font has."""
    for tag in tags:
        if tag in font:
            del font[tag]


def drop_signature(font: TTFont) -> None:
    """Remove a signature, which is of the bytes as they were."""
    if getattr(font.get("DSIG"), "signatureRecords", None):
        del font["DSIG"]


def base_tables(source: Source) -> TTFont:
    """The source's tables, static at its location; new tables without glyphs if the source is not a font."""
    if not isinstance(source, Font):
        return new_tables(source)
    font = source.tables()
    if "glyf" not in font and "CFF " not in font and "CFF2" not in font:
        raise FontError("has no outlines that could be replaced", font=str(source.path))
    if source.axes:
        from fontTools.varLib.instancer import instantiateVariableFont  # here and not above: it imports all of varLib

        at = {axis.tag: source.location.get(axis.tag, axis.default) for axis in source.axes}
        font = instantiateVariableFont(font, at, inplace=True)
    drop(font, *HINTS, *PICTURES, *SPENT)
    font.flavor = font.flavorData = None
    return font


def new_tables(source: Source) -> TTFont:
    """Names, metrics and characters of a UFO or of drawings. Kerning and features are not carried over."""
    given = source.metrics.units_per_em
    em = round(given)
    if not 16 <= em <= 16384 or em != given:
        raise FontError(f"an em of {given:g} units: a font has 16 to 16384", font=str(source.path))
    builder = FontBuilder(em, isTTF=True)
    builder.setupHead(unitsPerEm=em, created=DATE, modified=DATE)
    stored = storable_names(source)
    names = list(stored.values())
    builder.setupGlyphOrder(names)
    builder.setupCharacterMap({code: stored[name] for code, name in source.cmap.items()})
    ascender, descender = round(source.metrics.ascender), round(source.metrics.descender)
    builder.setupHorizontalMetrics(dict.fromkeys(names, (0, 0)))
    builder.setupHorizontalHeader(ascent=ascender, descent=descender)
    builder.setupNameTable({"familyName": source.family, "styleName": source.style})
    heights = {"sTypoAscender": ascender, "sTypoDescender": descender}
    builder.setupOS2(**heights, usWinAscent=max(ascender, 0), usWinDescent=max(-descender, 0))
    builder.setupPost()
    builder.font.recalcTimestamp = False
    return builder.font


def become(font: TTFont, flavour: Flavour, glyphs: dict[str, Any], family: str) -> None:
    """Replace all glyphs of the font, of either flavour, by ``glyphs``."""
    drop(font, "glyf", "loca", "CFF ", "CFF2")
    builder = FontBuilder(font=font)
    builder.isTTF = flavour == "ttf"
    builder.setupMaxp()
    post = font["post"]
    if flavour == "ttf":
        font.sfntVersion = "\0\1\0\0"
        font["maxp"].maxZones = 1  # no instructions, so no twilight zone
        builder.setupGlyf(glyphs, calcGlyphBounds=False)
        font["head"].glyphDataFormat = 0
        # A font of more glyphs than a table of names has room for keeps none, like its source.
        # Names of glyphs that ``post`` has room for besides the standard ones.
        post.formatType, post.extraNames, post.mapping = 2.0 if len(glyphs) <= 32767 - 257 else 3.0, [], {}
        post.glyphOrder = font.getGlyphOrder()
    else:
        builder.setupCFF(postscript(family), {"FamilyName": family, "FullName": family}, glyphs, {})
        post.formatType = 3.0


def rename(font: TTFont, family: str, style: str) -> None:
    """Replace the family name everywhere, so that the font is not taken for its source.

    Copyright and licence are kept; the trademark is removed.
    """
    if "name" not in font:
        font["name"] = newTable("name")
        font["name"].names = []
    names = font["name"]
    places = {(n.platformID, n.platEncID, n.langID) for n in names.names if n.nameID in (1, 2, 4, 6)} | {(3, 1, 0x409)}
    for name_id in (1, 2, 3, 4, 6, TRADEMARK, 16, 17, 18, 20, 21, 22, PREFIX):
        names.removeNames(nameID=name_id)
    regular = style if style in ("Regular", "Bold", "Italic", "Bold Italic") else "Regular"
    grouped = family if regular == style else f"{family} {style}"
    texts = {1: grouped, 2: regular, 3: f"{family} {style}", 4: f"{family} {style}", 6: postscript(f"{family}-{style}")}
    if grouped != family:
        texts |= {16: family, 17: style}
    for platform, encoding, language in sorted(places):
        if platform == 3 or family.isascii():
            for name_id, text in texts.items():
                names.setName(text, name_id, platform, encoding, language)
    if "CFF " in font:
        fonts = font["CFF "].cff
        fonts.fontNames = [texts[6]]
        top = fonts.topDictIndex[0]
        top.FamilyName, top.FullName = ascii_only(family), ascii_only(texts[4])
        top.rawDict.pop("Notice", None)


def replace_family(font: TTFont, family: str) -> None:
    """Replace the family name of a variable font in all names that have it, those of instances too; no trademark stays.

    Styles, and whatever else axes, instances and features are called, stay.
    """
    if "name" not in font:
        return
    names = font["name"]
    old = names.getBestFamilyName() or ""
    style = next((name for name in map(names.getDebugName, STYLES) if name), "Regular")
    names.removeNames(nameID=TRADEMARK)
    styles = dict.fromkeys((*WITH_STYLE, *POSTSCRIPT), style)
    for instance in font["fvar"].instances if "fvar" in font else ():
        if instance.postscriptNameID != 0xFFFF:
            styles[instance.postscriptNameID] = names.getDebugName(instance.subfamilyNameID) or style
    known = {*FAMILY, PREFIX, *styles}
    for record in [each for each in names.names if each.nameID in known]:
        text, identity = record.toUnicode(errors="replace"), record.nameID
        if identity in FAMILY:
            new = text.replace(old, family, 1) if old and old in text else family
        elif identity == PREFIX:
            new = postscript(family)
        elif identity in WITH_STYLE:
            new = text.replace(old, family, 1) if old and old in text else f"{family} {styles[identity]}"
        else:
            new = postscript(f"{family}-{styles[identity]}")
        names.setName(new, identity, record.platformID, record.platEncID, record.langID)


def postscript(name: str) -> str:
    """A PostScript name: at most 63 printable ASCII characters, none of them a bracket or a space."""
    return re.sub(r"[^!-~]|[\[\](){}<>/%]", "", name)[:63] or "Spline"


def ascii_only(text: str) -> str:
    """Text as a CFF table can hold it."""
    return text.encode("ascii", "ignore").decode().strip() or "Spline"
