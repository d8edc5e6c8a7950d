"""One closed spline a contour: the same curve as its arcs, lines and kept segments, C2 between triple knots."""

from __future__ import annotations

import numpy as np
import pytest

import glyphspline as gs
from glyphspline import hooks
from glyphspline.fitting.results import as_glyph, joined_results
from tests.drawings import L_SHAPE, polygon_contour
from tests.places import FONTS

FITS = {
    "smooth": gs.Options(corners="smooth"),
    "sharp": gs.Options(corners="sharp"),
    "g2": gs.Options(corners="sharp", continuity="g2"),
    "source": None,
}


@pytest.fixture(scope="module", params=FITS)
def results(request: pytest.FixtureRequest) -> list[gs.GlyphResult]:
    if request.param == "g2" and hooks.find("services", "g2_fits") is None:
        pytest.skip("the plug-in fonts is not there")
    font, options = gs.open_font(FONTS / "kouzan-gyosho.ttf"), FITS[request.param]
    outlines = [font.outline(name) for name in font.select(text="Og永")]
    return gs.convert_many(outlines, options) if options else [as_glyph(outline) for outline in outlines]


def test_it_is_the_contours_curve(results: list[gs.GlyphResult]) -> None:
    for contour in (contour for result in results for contour in result.contours):
        spline = contour.spline
        assert spline is not None
        spline = gs.Spline(spline.control_points, spline.knots)  # its knots are checked
        np.testing.assert_allclose(spline.to_bezier(), contour.curve.cubics(), atol=1e-9)
        if [arc.spline.closed for arc in contour.interpolations] == [True]:
            assert (spline.knots == contour.interpolations[0].spline.knots).all()
            assert (spline.control_points == contour.interpolations[0].spline.control_points).all()


def test_arcs_keep_their_control_points_and_intervals_between_triple_knots(results: list[gs.GlyphResult]) -> None:
    for contour in (contour for result in results for contour in result.contours):
        spline = contour.spline
        assert spline is not None
        P, u = spline.control_points, spline.knots
        _, times = np.unique(np.mod(u[:-1], spline.period), return_counts=True)
        assert set(times.tolist()).issubset({1, 3})
        for one in (arc.spline for arc in contour.interpolations if not arc.spline.closed):
            begins = (one.control_points[0] == P) & (np.roll(P, -1, axis=0) == one.control_points[1])
            (first,) = np.flatnonzero(begins.all(axis=1))
            own = np.arange(first, first + len(one.control_points)) % len(P)
            np.testing.assert_allclose(P[own], one.control_points, atol=1e-9)
            assert (P[own[:-1]] == one.control_points[:-1]).all()
            np.testing.assert_allclose(np.diff(u[own[1:-1]]), np.diff(one.knots), atol=1e-9)
            t = u[own[1]] + np.linspace(1e-6, 1 - 1e-6, 50) * one.period
            assert set(np.flatnonzero(spline.basis(t).any(axis=0)).tolist()) == set(own.tolist())  # no other arc's
            inner = u[own[2:-2]]
            for order in range(3):
                jumps = spline(inner, order) - spline(inner, order, side="left")
                assert np.abs(jumps).max(initial=0.0) < 1e-6 * np.abs(one.control_points).max()


def test_a_batch_is_its_glyphs(results: list[gs.GlyphResult]) -> None:
    found, offsets = joined_results(results)
    every = iter(found.splines())
    for contour in (contour for result in results for contour in result.contours):
        one, other = next(every), contour.spline
        assert one is not None
        assert other is not None
        assert (one.knots == other.knots).all()
        assert (one.control_points == other.control_points).all()
    assert next(every, None) is None
    assert offsets[-1] == len(found)


def test_lines_are_spans_of_their_own_and_points_are_none() -> None:
    point = gs.Contour(np.zeros((2, 2)), np.ones(2, dtype=np.int64))
    glyph = as_glyph(gs.Outline("x", contours=(polygon_contour(L_SHAPE), point, polygon_contour(L_SHAPE))))
    one, none, other = (contour.spline for contour in glyph.contours)
    assert none is None
    assert one is not None
    assert other is not None
    assert (one.control_points[::3] == L_SHAPE).all()
    assert (other.knots == one.knots).all()
    np.testing.assert_allclose(one.knots[2::3], np.cumsum(np.hypot(*np.diff(L_SHAPE, axis=0, append=L_SHAPE[:1]).T)))
    drop = gs.Contour(np.array([(0, 0), (90, 100), (-90, 100.0)]), np.array([3]))  # its chord has no length
    (contour,) = gs.convert(gs.Outline("x", contours=(drop,)), gs.Options(corners="sharp")).contours
    assert contour.spline is not None
    np.testing.assert_allclose(contour.spline.to_bezier(), contour.curve.cubics(), atol=1e-9)
