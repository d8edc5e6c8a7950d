"""Formats of one file a font, written at the end of a run: all next to each other, and the same however it went."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest

import glyphspline as gs
from glyphspline.errors import OutputError
from glyphspline.fitting.options import Options
from glyphspline.plugins.drawings.svg import SvgDrawings
from glyphspline.plugins.fonts.extrema import with_extrema
from glyphspline.plugins.fonts.spec import RefitSpec
from glyphspline.readers import open_font
from glyphspline.readers.ufo import Ufo
from glyphspline.runs.convert import convert_font
from glyphspline.runs.folder import entries_of
from glyphspline.runs.result_text import from_text, to_text
from glyphspline.runs.spec import RunSpec
from tests.places import FONTS
from tests.plugins.fonts.test_font import largest_distance
from tests.runs.test_batch import content

ALL = ("svg", "curvature", "ufo", "otf", "ttf")
SPEC = RefitSpec(Options(tolerance=4.0), ALL)
TEXT = "O8 B"


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("whole") / "out"
    source = open_font(FONTS / "kouzan-gyosho.otf")
    summary = convert_font(source, source.select(text=TEXT), folder, SPEC, jobs=0)
    assert "within" in next(remark for remark in summary.remarks if "as read back" in remark)
    assert [remark.split(":")[0] for remark in summary.remarks if "as read back" not in remark] == [
        f"KouzanGyoshoSubset-spline.{name}" for name in ("otf", "ttf", "ufo")
    ]
    return folder


def test_a_ttf_alone_is_made_of_outlines_and_nothing_is_fitted_that_it_does_not_use(tmp_path: Path) -> None:
    font, options, made = open_font(FONTS / "kouzan-gyosho.ttf"), Options(continuity="g2"), []
    for formats in (("ttf",), ("ttf", "json")):
        out = tmp_path / formats[-1]
        convert_font(font, font.select(text="gO"), out, RefitSpec(options, formats), jobs=0)
        made.append((out / "KouzanGyoshoSubset-spline.ttf").read_bytes())
        assert [entry["contours"] is None for entry in entries_of(out)] == [formats == ("ttf",)] * 2
    assert made[0] == made[1]


def test_all_formats_of_one_run_hold_the_same_outlines(out: Path, tmp_path: Path) -> None:
    source = open_font(FONTS / "kouzan-gyosho.otf")
    ufo, otf, ttf = (Ufo.opened(out / "KouzanGyoshoSubset-spline.ufo"), *(
        open_font(out / f"KouzanGyoshoSubset-spline.{name}") for name in ("otf", "ttf")))  # fmt: skip
    drawings = SvgDrawings.opened(out / "svg")
    assert set(ufo.glyph_names) == set(source.select(text=TEXT))
    spec = RunSpec(SPEC.fitting(source.metrics.units_per_em), ("parquet",))
    convert_font(source, source.select(text=TEXT), tmp_path, spec, jobs=0)
    rows = pq.read_table(tmp_path / "KouzanGyoshoSubset-spline.parquet").to_pylist()
    for name in source.select(text="O8B"):
        old = source.outline(name)
        for written in (ufo, otf, ttf, drawings):
            assert 0 < largest_distance(old, written.outline(name)) <= 4.0
            assert written.outline(name).advance == old.advance
        bezier = [
            gs.Contour(np.array(row["bezier_points"]), np.array(row["bezier_degrees"]))
            for row in rows
            if row["glyph"] == name
        ]
        for a, b, c in zip(bezier, drawings.outline(name).contours, ufo.outline(name).contours, strict=True):
            np.testing.assert_allclose(a.rounded(1).points, b.points, atol=1e-9)
            np.testing.assert_allclose(
                with_extrema(a, source.metrics.units_per_em).rounded(1).points, c.points, atol=1e-9
            )


def test_workers_and_interruptions_leave_no_trace(out: Path, tmp_path: Path) -> None:
    source = open_font(FONTS / "kouzan-gyosho.otf")
    other = tmp_path / "other"

    def interrupt(done: int, total: int, failed: int) -> None:
        if done == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        convert_font(source, source.select(text=TEXT), other, SPEC, jobs=0, observer=interrupt)
    assert not list(other.glob("*.otf"))
    convert_font(source, source.select(text=TEXT), other, SPEC, jobs=2)
    assert content(other) == content(out)


def test_a_finished_folder_is_left_and_a_file_that_is_gone_is_written_again(out: Path) -> None:
    source = open_font(FONTS / "kouzan-gyosho.otf")
    before = content(out)
    times = {path: path.stat().st_mtime_ns for path in out.rglob("*.*")}
    assert convert_font(source, source.select(text=TEXT), out, SPEC, jobs=0).remarks == []
    assert {path: path.stat().st_mtime_ns for path in out.rglob("*.*")} == times
    (out / "KouzanGyoshoSubset-spline.ttf").unlink()
    assert convert_font(source, source.select(text=TEXT), out, SPEC, jobs=0).done == 0
    assert content(out) == before


def test_a_stored_result_is_read_back_to_the_last_bit() -> None:
    source = open_font(FONTS / "kouzan-gyosho.otf")
    glyph = gs.convert(source.outline("O"), Options(tolerance=3.0))
    text = to_text(glyph)
    read = from_text(text, gs.GlyphResult)
    assert to_text(read) == text
    assert (read.options, read.outline.name, read.notes) == (glyph.options, "O", glyph.notes)
    for a, b in zip(glyph.contours, read.contours, strict=True):
        assert a.measures == b.measures
        np.testing.assert_array_equal(a.curve.points, b.curve.points)
        np.testing.assert_array_equal(a.interpolations[0].parameters, b.interpolations[0].parameters)
        assert b.interpolations[0].max_error == a.interpolations[0].max_error


@pytest.mark.parametrize("text", ["", "{}", "[1]", '{"kind":"Path"}', '{"array":"object","shape":[1],"data":""}'])
def test_nothing_else_is_made_of_a_stored_result(text: str) -> None:
    with pytest.raises(ValueError, match=r"not a stored result|Expecting value"):
        from_text(text, gs.GlyphResult)


def test_a_stored_result_that_was_changed_is_an_error(out: Path, tmp_path: Path) -> None:
    source = open_font(FONTS / "kouzan-gyosho.otf")
    convert_font(source, source.select(text="O"), tmp_path / "o", RefitSpec(Options(step=90), ("otf",)), jobs=0)
    (file,) = (tmp_path / "o" / "results").iterdir()
    file.write_text(re.sub(r"^.", "x", file.read_text()))
    (tmp_path / "o" / "KouzanGyoshoSubset-spline.otf").unlink()
    with pytest.raises(OutputError, match=r"O\.json"):
        convert_font(source, source.select(text="O"), tmp_path / "o", RefitSpec(Options(step=90), ("otf",)), jobs=0)
    assert json.loads((tmp_path / "o" / "run.json").read_text())["formats"] == ["otf"]


def test_a_font_that_is_written_leaves_room_for_its_rounding() -> None:
    plain, otf, ttf = (RefitSpec(Options(tolerance=2.0), names) for names in (("svg",), ("otf",), ("ttf", "otf")))
    fits = [spec.fitting(1000).tolerance or 0 for spec in (plain, otf, ttf)]
    assert fits[0] == 2.0 > fits[1] > fits[2] == 0.4
    assert RefitSpec(Options(step=9), ("ttf",)).fitting(1000) == Options(step=9).for_em(1000)
