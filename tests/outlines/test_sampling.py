"""Polygons sampled from contours, and curves fitted to them."""

from __future__ import annotations

import numpy as np
import pytest

import glyphspline as gs
from scripts.paper.measures import shape
from tests.polygons import circle_contour, square_contour


def teardrop() -> gs.Contour:
    """A smooth bulge of two cubics that meet in one corner of 90 degrees at the origin."""
    right = np.array([[0, 0], [60, 60], [40, 120], [0, 120]], dtype=float)
    left = np.array([[0, 120], [-40, 120], [-60, 60], [0, 0]], dtype=float)
    return gs.Contour.from_segments([right, left])


@pytest.mark.parametrize("contour", [circle_contour(), square_contour(), teardrop()], ids=["circle", "square", "drop"])
@pytest.mark.parametrize("count", [3, 4, 10, 57])
def test_count_gives_so_many_vertices_on_the_outline(contour: gs.Contour, count: int) -> None:
    polygon = gs.sample(contour, count=count)
    assert polygon.shape == (count, 2)
    dense = contour.at(np.linspace(0, len(contour), 20001))
    assert max(np.hypot(*(dense - p).T).min() for p in polygon) < 0.05


def test_step_keeps_corners_and_even_spacing() -> None:
    polygon = gs.sample(square_contour(100), step=30)
    for corner in square_contour(100).points:
        assert (polygon == corner).all(axis=1).any()
    chords = np.hypot(*(np.roll(polygon, -1, axis=0) - polygon).T)
    np.testing.assert_allclose(chords, 100 / 3)


def test_step_grades_chords_beside_short_sides() -> None:
    thin = gs.Contour(np.array([[0, 0], [400, 0], [400, 3], [0, 3]], dtype=float), np.ones(4, dtype=np.int64))
    for ratio in (2.0, 4.0):
        polygon = gs.sample(thin, step=100, max_ratio=ratio)
        chords = np.hypot(*(np.roll(polygon, -1, axis=0) - polygon).T)
        before = np.roll(chords, 1)
        assert (np.maximum(chords, before) / np.minimum(chords, before)).max() <= ratio * (1 + 1e-9)


def test_corners_are_found_by_angle() -> None:
    ends = [gs.sample(teardrop(), step=1e4, corner_angle=angle) for angle in (80.0, 100.0)]
    assert (ends[0] == 0).all(axis=1).any()  # the corner turns by 90 degrees
    square = gs.sample(square_contour(100), step=1e4)
    assert {tuple(p) for p in square} >= {tuple(p) for p in square_contour(100).points}
    hidden = gs.sample(square_contour(100), step=1e4, corner_angle=100.0)
    assert len(hidden) == 3


def test_sampling_needs_one_valid_measure() -> None:
    for bad in (
        {},
        {"count": 5, "step": 2.0},
        {"count": 2},
        {"step": 0.0},
        {"step": float("nan")},
        {"count": True},
        {"count": 5.0},
        {"step": "20"},
        {"step": True},
        {"count": 9, "max_ratio": 1.0},
        {"count": 9, "max_ratio": 1e7},
        {"count": 9, "max_ratio": float("nan")},
        {"count": 9, "corner_angle": 0.0},
        {"count": 9, "corner_angle": float("inf")},
    ):
        with pytest.raises(gs.GlyphsplineError):
            gs.sample(circle_contour(), **bad)


def test_measures_of_a_circle() -> None:
    pieces = circle_contour(100).cubics()
    circle = shape(pieces)
    assert circle.length == pytest.approx(2 * np.pi * 100, rel=3e-4)
    assert circle.area == pytest.approx(np.pi * 100**2, rel=4e-4)
    assert shape(circle_contour(100).reversed().cubics()).area == pytest.approx(-circle.area)
    assert circle.bending_energy == pytest.approx(2 * np.pi / 100, rel=2e-3)
    assert circle.max_curvature == pytest.approx(1 / 100, rel=1e-2)


@pytest.mark.parametrize("tolerance", [4.0, 1.0, 0.25])
def test_tolerance_is_kept_at_a_corner(tolerance: float) -> None:
    outline = gs.Outline("drop", contours=(teardrop(),))
    result = gs.convert(outline, gs.Options(tolerance=tolerance)).contours[0]
    assert result.measures.within_tolerance
    assert result.measures.converged
    assert result.measures.rate_bound is not None
    assert result.measures.rate_bound < 1
    dense = result.curve.at(np.linspace(0, len(result.curve), 8001))
    source = teardrop().at(np.linspace(0, 2, 8001))
    worst = max(
        max(np.hypot(*(source - p).T).min() for p in dense[::7]),
        max(np.hypot(*(dense - p).T).min() for p in source[::7]),
    )
    assert worst <= tolerance + 0.05


def test_step_and_count_are_measured_only_on_request() -> None:
    outline = gs.Outline("o", contours=(circle_contour(),))
    plain = gs.convert(outline, gs.Options(count=8)).contours[0].measures
    assert plain.deviation is plain.within_tolerance is None
    assert plain.vertices == plain.segments == 8
    measured = gs.convert(outline, gs.Options(count=8, measure=True)).contours[0].measures
    assert measured.deviation is not None
    assert 0 < measured.deviation < 1


def test_contours_that_enclose_nothing_are_left_out_with_a_note() -> None:
    dot = gs.Contour(np.array([[5.0, 5.0]]), np.array([1]))
    hair = gs.Contour(np.array([[0.0, 0.0], [5.0, 5.0], [0.0, 0.0]]), np.array([1, 1, 1]))
    result = gs.convert(gs.Outline("x", contours=(dot, circle_contour(), hair)), gs.Options(count=8))
    assert len(result.contours) == 1
    assert len(result.notes) == 2


def test_errors_name_glyph_and_contour() -> None:
    broken = gs.Contour(np.array([[0.0, 0.0], [np.nan, 5.0], [3.0, 1.0], [2.0, 2.0]]), np.ones(4, dtype=np.int64))
    with pytest.raises(gs.GlyphsplineError, match="glyph 'x', contour 1"):
        gs.convert(gs.Outline("x", contours=(circle_contour(), broken)))
