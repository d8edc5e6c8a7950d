"""The same bits whatever the number of threads, and whatever else is in the list."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import glyphspline as gs
from glyphspline.interpolation.batch import _parts, interpolate_batch, over_threads
from glyphspline.interpolation.method import Method
from glyphspline.interpolation.polygon import Polygons
from tests.polygons import polygon, uniform


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"variant": 1, "max_iterations": 20},
        {"margin": 0.02, "fallback": "peak"},
        {"closed": False},
        {"variant": 4, "max_iterations": 5},
    ],
)
def test_any_number_of_threads_gives_the_same_bits(options: dict[str, Any]) -> None:
    contours = [polygon(number, scale=3)[1] for number in range(60)]
    one = gs.interpolate_many(contours, threads=1, **options)
    for threads in (2, 3, 8):
        for a, b in zip(one, gs.interpolate_many(contours, threads=threads, **options), strict=True):
            assert a.spline.control_points.tobytes() == b.spline.control_points.tobytes()
            assert a.parameters.tobytes() == b.parameters.tobytes()
            assert a.residuals.tobytes() == b.residuals.tobytes()
    for k in (0, 7, 59):
        alone = gs.interpolate(contours[k], **options)
        assert alone.spline.control_points.tobytes() == one[k].spline.control_points.tobytes()


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"variant": 1},
        {"variant": 3},
        {"variant": 4, "max_iterations": 8},
        {"margin": 0.02, "fallback": "peak"},
        {"knots": "uniform"},
    ],
)
def test_results_do_not_depend_on_batching(options: dict[str, Any]) -> None:
    rng = np.random.default_rng(9)
    for sizes in ([3, 13, 14, 30, 31], list(range(3, 34)), [7] * 9, [12, 12, 29, 29, 29], [63, 64, 65, 5, 260]):
        contours = [polygon(int(rng.integers(500)))[1] for _ in range(5)] + [uniform(rng, n) for n in sizes]
        contours[2] = np.repeat(contours[2], 2, axis=0)  # duplicates are merged
        contours.insert(4, np.zeros((6, 2)))  # refused
        offsets = np.cumsum([0, *map(len, contours)])
        settings: dict[str, Any] = {"residual_tolerance": 1e-7, "max_iterations": 60, **options}
        together = interpolate_batch(Polygons(np.concatenate(contours), offsets), Method(**settings), threads=1)
        for k, contour in enumerate(contours):
            alone = interpolate_batch(Polygons(contour, np.array([0, len(contour)])), Method(**settings), threads=1)
            assert together.arrays.whole[k].tolist() == alone.arrays.whole[0].tolist(), k
            if alone.arrays.whole[0, 0]:
                continue
            a, b = together.results()[k], alone.results()[0]
            assert a.rate_bound == b.rate_bound
            for x, y in (
                (a.spline.control_points, b.spline.control_points),
                (a.spline.knots, b.spline.knots),
                (a.parameters, b.parameters),
                (a.intervals, b.intervals),
                (a.residuals, b.residuals),
                (a.merged, b.merged),
            ):
                assert x.tobytes() == y.tobytes(), k


def test_every_polygon_of_a_long_list_is_in_one_part() -> None:
    rng = np.random.default_rng(3)
    for sizes in ([5000], [5000, 3], [0, 0, 9000, 0], list(rng.integers(0, 300, 200)), [10] * 3000):
        offsets = np.cumsum([0, *sizes])
        for threads in (1, 2, 5):
            parts = _parts(offsets, threads)
            assert [k for first, stop in parts for k in range(first, stop)] == list(range(len(sizes)))


def test_an_error_in_any_thread_is_raised_and_order_is_kept() -> None:
    assert over_threads(lambda k: k * k, range(50), threads=3) == [k * k for k in range(50)]

    def work(k: int) -> int:
        if k == 7:
            raise KeyError(k)
        return k

    with pytest.raises(KeyError):
        over_threads(work, range(50), threads=3)
