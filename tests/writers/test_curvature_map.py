from __future__ import annotations

import io
import pickle
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from functools import cache
from typing import Any

import numpy as np
import pytest
from matplotlib.image import imread

import glyphspline as gs
from glyphspline.curves.curvature import bowls
from glyphspline.outlines.ink import corner_points, ink_sides
from glyphspline.types import FloatArray
from glyphspline.writers.figures.drawings import write_map
from glyphspline.writers.settings import Maps, Settings
from glyphspline.writers.svg.comb import (
    LONGEST,
    SIDES,
    TOOTH,
    colour_classes,
    combs,
    curvature_scale,
    palette,
    teeth,
)  # fmt: skip
from glyphspline.writers.svg.curvature_map import to_curvature_svg
from tests.drawings import L_SHAPE, METRICS, circle, polygon_contour, result
from tests.places import DEJAVU, FONTS

SVG = "{http://www.w3.org/2000/svg}"


def disc(radius: float = 200.0, turn: int = 1) -> gs.GlyphResult:
    return result(gs.Contour.from_segments(list(circle(radius, centre=(300, 300), turn=turn))))


@cache
def random_glyph(n: int = 20, seed: int = 0) -> gs.GlyphResult:
    points = np.random.default_rng(seed).uniform(0, 1000, (n, 2))
    r = gs.interpolate(points, 2, fallback="peak", margin=0.02, residual_tolerance=0.01)
    bare = result(gs.Contour.from_segments(list(r.spline.to_bezier())), name=f"random{seed}", gid=seed)
    contour = gs.ContourResult(bare.contours[0].source, points, (r,), bare.contours[0].curve, bare.contours[0].measures)
    return gs.GlyphResult(bare.outline, bare.options, (contour,))


NUMBER = r"-?(?:\d+\.?\d*|\.\d+)"


def strokes(svg: str, group: str = "comb") -> dict[str, FloatArray]:
    """Colour to its teeth (k, 2, 2), foot and tip, y up, as they are written."""
    root = ElementTree.fromstring(svg)
    comb = next(g for g in root.iter(f"{SVG}g") if g.get("class") == group)
    shift = np.array(re.findall(r"-?[\d.]+", comb.get("transform", "translate(0 0)")), dtype=float) * (1, -1)
    found = {}
    for path in comb.findall(f"{SVG}path"):
        if path.attrib["stroke"].startswith("#"):
            commands = re.findall(rf"([Mml])({NUMBER}) ?({NUMBER})", path.attrib["d"])
            assert "".join(command for command, _, _ in commands) == "Ml" + "ml" * (len(commands) // 2 - 1)
            moves = np.array([move for _, *move in commands], dtype=float) * (1, -1)
            found[path.attrib["stroke"]] = np.cumsum(moves, axis=0).reshape(-1, 2, 2) + shift  # all are relative
    return found


@pytest.mark.parametrize("turn", [1, -1])
def test_teeth_of_a_circle_are_as_long_as_its_curvature_and_point_outwards(turn: int) -> None:
    written = strokes(to_curvature_svg(disc(200, turn), scale=SIDES / 3 / 200))
    assert list(written) == [palette()[SIDES + 3]], "a disc is convex whichever way it runs"
    (pairs,) = written.values()
    radii = np.hypot(*(pairs - 300).transpose(2, 0, 1))
    assert radii[:, 0] == pytest.approx(200, abs=0.1)
    assert radii[:, 1] == pytest.approx(200 + TOOTH * 1000 * 3 / SIDES, abs=0.2)


@pytest.mark.parametrize("turn", [1, -1])
def test_ink_is_where_the_contour_winds_and_its_counters_do_not(turn: int) -> None:
    def ring(radius: float, x: float, way: int) -> gs.Contour:
        return gs.Contour.from_segments(list(circle(radius, 8, centre=(x, 0), turn=way * turn)))

    outer, counter, island, apart, across = (
        ring(200, 0, 1),
        ring(100, 0, -1),
        ring(20, 0, 1),
        ring(50, 900, 1),
        ring(90, 190, 1),
    )
    drawn = gs.Outline("a", contours=(outer, counter, island, apart, across))
    assert ink_sides(drawn.arrays).tolist() == [turn] * 5
    mixed = gs.Outline("b", contours=(outer, counter, apart.reversed()))
    assert ink_sides(mixed.arrays).tolist() == [turn, turn, -turn], "fonts with both directions"
    assert ink_sides(gs.Outline("c").arrays).tolist() == []


def test_convex_and_concave_are_the_same_in_truetype_and_postscript() -> None:
    shares = []
    for kind in ("ttf", "otf"):
        font = gs.open_font(FONTS / f"kouzan-gyosho.{kind}")
        glyph = gs.convert(font.outline(font.select(text="O")[0]), gs.Options(count=60))
        for whose in ("source", "result"):
            relative = np.concatenate([part.relative for part in teeth(glyph, 0.01, whose)])
            shares.append((relative > 0.1).sum() / (np.abs(relative) > 0.1).sum())
    assert shares == pytest.approx([shares[0]] * 4, abs=0.15)


def test_the_sources_comb_is_exact_and_stands_on_the_source() -> None:
    source = gs.Contour.from_segments(list(circle(200, 32, centre=(300, 300))))
    glyph = gs.convert(gs.Outline("o", 1, (), 600, (source,), METRICS), gs.Options(count=5))
    ((part,),) = (teeth(glyph, 1 / 200, "source"),)
    assert part.relative == pytest.approx(1, rel=1e-3)
    assert np.hypot(*(part.feet - 300).T) == pytest.approx(200, rel=1e-4)
    assert np.ptp(teeth(glyph, 1 / 200)[0].relative) > 0.005, "five vertices make no circle"
    svg = to_curvature_svg(glyph, comb="source", scale=1 / 200)
    classes = [path.get("class") for path in ElementTree.fromstring(svg).iter(f"{SVG}path")]
    assert "source" in classes
    assert "outline" not in classes
    assert "κ of the source in 1/em" in svg
    svg = to_curvature_svg(glyph, comb="both")
    classes = [path.get("class") for path in ElementTree.fromstring(svg).iter(f"{SVG}path")]
    assert classes.count("source-comb") == classes.count("outline") == 1
    assert "source" not in classes
    assert "dashed: of the source" in " ".join(legend_of(svg))
    assert write_map(glyph, Settings(), "png", Maps("both")) != write_map(glyph, Settings(), "png")
    with pytest.raises(gs.OptionError, match="comb is"):
        to_curvature_svg(glyph, comb="neither")  # type: ignore[arg-type]


def test_the_turn_about_a_corner_has_no_teeth_unless_asked_for() -> None:
    smooth = gs.Options(corners="smooth")
    glyph = gs.convert(gs.Outline("L", 1, (), 600, (polygon_contour(L_SHAPE),), METRICS), smooth)
    assert not any(part.cut.any() for part in teeth(glyph, 0.004))
    assert any(part.cut.any() for part in teeth(glyph, 0.004, in_corners=True))
    plain, every = (to_curvature_svg(glyph, scale=0.004, in_corners=asked) for asked in (False, True))
    assert 'class="cut"' not in plain
    assert 'class="cut"' in every
    largest = max(contour.measures.max_curvature or 0.0 for contour in glyph.contours) * METRICS.units_per_em
    words = [" ".join(legend_of(svg)) for svg in (plain, every)]
    assert all(line.endswith(f"; at most {largest:.0f}") for line in words)
    assert ["; left out: the teeth in 6 corners;" in line for line in words] == [True, False]
    hidden = teeth(glyph, 0.004)[0]
    corners = np.hypot(*(hidden.feet[:, None] - L_SHAPE).transpose(2, 0, 1)).min(axis=1) <= 25
    assert not hidden.relative[corners].any(), "the swings beside the turn neither"
    two = gs.Outline("s", contours=(polygon_contour(L_SHAPE), polygon_contour(L_SHAPE[::-1])))
    assert corner_points(two.arrays, 0.2)[1].tolist() == [0, 6, 12]
    small = gs.convert(gs.Outline("o", 1, (), 600, (gs.Contour.from_segments(list(circle(9, 4))),), METRICS))
    assert all(part.cut.all() for part in teeth(small, 0.004)), "a tight bend is no corner"


def test_long_teeth_are_cut_and_marked() -> None:
    glyph = disc(200)
    svg = to_curvature_svg(glyph, scale=1 / 1000)  # five times the scale
    (pairs,) = strokes(svg).values()
    assert np.hypot(*(pairs[:, 1] - pairs[:, 0]).T) == pytest.approx(LONGEST * TOOTH * 1000, abs=0.2)
    assert all(part.cut.all() for part in teeth(glyph, 1 / 1000))
    assert 'class="cut"' in svg
    assert 'class="cut"' not in to_curvature_svg(glyph, scale=1 / 200)


def test_the_scale_is_that_of_the_sources() -> None:
    source = polygon_contour(L_SHAPE)
    disc_and_corners = gs.Contour.from_segments(list(circle(200, 8, centre=(300, 300))))
    outline = gs.Outline("a", 1, (), 600, (source, disc_and_corners), METRICS)
    scales = [curvature_scale([gs.convert(outline, gs.Options(corners=kind))]) for kind in ("smooth", "sharp")]
    assert scales == pytest.approx([1 / 200] * 2, rel=1e-3), "the turns about corners do not count"
    straight = gs.convert(gs.Outline("b", 1, (), 600, (source,), METRICS), gs.Options(corners="smooth"))
    assert curvature_scale([straight]) > 0, "the result's, where no source is curved"
    assert curvature_scale([]) == 0


def test_scale_is_shared_and_in_the_legend() -> None:
    glyphs = [disc(100), disc(400)]
    scale = curvature_scale(glyphs)
    assert scale == pytest.approx(1 / 400, rel=1e-3) or scale == pytest.approx(1 / 100, rel=1e-3)
    svg = to_curvature_svg(disc(100), scale=1 / 400)
    words = [t.text for t in ElementTree.fromstring(svg).iter(f"{SVG}text")]
    assert not any("cut" in word for word in legend_of(to_curvature_svg(disc(100), scale=1 / 100)))
    assert words[:3] == ["\N{MINUS SIGN}2.5", "0", "2.5"]  # 1/400 per unit is 2.5 per em
    assert ElementTree.fromstring(svg).attrib["data-scale"] == "0.0025"


def legend_of(svg: str) -> list[str]:
    """The lines of a map's legend below its axis."""
    return [str(text.text) for text in ElementTree.fromstring(svg).iter(f"{SVG}text")][3:]


@pytest.mark.parametrize("width", [0.1, 0.3, 0.6, 1.2, 9.0])
def test_the_legend_is_as_wide_as_the_glyph(width: float) -> None:
    """Letters are counted as 0.6 of their size, more than sans serifs have; of a long text it is 1.5 em."""
    bar = polygon_contour(np.array([[0, 0], [1, 0], [1, 0.7], [0, 0.7]]) * [1000 * width, 1000])
    svg = to_curvature_svg(result(bar, advance=1000 * width), scale=0.01)
    box = [float(word) for word in ElementTree.fromstring(svg).attrib["viewBox"].split()]
    assert box[2] == pytest.approx(1000 * width + 40, abs=1), "the legend makes no map wider"
    ends = np.concatenate([pairs[:, 0] for pairs in strokes(svg, "legend").values()])[:, 0]
    wanted = min(1000 * width, 1500)
    assert wanted - 20 <= np.ptp(ends) <= wanted + 1e-6
    texts = list(ElementTree.fromstring(svg).iter(f"{SVG}text"))
    group = next(g for g in ElementTree.fromstring(svg).iter(f"{SVG}g") if g.get("font-size"))
    size = float(group.attrib["font-size"])
    assert max(len(str(text.text)) for text in texts) * 0.6 * size <= wanted + 1
    assert sum(len(str(text.text)) for text in texts[:3]) * 0.6 * size <= wanted


@pytest.mark.parametrize("corners", ["sharp", "smooth"])
def test_no_tooth_of_a_bowl_is_cut(corners: Any) -> None:
    """In faces whose bowls are 4 times as sharp as they are mostly, and however close the fit; corners may be cut."""
    for face, letters in (("STIXGeneral.ttf", "oSe"), ("DejaVuSans.ttf", "oSW"), ("cmr10.ttf", "oa")):
        font = gs.open_font(DEJAVU.parent / face)
        em, outlines = font.metrics.units_per_em, [font.outline(font.cmap[ord(letter)]) for letter in letters]
        for share in (5e-4, 3e-3):
            made = gs.convert_many(outlines, gs.Options(corners=corners, tolerance=share * em))
            for scale in (curvature_scale(made), None):
                for glyph in made:
                    limit = LONGEST * (scale or curvature_scale([glyph]))
                    for whose in ("source", "result"):
                        for item in combs(glyph, 1.0, whose):
                            assert not (bowls(item, em) & (np.abs(item.curvature) > limit + 1e-9 / em)).any()
                    svg = to_curvature_svg(glyph, scale=scale)
                    cut = svg.partition('class="cut"')[2].partition("/>")[0].count("h0")
                    said = re.search(r"dots: (\d+) t[eo]+th cut", " ".join(legend_of(svg)))
                    assert (int(said[1]) if said else 0) == cut


def test_nothing_is_clipped() -> None:
    for seed in range(4):
        glyph = random_glyph(seed=seed)
        svg = to_curvature_svg(glyph, control_polygon=True)
        left, top, width, height = (float(w) for w in ElementTree.fromstring(svg).attrib["viewBox"].split())
        controls = glyph.contours[0].interpolations[0].spline.control_points
        drawn = np.concatenate(
            [*(p.reshape(-1, 2) for p in strokes(svg).values()), controls, glyph.contours[0].polygon]
        )
        drawn = np.concatenate([drawn, *(p.reshape(-1, 2) for p in strokes(svg, "legend").values())])
        assert drawn[:, 0].min() >= left
        assert drawn[:, 0].max() <= left + width
        assert (-drawn[:, 1]).min() >= top
        assert (-drawn[:, 1]).max() <= top + height


def test_vertices_and_control_polygon_are_optional() -> None:
    glyph = random_glyph()
    for vertices in (True, False):
        for control_polygon in (True, False):
            svg = to_curvature_svg(glyph, vertices=vertices, control_polygon=control_polygon)
            classes = {e.get("class") for e in ElementTree.fromstring(svg).iter()}
            assert ("vertices" in classes) == vertices
            assert ("control-polygon" in classes) == control_polygon


def test_size_of_a_large_glyph_is_sensible() -> None:
    turns = np.linspace(0, 2 * np.pi, 300, endpoint=False)
    wave = (300 + 40 * np.sin(12 * turns))[:, None] * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    r = gs.interpolate(wave, 2)
    svg = to_curvature_svg(result(gs.Contour.from_segments(list(r.spline.to_bezier()))))
    assert len(svg) < 150_000


def test_an_endless_outline_gets_no_endless_comb() -> None:
    zigzag = np.array([[30000 * (i % 2), i] for i in range(2000)], dtype=float)
    assert len(teeth(result(polygon_contour(zigzag)), 1.0)[0].feet) < 15_000


@pytest.mark.parametrize("curves", [(), (polygon_contour(L_SHAPE),)], ids=["empty", "straight"])
def test_without_curvature_there_is_still_a_map(curves: tuple[gs.Contour, ...]) -> None:
    glyph = result(*curves, name="<&>", advance=0)
    svg = to_curvature_svg(glyph)
    assert strokes(svg) == {}
    assert "nan" not in svg
    assert write_map(glyph, Settings(), "png").startswith(b"\x89PNG")


def test_same_input_gives_the_same_bytes() -> None:
    assert to_curvature_svg(random_glyph()) == to_curvature_svg(random_glyph())
    assert write_map(random_glyph(), Settings(), "png") == write_map(random_glyph(), Settings(), "png")
    pdf = write_map(random_glyph(), Settings(), "pdf")
    assert pdf == write_map(random_glyph(), Settings(), "pdf")
    assert b"Date" not in pdf


def test_a_pickled_result_is_drawn_alike() -> None:
    made = gs.convert(gs.open_font(FONTS / "kouzan-gyosho.ttf").outline("O"), gs.Options(count=20))
    assert to_curvature_svg(pickle.loads(pickle.dumps(made))) == to_curvature_svg(made)


def test_png_shows_the_comb_in_its_colours() -> None:
    pixels = np.round(imread(io.BytesIO(write_map(disc(200, 1), Settings(), "png", scale=1 / 200)))[..., :3] * 255)
    violet = np.array([int(palette()[-1][i : i + 2], 16) for i in (1, 3, 5)])
    body = pixels[100:-250]  # without the title and the colour bar, which shows every colour
    assert (np.abs(body - violet).max(axis=2) < 40).sum() > 500
    red = np.array([int(palette()[0][i : i + 2], 16) for i in (1, 3, 5)])
    assert (np.abs(body - red).max(axis=2) < 40).sum() == 0


@pytest.mark.parametrize("width", [400, 440, 460, 600])
def test_title_and_legend_are_inside_a_png_of_any_proportion(width: float) -> None:
    arc = np.array([[1, 0], [1, 0.55], [0.55, 1], [0, 1], [-0.55, 1], [-1, 0.55]])
    oval = gs.Contour(np.concatenate([arc, -arc]) * (width, 400), np.full(4, 3))
    pixels = imread(io.BytesIO(write_map(result(oval), Settings(), "png")))[..., :3]
    edges = np.concatenate([pixels[:4], pixels[-4:]])
    np.testing.assert_array_equal(edges, 1.0)


def test_writing_svg_does_not_import_matplotlib() -> None:
    modules = "glyphspline.writers.svg.curvature_map, glyphspline.writers.figures.drawings, glyphspline.report"
    code = f"import sys, {modules}; sys.exit('matplotlib' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def luminance(colour: str) -> float:
    channels = np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255
    linear = np.where(channels <= 0.04045, channels / 12.92, ((channels + 0.055) / 1.055) ** 2.4)
    return float(linear @ [0.2126, 0.7152, 0.0722])


def in_oklch(lightness: float, chroma: float, hue: float) -> str:
    """An OKLCh colour (Ottosson 2020), its hue in degrees, as sRGB clipped to the gamut channel by channel."""
    lms = [[1, 0.3963377774, 0.2158037573], [1, -0.1055613458, -0.0638541728], [1, -0.0894841775, -1.2914855480]]
    rgb = [
        [4.0767416621, -3.3077115913, 0.2309699292],
        [-1.2684380046, 2.6097574011, -0.3413193965],
        [-0.0041960863, -0.7034186147, 1.7076147010],
    ]
    lab = np.array([lightness, chroma * np.cos(np.radians(hue)), chroma * np.sin(np.radians(hue))])
    linear = np.clip(np.array(rgb) @ (np.array(lms) @ lab) ** 3, 0, 1)
    encoded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return "#" + "".join(f"{round(255 * value):02x}" for value in encoded.tolist())


def test_colours_are_of_one_lightness_and_their_hues_follow_the_curvature() -> None:
    strength = np.arange(-SIDES, SIDES + 1) / SIDES
    chroma = np.where(strength == 0, 0.0, 0.06 + 0.14 * np.abs(strength))
    hue = np.where(strength > 0, 215 + 85 * strength, 80 + 60 * strength)
    assert [*map(in_oklch, [0.66] * len(hue), chroma.tolist(), hue.tolist())] == list(palette())


def test_every_colour_is_seen_on_white_and_on_black() -> None:
    colours = palette()
    assert len(set(colours)) == 2 * SIDES + 1
    for colour in colours:
        assert 1.05 / (luminance(colour) + 0.05) > 2.5  # contrast with white, as WCAG defines it
        assert (luminance(colour) + 0.05) / 0.05 > 4.5  # and with black


def test_colour_classes_are_symmetric_and_saturate() -> None:
    values = np.array([-9.0, -1.0, -0.5, 0.0, 0.02, 0.5, 1.0, 9.0])
    assert colour_classes(values).tolist() == [-SIDES, -SIDES, -4, 0, 0, 4, SIDES, SIDES]
