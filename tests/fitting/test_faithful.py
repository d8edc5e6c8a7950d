"""Results within their tolerance of real outlines, sharp and smooth, in few vertices, however the outline is given."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal

import numpy as np
import pytest
from scipy.spatial import cKDTree

import glyphspline as gs
from glyphspline.outlines.overlaps import inked_area, remove_overlaps
from glyphspline.types import FloatArray
from tests.places import GYOSHO as FONT
from tests.polygons import circle_contour, self_crossings, square_contour


def glyph(character: str) -> gs.Outline:
    font = gs.open_font(FONT)
    return font.outline(font.select(text=character)[0])


def points(contour: gs.Contour, spacing: float = 1.0) -> FloatArray:
    return gs.sample(contour, step=spacing)


def true_distance(result: gs.ContourResult, precision: int = 2) -> float:
    """Two-sided distance as written, by dense samples, too large by at most 0.13."""
    a, b = points(result.curve.rounded(precision)), points(result.source, 0.5)
    fine = points(result.curve.rounded(precision), 0.1)
    return float(max(cKDTree(b).query(a)[0].max(), cKDTree(fine).query(b)[0].max()))


@pytest.mark.parametrize("corners", ["sharp", "smooth"])
@pytest.mark.parametrize(("character", "tolerance"), [("永", 0.5), ("永", 4.0), ("龍", 1.0), ("好", 2.0), ("g", 1.0)])
def test_written_results_are_within_the_tolerance(corners: str, character: str, tolerance: float) -> None:
    outline = glyph(character if character != "g" else "a")
    result = gs.convert(outline, gs.Options(tolerance=tolerance, corners=corners))  # type: ignore[arg-type]
    assert len(result.contours) == len(outline.contours)
    for contour in result.contours:
        m = contour.measures
        assert m.within_tolerance
        if any(len(arc.parameters) > 2 for arc in contour.interpolations):
            assert m.converged
            assert m.rate_bound is not None
            assert m.rate_bound < 1
        else:  # lines and arcs of one span, in which nothing is iterated
            assert corners == "sharp"
            assert (m.iterations, m.residual, m.converged, m.rate_bound) == (None, None, None, None)
        assert m.deviation_bound is not None
        assert m.deviation_bound <= tolerance
        assert m.deviation is not None
        assert m.deviation <= m.deviation_bound
        assert true_distance(contour) <= m.deviation_bound + 0.15
    loops = sum(contour.measures.new_crossings or 0 for contour in result.contours)
    assert any("times more than its source" in note for note in result.notes) == (loops > 0)


def test_sharp_is_frugal() -> None:
    outline = glyph("龍")
    efforts: tuple[Literal["fast", "best"], ...] = ("fast", "best")
    fast, best = (
        sum(c.measures.numbers for c in gs.convert(outline, gs.Options(corners="sharp", effort=effort)).contours)
        for effort in efforts
    )
    assert best < 1.1 * fast
    assert fast < sum(2 * contour.degrees.sum() for contour in outline.contours)


def test_a_square_stays_a_square() -> None:
    result = gs.convert(gs.Outline("square", contours=(square_contour(300),)), gs.Options(corners="sharp")).contours[0]
    assert result.measures.segments == result.measures.vertices == 4
    assert result.measures.numbers == 8
    assert result.interpolations == ()
    np.testing.assert_array_equal(np.sort(result.curve.points, axis=0), np.sort(square_contour(300).points, axis=0))


def rounded_square(side: float = 300, radius: float = 80) -> gs.Contour:
    """Four sides and four quarter circles that meet them smoothly."""
    k = 0.5522847498 * radius
    corner = [np.array([[side - radius, 0], [side - radius + k, 0], [side, radius - k], [side, radius]])]
    segments = []
    for turn in range(4):
        angle = turn * np.pi / 2
        rotation = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        middle = np.full(2, side / 2)
        quarter = (corner[0] - middle) @ rotation.T + middle
        following = np.array([quarter[3], (corner[0][0] - middle) @ (rotation @ [[0, -1], [1, 0]]).T + middle])
        segments += [quarter, following]
    points = np.concatenate([s[:-1] for s in segments])
    return gs.Contour(points, np.array([len(s) - 1 for s in segments]))


def test_lines_stay_lines_and_meet_arcs_without_a_kink() -> None:
    outline = gs.Outline("rounded", contours=(rounded_square(),))
    curve = gs.convert(outline, gs.Options(corners="sharp", effort="best")).contours[0].curve
    assert (curve.degrees == 1).sum() == 4
    cubics = curve.cubics()
    arriving, leaving = cubics[:, 3] - cubics[:, 2], np.roll(cubics[:, 1] - cubics[:, 0], -1, axis=0)
    turn = np.arctan2(arriving[:, 0] * leaving[:, 1] - arriving[:, 1] * leaving[:, 0], (arriving * leaving).sum(axis=1))
    joins = (curve.degrees == 1) | (np.roll(curve.degrees, -1) == 1)
    assert np.abs(turn[joins]).max() < 1e-5


def test_arcs_are_what_the_public_interpolation_makes_of_their_vertices() -> None:
    result = gs.convert(glyph("龍"), gs.Options(corners="sharp", effort="best"))
    arcs = [arc for contour in result.contours for arc in contour.interpolations]
    assert any(len(arc.parameters) > 3 for arc in arcs)
    assert not any(arc.spline.closed for arc in arcs)
    for contour in result.contours:
        iterated = any(len(arc.parameters) > 2 for arc in contour.interpolations)
        assert contour.measures.converged is (True if iterated else None)
    for arc in arcs:
        assert arc.rate_bound < 1
        knots = arc.spline.knots
        inner = arc.spline(arc.parameters)
        np.testing.assert_allclose(np.hypot(*np.diff(inner, axis=0).T), np.diff(knots), atol=0.05)


def test_smooth_is_one_closed_curve_graded_and_twice_differentiable_at_the_seam() -> None:
    for contour in gs.convert(glyph("永"), gs.Options(corners="smooth", hold_corners=False)).contours:
        (interpolation,) = contour.interpolations
        spline = interpolation.spline
        assert spline.closed
        h = np.hypot(*(np.roll(contour.polygon, -1, axis=0) - contour.polygon).T)
        assert (h <= 4.0001 * np.roll(h, 1)).all()
        assert (np.roll(h, 1) <= 4.0001 * h).all()
        pieces = spline.to_bezier()
        step = spline.knots[1] - spline.knots[0], spline.knots[-1] - spline.knots[-2]
        second = [(pieces[0, 2] - 2 * pieces[0, 1] + pieces[0, 0]) / step[0] ** 2,
                  (pieces[-1, 3] - 2 * pieces[-1, 2] + pieces[-1, 1]) / step[1] ** 2]  # fmt: skip
        np.testing.assert_allclose(second[0], second[1], atol=1e-9)


def rotated(contour: gs.Contour) -> gs.Contour:
    k = len(contour) // 3
    return gs.Contour(np.roll(contour.points, -contour.offsets[k], axis=0), np.roll(contour.degrees, -k))


Move = tuple[Callable[[gs.Contour], gs.Contour], Callable[[FloatArray], FloatArray], float]
MOVES: dict[str, Move] = {
    "start": (rotated, lambda p: p, 1.0),
    "reversed": (lambda c: c.reversed(), lambda p: p, 1.0),
    "shifted": (lambda c: gs.Contour(c.points + np.array([300, -70]), c.degrees), lambda p: p - [300, -70], 1.0),
    "scaled": (lambda c: gs.Contour(c.points * 2, c.degrees), lambda p: p / 2, 2.0),
    "mirrored": (lambda c: gs.Contour(c.points * [-1, 1], c.degrees), lambda p: p * [-1, 1], 1.0),
}


@pytest.mark.parametrize("corners", ["sharp", "smooth"])
@pytest.mark.parametrize("move", MOVES)
def test_the_shape_does_not_depend_on_how_the_outline_is_given(corners: str, move: str) -> None:
    there, back, scale = MOVES[move]
    outline = glyph("永")
    for contour in outline.contours:
        curves = []
        for given, size in ((contour, 1.0), (there(contour), scale)):
            em = gs.FontMetrics(outline.metrics.units_per_em * size)
            options = gs.Options(tolerance=size, corners=corners, precision=4)  # type: ignore[arg-type]
            curves.append(gs.convert(gs.Outline("x", contours=(given,), metrics=em), options).contours[0].curve)
        assert len(curves[0]) == len(curves[1])
        moved = back(curves[1].points)
        gaps = cKDTree(moved).query(curves[0].points)[0]
        assert gaps.max() < 0.01


def test_crossings_are_counted() -> None:
    assert self_crossings(circle_contour().cubics()) == 0
    eight = gs.Contour(np.array([[0, 0], [100, 100], [100, 0], [0, 100]], dtype=float), np.ones(4, dtype=np.int64))
    assert self_crossings(eight.cubics()) == 1
    loop = np.array([[[0, 0], [300, 200], [-200, 200], [100, 0]], [[100, 0], [67, 0], [33, 0], [0, 0]]], dtype=float)
    assert self_crossings(loop) == 1
    result = gs.convert(gs.Outline("eight", contours=(eight,)), gs.Options(corners="sharp"))
    assert result.contours[0].measures.new_crossings == 0


def test_overlaps_are_united() -> None:
    pytest.importorskip("pathops")
    a, b = square_contour(100), gs.Contour(square_contour(100).points + np.array([50, 50]), np.ones(4, dtype=np.int64))
    outline = gs.Outline("two", contours=(a, b))
    united, note = remove_overlaps(outline)
    assert note is None
    assert len(united.contours) == 1
    assert inked_area(outline.contours) == pytest.approx(17500, rel=2e-3)
    assert inked_area(united.contours) == pytest.approx(17500, rel=2e-3)
    result = gs.convert(outline, gs.Options(corners="sharp", remove_overlaps=True))
    assert len(result.contours) == 1
    assert result.contours[0].measures.segments == 8


def test_contours_without_a_point_on_the_curve_are_united() -> None:
    """Skia gives a circle of quadratics back as off-curve points alone."""
    font = gs.open_font(FONT.parent / "variable.ttf")
    for name in font.glyph_names:
        united, _ = remove_overlaps(font.outline(name))
        for contour in united.contours:
            assert np.isfinite(contour.points).all()


def test_an_outline_without_overlaps_is_not_touched() -> None:
    pytest.importorskip("pathops")
    outline = glyph("永")
    assert remove_overlaps(outline) == (outline, None)


@pytest.mark.parametrize("sampling", [{"step": 20.0}, {"count": 20}])
def test_step_and_count_are_for_smooth_corners(sampling: dict[str, Any]) -> None:
    with pytest.raises(gs.GlyphsplineError, match="tolerance"):
        gs.Options(corners="sharp", **sampling)
