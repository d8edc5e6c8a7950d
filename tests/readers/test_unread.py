"""Glyphs whose ink is where nothing is read: they say so, and the run that meets them ends with status 1."""

from __future__ import annotations

from collections.abc import Callable
from io import BytesIO
from pathlib import Path

import pytest
from fontTools.colorLib.builder import buildCOLR
from fontTools.fontBuilder import FontBuilder
from fontTools.misc import sstruct
from fontTools.pens.t2CharStringPen import T2CharStringPen
from fontTools.pens.ttGlyphPen import TTGlyphPen
from fontTools.ttLib import newTable
from fontTools.ttLib.tables.BitmapGlyphMetrics import smallGlyphMetricsFormat
from fontTools.ttLib.tables.E_B_L_C_ import sbitLineMetricsFormat
from fontTools.ttLib.tables.S_V_G_ import SVGDocument
from typer.testing import CliRunner

import glyphspline as gs
from glyphspline.cli.app import app

NAMES = [".notdef", "space", "A", "B"]


def square(pen: TTGlyphPen | T2CharStringPen) -> None:
    """Draw one."""
    pen.moveTo((0, 0))
    for to in ((0, 500), (500, 500), (500, 0)):
        pen.lineTo(to)
    pen.closePath()


def with_table(path: Path, add: Callable[[FontBuilder], None], cff: bool) -> Path:
    """A font whose A has no contours, and whose B is a square."""
    builder = FontBuilder(1000, isTTF=not cff)
    builder.setupGlyphOrder(NAMES)
    builder.setupCharacterMap({0x20: "space", 0x41: "A", 0x42: "B"})
    pens = {name: T2CharStringPen(500, None) if cff else TTGlyphPen(None) for name in NAMES}
    square(pens["B"])
    if cff:
        builder.setupCFF("T", {}, {name: pen.getCharString() for name, pen in pens.items()}, {})
    else:
        builder.setupGlyf({name: pen.glyph() for name, pen in pens.items()})
    builder.setupHorizontalMetrics(dict.fromkeys(NAMES, (500, 0)))
    builder.setupHorizontalHeader(ascent=800, descent=-200)
    builder.setupNameTable({"familyName": "T", "styleName": "Regular"})
    builder.setupOS2()
    builder.setupPost()
    add(builder)
    builder.save(path)
    return path


def drawings(builder: FontBuilder) -> None:
    """A drawing of A."""
    table = builder.font["SVG "] = newTable("SVG ")
    text = '<svg xmlns="http://www.w3.org/2000/svg"><path id="glyph2" d="M0 0H500V-500Z"/></svg>'
    table.docList = [SVGDocument(text, 2, 2, False)]


def layers(builder: FontBuilder) -> None:
    """A layer of A, which is B."""
    builder.font["COLR"] = buildCOLR({"A": [("B", 0xFFFF)]})


def pixels(builder: FontBuilder) -> None:
    """Bitmaps of A, which is full, and of the space, which is empty."""
    line = "".join([f'<{name} value="0"/>' for name in sstruct.getformat(sbitLineMetricsFormat)[1]])
    lines = "".join([f'<sbitLineMetrics direction="{each}">{line}</sbitLineMetrics>' for each in ("hori", "vert")])
    size = {"colorRef": 0, "startGlyphIndex": 1, "endGlyphIndex": 2, "ppemX": 8, "ppemY": 8, "bitDepth": 1, "flags": 1}
    sizes = "".join([f'<{name} value="{value}"/>' for name, value in size.items()])
    small = "".join([f'<{name} value="8"/>' for name in sstruct.getformat(smallGlyphMetricsFormat)[1]])
    kind, metrics = "ebdt_bitmap_format_1", f"<SmallGlyphMetrics>{small}</SmallGlyphMetrics>"
    bitmaps = "".join(
        [
            f'<{kind} name="{name}">{metrics}<rawimagedata>{8 * row}</rawimagedata></{kind}>'
            for name, row in (("space", "00"), ("A", "ff"))
        ]
    )
    index = '<glyphLoc name="space"/><glyphLoc name="A"/>'
    kind = "eblc_index_sub_table_1"
    text = f"""<ttFont>
    <EBDT><header version="2.0"/><strikedata index="0">{bitmaps}</strikedata></EBDT>
    <EBLC><header version="2.0"/><strike index="0"><bitmapSizeTable>{lines}{sizes}</bitmapSizeTable>
    <{kind} imageFormat="1" firstGlyphIndex="1" lastGlyphIndex="2">{index}</{kind}></strike></EBLC></ttFont>"""
    builder.font.importXML(BytesIO(text.encode()))


@pytest.mark.parametrize("cff", [False, True])
@pytest.mark.parametrize(("add", "table"), [(drawings, "SVG"), (layers, "COLR"), (pixels, "EBDT")])
def test_an_empty_glyph_says_which_table_its_ink_is_in(
    tmp_path: Path, add: Callable[[FontBuilder], None], table: str, cff: bool
) -> None:
    font = gs.open_font(with_table(tmp_path / "font.ttf", add, cff))
    assert font.outline("A").unread == (f"its ink is in the {table} table, which is not read",)
    assert font.outline("B").unread == font.outline("space").unread == ()


def test_a_run_says_it_and_ends_with_1(tmp_path: Path) -> None:
    font = with_table(tmp_path / "font.ttf", drawings, False)
    words = ["--step", "100", "--format", "svg", "--jobs", "0"]
    done = CliRunner().invoke(app, ["convert", str(font), "--text", "AB", "--out", str(tmp_path / "a"), *words])
    assert done.exit_code == 1
    assert "not read of A: its ink is in the SVG table" in done.output
    done = CliRunner().invoke(app, ["convert", str(font), "--text", "B ", "--out", str(tmp_path / "b"), *words])
    assert done.exit_code == 0
