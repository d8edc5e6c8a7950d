"""The tables around the glyphs: those of the source at its location, or new ones, without hints and renamed."""

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
"""They belong to the old outlines' points."""

PICTURES = ("EBDT", "EBLC", "EBSC", "CBDT", "CBLC", "sbix", "SVG ", "bdat", "bloc")
"""Pictures of glyphs, which would be shown instead of the new outlines."""

SPENT = ("DSIG", "STAT", "MERG", "VORG")
"""A signature, names of axes, and what is derived from the old outlines."""

DATE = 3_786_912_000
"""2024-01-01 in a font's seconds, for fonts made from sources that have no date of their own: bytes must not vary."""


def base_tables(source: Source) -> TTFont:
    """The source's tables, static at its location; of a source that is no font, new ones with no glyphs."""
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
    em = round(source.metrics.units_per_em)
    if not 16 <= em <= 16384 or em != source.metrics.units_per_em:
        raise FontError(
            f"an em of {source.metrics.units_per_em:g} units: a font has 16 to 16384", font=str(source.path)
        )
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
    builder.setupOS2(
        sTypoAscender=ascender,
        sTypoDescender=descender,
        usWinAscent=max(ascender, 0),
        usWinDescent=max(-descender, 0),
    )
    builder.setupPost()
    builder.font.recalcTimestamp = False
    return builder.font


def become(font: TTFont, flavour: Flavour, glyphs: dict[str, Any], family: str) -> None:
    """Put a whole set of glyphs in the font's place for them, whatever kind it was."""
    for tag in ("glyf", "loca", "CFF ", "CFF2"):
        if tag in font:
            del font[tag]
    builder = FontBuilder(font=font)
    builder.isTTF = flavour == "ttf"
    if flavour == "ttf":
        font.sfntVersion = "\0\1\0\0"
        font["maxp"] = maxp = newTable("maxp")
        maxp.tableVersion, maxp.numGlyphs = 0x00010000, len(glyphs)
        for field in ("maxZones", "maxTwilightPoints", "maxStorage", "maxFunctionDefs", "maxInstructionDefs",
                      "maxStackElements", "maxSizeOfInstructions", "maxComponentElements", "maxComponentDepth",
                      "maxPoints", "maxContours", "maxCompositePoints", "maxCompositeContours"):  # fmt: skip
            setattr(maxp, field, 1 if field == "maxZones" else 0)
        builder.setupGlyf(glyphs, calcGlyphBounds=False)
        font["head"].glyphDataFormat = 0
    else:
        font["maxp"] = maxp = newTable("maxp")
        maxp.tableVersion, maxp.numGlyphs = 0x00005000, len(glyphs)
        builder.setupCFF(postscript(family), {"FamilyName": family, "FullName": family}, glyphs, {})
    post = font["post"]
    post.formatType = 2.0 if flavour == "ttf" else 3.0
    if flavour == "ttf":
        post.extraNames, post.mapping = [], {}
        post.glyphOrder = font.getGlyphOrder()


def rename(font: TTFont, family: str, style: str) -> None:
    """A new family name wherever the old one stands: a changed font must not pass for the one it came from.

    Copyright and licence stay; trademark goes.
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
