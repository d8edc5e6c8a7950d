"""The smooth fit's compiled steps against the plain ones: distances, measures, first places, curves run backwards."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
import pytest

import glyphspline as gs
from glyphspline.curves.curvature import comb
from glyphspline.fitting.closed_curves import beziers, interpolated
from glyphspline.fitting.faithful import faithful
from glyphspline.fitting.measures import geometry
from glyphspline.fitting.smooth import fairing, steps
from glyphspline.fitting.smooth.canonical_contours import CanonicalContours, canonical_contours
from glyphspline.fitting.smooth.smooth_fit import smooth_fits
from glyphspline.fitting.smooth.spacing import growth_of, off_corners
from glyphspline.interpolation.result import turned
from glyphspline.outlines.contour_arrays import polylines
from glyphspline.outlines.outline import Contours
from glyphspline.outlines.segments import all_cubics
from scripts.paper.measures import shape
from tests.fitting.test_distance import true_distance
from tests.places import DEJAVU
from tests.polygons import circle_contour, overshoot, random_polygon, square_contour

NONE = np.empty((0, 2))


def canonical_of(*contours: gs.Contour) -> CanonicalContours:
    """Contours of a plain outline as they are fitted."""
    arrays = Contours(contours).arrays
    return canonical_contours(all_cubics(arrays)[None], arrays.offsets)


def wobbly(radius: float, seed: int) -> gs.Contour:
    """A circle with its control points moved at random."""
    circle = circle_contour(radius)
    points = circle.points + np.random.default_rng(seed).normal(0, radius / 15, circle.points.shape)
    return gs.Contour(points, circle.degrees)


@pytest.mark.parametrize("seed", range(6))
def test_bounds_of_single_spans_are_never_below_the_distance(seed: int) -> None:
    contour = wobbly(100, seed)
    canonical = canonical_of(contour)
    which, near = np.zeros(1, dtype=np.int64), 0.01
    places = np.linspace(0, len(canonical.cubics), 7)[:-1]
    offsets = np.array([0, len(places)])
    found = interpolated(steps.polygons(canonical, which, places, offsets), offsets, gs.Options(precision=2))
    pieces, written = (each[:, 0] for each in beziers(found.arrays.controls, found.arrays.knots, offsets, 100.0))
    np.testing.assert_allclose(pieces, found.results()[0].spline.to_bezier(), atol=1e-9)
    np.testing.assert_array_equal(written, np.round(pieces, 2))
    given = canonical, which, places, offsets, found.arrays.controls
    measured = steps.measured(*given, written[:, None], near)
    bounds = measured.bounds
    bound, gap = steps.sharpened(written, canonical.cubics, bounds, measured.gaps, measured.ends, 0.01)
    truth = true_distance(gs.Contour.from_segments(written), contour)
    assert truth - 0.06 <= bound
    assert gap <= bound <= gap + 0.011
    assert bound <= bounds.max() + 1e-9


def test_a_span_may_begin_in_the_segment_before_that_of_its_vertex() -> None:
    pieces = np.array(circle_contour(100).cubics(), dtype=np.float64)
    parts = []
    for c in pieces:
        a = c[:-1] + 0.1 * np.diff(c, axis=0)
        b = a[:-1] + 0.1 * np.diff(a, axis=0)
        cut = b[0] + 0.1 * (b[1] - b[0])
        parts += [np.array([c[0], a[0], b[0], cut]), np.array([cut, b[1], a[2], c[3]])]
    outline = np.array(parts, dtype=np.float64)
    ends, none = np.array([0, 8]), np.zeros(8)
    canonical = CanonicalContours(outline, ends, np.zeros(1, dtype=np.bool_), none, np.zeros(8 * 16 + 1))
    places = np.array([1.02, 3.02, 5.02, 7.02])  # in the second part of each quarter; the spans begin with the first
    which, near = np.zeros(1, dtype=np.int64), 0.01
    points = outline[::2, 0].copy()
    trial = steps.measured(canonical, which, places, np.array([0, 4]), points, pieces[:, None], near)
    assert trial.bounds.max() < 1
    np.testing.assert_allclose(trial.ends, np.arange(0, 10, 2), atol=0.05)


def smoothed(contours: Sequence[gs.Contour], options: gs.Options, tolerance: float) -> list[gs.ContourResult]:
    arrays = Contours(contours).arrays
    each = np.arange(len(contours) + 1)  # a glyph each
    options = options.for_em(1000.0)
    return faithful(arrays, each, smooth_fits(options, tolerance), options, tolerance).contour_results()


def test_measures_are_those_that_look_at_every_piece() -> None:
    polygons = [random_polygon(n, seed) for n in (5, 12, 40) for seed in range(3)]
    curves = [gs.Contour.from_segments(gs.interpolate(p, fallback="peak").spline.to_bezier()) for p in polygons]
    source = [circle_contour(10) for _ in curves]
    drawn, vertices = Contours(curves).arrays, polylines(polygons, [True] * len(polygons))
    measured = geometry(drawn, drawn.rounded(9), Contours(source).arrays, vertices.points, vertices.offsets)
    found = measured._asdict()
    for k, (curve, polygon) in enumerate(zip(curves, polygons, strict=True)):
        whole = shape(curve.cubics())
        assert found["length"][k] == pytest.approx(whole.length)
        assert found["bending_energy"][k] == pytest.approx(whole.bending_energy)
        assert found["max_curvature"][k] == pytest.approx(whole.max_curvature)
        assert found["area_change"][k] == pytest.approx(whole.area - shape(source[k].cubics()).area, abs=1e-8)
        assert found["overshoot"][k] == pytest.approx(overshoot(curve.cubics(), polygon), abs=1e-8)


def test_a_fit_leaves_the_bound_its_share_of_rounding() -> None:
    """A contour of LXGW WenKai's u45C1, whose spans were within the tolerance before rounding was added."""
    points = """797,-99 782,-99 762,-86 701,-52 642,-5 619,16 619,25 619,32 626,32 637,32 655,24 721,-5 781,-22 779,396
        458,377 433,377 423,385 415,394 410,406 400,425 400,432 400,436 404,436 411,435 430,430 452,430 462,430 886,455
        904,456 921,465 925,467 930,467 944,467 961,450 982,430 982,421 982,410 962,407 838,399 841,-25 842,-32 842,-46
        842,-68 826.5,-83.5 811,-99"""
    degrees = [2, 2, 2, 2, 2, 2, 1, 1, 2, 2, 2, 2, 1, 2, 2, 2, 2, 2, 2, 2, 1, 2, 1, 2, 2]
    contour = gs.Contour(np.array([p.split(",") for p in points.split()], dtype=float), np.array(degrees))
    measures = smoothed([contour], gs.Options(), 1.0)[0].measures
    assert measures.within_tolerance
    assert measures.deviation_bound is not None
    assert measures.deviation_bound <= 1


def test_first_places_are_graded_at_corners_and_few_in_between() -> None:
    canonical = canonical_of(square_contour(900), circle_contour(100))
    rules = steps.Rules(near=1.0, corner_angle=np.radians(12), ratio=4.0, factor=growth_of(4.0, 2))
    _, places, offsets = steps.first_places(canonical, rules, 2, np.zeros(2, dtype=np.bool_))
    points = steps.polygons(canonical, np.arange(2), places, offsets)
    square = points[: offsets[1]]
    h = np.hypot(*(np.roll(square, -1, axis=0) - square).T)
    assert max((h / np.roll(h, 1)).max(), (np.roll(h, 1) / h).max()) <= 4 * (1 + 1e-9)
    assert h.min() < 20
    assert h.max() > 200
    for corner in square_contour(900).points:
        assert (square == corner).all(axis=1).any()
    assert 4 <= len(points) - len(square) <= 12


def round_letter(width: float, height: float, fullness: float) -> gs.Contour:
    """An o as TrueType fonts draw it: eight quadratics, joined at the sides and halfway between these.

    Args:
        width, height: half of those of the letter. fullness: 0.414 makes an ellipse, more fills its corners.
    """
    middle = (1 + fullness) / 2
    quarter = np.array([[1, 0], [1, fullness], [middle, middle], [fullness, 1]]) * [width, height]
    other = quarter[:, ::-1] / [height, width] * [-width, height]  # from the top to the left
    return gs.Contour(np.concatenate([quarter, other, -quarter, -other]), np.full(8, 2))


def extrema(curve: gs.Contour) -> int:
    """The extrema of a closed curve's curvature from which it comes back on both sides, by a tenth or 1/length."""
    found = comb(curve.cubics(), 1.0)
    kappa, length, count = found.curvature, found.weights.sum(), 0
    for i in range(len(kappa)):
        least = max(abs(kappa[i]) / 10, 1 / length)
        both = np.roll(kappa, -i)[1:], np.roll(kappa, -i - 1)[::-1][1:]
        for sign in (1, -1):
            falls = []
            for k, side in enumerate(both):
                beyond = np.flatnonzero(sign * (side - kappa[i]) > 0 if k else sign * (side - kappa[i]) >= 0)
                until = side[: beyond[0]] if len(beyond) else side
                falls.append(len(until) > 0 and (sign * (kappa[i] - until)).max() >= least)
            count += all(falls)
    return count


@pytest.mark.parametrize("effort", ["fast", "best"])
@pytest.mark.parametrize("form", [(200, 300, 0.5), (200, 300, 0.52), (250, 290, 0.45), (250, 290, 0.5)])
def test_a_round_letter_of_quadratics_has_even_chords_and_no_extrema_of_its_own(
    form: tuple[float, float, float], effort: Literal["fast", "best"]
) -> None:
    letter = round_letter(*form)
    (result,) = smoothed([letter], gs.Options(effort=effort), 1.0)
    h = np.hypot(*(np.roll(result.polygon, -1, axis=0) - result.polygon).T)
    assert result.measures.within_tolerance
    assert len(h) <= 13
    assert max((h / np.roll(h, 1)).max(), (np.roll(h, 1) / h).max()) < 1.9
    assert extrema(result.curve) <= 8


def test_what_is_laid_anew_keeps_its_corners() -> None:
    bowl = round_letter(250, 290, 0.5).cubics()[:4]  # the upper half, closed by a line
    half = gs.Contour.from_segments([*bowl, np.array([bowl[-1][3], bowl[0][0]])])
    (result,) = smoothed([half], gs.Options(corners="smooth", hold_corners=False), 1.0)
    assert result.measures.within_tolerance
    for corner in (bowl[0][0], bowl[-1][3]):
        assert (result.polygon == corner).all(axis=1).any()
    assert result.measures.vertices <= 24


def test_a_contour_run_against_its_direction_gets_the_curve_of_its_own_polygon() -> None:
    flips = set()
    for seed in range(6):
        contour = wobbly(100, seed)
        flips.add(bool(canonical_of(contour).flipped[0]))
        result = smoothed([contour], gs.Options(corners="smooth", hold_corners=False), 1.0)[0]
        (arc,) = result.interpolations
        plain = gs.interpolate(result.polygon, margin=0.02, residual_tolerance=0.005)
        np.testing.assert_allclose(arc.spline.control_points, plain.spline.control_points, atol=1e-6)
        np.testing.assert_allclose(arc.spline.knots, plain.spline.knots, atol=1e-6)
        np.testing.assert_allclose(arc.parameters, plain.parameters, atol=1e-4)
        np.testing.assert_allclose(arc.intervals, plain.intervals, atol=1e-6)
        np.testing.assert_allclose(result.curve.cubics(), arc.spline.to_bezier(), atol=1e-6)
    assert flips == {False, True}


def test_turned_begins_with_the_same_vertex() -> None:
    np.testing.assert_array_equal(turned(np.arange(5.0)), [0, 4, 3, 2, 1])


def test_segments_of_no_length_and_all_variants_are_taken() -> None:
    circle = circle_contour(100)
    doubled = gs.Contour(np.concatenate([circle.points[:1], circle.points]), np.array([1, 3, 3, 3, 3]))
    for variant in range(5):
        measures = smoothed([doubled], gs.Options(variant=variant), 1.0)[0].measures
        assert measures.within_tolerance
        assert measures.vertices < 16


def test_best_takes_no_more_vertices_than_fast() -> None:
    contours = [wobbly(200, seed) for seed in range(4)]
    fast, best = (
        sum(r.measures.vertices for r in smoothed(contours, gs.Options(effort=effort), 0.5))
        for effort in ("fast", "best")
    )
    assert best <= fast


E = [(0, 0), (480, 0), (480, 90), (110, 90), (110, 310), (440, 310), (440, 400), (110, 400), (110, 620), (470, 620),
     (470, 710), (0, 710)]  # fmt: skip


@pytest.mark.parametrize("points", [E, [(0, 0), (300, 0), (300, 300), (0, 300)], [(0, 0), (500, 40), (240, 420)]])
def test_held_corners_have_no_rings(points: list[tuple[float, float]]) -> None:
    outline = gs.Contour(np.array(points, dtype=np.float64), np.ones(len(points), dtype=np.int64))
    held, passed = (
        gs.convert(_outline(outline), gs.Options(corners="smooth", hold_corners=hold)).contours[0]
        for hold in (True, False)
    )
    assert held.measures.within_tolerance
    assert held.measures.rate_bound is not None
    assert held.measures.rate_bound < 1
    assert held.measures.curvature_extrema == held.measures.curvature_extrema_floor
    assert (passed.measures.curvature_extrema or 0) > (held.measures.curvature_extrema or 0)
    assert held.measures.vertices <= 1.4 * passed.measures.vertices
    (arc,) = held.interpolations
    for corner in points:  # its control point is there, and the curve passes inside
        assert (arc.spline.control_points == corner).all(axis=1).any()
        assert not (held.polygon == corner).all(axis=1).any()
    np.testing.assert_allclose(arc.spline(arc.parameters), held.polygon, atol=0.01)


def test_vertices_leave_the_outline_where_curvature_ripples(monkeypatch: pytest.MonkeyPatch) -> None:
    font = gs.open_font(DEJAVU)
    options, extrema, results = gs.Options(corners="smooth", tolerance=2.0), [], []
    for tries in (0, fairing.TRIES):
        monkeypatch.setattr(fairing, "TRIES", tries)
        results.append([gs.convert(font.outline(name), options) for name in ("S", "ampersand", "eight", "g")])
        measures = [contour.measures for result in results[-1] for contour in result.contours]
        assert all(m.within_tolerance and (m.rate_bound or 0) < 1 for m in measures)
        extrema.append(sum((m.curvature_extrema or 0) - (m.curvature_extrema_floor or 0) for m in measures))
    assert extrema[1] < 0.6 * extrema[0]
    before, after = ([c for result in each for c in result.contours] for each in results)
    for plain, faired in zip(before, after, strict=True):
        assert faired.measures.vertices <= plain.measures.vertices
        assert (faired.measures.curvature_extrema or 0) <= (plain.measures.curvature_extrema or 0)
        assert (faired.measures.max_curvature or 0) <= 1.3 * (plain.measures.max_curvature or 0)
        (arc,) = faired.interpolations  # variant 2 from the vertices gives the curve
        np.testing.assert_allclose(arc.spline(arc.parameters), faired.polygon, atol=0.01 * 2)
    plain, faired = before[1], after[1]  # between corners where curvature does not ripple they stay
    stay = (plain.polygon == faired.polygon).all(axis=1)
    assert 0.1 * len(stay) < stay.sum() < len(stay)


def test_no_held_corner_where_it_does_not_serve() -> None:
    # a hair: between its sides a corner's control point has no room
    points = np.array([(0.0, 0.0), (400.0, 0.0), (400.0, 0.2), (0.0, 0.2)])
    outline = _outline(gs.Contour(points, np.ones(4, dtype=np.int64)))
    measures = gs.convert(outline, gs.Options(corners="smooth", tolerance=0.05)).contours[0].measures
    assert measures.within_tolerance
    assert not measures.new_crossings


def _outline(contour: gs.Contour) -> gs.Outline:
    return gs.Outline("A", 1, (65,), 600.0, [contour], gs.FontMetrics(1000.0, 800.0, -200.0))


def test_how_far_off_the_curve_is_at_held_corners_is_known_from_the_chords() -> None:
    (contour,) = gs.convert(
        gs.Outline("square", contours=(square_contour(500),)), gs.Options(tolerance=1.0, corners="smooth")
    ).contours
    square = contour.source.points
    points = contour.polygon.copy()
    gaps = np.hypot(*(points[:, None] - square).T).T
    corners = np.sort(gaps.argmin(axis=0))
    off = gaps.min(axis=1)[corners]
    points[corners] = square[gaps.argmin(axis=1)[corners]]  # the polygon has the curve's own points there
    errors = off_corners(points, corners, np.full(4, np.pi / 2))
    assert off.min() > 0.5
    np.testing.assert_allclose(errors[corners], off, rtol=0.25)
    assert not errors[corners - 2].any()


def test_spans_that_fail_lower_what_moves_them() -> None:
    offsets, bounds, most = np.array([0, 14]), np.full(14, 0.9), np.ones((1, 1))
    first = np.array([[0.9] * 5 + [0.0] * 4 + [0.9] * 3 + [0.0] * 2]).T  # two runs of spans that move
    bounds[[1, 7]] = 1.2, 0.95
    limits = first.copy()
    again = fairing.lowered(limits, offsets, bounds, 1.0, np.zeros((14, 1)), most)
    assert np.flatnonzero(again).tolist() == [0, 1, 2, 3, 4]
    np.testing.assert_allclose(limits[:3], 0.9 * fairing.CUT / 1.2)
    np.testing.assert_array_equal(limits[3:], first[3:])
    bounds[[1, 7]] = 0.9, 1.2  # nothing beside it moves
    limits = first.copy()
    again = fairing.lowered(limits, offsets, bounds, 1.0, np.zeros((14, 1)), most)
    assert np.flatnonzero(again).tolist() == [0, 1, 2, 3, 4, 9, 10, 11]
    assert np.flatnonzero(limits < first).tolist() == [3, 4, 9, 10, 11]
