"""Crossings and overshoot against plain NumPy and SciPy, which look at every pair of many chords."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial import ConvexHull

import glyphspline as gs
from glyphspline.curves.crossings import crossings, meetings
from glyphspline.curves.cubics import bernstein
from glyphspline.curves.overshoot import chords
from glyphspline.outlines.contour_arrays import joined
from glyphspline.outlines.segments import all_cubics
from glyphspline.types import FloatArray
from tests.places import GYOSHO as FONT
from tests.polygons import overshoot


def chains_at_random(times: int) -> list[FloatArray]:
    rng = np.random.default_rng(11)
    found = []
    for n in [2, 3, 4, 6, 9, 15] * times:
        joints, handles = rng.normal(0, 100, (n, 2)), rng.normal(0, 100 / n, (n, 2, 2))
        ends = np.roll(joints, -1, axis=0)
        found.append(np.stack([joints, joints + handles[:, 0], ends - handles[:, 1], ends], axis=1))
    return found


def lines(points: list[tuple[float, float]]) -> FloatArray:
    """The straight segments of a closed polygon as cubics."""
    p = np.array(points, dtype=np.float64)
    return np.stack([p + w / 3 * (np.roll(p, -1, axis=0) - p) for w in range(4)], axis=1)


def crossings_of(*contours: FloatArray) -> list[tuple[tuple[int, int], tuple[float, float]]]:
    """The pair of contours, and the places on them, of each crossing of one glyph."""
    offsets = np.cumsum([0, *map(len, contours)])
    found, complete = crossings(np.concatenate(contours).astype(float), offsets, np.array([0, len(contours)]))
    assert complete.all()
    return [((int(c), int(d)), (x, y)) for c, d, x, y in found.tolist()]


def sampled(cubics: FloatArray, steps: int) -> FloatArray:
    """Points at even parameters of each segment."""
    return np.einsum("kt,mkc->mtc", bernstein(steps)[:, :-1], cubics).reshape(-1, 2)


def at(cubics: FloatArray, place: float) -> FloatArray:
    """The point at a place of a chain."""
    s = min(int(place), len(cubics) - 1)
    x = place - s
    weights = np.array([(1 - x) ** 3, 3 * (1 - x) ** 2 * x, 3 * (1 - x) * x * x, x**3])
    return weights @ cubics[s]


def cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def crossings_of_all_pairs(p: FloatArray) -> int:
    """Chords of a closed polyline that cross properly, neighbours apart."""
    n, q = len(p), np.roll(p, -1, axis=0)
    after = cross((q - p)[:, None], p[None] - p[:, None]) >= 0  # [i, j]: whether point j is left of chord i
    apart = after != np.roll(after, -1, axis=1)
    i, j = np.triu_indices(n, 2)
    return int((apart & apart.T)[i, j][(i > 0) | (j < n - 1)].sum())


def farthest_from_hull(points: FloatArray, polygon: FloatArray) -> float:
    """Largest distance of points from the convex hull of a polygon."""
    a = polygon[ConvexHull(polygon).vertices]
    side = np.roll(a, -1, axis=0) - a
    away = points[:, None] - a
    along = np.clip((away * side).sum(-1) / (side**2).sum(-1), 0, 1)
    inside = (cross(side, away) >= 0).all(axis=1)
    return float(np.where(inside, 0, np.hypot(*(away - along[..., None] * side).T).min(axis=0)).max())


@pytest.mark.parametrize("times", [2, pytest.param(8, marks=pytest.mark.long)])
def test_crossings_are_those_of_many_chords(times: int) -> None:
    counted = 0
    for cubics in chains_at_random(times):
        found, _ = crossings(cubics, np.array([0, len(cubics)]), np.array([0, 1]))
        counted += len(found)
        if len(found) != crossings_of_all_pairs(sampled(cubics, 100)):  # too coarse for some
            tiny = np.abs(found[:, 2] - found[:, 3]) < 1e-3  # loops of neighbouring chords
            assert len(found) - tiny.sum() == crossings_of_all_pairs(sampled(cubics, 600))
        for x, y in found[:, 2:]:
            np.testing.assert_allclose(at(cubics, x), at(cubics, y), atol=1e-5)
    assert counted > 25 * times


@pytest.mark.parametrize(
    ("contours", "expected"),
    [
        ([[(0, 0), (10, 0), (10, 10), (0, 10)]], []),
        ([[(0, 0), (10, 10), (10, 0), (0, 10)]], [(0, 0)]),
        ([[(0, 0), (10, 0), (10, 10), (0, 10)], [(5, 5), (15, 5), (15, 15), (5, 15)]], [(0, 1), (0, 1)]),
        ([[(0, 0), (10, 0), (10, 10), (0, 10)], [(2, 2), (8, 2), (8, 8), (2, 8)]], []),
        ([[(0, 0), (10, 0), (10, 10), (0, 10)]] * 2, []),  # on each other
        ([[(0, 0), (10, 0), (10, 10), (0, 10)], [(10, 2), (20, 2), (20, 8), (10, 8)]], []),  # side by side
        ([[(0, 0), (10, 0), (5, 0), (5, 5), (5, 0)]], []),  # there and back
        ([[(0, 0), (10, 0), (10, 10), (0, 10)], [(10, 5), (20, 0), (20, 10), (0, 5.1)]], [(0, 1), (0, 1)]),
    ],
)
def test_crossings_of_polygons(contours: list[list[tuple[float, float]]], expected: list[tuple[int, int]]) -> None:
    assert [pair for pair, _ in crossings_of(*map(lines, contours))] == expected


@pytest.mark.parametrize(("depth", "expected"), [(-1, 0), (-1e-4, 0), (1e-4, 2), (0.01, 2), (1, 2)])
def test_shallow_crossings_of_two_contours_are_found(depth: float, expected: int) -> None:
    """An arc 600 units long that dips below the upper side of a box."""
    low = (100 - 8 * depth) / 6
    above = np.array([[(0, 50), (200, low), (400, low), (600, 50)], [(600, 50), (400, 90), (200, 90), (0, 50)]])
    found = crossings_of(above, lines([(-10, -100), (610, -100), (610, 25), (-10, 25)]))
    assert [pair for pair, _ in found] == [(0, 1)] * expected


@pytest.mark.parametrize(("handle", "expected"), [(0.3, 1), (-0.3, 0)])
def test_a_small_loop_at_a_fold_is_found(handle: float, expected: int) -> None:
    """A stroke that comes back above itself; with the one handle it arrives at its tip from above."""
    there, back = [(0, -1), (100, -1), (299, handle), (300, 0)], [(300, 0), (299, -handle), (100, 1), (0, 1)]
    cap = [(0, 1), (0, 1 / 3), (0, -1 / 3), (0, -1)]
    assert len(crossings_of(np.array([there, back, cap]))) == expected


def test_a_loop_at_a_joint_that_is_smaller_than_the_chords_there_is_found() -> None:
    """Strands there and back, a quarter of a unit apart, whose ends at the joint point past each other."""
    there = np.array([(696.42, 463.14), (696.84, 414.15), (704.99, 348.03), (705, 348)])
    back = np.array([(705, 348), (705, 347.97), (696.85, 414.21), (696.43, 463.29)])
    around = lines([(696.43, 463.29), (696.43, 800), (600, 800), (600, 463.14), (696.42, 463.14)])[:4]
    ((_, places),) = crossings_of(np.concatenate([[there, back], around]))
    assert np.allclose(places, (0.99937, 1.00108), atol=1e-4)
    assert not crossings_of(np.concatenate([[there, back + np.array([0.1, 0])], around]))


@pytest.mark.parametrize(("back", "expected"), [(759.03, 1), (759.02, 0), (759.01, 0)])
def test_sides_of_a_hair_that_cross_before_they_meet_are_found(back: float, expected: int) -> None:
    """There and back on one line. The way back leaves it earlier than the way there joins it, by less than 1e-6."""
    there = [(758.23, 115.09), (758.41, 115), (758.71, 115), (759.02, 115)]
    tip = [
        [(759.02, 115), (759.33, 115), (759.67, 115), (759.67, 115)],
        [(759.67, 115), (759.67, 115), (759.33, 115), (back, 115)],
    ]
    away = [(back, 115), (758.72, 115), (758.44, 115), (758.2, 115.02)]
    around = lines([(758.2, 115.02), (722, 125), (722, 1000), (753, 156), (758.23, 115.09)])[:4]
    assert len(crossings_of(np.concatenate([[there, *tip, away], around]))) == expected


def test_crossings_beside_the_tip_of_a_fold_are_found_both() -> None:
    """The tip penetrates by 2e-4 of 1,000, and a chord ends 4e-6 from one of the two crossings."""
    chain = [
        [(274.62, 993.59), (274.56, 993.55), (274.47, 993.5), (274.41, 993.47)],
        [(274.41, 993.47), (274.39, 993.46), (274.37, 993.45), (274.38, 993.45)],
        [(274.38, 993.45), (274.38, 993.45), (274.38, 993.45), (274.39, 993.46)],
        [(274.39, 993.46), (274.4, 993.46), (274.41, 993.45), (274.42, 993.44)],
        *([a, a, b, b] for a, b in pairwise([(274.42, 993.44), (274.42, 0.0), (280.0, 0.0), (274.62, 993.59)])),
    ]
    assert sorted((int(x), int(y)) for _, (x, y) in crossings_of(np.array(chain))) == [(1, 2), (1, 3)]


def test_strands_that_cross_twice_within_chord_errors_are_found() -> None:
    """There, and back on the other side for a 60th of a unit, by 4e-6 at most."""
    there = [(662.59, -10.5), (662.32, -12.08), (662.08, -13.5), (662.12, -13.24)]
    back = [(662.12, -13.24), (662.14, -13.15), (662.19, -12.85), (662.23, -12.5)]
    around = lines([(662.23, -12.5), (662.23, 0), (663, 0), (662.59, -10.5)])[:3]
    found = crossings_of(np.concatenate([[there, back], around]))
    np.testing.assert_allclose([places for _, places in found], [(0.7320862, 1.28354), (0.7417227, 1.2574887)])


def test_strands_that_cross_twice_in_one_small_circle_are_found() -> None:
    """The tip passes its strands by 0.002, and they cross before it twice within 0.006."""
    there = [(824.37, 93.66), (824.48, 93.61), (824.59, 93.55), (824.55, 93.57)]
    back = [(824.55, 93.57), (824.53, 93.58), (824.48, 93.61), (824.41, 93.64)]
    around = lines([(824.41, 93.64), (800, 200), (700, 93), (824.37, 93.66)])[:3]
    found = [places for _, places in crossings_of(np.concatenate([[there, back], around])) if max(places) < 2]
    np.testing.assert_allclose(found, [(0.3203735, 1.679629), (0.3300171, 1.6633543)], atol=1e-6)


def test_a_nose_at_the_tip_of_a_fold_is_found() -> None:
    """The tip runs on for 1e-4 before it turns back across the way there, at an angle of 0.002."""
    there = [(1.98, -0.03), (1.31, -0.02), (0.66, -0.01), (0.65, -0.01)]
    back = [(0.65, -0.01), (0.64, -0.01), (1.28, -0.01), (1.95, -0.02)]
    around = lines([(1.95, -0.02), (822.45, -1), (822.45, -2), (1.98, -0.03)])[:3]
    ((_, places),) = crossings_of(np.concatenate([[there, back], around]))
    np.testing.assert_allclose(places, (0.9987423, 1.0167236), atol=1e-6)


def test_straight_pieces_that_lie_on_each_other_are_not_halved_on() -> None:
    """Two cubics up one line that turn back on it: a chord error says nothing of their distance."""
    there = [(304.0, 161.5), (304.0, 161.1), (304.0, 160.69), (304.0, 160.59)]
    back = [(304.0, 160.59), (304.0, 160.41), (304.0, 161.11), (304.0, 161.97)]
    chain = np.concatenate([[there, back], lines([(304.0, 161.97), (0, 400), (0, 0), (304.0, 161.5)])[:3]])
    met, complete = meetings(chain, np.array([0, len(chain)]), np.array([0, 1]))
    assert complete.all()
    assert len(met) < 1_800


def test_a_loop_within_a_segment_is_found() -> None:
    loop = np.array([[(0, 0), (30, 30), (-20, 30), (10, 0)], [(10, 0), (7, -5), (3, -5), (0, 0)]])
    ((pair, (x, y)),) = crossings_of(loop)
    assert pair == (0, 0)
    np.testing.assert_allclose(at(loop, x), at(loop, y), atol=1e-6)
    assert crossings_of(np.array([[(0, 0), (30, 30), (-20, 30), (0, 0)]])) == []  # a drop of one segment


def test_crossings_are_those_of_each_glyph_alone() -> None:
    font = gs.open_font(FONT)
    outlines = [font.outline(name) for name in font.select(text="いの好8")]
    arrays = joined([outline.arrays for outline in outlines])
    glyphs = np.cumsum([0, *(len(outline.contours) for outline in outlines)])
    found, complete = crossings(all_cubics(arrays), arrays.offsets, glyphs)
    assert complete.all()
    alone = []
    for outline, first in zip(outlines, glyphs, strict=False):
        own, _ = crossings(all_cubics(outline.arrays), outline.arrays.offsets, np.array([0, len(outline.contours)]))
        alone.append(own + np.array([first, first, 0, 0]))
    np.testing.assert_array_equal(found, np.concatenate(alone))
    assert len(found) > 5


def test_strands_that_lie_on_each_other_by_thousands_end_in_time() -> None:
    """Every pair of these curves would be halved down to its chords."""
    rng = np.random.default_rng(3)
    strands = []
    for _ in range(400):
        a, b = np.sort(rng.uniform(0, 1, 2))
        x = np.linspace(a, b, 4)
        parabola = np.stack([x, [x[0] ** 2, x[0] * (2 * x[1] - x[0]), x[3] * (2 * x[2] - x[3]), x[3] ** 2]], axis=1)
        strands.append(np.stack([parabola * 600, parabola[::-1] * 600]))
    offsets = np.arange(0, 2 * len(strands) + 1, 2)
    _, complete = crossings(np.concatenate(strands), offsets, np.array([0, len(strands)]))
    assert not complete.any()


def test_overshoot_is_that_of_every_chord() -> None:
    font = gs.open_font(FONT)
    outlines = [font.outline(name) for name in font.select(text="龍好g")]
    for cubics in [*chains_at_random(2), *(c.cubics() for o in outlines for c in o.contours)]:
        points, _ = chords(cubics)
        polygon = np.ascontiguousarray(cubics[::2, 0])
        if len(polygon) >= 3:
            assert overshoot(cubics, polygon) == pytest.approx(farthest_from_hull(points, polygon), abs=1e-9)


def test_a_point_in_line_with_a_far_side_of_the_hull_is_not_outside() -> None:
    """Vertices on straight sides lie outside of the lines of others by rounding alone."""
    rng = np.random.default_rng(5)
    for _ in range(50):
        corners = rng.normal(0, 300, (3, 2))
        share = np.linspace(0, 1, 60, endpoint=False)[:, None]
        polygon = np.concatenate([(1 - share) * corners[k] + share * corners[(k + 1) % 3] for k in range(3)])
        lines = np.stack([polygon + w / 3 * (np.roll(polygon, -1, axis=0) - polygon) for w in range(4)], axis=1)
        assert overshoot(lines, polygon) < 1e-9
