"""The same bits whatever the number of threads, and whatever else is in the list."""

from __future__ import annotations

from typing import Any

import pytest

import glyphspline as gs

from .polygons import polygon


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"variant": 1, "max_iterations": 20},
        {"finish": "solve", "margin": 0.02, "fallback": "peak"},
        {"closed": False},
        {"variant": 4, "max_iterations": 5},
    ],
)
def test_any_number_of_threads_gives_the_same_bits(options: dict[str, Any]) -> None:
    contours = [polygon(number, scale=3)[1] for number in range(200)]
    one = gs.interpolate_many(contours, threads=1, **options)
    for threads in (2, 3, 8):
        for a, b in zip(one, gs.interpolate_many(contours, threads=threads, **options), strict=True):
            assert a.spline.control_points.tobytes() == b.spline.control_points.tobytes()
            assert a.parameters.tobytes() == b.parameters.tobytes()
            assert a.residuals.tobytes() == b.residuals.tobytes()
    for k in (0, 7, 199):
        alone = gs.interpolate(contours[k], **options)
        assert alone.spline.control_points.tobytes() == one[k].spline.control_points.tobytes()
