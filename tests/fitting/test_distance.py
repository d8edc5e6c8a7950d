"""The certified distance: never below the true one, close to it, whatever is taken to belong together."""

from __future__ import annotations

import numpy as np
import pytest

import glyphspline as gs
from glyphspline.curves.pairing import pair_stretches
from glyphspline.types import FloatArray
from tests.polygons import circle_contour, square_contour


def true_distance(a: gs.Contour, b: gs.Contour, samples: int = 6000) -> float:
    """Two-sided distance of dense polylines, too small by what they miss."""
    p, q = (c.at(np.linspace(0, len(c), samples)) for c in (a, b))
    gaps = np.hypot(*np.moveaxis(p[::5, None] - q[None], 2, 0)).min(axis=1).max()
    back = np.hypot(*np.moveaxis(q[::5, None] - p[None], 2, 0)).min(axis=1).max()
    return float(max(gaps, back))


def certified(result: FloatArray, source: FloatArray, anchors: FloatArray, sharpness: float) -> tuple[float, float]:
    """Bound of the distance of two contours, and the largest distance seen."""
    parts = [(rows, np.array([0, len(rows)])) for rows in (result, source, anchors)]
    bounds, gaps = pair_stretches(parts[0], parts[1], parts[2], sharpness)
    return float(bounds.max()), float(gaps.max())


def joints_together(contour: gs.Contour) -> FloatArray:
    """Anchors that pair the joints of two contours of the same number of segments."""
    places = np.arange(len(contour) + 1, dtype=np.float64)
    return np.stack([places, places], axis=1)


def test_a_contour_is_at_no_distance_from_itself() -> None:
    circle = circle_contour(300)
    bound, seen = certified(circle.cubics(), circle.cubics(), joints_together(circle), 0.01)
    assert 0 < bound < 1e-9
    assert seen == 0


@pytest.mark.parametrize("growth", [0.01, 1.0, 20.0])
def test_circles_in_one_another(growth: float) -> None:
    inner, outer = circle_contour(100), circle_contour(100 + growth)
    bound, _ = certified(outer.cubics(), inner.cubics(), joints_together(inner), 1e-3)
    # Both circles are out of true by 2.7e-4 of their radius.
    assert growth <= bound <= growth * 1.0003 + 1e-3


def test_the_bound_is_never_below_the_distance() -> None:
    rng = np.random.default_rng(5)
    for _ in range(10):
        circle = circle_contour(100)
        other = gs.Contour(circle.points + rng.normal(0, 6, circle.points.shape), circle.degrees)
        bound, seen = certified(other.cubics(), circle.cubics(), joints_together(circle), 0.01)
        truth = true_distance(other, circle, 3000)
        assert truth - 0.05 <= bound
        assert seen <= bound


def test_wrong_anchors_loosen_the_bound_and_never_break_it() -> None:
    inner, outer = circle_contour(100), circle_contour(101)
    anchors = joints_together(inner)
    anchors[1:-1, 1] += [0.3, -0.2, 0.1]
    loose, _ = certified(outer.cubics(), inner.cubics(), anchors, 0.01)
    assert loose > 10
    whole = anchors[[0, -1]]
    assert certified(outer.cubics(), inner.cubics(), whole, 0.01)[0] < 1.05


def test_a_loop_between_two_samples_is_seen() -> None:
    square = square_contour(100).cubics()
    looped = square.copy()
    # The side's middle runs out 60 and comes back: a hairpin with its feet on the line.
    looped[0, 1:3] = [[50, -80], [50, -80]]
    bound, _ = certified(looped, square, np.array([[0.0, 0.0], [4.0, 4.0]]), 0.01)
    assert bound == pytest.approx(60, abs=1)


def test_other_numbers_of_segments() -> None:
    circle = circle_contour(100)
    finer = gs.interpolate(gs.sample(circle, count=24)).spline.to_bezier()
    bound, _ = certified(finer, circle.cubics(), np.array([[0.0, 0.0], [24.0, 4.0]]), 1e-3)
    truth = true_distance(gs.Contour.from_segments(finer), circle)
    # Points a tenth of a unit apart add half of that.
    assert truth - 0.06 <= bound <= truth + 0.01
