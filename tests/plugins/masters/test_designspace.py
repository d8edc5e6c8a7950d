"""Designspaces: masters in UFOs and their layers, interpolated as fontTools' model of variations does."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import pytest
from fontTools.designspaceLib import DesignSpaceDocument
from fontTools.ufoLib import UFOWriter

from glyphspline import FontError, GlyphsplineError, open_source
from glyphspline.plugins.fonts.back.back import NewGlyph, write_back
from glyphspline.plugins.masters.designspace import Designspace
from glyphspline.readers import Source
from glyphspline.readers.ufo import Ufo
from glyphspline.runs.font_search import find_fonts

Points: TypeAlias = Sequence[tuple[float, float]]


class Drawn:
    """What ufoLib's writer takes: a width, code points, and a drawing."""

    def __init__(self, width: float, unicodes: tuple[int, ...] = ()) -> None:
        self.width, self.unicodes = width, list(unicodes)


def lines(*points: tuple[float, float]) -> Callable[[Any], None]:
    def draw(pen: Any) -> None:
        pen.beginPath()
        for point in points:
            pen.addPoint(point, "line")
        pen.endPath()

    return draw


def components(*placed: tuple[str, tuple[float, ...]]) -> Callable[[Any], None]:
    def draw(pen: Any) -> None:
        for base, matrix in placed:
            pen.addComponent(base, matrix)

    return draw


def bowl(size: float) -> Callable[[Any], None]:
    """A cubic, a line that closes it, and a quadratic contour without points on the curve."""

    def draw(pen: Any) -> None:
        pen.beginPath()
        pen.addPoint((0, 0), "line")
        pen.addPoint((0, size))
        pen.addPoint((size, 2 * size))
        pen.addPoint((2 * size, size), "curve")
        pen.endPath()
        pen.beginPath()
        for point in ((0, 0), (size, 0), (size, size), (0, size)):
            pen.addPoint(point)
        pen.endPath()

    return draw


GlyphsOf: TypeAlias = Mapping[str, tuple[float, Callable[[Any], None]]]


def write_ufo(path: Path, style: str, layers: Mapping[str | None, GlyphsOf]) -> None:
    writer = UFOWriter(path)

    class Info:
        familyName, styleName, unitsPerEm, ascender, descender = "Space", style, 1000, 800, -200  # noqa: N815

    writer.writeInfo(Info())
    for layer, of_layer in layers.items():
        glyphs = writer.getGlyphSet(layer, defaultLayer=layer is None)
        for name, (width, draw) in of_layer.items():
            glyphs.writeGlyph(name, Drawn(width, (ord(name),) if len(name) == 1 else ()), draw)
        glyphs.writeContents()
    writer.writeLayerContents()
    writer.close()


def box(x: float, y: float) -> Callable[[Any], None]:
    return lines((0, 0), (x, 0), (x, y), (0, y))


@pytest.fixture
def space(tmp_path: Path) -> Path:
    """Weights 100 to 900 at stems 20, 80 and 200; widths 75 to 100. A layer has the box at stem 140."""
    light = {"o": (500.0, box(20, 700)), "i": (300.0, components(("o", (1, 0, 0, 1, 5, 0)))), "c": (400.0, bowl(100))}
    regular = {
        "o": (520.0, box(80, 700)),
        "i": (310.0, components(("o", (1, 0, 0, 1, 10, 7)))),
        "c": (410.0, bowl(130)),
    }
    bold = {"o": (600.0, box(200, 720)), "i": (330.0, components(("o", (1, 0, 0, 1, 40, 9)))), "c": (450.0, bowl(190))}
    narrow = {"o": (420.0, box(60, 700)), "i": (300.0, components(("o", (1, 0, 0, 1, 2, 7))))}
    write_ufo(tmp_path / "Light.ufo", "Light", {None: light})
    write_ufo(tmp_path / "Regular.ufo", "Regular", {None: regular})
    write_ufo(tmp_path / "Bold.ufo", "Bold", {None: bold, "brace": {"o": (570.0, box(160, 710))}})
    write_ufo(tmp_path / "Narrow.ufo", "Narrow", {None: narrow})
    document = DesignSpaceDocument()
    document.addAxisDescriptor(
        tag="wght",
        name="Weight",
        minimum=100,
        default=400,
        maximum=900,
        map=[(100, 20), (400, 80), (700, 140), (900, 200)],
    )
    document.addAxisDescriptor(tag="wdth", name="Width", minimum=75, default=100, maximum=100)
    for file, stem, width, layer in (
        ("Light", 20, 100, None),
        ("Regular", 80, 100, None),
        ("Bold", 200, 100, None),
        ("Bold", 140, 100, "brace"),
        ("Narrow", 80, 75, None),
    ):
        document.addSourceDescriptor(
            path=str(tmp_path / f"{file}.ufo"),
            styleName=file,
            layerName=layer,
            location={"Weight": stem, "Width": width},
        )
    document.addInstanceDescriptor(name="Semi", designLocation={"Weight": 140, "Width": 100})
    document.write(tmp_path / "Space.designspace")
    return tmp_path / "Space.designspace"


def corners(source: Source, name: str) -> Any:
    return source.outline(name).contours[0].points.tolist()


def test_a_designspace_is_a_source(space: Path) -> None:
    source = open_source(space)
    assert isinstance(source, Designspace)
    assert repr(source) == (
        "<Designspace 'Space Regular' from 'Space.designspace': 3 glyphs, 3 characters, 1000 units per em>"
    )
    assert source.select(text="oi") == ("o", "i")
    assert corners(source, "o") == [[0, 0], [80, 0], [80, 700], [0, 700]]
    assert source.outline("o").advance == 520
    again = pickle.loads(pickle.dumps(open_source(space, location={"wght": 900})))
    assert corners(again, "o") == [[0, 0], [200, 0], [200, 720], [0, 720]]
    assert again.sha256 == source.sha256


def test_every_master_is_what_its_ufo_draws(space: Path) -> None:
    for file, location in (
        ("Light", {"wght": 100}),
        ("Regular", {}),
        ("Bold", {"wght": 900}),
        ("Narrow", {"wdth": 75}),
    ):
        source, ufo = open_source(space, location=location), open_source(space.with_name(f"{file}.ufo"))
        for name in ufo.glyph_names:
            outline, expected = source.outline(name), ufo.outline(name)
            assert outline.advance == pytest.approx(expected.advance)
            for contour, other in zip(outline.contours, expected.contours, strict=True):
                assert contour.degrees.tolist() == other.degrees.tolist()
                assert np.abs(contour.points - other.points).max() < 1e-9


def test_a_layer_is_a_master_of_the_glyphs_in_it(space: Path) -> None:
    source = open_source(space)
    masters = source.masters("o")
    assert len(masters) == 5
    assert masters.normalised({"wght": 700}).tolist() == [0.5, 0]
    assert masters.instance({"wght": 700}).contours[0].points.tolist() == [[0, 0], [160, 0], [160, 710], [0, 710]]
    assert len(source.masters("c")) == 3
    assert masters.axes[0].user(0.25) == 550


def test_a_glyph_that_only_the_default_master_draws(space: Path) -> None:
    change(space, "Regular", "p", box(30, 40))
    source = open_source(space)
    assert len(source.masters("p")) == 1
    assert corners(source, "p") == [[0, 0], [30, 0], [30, 40], [0, 40]]


def test_a_component_keeps_the_masters_that_the_glyph_has_not(space: Path) -> None:
    source = open_source(space)
    masters = source.masters("i")
    assert len(masters) == 5
    points = masters.instance({"wght": 700}).contours[0].points  # offset halfway from (10, 7) to (40, 9)
    assert points.tolist() == [[25, 8], [185, 8], [185, 718], [25, 718]]


def test_mirrored_components_keep_their_ink_in_all_masters(space: Path) -> None:
    """They have the points that they have in a UFO, and run as they did before they were mirrored."""
    for style in ("Light", "Regular", "Bold", "Narrow"):
        change(space, style, "m", components(("c", (-1, 0, 0, 1, 500, 0))))
        change(space, style, "w", components(("m", (1, 0, 0, -1, 0, 90))))
    source, ufo = open_source(space), open_source(space.with_name("Regular.ufo"))
    for name in ("m", "w"):
        drawn = ufo.outline(name).contours
        for contour, expected in zip(source.outline(name).contours, drawn, strict=True):
            assert sorted(contour.points.tolist()) == sorted(expected.points.tolist())
            assert polygon_area(contour.points) == pytest.approx(polygon_area(expected.points))
    areas = [[polygon_area(each.points) for each in source.outline(name).contours] for name in "cmw"]
    assert np.sign(areas[0]).tolist() == np.sign(areas[1]).tolist() == np.sign(areas[2]).tolist()


def polygon_area(points: Any) -> float:
    x, y = np.transpose(points)
    return float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) / 2)


def test_a_named_instance_is_a_location(space: Path) -> None:
    assert corners(open_source(space, location="semi"), "o")[2] == [160, 710]


def test_contours_of_all_kinds_of_segments_close(space: Path) -> None:
    masters = open_source(space).masters("c")
    assert [contour.degrees.tolist() for contour in masters.contours] == [[3, 1], [2, 2, 2, 2]]
    assert masters.weights({"wght": 900}).tolist() == [0, 0, 1]


def change(space: Path, file: str, name: str, draw: Callable[[Any], None]) -> None:
    from fontTools.ufoLib.glifLib import GlyphSet

    glyphs = GlyphSet(space.with_name(f"{file}.ufo") / "glyphs")
    glyphs.writeGlyph(name, Drawn(500), draw)
    glyphs.writeContents()


def test_own_contours_are_numbered_as_in_the_file(space: Path) -> None:
    """One without points, a component, one that encloses nothing, and a box, whose number is that of the outline."""

    def draw(pen: Any) -> None:
        for part in (lines(), components(("o", (1, 0, 0, 1, 5, 0))), lines((0, 0), (9, 9)), box(30, 40)):
            part(pen)

    for file in ("Light", "Regular", "Bold"):
        change(space, file, "c", draw)
    for path in (space, space.with_name("Regular.ufo")):
        source = open_source(path)
        assert isinstance(source, Ufo | Designspace)
        assert source.own_contours("c") == [None, None, 1]
        assert len(source.outline("c").contours) == 2
        assert source.own_contours("o") == [0]
        assert source.own_contours("i") == []
        assert [each.layer for each in source.drawings("c")] == [None] * (3 if path == space else 1)


@pytest.mark.parametrize(
    ("draw", "words"),
    [
        (lines((0, 0), (1, 0), (1, 1)), "contour 0: master 'Bold' is unlike 'Regular': 3 segments, not 4"),
        (bowl(10), "master 'Bold' has 2 contours and components, not 1 as 'Regular'"),
        (components(("c", (1, 0, 0, 1, 0, 0))), "contour 0: master 'Bold' has component 'c', 'Regular' has a contour"),
    ],
)
def test_unlike_masters_are_named(space: Path, draw: Callable[[Any], None], words: str) -> None:
    change(space, "Bold", "o", draw)
    with pytest.raises(GlyphsplineError) as raised:
        open_source(space).masters("o")
    assert str(raised.value).startswith(f"{space}, glyph 'o'")
    assert str(raised.value).endswith(words)


def test_a_curve_in_place_of_a_line_is_named(space: Path) -> None:
    def draw(pen: Any) -> None:
        pen.beginPath()
        for point, kind in (((0, 0), "line"), ((9, 0), "line"), ((9, 5), None), ((9, 7), None), ((9, 9), "curve")):
            pen.addPoint(point, kind)
        pen.addPoint((0, 9), "line")
        pen.endPath()

    change(space, "Light", "o", draw)
    with pytest.raises(GlyphsplineError, match="'Light' is unlike 'Regular': segment 1 is a cubic, not a line"):
        open_source(space).masters("o")


def test_a_glyph_without_a_default_master_is_named(space: Path) -> None:
    (space.with_name("Regular.ufo") / "glyphs" / "c.glif").unlink()
    document = DesignSpaceDocument.fromfile(space)
    document.sources = [source for source in document.sources if source.layerName is None]
    contents = space.with_name("Regular.ufo") / "glyphs" / "contents.plist"
    contents.write_text(contents.read_text().replace("<key>c</key>", "").replace("<string>c.glif</string>", ""))
    change(space, "Regular", "k", components(("c", (1, 0, 0, 1, 0, 0))))
    contents.write_text(contents.read_text().replace("</dict>", "<key>k</key><string>k.glif</string></dict>"))
    with pytest.raises(GlyphsplineError, match=r"glyph 'k': its masters \(Light, Bold\) are not one default"):
        open_source(space).masters("k")


def test_what_is_no_designspace(space: Path, tmp_path: Path) -> None:
    with pytest.raises(FontError, match="no axis 'opsz': it has wght, wdth"):
        open_source(space, location={"opsz": 12})
    broken = tmp_path / "broken.designspace"
    broken.write_text("<designspace format='5.0'><axes>")
    with pytest.raises(FontError, match=r"broken\.designspace: not well-formed XML"):
        open_source(broken)
    text = space.read_text()
    broken.write_text(text.replace("Bold.ufo", "Gone.ufo"))
    with pytest.raises(FontError, match=r"Gone\.ufo"):
        open_source(broken)
    broken.write_text(text.replace('layer="brace"', 'layer="none"'))
    with pytest.raises(FontError, match="no layer 'none'"):
        open_source(broken)
    broken.write_text(
        text.replace("<?xml", "<!DOCTYPE a [<!ENTITY b 'c'>]><?xml", 1).replace(
            "<?xml version='1.0' encoding='UTF-8'?>", ""
        )
    )
    with pytest.raises(FontError, match="entities"):
        Designspace.opened(broken)


GLYPHS = """{
.appVersion = "3208";
.formatVersion = 3;
axes = ({ name = Weight; tag = wght; });
familyName = Strokes;
fontMaster = (
{ axesValues = (20); id = m01; metricValues = ({ pos = 800; }, { pos = -200; }); name = Light; },
{ axesValues = (200); id = m02; metricValues = ({ pos = 800; }, { pos = -200; }); name = Bold; }
);
glyphs = (
{
glyphname = o;
layers = (
{ layerId = m01; shapes = ({ closed = 1; nodes = ((0,0,l),(20,0,l),(20,700,l),(0,700,l)); }); width = 500; },
{ layerId = m02; shapes = ({ closed = 1; nodes = ((0,0,l),(200,0,l),(200,720,l),(0,720,l)); }); width = 600; }
);
unicode = 111;
}
);
instances = (
{ axesValues = (20); name = Light; weightClass = 300; },
{ axesValues = (200); name = Bold; weightClass = 700; }
);
metrics = ({ type = ascender; }, { type = descender; });
unitsPerEm = 1000;
}
"""


def test_a_glyphs_file_is_a_designspace(tmp_path: Path) -> None:
    pytest.importorskip("glyphsLib")
    pytest.importorskip("ufo2ft")
    path = tmp_path / "strokes.glyphs"
    path.write_text(GLYPHS)
    source = open_source(path, location={"wght": 500})
    assert source.format == "Glyphs"
    assert source.select(text="o") == ("o",)
    assert source.outline("o").contours[0].points[:, 0].max() == pytest.approx(110)
    assert len(source.masters("o")) == 2
    again = pickle.loads(pickle.dumps(source))
    assert again.sha256 == source.sha256
    assert corners(again, "o") == corners(source, "o")
    path.write_text("{ .appVersion = ")
    with pytest.raises(FontError, match=r"strokes\.glyphs: a broken Glyphs file"):
        open_source(path)


def test_a_glyphs_package_is_its_file_in_parts(tmp_path: Path) -> None:
    pytest.importorskip("glyphsLib")
    pytest.importorskip("ufo2ft")
    plist = pytest.importorskip("openstep_plist")
    (tmp_path / "strokes.glyphs").write_text(GLYPHS)
    whole, package = open_source(tmp_path / "strokes.glyphs"), tmp_path / "strokes.glyphspackage"
    (package / "glyphs").mkdir(parents=True)
    parts = plist.loads(GLYPHS, use_numbers=True)
    glyphs = parts.pop("glyphs")
    (package / "fontinfo.plist").write_text(plist.dumps(parts))
    (package / "order.plist").write_text(plist.dumps([glyph["glyphname"] for glyph in glyphs]))
    for glyph in glyphs:
        (package / "glyphs" / f"{glyph['glyphname']}.glyph").write_text(plist.dumps(glyph))
    assert find_fonts([str(package)]) == [package]
    source = open_source(package)
    assert isinstance(source, Designspace)
    assert source.glyph_names == whole.glyph_names
    assert corners(source, "o") == corners(whole, "o")
    before = source.sha256
    (package / "order.plist").write_text("()")
    assert open_source(package).sha256 != before
    with pytest.raises(FontError, match=r"strokes\.glyphspackage: a Glyphs package takes no outlines back"):
        write_back(source, [], 0)


CORNER = """{
.appVersion = "3260";
.formatVersion = 3;
familyName = Serifs;
fontMaster = ({ id = m01; name = Regular; });
glyphs = (
{
glyphname = I;
layers = ({
hints = ({ name = _corner.serif; origin = (0,0); type = Corner; });
layerId = m01;
shapes = ({ closed = 1; nodes = ((0,0,l),(100,0,l),(100,700,l),(0,700,l)); });
width = 600;
});
unicode = 73;
},
{
glyphname = H;
layers = ({
hints = ({ name = _cap.round; origin = (0,0); type = Cap; });
layerId = m01;
shapes = ({ closed = 1; nodes = ((0,0,l),(100,0,l),(100,700,l),(0,700,l)); });
width = 600;
});
unicode = 72;
},
{
glyphname = Hbar;
layers = ({ layerId = m01; shapes = ({ ref = H; }, { pos = (300,0); ref = I; }); width = 600; });
},
{
glyphname = Ibar;
layers = ({ layerId = m01; shapes = ({ ref = I; }, { ref = gone; }); width = 600; });
},
{
glyphname = _corner.serif;
layers = ({
layerId = m01;
shapes = ({ closed = 0; nodes = ((0,60,l),(-60,20,l),(-60,0,l),(30,0,l)); });
width = 600;
});
}
);
unitsPerEm = 1000;
}
"""


def test_corner_components_are_applied_and_caps_are_named(tmp_path: Path) -> None:
    """A stem gets a serif at its first node; what is then drawn does not go back, as it would be applied twice."""
    pytest.importorskip("glyphsLib")
    pytest.importorskip("ufo2ft")
    path = tmp_path / "serifs.glyphs"
    path.write_text(CORNER)
    source = open_source(path)
    assert isinstance(source, Designspace)
    serif = [[0, 60], [-60, 20], [-60, 0], [30, 0]]
    assert corners(source, "H") == [[0, 700], [0, 0], [100, 0], [100, 700]]
    assert corners(source, "I") == [[0, 700], *serif, [100, 0], [100, 700]]
    assert [source.outline(name).unread for name in "HI"] == [("cap components",), ()]
    assert [source.masters(name).unread for name in "HI"] == [("cap components",), ()]
    assert source.outline("Hbar").unread == ("cap components",)
    with pytest.raises(GlyphsplineError, match=r"'Ibar': component 'gone' does not exist"):
        source.outline("Ibar")
    new = [NewGlyph(name, [source.outline(name).contours], source.drawings(name)) for name in "I"]
    found = write_back(source, new, 0, dry=True)
    assert not found.names
    assert "corner components" in found.kept["I"]
