"""Small fonts and UFOs of boxes, with any characters and what changes their glyphs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from fontTools.feaLib.builder import addOpenTypeFeaturesFromString
from fontTools.fontBuilder import FontBuilder
from fontTools.pens.ttGlyphPen import TTGlyphPen
from fontTools.ttLib.tables._c_m_a_p import CmapSubtable
from fontTools.ufoLib import UFOWriter

import glyphspline as gs
from glyphspline.readers import Source

HEAVY = "conditionset heavy { wght 700 900; } heavy; variation rvrn heavy { sub dollar by dollar.heavy; } rvrn;"
"""A feature: at and above 700 another glyph stands for the dollar."""


def box() -> Any:
    pen = TTGlyphPen(None)
    pen.moveTo((0, 0))
    for place in [(0, 500), (500, 500), (500, 0)]:
        pen.lineTo(place)
    pen.closePath()
    return pen.glyph()


def font_of(
    path: Path,
    cmap: dict[int, str],
    *others: str,
    features: str = "",
    weight: bool = False,
    selectors: list[tuple[int, int, str | None]] | None = None,
    table: tuple[int, int] | None = None,
    empty: str = "",
    location: dict[str, float] | None = None,
) -> gs.Font:
    """A font of boxes.

    Args:
        cmap: code point to glyph name. others: glyphs without one. weight: whether it has an axis, 400 to 900.
        selectors: base, selector and glyph of variations. table: platform and encoding of its only table of
            characters, in the place of Unicode. empty: a glyph without ink.
    """
    names = list(dict.fromkeys([".notdef", *cmap.values(), *others]))
    builder = FontBuilder(1000, isTTF=True)
    builder.setupGlyphOrder(names)
    builder.setupCharacterMap({} if table else cmap, uvs=selectors)
    if table:
        (only, *_) = builder.font["cmap"].tables = [CmapSubtable.newSubtable(0 if table[0] == 1 else 4)]
        only.platformID, only.platEncID, only.language, only.cmap = *table, 0, cmap
    builder.setupGlyf({name: TTGlyphPen(None).glyph() if name == empty else box() for name in names})
    builder.setupHorizontalMetrics(dict.fromkeys(names, (550, 0)))
    builder.setupHorizontalHeader(ascent=800, descent=-200)
    builder.setupNameTable({"familyName": "Asked", "styleName": "Regular"})
    builder.setupOS2()
    builder.setupPost()
    if weight:
        named = [{"location": {"wght": at}, "stylename": style} for at, style in ((400, "Regular"), (900, "Black"))]
        builder.setupFvar([("wght", 400, 400, 900, "Weight")], named)
        builder.setupGvar({name: [] for name in names})
    if features:
        addOpenTypeFeaturesFromString(builder.font, features)
    builder.save(path)
    return gs.open_font(path, location=location)


def ufo_of(path: Path, cmap: dict[int, str], *others: str, lib: dict[str, Any] | None = None) -> Source:
    """A UFO of boxes."""

    class Glyph:
        def __init__(self, codes: list[int]) -> None:
            self.width, self.unicodes = 500, codes

    def draw(pen: Any) -> None:
        pen.beginPath()
        for place in [(0, 0), (0, 500), (500, 500), (500, 0)]:
            pen.addPoint(place, "line")
        pen.endPath()

    writer = UFOWriter(path)
    glyphs = writer.getGlyphSet()
    for name in dict.fromkeys([*cmap.values(), *others]):
        glyphs.writeGlyph(name, Glyph([code for code, of in cmap.items() if of == name]), draw)
    glyphs.writeContents()
    writer.writeLayerContents(["public.default"])
    writer.writeLib(lib or {})
    return gs.open_source(path)
