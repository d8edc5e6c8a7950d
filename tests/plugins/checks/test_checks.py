"""Findings: outlines built to have exactly one fault, ones that nearly have it, and what must not matter."""

from __future__ import annotations

import dataclasses
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import glyphspline as gs
from glyphspline.curves.bezier import split
from glyphspline.outlines.outline import Contour
from glyphspline.plugins.checks.check import check_many
from glyphspline.plugins.checks.finding import Finding, severity
from glyphspline.types import FloatArray
from tests.drawings import circle
from tests.places import FONTS

PLAIN = gs.open_font(FONTS / "kouzan-gyosho.otf").outline("A").metrics


def outline(*contours: Contour, em: float = 1000.0) -> gs.Outline:
    return gs.Outline("test", contours=contours, metrics=dataclasses.replace(PLAIN, units_per_em=em))


def closed(*segments: object) -> Contour:
    """Segments by their points after the first, from (0, 0) on; the last one ends there."""
    parts, at = [], [0.0, 0.0]
    for segment in segments:
        part = np.array([at, *np.reshape(np.array(segment, dtype=float), (-1, 2))])
        parts.append(part)
        at = part[-1].tolist()
    return Contour.from_segments(parts)


def kinds(contour: Contour, em: float = 1000.0) -> dict[str, float]:
    return {each.kind: each.value for each in gs.check(outline(contour, em=em))}


def arch(curve: object) -> Contour:
    """A curve from (0, 0) on, closed at corners by lines far below it."""
    last = np.reshape(np.array(curve, dtype=float), (-1, 2))[-1]
    return closed(curve, [last[0], -300], [last[0] / 2, -333.3], [0, -280], [0, 0])


def arch_of(arriving: list[float], leaving: list[float], turned: bool = False) -> Contour:
    """Two curves that meet at (0, 0), both going down from there, by the other ends of their handles there."""
    top = np.array([[-100, -90], [-100, -36], arriving, [0, 0], leaving, [120, -50], [120, -90]])
    way = top[:, ::-1] * [-1, 1] if turned else top
    corners = np.array([[220, -300], [-200, -330]])
    corners = corners[:, ::-1] * [-1, 1] if turned else corners
    return Contour.from_segments(
        [way[:4], way[3:], np.array([way[-1], corners[0]]), corners, np.array([corners[1], way[0]])]
    )


def short_and_turned(rise: float) -> Contour:
    """A line of eight units, smoothly joined to a curve but for this rise of its handle along 60 units."""
    return closed([8, 0], [68, rise, 110, 60, 120, 100], [110, 300], [-80, 250], [0, 0])


BACK = arch([20, 21, 96, 68, 100, 100])
"""The first control point lies on the outer side of the chord."""

FAULTS: dict[str, tuple[str, Contour, float]] = {
    # A quarter with its first handle 20 beyond the place where both meet.
    "handle too long": ("handles", arch([0, 120, 80, 100, 100, 100]), 0.2),
    "both handles too long": ("handles", arch([0, 120, -30, 100, 100, 100]), 0.3),
    "handle past the other end": ("handles", arch([130, -20, 60, 20, 100, 0]), 0.3),
    "bends back": ("inflection", BACK, np.nan),
    "straight cubic": ("straight", arch([30, 0.4, 70, 0.4, 100, 0]), 0.3),
    "straight quadratic": ("straight", arch([50, 0.8, 100, 0]), 0.4),
    "slanted": ("slanted", closed([300, 2], [300, 250], [0, 250], [0, 0]), np.degrees(np.arctan(2 / 300))),
    "slanted by a unit": ("slanted", closed([300, 1], [300, 250], [0, 250], [0, 0]), np.degrees(np.arctan(1 / 300))),
    "no point at the extremum": ("extremum", arch([0, 40, 100, 40, 100, 0]), 30.0),
    "no point at the extremum of a quadratic": ("extremum", arch([50, 60, 100, 0]), 30.0),
    "short line": ("short", closed([300, 0], [300, 2], [0, 300], [0, 0]), 2.0),
    "leftover": ("leftover", closed([140, 0], [300, 0], [300, 250], [0, 250], [0, 0]), 0.0),
    "leftover but for rounding": ("leftover", closed([140, 51], [300, 109], [0, 400], [0, 0]), 40 / np.hypot(300, 109)),
    "handle of no length": ("retracted", arch([0, 0, 45, 100, 100, 100]), np.hypot(100, 100)),
    "handle of a quadratic on its end": ("retracted", closed([10, 9, 10, 9], [300, -40], [0, -200], [0, 0]), np.nan),
    "handles not level": ("unlevel", arch_of([-50, -2], [60, 2.4]), 2.4),
    "handles not upright": ("unlevel", arch_of([-50, -2], [60, 2.4], turned=True), 2.4),
    "two lines that turn": (
        "turn",
        closed([200, 5], [400, 0], [400, 300], [0, 310], [0, 0]),
        2 * np.degrees(np.arctan(1 / 40)),
    ),
    "a turn beside a short segment": ("turn", short_and_turned(6), np.degrees(np.arctan(6 / 60))),
    "short curve": ("short", closed([300, 0], [300, 1, 300.5, 2, 301, 2], [0, 300], [0, 0]), np.nan),
}


@pytest.mark.parametrize("name", FAULTS)
def test_exactly_this_fault(name: str) -> None:
    kind, contour, value = FAULTS[name]
    found = kinds(contour)
    expected = {kind, "extremum"} if kind in ("inflection", "handles") and "extremum" in found else {kind}
    assert set(found) == expected
    if not np.isnan(value):
        assert found[kind] == pytest.approx(value)


SOUND: dict[str, Contour] = {
    "handles that meet": arch([0, 100, 0, 100, 100, 100]),
    "a unit beyond, of whole units": arch([0, 101, 45, 100, 100, 100]),
    "an S": arch([60, 0, 40, 100, 100, 100]),
    "a bent curve": arch([20, 3, 80, 3.1, 100, 0.5]),
    "short but bent": closed([-2, 8, 5, 13, 15, 13], [90, -300], [-80, -200], [0, 0]),
    "a line at 0.6 degrees": closed([300, 3.2], [300, 250], [0, 250], [0, 0]),
    "a line on the axis": closed([300, 0], [300, 250], [0, 250], [0, 0]),
    "an extremum lower than the limit": arch([20, 5, 80, 5, 100, 3.4]),
    "a point too far off a line": closed([100, 60], [200, 118], [100, 400], [0, 0]),
    "level handles": arch_of([-50, 0], [60, 0]),
    "handles half a unit off level": arch_of([-50, -0.4], [60, 0.5]),
    "handles meant to slope": arch_of([-42, -4.2], [60, 6]),
    "a turn beside a short segment, less than counts": short_and_turned(2),
    "a segment of 3.1": closed([300, 0], [300, 3.1], [0, 300], [0, 0]),
}


@pytest.mark.parametrize("name", SOUND)
def test_nearly_a_fault(name: str) -> None:
    assert set(kinds(SOUND[name])) <= {"extremum"} if name.startswith("a bent") else kinds(SOUND[name]) == {}


def squeezed(cubic: FloatArray, share: float, *at: float) -> list[FloatArray]:
    """A cubic cut at parameters, with handles of this share of their length there."""
    parts, done, rest = [], 0.0, cubic
    for t in at:
        left, rest = split(rest, (t - done) / (1 - done))
        parts.append(left.copy())
        done = t
    parts.append(rest.copy())
    for a, b in pairwise(parts):
        a[2] += (1 - share) * (a[3] - a[2])
        b[1] += (1 - share) * (b[0] - b[1])
    return parts


def ring(share: float, *at: float, radius: float = 200.0) -> Contour:
    quarters = circle(radius, 4)
    return Contour.from_segments([*squeezed(quarters[0], share, *at), *quarters[1:]])


def slice_of_round(share: float, *at: float, radius: float = 200.0) -> Contour:
    """A quarter of a circle with its centre, corners at both ends."""
    parts = squeezed(circle(radius, 4)[0], share, *at)
    ends = parts[-1][-1], np.zeros(2), parts[0][0]
    return Contour.from_segments([*parts, np.array(ends[:2]), np.array(ends[1:])])


def lumps(contour: Contour) -> list[Finding]:
    return [each for each in gs.check(outline(contour)) if each.kind == "lump"]


def test_a_lump_is_a_maximum_too_many() -> None:
    """Two maxima 30 degrees from each other: the lesser is a lump."""
    found = lumps(slice_of_round(0.75, 0.3, 0.6))
    assert len(found) == 1
    assert found[0].value > 1
    assert found[0].detail is not None
    assert found[0].detail > 0.3
    assert np.hypot(*found[0].point) == pytest.approx(200, rel=1e-2)


@pytest.mark.parametrize(
    "contour",
    [
        ring(1.0, 1 / 3, 2 / 3),
        ring(0.97, 1 / 3, 2 / 3),
        slice_of_round(0.75, 0.5),  # one
        slice_of_round(0.75, 0.3, 0.6, radius=15.0),  # moves the curve by less than rounding does
        Contour.from_segments(circle(200.0, 4) * [0.5, 1.0]),
    ],
    ids=["cut only", "low", "one", "small", "ellipse"],
)
def test_no_lump(contour: Contour) -> None:
    assert "lump" not in kinds(contour)


@pytest.mark.parametrize("handle", [0.35, 0.45, 0.65, 0.8])
def test_a_superelliptic_o_has_four_maxima(handle: float) -> None:
    quarter = 200 * np.array([[1, 0], [1, handle], [handle, 1], [0, 1]])
    turn = np.array([[0.0, 1], [-1, 0]])
    found = kinds(Contour.from_segments([quarter @ np.linalg.matrix_power(turn, k) for k in range(4)]))
    assert "lump" not in found


def test_quadratics_are_not_judged_by_their_peaks() -> None:
    font = gs.open_font(FONTS / "variable.ttf")
    assert all(each.kind != "lump" for each in gs.check(font.outline(font.select(text="o")[0])))


def places(found: list[Finding]) -> set[tuple[object, ...]]:
    return {
        (each.kind, round(each.value, 6), round(each.point[0] + 0.0, 5), round(each.point[1] + 0.0, 5))
        for each in found
    }


FAULTY = [slice_of_round(0.75, 0.3, 0.6), *(contour for _, contour, _ in FAULTS.values())]


@given(st.sampled_from(FAULTY), st.integers(0, 9))
def test_start_and_direction_do_not_matter(contour: Contour, start: int) -> None:
    expected = places(gs.check(outline(contour)))
    segments = list(contour.segments())
    k = start % len(segments)
    assert places(gs.check(outline(Contour.from_segments([*segments[k:], *segments[:k]])))) == expected
    assert places(gs.check(outline(contour.reversed()))) == expected


@given(st.sampled_from([*FAULTY, *SOUND.values()]))
def test_the_em_does_not_matter(contour: Contour) -> None:
    """Shapes in fractions of a unit: what rounding may make depends on the unit, not on the em."""
    moved = Contour(
        contour.points + [0.3, 0.4] + 1e-3 * np.arange(len(contour.points))[:, None] % 0.01, contour.degrees
    )
    small, large = (gs.check(outline(Contour(moved.points * em / 1000, moved.degrees), em=em)) for em in (1000, 2048))
    assert [(each.kind, each.segment) for each in small] == [(each.kind, each.segment) for each in large]


def test_worst_first_and_many_are_as_one() -> None:
    font = gs.open_font(FONTS / "kouzan-gyosho.otf")
    outlines = [font.outline(name) for name in font.glyph_names]
    together = check_many(outlines)
    assert together == [gs.check(each) for each in outlines]
    for found in together:
        for kind in {each.kind for each in found}:
            values = [(each.seen or 0.0) if kind == "jump" else each.value for each in found if each.kind == kind]
            assert values == sorted(values, reverse=True)


def jumping(size: float, share: float) -> list[list[float]]:
    """Two quarters of a circle that meet level at the top, the second with a handle of this share of its length."""
    k = 0.55 * size
    return [[0, k, size - k, size, size, size], [size + share * k, size, 2 * size, k, 2 * size, 0]]


def jumps(*sizes: tuple[float, float], rounding: float = 3.0) -> list[Finding]:
    contours = [closed(*jumping(*each), [each[0] * 1.7, -300], [each[0] / 2, -300], [0, 0]) for each in sizes]
    found = gs.check(outline(*contours), gs.Thresholds(rounding=rounding))
    return [each for each in found if each.kind == "jump"]


def test_what_rounding_may_make_is_no_jump_unless_it_is_asked_for() -> None:
    """A handle of 60 units shorter by a fifth, and one of 10 units: of the latter rounding may make a tenth."""
    (found,) = jumps((110, 0.8))
    assert found.sentence.startswith("curvature jumps by ")
    assert jumps((20, 9 / 11)) == []
    assert len(jumps((20, 9 / 11), rounding=0.1)) == 1
    assert len(jumps((20.3, 9 / 11))) == 1  # not in whole units


def test_jumps_are_ranked_by_how_far_they_are_seen() -> None:
    """The round of a serif has the larger curvature, and the larger jump; the bowl's is seen along more."""
    serif, bowl = jumps((40, 0.6), (240, 0.6))[::-1]
    assert (serif.contour, bowl.contour) == (0, 1)
    assert serif.value > bowl.value
    assert serif.detail == pytest.approx(bowl.detail, rel=0.02)
    assert serif.seen is not None
    assert bowl.seen == pytest.approx(6 * serif.seen, rel=0.05)
    assert bowl.seen == pytest.approx((bowl.detail or 0.0) * 240 * np.pi / 2, rel=0.1)
    assert severity(bowl) < severity(serif)


def test_short_lines_of_one_unit_off() -> None:
    """In an em of 2048, a line of 150 units that is off by one: rounding may make that; a line of 300 units counts."""
    assert kinds(closed([150, 1], [150, 250], [0, 250], [0, 0]), em=2048.0) == {}
    assert set(kinds(closed([300, 1], [300, 250], [0, 250], [0, 0]), em=2048.0)) == {"slanted"}


@pytest.mark.parametrize(("way", "told"), [(1.0, False), (-1.0, True)])
def test_the_end_of_a_neighbours_bend_is_no_inflection(way: float, told: bool) -> None:
    """A segment that begins by turning right, smoothly joined to one that turns right as well, or left."""
    along = np.array([20.0, 21.0]) / 29.0
    side = np.array([along[1], -along[0]]) * way  # to the right of it
    start = -100 * along + 60 * side
    before = [*start, *(start + 20 * along - 40 * side), *(-40 * along)]
    contour = closed([20, 21, 96, 68, 100, 100], [100, -300], [-300, -300], before[:2], [*before[2:], 0, 0])
    assert ("inflection" in kinds(contour)) == told


@pytest.mark.parametrize(("way", "told"), [(1.0, False), (-1.0, True)])
def test_one_handle_too_long_is_meant_where_the_neighbour_goes_on_bending(way: float, told: bool) -> None:
    """A quarter whose first handle is 20 beyond where both meet: its end turns left, as the next curve does, or not."""
    behind = [140, 100, 180, 100 + 20 * way, 200, 100 + 60 * way]
    found = kinds(closed([0, 120, 80, 100, 100, 100], behind, [200, -300], [100, -333], [0, -280], [0, 0]))
    assert ("handles" in found) == told
    assert "inflection" not in found


def pressed_in(depth: float, share: float, reverse: bool) -> Contour:
    """A superelliptic o with its top pressed in: curvature has the other sign at that one point.

    A quarter below is cut in three, and its handles there are of a share of their length.
    """
    quarter = 200 * np.array([[1, 0], [1, 0.65], [0.65, 1], [0, 1]])
    turn = np.array([[0.0, 1], [-1, 0]])
    right, left, below, last = [quarter @ np.linalg.matrix_power(turn, k) for k in range(4)]
    right[1, 1] = left[2, 1] = 200 + depth
    segments = [right, left, *squeezed(below, share, 0.4, 0.6), last]
    return Contour.from_segments([segment[::-1] for segment in segments[::-1]] if reverse else segments)


@pytest.mark.parametrize("reverse", [False, True], ids=["outer", "counter"])
@pytest.mark.parametrize("depth", [5.0, 40.0], ids=["insignificant", "significant"])
def test_a_bend_that_goes_all_the_way_round_has_its_four_maxima(depth: float, reverse: bool) -> None:
    """From the only inflection to itself, or the whole contour where the inflection is none to speak of."""
    assert lumps(pressed_in(depth, 1.0, reverse)) == []
    (found,) = lumps(pressed_in(depth, 0.6, reverse))
    assert found.value > 1
    assert found.point[0] < -100
    assert found.point[1] < -100


@pytest.mark.parametrize("reverse", [False, True])
@pytest.mark.parametrize(
    ("tilts", "expected"),
    [((14.0, 14.0), "turn"), ((14.0, 8.0), "turn"), ((14.0, 0.0), "kink"), ((14.0, -14.0), "kink")],
)
def test_a_stroke_whose_sides_turn_alike_into_its_end_is_meant(
    tilts: tuple[float, float], expected: str, reverse: bool
) -> None:
    left, right = tilts
    stroke = closed(
        [left, 100], [80 + right, 100], [80, 0], [80, -80, 100, -150, 200, -200], [120, -290],
        [30, -200, 0, -100, 0, 0],
    )  # fmt: skip
    segments = [segment[::-1] for segment in stroke.segments()][::-1] if reverse else stroke.segments()
    found = kinds(Contour.from_segments([*segments]))
    assert {"turn", "kink"} & found.keys() == {expected}
