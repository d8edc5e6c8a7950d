"""Unlike masters: outlines of one glyph whose points do not correspond become masters that do."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import glyphspline as gs
from glyphspline.curves.bezier import split
from glyphspline.outlines.masters import DesignAxis, Masters
from glyphspline.plugins.masters.matching.alignment import elastic_nodes
from glyphspline.plugins.masters.matching.cuts import NODES, common_cuts, cut
from glyphspline.plugins.masters.matching.landmarks import Landmarks
from glyphspline.plugins.masters.matching.match import match_masters
from glyphspline.plugins.masters.single_fonts import Unmatched, axis_of, masters_of_fonts
from glyphspline.types import FloatArray
from tests.drawings import L_SHAPE, circle, polygon_contour
from tests.places import FONTS

WEIGHT = DesignAxis("wght", "Weight", 300.0, 300.0, 700.0)
BOLD_L = np.array([[30, 0], [480, 0], [480, 160], [240, 160], [240, 700], [30, 700]], dtype=float)
SQUARE = np.array([[0, 0], [100, 0], [100, 100], [0, 100]], dtype=float)


def outline(*contours: gs.Contour, em: float = 1000.0) -> gs.Outline:
    return gs.Outline("A", 1, (65,), em / 2, contours, gs.FontMetrics(em, 0.8 * em, -0.2 * em))


def matched(*outlines: gs.Outline, axis: DesignAxis = WEIGHT, values: tuple[float, ...] = (300.0, 700.0)) -> Masters:
    return match_masters(outlines, values, axis)


def disc(radius: float, x: float = 0.0, y: float = 0.0, pieces: int = 4, turn: int = 1) -> gs.Contour:
    return gs.Contour.from_segments(circle(radius, pieces, centre=(x, y), turn=turn))


def rotated(contour: gs.Contour, by: int) -> gs.Contour:
    segments = list(contour.segments())
    return gs.Contour.from_segments([*segments[by:], *segments[:by]])


def joints(masters: Masters, c: int = 0) -> FloatArray:
    """(K, m, 2) where the segments of a contour begin in all masters."""
    contour = masters.contours[c]
    return contour.points[:, np.cumsum(contour.degrees) - contour.degrees]


def partner(masters: Masters, point: Any, c: int = 0) -> FloatArray:
    """The partner in the second master of a joint of the first."""
    marks = joints(masters, c)
    away = np.hypot(*(marks[0] - point).T)
    assert away.min() < 1e-9
    found: FloatArray = marks[1, away.argmin()]
    return found


def distance(points: FloatArray, contour: gs.Contour) -> float:
    """Farthest of the points from a densely sampled contour."""
    dense = contour.at(np.arange(400 * len(contour)) / 400)
    return float(np.hypot(*(points[:, None] - dense).transpose(2, 0, 1)).min(axis=1).max())


def area(contour: gs.Contour) -> float:
    from glyphspline.curves.integrals import area as signed

    return float(signed(np.ascontiguousarray(contour.cubics())))


@pytest.mark.parametrize("by", range(6))
@pytest.mark.parametrize("back", [False, True])
def test_corners_find_each_other_whatever_the_start_and_direction(by: int, back: bool) -> None:
    light, bold = polygon_contour(L_SHAPE), rotated(polygon_contour(BOLD_L), by)
    masters = matched(outline(light), outline(bold.reversed() if back else bold))
    assert masters.contours[0].degrees.tolist() == [1] * 6
    np.testing.assert_allclose(joints(masters)[1], BOLD_L, atol=1e-12)


def test_both_ways_round_is_the_default_counter_clockwise() -> None:
    masters = matched(outline(polygon_contour(L_SHAPE).reversed()), outline(polygon_contour(BOLD_L)))
    assert all(area(masters.master(k).contours[0]) > 0 for k in (0, 1))
    np.testing.assert_allclose(partner(masters, L_SHAPE[3]), BOLD_L[3], atol=1e-12)


def test_contours_in_another_order() -> None:
    light = [disc(200, 300, 300), disc(150, 300, 300, turn=-1), polygon_contour(SQUARE + np.array([250, 620]))]
    bold = [disc(240, 310, 300), disc(90, 310, 300, turn=-1), polygon_contour(1.4 * SQUARE + (240, 620))]
    masters = matched(outline(*light), outline(*bold[::-1]))
    assert [round(area(c)) for c in masters.master(1).contours] == [round(area(c)) for c in bold]
    assert [round(area(c)) for c in masters.master(0).contours] == [round(area(c)) for c in light]


def test_a_corner_that_the_other_master_lacks_is_cut_into_it() -> None:
    notched = np.insert(BOLD_L, 5, [[240, 690], [200, 660]], axis=0)
    masters = matched(outline(polygon_contour(L_SHAPE)), outline(polygon_contour(notched)))
    marks = joints(masters)
    assert marks.shape[1] == 8
    for corner, true in zip(L_SHAPE, np.delete(notched, [5, 6], axis=0), strict=True):
        np.testing.assert_allclose(partner(masters, corner), true, atol=1e-12)
    assert area(masters.master(0).contours[0]) == pytest.approx(area(polygon_contour(L_SHAPE)), rel=1e-12)


def test_a_rounded_corner_takes_the_sharp_one_to_its_middle() -> None:
    round_end = gs.Contour.from_segments([
        np.array([[0.0, 0.0], [400.0, 0.0]]), np.array([[400.0, 0.0], [455.2, 0.0], [500.0, 44.8], [500.0, 100.0]]),
        np.array([[500.0, 100.0], [500.0, 500.0]]), np.array([[500.0, 500.0], [0.0, 500.0]]),
        np.array([[0.0, 500.0], [0.0, 0.0]]),
    ])  # fmt: skip
    masters = matched(outline(polygon_contour(5 * SQUARE)), outline(round_end))
    found = partner(masters, (500, 0))
    np.testing.assert_allclose(found, (500 - 100 * (1 - 0.5**0.5), 100 * (1 - 0.5**0.5)), atol=0.5 * 2000 / NODES)


def test_an_o_without_corners_is_matched_by_its_tangents() -> None:
    thin = [disc(300, 350, 350), disc(280, 350, 350, pieces=5, turn=-1)]
    bold = [rotated(disc(320, 360, 350, pieces=7), 3), disc(160, 360, 350, pieces=3, turn=-1)]
    masters = matched(outline(*thin), outline(*bold))
    for c, (r, R, centre) in enumerate(((300, 320, (350, 350)), (280, 160, (350, 350)))):
        for mark, other in zip(*joints(masters, c), strict=True):
            a, b = (mark - centre) / r, (other - (360, 350)) / R
            assert abs(a[0] * b[1] - a[1] * b[0]) < 0.05  # sine of the angle between the radii
            assert a @ b > 0


def test_inserted_joints_stay_where_they_are() -> None:
    light, bold = (polygon_contour(np.insert(points, at + 1, share * points[at] + (1 - share) * points[at + 1], axis=0))
                   for points, at, share in ((L_SHAPE, 4, 0.1), (BOLD_L, 4, 0.8)))  # fmt: skip
    masters = matched(outline(light), outline(bold))
    marks = joints(masters)
    assert marks.shape[1] == 8
    np.testing.assert_allclose(partner(masters, L_SHAPE[4]), BOLD_L[4], atol=1e-12)
    assert masters.contours[0].degrees.tolist() == [1] * 8


def test_a_corner_takes_the_joint_that_the_other_master_hardly_shows() -> None:
    """Where two strokes meet, the light master's two joints are all but straight; in the bold one they are a step."""
    light = np.array([[273, 536], [533, 817], [545, 828], [1158, 1490], [1097, 1490], [258, 584]], dtype=float)
    bold = np.array([[403, 261], [820, 739], [858, 723], [1481, 1490], [1002, 1490], [403, 603]], dtype=float)
    masters = matched(outline(polygon_contour(light)), outline(polygon_contour(bold)))
    for mark, true in zip(light, bold, strict=True):
        np.testing.assert_allclose(partner(masters, mark), true, atol=1e-12)


def test_rounded_coordinates_make_no_corners() -> None:
    """Two units long, and rounded: such a piece of a circle turns by 27° at both ends."""
    points = np.array([[0, 0], [200, 0], [202, 1], [400, 1], [400, 300], [0, 300]], dtype=float)
    found = Landmarks(polygon_contour(points), 1000.0)
    np.testing.assert_array_equal(found.points[found.corners], points[[0, 3, 4, 5]])


@pytest.mark.parametrize(("small", "large"), [(0.01, 2.0), (2.0, 0.01)])
def test_a_dot_too_small_for_corners(small: float, large: float) -> None:
    """A unit wide, its corners may be made by rounding: that is no landmark in it, but its place is its partner's."""
    masters = matched(outline(polygon_contour(small * SQUARE)), outline(polygon_contour(large * SQUARE)))
    np.testing.assert_allclose(area(masters.master(1).contours[0]), (100 * large) ** 2)


@pytest.mark.parametrize(("one", "other"), [((0.5, 0.5), (0.2, 0.8)), ((0.8, 0.2), (0.3, 0.7))])
def test_elastic_alignment_pairs_equal_directions(one: tuple[float, float], other: tuple[float, float]) -> None:
    """An arc goes right and then up, so does another one, in other shares: they turn at the same nodes."""
    mine, its = (np.concatenate([np.full(20, share / 20) for share in shares]) for shares in (one, other))
    right = np.repeat([True, False], 20)
    alike = np.where(right[:, None] == right, 1.0, 0.0)
    pairs = elastic_nodes(mine, its, alike, np.zeros((41, 41)))
    assert pairs[0].tolist() == [0, 0]
    assert pairs[-1].tolist() == [40, 40]
    assert [20, 20] in pairs.tolist()
    assert (np.diff(pairs, axis=0) > 0).all()


def test_elastic_alignment_of_few_pieces_with_many() -> None:
    for n, m in ((1, 40), (3, 200), (200, 3), (1, 1)):
        pairs = elastic_nodes(np.full(n, 1 / n), np.full(m, 1 / m), np.ones((n, m)), np.zeros((n + 1, m + 1)))
        assert pairs[0].tolist() == [0, 0]
        assert pairs[-1].tolist() == [n, m]
        assert len(pairs) <= min(n, m) + 1


def test_near_joints_become_one() -> None:
    """The same inserted joint, but for two units, leaves no sliver."""
    light, bold = (np.insert(L_SHAPE, 5, [x, 700], axis=0) for x in (90, 92))
    masters = matched(outline(polygon_contour(light)), outline(polygon_contour(bold)))
    assert len(masters.contours[0]) == 7


def test_lines_and_curves_together_are_cubics() -> None:
    curved = gs.Contour(
        np.array([[0, 0], [50, -20], [100, 0], [100, 100], [0, 100]], dtype=float), np.array([2, 1, 1, 1])
    )
    masters = matched(outline(polygon_contour(SQUARE)), outline(curved))
    assert masters.contours[0].degrees.tolist() == [3, 1, 1, 1]


@pytest.mark.parametrize("em", [1000.0, 2048.0])
def test_masters_keep_their_outlines(em: float) -> None:
    light = [disc(300, 350, 350, pieces=3), disc(250, 350, 350, pieces=5, turn=-1)]
    bold = [disc(340, 350, 350), disc(100, 340, 350, pieces=6, turn=-1)]
    scaled = [gs.Contour(c.points * em / 1000, c.degrees) for c in bold]
    masters = matched(outline(*light), outline(*scaled, em=em))
    assert masters.advances.tolist() == [500.0, 500.0]
    for k, given_ in enumerate((light, bold)):
        for mine, its in zip(masters.master(k).contours, given_, strict=True):
            assert area(mine) == pytest.approx(area(its), rel=1e-12)
            assert distance(mine.at(np.linspace(0, len(mine), 97)), its) < 1.5


def test_three_masters_are_cut_alike() -> None:
    axis = DesignAxis("wght", "Weight", 300.0, 400.0, 700.0)
    outlines = [outline(polygon_contour(points)) for points in (
        np.insert(L_SHAPE, 1, [200, 0], axis=0), (L_SHAPE + BOLD_L) / 2, np.insert(BOLD_L, 5, [100, 700], axis=0),
    )]  # fmt: skip
    masters = matched(*outlines, axis=axis, values=(300.0, 400.0, 700.0))
    assert joints(masters).shape == (3, 8, 2)
    np.testing.assert_array_equal(masters.peaks[:, 0], [0, -1, 1])
    for value, points in ((300, L_SHAPE), (400, (L_SHAPE + BOLD_L) / 2), (700, BOLD_L)):
        assert area(masters.instance({"wght": value}).contours[0]) == pytest.approx(area(polygon_contour(points)))


def test_regions_between_masters_of_one_axis() -> None:
    axis = DesignAxis("wght", "Weight", 100.0, 100.0, 900.0)
    outlines = [outline(polygon_contour(SQUARE * k)) for k in (1.0, 3.0, 4.0)]
    masters = match_masters(outlines, [100.0, 900.0, 500.0], axis)
    np.testing.assert_allclose(masters.regions[:, 0], [[0.5, 1, 1], [0, 0.5, 1]])
    for value, size in ((100, 1), (300, 2.5), (500, 4), (700, 3.5), (900, 3)):
        assert np.ptp(masters.instance({"wght": value}).contours[0].points) == pytest.approx(100 * size)


def test_a_contour_that_is_missing() -> None:
    with pytest.raises(
        gs.GlyphsplineError, match=r"glyph 'A': unlike the master at wght=700: .* 2 contours, that one 1"
    ):
        matched(outline(disc(300), disc(200, turn=-1)), outline(disc(300)))


def test_a_contour_whose_area_flips() -> None:
    with pytest.raises(gs.GlyphsplineError, match=r"runs clockwise in the default, .* counter-clockwise") as caught:
        matched(outline(disc(300), disc(200, turn=-1)), outline(disc(300), disc(200)))
    assert (caught.value.glyph, caught.value.contour) == ("A", 1)


def test_contours_in_places_too_far_apart() -> None:
    light = [polygon_contour(SQUARE * (10, 1)), polygon_contour(SQUARE + np.array([0, 900]))]
    bold = [polygon_contour(SQUARE * (1, 10)), polygon_contour(SQUARE + np.array([900, 900]))]
    with pytest.raises(gs.GlyphsplineError, match="no contour there resembles it"):
        matched(outline(*light), outline(*bold))


def test_an_axis_and_its_values() -> None:
    axis, values = axis_of("wght=400:300:700", 3)
    assert (axis.tag, axis.name, axis.minimum, axis.default, axis.maximum) == ("wght", "Weight", 300, 400, 700)
    assert values == [400, 300, 700]
    for words in ("wght", "wght=300", "wght=300:700", "weight=1:2:3", "wght=1:2:2", "wght=1:x:3"):
        with pytest.raises(gs.FontError):
            axis_of(words, 3)


def test_single_fonts_of_a_family() -> None:
    """Instances of a variable font, and a font of which some glyphs are drawn otherwise."""
    fonts = [gs.open_font(FONTS / "variable.ttf", location={"wght": value}) for value in (400, 900)]
    for found in masters_of_fonts(fonts, "wght=400:900"):
        assert isinstance(found, Masters)
        for k, font in enumerate(fonts):
            for mine, its in zip(found.master(k).contours, font.outline(found.name).contours, strict=True):
                assert abs(area(mine)) == pytest.approx(abs(area(its)), rel=1e-12)
    brushes = [gs.open_font(FONTS / f"kouzan-{style}.ttf") for style in ("gyosho", "kaisho")]
    every = list(masters_of_fonts(brushes, "wght=300:700"))
    names = [one.name for one in every]
    assert names == list(brushes[0].glyph_names)
    for name, found in zip(names, every, strict=True):
        counts = [len(font.outline(name).contours) for font in brushes]
        if isinstance(found, Unmatched):
            assert str(counts[0]) in str(found.error)
        else:
            assert counts[0] == counts[1] == len(found.contours)
    assert {isinstance(found, Unmatched) for found in every} == {True, False}


def test_a_glyph_that_a_font_lacks_is_named() -> None:
    fonts = [gs.open_font(FONTS / file) for file in ("kouzan-gyosho.ttf", "variable.ttf")]
    found = {one.name: one for one in masters_of_fonts(fonts, "wght=300:700", ["g", "A"])}
    lacking = found["g"]
    assert isinstance(lacking, Unmatched)
    assert "there is no glyph 'g' or U+0067" in str(lacking.error)
    assert "variable.ttf" in str(lacking.error)


@given(st.integers(0, 2**32 - 1))
def test_a_contour_matches_itself_by_other_points(seed: int) -> None:
    """Whatever joints are inserted, a contour is cut like itself, and the curve stays.

    A partner is the same point, or one that slides where the outline is nearly straight: half-way between the two the
    curve is the same.
    """
    rng = np.random.default_rng(seed)
    angles = np.sort(rng.uniform(0, 2 * np.pi, 7)) + np.arange(7) * 0.2
    angles *= 2 * np.pi / (angles[-1] + 0.4)
    points = np.stack([np.cos(angles), np.sin(angles)], axis=1) * rng.uniform(150, 400, (7, 1))
    segments = []
    for a, b in zip(points, np.roll(points, -1, axis=0), strict=True):
        bend = 0.2 * np.array([a[1] - b[1], b[0] - a[0]]) * rng.uniform(-1, 1)
        segments.append(np.array([a, a + (b - a) / 3 + bend, b - (b - a) / 3 + bend, b]))
    again = [part for segment in segments for part in (split(segment, rng.uniform(0.2, 0.8)) if rng.random() < 0.5
                                                       else [segment])]  # fmt: skip
    one, other = (
        gs.Contour.from_segments(segments),
        rotated(gs.Contour.from_segments(again), int(rng.integers(len(again)))),
    )
    u, v, cost = common_cuts(Landmarks(one, 1000.0), Landmarks(other, 1000.0))
    assert cost < 0.1  # 0.04 of most seeds, 0.061 of one
    mine, its = cut(one, u), cut(other, v)
    assert np.all(np.diff(u) > 0)
    assert np.all(np.diff(v) > 0)
    half = gs.Contour((mine.points + its.points) / 2, mine.degrees)
    places = np.arange(0, len(half), 0.05)
    assert distance(half.at(places), one) < 3.0
    assert area(mine) == pytest.approx(area(one), rel=1e-12)
    assert area(its) == pytest.approx(area(one), rel=1e-12)
