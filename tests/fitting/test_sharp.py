"""The sharp mode's parts: every variant, glyphs taken whole or in parts, single cubics, pieces, crossings, overlaps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import cKDTree

import glyphspline as gs
from glyphspline.curves.bezier import evaluate
from glyphspline.fitting.measures import geometry
from glyphspline.fitting.options import Corners, Effort
from glyphspline.fitting.sharp.assembly import certify, put_together
from glyphspline.fitting.sharp.cubics import fit_cubic
from glyphspline.fitting.sharp.cutting import Chains, fit_contours, refit
from glyphspline.fitting.sharp.pieces import Pieces
from glyphspline.fitting.sharp.settings import EFFORTS
from glyphspline.fitting.sharp.sharp_fit import chords
from glyphspline.outlines.outline import Contours
from glyphspline.outlines.overlaps import remove_overlaps
from glyphspline.outlines.segments import all_cubics
from glyphspline.runs.small_runs import converted
from glyphspline.types import FloatArray
from scripts.paper.measures import shape
from tests.places import GYOSHO as FONT
from tests.polygons import circle_contour, square_contour

LINES = np.ones(4, dtype=np.int64)


def glyph(character: str) -> gs.Outline:
    font = gs.open_font(FONT)
    return font.outline(font.select(text=character)[0])


def options(variant: int = 2, **others: object) -> gs.Options:
    chosen = gs.Options(corners="sharp", effort="best", variant=variant, **others)  # type: ignore[arg-type]
    return chosen.for_em(1024)


def true_distance(contour: gs.ContourResult, precision: int) -> float:
    """Two-sided distance of what is written from its source, by points 0.1 apart: too large by at most 0.002."""
    a, b = (gs.sample(curve, step=0.1) for curve in (contour.curve.rounded(precision), contour.source))
    return float(max(cKDTree(b).query(a)[0].max(), cKDTree(a).query(b)[0].max()))


@pytest.mark.parametrize("variant", range(5))
@pytest.mark.parametrize("character", ["永", "龍"])
def test_every_variant_is_certified_and_gives_what_the_public_interpolation_gives(variant: int, character: str) -> None:
    chosen = options(variant)
    compared = 0
    for contour in gs.convert(glyph(character), chosen).contours:
        measures = contour.measures
        assert measures.within_tolerance
        assert measures.new_crossings == 0
        assert measures.deviation_bound is not None
        assert true_distance(contour, 1) <= measures.deviation_bound + 0.01
        for arc in contour.interpolations:
            k = len(arc.parameters) - 1
            assert not arc.spline.closed
            starts, ends = arc.spline.control_points[[0, -1]]  # the outline may pass a point twice
            off = np.hypot(*(contour.polygon - starts).T) + np.hypot(*(np.roll(contour.polygon, -k, axis=0) - ends).T)
            first = int(off.argmin())
            p = contour.polygon.take(range(first, first + k + 1), axis=0, mode="wrap")
            tangents = arc.spline(arc.spline.knots[[0, -1]], derivative=1)
            again = gs.interpolate(
                p, variant, closed=False, end_tangents=(tangents[0], tangents[1]), margin=chosen.margin,
                residual_tolerance=chosen.solver_tolerance,
            )  # fmt: skip
            np.testing.assert_allclose(arc.spline.control_points, again.spline.control_points, atol=1e-6)
            np.testing.assert_allclose(arc.intervals, again.intervals, atol=1e-9)
            compared += k > 1
    assert compared


def test_fine_detail_of_very_many_lines_is_fitted_where_few_vertices_do_and_stays_lines_where_not() -> None:
    """A circle rounded to units, of 1,499 noisy points: where the first guess misses by little it grows in large steps.
    A staircase of as many lines needs more vertices than a spline may have.
    """
    angle = 2 * np.pi * np.arange(1499) / 1499
    circle = np.array([500.0, 400.0]) + 400 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    noisy = np.round(circle + 0.3 * np.random.default_rng(1).standard_normal((1499, 2)))
    corners = np.round(circle[::2])
    stairs = np.stack([corners, np.stack([np.roll(corners[:, 0], -1), corners[:, 1]], axis=1)], axis=1).reshape(-1, 2)
    most = {"noise": 120, "stairs": len(stairs)}
    for name, points in (("noise", noisy), ("stairs", stairs)):
        points = points[np.hypot(*(points - np.roll(points, 1, axis=0)).T) > 0]
        lines = [np.stack(pair) for pair in zip(points, np.roll(points, -1, axis=0), strict=True)]
        outline = gs.Outline(name, contours=(gs.Contour.from_segments(lines),))
        (contour,) = gs.convert(outline, options(tolerance=1.0)).contours
        assert contour.measures.within_tolerance
        assert contour.measures.new_crossings == 0
        assert 0 < contour.measures.segments < most[name]
        assert contour.measures.deviation_bound is not None
        assert true_distance(contour, 2) <= contour.measures.deviation_bound + 0.01


def test_a_contour_smaller_than_the_tolerance_keeps_a_curve_of_four_vertices() -> None:
    points = np.array([[509.0, 609.0], [510.0, 611.0], [511.0, 613.0], [509.0, 611.0]])
    lens = gs.Contour(points, np.array([2, 2]))
    for tolerance in (3, 4, 50):
        chosen = gs.Options(corners="sharp", tolerance=tolerance, effort="best")
        (result,) = gs.convert(gs.Outline("lens", contours=(lens,)), chosen).contours
        assert result.measures.within_tolerance
        assert all(len(arc.parameters) >= 4 for arc in result.interpolations if arc.spline.closed)


def test_variants_differ_where_arcs_have_inner_vertices() -> None:
    curves = {
        v: np.concatenate([c.curve.points for c in gs.convert(glyph("龍"), options(v)).contours]) for v in range(5)
    }
    shapes = {points.tobytes() for points in curves.values()}
    assert len(shapes) > 2


@pytest.mark.parametrize("effort", ["fast", "best"])
def test_a_contour_is_the_same_alone_and_among_others(effort: str) -> None:
    outline = glyph("龍")
    chosen = gs.Options(corners="sharp", effort=effort)  # type: ignore[arg-type]
    together = gs.convert(outline, chosen).contours
    for contour, result in zip(outline.contours, together, strict=True):
        (alone,) = gs.convert(replace(outline, contours=(contour,)), chosen).contours
        np.testing.assert_array_equal(alone.curve.points, result.curve.points)
        np.testing.assert_array_equal(alone.polygon, result.polygon)
        assert alone.measures == result.measures


@pytest.mark.parametrize("corners", ["smooth", "sharp"])
def test_an_error_names_the_contour_whatever_was_left_out_before_it(corners: str) -> None:
    flat = gs.Contour(np.array([[0.0, 0.0], [9.0, 0.0]]), np.array([1, 1]))
    broken = square_contour(100).points.copy()
    broken[2, 1] = np.nan
    outline = gs.Outline("x", contours=(flat, square_contour(100), gs.Contour(broken, LINES)))
    with pytest.raises(gs.GlyphsplineError, match="finite") as caught:
        gs.convert(outline, gs.Options(corners=corners))  # type: ignore[arg-type]
    assert (caught.value.glyph, caught.value.contour) == ("x", 2)


@pytest.mark.parametrize("free", [False, True])
def test_a_single_cubic_is_found_again(free: bool) -> None:
    cubic = np.array([[0.0, 0.0], [40.0, 90.0], [150.0, 120.0], [200.0, 10.0]])
    samples = evaluate(np.broadcast_to(cubic, (60, 4, 2)), np.linspace(0, 1, 60))
    directions = np.stack([leg / np.hypot(*leg) for leg in (cubic[1] - cubic[0], cubic[3] - cubic[2])])
    tangents = np.empty((2, 2))
    error = fit_cubic(samples, directions, (free, free), 0.3, 10, tangents)
    assert error <= 0.3
    third = np.hypot(*(cubic[3] - cubic[0])) / 3
    found = np.stack([cubic[0], cubic[0] + third * tangents[0], cubic[3] - third * tangents[1], cubic[3]])
    fine = evaluate(np.broadcast_to(found, (5000, 4, 2)), np.linspace(0, 1, 5000))
    true = np.hypot(*(samples[:, None] - fine[None]).transpose(2, 0, 1)).min(axis=1).max()
    assert error == pytest.approx(true, abs=0.01)
    if not free:
        np.testing.assert_allclose(tangents / np.hypot(*tangents.T)[:, None], directions, atol=1e-12)


def test_what_no_cubic_is_near_is_not_taken_for_one() -> None:
    x = np.linspace(0, 6 * np.pi, 200)
    wave = np.stack([10 * x, 20 * np.sin(x)], axis=1)
    tangents, east = np.empty((2, 2)), np.array([[1.0, 0.0], [1.0, 0.0]])
    assert fit_cubic(wave, east, (True, True), 1.0, 6, tangents) > 5
    assert fit_cubic(np.zeros((5, 2)), east, (False, False), 1.0, 6, tangents) == np.inf


SETTINGS = EFFORTS["fast"](near=0.9, angle=np.radians(12.0), line=20.0, c2=True, margin=0.02, residual=0.005)


def cut(contours: Sequence[gs.Contour]) -> tuple[Chains, Pieces]:
    arrays = Contours(contours).arrays
    return fit_contours(all_cubics(arrays)[None], arrays, SETTINGS)


def test_pieces_that_all_fail_become_the_source_itself() -> None:
    contours = [circle_contour(300), square_contour(200), *glyph("永").contours]
    chains, pieces = cut(contours)
    assert (pieces.contour[0], *pieces.joints[0], pieces.closed[0]) == (0, 0, len(contours[0]), 1)
    exact, _ = refit(chains, pieces, np.ones(len(pieces.spans), dtype=np.bool_), np.empty(0), SETTINGS)
    assembly = put_together(exact, 0, len(contours), np.empty((0, 4, 2)), np.empty((0, 2)), chords(exact))
    curve = assembly.curves
    unknown = np.full(len(exact.spans), np.nan)
    bounds, _, _ = certify(
        chains, exact, assembly.segments, all_cubics(curve)[None], curve.offsets, None, 0.01, 1.0, unknown
    )
    assert bounds.max() < 1e-9
    assert len(curve.degrees) == sum(map(len, contours))
    none = np.zeros(len(contours) + 1, dtype=np.int64)
    areas = geometry(curve, curve, Contours(contours).arrays, exact.vertices[:, 0].copy(), none).area_change
    np.testing.assert_allclose(areas, 0, atol=1e-6)


def test_one_piece_is_replaced_and_the_others_stay() -> None:
    chains, pieces = cut(glyph("龍").contours)
    q = int(pieces.spans.argmax())
    poor = np.arange(len(pieces.spans)) == q
    closer, same = refit(chains, pieces, poor, np.array([0.9]), SETTINGS)
    assert same.tolist() == np.where(poor, -1, np.arange(len(poor))).tolist()
    assert closer.joints[q].tolist() == pieces.joints[q].tolist()
    assert closer.errors[q] <= 0.9 * SETTINGS.near
    for k in np.flatnonzero(~poor):
        old, new = (p.vertices[p.starts[k] : p.starts[k + 1]] for p in (pieces, closer))
        np.testing.assert_array_equal(old, new)
    old, new = (p.vertices[[p.starts[q], p.starts[q + 1] - 1]] for p in (pieces, closer))
    np.testing.assert_array_equal(old, new)


def curvatures(cubics: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Signed curvature at the beginning and at the end of each cubic."""
    found = []
    for a, b, c in ((cubics[:, 0], cubics[:, 1], cubics[:, 2]), (cubics[:, 3], cubics[:, 2], cubics[:, 1])):
        d, e = b - a, c - b
        found.append(2 / 3 * (d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0]) / np.hypot(*d.T) ** 3)
    return found[0], -found[1]


@pytest.mark.parametrize("effort", ["fast", "best"])
@pytest.mark.parametrize("character", ["永", "龍", "好"])
def test_curvature_is_continuous_inside_every_arc(character: str, effort: Effort) -> None:
    inner = 0
    for contour in gs.convert(glyph(character), gs.Options(corners="sharp", effort=effort)).contours:
        for arc in contour.interpolations:
            starts, ends = curvatures(arc.spline.to_bezier())
            joints = slice(0, None) if arc.spline.closed else slice(1, None)
            np.testing.assert_allclose(np.roll(ends, 1)[joints], starts[joints], rtol=1e-6, atol=1e-9)
            inner += len(starts[joints])
        assert contour.measures.within_tolerance
        assert contour.measures.converged is not False
        assert (contour.measures.iterations or 0) <= 60
    assert inner >= 2


def test_a_contour_without_corners_is_one_closed_spline() -> None:
    result = gs.convert(gs.Outline("o", contours=(circle_contour(300),)), gs.Options(corners="sharp")).contours[0]
    (arc,) = result.interpolations
    assert arc.spline.closed
    assert result.measures.numbers == 2 * result.measures.segments == 2 * len(result.polygon)
    again = gs.interpolate(result.polygon, margin=0.02, residual_tolerance=0.005)
    np.testing.assert_array_equal(arc.spline.control_points, again.spline.control_points)
    np.testing.assert_allclose(result.curve.cubics(), arc.spline.to_bezier(), atol=1e-9)


def test_a_stretch_that_no_spline_follows_is_cut_in_two_that_meet_smoothly() -> None:
    """A circle with a fold at its top, of two half circles smaller than the tolerance."""
    circle = circle_contour(300).cubics()
    top = int(circle[:, 0, 1].argmax())
    east = np.sign(circle[top, 1, 0] - circle[top, 0, 0]) * np.array([1.0, 0.0])
    round_circle, begin = np.roll(circle, -top, axis=0), circle[top, 0]
    small, down = 0.8, np.array([0.0, -1.6])
    a = [begin, begin + 4 * east, begin + 4 * east + down, begin + down, begin + 2 * down]
    bend = 4 / 3 * small * east
    fold = [
        [a[0], a[0] + 1.3 * east, a[1] - 1.3 * east, a[1]], [a[1], a[1] + bend, a[2] + bend, a[2]],
        [a[2], a[2] - 1.3 * east, a[3] + 1.3 * east, a[3]], [a[3], a[3] - bend, a[4] - bend, a[4]],
    ]  # fmt: skip
    round_circle[0, :2] += 2 * down
    contour = gs.Contour(
        np.concatenate([round_circle[:, :3].reshape(-1, 2), np.array(fold)[:, :3].reshape(-1, 2)]),
        np.full(len(circle) + 4, 3),
    )
    result = gs.convert(gs.Outline("o", contours=(contour,)), gs.Options(corners="sharp", tolerance=1.0)).contours[0]
    assert result.measures.within_tolerance
    assert result.measures.deviation_bound is not None
    assert true_distance(result, 1) <= result.measures.deviation_bound + 0.01
    assert [arc.spline.closed for arc in result.interpolations] == [False, False]
    cubics = result.curve.cubics()
    ends, starts = cubics[:, 3] - cubics[:, 2], np.roll(cubics[:, 1] - cubics[:, 0], -1, axis=0)
    cross = ends[:, 0] * starts[:, 1] - ends[:, 1] * starts[:, 0]
    np.testing.assert_allclose(cross / np.hypot(*ends.T) / np.hypot(*starts.T), 0, atol=1e-6)
    assert ((ends * starts).sum(axis=1) > 0).all()


def test_workers_compile_the_spline_fit_before_their_time_limits_begin() -> None:
    disc = converted(gs.Options(corners="sharp")).contours[2]
    assert [arc.spline.closed for arc in disc.interpolations] == [True]
    assert disc.measures.iterations


def test_measures_are_those_of_the_curve() -> None:
    for contour in gs.convert(glyph("龍"), options()).contours:
        form, source = shape(contour.curve.rounded(1).cubics()), shape(contour.source.cubics())
        m = contour.measures
        assert m.length == pytest.approx(form.length)
        assert m.area_change == pytest.approx(form.area - source.area, abs=1e-6)
        assert m.bending_energy == pytest.approx(form.bending_energy)
        assert m.max_curvature == pytest.approx(form.max_curvature)


@pytest.mark.parametrize(("shift", "reason"), [(1e8, "changed the area"), (np.inf, "did not succeed")])
def test_overlaps_that_cannot_be_united_are_left_in_with_a_note(shift: float, reason: str) -> None:
    """Skia counts in single precision: far from the origin it loses contours, and gives up at infinity."""
    pytest.importorskip("pathops")
    a, b = (gs.Contour(square_contour(100).points + d, LINES) for d in (shift, shift + 50))
    outline = gs.Outline("far", contours=(a, b))
    same, note = remove_overlaps(outline)
    assert same is outline
    assert note is not None
    assert reason in note


@pytest.mark.parametrize("corners", ["smooth", "sharp"])
def test_a_contour_without_points_is_left_out(corners: Corners) -> None:
    nothing = gs.Contour(np.empty((0, 2)), np.empty(0, dtype=np.int64))
    result = gs.convert(gs.Outline("empty", contours=(nothing,)), gs.Options(corners=corners))
    assert len(result.contours) == 0
    assert result.notes == ("contour 0 has fewer than three distinct points and is left out",)


def test_a_broken_glyph_of_a_batch_costs_no_note_of_another() -> None:
    pytest.importorskip("pathops")
    a, b = (gs.Contour(square_contour(100).points + d, LINES) for d in (1e8, 1e8 + 50))
    broken = gs.Contour(np.array([[0.0, 0], [np.nan, 0], [0, 1]]), np.ones(3, dtype=np.int64))
    glyphs = [gs.Outline("far", contours=(a, b)), gs.Outline("broken", contours=(broken,))]
    far, error = gs.convert_many(glyphs, options(remove_overlaps=True), errors="return")
    assert isinstance(far, gs.GlyphResult)
    assert [note[:20] for note in far.notes] == ["overlaps were left i"]
    assert isinstance(error, gs.GlyphsplineError)


def test_a_glyph_whose_overlaps_stay_is_converted_and_says_so() -> None:
    pytest.importorskip("pathops")
    a, b = (gs.Contour(square_contour(100).points + d, LINES) for d in (1e8, 1e8 + 50))
    result = gs.convert(gs.Outline("far", contours=(a, b)), options(remove_overlaps=True))
    assert [contour.measures.segments for contour in result.contours] == [4, 4]
    assert all(contour.measures.within_tolerance for contour in result.contours)
    (note,) = result.notes
    assert note.startswith("overlaps were left in")
