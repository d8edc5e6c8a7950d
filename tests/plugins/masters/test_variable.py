"""Variable fonts with glyphs drawn anew: read back as HarfBuzz and fontTools draw them, beside the curves given."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from fontTools.designspaceLib import DesignSpaceDocument
from fontTools.fontBuilder import FontBuilder
from fontTools.pens.recordingPen import RecordingPen
from fontTools.pens.t2CharStringPen import T2CharStringPen
from fontTools.ttLib import TTFont
from fontTools.ttLib.tables._g_l_y_f import flagOverlapSimple
from fontTools.ttLib.tables.ttProgram import Program
from fontTools.ufoLib import UFOReader
from fontTools.varLib import build as build_variable

from glyphspline import Options, OutputError, convert_masters, open_font
from glyphspline.curves.integrals import area
from glyphspline.errors import GlyphsplineError
from glyphspline.outlines.masters import DesignAxis, MasterContour, Masters
from glyphspline.plugins.fonts.tables.master_deltas import as_drawn, rounded_deltas
from glyphspline.plugins.masters.job import redrawn_glyph
from glyphspline.plugins.masters.new_designspace import unlike_regions, write_designspace
from glyphspline.plugins.masters.other_outlines import to_other_outlines
from glyphspline.plugins.masters.redrawn import Redrawn
from glyphspline.plugins.masters.variable_font import components, to_variable_font
from glyphspline.readers import Font
from glyphspline.types import FloatArray
from tests.outlines.test_masters import composed
from tests.places import FONTS
from tests.variable_drawings import Drawing, Shaper, apart, as_it_is, changed_tables, dense, refitted, turns_of
from tests.variable_fonts import quadratic, variable_font

TTF, OTF = FONTS / "variable.ttf", FONTS / "variable-cff2.otf"

AXES = (("wght", 100, 400, 900, "Weight"), ("wdth", 75, 100, 100, "Width"))
SUPPORTS: tuple[dict[str, tuple[float, float, float]], ...] = (
    {"wght": (0, 1, 1)},
    {"wght": (-1, -1, 0)},
    {"wdth": (-1, -1, 0)},
    {"wght": (0, 1, 1), "wdth": (-1, -1, 0)},
    {"wght": (0, 0.5, 1)},
)


@pytest.fixture(scope="module")
def blobs(tmp_path_factory: pytest.TempPathFactory) -> Font:
    """Two axes, an intermediate region, and a glyph with a smooth contour, a cornered one, lines, and a composite."""
    rng = np.random.default_rng(5)
    turn = np.arange(12) * 2 * np.pi / 12
    ring = np.stack([300 + 250 * np.cos(turn), 350 + 330 * np.sin(turn)], axis=1)
    drop = [(120, 0), (120, 500), (180, 640), (330, 700), (480, 640), (540, 500), (540, 0), (500, 0), (500, 480)]
    drop += [(460, 600), (330, 660), (200, 600), (160, 480), (160, 0)]
    on = [True, True, *[False] * 3, True, True, True, True, *[False] * 3, True, True]
    glyphs = {
        "o": quadratic([tuple(map(round, p)) for p in ring], [False] * 12),
        "n": quadratic(drop, on),
        "b": composed(("o", 0, 0), ("n", 40, 10)),
    }
    scale = {0: (1.2, 1.0), 1: (0.9, 1.02), 2: (0.7, 1.0), 3: (0.95, 1.03), 4: (1.02, 0.98)}
    variations = {}
    for name, points in (("o", ring), ("n", np.array(drop, dtype=float))):
        variations[name] = [
            (
                support,
                [tuple(map(round, d)) for d in points * (np.array(scale[k]) - 1) + rng.integers(-6, 7, points.shape)],
            )
            for k, support in enumerate(SUPPORTS)
        ]
    path = variable_font(tmp_path_factory.mktemp("blobs") / "blobs.ttf", glyphs, variations, AXES)
    font = TTFont(path)
    glyf, gvar = font["glyf"], font["gvar"]
    glyf["o"].flags[0] |= flagOverlapSimple
    glyf["n"].program = Program()
    glyf["n"].program.fromBytecode(bytes([0x4F]))  # DEBUG: instructions of the old outline
    font["hmtx"]["n"] = (610, glyf["n"].xMin + 7)  # rasterisers move the glyph by 7 units
    for number, variation in enumerate(gvar.variations["n"]):
        variation.coordinates[-4:] = [(3 * number, 0), (40 * number, 0), (0, 0), (0, 0)]
    font["maxp"].maxSizeOfInstructions = 1
    font.save(path)
    return open_font(path)


def drawn_at(font: Font, redrawn: dict[str, Redrawn], data: bytes, count: int = 8) -> list[tuple[str, int, FloatArray]]:
    """Glyphs and contours at random locations of their design space that the format can say exactly."""
    rng = np.random.default_rng(0)
    low = [-1.0 * (axis.minimum < axis.default) for axis in font.axes]
    high = [1.0 * (axis.maximum > axis.default) for axis in font.axes]
    places = np.round(rng.uniform(low, high, (count, len(low))) * 16384) / 16384
    return [(name, c, at) for at in places for name, new in redrawn.items() for c in range(len(new.contours))]


def all_redrawn(font: Font, names: tuple[str, ...] | None = None) -> dict[str, Redrawn]:
    found = {name: font.masters(name) for name in components(font, names or font.glyph_names)}
    return {name: refitted(masters) for name, masters in found.items() if masters.contours}


@pytest.mark.parametrize("make", [as_it_is, refitted])
def test_cff2_draws_the_curves_given(make: object) -> None:
    font = open_font(OTF)
    redrawn = {name: make(font.masters(name)) for name in ("o", "l", "n", ".notdef")}  # type: ignore[operator]
    data, summary = to_variable_font(font, redrawn, "otf")
    assert summary.glyphs.keys() == redrawn.keys()
    assert not summary.left
    assert changed_tables(OTF.read_bytes(), data) <= {"CFF2"}  # the same char strings, if the curves are the source's
    assert max(glyph.distance for glyph in summary.glyphs.values()) < 2**-15
    drawing = Drawing(data)
    for name, c, at in drawn_at(font, redrawn, data):
        new = redrawn[name]
        drawing.at(at)
        segments = drawing.contours(font.glyph_names.index(name))[c]
        wanted = list(new.contours[c].mixed(new.masters.weights_at(at)).segments())
        assert len(segments) == len(wanted)
        for one, other in zip(segments, wanted, strict=True):
            assert one == pytest.approx(other, abs=2e-4)
        if new.inner[c].any():
            assert turns_of(segments)[new.inner[c]].max() < 0.01


def test_cff2_is_read_by_fonttools_and_saved_again(tmp_path: Path) -> None:
    font = open_font(OTF)
    data, _ = to_variable_font(font, {"o": refitted(font.masters("o"))}, "otf")
    again = BytesIO()
    read = TTFont(BytesIO(data), recalcTimestamp=False)
    read["CFF2"].cff.topDictIndex[0].CharStrings["o"].decompile()
    read.save(again, reorderTables=False)
    pens = []
    for each in (data, again.getvalue()):
        pen = RecordingPen()
        TTFont(BytesIO(each)).getGlyphSet(location={"wght": 640, "wdth": 90})["o"].draw(pen)
        pens.append(pen.value)
    assert pens[0] == pens[1]


def test_glyf_draws_the_curves_given(blobs: Font) -> None:
    redrawn = all_redrawn(blobs)
    data, summary = to_variable_font(blobs, redrawn, "ttf", tolerance=2.0)
    assert set(summary.glyphs) == {"o", "n"}
    assert not summary.left
    before = blobs.path.read_bytes()
    assert changed_tables(before, data) <= {"glyf", "gvar", "loca", "hmtx", "maxp", "head"}
    drawing, written = Drawing(data), Font(blobs.path, data, 0, None)
    for name, c, at in drawn_at(blobs, redrawn, data):
        new, stored = redrawn[name], summary.glyphs[name]
        assert stored.distance <= 2.0
        drawing.at(at)
        segments = drawing.contours(blobs.glyph_names.index(name))[c]
        weights = new.masters.weights_at(at)
        wanted = list(new.contours[c].mixed(weights).segments())
        said = list(written.masters(name).contours[c].mixed(weights).segments())
        # Without a point on the curve renderers begin where they like.
        turned = [np.concatenate([*said[j:], *said[:j]]) for j in range(len(said) if stored.inner[c].all() else 1)]
        assert min(np.abs(np.concatenate(segments) - each).max() for each in turned) < 2e-3
        fine, other = dense(segments, 40), dense(wanted, 40)
        assert apart(fine, other) < stored.distance + 0.02
        assert apart(other, fine) < stored.distance + 0.02
        assert turns_of(segments)[stored.inner[c]].max(initial=0.0) < 0.002


def test_glyf_keeps_what_is_not_the_outline(blobs: Font) -> None:
    redrawn = all_redrawn(blobs)
    data, _ = to_variable_font(blobs, redrawn, "ttf", tolerance=2.0)
    old, new = blobs.tables(), TTFont(BytesIO(data))
    assert new["glyf"]["o"].flags[0] & flagOverlapSimple
    assert sum(flag & 1 for flag in new["glyf"]["o"].flags) <= 1, "a smooth contour has but its start on the curve"
    assert not new["glyf"]["n"].program.getBytecode()
    assert new["glyf"]["b"].isComposite()
    assert new["head"].modified == old["head"].modified
    for name in ("o", "n"):
        one, other = old["gvar"].variations[name], new["gvar"].variations[name]
        assert [v.axes for v in one] == [v.axes for v in other]
        phantoms = [[delta or (0, 0) for delta in v.coordinates[-4:]] for v in (*one, *other)]
        assert phantoms[: len(one)] == phantoms[len(one) :]
        shift = [font["glyf"][name].xMin - font["hmtx"][name][1] for font in (old, new)]
        assert shift[0] == shift[1]
    for at in ((0.0, 0.0), (1.0, 0.0), (0.5, -0.5), (-0.7, -1.0)):
        place = np.array(at)
        assert Shaper(data).positions("nobno", place) == Shaper(blobs.path.read_bytes()).positions("nobno", place)


def test_composites_follow_their_components(blobs: Font) -> None:
    redrawn = all_redrawn(blobs)
    data, summary = to_variable_font(blobs, {**redrawn, "b": refitted(blobs.masters("b"))}, "ttf", tolerance=0.8)
    assert not summary.left
    one, other = Drawing(blobs.path.read_bytes()), Drawing(data)
    for at in ([0.4, -0.3], [-0.6, -0.9]):
        one.at(np.array(at))
        other.at(np.array(at))
        gid = blobs.glyph_names.index("b")
        for old, new in zip(one.contours(gid), other.contours(gid), strict=True):
            assert apart(dense(old, 30), dense(new, 30)) < 8  # the refit of the test is not close
    _, summary = to_variable_font(blobs, {"b": refitted(blobs.masters("b"))}, "ttf")
    assert summary.left == {"b": "its component o keeps its outline"}


def test_freetype_fills_contours_without_points_on_the_curve(blobs: Font) -> None:
    from PIL import Image, ImageDraw, ImageFont

    def ink(data: bytes) -> int:
        image = Image.new("L", (600, 600))
        ImageDraw.Draw(image).text((20, 20), "o", fill=255, font=ImageFont.truetype(BytesIO(data), 400))
        return int((np.asarray(image) > 127).sum())

    data, _ = to_variable_font(blobs, all_redrawn(blobs), "ttf")
    assert ink(data) == pytest.approx(ink(blobs.path.read_bytes()), rel=0.02)


@pytest.mark.parametrize(("path", "flavour"), [(TTF, "ttf"), (OTF, "otf")])
def test_the_same_bytes_each_time(path: Path, flavour: str) -> None:
    font = open_font(path)
    redrawn = all_redrawn(font)
    files = [to_variable_font(open_font(path), redrawn, flavour)[0] for _ in range(2)]  # type: ignore[arg-type]
    assert files[0] == files[1]


@pytest.mark.parametrize(("path", "flavour"), [(TTF, "ttf"), (OTF, "otf")])
def test_nothing_redrawn_changes_nothing(path: Path, flavour: str) -> None:
    data, summary = to_variable_font(open_font(path), {}, flavour)  # type: ignore[arg-type]
    assert changed_tables(path.read_bytes(), data) == set()
    assert not summary.glyphs
    assert not summary.glyphs


def test_what_cannot_be_written_is_refused() -> None:
    font = open_font(OTF)
    with pytest.raises(OutputError, match="has the outlines of otf, not of ttf"):
        to_variable_font(font, {}, "ttf")
    with pytest.raises(OutputError, match="has the outlines of ttf, not of otf"):
        to_variable_font(open_font(TTF), {}, "otf")
    with pytest.raises(OutputError, match="not variable"):
        to_variable_font(open_font(FONTS / "kouzan-gyosho.ttf"), {}, "ttf")
    with pytest.raises(GlyphsplineError, match="no such glyph"):
        to_variable_font(font, {"x": refitted(font.masters("o"))}, "otf")


@pytest.mark.parametrize("path", [TTF, OTF, None])
def test_outlines_of_the_other_kind_are_the_same_at_every_location(path: Path | None, blobs: Font) -> None:
    source = open_font(path) if path else blobs
    flavour, near = ("ttf", 1.0) if path == OTF else ("otf", 1e-3)
    data, summary = to_other_outlines(source, {}, flavour, tolerance=1.0, rest=0.5)  # type: ignore[arg-type]
    assert not summary.glyphs
    assert data == to_other_outlines(source, {}, flavour, tolerance=1.0, rest=0.5)[0]  # type: ignore[arg-type]
    assert ("glyf" in TTFont(BytesIO(data))) == (flavour == "ttf")
    rng = np.random.default_rng(3)
    for _ in range(6):
        at = {axis.tag: float(rng.uniform(axis.minimum, axis.maximum)) for axis in source.axes}
        here, there = (Font(source.path, each, 0, at) for each in (source.path.read_bytes(), data))
        for name in source.glyph_names:
            old, new = here.outline(name), there.outline(name)
            assert new.advance == pytest.approx(old.advance, abs=0.51)
            assert len(new.contours) == len(old.contours)
            for a, b in zip(old.contours, new.contours, strict=True):
                points = [dense([*c.cubics()], 40) for c in (a, b)]
                assert max(apart(points[0], points[1]), apart(points[1], points[0])) < near + 0.05
            total = sum(area(contour.cubics()) for contour in new.contours)
            assert total == 0 or (total > 0) == (flavour == "otf")


def test_glyphs_drawn_anew_have_outlines_of_the_other_kind_within_the_tolerance() -> None:
    source = open_font(TTF)
    redrawn = {"o": redrawn_glyph(convert_masters(source.masters("o"), Options(tolerance=1.0)))}
    data, summary = to_other_outlines(source, redrawn, "otf", tolerance=1.0, rest=0.5)
    assert set(summary.glyphs) == {"o"}
    assert (summary.glyphs["o"].bound or 9.0) <= 1.0
    font = Font(source.path, data, 0, {"wght": 650.0})
    old = open_font(TTF, location={"wght": 650.0}).outline("o")
    for a, b in zip(old.contours, font.outline("o").contours, strict=True):
        points = [dense([*c.cubics()], 200) for c in (a, b)]
        assert 1e-3 < apart(points[1], points[0]) < 1.0
    data = TTF.read_bytes()
    at = TTFont(TTF).reader.tables["gvar"].offset + 12  # the number of glyphs
    broken = Font(source.path, data[:at] + b"\0\1" + data[at + 2 :], 0, None)
    with pytest.raises(GlyphsplineError, match="a broken font"):
        to_other_outlines(broken, {}, "otf", tolerance=1.0, rest=0.5)
    _, tight = to_other_outlines(
        open_font(OTF), {"n": as_it_is(open_font(OTF).masters("n"))}, "ttf", tolerance=0.05, rest=0.05
    )
    assert "beyond the tolerance" in tight.left["n"]


def test_regions_that_the_font_does_not_have_leave_the_glyph() -> None:
    font = open_font(OTF)
    good = refitted(font.masters("o"))
    masters = good.masters
    other = Masters("o", masters.gid, (), masters.axes, masters.regions * [1.0, 0.5, 1.0], masters.contours)
    data, summary = to_variable_font(font, {"o": Redrawn(other, good.contours, good.inner)}, "otf")
    assert "variation store" in summary.left["o"]
    assert changed_tables(OTF.read_bytes(), data) == set()


def test_a_smaller_tolerance_takes_more_points(blobs: Font) -> None:
    redrawn = {"o": refitted(blobs.masters("o"))}
    counts = [
        len(to_variable_font(blobs, redrawn, "ttf", tolerance=tolerance)[1].glyphs["o"].inner[0])
        for tolerance in (5.0, 0.7)
    ]
    assert counts[0] < counts[1]


def space(axes: int, regions: FloatArray) -> Masters:
    named = tuple(DesignAxis(f"ax{k}", f"Axis {k}", -1, 0, 1) for k in range(axes))
    return Masters("x", axes=named, regions=regions)


def test_every_master_is_within_half_a_step() -> None:
    rng = np.random.default_rng(3)
    one = np.array([[0.0, 1, 1], [0, 0.5, 1], [-1, -1, 0]])
    none = np.zeros(3)
    regions = np.array(
        [[one[0], none], [none, one[0]], [one[0], one[0]], [one[1], none], [one[1], one[0]], [none, one[2]]]
    )
    masters = space(2, regions)
    points = rng.uniform(-900, 900, (7, 40, 2))
    for parts in (1, 1 << 16):
        drawn = as_drawn(masters, rounded_deltas(masters, points, parts), parts)
        assert np.abs(drawn - points).max() <= 0.5 / parts + 1e-6 / parts
    plain = np.floor(np.einsum("kj,jnc->knc", np.linalg.inv(masters.scalars(masters.peaks)), points) + 0.5)
    assert np.abs(as_drawn(masters, plain.astype(np.int64), 1) - points).max() > 0.6, "deltas rounded one by one add up"


def master_fonts(folder: Path) -> DesignSpaceDocument:
    """The designspace of a folder with a font for each UFO and layer, as compilers of UFOs make them."""
    document = DesignSpaceDocument.fromfile(next(folder.glob("*.designspace")))
    for source in document.sources:
        reader = UFOReader(source.path)
        glyphs = reader.getGlyphSet(layerName=source.layerName)
        order = [".notdef", *[name for name in reader.readLib()["public.glyphOrder"] if name in glyphs]]
        builder = FontBuilder(1000, isTTF=False)
        builder.setupGlyphOrder(order)
        strings, widths = {}, {}
        for name in order:
            pen = T2CharStringPen(500, None, roundTolerance=0)
            widths[name] = 500
            if name in glyphs:
                glyph = glyphs[name]
                glyph.draw(pen)
                widths[name] = round(glyph.width)
            strings[name] = pen.getCharString(optimize=False)
        builder.setupCharacterMap({ord(name): name for name in order if len(name) == 1})
        builder.setupCFF("Built", {}, strings, {})
        builder.setupHorizontalMetrics({name: (widths[name], 0) for name in order})
        builder.setupHorizontalHeader(ascent=800, descent=-200)
        builder.setupNameTable({"familyName": "Built", "styleName": "Regular"})
        builder.setupOS2()
        builder.setupPost(keepGlyphNames=False)
        source.font = builder.font
    return document


@pytest.mark.parametrize("font_path", [OTF, None])
def test_a_designspace_builds_the_font(font_path: Path | None, blobs: Font, tmp_path: Path) -> None:
    font = open_font(font_path) if font_path else blobs
    redrawn = {name: refitted(font.masters(name)) for name in ("o", "n")}
    folder = tmp_path / "masters"
    for _ in range(2):  # the second replaces the first
        assert write_designspace(font, redrawn, folder, family="Try It") == {}
    assert (folder / "Try-It.designspace").exists()
    file = BytesIO()
    build_variable(master_fonts(folder))[0].save(file)
    built = TTFont(file)
    for name, new in redrawn.items():
        for at in new.masters.peaks:
            pen = RecordingPen()
            user = new.masters.user(at)
            built.getGlyphSet(location=user)[name].draw(pen)
            points = np.array([point for _, args in pen.value for point in args])
            weights = new.masters.weights(user)
            wanted = np.concatenate([contour.mixed(weights).points for contour in new.contours])
            assert max(np.hypot(*(points - point).T).min() for point in wanted) < 0.05


def test_a_designspace_is_the_same_each_time(tmp_path: Path) -> None:
    font = open_font(OTF)
    redrawn = {"o": refitted(font.masters("o"))}
    files = []
    for name in ("one", "two"):
        write_designspace(font, redrawn, tmp_path / name)
        files.append(
            {p.relative_to(tmp_path / name): p.read_bytes() for p in (tmp_path / name).rglob("*.*") if p.is_file()}
        )
    assert files[0] == files[1]


def test_a_master_that_one_glyph_has_alone_is_a_layer(blobs: Font, tmp_path: Path) -> None:
    font = open_font(OTF)
    redrawn = {"o": refitted(font.masters("o")), ".notdef": refitted(font.masters(".notdef"))}
    write_designspace(font, redrawn, tmp_path / "masters")
    document = DesignSpaceDocument.fromfile(next((tmp_path / "masters").glob("*.designspace")))
    layers = [source.layerName for source in document.sources]
    assert layers == [None, "wdth75", "wght900"]
    reader = UFOReader(document.sources[0].path)
    assert set(reader.getGlyphSet().keys()) == {"o", ".notdef"}
    assert set(reader.getGlyphSet(layerName="wght900").keys()) == {"o"}


def test_regions_that_no_designspace_gives_are_named(tmp_path: Path) -> None:
    narrow = np.array([[[0.5, 1.0, 1.0]]])
    assert unlike_regions(space(1, np.array([[[0.0, 1.0, 1.0]]]))) is None
    assert "do not follow" in str(unlike_regions(space(1, narrow))) or "not those" in str(
        unlike_regions(space(1, narrow))
    )
    masters = space(1, narrow)
    contour = MasterContour(np.tile([[0.0, 0], [9, 0], [9, 9]], (2, 1, 1)), np.ones(3, dtype=np.int64))
    new = Redrawn(masters, (contour,), (np.zeros(3, dtype=bool),))
    with pytest.raises(OutputError, match="no glyph to write"):
        write_designspace(open_font(OTF), {"x": new}, tmp_path / "masters")


def test_something_else_in_the_designspace_s_place_stays(tmp_path: Path) -> None:
    font = open_font(OTF)
    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(OutputError, match="holds no designspace"):
        write_designspace(font, {"o": refitted(font.masters("o"))}, tmp_path)
    assert (tmp_path / "notes.txt").read_text() == "mine"


def test_glyphs_whose_points_are_counted_keep_them(tmp_path: Path) -> None:
    square = [(0, 0), (0, 100), (100, 100), (100, 0)]
    glyphs = {
        "s": quadratic(square, [True] * 4),
        "t": quadratic(square, [True] * 4),
        "m": composed(("s", 0, 0), ("s", 9, 9)),
    }
    part = glyphs["m"].components[1]
    del part.x, part.y
    part.firstPt, part.secondPt, part.flags = 2, 0, 0
    deltas = [({"wght": (0.0, 1.0, 1.0)}, [(0, 0), (0, 50), (50, 50), (50, 0)])]
    font = open_font(variable_font(tmp_path / "matched.ttf", glyphs, {"s": deltas, "t": deltas}))
    redrawn = {name: as_it_is(font.masters(name)) for name in ("s", "t")}
    _, summary = to_variable_font(font, redrawn, "ttf")
    assert set(summary.glyphs) == {"t"}
    assert "m is composed by the numbers of its points" in summary.left["s"]


def test_a_contour_that_is_a_point_in_one_master(tmp_path: Path) -> None:
    turn = np.arange(8) * 2 * np.pi / 8
    ring = [(round(200 + 150 * np.cos(a)), round(200 + 150 * np.sin(a))) for a in turn]
    deltas = [({"wght": (0.0, 1.0, 1.0)}, [(200 - x, 200 - y) for x, y in ring])]
    font = open_font(variable_font(tmp_path / "point.ttf", {"o": quadratic(ring, [False] * 8)}, {"o": deltas}))
    masters = font.masters("o")
    new = Redrawn(masters, tuple(masters.contours), (np.ones(len(masters.contours[0]), dtype=bool),))
    data, summary = to_variable_font(font, {"o": new}, "ttf", tolerance=1.0)
    assert summary.glyphs["o"].distance <= 1.0
    assert np.ptp(Font(font.path, data, 0, None).masters("o").contours[0].points[1], axis=0).max() <= 2


def test_a_feature_that_vanishes_in_one_master_is_measured_there_too(tmp_path: Path) -> None:
    points = [(0, 0), (0, 300), (20, 330), (60, 335), (100, 330), (140, 420), (300, 500), (460, 300), (460, 0)]
    on = [True, True, *[False] * 5, True, True]
    small = [(0, 0), (0, 300), (1, 301), (2, 302), (3, 302), (140, 420), (300, 500), (460, 300), (460, 0)]
    deltas = [(b[0] - a[0], b[1] - a[1]) for a, b in zip(points, small, strict=True)]
    glyph = {"h": quadratic(points, on)}
    font = open_font(variable_font(tmp_path / "vanish.ttf", glyph, {"h": [({"wght": (0.0, 1.0, 1.0)}, deltas)]}))
    new = refitted(font.masters("h"), 2.5)
    data, summary = to_variable_font(font, {"h": new}, "ttf", tolerance=0.6)
    stored, drawing = summary.glyphs["h"], Drawing(data)
    for at in (0.0, 0.4, 0.8, 1.0):
        drawing.at(np.array([at]))
        segments = drawing.contours(font.glyph_names.index("h"))[0]
        wanted = list(new.contours[0].mixed(new.masters.weights_at(np.array([at]))).segments())
        fine, other = dense(segments, 60), dense(wanted, 60)
        assert max(apart(fine, other), apart(other, fine)) < stored.distance + 0.02


def test_a_composite_of_a_glyph_that_does_not_exist_costs_only_itself(tmp_path: Path) -> None:
    tables = TTFont(FONTS / "variable.ttf", recalcBBoxes=False)
    composites = [name for name in tables.getGlyphOrder() if tables["glyf"][name].isComposite()]
    tables.save(tmp_path / "v.ttf")
    data = bytearray((tmp_path / "v.ttf").read_bytes())
    at = (
        TTFont(BytesIO(data)).reader.tables["glyf"].offset
        + TTFont(BytesIO(data))["loca"][tables.getGlyphID(composites[0])]
    )
    data[at + 12 : at + 14] = b"\0\x63"  # the number of the first component
    (tmp_path / "v.ttf").write_bytes(data)
    font = open_font(tmp_path / "v.ttf")
    assert set(components(font, font.glyph_names)) == set(font.glyph_names) - {*composites}
