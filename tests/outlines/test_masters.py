"""Masters of variable glyphs: what HarfBuzz draws at any location is the linear combination of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import product
from math import comb
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fontTools.pens.ttGlyphPen import TTGlyphPen
from fontTools.ttLib import TTFont, newTable
from fontTools.ttLib.tables import otTables

from glyphspline import FontError, GlyphsplineError, open_font
from glyphspline.outlines.masters import MasterContour, Masters, distinct_regions, region_scalars
from tests.places import FONTS
from tests.variable_fonts import Tuples, polygon, quadratic, variable_font


def composed(*components: tuple[str, float, float]) -> Any:
    pen = TTGlyphPen(dict.fromkeys(name for name, _, _ in components))
    for name, x, y in components:
        pen.addComponent(name, (1, 0, 0, 1, x, y))
    return pen.glyph()


def largest_difference(path: Path, locations: Sequence[Mapping[str, float]]) -> float:
    """Of the points of all glyphs, as HarfBuzz draws them and as their masters say, which have the same segments."""
    font, most = open_font(path), 0.0
    masters = [font.masters(name) for name in font.glyph_names]
    for location in locations:
        drawn = open_font(path, location=location)
        at = np.array([drawn._face.normalized[axis.tag] for axis in drawn.axes])  # rounded to 1/16384 by the format
        for of_glyph, outline in zip(masters, drawn.outlines(drawn.glyph_names), strict=True):
            weights = of_glyph.weights_at(at)
            assert weights.sum() == pytest.approx(1, abs=1e-12)
            assert abs(of_glyph.advances @ weights - outline.advance) <= 0.5 + 1e-6  # HarfBuzz rounds advances
            assert len(of_glyph.contours) == len(outline.contours)
            for contour, expected in zip(of_glyph.contours, outline.contours, strict=True):
                instance = contour.mixed(weights)
                assert instance.degrees.tolist() == expected.degrees.tolist()
                most = max(most, float(np.abs(instance.points - expected.points).max()))
    return most


def random_locations(path: Path, count: int) -> list[dict[str, float]]:
    rng = np.random.default_rng(7)
    axes = open_font(path).axes
    return [{axis.tag: float(rng.uniform(axis.minimum, axis.maximum)) for axis in axes} for _ in range(count)]


@pytest.mark.parametrize("name", ["variable.ttf", "variable-cff2.otf"])
def test_instances_are_what_harfbuzz_draws(name: str) -> None:
    path = FONTS / name
    corners = [
        dict(zip([axis.tag for axis in open_font(path).axes], ends, strict=True))
        for ends in product(*((axis.minimum, axis.default, axis.maximum) for axis in open_font(path).axes))
    ]
    assert largest_difference(path, [*corners, *random_locations(path, 6)]) < 1e-3


def test_contours_begin_where_harfbuzz_begins(tmp_path: Path) -> None:
    points = [(0, 0), (300, -50), (500, 200), (300, 500), (100, 400)]
    deltas = [(10 * k, 7 * k * k) for k in range(5)]
    patterns = {f"g{k}": on for k, on in enumerate(product([False, True], repeat=5))}
    glyphs = {name: quadratic(points, on) for name, on in patterns.items()}
    path = variable_font(tmp_path / "v.ttf", glyphs, {name: [({"wght": (0, 1, 1)}, deltas)] for name in glyphs})
    assert largest_difference(path, [{"wght": 100}, {"wght": 400}, {"wght": 777}, {"wght": 900}]) < 1e-3


def test_components_with_unlike_intermediate_masters(tmp_path: Path) -> None:
    """The stem has one region peaking at 1, the dot another of less extent: peaks are told apart by cutting it."""
    square = [(0, 0), (0, 100), (100, 100), (100, 0)]
    glyphs = {
        "s": polygon(*square),
        "d": polygon(*square),
        "i": composed(("s", 0, 0), ("d", 20, 300)),
    }
    variations: Tuples = {
        "s": [({"wght": (0, 1, 1)}, [(0, 0), (0, 50), (80, 50), (80, 0)])],
        "d": [
            ({"wght": (0, 0.5, 1)}, [(0, 0), (0, 10), (30, 10), (30, 0)]),
            ({"wght": (0.5, 1, 1)}, [(0, 0), (0, 90), (10, 90), (10, 0)]),
        ],
        "i": [({"wght": (-1, -1, 0)}, [(0, 0), (0, -60)])],
    }
    path = variable_font(tmp_path / "v.ttf", glyphs, variations)
    masters = open_font(path).masters("i")
    assert sorted(masters.regions[:, 0].tolist()) == [[-1, -1, 0], [0, 0.5, 1], [0.5, 1, 1]]
    assert masters.peaks[0].tolist() == [0]
    assert largest_difference(path, random_locations(path, 12)) < 1e-3


def test_cut_regions_say_the_same() -> None:
    zero = (0.0, 0.0, 0.0)
    given = [
        ((0.0, 1.0, 1.0), zero),
        ((0.25, 1.0, 1.0), zero),
        ((0.0, 1.0, 1.0), (0.0, 1.0, 1.0)),
        ((0.0, 1.0, 1.0), (0.5, 1.0, 1.0)),
        ((-1.0, -1.0, 0.0), zero),
        (zero, zero),
    ]
    regions = distinct_regions(given)
    peaks = [tuple(peak for _, peak, _ in region) for region in regions]
    assert len(set(peaks)) == len(regions)
    assert (0.0, 0.0) not in peaks
    at = np.random.default_rng(3).uniform(-1, 1, (200, 2))
    before, after = region_scalars(np.array(given), at), region_scalars(np.array(regions), at)
    at_peaks = region_scalars(np.array(given), np.array([(0.0, 0.0), *peaks]))
    weights = after @ np.linalg.inv(region_scalars(np.array(regions), np.array([(0.0, 0.0), *peaks])))
    assert np.abs(weights @ at_peaks - before).max() < 1e-12
    assert distinct_regions(regions) == regions


@pytest.mark.parametrize("other", [(0.0, 0.5, 0.5), (0.5, 0.5, 1.0)])
def test_regions_that_end_abruptly_cannot_be_cut(other: tuple[float, float, float]) -> None:
    with pytest.raises(GlyphsplineError, match="two regions of one peak"):
        distinct_regions([((0.0, 0.5, 1.0),), (other,)])
    assert distinct_regions([(other,)]) == [(other,)]


def test_segments_that_vanish_in_one_master_stay(tmp_path: Path) -> None:
    """The second point is at the first at the default, the last one in the bold; the third is always double."""
    points = [(0, 0), (0, 0), (400, 0), (400, 0), (400, 300), (0, 300)]
    deltas = [(0, 0), (50, 0), (0, 0), (0, 0), (0, 0), (0, -300)]
    path = variable_font(tmp_path / "v.ttf", {"a": polygon(*points)}, {"a": [({"wght": (0, 1, 1)}, deltas)]})
    font = open_font(path)
    masters = font.masters("a")
    assert [len(contour) for contour in masters.contours] == [5]
    assert len(font.outline("a").contours[0]) == 4
    assert masters.master(1).contours[0].points.tolist() == [[0, 0], [50, 0], [400, 0], [400, 300], [0, 0]]


def test_a_contour_without_area_in_all_masters_is_left_out_and_noted(tmp_path: Path) -> None:
    glyph = polygon((0, 0), (100, 0), (200, 0), (50, 0), (0, 300), (100, 300), (200, 300))
    glyph.numberOfContours, glyph.endPtsOfContours = 2, [2, 6]
    flat = [(0, 0), (0, 0), (7, 0), (0, 0), (0, 0), (0, 0), (0, 0)]
    path = variable_font(tmp_path / "v.ttf", {"a": glyph}, {"a": [({"wght": (0, 1, 1)}, flat)]})
    masters = open_font(path).masters("a")
    assert [len(contour) for contour in masters.contours] == [4]
    assert masters.notes == ("contour 0 left out: it encloses nothing",)


def test_axes_are_mapped_by_avar(tmp_path: Path) -> None:
    box = polygon((0, 0), (0, 100), (100, 100), (100, 0))
    deltas = [(0, 0), (0, 0), (100, 0), (100, 0)]
    path = variable_font(tmp_path / "v.ttf", {"a": box}, {"a": [({"wght": (0, 1, 1)}, deltas)]})
    font = TTFont(path)
    font["avar"] = newTable("avar")
    font["avar"].segments = {"wght": {-1.0: -1.0, 0.0: 0.0, 0.5: 0.25, 1.0: 1.0}}
    font.save(path)
    masters = open_font(path).masters("a")
    assert masters.normalised({"wght": 650}).tolist() == [0.25]
    assert masters.user(np.array([0.25])) == {"wght": 650}
    assert masters.instance({"wght": 650}).contours[0].points[:, 0].max() == 125
    assert largest_difference(path, random_locations(path, 5)) < 1e-3


def test_axes_that_depend_on_each_other_are_refused(tmp_path: Path) -> None:
    path = variable_font(tmp_path / "v.ttf", {"a": polygon((0, 0), (0, 100), (100, 100))}, {})
    font = TTFont(path)
    font["avar"] = newTable("avar")
    font["avar"].segments = {"wght": {}}
    font["avar"].majorVersion = 2
    font.save(path)
    with pytest.raises(GlyphsplineError, match=r"v\.ttf, glyph 'a': .*avar version 2"):
        open_font(path).masters("a")
    assert len(open_font(path).outline("a").contours) == 1


def test_the_location_of_the_font_does_not_matter() -> None:
    default, bold = (open_font(FONTS / "variable.ttf", location=at).masters("o") for at in (None, {"wght": 900}))
    assert (default.contours[0].points == bold.contours[0].points).all()


@pytest.mark.parametrize("name", ["kouzan-gyosho.ttf", "kouzan-gyosho.otf"])
def test_a_font_without_axes_has_one_master(name: str) -> None:
    font = open_font(FONTS / name)
    masters, outline = font.masters("uni9F8D"), font.outline("uni9F8D")
    assert (len(masters), masters.axes, masters.grid().shape) == (1, (), (1, 0))
    assert masters.weights({}).tolist() == [1]
    instance = masters.instance({})
    assert instance.advance == outline.advance
    for one, other in zip(instance.contours, outline.contours, strict=True):
        assert (one.points == other.points).all()


def test_glyphs_that_are_not_there() -> None:
    with pytest.raises(FontError, match="no such glyph"):
        open_font(FONTS / "variable.ttf").masters("nothing")


def test_components_in_a_loop(tmp_path: Path) -> None:
    glyphs = {"s": polygon((0, 0), (0, 100), (100, 100)), "a": composed(("s", 0, 0)), "b": composed(("a", 0, 0))}
    path = variable_font(tmp_path / "v.ttf", glyphs, {})
    font = TTFont(path)
    font["glyf"]["a"].components[0].glyphName = "b"
    font["glyf"].glyphs["a"].recalcBounds = lambda *_, **__: None
    font["maxp"].recalc = lambda *_: None
    font.recalcBBoxes = False
    font.save(path)
    with pytest.raises(GlyphsplineError, match="glyph 'a': components in a loop: a > b > a"):
        open_font(path).masters("a")


def test_more_masters_than_can_be_weighed_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("glyphspline.plugins.masters.variations.MOST_MASTERS", 1)
    with pytest.raises(GlyphsplineError, match="glyph 'o': 2 masters, more than 1"):
        open_font(FONTS / "variable.ttf").masters("o")


def test_glyphs_of_variable_components_are_refused(tmp_path: Path) -> None:
    tables = TTFont(FONTS / "variable.ttf")
    tables["VARC"] = newTable("VARC")
    tables["VARC"].table = composed_of = otTables.VARC()
    composed_of.Version, composed_of.Coverage = 0x00010000, otTables.Coverage()
    composed_of.Coverage.glyphs = ["mirror"]
    composed_of.MultiVarStore = composed_of.ConditionList = composed_of.AxisIndicesList = None
    component = otTables.VarComponent()
    component.glyphName = "o"
    composed_of.VarCompositeGlyphs = otTables.VarCompositeGlyphs()
    composed_of.VarCompositeGlyphs.VarCompositeGlyph = [otTables.VarCompositeGlyph([component])]
    tables.save(tmp_path / "v.ttf")
    font = open_font(tmp_path / "v.ttf")
    with pytest.raises(GlyphsplineError, match="glyph 'mirror': made of variable components"):
        font.masters("mirror")
    assert isinstance(font.masters("o"), Masters)


def test_cubics_are_the_segments_of_every_degree() -> None:
    degrees = np.array([1, 2, 3, 2])
    points = np.random.default_rng(5).normal(size=(2, degrees.sum(), 2))

    def drawn(controls: np.ndarray, t: float) -> np.ndarray:
        d = len(controls) - 1
        return sum(comb(d, i) * t**i * (1 - t) ** (d - i) * point for i, point in enumerate(controls))

    for master, cubics in zip(points, MasterContour(points, degrees).cubics(), strict=True):
        ring, start = np.concatenate([master, master[:1]]), 0
        for degree, cubic in zip(degrees, cubics, strict=True):
            for t in (0.0, 0.3, 0.8, 1.0):
                own = drawn(ring[start : start + degree + 1], t)
                np.testing.assert_allclose(drawn(cubic, t), own, atol=1e-12)
            start += degree
