"""The short way gives what the long way gives."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from svgpathtools import parse_path

import glyphspline as gs
from glyphspline.batch import RunSpec, convert_font, entries_of
from glyphspline.batch import worker as work
from glyphspline.batch.entry import measured, solved_texts, told_of
from glyphspline.batch.job import Job
from glyphspline.batch.lane import Drawn, draw_chunk, drawn_map, drawn_source, drawn_svg, source_texts, suits
from glyphspline.batch.run import tasks_of
from glyphspline.fitting.options import Options
from glyphspline.outlines.places import sampled
from glyphspline.outlines.sampling import sample
from glyphspline.readers import open_font
from glyphspline.readers.opentype.bulk_contours import BulkReader, cubics_of, read_chunk
from glyphspline.types import FloatArray
from glyphspline.writers.svg.curvature_map import to_curvature_svg
from glyphspline.writers.svg.document import to_svg
from glyphspline.writers.svg.markup import polyline_data
from glyphspline.writers.svg.source_drawing import to_source_svg

FONTS = Path(__file__).parents[1] / "fonts_test"
STATIC = ["kouzan-gyosho.ttf", "kouzan-gyosho.otf", "kouzan-kaisho.ttf", "edge-cases.ttf"]


@pytest.mark.parametrize("view_box", ["em", "ink"])
@pytest.mark.parametrize("name", STATIC)
def test_both_ways_write_the_same_files(
    name: str, view_box: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    font = open_font(FONTS / name)
    spec = RunSpec(Options(step=31.0, precision=1), ("svg",), view_box)  # type: ignore[arg-type]
    names = font.select(all_glyphs=True)
    convert_font(font, names, tmp_path / "short", spec, jobs=0)
    monkeypatch.setattr(work, "short_way", lambda job: False)
    convert_font(font, names, tmp_path / "long", spec, jobs=0)
    short, long = (tmp_path / way for way in ("short", "long"))
    assert (short / "run.json").read_bytes() == (long / "run.json").read_bytes()
    assert without_rates(short) == without_rates(long)
    drawings = sorted(path.name for path in long.glob("svg/*"))
    assert sorted(path.name for path in short.glob("svg/*")) == drawings
    for drawing in drawings:
        assert alike(*((way / "svg" / drawing).read_text() for way in (short, long))), drawing


@pytest.mark.parametrize("name", STATIC)
def test_maps_of_chunks_are_the_writers_to_the_byte(name: str) -> None:
    font = open_font(FONTS / name)
    options = Options(step=31.0, precision=1)
    drawn = draw_chunk(BulkReader(font.path, 0), range(font.num_glyphs), options)
    for glyph, short in zip(font.glyph_names, drawn, strict=True):
        if short is None:
            continue
        outline = font.outline(glyph)
        result = gs.GlyphResult(outline, options, tuple(contour_results(outline, short)))
        assert drawn_map(outline, short, 0.02).decode() == to_curvature_svg(result, scale=0.02), glyph
        texts = source_texts(short, font.metrics.units_per_em, 1)
        assert drawn_source(outline, short, texts, 1).decode() == to_source_svg(result), glyph
        assert drawn_svg(outline, short, 1, "ink").decode() == to_svg(result, view_box="ink"), glyph


def contour_results(outline: gs.Outline, drawn: Drawn) -> Iterator[gs.ContourResult]:
    """What the long way makes of the polygons of the short one."""
    none = np.empty(0)
    points, starts, stops, _ = drawn.polygons
    for contour, a, b, (controls, knots) in zip(outline.contours, starts, stops, drawn.splines, strict=True):
        spline = gs.Spline(controls, knots)
        found = gs.Interpolation(spline, none, none, 0, none, True, 0, 0.0, np.empty(0, dtype=np.int64))
        measures = gs.Measures(0, 0, 0, 0, 0.0, True, 0.0, 0)
        yield gs.ContourResult(
            contour, points[a:b], (found,), gs.Contour.from_segments(list(spline.to_bezier())), measures
        )


def without_rates(folder: Path) -> list[Any]:
    """The manifest, but for the measures in which rounding errors show."""
    entries = list(entries_of(folder))
    for entry in entries:
        for contour in entry["contours"]:
            del contour["residual"], contour["rate_bound"]
    return entries


def alike(a: str, b: str) -> bool:
    """Whether two drawings are the same, but for a few coordinates within a unit of their last digit."""
    data = re.compile(r' d="([^"]*)"')
    if data.sub("", a) != data.sub("", b):
        return False
    x, y = (np.concatenate([coordinates(path) for path in data.findall(text)]) for text in (a, b))
    return x.shape == y.shape and bool((np.abs(x - y) <= 0.1000001).all() and (np.abs(x - y) > 1e-9).mean() < 1e-2)


def coordinates(path: str) -> FloatArray:
    points = np.array([point for segment in parse_path(path) for point in segment.bpoints()])
    return np.concatenate([points.real, points.imag])


@pytest.mark.parametrize("name", STATIC)
def test_outlines_read_at_once_are_those_of_the_font(name: str) -> None:
    font = open_font(FONTS / name)
    read = read_chunk(BulkReader(font.path, 0), range(font.num_glyphs))
    for glyph, found in zip(font.glyph_names, read, strict=True):
        outline = font.outline(glyph)
        assert (found is None) == (not outline.contours)
        if found is not None:
            assert found.advance == outline.advance
            for own, contour in zip(found.contours, outline.contours, strict=True):
                assert own.points.tobytes() == contour.points.tobytes()
                assert own.degrees.tobytes() == contour.degrees.tobytes()


@pytest.mark.parametrize("options", [Options(step=25.0), Options(tolerance=2.0, corners="sharp")])
def test_what_is_told_beside_a_line_is_what_the_line_says(options: Options, tmp_path: Path) -> None:
    font = open_font(FONTS / "kouzan-gyosho.otf")
    (tmp_path / "svg").mkdir()
    job = Job(font.path, 0, (), tmp_path, RunSpec(options, ("svg",)), font.metrics, True)
    found = work.work(job, tasks_of(font, font.glyph_names[:12], ()))
    assert [done.status for done in found].count("ok") > 8
    for done in found:
        assert (done.row, done.facts) == told_of(json.loads(done.line.partition(b"\t")[2]))


def test_measures_that_are_no_numbers_are_null() -> None:
    columns: list[list[Any]] = [
        [3, 4],
        [3, 4],
        [6, 8],
        [9, 1000],
        [0.001, np.inf],
        [True, False],
        [1.5, np.nan],
        [0, 1],
    ]
    good, bad = map(json.loads, solved_texts(columns))
    assert (good["residual"], good["converged"], good["rate_bound"], good["deviation"]) == (0.001, True, 1.5, None)
    assert (bad["residual"], bad["converged"], bad["rate_bound"], bad["iterations"]) == (None, False, None, 1000)
    contour = gs.Measures(3, 3, 6, 9, 0.001, True, np.inf, 0, deviation=0.25, within_tolerance=True)
    entry = json.loads(measured([contour], Options()))
    assert (entry["rate_bound"], entry["deviation"], entry["within_tolerance"]) == (None, 0.25, True)
    assert entry["length"] is None


@pytest.mark.parametrize("name", STATIC)
def test_no_usual_glyph_is_left_to_the_long_way(name: str) -> None:
    font = open_font(FONTS / name)
    drawn = draw_chunk(BulkReader(font.path, 0), range(font.num_glyphs), Options(step=25.0))
    empty = [len(font.outline(glyph).contours) == 0 for glyph in font.glyph_names]
    assert [glyph is None for glyph in drawn] == empty


@pytest.mark.parametrize("step", [7.0, 20.0, 50.0, 1000.0])
def test_vertices_are_those_of_the_sampling(step: float) -> None:
    font = open_font(FONTS / "kouzan-gyosho.otf")
    reader = BulkReader(font.path, 0)
    gid = font.glyph_names.index("uni9F8D")
    buffer, starts, _, _ = reader.read([gid])
    cubics, contours, *_ = cubics_of(buffer, starts)
    points, _, offsets, odd = sampled(cubics, contours, step, 0, 4.0, np.radians(12.0), 10_000)
    assert not odd.any()
    for k, contour in enumerate(font.outline("uni9F8D").contours):
        expected = sample(contour, step=step)
        assert points[offsets[k] : offsets[k + 1]] == pytest.approx(expected, abs=1e-6)


def test_too_many_vertices_are_left_to_the_long_way() -> None:
    reader = BulkReader(FONTS / "kouzan-gyosho.otf", 0)
    assert draw_chunk(reader, [5, 6], Options(step=1e-3)) == [None, None]


@pytest.mark.parametrize(
    ("value", "precision", "text"),
    [(0, 2, "0"), (5, 2, ".05"), (-5, 2, "-.05"), (120, 2, "1.2"), (-100, 2, "-1"), (12345, 0, "12345"),
     (999_999_999_999_999, 3, "999999999999.999"), (1_000_000, 2, "10000"), (7, 9, ".000000007")],
)  # fmt: skip
def test_numbers_are_written_exactly(value: int, precision: int, text: str) -> None:
    points = np.array([[value, -value]]) / 10.0**precision
    assert polyline_data(points, precision) == f"M{text}{text if value < 0 else f' {text}'}"


def test_only_plain_stepping_takes_the_short_way() -> None:
    assert suits(Options(step=20.0))
    for options in (Options(), Options(count=30), Options(step=20.0, measure=True), Options(step=20.0, variant=4)):
        assert not suits(options)
