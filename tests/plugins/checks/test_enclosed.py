"""Overlaps, self-crossings, doubled strands and directions: outlines that have just this fault, and ones that nearly
have it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from glyphspline.outlines.flaws.kinds import Thresholds
from glyphspline.outlines.outline import Contour, FontMetrics, Outline
from glyphspline.plugins.checks.check import check, check_many
from glyphspline.plugins.checks.finding import Finding
from glyphspline.types import FloatArray

KINDS = ("overlap", "crossing", "direction", "covered", "doubled")

Points = Sequence[tuple[float, float]]


def polygon(points: Points) -> Contour:
    return Contour(np.array(points, dtype=np.float64), np.ones(len(points), dtype=np.int64))


def box(x: float, y: float, width: float, height: float, turn: int = 1) -> Contour:
    """Counter-clockwise, or clockwise for ``turn`` -1."""
    corners = [(x, y), (x + width, y), (x + width, y + height), (x, y + height)]
    return polygon(corners[::turn])


def disc(x: float, y: float, radius: float, turn: int = 1) -> Contour:
    k = 0.5523
    quarter = np.array([(1, 0), (1, k), (k, 1)])
    around = np.concatenate([quarter @ np.array([[c, s], [-s, c]]) for c, s in ((1, 0), (0, 1), (-1, 0), (0, -1))])
    contour = Contour(radius * around + (x, y), np.full(4, 3))
    return contour if turn > 0 else contour.reversed()


def found(*contours: Contour, em: float = 1000.0, thresholds: Thresholds | None = None) -> list[Finding]:
    outline = Outline("test", contours=contours, metrics=FontMetrics(units_per_em=em))
    return [item for item in check(outline, thresholds or Thresholds()) if item.kind in KINDS]


def kinds(*contours: Contour) -> list[tuple[str, int, int | None]]:
    """Kind, contour and other contour of each finding; the same when all contours run the other way round."""
    first = [(item.kind, item.contour, item.other) for item in found(*contours)]
    turned = [(item.kind, item.contour, item.other) for item in found(*[contour.reversed() for contour in contours])]
    assert sorted(first, key=str) == sorted(turned, key=str)
    return first


def test_contours_that_cross_are_told_once_with_the_other_where_the_first_crosses_first() -> None:
    (item,) = found(box(0, 0, 100, 100), box(50, 50, 100, 100))
    assert (item.kind, item.level, item.contour, item.other, item.value) == ("overlap", "INFO", 0, 1, 2)
    assert item.segment + item.parameter == pytest.approx(1.5)
    assert item.point == pytest.approx((100, 50))
    assert item.sentence == "crosses contour 1"


def test_three_contours_that_cross_each_other_are_three_pairs() -> None:
    assert [(c, d) for _, c, d in kinds(disc(0, 0, 50), disc(50, 0, 50), disc(25, 40, 50))] == [(0, 1), (0, 2), (1, 2)]


@pytest.mark.parametrize(
    "other",
    [
        pytest.param(box(100.5, 0, 50, 50), id="beside it"),
        pytest.param(box(100, 100, 50, 50), id="corner to corner"),
        pytest.param(polygon([(100, 50), (150, 0), (150, 100)]), id="a corner on an edge"),
        pytest.param(disc(150, 50, 50), id="a round one on an edge"),
    ],
)
def test_contours_that_only_touch_do_not_overlap(other: Contour) -> None:
    assert kinds(box(0, 0, 100, 100), other) == []


def test_a_contour_that_crosses_itself_is_told_once_with_the_number_of_places() -> None:
    (item,) = found(polygon([(0, 0), (100, 0), (100, 40), (20, 40), (20, 60), (60, 60), (60, 20), (0, 20)]))
    assert (item.kind, item.contour, item.other, item.value) == ("crossing", 0, None, 1)
    assert item.point == pytest.approx((60, 40))
    assert item.sentence == "crosses itself"
    loop = Contour(
        np.array([(0, 0), (200, 100), (-100, 100), (100, 0), (50, -100)], dtype=np.float64), np.array([3, 1, 1])
    )
    assert kinds(loop) == [("crossing", 0, None)]


def test_a_contour_that_touches_itself_does_not_cross_itself() -> None:
    assert kinds(polygon([(0, 0), (100, 0), (100, 50), (50, 0), (0, 50)])) == []


def test_a_counter_runs_against_its_outer_contour_whichever_way_that_runs() -> None:
    assert kinds(disc(0, 0, 100), disc(0, 0, 60, -1)) == []
    (item,) = found(disc(0, 0, 100), disc(0, 0, 60))
    assert (item.kind, item.contour, item.other) == ("covered", 1, 0)
    assert item.value == pytest.approx(np.pi * 60**2, rel=1e-3)


def test_an_island_in_a_counter_runs_like_the_outer_contour() -> None:
    ring = [disc(0, 0, 100), disc(0, 0, 80, -1)]
    assert kinds(*ring, box(-20, -20, 40, 40)) == []
    assert kinds(*ring, box(-20, -20, 40, 40, -1)) == [("direction", 2, None)]


def test_an_outer_contour_unlike_the_others_is_wrong_with_none_of_its_counters() -> None:
    dots = [disc(-50, 200, 20), disc(50, 200, 20)]
    assert kinds(disc(0, 0, 100), disc(0, 0, 60, -1), *dots) == []
    assert kinds(disc(0, 0, 100, -1), disc(0, 0, 60), *dots) == [("direction", 0, None)]


def test_of_one_against_one_the_smaller_is_wrong() -> None:
    assert kinds(disc(0, 300, 20, -1), box(-20, 0, 40, 200)) == [("direction", 0, None)]


def test_a_part_that_overlaps_is_not_hidden_unless_all_of_it_is() -> None:
    stem, bar = box(0, 0, 40, 300), box(-60, 100, 160, 30)
    assert [kind for kind, _, _ in kinds(stem, bar)] == ["overlap"]
    assert kinds(stem, box(10, 100, 20, 30)) == [("covered", 1, 0)]
    assert sorted(kinds(stem, box(-60, 100, 160, 30, -1))) == [("direction", 1, None), ("overlap", 0, 1)]


CROSS = [box(290, 380, 40, 320), box(290, 60, 40, 320), box(0, 360, 310, 40), box(310, 360, 310, 40)]
"""Four parts that abut in the middle."""


@pytest.mark.parametrize(
    "patched",
    [
        pytest.param([*CROSS, box(280, 350, 60, 60)], id="over the joint, beyond it"),
        pytest.param([*CROSS, box(300, 370, 20, 20)], id="inside the joint"),
        pytest.param([*CROSS, disc(310, 380, 30)], id="round"),
        pytest.param([box(0, 0, 40, 300), box(-60, 100, 160, 30), box(5, 105, 30, 20)], id="where two overlap"),
        pytest.param([box(0, 0, 100, 50), box(100, 0, 100, 50), box(80, 10, 40, 30)], id="over a seam"),
        pytest.param([disc(0, 0, 100), disc(120, 0, 100), box(20, -20, 80, 40)], id="across a lens"),
    ],
)
def test_a_patch_over_a_joint_of_others_has_no_direction(patched: list[Contour]) -> None:
    assert {"direction", "covered"}.isdisjoint(kind for kind, _, _ in kinds(*patched))


def test_a_contour_inside_two_others_has_ink_on_both_sides_whichever_way_it_runs() -> None:
    around = [box(0, 0, 300, 300), box(20, 20, 260, 260)]
    for turn in (1, -1):
        assert kinds(*around, box(100, 100, 50, 50, turn)) == [("covered", 1, 0)]


def test_a_contour_that_runs_both_ways_has_no_direction() -> None:
    eight = polygon([(0, 0), (300, 320), (300, 0), (0, 300)])
    others = [box(400, 0, 90, 90), box(500, 0, 90, 90)]
    assert [kind for kind, _, _ in kinds(eight, *others)] == ["crossing"]


def test_the_box_of_a_contour_around_another_does_not_make_it_a_counter() -> None:
    corner = polygon([(0, 0), (100, 0), (100, 10), (10, 10), (10, 100), (0, 100)])
    assert kinds(corner, disc(60, 60, 20)) == []


def test_a_point_beside_a_curve_is_inside_by_the_curve_not_by_its_chords() -> None:
    sliver = polygon([(70.6, 70.6), (60, 75), (75, 60)])  # in the disc, beyond its chords of an eighth
    assert kinds(disc(0, 0, 100), sliver) == [("covered", 1, 0)]
    assert kinds(disc(0, 0, 100), polygon([(71, 71), (80, 75), (75, 80)])) == []


@pytest.mark.parametrize("apart", [0.0, 0.6])
def test_a_spur_is_told_from_five_thousandths_of_an_em(apart: float) -> None:
    def spur(length: float) -> Contour:
        return polygon([(0, 0), (200, 0), (200, 100), (100 + apart, 100), (100, 100 + length), (100, 100), (0, 100)])

    assert kinds(spur(4.8)) == []
    (item,) = found(spur(30))
    assert (item.kind, item.contour, item.segment, item.other) == ("doubled", 0, 4, None)
    assert item.value == pytest.approx(30, abs=0.1)
    assert item.point == (100, 130)
    assert item.sentence == "lies on itself for 30 units"
    assert [x.value for x in found(spur(6), em=2000)] == []
    assert len(found(spur(11), em=2000)) == 1
    assert found(spur(30), thresholds=Thresholds(doubled=31)) == []


def test_a_thin_wedge_and_a_sharp_tip_are_no_spurs() -> None:
    assert kinds(polygon([(0, 0), (200, 0), (200, 100), (103, 100), (101.5, 200), (100, 100), (0, 100)])) == []
    star = [(0, 200), (3, 60), (60, 3), (200, 0), (60, -3), (3, -60), (0, -200), (-3, -60), (-60, -3), (-200, 0)]
    tips = Contour(np.array([*star, (-60, 3), (-3, 60)], dtype=np.float64), np.full(4, 3))
    assert kinds(tips) == []


@pytest.mark.parametrize(("width", "length", "em", "told"), [
    (2, 40, 1000, True), (3, 15, 1000, True), (2, -30, 1000, True), (4, 40, 1000, False), (2, 5, 1000, False),
    (5, 40, 2000, True), (2, 10, 2000, False),
])  # fmt: skip
def test_a_spike_has_a_width(width: float, length: float, em: float, told: bool) -> None:
    base = [(100 + width / 2, 100), (100, 100 + length), (100 - width / 2, 100)]
    contour = polygon([(0, 0), (200, 0), (200, 100), *base, (0, 100)])
    outline = Outline("test", contours=[contour], metrics=FontMetrics(units_per_em=em))
    found = [item for item in check(outline) if item.kind in ("spike", "doubled", "crossing")]
    assert [(item.kind, item.point) for item in found] == [("spike", (100, 100 + length))] * told
    assert all(item.value == pytest.approx(abs(length), rel=0.1) for item in found)


def test_a_curved_spur_and_one_of_several_segments_are_told_once() -> None:
    way = np.array([(100, 100), (110, 120), (130, 140), (160, 150)], dtype=np.float64)
    back = np.array([(0, 100), (0, 0), (200, 0)], dtype=np.float64)
    points = np.concatenate([back, [(200, 100)], way, way[-2::-1]])
    curved = Contour(points, np.array([1, 1, 1, 1, 3, 3, 1]))
    (item,) = found(curved)
    assert (item.kind, item.point) == ("doubled", (160, 150))
    assert item.value == pytest.approx(np.hypot(*np.diff(sampled(way), axis=0).T).sum(), rel=1e-2)
    bent = polygon([(0, 100), (0, 0), (200, 0), (200, 100), (100, 100), (120, 140), (120, 190), (120, 140), (100, 100)])
    (item,) = found(bent)
    assert (item.kind, item.segment) == ("doubled", 6)
    assert item.value == pytest.approx(50 + np.hypot(20, 40))


def sampled(cubic: FloatArray) -> FloatArray:
    t = np.linspace(0, 1, 200)[:, None]
    points: FloatArray = (
        (1 - t) ** 3 * cubic[0] + 3 * (1 - t) * t * ((1 - t) * cubic[1] + t * cubic[2]) + t**3 * cubic[3]
    )
    return points


def test_a_counter_joined_by_a_bridge_lies_on_itself() -> None:
    keyhole = [
        (0, 0),
        (100, 0),
        (100, 100),
        (0, 100),
        (0, 50),
        (30, 50),
        (30, 70),
        (70, 70),
        (70, 30),
        (30, 30),
        (30, 50),
    ]
    (item,) = found(polygon([*keyhole, (0, 50)]))
    assert (item.kind, item.other) == ("doubled", None)
    assert item.value == pytest.approx(30)


def test_a_copy_of_a_contour_is_told_wherever_it_begins() -> None:
    ring = disc(0, 0, 100)
    (item,) = found(ring, disc(0, 0, 100))
    assert (item.kind, item.contour, item.other) == ("doubled", 0, 1)
    assert item.value == pytest.approx(2 * np.pi * 100, rel=1e-2)
    turned = Contour(np.roll(ring.points, 3, axis=0), ring.degrees)
    assert kinds(ring, turned) == [("doubled", 0, 1)]
    assert kinds(ring, disc(0, 0, 97, -1)) == []


def test_edges_that_abut_are_told_and_shared_edges_of_an_overlap_are_not() -> None:
    (item,) = found(box(0, 0, 100, 100), box(100, 20, 50, 50))
    assert (item.kind, item.value, item.other, item.sentence) == ("doubled", 50, 1, "lies on contour 1 for 50 units")
    assert kinds(box(0, 0, 100, 100), box(100, 20, 50, 4)) == []
    assert [kind for kind, _, _ in kinds(box(0, 0, 100, 30), box(30, 0, 40, 200))] == ["overlap"]
    stem_over_both = box(90, -50, 20, 200)
    assert {kind for kind, _, _ in kinds(box(0, 0, 100, 100), box(100, 20, 50, 50), stem_over_both)} == {"overlap"}


def test_glyphs_do_not_see_each_other() -> None:
    one = Outline("one", contours=[box(0, 0, 100, 100)])
    other = Outline("other", gid=1, contours=[box(50, 50, 100, 100), box(60, 60, 10, 10)])
    together = [[item for item in items if item.kind in KINDS] for items in check_many([one, other, one])]
    assert [len(items) for items in together] == [0, 1, 0]
    assert together[1] == [item for item in check(other) if item.kind in KINDS]
    assert (together[1][0].contour, together[1][0].other) == (1, 0)


def test_scale_and_place_do_not_matter() -> None:
    contours = [disc(0, 0, 100), disc(120, 0, 60, -1), box(-20, -20, 40, 40), box(-20, -20, 40, 40)]
    first = [(item.kind, item.contour, item.other) for item in found(*contours)]
    for scale, dx in ((0.024, 0.0), (7.0, 1e4)):
        moved = [Contour(scale * contour.points + dx, contour.degrees) for contour in contours]
        assert [(item.kind, item.contour, item.other) for item in found(*moved, em=1000 * scale)] == first
