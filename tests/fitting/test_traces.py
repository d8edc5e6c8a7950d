"""Traced outlines: noise within the tolerance makes no segments, and corners that show stay."""

from typing import Any

import numpy as np
import pytest

import glyphspline as gs
from glyphspline.curves.bezier import evaluate
from glyphspline.fitting.traces import are_traces
from glyphspline.outlines.segments import all_cubics
from glyphspline.types import FloatArray
from tests.places import GYOSHO

E = ((100, 0), (500, 0), (500, 80), (180, 80), (180, 310), (450, 310), (450, 390), (180, 390), (180, 620), (500, 620),
     (500, 700), (100, 700))  # fmt: skip
MODES: dict[str, dict[str, Any]] = {"smooth": {"corners": "smooth"}, "sharp": {}, "g2": {"continuity": "g2"}}


def noisy(points: FloatArray, noise: float = 0.7) -> FloatArray:
    return points + np.random.default_rng(4).uniform(-noise, noise, points.shape)


def circle(count: int, radius: float = 300.0) -> FloatArray:
    angles = np.arange(count) * (2 * np.pi / count)
    return 400.0 + radius * np.column_stack([np.cos(angles), np.sin(angles)])


def letter(step: float = 2.0) -> FloatArray:
    """The E with a point every two units or so."""
    sides = []
    for a, b in zip(np.array(E, float), np.roll(np.array(E, float), -1, axis=0), strict=True):
        n = int(np.hypot(*(b - a)) / step)
        sides.append(a + (b - a) * np.arange(n)[:, None] / n)
    return np.concatenate(sides)


def stairs() -> FloatArray:
    """A slanted stem on the grid, 90 wide: a step of one unit every 20."""
    left = np.column_stack([100.0 + (np.arange(70) + 1) // 2, 20.0 * (np.arange(70) // 2)])
    return np.concatenate([left[::-1], left + np.array([90.0, 0.0])])


def outline(points: FloatArray, degree: int = 1) -> gs.Outline:
    return gs.Outline("trace", contours=(gs.Contour(points, np.full(len(points) // degree, degree)),))


def fitted(points: FloatArray, degree: int = 1, tolerance: float = 5.0, **options: Any) -> tuple[Any, FloatArray]:
    """The one contour's result, which has to be certified; and samples of its curve."""
    (found,) = gs.convert(outline(points, degree), gs.Options(tolerance=tolerance, **options)).contours
    assert found.measures.within_tolerance
    assert not found.measures.new_crossings
    assert not found.measures.source_kept
    cubics = all_cubics(gs.Outline("curve", contours=(found.curve,)).arrays)
    return found, evaluate(cubics.repeat(200, axis=0), np.tile(np.linspace(0.0, 1.0, 200), len(cubics)))


@pytest.mark.parametrize("mode", MODES)
def test_a_noisy_circle_is_a_circle(mode: str) -> None:
    found, points = fitted(noisy(circle(1_500)), **MODES[mode])
    assert found.measures.segments <= 8
    assert np.abs(np.hypot(*(points - 400.0).T) - 300.0).max() < 5.0


def test_a_circle_of_noisy_quadratics_too() -> None:
    found, points = fitted(noisy(circle(1_200)), degree=2)
    assert found.measures.segments <= 8
    assert np.abs(np.hypot(*(points - 400.0).T) - 300.0).max() < 5.0


def test_corners_of_a_noisy_letter_stay() -> None:
    found, points = fitted(noisy(letter()))
    assert found.measures.segments <= 14
    apart = np.hypot(*(points[:, None] - np.array(E)).transpose(2, 0, 1)).min(axis=0)
    assert apart.max() < 2.5  # what rounds a corner within the tolerance passes it at more


def test_a_smooth_curve_of_a_noisy_letter_takes_few_vertices_more_than_the_clean_one() -> None:
    clean, _ = fitted(np.array(E, float), corners="smooth")
    found, _ = fitted(noisy(letter()), corners="smooth")
    assert found.measures.segments <= 1.25 * clean.measures.segments


def test_stairs_within_the_tolerance_are_a_line() -> None:
    assert fitted(stairs())[0].measures.segments == 4


def test_the_distance_is_that_from_the_trace() -> None:
    points = noisy(circle(1_500))
    found, curve = fitted(points, corners="smooth")
    nearest = np.array([np.hypot(*(curve - point).T).min() for point in points])
    assert nearest.max() - 0.5 <= found.measures.deviation_bound <= 5.0


def test_noise_beyond_the_tolerance_is_followed() -> None:
    found, _ = fitted(noisy(circle(300), 6.0), tolerance=1.0)
    assert found.measures.segments > 100


def test_what_a_brush_font_has_is_no_trace() -> None:
    font = gs.open_font(GYOSHO)
    for glyph in font.outlines(font.select(all_glyphs=True)):
        assert not are_traces(glyph.arrays, 12.0, 3 * glyph.metrics.units_per_em / 1000).any()
    assert are_traces(outline(noisy(circle(1_500))).arrays, 12.0, 5.0).all()
