"""What fonts store: no more curves and points than the source, on the grid, no new kink, curvatures that meet."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from fontTools.ttLib import TTFont
from scipy.spatial import cKDTree

import glyphspline as gs
from glyphspline.curves.cubics import turns
from glyphspline.fitting.sharp.corners import find_joints
from glyphspline.fitting.sharp.settings import EFFORTS
from glyphspline.outlines.contour_arrays import ContourArrays
from glyphspline.outlines.flaws.joints import WHAT
from glyphspline.outlines.flaws.kinds import KINK
from glyphspline.outlines.outline import Contours
from glyphspline.outlines.segments import all_cubics
from glyphspline.plugins.fonts.extrema import hidden_extrema
from glyphspline.plugins.fonts.fit.fit import ONE, TURNING, findings
from glyphspline.plugins.fonts.fit.gates import misses
from glyphspline.plugins.fonts.fit.harmony import end_jump, harmonise
from glyphspline.plugins.fonts.fit.points import (
    of_points,
    quadratic_points,
    rounded_nodes,
    stored_points,
    with_cut_lines,
)
from glyphspline.plugins.fonts.fit.run_nodes import CubicRun, Guide
from glyphspline.plugins.fonts.tables.font_file import write_font
from glyphspline.types import FloatArray
from tests.fitting.test_sharp import true_distance
from tests.places import FONTS, GYOSHO

TEXT = "永龍好書山河風月草花鳥"
OPTIONS = gs.Options(continuity="g2")


def outlines(file: Path, text: str = TEXT) -> list[gs.Outline]:
    font = gs.open_font(file)
    return font.outlines(font.select(text=text))


def curves_in(contour: gs.Contour) -> int:
    return int(np.count_nonzero(contour.degrees > 1))


def kinks(contour: gs.Contour) -> list[tuple[float, float, float]]:
    """Where joints turn by 0.5 to 12 degrees, but for those of two lines, and by how much."""
    angles, line = np.degrees(np.abs(turns(contour.cubics(), 1e-6))), contour.degrees == 1
    joints = np.flatnonzero((angles >= 0.5) & (angles < 12.0) & ~(line & np.roll(line, 1)))
    starts = contour.points[contour.offsets]
    return [(*starts[j].tolist(), float(angles[j])) for j in joints]


def jumps(cubics: FloatArray, em: float) -> int:
    """The number of smooth joints at which the curvature jumps by more than a tenth."""
    smooth = np.degrees(np.abs(turns(cubics, 1e-6))) < 3.0
    return sum(end_jump(cubics[j - 1], cubics[j], em) > 0.1 for j in np.flatnonzero(smooth))


def test_a_brush_face_gets_fewer_curves_within_the_tolerance_and_no_new_kink() -> None:
    given = outlines(FONTS / "kouzan-gyosho.otf")
    before = after = 0
    for outline, result in zip(given, gs.convert_many(given, OPTIONS), strict=True):
        for contour in result.contours:
            assert contour.measures.within_tolerance
            assert curves_in(contour.curve) <= curves_in(contour.source)
            before, after = before + curves_in(contour.source), after + curves_in(contour.curve)
            old = kinks(contour.source)
            for x, y, turn in kinks(contour.curve):
                assert any(np.hypot(a - x, b - y) < 3.0 and turn <= was + 0.3 for a, b, was in old), outline.name
    assert after < 0.95 * before


def oval(out: float, back: float) -> gs.Contour:
    """Four quarters whose handles are longer on one side of each extremum than on the other."""
    points: list[list[float]] = [
        [400, 0], [400, out], [300 * 0.55, 500], [0, 500], [-300 * 0.5, 500], [-400, back], [-400, 0],
        [-400, -out], [-300 * 0.55, -500], [0, -500], [300 * 0.5, -500], [400, -back],
    ]  # fmt: skip
    return gs.Contour(np.rint(points), np.full(4, 3))


def test_curvatures_are_made_to_meet_at_points_that_stay_where_letters_have_them() -> None:
    source = oval(290.0, 262.0)
    assert jumps(source.cubics(), 1000.0) == 4
    (found,) = gs.convert(gs.Outline("o", contours=(source,)), gs.Options(continuity="g2", tolerance=3.0)).contours
    curve = found.curve
    assert jumps(curve.cubics(), 1000.0) == 0
    assert len(curve) == 4
    assert kinks(curve) == []
    np.testing.assert_array_equal(curve.points, np.rint(curve.points))
    joints = curve.points[curve.offsets]
    assert sorted(np.abs(joints).max(axis=1).tolist()) == [400, 400, 500, 500]
    assert found.measures.within_tolerance


def test_few_jumps_are_left_that_the_grid_can_do_without() -> None:
    """Nearby places of single nodes and their handles alone leave 28 of 98."""
    before = after = 0
    for outline in outlines(FONTS / "kouzan-gyosho.otf", "永g好龍"):
        for contour in gs.convert(outline, OPTIONS).contours:
            before += jumps(contour.source.cubics(), 1000.0)
            after += jumps(contour.curve.cubics(), 1000.0)
    assert after <= 11 < before


def test_curvature_neither_jumps_nor_swells_where_it_does_not_in_the_source() -> None:
    """Fits that are not looked at for it have eleven such places in this face."""
    font = gs.open_font(FONTS / "kouzan-gyosho.otf")
    given = font.outlines(font.glyph_names)
    for outline, result in zip(given, gs.convert_many(given, OPTIONS), strict=True):
        made = replace(outline, contours=tuple(contour.curve for contour in result.contours))
        old, new = ([one for one in gs.check(each) if one.kind in ("jump", "lump")] for each in (outline, made))
        for one in new:
            near = [np.hypot(*np.subtract(one.point, each.point)) for each in old if each.kind == one.kind]
            assert min(near, default=np.inf) < 40.0, (outline.name, one)


def test_jumps_of_curvature_that_may_stay_move_nothing() -> None:
    source = oval(290.0, 262.0).cubics()
    settings = EFFORTS["fast"](near=1.0, angle=0.3, line=25.0, c2=False, margin=0.0, residual=0.0)
    joints = find_joints(source[None], np.full(4, 3), settings.near, settings.angle, settings.line, settings.c2)
    most = max(end_jump(source[s - 1], source[s], 1000.0) for s in range(4))
    for slack in (most + 0.01, 0.0):
        run = CubicRun(
            source.copy(), np.zeros(4, np.bool_), np.empty(5, np.int64), np.empty((5, 2)), np.arange(5),
            np.zeros(4, np.int64), np.ones(5), np.full(5, slack), True,
        )  # fmt: skip
        guide = Guide(
            joints.samples[0], joints.first, joints.corner, np.ones(5, np.bool_), joints.arriving[0], joints.leaving[0]
        )
        harmonise(run[:], guide[:], 1.0, 1000.0)
        stays, met = np.abs(run.P - source).max() < 1e-6, jumps(run.P, 1000.0) == 0
        assert (stays, met) == (slack > 0, slack == 0)


def test_what_is_good_stays_to_the_byte_with_its_first_point() -> None:
    good = gs.convert(
        gs.Outline("o", contours=(oval(290.0, 262.0),)), gs.Options(continuity="g2", tolerance=3.0)
    ).contours
    square = gs.Contour(np.array([[0.0, 0], [100, 0], [100, 100], [0, 100]]), np.ones(4, dtype=np.int64))
    again = gs.convert(gs.Outline("o", contours=(good[0].curve, square)), OPTIONS)
    for source, result in zip((good[0].curve, square), again.contours, strict=True):
        np.testing.assert_array_equal(result.curve.points, source.points)
        np.testing.assert_array_equal(result.curve.degrees, source.degrees)


def test_a_node_that_says_nothing_goes() -> None:
    whole = oval(276.0, 276.0).cubics()
    a, b, c, d = whole[0]
    ab, bc, cd = (a + b) / 2, (b + c) / 2, (c + d) / 2
    abc, bcd = (ab + bc) / 2, (bc + cd) / 2
    points = np.concatenate([[a, ab, abc, (abc + bcd) / 2, bcd, cd], *(each[:3] for each in whole[1:])])
    split = gs.Contour(np.rint(points), np.full(5, 3))
    (found,) = gs.convert(gs.Outline("o", contours=(split,)), OPTIONS).contours
    assert len(found.curve) == 4
    assert found.measures.within_tolerance


@pytest.mark.parametrize("precision", [0, 1])
def test_points_are_on_the_grid_asked_for(precision: int) -> None:
    options = gs.Options(corners="sharp", continuity="g2", precision=precision)
    source = oval(290.3, 262.1)
    (found,) = gs.convert(gs.Outline("o", contours=(source,)), options).contours
    scaled = found.curve.points * 10**precision
    np.testing.assert_allclose(scaled, np.rint(scaled), atol=1e-9)


def test_sources_off_the_grid_get_no_kink_and_keep_their_digits(tmp_path: Path) -> None:
    """Rounded nodes beside stretches that stay, or these in 64ths of a unit, would turn."""
    font = gs.open_font(FONTS / "kouzan-gyosho.otf")
    results, kept = [], 0
    for outline, scale in zip(font.outlines(font.select(text="好永龍")), (0.47, 0.7, 0.7), strict=True):
        contours = tuple(gs.Contour(np.round(scale * each.points, 1), each.degrees) for each in outline.contours)
        results.append(gs.convert(replace(outline, contours=contours), OPTIONS))
        for contour in results[-1].contours:
            old = kinks(contour.source)
            for x, y, turn in kinks(contour.curve):
                assert any(np.hypot(a - x, b - y) < 3.0 and turn <= was + 0.05 for a, b, was in old), outline.name
    write_font(font, results, tmp_path / "new.otf", tolerance=1.024)
    new = gs.open_font(tmp_path / "new.otf")
    for result in results:
        for contour, again in zip(result.contours, new.outline(result.outline.name).contours, strict=True):
            np.testing.assert_allclose(again.points, contour.curve.points, rtol=0.0, atol=1e-4)
            kept += int(np.count_nonzero(contour.curve.points != np.rint(contour.curve.points)))
    assert kept > 100


def test_a_sliver_does_not_cross_itself_as_fonts_store_it() -> None:
    """A curve within a unit of a line whose ends have decimals: they stay, and handles in whole units cross the line;
    with ends in whole units too they do not."""
    points = [[382.5, 281.8], [386.4, 299.6], [385.5, 294.2], [384.2, 288.3]]
    source = gs.Contour(np.array(points), np.array([1, 3]))
    (found,) = gs.convert(gs.Outline("d", contours=(source,)), OPTIONS).contours
    made = gs.Outline("d", contours=(found.curve,))
    assert not [each for each in gs.check(made) if each.kind == "crossing"]
    assert found.measures.new_crossings == 0


def test_decimals_do_not_keep_a_whole_contour_as_it_is() -> None:
    """A curve that begins at a corner with decimals is too far once that is rounded: it alone is fitted again."""
    (outline,) = outlines(FONTS / "kouzan-gyosho.otf", "永")
    contour = outline.contours[0]
    source = gs.Contour(np.round(0.61 * contour.points, 1), contour.degrees)
    (found,) = gs.convert(replace(outline, contours=(source,)), OPTIONS).contours
    assert found.measures.within_tolerance
    assert len(found.curve) < 0.8 * len(source)


TURNED = gs.Contour(
    np.array(
        [[-600, 20], [-400, 8], [-200, 0], [0, 0], [6, -1], [12, -1], [19, -2], [141, -25], [300, -164], [300, -330],
         [-600, -330]], dtype=np.float64,
    ), np.array([3, 3, 3, 1, 1]),
)  # fmt: skip
"""It turns by 9.5 degrees beside a handle of 6 units."""


def test_a_turn_that_a_check_excuses_beside_a_short_handle_is_told_apart_from_a_kink() -> None:
    source = TURNED
    whole = gs.Contour(np.delete(source.points, [4, 5, 6], axis=0), np.array([3, 3, 1, 1]))
    kinds = [set(findings(gs.Outline("d", contours=(each,)).arrays, 1000.0)[:, WHAT]) for each in (source, whole)]
    assert TURNING in kinds[0] & kinds[1]
    assert KINK in kinds[1] - kinds[0]


def test_a_turn_that_a_check_excuses_is_none_in_quadratics_with_longer_legs() -> None:
    ((points, on),), far = quadratic_points(gs.Outline("d", contours=(TURNED,)).arrays, OPTIONS, 1.0, 1000.0)
    assert far <= 1.0
    assert not {KINK, TURNING} & set(findings(of_points(points, on), 1000.0)[:, WHAT])


def quadratics(outline: gs.Outline) -> Sequence[tuple[ContourArrays, ContourArrays, int, int]]:
    """Contours of a glyph and what is stored for them, with the numbers of their points."""
    em = outline.metrics.units_per_em
    found, _ = quadratic_points(outline.arrays, OPTIONS, em / 1000, em)
    rows = []
    for c, (points, on) in enumerate(found):
        own = outline.arrays.part(c, c + 1)
        stored = stored_points(own)
        assert stored is not None
        rows.append((own, of_points(points, on), len(stored[1]), len(points)))
    return rows


def test_quadratics_have_fewer_points_and_no_new_kink() -> None:
    before = after = 0
    for outline in outlines(GYOSHO):
        for source, made, had, has in quadratics(outline):
            before, after = before + had, after + has
            assert has <= had
            old, new = (gs.Contour(each.points, each.degrees) for each in (source, made))
            assert len(kinks(new)) <= len(kinks(old)), outline.name
            a, b = (gs.sample(each, step=0.5) for each in (old, new))
            assert max(cKDTree(b).query(a)[0].max(), cKDTree(a).query(b)[0].max()) < 1.1
    assert after < before


def test_fonts_are_written_as_they_are_fitted(tmp_path: Path) -> None:
    for file, flavour in ((FONTS / "kouzan-gyosho.otf", "otf"), (GYOSHO, "ttf")):
        font = gs.open_font(file)
        names = font.select(text=TEXT)
        results = gs.convert_many(font.outlines(names), OPTIONS)
        summary = write_font(font, results, tmp_path / f"new.{flavour}", tolerance=1.024)
        assert summary.extrema == 0
        assert summary.beyond == ()
        assert summary.largest_error is not None
        assert summary.largest_error <= 1.024
        new = gs.open_font(tmp_path / f"new.{flavour}")
        written, source = TTFont(tmp_path / f"new.{flavour}"), TTFont(file)
        for name, outline in zip(names, font.outlines(names), strict=True):
            again = new.outline(name)
            np.testing.assert_array_equal(2 * again.arrays.points, np.rint(2 * again.arrays.points))
            assert sum(map(curves_in, again.contours)) <= sum(map(curves_in, outline.contours)) or flavour == "ttf"
            if flavour == "ttf":
                assert len(written["glyf"][name].coordinates) <= len(source["glyf"][name].coordinates)


def test_quadratics_that_stay_are_cubics_of_the_same_shape() -> None:
    given = outlines(FONTS / "kouzan-gyosho.ttf")
    for result in gs.convert_many(given, OPTIONS):
        for contour in result.contours:
            assert contour.measures.within_tolerance
            assert set(contour.curve.degrees.tolist()) <= {1, 3}
            a, b = (gs.sample(each, step=0.5) for each in (contour.source, contour.curve))
            assert max(cKDTree(b).query(a)[0].max(), cKDTree(a).query(b)[0].max()) < 1.1


@pytest.mark.parametrize("file", ["kouzan-gyosho.ttf", "kouzan-kaisho.ttf"])
def test_cubics_in_the_place_of_quadratics_are_on_the_grid_and_turn_no_more(file: str) -> None:
    """As cubics quadratics have decimals, beside which a check excuses no turn."""
    whole: list[bool] = []
    for result in gs.convert_many(outlines(FONTS / file), OPTIONS):
        made = tuple(each.curve for each in result.contours)
        old, new = (gs.Outline("d", contours=each).arrays for each in (result.outline.contours, made))
        kinks_there = [np.count_nonzero(findings(each, 1000.0)[:, WHAT] == KINK) for each in (old, new)]
        assert kinks_there[1] <= kinks_there[0], result.outline.name
        whole.extend(np.all(np.abs(new.points - np.rint(new.points)) < 1e-6, axis=1).tolist())
    assert np.mean(whole) > 0.95


def test_quadratics_in_the_place_of_cubics_are_near_and_turn_no_more() -> None:
    for outline in outlines(FONTS / "kouzan-gyosho.otf", "永g好龍"):
        found, far = quadratic_points(outline.arrays, OPTIONS, 1.0, 1000.0)
        assert far <= 1.0
        for contour, (points, on) in zip(outline.contours, found, strict=True):
            np.testing.assert_array_equal(points, np.rint(points))
            made = of_points(points, on)
            new = gs.Contour(made.points, made.degrees)
            a, b = (gs.sample(each, step=0.5) for each in (contour, new))
            assert max(cKDTree(b).query(a)[0].max(), cKDTree(a).query(b)[0].max()) < 1.1
            old = kinks(contour)
            for x, y, turn in kinks(new):
                assert any(np.hypot(p - x, q - y) < 3.0 and turn <= was + 0.3 for p, q, was in old), outline.name


def test_lines_are_left_along_them_where_the_grid_has_that_direction() -> None:
    """Lines that rise by 3 in 7 steps, and a bow between them that begins and ends along them."""
    points = [[0, 0], [140, 60], [210, 90], [290, 90], [360, 60], [500, 0], [500, -200], [0, -200]]
    source = gs.Contour(np.array(points, dtype=np.float64), np.array([1, 3, 1, 1, 1, 1]))
    (found,), far = quadratic_points(gs.Outline("bow", contours=(source,)).arrays, OPTIONS, 1.0, 1000.0)
    made = of_points(*found)
    assert kinks(gs.Contour(made.points, made.degrees)) == []
    assert far <= 1.0


def test_a_line_ends_earlier_where_the_grid_has_no_control_point_along_it_near_its_end() -> None:
    """A curve 12 units high that begins along a line of slope 169 / 152: near its end the grid has slope 1."""
    points = [[266, 104], [121, 104], [117, 104], [113.32, 110.03], [116, 113], [268, 282]]
    source = gs.Contour(np.array(points, dtype=np.float64), np.array([1, 3, 1, 1]))
    (found,), far = quadratic_points(gs.Outline("four", contours=(source,)).arrays, OPTIONS, 1.0, 1000.0)
    made = of_points(*found)
    assert kinks(gs.Contour(made.points, made.degrees)) == []
    assert far <= 1.0
    a, b = (gs.sample(each, step=0.5) for each in (source, gs.Contour(made.points, made.degrees)))
    assert max(cKDTree(b).query(a)[0].max(), cKDTree(a).query(b)[0].max()) < 1.1


def test_what_follows_a_line_that_ends_earlier_keeps_its_shape() -> None:
    points = np.array([[0.0, 0], [301.3, 7.2], [420, 11], [500, 200], [300, 400]])
    source = Contours([gs.Contour(points, np.array([1, 2, 1, 1]))]).arrays
    cut = with_cut_lines(source, {(0, 1): 3})
    assert cut is not None
    np.testing.assert_allclose(all_cubics(cut)[2:], all_cubics(source)[1:], atol=1e-9)


def test_a_line_end_has_no_new_kink_beside_a_kink_of_the_source_that_is_gone() -> None:
    """The same line, and a joint of 0.95 degrees on the other side, which quadratics smooth."""
    points = [
        [266, 104], [121, 104], [117, 104], [113.32, 110.03], [116, 113], [268, 282], [368, 270], [380, 240],
        [380, 200], [381, 140], [340, 104],
    ]  # fmt: skip
    source = gs.Contour(np.array(points, dtype=np.float64), np.array([1, 3, 1, 3, 3]))
    assert [place for *place, _ in kinks(source)] == [[380.0, 200.0]]
    (found,), far = quadratic_points(gs.Outline("four", contours=(source,)).arrays, OPTIONS, 1.0, 1000.0)
    made = of_points(*found)
    assert kinks(gs.Contour(made.points, made.degrees)) == []
    assert far <= 1.0


def test_rounding_turns_short_lines_little() -> None:
    """Rounded to the nearest units, a line of 7 turns by 4 degrees."""
    points = [[388.3, 420], [391.7, 414], [465, 468], [500, 542], [478, 613], [370, 540], [372, 458]]
    source = gs.Contour(np.array(points, dtype=np.float64), np.array([1, 3, 3]))
    nodes = rounded_nodes(source.cubics()[None], source.degrees)
    np.testing.assert_array_equal(nodes[0], [[388, 420], [391, 414], [478, 613]])


def test_no_control_point_is_on_a_point_of_the_curve_where_its_leg_would_turn_unseen() -> None:
    """A serif ten units wide, on whose top the grid has hardly a place for two quadratics."""
    points = [
        [61, 310], [61, 300], [63, 293], [68, 293], [77, 293], [88, 304], [91, 308], [118, 342], [132, 345], [142, 345],
        [150, 345], [158, 342], [162, 327], [196, 198], [61, 190],
    ]  # fmt: skip
    source = gs.Contour(np.array(points, dtype=np.float64), np.array([3, 3, 3, 3, 1, 1, 1]))
    (found,), far = quadratic_points(gs.Outline("x", contours=(source,)).arrays, OPTIONS, 1.0, 1000.0)
    made = of_points(*found)
    assert np.abs(np.diff(found[0], axis=0)).max(axis=1).min() > 0
    assert all(p == [91.0, 308.0] and turn < 1.6 for *p, turn in kinks(gs.Contour(made.points, made.degrees)))
    assert kinks(source)[0][:2] == (91.0, 308.0)
    assert far <= 1.0


def test_a_truetype_font_of_cubics_is_within_the_tolerance(tmp_path: Path) -> None:
    font = gs.open_font(FONTS / "kouzan-gyosho.otf")
    names = font.select(text="永g好")
    summary = write_font(font, gs.convert_many(font.outlines(names), OPTIONS), tmp_path / "new.ttf", tolerance=1.024)
    assert summary.beyond == ()
    new = gs.open_font(tmp_path / "new.ttf")
    for name in names:
        for one, other in zip(font.outline(name).contours, new.outline(name).contours, strict=True):
            a, b = (gs.sample(each, step=0.5) for each in (one, other))
            assert max(cKDTree(b).query(a)[0].max(), cKDTree(a).query(b)[0].max()) < 1.1


def test_no_extremum_is_hidden_inside_a_curve_that_the_source_has_at_a_node() -> None:
    given = outlines(FONTS / "kouzan-gyosho.otf")
    for outline, result in zip(given, gs.convert_many(given, OPTIONS), strict=True):
        for contour in result.contours:
            inside = [sum(map(hidden_extrema, np.rint(each.cubics()))) for each in (contour.curve, contour.source)]
            assert inside[0] <= inside[1], outline.name


def test_a_handle_may_move_by_as_much_as_the_tolerance() -> None:
    """The curve itself moves by less than half of that."""
    source = np.array([[[0, 0], [0, 10], [10, 30], [40, 30]], [[40, 30], [27, 20], [13, 10], [0, 0]]], dtype=np.float64)
    moved = source[None, :1].copy()
    moved[0, 0, 1, 1] += 1.0
    of = (np.arange(2), np.zeros(1, np.bool_), False, 0, source[None], source, ONE)
    assert not misses(moved, *of, 0.999).any()
    moved[0, 0, 1, 1] += 3.0
    assert misses(moved, *of, 0.999).all()


def test_cubics_are_no_interpolation_that_was_iterated() -> None:
    font = gs.open_font(FONTS / "kouzan-gyosho.ttf")
    outline = font.outline(font.select(text="龍")[0])
    for contour in gs.convert(outline, gs.Options(continuity="g2", precision=2)).contours:
        m = contour.measures
        assert m.within_tolerance
        assert (m.iterations, m.residual, m.converged, m.rate_bound, m.fallbacks) == (None,) * 5
        assert all(len(arc.parameters) == 2 for arc in contour.interpolations)


@pytest.mark.parametrize("handle", [0.0, 1.5])
def test_a_segment_that_ends_where_it_begins_may_stay_as_it_is(handle: float) -> None:
    """Flat, a loop is a spike there and back on the line: both halves of it end where they begin."""
    corners = np.array([[0.0, 0.0], [200.0, 0.0], [500.0, 0.0], [500.0, 300.0], [0.0, 300.0]])
    segments = [np.stack(pair) for pair in zip(corners, np.roll(corners, -1, axis=0), strict=True)]
    segments.insert(1, np.array([[200.0, 0.0], [202.0, handle], [198.0, handle], [200.0, 0.0]]))
    outline = gs.Outline("loop", contours=(gs.Contour.from_segments(segments),))
    (contour,) = gs.convert(outline, gs.Options(continuity="g2", tolerance=0.5, precision=2)).contours
    assert np.isfinite(contour.curve.points).all()
    assert contour.measures.deviation_bound is not None
    assert true_distance(contour, 2) <= contour.measures.deviation_bound + 0.01
