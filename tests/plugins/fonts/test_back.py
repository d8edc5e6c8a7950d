"""Outlines back into UFOs, designspaces and Glyphs files: only points of contours change."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import glyphspline as gs
from glyphspline.errors import GlyphsplineError
from glyphspline.plugins.fonts.back.glif import Glif
from glyphspline.plugins.fonts.back.nodes import Node, replaced
from glyphspline.plugins.fonts.extrema import with_extrema
from glyphspline.plugins.fonts.spec import RefitSpec
from glyphspline.plugins.masters.job import convert_font_masters
from glyphspline.readers import open_source
from glyphspline.readers.ufo import Ufo
from glyphspline.runs.convert import convert_font
from glyphspline.runs.schedule import workers
from tests.drawings import circle
from tests.places import FONTS

ufoLib2 = pytest.importorskip("ufoLib2")  # noqa: N816

SHARP = gs.Options(corners="sharp")


def ufo_at(path: Path, stretch: float = 1.0) -> Path:
    """A UFO with everything in it: an o of 24 arcs, a d that has a point with a name, an i without curves."""
    font = ufoLib2.Font()
    font.info.familyName, font.info.styleName, font.info.unitsPerEm = "Mine", f"{stretch:g}", 1000
    font.info.ascender, font.info.descender, font.info.openTypeOS2TypoLineGap = 800, -200, 33
    for name, radius in (("o", 250), ("d", 200)):
        glyph = font.newGlyph(name)
        glyph.width, glyph.unicodes = 600, [ord(name)]
        pen = glyph.getPen()
        for k, segment in enumerate(circle(radius, 24, centre=(300, 250))):
            points = [(round(stretch * x), round(y)) for x, y in segment.tolist()]
            if k == 0:
                pen.moveTo(points[0])
            pen.curveTo(*points[1:])
        pen.closePath()
        glyph.lib["my.hint"] = "keep"
    font["d"].contours[0].points[2].name = "hr00"
    box = font.newGlyph("i")
    box.unicodes = [ord("i")]
    pen = box.getPen()
    for k, point in enumerate(((0, 0), (round(80 * stretch), 0), (round(80 * stretch), 700), (0, 700))):
        (pen.lineTo if k else pen.moveTo)(point)
    pen.closePath()
    both = font.newGlyph("oi")
    both.getPen().addComponent("i", (1, 0, 0, 1, -90, 0))
    for contour in font["o"].contours:
        both.appendContour(contour)
    font["o"].appendAnchor({"name": "top", "x": 300, "y": 520})
    font["o"].guidelines = [{"x": 10, "y": 0, "angle": 90}]
    font.kerning[("o", "i")], font.groups["public.kern1.o"] = -20, ["o"]
    font.features.text, font.lib["my.key"], font.data["me/x.txt"] = "# features\n", {"x": 1}, b"data"
    font.newLayer("sketch").newGlyph("o").width = 3
    font.save(path)
    return path


def family(folder: Path) -> Path:
    """A designspace of two such UFOs."""
    from fontTools.designspaceLib import DesignSpaceDocument

    document = DesignSpaceDocument()
    document.addAxisDescriptor(tag="wght", name="Weight", minimum=400, default=400, maximum=700)
    for name, weight, stretch in (("Regular", 400, 1.0), ("Bold", 700, 1.2)):
        path = ufo_at(folder / f"{name}.ufo", stretch)
        document.addSourceDescriptor(path=str(path), styleName=name, familyName="Mine", location={"Weight": weight})
    document.write(folder / "Mine.designspace")
    return folder / "Mine.designspace"


def glyphs_file(version: int) -> Callable[[Path], Path]:
    """A maker of the same as a Glyphs file."""

    def make(folder: Path) -> Path:
        import glyphsLib
        from fontTools.designspaceLib import DesignSpaceDocument

        font = glyphsLib.to_glyphs(DesignSpaceDocument.fromfile(family(folder)))
        font.format_version = version
        font.save(str(folder / "Mine.glyphs"))
        return folder / "Mine.glyphs"

    return make


def files(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def without_points(data: bytes) -> bytes:
    return re.sub(rb"\s*<point [^>]*/>", b"", data)


def run(path: Path, out: Path, spec: RefitSpec) -> list[str]:
    source = open_source(path)
    if not source.axes:
        return convert_font(source, source.glyph_names, out, spec, jobs=0).remarks
    with workers(0, 60.0, (), 0) as pool:
        return convert_font_masters([source], source.glyph_names, out, spec, pool).remarks


def test_in_place_only_points_of_fitted_contours_change(tmp_path: Path) -> None:
    path = ufo_at(tmp_path / "My.ufo")
    before, source = files(path), Ufo.opened(path)
    old = {name: source.outline(name) for name in source.glyph_names}
    remarks = run(path, tmp_path / "out", RefitSpec(SHARP, in_place=True))
    after, now = files(path), Ufo.opened(path)
    assert before.keys() == after.keys()
    assert {name for name in before if before[name] != after[name]} == {"glyphs/o.glif", "glyphs/oi.glif"}
    for name in ("glyphs/o.glif", "glyphs/oi.glif"):
        assert without_points(before[name]) == without_points(after[name])
    for name in ("o", "oi"):
        outline = now.outline(name)
        for was, contour in zip(old[name].contours, outline.contours, strict=True):
            assert len(contour) <= len(was)
            if len(was) > 4:
                assert len(contour) < 12
                radii = np.hypot(*(contour.at(np.arange(0, len(contour), 0.1)) - (300, 250)).T)
                assert np.abs(radii - 250).max() < 1.6  # the source is rounded to whole units
    words = r"My.ufo: new outlines of 2 glyphs, C2 \(--continuity g2: fewer points\): points (\d+) → (\d+); nothing.*"
    found = re.fullmatch(words, remarks[0])
    assert found
    points = [int(number) for number in found.groups()]
    counts = [sum(part[f"glyphs/{name}.glif"].count(b"<point ") for name in ("o", "oi")) for part in (before, after)]
    assert points[1] < points[0] <= counts[0]
    assert points[1] - points[0] == counts[1] - counts[0]
    assert re.fullmatch(r"d: contour 0 would lose the point at \d+ \d+, which something refers to.*", remarks[1])


def test_a_layer_has_the_new_outlines_beside_the_old(tmp_path: Path) -> None:
    path = ufo_at(tmp_path / "My.ufo")
    before = files(path)
    spec = RefitSpec(SHARP, layer="glyphspline")
    run(path, tmp_path / "out", spec)
    after = files(path)
    added = {name for name in after if name not in before}
    assert added == {f"glyphs.glyphspline/{name}" for name in ("contents.plist", "o.glif", "oi.glif")}
    assert {name for name in before if before[name] != after[name]} == {"layercontents.plist"}
    font = ufoLib2.Font.open(path)
    assert [layer.name for layer in font.layers] == ["public.default", "sketch", "glyphspline"]
    assert len(font.layers["glyphspline"]["o"].contours[0]) < len(font["o"].contours[0])
    assert font.layers["glyphspline"]["oi"].components == font["oi"].components
    shutil.rmtree(tmp_path / "out")
    run(path, tmp_path / "out", spec)  # again: the same layer
    assert files(path) == after


def test_the_format_ufo_of_a_ufo_is_a_copy_of_it(tmp_path: Path) -> None:
    path = ufo_at(tmp_path / "My.ufo")
    before = files(path)
    run(path, tmp_path / "out", RefitSpec(SHARP, formats=("ufo",)))
    copy = files(tmp_path / "out" / "Mine-spline.ufo")
    assert files(path) == before
    assert copy.keys() == before.keys()
    assert {name for name in before if before[name] != copy[name]} == {"glyphs/o.glif", "glyphs/oi.glif"}


def test_what_is_fitted_for_fonts_goes_back_point_for_point(tmp_path: Path) -> None:
    source = open_source(FONTS / "kouzan-gyosho.otf")
    font = ufoLib2.Font()
    font.info.unitsPerEm = source.metrics.units_per_em
    outline = source.outline(source.glyph_names[5])
    outline.draw(font.newGlyph("a").getPen())
    font.save(tmp_path / "My.ufo")
    options = gs.Options(corners="sharp", continuity="g2", precision=0)
    fitted = gs.convert(Ufo.opened(tmp_path / "My.ufo").outline("a"), options)
    run(tmp_path / "My.ufo", tmp_path / "out", RefitSpec(options, formats=("ufo",)))
    (copy,) = (tmp_path / "out").glob("*.ufo")
    written = Ufo.opened(copy).outline("a").contours
    assert [len(contour) for contour in written] == [len(contour.curve) for contour in fitted.contours]
    em = source.metrics.units_per_em
    assert sum(map(len, written)) < sum(len(with_extrema(contour.curve, em)) for contour in fitted.contours)


def test_points_that_stay_keep_their_flags() -> None:
    """A line runs into a curve as whole units allow, off by a sixth of a degree: the point is marked smooth."""
    start, end, corner = (306, 109), (311, 325), (500, 109)
    old = [Node(start, "line"), Node(end, "line", True), Node((312, 374), None), Node((400, 400), None)]
    old.append(Node(corner, "curve"))
    parts = [[start, end], [end, (312, 373), (401, 400), corner], [corner, start]]
    new = gs.Contour.from_segments([np.array(part, dtype=np.float64) for part in parts])
    made = replaced([old], [new], [frozenset()], 0)
    assert isinstance(made, list)
    assert [(node.at, node.smooth) for node in made[0] if node.kind] == [(start, False), (end, True), (corner, False)]


def test_what_no_whole_units_are_near_keeps_its_decimals(tmp_path: Path) -> None:
    path = family(tmp_path)
    for glif in tmp_path.rglob("*.glif"):
        glif.write_text(re.sub(r'(<point x="-?\d+)"', r'\1.3"', glif.read_text()))
    before = files(tmp_path)
    options = gs.Options(corners="sharp", continuity="g2", precision=0, tolerance=0.1)
    run(path, tmp_path / "out", RefitSpec(options, in_place=True, masters=True))
    assert {name: data for name, data in files(tmp_path).items() if not name.startswith("out/")} == before


@pytest.mark.parametrize("make", [family, glyphs_file(2), glyphs_file(3)], ids=["designspace", "Glyphs 2", "Glyphs 3"])
@pytest.mark.parametrize("layer", [None, "glyphspline"])
def test_masters_stay_compatible_and_nothing_else_changes(
    make: Callable[[Path], Path], layer: str | None, tmp_path: Path
) -> None:
    pytest.importorskip("glyphsLib")
    pytest.importorskip("ufo2ft")
    path = make(tmp_path)
    before = open_source(path)
    old = {name: before.masters(name) for name in before.glyph_names}
    text = path.read_text()
    spec = RefitSpec(SHARP, in_place=layer is None, layer=layer, masters=True)
    assert "new outlines of 2 glyphs" in run(path, tmp_path / "out", spec)[0]
    now = open_source(path)
    for name, masters in old.items():
        new = now.masters(name)
        assert new.advances.tolist() == masters.advances.tolist()
        counts = [(len(a), len(b)) for a, b in zip(masters.contours, new.contours, strict=True)]
        assert all(b < a if layer is None and a == 24 and name != "d" else a == b for a, b in counts)
    if path.suffix == ".glyphs":
        import glyphsLib

        fonts = [glyphsLib.GSFont(str(path))]
        (tmp_path / "old.glyphs").write_text(text)
        fonts.insert(0, glyphsLib.GSFont(str(tmp_path / "old.glyphs")))
        for glyph in fonts[0].glyphs:
            layers = fonts[1].glyphs[glyph.name].layers
            changed = glyph.name in ("o", "oi")
            assert len(layers) == len(glyph.layers) + (2 if layer and changed else 0)
            assert {one.name for one in layers} - {one.name for one in glyph.layers} == (
                {layer} if layer and changed else set()
            )
    if layer is None:
        nodes = r'\((\d|-)[^()]*\),?\n?|"[-\d. ]+(LINE|CURVE|OFFCURVE)[^"]*",?\n?|nodes = \(\s*\);'
        assert re.sub(nodes, "", text) == re.sub(nodes, "", path.read_text())


def test_other_sources_take_nothing_back(tmp_path: Path) -> None:
    with pytest.raises(GlyphsplineError, match="only UFOs, designspaces and Glyphs files"):
        run(FONTS / "edge-cases.ttf", tmp_path / "out", RefitSpec(SHARP, in_place=True))
    assert not (tmp_path / "out").exists()
    with pytest.raises(gs.OptionError, match="not both"):
        RefitSpec(in_place=True, layer="x")


def test_a_glif_keeps_its_style_and_the_attributes_of_points() -> None:
    data = b"""<?xml version="1.0"?>
<glyph name="a" format="2">
\t<outline>
\t\t<component base="b"/>
\t\t<contour identifier="c1">
\t\t\t<point x="0" y="0" type="line" name="first" />
\t\t\t<point x="10" y="0" type="line" />
\t\t</contour>
\t</outline>
</glyph>
"""
    glif = Glif(data)
    (span,) = glif.contours
    assert glif.with_contours({0: [node._replace(at=(round(node.at[0]), 5)) for node in span.nodes]}) == data.replace(
        b'y="0"', b'y="5"'
    )
