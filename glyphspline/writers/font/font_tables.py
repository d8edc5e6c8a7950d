"""All tables but the outlines: those of the source at its location, or new ones; without hints, and renamed."""

from __future__ import annotations

import re
from typing import Any

from fontTools.fontBuilder import FontBuilder
from fontTools.ttLib import TTFont, newTable
from fontTools.varLib.instancer import instantiateVariableFont

from ...errors import FontError
from ...readers import Font, Source
from .font_glyphs import Flavour

HINTS = ("cvt ", "cvar", "fpgm", "prep", "gasp", "hdmx", "VDMX", "LTSH", "TSI0", "TSI1", "TSI2", "TSI3", "TSI5", "TSIV")
"""Hints, which refer to points of the old outlines."""

PICTURES = ("EBDT", "EBLC", "EBSC", "CBDT", "CBLC", "sbix", "SVG ", "bdat", "bloc")
"""Pictures of glyphs, which renderers prefer to outlines."""

SPENT = ("DSIG", "STAT", "MERG", "VORG")
"""A signature, names of axes, and values derived from the old outlines."""

DATE = 3_786_912_000
"""2024-01-01 in a font's seconds, for sources without a date: the bytes must not depend on the clock."""


def base_tables(source: Source) -> TTFont:
    """The source's tables, static at its location; new tables without glyphs if the source is not a font."""
    if not isinstance(source, Font):
        return new_tables(source)
    font = source.tables()
    if "glyf" not in font and "CFF " not in font and "CFF2" not in font:
        raise FontError("has no outlines that could be replaced", font=str(source.path))
    if source.axes:
        at = {axis.tag: source.location.get(axis.tag, axis.default) for axis in source.axes}
        font = instantiateVariableFont(font, at, inplace=True)
    for tag in (*HINTS, *PICTURES, *SPENT):
        if tag in font:
            del font[tag]
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
    names = list(source.glyph_names)
    if names[:1] != [".notdef"]:
        names = [".notdef", *(name for name in names if name != ".notdef")]
    builder.setupGlyphOrder(names)
    builder.setupCharacterMap(dict(source.cmap))
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
    for tag in ("glyf", "loca", "CFF ", "CFF2"):
        if tag in font:
            del font[tag]
    builder = FontBuilder(font=font)
    builder.isTTF = flavour == "ttf"
    builder.setupMaxp()
    post = font["post"]
    if flavour == "ttf":
        font.sfntVersion = "\0\1\0\0"
        font["maxp"].maxZones = 1  # no instructions, so no twilight zone
        builder.setupGlyf(glyphs, calcGlyphBounds=False)
        font["head"].glyphDataFormat = 0
        post.formatType, post.extraNames, post.mapping = 2.0, [], {}
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
    for name_id in (3, 7, 16, 17, 18, 20, 21, 22, 25):
        names.removeNames(nameID=name_id)
    regular = style if style in ("Regular", "Bold", "Italic", "Bold Italic") else "Regular"
    grouped = family if regular == style else f"{family} {style}"
    texts = {1: grouped, 2: regular, 3: f"{family} {style}", 4: f"{family} {style}", 6: postscript(f"{family}-{style}")}
    if grouped != family:
        texts |= {16: family, 17: style}
    places = {(n.platformID, n.platEncID, n.langID) for n in names.names if n.nameID in (1, 2, 4, 6)} | {(3, 1, 0x409)}
    for name_id in (1, 2, 4, 6):
        names.removeNames(nameID=name_id)
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


def postscript(name: str) -> str:
    """A PostScript name: at most 63 printable ASCII characters, none of them a bracket or a space."""
    return re.sub(r"[^!-~]|[\[\](){}<>/%]", "", name)[:63] or "Spline"


def ascii_only(text: str) -> str:
    """Text as a CFF table can hold it."""
    return text.encode("ascii", "ignore").decode().strip() or "Spline"
