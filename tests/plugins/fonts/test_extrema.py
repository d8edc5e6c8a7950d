"""Points at extrema: exact splits in memory, and what of them is left in fonts that were written and read again."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import numpy as np
import pytest

import glyphspline as gs
from glyphspline.curves.bezier import evaluate
from glyphspline.plugins.fonts.extrema import SHORTEST, UNIT, extremal_places, hidden_extrema, peaks, with_extrema
from glyphspline.plugins.fonts.tables.font_file import to_font, write_font
from glyphspline.plugins.fonts.tables.font_glyphs import ROUNDING, Flavour, fitting_tolerance
from glyphspline.plugins.fonts.ufo_folder import write_ufo
from glyphspline.readers import Source, open_font, open_source
from glyphspline.types import FloatArray
from tests.drawings import circle, polygon_contour, result
from tests.places import FONTS
from tests.readers.test_fonts import bounds, two_sided_distance

EM = 1000.0


def wave(height: float) -> gs.Contour:
    """Lines around a cubic that first rises and then falls, each by about 0.3 ``height``; no lowest point."""
    lower = np.array([[0.0, 0.0], [100.0, height], [200.0, -height], [300.0, 0.0]])
    sides = np.array([[300.0, 0.0], [300.0, 400.0], [-50.0, -100.0], [0.0, 0.0]])
    return gs.Contour.from_segments([lower, sides[:2], sides[1:3], sides[2:]])


def test_extrema_are_split_exactly() -> None:
    contour = gs.Contour.from_segments(circle(200, 3, centre=(7, -5)))
    split = with_extrema(contour, EM)
    assert len(split) == 3 + 4 - 1, "three joints, four extrema, one of them a joint"
    assert bounds(gs.Outline("a", contours=(contour,))) == pytest.approx(bounds(gs.Outline("a", contours=(split,))))
    ends = split.points[split.offsets]
    left, bottom, right, top = bounds(gs.Outline("a", contours=(contour,))) or ()
    for value, column in ((left, 0), (right, 0), (bottom, 1), (top, 1)):
        assert np.abs(ends[:, column] - value).min() < 1e-9
    for piece in split.segments():
        steps = np.diff(piece, axis=0).round(9)  # no piece turns back in either coordinate
        assert ((steps >= 0).all(axis=0) | (steps <= 0).all(axis=0)).all()


def test_a_quadratic_stays_quadratic_and_handles_lie_exactly_level() -> None:
    arch = gs.Contour.from_segments(
        [np.array([[0.0, 0.1], [1 / 3, 200.0], [200.0, 0.2]]), np.array([[200, 0.2], [0, 0.1]])]
    )
    split = with_extrema(arch, EM)
    assert split.degrees.tolist() == [2, 2, 1]
    assert split.points[1, 1] == split.points[2, 1] == split.points[3, 1]


def test_lines_and_what_has_points_already_are_left() -> None:
    for contour in (
        polygon_contour(np.array([[0.0, 0.0], [100.0, 3.0], [50.0, 90.0]])),
        gs.Contour.from_segments(circle(200, 4)),
        gs.Contour.from_segments(
            circle(200, 4) @ np.array([[np.cos(0.004), np.sin(0.004)], [-np.sin(0.004), np.cos(0.004)]])
        ),
    ):
        assert with_extrema(contour, EM) is contour or len(with_extrema(contour, EM)) == len(contour)


def test_waves_get_points_from_a_unit_on() -> None:
    assert len(with_extrema(wave(1.5), EM)) == 4
    assert len(with_extrema(wave(6.0), EM)) == 6
    assert len(with_extrema(wave(6.0), 10 * EM)) == 4


def test_peaks_rise_and_fall_by_the_height() -> None:
    assert peaks([0.0, 5.0, 4.9, 9.0, 3.0], 1.0) == [3, 0]
    assert peaks([0.0, 5.0, 4.9, 9.0, 3.0], 0.01) == [3, 0, 1, 2]
    assert peaks([3.0, 9.0, 9.0, 4.9, 5.0, 0.0], 3.0) == [1, 5]
    assert peaks([0.0, 0.1, 0.0], 0.5) == peaks([], 0.5) == []


def read_back(source: Source, results: list[gs.GlyphResult], kind: str, folder: Path) -> Source:
    path = folder / f"out.{kind}"
    if kind == "ufo":
        write_ufo(source, results, path)
    else:
        write_font(source, results, path, tolerance=4.0)
    return open_source(path)


def joints(contour: gs.Contour) -> tuple[FloatArray, FloatArray]:
    """(m, 2) the points on the curve, and (m, 2, 2) the handles before and after each, as vectors; parts of lines."""
    cubics = contour.cubics()
    return cubics[:, 0], np.stack(
        [cubics[:, 0] - np.roll(cubics[:, 2], 1, axis=0), cubics[:, 1] - cubics[:, 0]], axis=1
    )


def check_points(written: gs.Contour, em: float, grid: float) -> None:
    """An extremum of a contour read again lies at a point, or too near one to get its own, as far as rounding tells."""
    ends, cubics = joints(written)[0], written.cubics()
    for k in (0, 1):
        for place in extremal_places(cubics[..., k], UNIT * em + 2 * grid):
            j = int(place)
            at = evaluate(cubics[[j]], np.array([place % 1]))[0]
            assert np.abs(ends[[j, (j + 1) % len(ends)], k] - at[k]).min() <= SHORTEST * em + grid / 2


def check_levels(exact: gs.Contour, written: gs.Contour, grid: float) -> int:
    """Where the handles of the exact curve are level, those of the rounded one are; returns the number of points."""
    ends, arms = joints(written)
    level = 0
    for end, arm in zip(*joints(exact), strict=True):
        for k in (0, 1):
            if (arm[:, k] == 0).all() and (np.abs(arm[:, 1 - k]) > grid).all():
                i = int(np.hypot(*(ends - end).T).argmin())
                assert np.hypot(*(ends[i] - end)) <= ROUNDING * grid
                assert (arms[i, :, k] == 0).all()
                level += 1
    return level


@pytest.mark.parametrize("kind", ["otf", "ufo"])
@pytest.mark.parametrize("corners", ["smooth", "sharp"])
def test_extrema_of_the_outlines_read_back_have_points(
    kind: str, corners: Literal["smooth", "sharp"], tmp_path: Path
) -> None:
    source = open_font(FONTS / "kouzan-gyosho.otf")
    options = gs.Options(tolerance=fitting_tolerance(4.0, "ttf"), corners=corners)
    results = [gs.convert(source.outline(name), options) for name in source.select(text="O&8B")]
    written = read_back(source, results, kind, tmp_path)
    grid = 0.01 if kind == "ufo" else 1.0
    level = 0
    for one in results:
        for contour, found in zip(one.contours, written.outline(one.outline.name).contours, strict=True):
            check_points(found, source.metrics.units_per_em, grid)
            level += check_levels(with_extrema(contour.curve, source.metrics.units_per_em), found, grid)
    assert level > 4 * len(results)


def test_quadratics_have_points_at_nine_of_ten_extrema_of_the_splines_they_are_made_of(tmp_path: Path) -> None:
    source = open_font(FONTS / "kouzan-gyosho.otf")
    em, options = source.metrics.units_per_em, gs.Options(tolerance=fitting_tolerance(1.0, "ttf"))
    results = [gs.convert(source.outline(name), options) for name in source.select(text="O&8B龍")]
    write_font(source, results, tmp_path / "out.ttf", tolerance=1.0)
    written, every, met = open_source(tmp_path / "out.ttf"), 0, 0
    for one in results:
        for contour, found in zip(one.contours, written.outline(one.outline.name).contours, strict=True):
            ends, arms = joints(found)
            for end, arm in zip(*joints(with_extrema(contour.curve, em)), strict=True):
                for k in (0, 1):
                    if (arm[:, k] == 0).all() and (np.abs(arm[:, 1 - k]) > 1.0).all():
                        level = (arms[:, :, k] == 0).all(axis=1) & (np.hypot(*(ends - end).T) < 0.04 * em)
                        every, met = every + 1, met + bool((np.abs(ends[level, k] - end[k]) <= 1.0).any())
    assert met >= 0.9 * every > 15


@pytest.mark.parametrize("flavour", ["otf", "ttf"])
def test_with_the_points_the_curve_stays_where_it_was(flavour: Flavour, tmp_path: Path) -> None:
    source = open_font(FONTS / "kouzan-gyosho.otf")
    tolerance = 4.0
    options = gs.Options(corners="smooth", tolerance=fitting_tolerance(tolerance, flavour))
    results = [gs.convert(source.outline(name), options) for name in source.select(text="O&8B")]
    read = []
    for extrema in (False, True):
        data, summary = to_font(source, results, flavour, tolerance=tolerance, extrema=extrema)
        assert summary.beyond == ()
        assert (summary.extrema > 2 * len(results)) == extrema
        (tmp_path / f"{extrema}.{flavour}").write_bytes(data)
        read.append(open_font(tmp_path / f"{extrema}.{flavour}"))
    for one in results:
        plain, split = (font.outline(one.outline.name) for font in read)
        for contour, a, b in zip(one.contours, plain.contours, split.contours, strict=True):
            assert len(b) >= len(a) or flavour == "ttf"
            room = tolerance - contour.measures.deviation_bound if flavour == "ttf" else ROUNDING  # type: ignore[operator]
            assert two_sided_distance(contour.curve, b) <= room
            assert two_sided_distance(a, b) <= 2 * room


def test_a_split_that_rounding_would_move_out_of_tolerance_is_left_out() -> None:
    source = open_font(FONTS / "edge-cases.ttf")
    whole = np.round(circle(200.0, 3, centre=(300.0, 300.0)))
    given = result(gs.Contour.from_segments(whole), gid=source.glyph_names.index("A"))
    (contour,) = given.contours
    for bound, added in ((0.2, 3), (0.9999, 0)):
        measures = gs.Measures(3, 3, 18, deviation=bound, deviation_bound=bound)
        measured = gs.ContourResult(contour.source, contour.polygon, (), contour.curve, measures)
        glyph = gs.GlyphResult(given.outline, given.options, (measured,))
        _, summary = to_font(source, [glyph], "otf", tolerance=1.0)
        assert (summary.extrema, summary.beyond) == (added, ())
        assert summary.largest_error is not None
        assert summary.largest_error <= 1.0


def test_hidden_extrema_are_the_derivatives_changes_of_sign_between_the_ends() -> None:
    rng = np.random.default_rng(5)
    for points in rng.integers(-4, 5, (500, 4, 2)).astype(float):
        expected = 0
        for a, b, c in np.diff(points, axis=0).T:
            roots = np.roots([a - 2 * b + c, 2 * (b - a), a])
            inside = roots[(np.abs(roots.imag) < 1e-9) & (roots.real > 1e-9) & (roots.real < 1 - 1e-9)].real
            expected += len(inside) if len(inside) < 2 or np.ptp(inside) > 1e-6 else 0
        assert hidden_extrema(points) == expected, points
