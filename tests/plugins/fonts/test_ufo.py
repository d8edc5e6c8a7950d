"""UFO folders written from results and read back: outlines, flags, background, lib."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fontTools.pens.recordingPen import RecordingPointPen
from fontTools.ufoLib import UFOReader
from scipy.interpolate import BSpline

import glyphspline as gs
from glyphspline.errors import GlyphsplineError
from glyphspline.plugins.fonts.extrema import with_extrema
from glyphspline.plugins.fonts.ufo_folder import BACKGROUND, LIB_KEY, write_ufo
from glyphspline.readers import open_font
from glyphspline.readers.ufo import Ufo
from tests.drawings import L_SHAPE, circle, polygon_contour, result
from tests.places import FONTS


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[gs.GlyphResult]]:
    source = open_font(FONTS / "kouzan-gyosho.otf")
    options = gs.Options(corners="smooth", tolerance=3.0)
    results = [gs.convert(source.outline(name), options) for name in source.select(text="O& A")]
    path = tmp_path_factory.mktemp("ufo") / "out.ufo"
    assert write_ufo(source, results, path) == 4
    return path, results


def test_outlines_advances_and_characters_are_read_back_equal(
    written: tuple[Path, list[gs.GlyphResult]],
) -> None:
    path, results = written
    ufo = Ufo.opened(path)
    assert ufo.family == "Kouzan Gyosho Subset Spline"
    assert ufo.metrics == results[0].outline.metrics
    assert ufo.glyph_names == tuple(glyph.outline.name for glyph in results)
    for glyph in results:
        read = ufo.outline(glyph.outline.name)
        assert (read.advance, read.unicodes) == (glyph.outline.advance, glyph.outline.unicodes)
        for contour, found in zip(glyph.contours, read.contours, strict=True):
            expected = with_extrema(contour.curve, ufo.metrics.units_per_em).rounded(1)
            np.testing.assert_array_equal(found.degrees, expected.degrees)
            np.testing.assert_allclose(found.points, expected.points, atol=1e-9)


def test_polygons_are_the_background_and_the_lib_gives_the_splines_back(
    written: tuple[Path, list[gs.GlyphResult]],
) -> None:
    path, results = written
    reader = UFOReader(path, validate=True)
    front, back = reader.getGlyphSet(), reader.getGlyphSet(BACKGROUND)
    glyph = results[-1]

    class Read:
        lib: Any

    read, pen = Read(), RecordingPointPen()
    front.readGlyph(glyph.outline.name, read)
    back.readGlyph(glyph.outline.name, object(), pen)
    points = [args[0] for name, args, _ in pen.value if name == "addPoint"]
    np.testing.assert_allclose(points, np.concatenate([c.polygon for c in glyph.contours]), atol=0.05001)
    for entry, contour in zip(read.lib[LIB_KEY], glyph.contours, strict=True):
        (spline,) = entry["splines"]
        interpolation = contour.interpolations[0]
        assert spline["knots"] == interpolation.spline.knots.tolist()
        values = interpolation.spline.to_scipy()(np.array(spline["parameters"]) % interpolation.spline.period)
        assert isinstance(interpolation.spline.to_scipy(), BSpline)
        np.testing.assert_allclose(values, contour.polygon, atol=0.01)
        measures = entry["measures"]
        assert measures["vertices"] == len(contour.polygon)
        assert measures == {name: value for name, value in measures.items() if value is not None}


def test_points_are_smooth_where_the_curve_is(tmp_path: Path) -> None:
    round_one = gs.Contour.from_segments(circle(200, 3, centre=(300, 300)))
    cornered = gs.Contour.from_segments([*circle(100, 4)[:2], np.array([[-100.0, 0.0], [100.0, 0.0]])])
    source = open_font(FONTS / "edge-cases.ttf")
    write_ufo(source, [result(round_one, cornered, polygon_contour(L_SHAPE))], tmp_path / "x.ufo")
    pen = RecordingPointPen()
    UFOReader(tmp_path / "x.ufo").getGlyphSet().readGlyph("A", object(), pen)
    contours: list[list[tuple[float, float, bool]]] = []
    for name, args, _ in pen.value:
        if name == "beginPath":
            contours.append([])
        elif name == "addPoint" and args[1] is not None:
            contours[-1].append((*args[0], bool(args[2])))
    first, second, third = contours
    assert len(first) == 3 + 4 - 1  # three joints, four extrema, one of them a joint
    assert all(smooth for *_, smooth in first)
    assert sorted(second) == [(-100, 0, False), (0, 100, True), (100, 0, False)]
    assert not any(smooth for *_, smooth in third)


def test_only_a_ufo_is_replaced(tmp_path: Path) -> None:
    source = open_font(FONTS / "edge-cases.ttf")
    glyphs = [result(polygon_contour(L_SHAPE))]
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "letter.txt").write_text("dear")
    with pytest.raises(GlyphsplineError, match="no UFO"):
        write_ufo(source, glyphs, tmp_path / "mine")
    assert (tmp_path / "mine" / "letter.txt").exists()
    for _ in range(2):
        write_ufo(source, glyphs, tmp_path / "a.ufo")
    write_ufo(source, glyphs, tmp_path / "b.ufo")
    assert Ufo.opened(tmp_path / "a.ufo").sha256 == Ufo.opened(tmp_path / "b.ufo").sha256
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.ufo", "b.ufo", "mine"]
