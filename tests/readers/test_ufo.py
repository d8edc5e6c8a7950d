"""UFO sources as outlines, against the font they were made of."""

from __future__ import annotations

import pickle
import shutil
from pathlib import Path
from types import SimpleNamespace
from xml.etree.ElementTree import fromstring

import numpy as np
import pytest
from fontTools.ufoLib import UFOWriter

from glyphspline.errors import FontError, GlyphsplineError
from glyphspline.readers import Source, open_font, open_source
from glyphspline.readers.ufo import Ufo
from glyphspline.types import FloatArray
from tests.places import FONTS


class Drawn:
    """What ufoLib's writer takes: a width, code points, and a drawing."""

    def __init__(self, width: float, unicodes: tuple[int, ...] = ()) -> None:
        self.width, self.unicodes = width, list(unicodes)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A UFO of two glyphs of their own, a composite, and a part that is not exported."""
    path = tmp_path / "Small.ufo"
    writer = UFOWriter(path)

    class Info:
        familyName, styleName, unitsPerEm, ascender, descender = "Small", "Light", 2000, 1500, -500  # noqa: N815

    writer.writeInfo(Info())
    glyphs = writer.getGlyphSet()

    def square(pen: object, side: int = 400) -> None:
        pen.beginPath()  # type: ignore[attr-defined]
        for point in ((0, 0), (side, 0), (side, side), (0, side)):
            pen.addPoint(point, "line")  # type: ignore[attr-defined]
        pen.endPath()  # type: ignore[attr-defined]

    def composite(pen: object) -> None:
        pen.addComponent("_part", (2, 0, 0, 1, 100, 50))  # type: ignore[attr-defined]
        pen.addComponent("square", (1, 0, 0, 1, 0, 0))  # type: ignore[attr-defined]

    def curve(pen: object) -> None:
        pen.beginPath()  # type: ignore[attr-defined]
        pen.addPoint((0, 0), "curve", True)  # type: ignore[attr-defined]
        pen.addPoint((300, 0))  # type: ignore[attr-defined]
        pen.addPoint((300, 300))  # type: ignore[attr-defined]
        pen.addPoint((600, 300), "curve")  # type: ignore[attr-defined]
        pen.addPoint((900, 600), "qcurve")  # type: ignore[attr-defined]
        pen.endPath()  # type: ignore[attr-defined]

    glyphs.writeGlyph("square", Drawn(500, (0x41,)), square)
    glyphs.writeGlyph("_part", Drawn(300), lambda pen: square(pen, 100))
    glyphs.writeGlyph("pair", Drawn(700.5, (0x42, 0x43)), composite)
    glyphs.writeGlyph("alone", Drawn(0), composite)
    glyphs.writeGlyph("loop", Drawn(0), lambda pen: pen.addComponent("loop", (1, 0, 0, 1, 0, 0)))
    glyphs.writeGlyph("lost", Drawn(0), lambda pen: pen.addComponent("nowhere", (1, 0, 0, 1, 0, 0)))
    glyphs.writeGlyph("curves", Drawn(900), curve)
    glyphs.writeContents()
    writer.writeLib({"public.glyphOrder": ["pair", "gone", "square"], "public.skipExportGlyphs": ["_part", "alone"]})
    writer.writeLayerContents()
    return path


def test_mirrored_components_keep_their_ink(tmp_path: Path) -> None:
    """A square over its own mirror image is inked where they overlap; mirrored twice it is as it was."""
    writer = UFOWriter(tmp_path / "Mirror.ufo")
    glyphs = writer.getGlyphSet()

    def half(pen: object) -> None:
        pen.beginPath()  # type: ignore[attr-defined]
        for point in ((0, 0), (300, 0), (300, 200), (0, 200)):
            pen.addPoint(point, "line")  # type: ignore[attr-defined]
        pen.endPath()  # type: ignore[attr-defined]

    glyphs.writeGlyph("half", Drawn(500), half)
    glyphs.writeGlyph("turned", Drawn(500), lambda pen: pen.addComponent("half", (-1, 0, 0, 1, 500, 0)))
    glyphs.writeGlyph("again", Drawn(500), lambda pen: pen.addComponent("turned", (-1, 0, 0, 1, 500, 0)))
    glyphs.writeContents()
    writer.writeLayerContents()
    ufo = open_source(tmp_path / "Mirror.ufo")
    first, turned, again = (ufo.outline(name).contours[0].points for name in ("half", "turned", "again"))
    assert [signed_area(each) for each in (first, turned, again)] == [60000.0] * 3
    assert turned.min(axis=0).tolist() == [200, 0]
    assert again.tolist() == first.tolist()


def signed_area(points: FloatArray) -> float:
    x, y = points.T
    return float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) / 2)


def test_a_ufo_is_a_source(folder: Path) -> None:
    ufo: Source = open_source(folder)
    assert isinstance(ufo, Ufo)
    assert (ufo.family, ufo.style) == ("Small", "Light")
    assert (ufo.metrics.units_per_em, ufo.metrics.ascender, ufo.metrics.descender) == (2000, 1500, -500)
    assert ufo.glyph_names == ("pair", "square", "curves", "loop", "lost")
    assert ufo.cmap == {0x41: "square", 0x42: "pair", 0x43: "pair"}
    assert ufo.select(text="BAX") == ("pair", "square")
    assert ufo.select(text="X").missing == ("U+0058",)
    again = pickle.loads(pickle.dumps(ufo))
    assert again.sha256 == ufo.sha256
    (folder / "glyphs" / "square.glif").write_text((folder / "glyphs" / "square.glif").read_text() + "\n")
    assert Ufo.opened(folder).sha256 != ufo.sha256


def test_components_are_decomposed_those_of_skipped_glyphs_too(folder: Path) -> None:
    ufo = Ufo.opened(folder)
    pair = ufo.outline("pair")
    assert (pair.gid, pair.advance, pair.unicodes) == (0, 700.5, (0x42, 0x43))
    part, square = pair.contours
    assert sorted(map(tuple, part.points.tolist())) == [(100, 50), (100, 150), (300, 50), (300, 150)]
    np.testing.assert_array_equal(square.points, ufo.outline("square").contours[0].points)
    with pytest.raises(FontError, match="no such glyph"):
        ufo.outline("_part")


def test_cubics_and_quadratics_of_one_contour_are_kept_apart(folder: Path) -> None:
    (contour,) = Ufo.opened(folder).outline("curves").contours
    assert sorted(contour.degrees.tolist()) == [1, 1, 3]  # a qcurve without points off the curve is a line


def test_what_is_broken_is_named(folder: Path) -> None:
    ufo = Ufo.opened(folder)
    with pytest.raises(GlyphsplineError, match=r"Small\.ufo, glyph 'loop': components in a loop"):
        ufo.outline("loop")
    with pytest.raises(GlyphsplineError, match="'nowhere' does not exist"):
        ufo.outline("lost")
    (folder / "glyphs" / "square.glif").write_text("<glyph")
    with pytest.raises(GlyphsplineError, match="not well-formed"):
        Ufo.opened(folder).outline("square")


@pytest.mark.parametrize("file", ["glyphs/curves.glif", "fontinfo.plist", "glyphs/contents.plist"])
def test_entities_are_refused(folder: Path, file: str) -> None:
    text = (folder / file).read_text()
    declared = '<!DOCTYPE x [<!ENTITY laugh "ha">]>'
    head, _, body = text.partition("?>")
    (folder / file).write_text(
        head + "?>" + declared + body[body.index("<glyph") if "glif" in file else body.index("<plist") :]
    )
    with pytest.raises(GlyphsplineError, match="entities"):
        Ufo.opened(folder).outline("curves")


def test_a_glyph_outside_the_folder_is_refused(folder: Path) -> None:
    shutil.copy(folder / "glyphs" / "curves.glif", folder / "curves.glif")
    contents = folder / "glyphs" / "contents.plist"
    contents.write_text(contents.read_text().replace("curves.glif", "../curves.glif"))
    with pytest.raises(FontError, match="outside"):
        Ufo.opened(folder)


def test_folders_that_are_no_ufo(tmp_path: Path) -> None:
    with pytest.raises(FontError, match="nor a UFO"):
        open_source(tmp_path)
    (tmp_path / "metainfo.plist").write_text("nonsense")
    with pytest.raises(FontError, match="well-formed"):
        open_source(tmp_path)


def test_a_font_opened_through_open_source_is_the_font(tmp_path: Path) -> None:
    shutil.copy(FONTS / "variable.ttf", tmp_path / "font.svg")  # the name does not decide
    font = open_source(tmp_path / "font.svg", 0, {"wght": 700})
    assert font.location == {"wght": 700}
    assert font.glyph_names == open_font(FONTS / "variable.ttf").glyph_names


@pytest.mark.parametrize("text", ["<glyph", '<glyph name="square" format="2"><unicode hex="no"/></glyph>'])
def test_a_broken_glyph_costs_only_itself(folder: Path, text: str) -> None:
    before = Ufo.opened(folder).outline("curves")
    (folder / "glyphs" / "square.glif").write_text(text)
    ufo = Ufo.opened(folder)
    assert "square" in ufo.glyph_names
    np.testing.assert_array_equal(ufo.outline("curves").contours[0].points, before.contours[0].points)
    for broken in ("square", "pair"):  # which has it as a component
        with pytest.raises(GlyphsplineError, match=rf"Small\.ufo, glyph '{broken}': "):
            ufo.outline(broken)


BEGIN, END = '<?xml version="1.0"?>\n<glyph name="square" format="2">', "</glyph>"
A, D = '<unicode hex="0041"/>', '<unicode hex="44" />'


@pytest.mark.parametrize(
    ("inside", "codes"),
    [
        (f"{A}<outline/>{D}", "AD"),
        (f"<outline/>\n{D}\n<advance width='5'/>{A}", "DA"),
        (f"<!-- {A} -->{D}", "D"),
        (f"{D}<note><![CDATA[{A}]]></note>", "D"),
        (f"<note>&lt;unicode hex=\"41\"/> '{A[1:-1]}'</note>{D}", "D"),
        (f"<?tool {A}?>{D}", "D"),
        ("<unicode\n  hex = '41'></unicode>", "A"),
        ('<unicode hex="004&#x31;"/>', "A"),
        (f"{D}<lib><dict><key>unicodes</key><string>>{A[1:]}</string></dict></lib>", "D"),
        ("<unicodes hex='41'/>", ""),
    ],
)
@pytest.mark.parametrize("coding", ["utf-8", "utf-8-sig", "utf-16"])
def test_code_points_are_those_that_a_parser_finds(folder: Path, inside: str, codes: str, coding: str) -> None:
    document = (BEGIN + inside + END).encode(coding)
    (folder / "glyphs" / "square.glif").write_bytes(document)
    found = [chr(code) for code, name in Ufo.opened(folder).cmap.items() if name == "square"]
    assert found == list(codes) == [chr(int(each.get("hex", ""), 16)) for each in fromstring(document).iter("unicode")]


def test_components_are_those_that_a_parser_finds(folder: Path) -> None:
    assert Ufo.opened(folder).components() == {
        "pair": {"_part", "square"}, "alone": {"_part", "square"}, "loop": {"loop"}, "lost": {"nowhere"},
    }  # fmt: skip
    text = '<outline><component xScale=\'2\' base="curves"/><!-- <component base="no"/> --></outline>'
    (folder / "glyphs" / "square.glif").write_text(BEGIN + text + END)
    assert Ufo.opened(folder).components()["square"] == {"curves"}


@pytest.mark.parametrize("key", ["unitsPerEm", "ascender", "descender"])
def test_metrics_that_no_plist_can_hold_again_are_refused(folder: Path, key: str) -> None:
    UFOWriter(folder).writeInfo(SimpleNamespace(**{key: 1}))
    text = (folder / "fontinfo.plist").read_text()
    (folder / "fontinfo.plist").write_text(text.replace("<integer>1</integer>", f"<integer>{10**126}</integer>"))
    with pytest.raises(FontError, match="metrics that are too large"):
        open_source(folder)
