"""Formats by name, ours and a plug-in's; outlines as the font has them; results as JSON."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from fontTools.svgLib.path import parse_path
from fontTools.ttLib import TTFont
from jsonschema import Draft202012Validator
from typer.testing import CliRunner

import glyphspline as gs
from glyphspline import hooks
from glyphspline.cli.app import app
from glyphspline.errors import GlyphsplineError, OptionError
from glyphspline.outlines.outline import FontMetrics
from glyphspline.runs import worker as batch_worker
from glyphspline.runs.convert import convert_font
from glyphspline.runs.folder import entries_of
from glyphspline.runs.spec import RunSpec
from glyphspline.writers.formats import OURS, Format, format_named, format_names, formats
from glyphspline.writers.json_file import json_text
from glyphspline.writers.settings import Appearance, Settings
from tests.places import FONTS, ROOT

TTF, OTF = FONTS / "kouzan-gyosho.ttf", FONTS / "kouzan-gyosho.otf"

runner = CliRunner()


@pytest.fixture(scope="module")
def font() -> gs.Font:
    return gs.open_font(TTF)


@pytest.fixture(scope="module", params=["smooth", "sharp"])
def glyph(request: pytest.FixtureRequest, font: gs.Font) -> gs.GlyphResult:
    return gs.convert(font.outline("uni9F8D"), gs.Options(corners=request.param))


# The registry.


def test_formats_are_found_by_name() -> None:
    assert [format_named(name).name for name in OURS] == list(OURS)
    assert set(OURS) <= set(format_names())
    assert {each.name for each in formats()} == set(format_names())
    with pytest.raises(OptionError, match=r"no format bmp: there are source, svg, .*polyline-csv"):
        format_named("bmp")


def test_every_format_writes_a_result_by_itself(font: gs.Font) -> None:
    glyph = gs.convert(font.outline("O"), gs.Options(step=60))
    for each in OURS.values():
        found = [each.write(glyph, Settings(Appearance(size="20mm"))) for _ in range(2)]
        assert found[0] == found[1]
        assert len(found[0]) > 300


def test_the_run_writes_what_the_format_does(font: gs.Font, tmp_path: Path) -> None:
    shared = ("source", "svg", "png", "json", "polyline", "polyline-csv")
    look = Appearance("ink", "20mm", "red", "blue")
    spec = RunSpec(gs.Options(step=60), shared, Settings(look, flatness=2.0))
    convert_font(font, ["O"], tmp_path, spec, jobs=0)
    glyph = gs.convert(font.outline("O"), gs.Options(step=60))
    settings = Settings(look, flatness=2.0).scaled(font.metrics)
    (entry,) = entries_of(tmp_path)
    assert tuple(entry["files"]) == tuple(name for name in format_names() if name in shared)
    for name, path in entry["files"].items():
        text = format_named(name).write(glyph, settings)
        assert (tmp_path / path).read_bytes() == (text.encode() if isinstance(text, str) else text), name


@pytest.mark.parametrize(
    ("name", "suffix", "extra"),
    [
        ("../x", ".x", None),
        ("X", ".x", None),
        ("x", "x", None),
        ("x", ".x/y", None),
        ("x", ".x", "none"),
        ("", ".x", None),
    ],
)
def test_a_format_has_a_name_and_a_suffix_that_are_safe(name: str, suffix: str, extra: str | None) -> None:
    with pytest.raises(OptionError):
        Format(name, suffix, lambda result, settings: "", extra)


@pytest.mark.parametrize(
    "wrong", [{"flatness": 0.0}, {"flatness": float("nan")}, {"flatness": -1}, {"dxf": "line"}, {"scale": 0.0}]
)
def test_settings_are_checked(wrong: dict[str, Any]) -> None:
    with pytest.raises(OptionError):
        Settings(**wrong)


def test_a_size_is_the_height_from_descender_to_ascender() -> None:
    settings = Settings(Appearance(size="20mm")).scaled(FontMetrics(1000, 750, -250))
    assert (settings.scale, settings.unit) == (0.02, "mm")
    assert Settings(Appearance(size="1in")).scaled(FontMetrics(1000, 0, 0)).scale == 1 / 1000
    plain = Settings().scaled(FontMetrics())
    assert (plain.scale, plain.unit) == (1, None)


def test_a_missing_extra_is_said_before_the_run_starts(font: gs.Font, tmp_path: Path, monkeypatch: Any) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    monkeypatch.setitem(OURS, "needy", Format("needy", ".x", lambda result, settings: "x", "parquet"))
    with pytest.raises(GlyphsplineError, match=r"glyphspline\[parquet\]"):
        convert_font(font, ["O"], tmp_path / "out", RunSpec(formats=("needy",)), jobs=0)
    assert not (tmp_path / "out").exists()


# Plug-ins.

PLUG_IN = """
from glyphspline.hooks import Plugin
from glyphspline.writers.formats import Format

def write(result, settings):
    return f"{result.outline.name} {len(result.contours)} {settings.scale:.6f} {settings.unit}\\n"

count = Format("count", ".count.txt", write)
svg = Format("svg", ".txt", write)
bare = Format("bare", ".txt", lambda result, settings: str(len(result.arrays.arcs)), fitted=False)
names = ["count", "svg", "bare"]
places = {name: f"counting:{name}" for name in names}
PLUGIN = Plugin(formats={**places, "broken": "counting:missing", "other": "counting:count"})
"""

METADATA = "Metadata-Version: 2.1\nName: counting\nVersion: 1.0\n"

ENTRIES = """[glyphspline.plugins]
counting = counting:PLUGIN
"""


@pytest.fixture(scope="module")
def plug_in(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """The environment of a process for which a package with formats is installed."""
    folder = tmp_path_factory.mktemp("site")
    (folder / "counting.py").write_text(PLUG_IN)
    facts = folder / "counting-1.0.dist-info"
    facts.mkdir()
    (facts / "METADATA").write_text(METADATA)
    (facts / "entry_points.txt").write_text(ENTRIES)
    return {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), str(folder)])}


def convert(environment: dict[str, str], out: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "glyphspline", "convert", str(TTF), "--out", str(out), *arguments]
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=False)


@pytest.mark.parametrize("jobs", [pytest.param("0", marks=pytest.mark.long), "2"])
def test_an_installed_plug_in_writes_files(plug_in: dict[str, str], tmp_path: Path, jobs: str) -> None:
    call = ["--text", "龍O", "--step", "60", "--size", "2cm", "--format", "svg,count", "--jobs", jobs]
    done = convert(plug_in, tmp_path, *call)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "count" / "O.count.txt").read_text() == f"O 2 {2 / 1024:.6f} cm\n"
    assert (tmp_path / "svg" / "O.svg").read_text().startswith("<svg ")  # ours, and not the plug-in's
    files = [entry["files"] for entry in entries_of(tmp_path)]
    assert files[0] == {"svg": "svg/O.svg", "count": "count/O.count.txt"}
    run = json.loads((tmp_path / "run.json").read_text())
    assert run["formats"] == ["svg", "count"]
    assert "--format svg,count" in run["command"]
    before = (tmp_path / "count" / "O.count.txt").stat().st_mtime_ns
    (tmp_path / "count" / "uni9F8D.count.txt").unlink()
    assert convert(plug_in, tmp_path, *call).returncode == 0  # goes on: one file is missing
    assert (tmp_path / "count" / "uni9F8D.count.txt").exists()
    assert (tmp_path / "count" / "O.count.txt").stat().st_mtime_ns == before
    assert convert(plug_in, tmp_path, "--text", "O", "--format", "svg", "--restart").returncode == 0
    assert list((tmp_path / "count").iterdir()) == []


def test_a_plug_in_that_shows_outlines_as_they_are_fits_nothing(plug_in: dict[str, str], tmp_path: Path) -> None:
    assert convert(plug_in, tmp_path, "--text", "O", "--format", "bare", "--jobs", "0").returncode == 0
    assert (tmp_path / "bare" / "O.txt").read_text() == "0"


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("broken", "the plug-in counting cannot be loaded: module 'counting' has no attribute 'missing'"),
        ("other", "the plug-in for format 'other' has Format(name='count'"),
        ("counting", "no format counting: there are source, svg, "),
    ],
)
def test_a_plug_in_that_does_not_load_is_named(plug_in: dict[str, str], tmp_path: Path, name: str, words: str) -> None:
    done = convert(plug_in, tmp_path / "out", "--text", "O", "--format", f"svg,{name}")
    assert done.returncode == 2
    assert words in done.stderr
    if name == "counting":
        assert "json, bare, broken, count, dxf, other, polyline, polyline-csv, gallery, otf" in done.stderr


def test_our_formats_are_found_without_scanning_packages(font: gs.Font, tmp_path: Path, monkeypatch: Any) -> None:
    def scanned(group: str = "") -> tuple[()]:
        assert group != hooks.GROUP
        return ()  # Numba looks for extensions of its own

    hooks.plugins.cache_clear()
    hooks.entries.cache_clear()
    monkeypatch.setattr("importlib.metadata.entry_points", scanned)
    convert_font(font, ["O"], tmp_path, RunSpec(gs.Options(step=90), ("svg", "gallery", "json")), jobs=0)
    convert_font(font, ["O"], tmp_path, RunSpec(gs.Options(step=90), ("svg", "json")), jobs=0, restart=True)


# The outline as it is.


def test_source_fits_nothing(font: gs.Font, tmp_path: Path, monkeypatch: Any) -> None:
    def fitted(*_: Any, **__: Any) -> Any:
        raise AssertionError

    monkeypatch.setattr(batch_worker, "convert_many", fitted)
    summary = convert_font(font, font.glyph_names, tmp_path, RunSpec(formats=("source",)), jobs=0)
    assert not summary.failed
    for entry in entries_of(tmp_path):
        assert entry["contours"] is None
        assert entry["deviation"] is None
        assert list(entry["files"]) == (["source"] if entry["status"] == "ok" else [])


@pytest.mark.parametrize("path", [TTF, OTF])
def test_source_is_what_the_font_draws(path: Path, tmp_path: Path) -> None:
    """Another reader of the font, fontTools, and another of the drawing see the same points."""
    source = gs.open_font(path)
    convert_font(source, source.glyph_names, tmp_path, RunSpec(formats=("source",)), jobs=0)
    glyphs = TTFont(path).getGlyphSet()
    seen = set()
    for entry in entries_of(tmp_path):
        if entry["status"] == "ok":
            root = ElementTree.parse(tmp_path / entry["files"]["source"]).getroot()
            data = next(root.iter("{http://www.w3.org/2000/svg}path")).attrib["d"]
            found, expected = Segments(), Segments()
            parse_path(data, found)
            glyphs[entry["glyph"]].draw(expected)
            assert len(found.segments) == len(expected.segments)
            for a, b in zip(found.segments, expected.segments, strict=True):
                np.testing.assert_allclose(np.array(a) * (1, -1), b, atol=1e-9)
            seen |= set(re.findall("[QqCc]", data))
    assert seen <= ({"q", "Q"} if path == TTF else {"c", "C"})
    assert seen


class Segments:
    """Segments of contours, each as its points; a pen."""

    def __init__(self) -> None:
        from fontTools.pens.recordingPen import DecomposingRecordingPen

        self._pen = DecomposingRecordingPen(None)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._pen, name)

    @property
    def segments(self) -> list[list[tuple[float, float]]]:
        from fontTools.pens.basePen import decomposeQuadraticSegment

        found: list[list[tuple[float, float]]] = []
        start = at = (0.0, 0.0)
        for operation, points in self._pen.value:
            if operation == "moveTo":
                start = at = points[0]
                continue
            if operation == "qCurveTo":
                parts = decomposeQuadraticSegment(points) if points[-1] is not None else []
            else:
                parts = [points] if points else [(start,)]
            for part in parts:
                if len(part) > 1 or tuple(part[0]) != tuple(at):
                    found.append([at, *part])
                at = part[-1]
        return found


def test_source_with_a_gallery_has_no_polygon(font: gs.Font, tmp_path: Path) -> None:
    options = gs.Options(step=60)
    convert_font(font, ["O"], tmp_path / "with", RunSpec(options, ("source", "gallery")), jobs=0)
    convert_font(font, ["O"], tmp_path / "alone", RunSpec(options, ("source",)), jobs=0)
    drawings = [(tmp_path / which / "source" / "O.svg").read_bytes() for which in ("with", "alone")]
    assert drawings[0] == drawings[1]
    assert b'class="polygon"' in (tmp_path / "with" / "polygon" / "O.svg").read_bytes()


def test_source_looks_as_drawings_do(font: gs.Font, tmp_path: Path) -> None:
    call = ["convert", str(TTF), "--text", "龍", "--out", str(tmp_path), "--format", "source", "--jobs", "0"]
    look = ["--view-box", "ink", "--size", "1024mm", "--fill", "none", "--stroke", "red", "--names", "char"]
    result = runner.invoke(app, [*call, *look])
    assert result.exit_code == 0, result.output
    assert "corners" not in result.stderr
    svg = (tmp_path / "source" / "龍.svg").read_text()
    assert re.search(r'viewBox="\d+ -\d+ (\d+) (\d+)" width="\1mm" height="\2mm"', svg), "a unit is a millimetre"
    assert 'fill="none" stroke="red"' in svg


def test_source_with_overlaps_removed(tmp_path: Path) -> None:
    pytest.importorskip("pathops")
    source = gs.open_font(FONTS / "edge-cases.ttf")
    spec = RunSpec(gs.Options(remove_overlaps=True), ("source",))
    assert not convert_font(source, source.glyph_names, tmp_path, spec, jobs=0).failed


# JSON.


@pytest.fixture(scope="module")
def schema() -> Draft202012Validator:
    data = json.loads((ROOT / "glyphspline" / "writers" / "glyph.schema.json").read_text(encoding="utf-8"))
    Draft202012Validator.check_schema(data)
    return Draft202012Validator(data)


def strict(text: str) -> Any:
    def refuse(constant: str) -> Any:
        raise AssertionError(constant)

    return json.loads(text, parse_constant=refuse)


def test_json_is_by_the_schema_and_splines_come_back_exactly(
    glyph: gs.GlyphResult, schema: Draft202012Validator
) -> None:
    data = strict(gs.to_json(glyph))
    schema.validate(data)
    assert len(data["contours"]) == len(glyph.contours)
    for read, contour in zip(data["contours"], glyph.contours, strict=True):
        written = [read["spline"], *read["splines"]]
        for spline, own in zip(written, [contour.spline, *(arc.spline for arc in contour.interpolations)], strict=True):
            again = gs.Spline(**{**spline, "control_points": np.array(spline["control_points"])})
            assert own is not None
            assert (again.control_points == own.control_points).all()
            assert (again.knots == own.knots).all()
            assert (again.degree, again.closed) == (own.degree, own.closed)
        for name in ("beziers", "source"):
            curve = contour.curve if name == "beziers" else contour.source
            for a, b in zip(read[name], curve.segments(), strict=True):
                assert (np.array(a) == b).all()
        assert read["measures"]["deviation_bound"] == contour.measures.deviation_bound
        assert set(read["measures"]) == set(gs.Measures.__dataclass_fields__)


def test_the_schema_refuses_what_is_not_there(font: gs.Font, schema: Draft202012Validator) -> None:
    data = strict(gs.to_json(gs.convert(font.outline("O"), gs.Options(step=60))))
    data["contours"][0]["splines"][0]["knots"][0] = None
    assert not schema.is_valid(data)


def test_what_is_not_a_number_is_null(font: gs.Font, schema: Draft202012Validator) -> None:
    glyph = gs.convert(font.outline("O"), gs.Options(step=60))
    (first, *_) = glyph.contours
    odd = gs.Measures(1, 1, 1, max_curvature=float("inf"), residual=float("nan"), fallbacks=np.int64(3))  # type: ignore[arg-type]
    contour = gs.ContourResult(first.source, first.polygon, first.interpolations, first.curve, odd)
    data = strict(gs.to_json(gs.GlyphResult(glyph.outline, glyph.options, (contour,))))
    schema.validate(data)
    measures = data["contours"][0]["measures"]
    assert (measures["max_curvature"], measures["residual"], measures["fallbacks"]) == (None, None, 3)


def test_sizes_scale_coordinates_and_not_knots(font: gs.Font, schema: Draft202012Validator) -> None:
    glyph = gs.convert(font.outline("O"), gs.Options(step=60))
    plain, scaled = (strict(json_text(glyph, Settings(scale=s, unit=u))) for s, u in ((1.0, None), (0.5, "mm")))
    schema.validate(scaled)
    assert (scaled["unit"], scaled["scale"], scaled["advance"]) == ("mm", 0.5, plain["advance"] / 2)
    a, b = (each["contours"][0] for each in (plain, scaled))
    assert a["splines"][0]["knots"] == b["splines"][0]["knots"]
    assert a["measures"] == b["measures"]
    for name in ("points", "beziers", "source"):
        for whole, half in zip(a[name], b[name], strict=True):
            np.testing.assert_array_equal(np.array(whole) / 2, half)
