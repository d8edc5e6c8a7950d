from __future__ import annotations

import warnings

import numpy as np
import pytest

import glyphspline as gs
from glyphspline.curves.curvature import ANGLE, Comb, comb, relative, robust_scale
from tests.drawings import circle


@pytest.mark.parametrize("radius", [0.01, 7.0, 1e5])
@pytest.mark.parametrize("turn", [1, -1])
def test_circle(radius: float, turn: int) -> None:
    found = comb(circle(radius, 32, turn=turn), spacing=radius / 10)
    assert found.curvature == pytest.approx(turn / radius, rel=1e-4)
    assert np.hypot(*found.points.T) == pytest.approx(radius, rel=1e-8)
    assert found.normals == pytest.approx(-turn * found.points / radius, abs=1e-5)
    assert found.weights.sum() == pytest.approx(2 * np.pi * radius, rel=1e-4)


def test_agrees_with_the_splines_own_curvature() -> None:
    spline = gs.interpolate(np.random.default_rng(2).uniform(0, 100, (15, 2)), 2).spline
    found = comb(spline.to_bezier(), 1.0)
    ends = found.curvature[found.pieces[:-1]]
    assert ends == pytest.approx(spline.curvature(spline.knots[:-1]), rel=1e-6)
    assert found.points[found.pieces[:-1]] == pytest.approx(spline(spline.knots[:-1]))


def test_samples_are_even_and_turn_little() -> None:
    spline = gs.interpolate(np.random.default_rng(3).uniform(0, 100, (15, 2)), 2).spline
    found = comb(spline.to_bezier(), 1.0)
    for start, stop in zip(found.pieces[:-1], found.pieces[1:], strict=True):
        gaps = np.hypot(*np.diff(found.points[start:stop], axis=0).T)
        normals = found.normals[start:stop]
        turns = np.arccos(np.clip((normals[:-1] * normals[1:]).sum(axis=1), -1, 1))
        assert gaps.max() <= 1.15
        assert turns.max() <= 2 * ANGLE


def test_reversal_changes_the_sign_and_keeps_the_tips() -> None:
    pieces = gs.interpolate(np.random.default_rng(5).uniform(0, 100, (9, 2)), 2).spline.to_bezier()
    forth, back = comb(pieces, 2.0), comb(pieces[::-1, ::-1], 2.0)
    assert back.curvature[::-1] == pytest.approx(-forth.curvature, rel=1e-6, abs=1e-9)
    tips = [c.points - c.curvature[:, None] * c.normals for c in (forth, back)]
    assert tips[1][::-1] == pytest.approx(tips[0], abs=1e-6)


CUSPS = {
    "cusp": [[0, 0], [100, 100], [0, 100], [100, 0]],
    "handle on its end": [[0, 0], [0, 0], [50, 100], [100, 0]],
    "both handles on their ends": [[0, 0], [0, 0], [100, 0], [100, 0]],
    "turns back on itself": [[0, 0], [100, 0], [0, 0], [100, 0]],
    "three points in one": [[0, 0], [0, 0], [0, 0], [100, 50]],
    "one point": [[5, 5], [5, 5], [5, 5], [5, 5]],
    "nearly one point": [[5, 5], [5 + 1e-300, 5], [5, 5], [5, 5 + 1e-300]],
    "tiny": [[0, 0], [1e-200, 0], [2e-200, 1e-200], [3e-200, 3e-200]],
}


@pytest.mark.parametrize("points", CUSPS.values(), ids=CUSPS.keys())
def test_cusps_stay_finite_and_silent(points: list[list[float]]) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = comb(np.array([points], dtype=float), 1.0)
        assert np.isfinite(robust_scale([found]))
    for values in (found.points, found.normals, found.weights, found.curvature):
        assert np.isfinite(values).all()
    extent = np.ptp(np.array(points, dtype=float), axis=0).max()
    np.testing.assert_allclose(np.hypot(*found.normals.T), 1.0 if extent > 0 else 0.0)


def test_no_pieces() -> None:
    assert len(comb(np.empty((0, 4, 2)), 1.0).points) == 0
    assert robust_scale([]) == 0


def test_scale_of_circles_counts_by_length_not_by_sample() -> None:
    long = comb(circle(100.0), spacing=50.0)
    short = comb(circle(1.0), spacing=0.001)  # far more samples, a hundredth of the length
    assert len(short.points) > 10 * len(long.points)
    assert robust_scale([long, short]) == pytest.approx(0.01, rel=1e-4)
    assert robust_scale([long, short], percentile=99.5) == pytest.approx(1.0, rel=1e-4)


def test_scale_leaves_straight_lines_out() -> None:
    line = np.array([[[0.0, 0], [300, 400], [600, 800], [900, 1200]]])
    assert robust_scale([comb(line, 1.0)]) == 0
    assert robust_scale([comb(line, 1.0), comb(circle(10.0), 1.0)]) == pytest.approx(0.1, rel=1e-4)


def test_scale_does_not_depend_on_order() -> None:
    rng = np.random.default_rng(0)
    many: list[Comb] = [comb(circle(r), 1.0) for r in rng.uniform(1, 50, 10)]
    assert robust_scale(many) == pytest.approx(robust_scale(many[::-1]))


def test_relative_without_a_scale_is_flat() -> None:
    assert relative(np.array([1.0, -2.0]), 0.0).tolist() == [0.0, 0.0]
    assert relative(np.array([1.0, -2.0]), 4.0).tolist() == [0.25, -0.5]


@pytest.mark.parametrize(("spacing", "angle"), [(0.0, 1.0), (-1.0, 1.0), (np.nan, 1.0), (1.0, 0.0)])
def test_bad_spacing_is_refused(spacing: float, angle: float) -> None:
    with pytest.raises(ValueError, match="positive"):
        comb(circle(1.0), spacing, angle=angle)
