"""Rows of data sets: one row whatever the storage, points at equal arc lengths, and back again."""

from __future__ import annotations

import os
from dataclasses import replace
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest
from fontTools.fontBuilder import FontBuilder
from hypothesis import example, given
from hypothesis import strategies as st

import glyphspline as gs
from glyphspline.curves.integrals import area
from glyphspline.fitting.results import Measures
from glyphspline.plugins.datasets import columns
from glyphspline.plugins.datasets import load as loading
from glyphspline.plugins.datasets.canonical_outlines import canonical_outlines
from glyphspline.plugins.datasets.columns import ABOUT, contour_types, schema
from glyphspline.plugins.datasets.resampling import resampled
from glyphspline.plugins.datasets.rows import fits_of, table_of
from glyphspline.plugins.datasets.spec import DatasetSpec
from glyphspline.types import FloatArray
from tests.drawings import L_SHAPE, METRICS, circle, polygon_contour
from tests.places import FONTS

UNFITTED = DatasetSpec(options=None, normalise="units")


def outline(*contours: gs.Contour) -> gs.Outline:
    return gs.Outline("A", 36, (65,), 600.0, contours, METRICS)


def font_outlines(name: str = "kouzan-gyosho.ttf", text: str | None = None) -> list[gs.Outline]:
    source = gs.open_font(FONTS / name)
    return list(source.outlines(source.glyph_names if text is None else source.select(text=text)))


def stored_otherwise(given: gs.Outline, rng: np.random.Generator) -> gs.Outline:
    """The same shape: every contour from another joint, in another order, all perhaps the other way round."""
    found, backward = [], bool(rng.integers(2))
    for k in rng.permutation(len(given.contours)):
        contour = given.contours[k].reversed() if backward else given.contours[k]
        joint = int(rng.integers(len(contour)))
        points = np.roll(contour.points, -int(contour.offsets[joint]), axis=0)
        found.append(gs.Contour(points, np.roll(contour.degrees, -joint)))
    return replace(given, contours=found)


# One row, however it is stored


@pytest.mark.parametrize("font", ["kouzan-gyosho.ttf", "kouzan-gyosho.otf", "variable.ttf", "edge-cases.ttf"])
def test_a_glyph_of_a_font_has_one_row_however_it_is_stored(font: str) -> None:
    rng = np.random.default_rng(1)
    outlines = font_outlines(font)
    for rows in ("glyph", "contour"):
        spec = replace(UNFITTED, rows=rows)
        table = table_of(outlines, None, spec)
        for _ in range(3):
            assert table_of([stored_otherwise(each, rng) for each in outlines], None, spec).equals(table)


def test_implied_points_and_direction_of_a_real_font_make_no_difference(tmp_path: Path) -> None:
    from fontTools.pens.reverseContourPen import ReverseContourPen
    from fontTools.pens.ttGlyphPen import TTGlyphPen
    from fontTools.ttLib.tables._g_l_y_f import dropImpliedOnCurvePoints

    ring = [(0, -200), (200, -200), (200, 0), (200, 200), (0, 200), (-200, 200), (-200, 0), (-200, -200)]
    tables, points = [], []
    for implied, backward in ((False, False), (True, False), (False, True)):
        pen = TTGlyphPen(None)
        to: Any = ReverseContourPen(pen) if backward else pen
        for size, inner in ((1.0, False), (0.5, True)):
            own = [(300 + round(size * x), 300 + round(size * y)) for x, y in (ring[::-1] if inner else ring)]
            own = own[1:] + own[:1] if inner else own
            to.moveTo(own[0])
            for k in range(1, 9, 2):
                to.qCurveTo(own[k], own[(k + 1) % 8])
            to.closePath()
        glyph = pen.glyph(dropImpliedOnCurves=False)
        if implied:
            assert dropImpliedOnCurvePoints(glyph)
        builder = FontBuilder(1000, isTTF=True)
        builder.setupGlyphOrder([".notdef", "o"])
        builder.setupCharacterMap({0x6F: "o"})
        builder.setupGlyf({".notdef": TTGlyphPen(None).glyph(), "o": glyph})
        builder.setupHorizontalMetrics({".notdef": (600, 0), "o": (600, 0)})
        builder.setupHorizontalHeader(ascent=800, descent=-200)
        builder.setupNameTable({"familyName": "T", "styleName": "R"})
        builder.setupPost()
        builder.save(path := tmp_path / f"{implied}{backward}.ttf")
        points.append(len(glyph.coordinates))
        tables.append(table_of([gs.open_font(path).outline("o")], None, UNFITTED))
    assert points == [16, 8, 16]
    assert tables[0].equals(tables[1])
    assert tables[0].equals(tables[2])


def test_a_fit_has_one_row_however_the_outline_is_stored() -> None:
    rng, spec = np.random.default_rng(2), DatasetSpec()
    outlines = font_outlines(text="gO")
    otherwise = [stored_otherwise(each, rng) for each in outlines]
    one, other = (fits_of(given, spec) for given in (outlines, otherwise))
    assert table_of(outlines, one, spec).equals(table_of(otherwise, other, spec))  # type: ignore[arg-type]


def test_united_outlines_are_canonical_too() -> None:
    left, right = (polygon_contour(L_SHAPE + np.array([x, 0.0])) for x in (0.0, 100.0))
    spec = DatasetSpec(options=gs.Options(corners="sharp", remove_overlaps=True), normalise="units")
    (found,) = fits_of([outline(left, right)], spec)
    (row,) = table_of([outline(left, right)], [found], spec).to_pylist()  # type: ignore[list-item]
    assert row["source_points"][0][0] == [50.0, 0.0]
    assert all(area(contour.cubics()) > 0 for contour in gs.load(row).outline.contours)


@st.composite
def contours(draw: st.DrawFn) -> gs.Contour:
    degrees = draw(st.lists(st.integers(1, 3), min_size=2, max_size=7))
    grid = st.tuples(st.integers(0, 12), st.integers(0, 12))  # so coarse that joints coincide and areas vanish
    points = draw(st.lists(grid, min_size=sum(degrees), max_size=sum(degrees)))
    return gs.Contour(50.0 * np.array(points, dtype=float), np.array(degrees))


@given(contours(), st.integers(0, 2**32))
@example(gs.Contour(np.array([[50.0, 0], [0, 0], [50, 0], [100, 0]]), np.array([1, 3])), 1)  # told by degrees alone
def test_a_contour_of_any_shape_has_one_row(contour: gs.Contour, seed: int) -> None:
    given = outline(contour)
    otherwise = stored_otherwise(given, np.random.default_rng(seed))
    assert table_of([otherwise], None, UNFITTED).equals(table_of([given], None, UNFITTED))
    (once,) = canonical_outlines([given])
    (twice,) = canonical_outlines([once])
    for one, other in zip(once.arrays, twice.arrays, strict=True):
        np.testing.assert_array_equal(one, other)


def test_ink_is_to_the_left_and_holes_come_after_what_they_are_in() -> None:
    outer, hole, island, apart = 300.0, 200.0, 100.0, 40.0
    rings = [(apart, (500.0, 0.0), -1), (hole, (0.0, 0.0), 1), (island, (0.0, 0.0), -1), (outer, (0.0, 0.0), -1)]
    drawn = [gs.Contour.from_segments(circle(r, 8, centre=centre, turn=turn)) for r, centre, turn in rings]
    (found,) = canonical_outlines([outline(*drawn)])
    areas = [area(contour.cubics()) for contour in found.contours]
    expected = [np.pi * outer**2, -np.pi * hole**2, np.pi * island**2, np.pi * apart**2]
    np.testing.assert_allclose(areas, expected, rtol=1e-3)


def test_segments_of_no_length_and_contours_that_enclose_nothing_are_left_out() -> None:
    padded = gs.Contour(np.repeat(L_SHAPE, [1, 1, 3, 1, 1, 1], axis=0), np.ones(8, dtype=np.int64))
    line = polygon_contour(np.array([[0.0, 0.0], [10.0, 0.0]]))
    (found,) = canonical_outlines([outline(line, padded)])
    np.testing.assert_array_equal(found.contours[0].points, L_SHAPE[np.r_[0:6]])
    assert len(found.contours) == 1


def test_shapes_are_equal_in_fonts_of_another_em_and_differ_by_a_thousandth() -> None:
    square = polygon_contour(np.array([[0, 0], [500, 0], [500, 500], [0, 500]], dtype=float))
    other = gs.Outline("B", 7, (), 0.0, [gs.Contour(2 * square.points, square.degrees)], gs.FontMetrics(2000.0))
    moved = outline(gs.Contour(square.points + np.eye(4, 2), square.degrees))
    found = table_of([outline(square), other, moved, outline()], None, UNFITTED)["shape"].to_pylist()
    assert found[0] == found[1] != found[2]
    assert found[3] is None


# Points at equal arc lengths


FINE = 5000
"""Chords a segment: too short by less than 1e-6 of it."""


@given(contours())
def test_points_are_at_equal_arc_lengths(contour: gs.Contour) -> None:
    """Against short chords, cusps too."""
    (canonical,) = canonical_outlines([outline(contour)])
    if not canonical.contours:
        return
    found = resampled(canonical.arrays, 16, 0.2)
    own = canonical.contours[0]
    fine = own.at(np.arange(FINE * len(own)) / FINE)
    steps = np.hypot(*np.diff(np.concatenate([fine, fine[:1]]), axis=0).T)
    along, total = np.concatenate([[0.0], np.cumsum(steps)[:-1]]), steps.sum()
    assert found.lengths[0] == pytest.approx(total, rel=1e-6)
    assert found.points[0].sum() == pytest.approx(fine.sum(axis=1).min(), abs=1e-5 * total)
    away = np.hypot(*(fine - found.points[0]).T)
    error = steps.max() + 1e-5 * total
    apart = []
    for start in np.flatnonzero(away <= away.min() + error):  # more than one, if the contour comes there again
        places = (along[start] + total * np.arange(16) / 16) % total
        wanted = fine[np.searchsorted(along, places, side="right") - 1]
        apart.append(np.hypot(*(found.points - wanted).T).max())
    assert min(apart) <= 2 * error


@pytest.mark.parametrize("turn", [1, -1])
def test_a_circle_has_its_points_tangents_and_curvature(turn: int) -> None:
    ring = outline(gs.Contour.from_segments(circle(200.0, centre=(300.0, 100.0), turn=turn)))
    (row,) = table_of([ring], None, replace(UNFITTED, rows="contour", points=40)).to_pylist()
    angles = 2 * np.pi * np.arange(40) / 40 - 3 * np.pi / 4
    around = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    np.testing.assert_allclose(row["points"], 200 * around + [300, 100], atol=1e-3)
    np.testing.assert_allclose(row["tangents"], np.stack([-around[:, 1], around[:, 0]], axis=1), atol=1e-5)
    np.testing.assert_allclose(row["curvature"], 1 / 200, rtol=1e-4)
    assert not any(row["corner"])


def test_every_corner_has_its_nearest_point() -> None:
    row = table_of([outline(polygon_contour(L_SHAPE))], None, UNFITTED).to_pylist()[0]
    points, corners = np.array(row["points"][0]), np.array(row["corner"][0])
    expected = {int(np.argmin(np.hypot(*(points - corner).T))) for corner in L_SHAPE}
    assert set(np.flatnonzero(corners).tolist()) == expected
    assert len(expected) == 6
    np.testing.assert_array_equal(points[0], [50, 0])
    assert row["tangents"][0][0] == [1.0, 0.0], "at a corner, of what follows"


def test_a_cusp_has_a_tangent_and_no_curvature() -> None:
    cusp = gs.Contour(np.array([[0, 0], [600, 600], [0, 600], [600, 0], [300, -300.0]]), np.array([3, 1, 1]))
    row = table_of([outline(cusp)], None, replace(UNFITTED, points=None)).to_pylist()[0]
    assert np.isfinite(np.array(row["tangents"][0])).all()
    pinched = gs.Contour(np.array([[0, 0], [0, 0], [500, 500.0], [0, 500], [-300, 300]]), np.array([3, 1, 1]))
    row = table_of([outline(pinched)], None, replace(UNFITTED, points=None)).to_pylist()[0]
    place = row["points"][0].index([0.0, 0.0])
    assert row["curvature"][0][place] is None
    assert row["tangents"][0][place] == pytest.approx([np.sqrt(0.5)] * 2)


# Columns


@pytest.fixture(scope="module")
def fitted() -> tuple[list[gs.Outline], list[gs.GlyphResult]]:
    outlines = font_outlines(text="gO好")
    return outlines, [fit for fit in fits_of(outlines, DatasetSpec()) if isinstance(fit, gs.GlyphResult)]


@pytest.mark.parametrize("rows", ["glyph", "contour"])
@pytest.mark.parametrize("points", [48, None])
@pytest.mark.parametrize("fit", [True, False])
@pytest.mark.parametrize("normalise", ["em", "units"])
def test_rows_are_read_back(
    fitted: tuple[list[gs.Outline], list[gs.GlyphResult]], rows: Any, points: int | None, fit: bool, normalise: Any
) -> None:
    outlines, results = fitted
    spec = DatasetSpec(rows=rows, points=points, normalise=normalise, options=DatasetSpec().options if fit else None)
    table = table_of(outlines, results if fit else [None] * len(outlines), spec)
    table.validate(full=True)
    file = BytesIO()
    pq.write_table(table, file)
    read = pq.read_table(BytesIO(file.getvalue()))
    assert read.equals(table)
    scale = 1024.0 if normalise == "em" else 1.0
    loaded = [gs.load(row) for row in read.to_pylist()]
    by_pandas = [gs.load({name: as_pandas(value) for name, value in row.items()}) for row in read.to_pylist()]
    contours = [(r, c) for r in results for c in r.contours]
    whole = [(r.outline, list(r.contours)) for r in results]
    expected = whole if rows == "glyph" else [(r.outline, [c]) for r, c in contours]
    assert len(loaded) == len(by_pandas) == len(expected)
    for got, again, (source, its) in zip(loaded, by_pandas, expected, strict=True):
        assert (got.outline.name, got.outline.gid, got.outline.unicodes) == (source.name, source.gid, source.unicodes)
        assert got.outline.advance * scale == pytest.approx(source.advance)
        assert got.outline.metrics.units_per_em * scale == source.metrics.units_per_em
        assert len(got.outline.contours) == len(got.points) == len(its)
        for contour, other, one in zip(got.outline.contours, again.outline.contours, its, strict=True):
            np.testing.assert_array_equal(contour.points * scale, one.source.points)
            np.testing.assert_array_equal(contour.degrees, one.source.degrees)
            np.testing.assert_array_equal(contour.points, other.points)
        assert (got.splines is not None) == (again.splines is not None) == fit
        for splines, one in zip(got.splines or (), its, strict=False):
            assert len(splines) == len(one.interpolations)
            for spline, arc in zip(splines, one.interpolations, strict=True):
                np.testing.assert_allclose(spline.to_bezier() * scale, arc.spline.to_bezier(), rtol=1e-12, atol=1e-9)
        assert (got.whole_splines is not None) == (again.whole_splines is not None) == fit
        for whole_spline, one in zip(got.whole_splines or (), its, strict=False):
            assert whole_spline is not None
            np.testing.assert_allclose(whole_spline.to_bezier() * scale, one.curve.cubics(), rtol=1e-12, atol=1e-9)
        for own, one in zip(got.points, its, strict=True):
            if points is not None:
                assert own.shape == (points, 2)
            else:
                polygon = one.polygon if fit else one.source.points[one.source.offsets]
                assert {*map(tuple, np.round(own * scale, 2).tolist())} == {*map(tuple, np.round(polygon, 2).tolist())}


def as_pandas(value: Any) -> Any:
    """A row as pandas has it: each list an array, of arrays if its items are lists."""
    if not isinstance(value, list):
        return value
    found = np.empty(len(value), dtype=object)
    found[:] = [as_pandas(item) for item in value]
    return found


def test_measures_are_in_the_row_s_unit_and_bounds_stay_bounds(
    fitted: tuple[list[gs.Outline], list[gs.GlyphResult]],
) -> None:
    outlines, results = fitted
    measures = [contour.measures for result in results for contour in result.contours]
    powers = {"length": 1, "area_change": 2, "bending_energy": -1, "max_curvature": -1, "deviation": 1}
    rows = table_of(outlines, results, DatasetSpec(rows="contour")).to_pylist()
    for row, own in zip(rows, measures, strict=True):
        for name, power in powers.items():
            assert row[name] * 1024.0**power == pytest.approx(getattr(own, name), rel=1e-12)
        assert row["deviation_bound"] * 1024.0 >= (own.deviation_bound or 0.0)
        assert max(np.abs(row["curvature"])) <= row["max_curvature"] * 1.01
    units = table_of(outlines, results, DatasetSpec(rows="contour", normalise="units")).to_pylist()
    assert [Measures(**{name: row[name] for name in Measures.__dataclass_fields__}) for row in units] == measures


def test_without_a_fit_its_columns_are_null_and_an_empty_glyph_has_a_row() -> None:
    (row,) = table_of([outline()], None, DatasetSpec(options=None)).to_pylist()
    assert (row["points"], row["source_points"], row["shape"]) == ([], [], None)
    assert {row[name] for name in ("knots", "polygon", "deviation_bound", "vertices")} == {None}
    assert gs.load(row).outline.contours.arrays.num_contours == 0  # type: ignore[attr-defined]
    assert table_of([outline()], None, DatasetSpec(options=None, rows="contour")).num_rows == 0
    assert table_of([], [], DatasetSpec()).schema.equals(schema(DatasetSpec()))


def test_coordinates_that_are_no_numbers_are_refused() -> None:
    broken = polygon_contour(np.array([[0, 0], [np.nan, 0], [500, 500], [0, 500]], dtype=float))
    with pytest.raises(gs.GlyphsplineError):
        table_of([outline(broken)], None, UNFITTED)


def test_every_column_is_documented_and_has_its_unit() -> None:
    layout = schema(DatasetSpec(rows="contour", raster=8))
    assert schema(DatasetSpec(rows="contour", raster=8), of_fonts=True).names == list(ABOUT)
    page = (FONTS.parent / "docs" / "datasets.md").read_text(encoding="utf-8")
    assert "\n".join(f"| `{name}` | {about} |" for name, about in ABOUT.items()) in page
    assert layout.field("points").metadata == {b"unit": b"em"}
    assert layout.field("curvature").metadata == {b"unit": b"1/em"}
    assert layout.field("area_change").metadata == {b"unit": b"em^2"}
    assert schema(UNFITTED).field("knots").metadata == {b"unit": b"font unit"}
    assert set(contour_types(DatasetSpec())) <= set(layout.names)


def test_a_newer_row_is_refused_and_a_missing_column_is_named() -> None:
    (row,) = table_of([outline(polygon_contour(L_SHAPE))], None, UNFITTED).to_pylist()
    assert gs.load(row).outline.name == "A"
    with pytest.raises(gs.GlyphsplineError, match=f"schema version 99, .* up to {columns.SCHEMA_VERSION}"):
        gs.load(row | {"schema_version": 99})
    with pytest.raises(gs.GlyphsplineError, match="source_points"):
        gs.load({name: value for name, value in row.items() if name != "source_points"})


def test_a_newer_program_reads_an_older_row(monkeypatch: pytest.MonkeyPatch) -> None:
    (row,) = table_of([outline(polygon_contour(L_SHAPE))], None, UNFITTED).to_pylist()
    monkeypatch.setattr(loading, "SCHEMA_VERSION", columns.SCHEMA_VERSION + 1)
    assert gs.load(row).outline.name == "A"


def test_rows_of_the_first_schema_are_read() -> None:
    """``rows-of-schema-1.parquet`` was written by ``dataset --characters O --normalise units`` of 0.1.0, and stays."""
    (row,) = pq.read_table(Path(__file__).parent / "rows-of-schema-1.parquet").to_pylist()
    assert row["schema_version"] == 1
    loaded = gs.load(row)
    (expected,) = canonical_outlines(font_outlines(text="O"))
    assert (loaded.outline.name, loaded.outline.unicodes) == ("O", (79,))
    for one, other in zip(loaded.outline.arrays, expected.arrays, strict=True):
        np.testing.assert_array_equal(one, other)
    assert loaded.whole_splines is None
    assert loaded.splines is not None
    assert [[len(spline.control_points) for spline in own] for own in loaded.splines] == [
        [len(points) for points in own] for own in row["control_points"]
    ]


# Pictures


def picture(*contours: gs.Contour, size: int = 50) -> FloatArray:
    (row,) = table_of([outline(*contours)], None, DatasetSpec(options=None, raster=size)).to_pylist()
    return np.array(row["raster"]) / 255.0


def test_a_picture_covers_the_area_and_stands_upright() -> None:
    grey = picture(polygon_contour(L_SHAPE))
    ink = 400 * 80 + 80 * 620
    assert grey.sum() * (1000 / 50) ** 2 == pytest.approx(ink, rel=0.01)
    # The em square: from left to right about half the advance, from bottom to top from descender to ascender.
    rows, places = np.nonzero(grey)
    assert (rows.min(), rows.max()) == ((800 - 700) // 20, (800 - 0) // 20 - 1)
    assert (places.min(), places.max()) == ((50 + 200) // 20, (450 + 200 - 1) // 20)
    assert grey[-12].sum() > grey[10].sum(), "the foot of the L is below"


def test_a_picture_holds_all_ink() -> None:
    tall = polygon_contour(np.array([[0, -400], [300, -400], [300, 1000], [0, 1000.0]]))
    (row,) = table_of([outline(tall)], None, DatasetSpec(options=None, raster=70, normalise="units")).to_pylist()
    assert row["raster_side"] == 1400
    grey = np.array(row["raster"]) / 255.0
    assert grey.sum() * (1400 / 70) ** 2 == pytest.approx(300 * 1400, rel=1e-2)
    (small,) = table_of([outline(polygon_contour(L_SHAPE))], None, DatasetSpec(options=None, raster=8)).to_pylist()
    assert small["raster_side"] == 1


def test_pictures_are_filled_by_the_non_zero_rule_and_antialiased() -> None:
    ring, hole = (gs.Contour.from_segments(circle(r, centre=(300, 300), turn=t)) for r, t in ((200, 1), (100, -1)))
    assert picture(ring, hole).sum() * 400 == pytest.approx(np.pi * (200**2 - 100**2), rel=0.01)
    assert picture(ring, hole.reversed()).sum() * 400 == pytest.approx(np.pi * 200**2, rel=0.01)
    grey = picture(ring)
    assert ((grey > 0) & (grey < 1)).sum() > 40


@pytest.mark.needs("nbclient", "nbformat", "ipykernel")
def test_the_notebook_runs_and_keeps_no_outputs() -> None:
    import nbclient
    import nbformat

    path = FONTS.parent / "glyphspline" / "examples" / "dataset.ipynb"
    notebook: Any = nbformat.read(path, as_version=4)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert not any(cell.outputs or cell.execution_count for cell in code)
    os.environ.setdefault("PYDEVD_DISABLE_FILE_VALIDATION", "1")
    nbclient.NotebookClient(notebook, timeout=600, resources={"metadata": {"path": str(path.parent)}}).execute()
    said = "".join(output.get("text", "") for cell in code for output in cell.outputs)
    assert "o of DejaVu Sans Book \u2192" in said
    assert "<Outline 'g'" in said
    shown = [kind for cell in code for output in cell.outputs for kind in output.get("data", {})]
    assert shown.count("image/png") == 2
