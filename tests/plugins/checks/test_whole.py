"""Open paths, misses of heights, mixed outlines, and contours that cancel each other: glyphs that have just this."""

from __future__ import annotations

import numpy as np
import pytest

from glyphspline.outlines.open_paths import there_and_back
from glyphspline.outlines.outline import Contour, Outline
from glyphspline.plugins.checks.check import check_many
from glyphspline.plugins.checks.finding import Finding

from .test_enclosed import box, disc, polygon

KINDS = ("open contour", "alignment miss", "mixed outlines", "cancelling component")


def found(*contours: Contour, heights: tuple[float, ...] = (0.0, 500.0, 700.0)) -> list[Finding]:
    """The findings of these kinds; another glyph before it in the batch changes nothing."""
    one, before = Outline("test", contours=contours), Outline("other", contours=[box(0, 0, 100, 300)])
    first, again = check_many([one], heights=heights), check_many([before, one], heights=heights)
    assert again == [[], first[0]]
    return [item for item in first[0] if item.kind in KINDS]


def stroke(*points: tuple[float, float]) -> Contour:
    return Contour(*there_and_back(np.array(points, dtype=np.float64), np.ones(len(points) - 1, dtype=np.int64)))


def test_an_open_path_is_named_and_nothing_else_is_looked_for_in_it() -> None:
    zigzag = stroke((0, 0), (100, 700), (1, 0))
    glyph = Outline("test", contours=[box(200, 0, 100, 100), zigzag, box(400, 0, 100, 1)])
    (items,) = check_many([glyph])
    assert [(each.kind, each.contour, each.value) for each in items if each.contour == 1] == [("open contour", 1, 2)]
    assert {each.contour for each in items if each.kind == "short"} == {2}
    (item,) = [each for each in items if each.kind == "open contour"]
    assert (item.point, item.level, item.other) == ((0, 0), "INFO", None)


@pytest.mark.parametrize(("y", "is_found"), [(1, True), (-2, True), (3, False), (0, False)])
def test_a_point_misses_a_height_that_another_one_is_on(y: float, is_found: bool) -> None:
    legs = polygon([(0, 0), (100, 0), (100, 300), (200, 300), (200, y), (300, y + 40), (300, 400), (0, 400)])
    assert [(each.point, each.value, each.detail) for each in found(legs)] == [((200, y), abs(y), 0.0)] * is_found


def test_flat_tops_miss_a_height_by_themselves_but_overshoots_do_not() -> None:
    assert [each.point[1] for each in found(box(0, 3, 100, 696))] == [699, 699]
    assert {each.detail for each in found(box(0, 3, 100, 696))} == {700.0}
    assert found(disc(300, 349, 350)) == []
    assert found(box(0, 3, 100, 696), heights=(0.0,)) == []


def test_quadratics_beside_cubics_are_named_once_a_glyph() -> None:
    cubic = disc(300, 300, 200)
    quadratic = Contour(np.array([[0, 0], [50, -50], [100, 0], [50, 50]], dtype=np.float64), np.array([2, 2]))
    assert found(cubic, cubic) == []
    (item,) = found(cubic, quadratic)
    assert (item.kind, item.contour, item.segment, item.value) == ("mixed outlines", 1, 0, 2)


def test_contours_that_overlap_and_run_in_opposite_directions_cancel() -> None:
    (item,) = found(box(0, 10, 100, 100), box(50, 60, 100, 100, -1))
    assert (item.kind, item.contour, item.other, item.value) == ("cancelling component", 0, 1, 100)
    assert found(box(0, 10, 100, 100), box(50, 60, 100, 100)) == []
    assert found(box(0, 10, 300, 300), box(50, 60, 100, 100, -1)) == []  # a counter


def test_a_stem_through_a_counter_cancels_nothing_and_a_copy_turned_round_all() -> None:
    assert found(box(0, 10, 300, 300), box(50, 60, 200, 200, -1), box(140, 15, 20, 290)) == []
    assert [each.kind for each in found(box(0, 10, 100, 100), box(0, 10, 100, 100, -1))] == ["cancelling component"]
