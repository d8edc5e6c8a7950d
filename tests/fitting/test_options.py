"""Options refuse, where they are made, what cannot be meant."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import glyphspline as gs
from glyphspline.fitting.options import PRESETS
from tests.polygons import circle_contour

WRONG: list[dict[str, Any]] = [
    {"variant": 7}, {"variant": True}, {"variant": 2.5},
    {"tolerance": 0.0}, {"tolerance": -1.0}, {"tolerance": float("nan")}, {"tolerance": float("inf")},
    {"step": 0.0}, {"step": float("nan")}, {"step": "20"}, {"count": 2}, {"count": 5.5}, {"count": 10**9},
    {"corners": "round"}, {"corner_angle": 0.0}, {"corner_angle": 181.0}, {"effort": "slow"},
    {"margin": -0.1}, {"margin": 0.6}, {"fallback": None}, {"max_ratio": 1.2}, {"max_ratio": float("inf")},
    {"max_ratio": 1e7}, {"corner_angle": float("nan")}, {"corner_angle": True}, {"step": 10**400},
    {"variant": 2.0}, {"margin": "0.1"},
    {"precision": 10}, {"precision": -1}, {"residual_tolerance": 0.0}, {"max_iterations": -1}, {"measure": "yes"},
]  # fmt: skip


@pytest.mark.parametrize("wrong", WRONG, ids=str)
def test_a_value_out_of_range_is_refused_by_name(wrong: dict[str, Any]) -> None:
    (name,) = wrong
    with pytest.raises(gs.OptionError, match=f"^{name} is "):
        gs.Options(**wrong)


@pytest.mark.parametrize(
    "wrong",
    [{"step": 5.0, "count": 9}, {"tolerance": 1.0, "step": 5.0}, {"corners": "sharp", "count": 9}],
    ids=str,
)
def test_options_that_contradict_each_other_are_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(gs.OptionError, match="give"):
        gs.Options(**wrong)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({}, "variant 2, margin 0.02, corners sharp, tolerance 1/1000 em, effort fast"),
        (PRESETS["brush"], "variant 2, margin 0.02, corners smooth, tolerance 3/1000 em, effort fast"),
        ({"step": 20, "variant": 3}, "variant 3, margin 0.02, corners smooth, step 20"),
        (PRESETS["type"], "variant 2, margin 0.02, corners sharp, tolerance 1/1000 em, effort best"),
        (
            {"corners": "sharp", "continuity": "g2", "tolerance": 0.5},
            "corners sharp, continuity g2, tolerance 0.5, effort fast",
        ),
        ({"continuity": "g2", "count": 9}, "variant 2, margin 0.02, corners smooth, count 9"),
    ],
    ids=str,
)
def test_a_caption_says_what_made_a_difference(given: dict[str, Any], words: str) -> None:
    assert gs.Options(**given).words == words


def test_numbers_of_numpy_are_numbers() -> None:
    options = gs.Options(step=np.float64(20), precision=np.int64(1))  # type: ignore[arg-type]
    assert options.solver_tolerance == 0.005


def test_the_solver_may_stop_sooner_than_the_digits_written() -> None:
    outline = gs.Outline("o", contours=(circle_contour(300),))
    few, many = (
        gs.convert(outline, gs.Options(count=12, residual_tolerance=tolerance)).contours[0].measures
        for tolerance in (1.0, 1e-9)
    )
    assert few.residual is not None
    assert many.residual is not None
    assert many.residual < 1e-9 < few.residual < 1.0


@pytest.mark.parametrize("options", [{"step": 40.0}, {"count": 5}, {}, {"corners": "sharp"}], ids=str)
def test_every_mode_has_its_corners_by_the_angle_asked_for(options: dict[str, Any]) -> None:
    """Joins that turn by 36 degrees are vertices of the result if they are corners."""
    egg = gs.Contour.from_segments(
        np.array([[[0, 0], [50, 190], [350, 190], [400, 0]], [[400, 0], [340, -150], [60, -150], [0, 0]]], dtype=float)
    )
    outline = gs.Outline("egg", contours=(egg,))
    corners, bends = (gs.convert(outline, gs.Options(**options, corner_angle=angle)) for angle in (20.0, 45.0))
    assert has_both_tips(corners)
    assert gs.to_svg(corners) != gs.to_svg(bends)


def has_both_tips(glyph: gs.GlyphResult) -> bool:
    polygon = glyph.contours[0].polygon
    return all((np.hypot(*(polygon - tip).T) < 1e-9).any() for tip in ([0.0, 0.0], [400.0, 0.0]))
