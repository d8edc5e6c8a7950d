"""``glyphspline text``: what is written where, sizes and lengths, what is missing, and what is refused."""

from __future__ import annotations

import io
import json
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from svgpathtools import parse_path
from typer.testing import CliRunner, Result

import glyphspline as gs
from glyphspline.cli.app import app
from glyphspline.plugins.text.command import BY_SUFFIX
from glyphspline.types import FloatArray
from tests.places import DEJAVU, FONTS

BRUSH = FONTS / "kouzan-gyosho.ttf"
EM = 1024
SVG = "{http://www.w3.org/2000/svg}"

runner = CliRunner()


def text(*arguments: str | Path, stdin: str | None = None) -> Result:
    return runner.invoke(app, ["text", str(BRUSH), *map(str, arguments)], input=stdin)


def root_of(result: Result) -> Any:
    assert result.exit_code == 0, result.output
    return ElementTree.fromstring(result.stdout)


def box_of(root: Any) -> list[float]:
    return [float(word) for word in root.attrib["viewBox"].split()]


def test_a_text_is_one_path_of_all_its_glyphs() -> None:
    font = gs.open_font(BRUSH)
    root = root_of(text("Ag", "-o", "-", "--format", "svg", "--step", "40"))
    (path,) = root.iter(f"{SVG}path")
    options = gs.Options(step=40)
    one, two = (gs.convert(font.outline(name), options) for name in ("A", "g"))
    assert path.attrib["d"].count("M") == len(one.contours) + len(two.contours)
    advances = one.outline.advance + two.outline.advance
    assert box_of(root)[2] == pytest.approx(advances, abs=1)


def test_each_glyph_is_an_element_that_says_what_it_stands_for() -> None:
    root = root_of(text("gAg\nA", "-o", "-", "--format", "svg", "--each-glyph"))
    uses = list(root.iter(f"{SVG}use"))
    assert [use.attrib["data-cluster"] for use in uses] == ["0", "1", "2", "4"]
    assert [use.attrib["data-glyph"] for use in uses] == ["g", "A", "g", "A"]
    paths = {path.attrib["id"] for path in root.iter(f"{SVG}path")}
    assert len(paths) == 2
    assert {use.attrib["href"].removeprefix("#") for use in uses} == paths
    assert root.attrib["aria-label"] == "gAg A"  # XML reads a line break in an attribute as a space
    lines = [group for group in root.iter(f"{SVG}g") if group.get("class") == "line"]
    assert [len(line) for line in lines] == [3, 1]
    assert float(lines[1][0].attrib["y"]) > float(lines[0][0].attrib["y"])


def test_one_path_and_elements_draw_the_same() -> None:
    font = gs.open_font(BRUSH)
    layout = gs.layout(font, "Ag龍A", width=3 * EM)
    whole = layout.convert(gs.Options(step=60))
    results = layout.results(gs.Options(step=60))
    at = 0
    for k, which in enumerate(layout.which.tolist()):
        for contour in results[which].contours:
            np.testing.assert_allclose(whole.contours[at].curve.points, contour.curve.points + layout.origin[k])
            at += 1
    assert at == len(whole.contours) > 4


def test_suffixes_say_formats(tmp_path: Path) -> None:
    files = [tmp_path / "new" / f"word{suffix}" for suffix in BY_SUFFIX]
    result = text("g", "--count", "30", *[word for file in files for word in ("-o", str(file))])
    assert result.exit_code == 0, result.output
    assert all(file.stat().st_size for file in files)
    assert json.loads((tmp_path / "new" / "word.json").read_text(encoding="utf-8"))


@pytest.mark.parametrize("form", ["curvature", "source", "polyline"])
def test_other_formats_are_asked_for_by_name(form: str, tmp_path: Path) -> None:
    result = text("gA", "-o", tmp_path / "word.file", "--format", form)
    assert result.exit_code == 0, result.output
    assert (tmp_path / "word.file").stat().st_size


def test_source_is_the_outline_and_nothing_is_fitted() -> None:
    outline = gs.open_font(BRUSH).outline("g")
    root = root_of(text("g", "-o", "-", "--format", "source"))
    (path,) = root.iter(f"{SVG}path")
    assert path.attrib["d"] == gs.to_svg(as_result(outline)).split(' d="')[1].split('"')[0]
    for form in ("svg", "source"):
        root_of(text("g", "-o", "-", "--format", form, "--each-glyph"))


def as_result(outline: gs.Outline) -> gs.GlyphResult:
    from glyphspline.fitting.results import as_glyph

    return as_glyph(outline)


def test_size_is_that_of_an_em() -> None:
    root = root_of(text("gA", "-o", "-", "--format", "svg", "--size", "12pt"))
    _, _, width, height = box_of(root)
    said = [float(root.attrib[name].removesuffix("pt")) for name in ("width", "height")]
    assert said == pytest.approx([width * 12 / EM, height * 12 / EM], abs=1e-3)


def ink(file: Path) -> FloatArray:
    """(n, 2) points on the curves of a written SVG or DXF, in millimetres, y up."""
    if file.suffix == ".dxf":
        entities = pytest.importorskip("ezdxf").readfile(file).modelspace()
        found = [
            [entity.dxf.start, entity.dxf.end]
            if entity.dxftype() == "LINE"
            else list(entity.construction_tool().approximate(2000))
            for entity in entities
        ]
        return np.concatenate([np.array([list(point)[:2] for point in own]) for own in found])
    root = ElementTree.fromstring(file.read_text(encoding="utf-8"))
    scale = float(root.attrib["width"].removesuffix("mm")) / box_of(root)[2]
    segments = [segment for path in root.iter(f"{SVG}path") for segment in parse_path(path.attrib["d"])]
    points = np.concatenate([[segment.point(t) for t in np.linspace(0, 1, 65)] for segment in segments])
    return np.stack([points.real, -points.imag], axis=1) * scale


def measured(folder: Path, *arguments: str) -> list[FloatArray]:
    """The ink of a text of DejaVu Sans with sharp corners, as written in SVG and in DXF."""
    files = [folder / f"sign{suffix}" for suffix in (".svg", ".dxf")]
    outs = [word for file in files for word in ("-o", str(file))]
    result = runner.invoke(app, ["text", str(DEJAVU), *arguments, "--corners", "sharp", *outs])
    assert result.exit_code in (0, 1), result.output
    return [ink(file) for file in files]


def test_sizes_are_those_of_what_is_written(tmp_path: Path) -> None:
    for points in measured(tmp_path, "HE", "--cap-height", "50mm"):
        assert np.ptp(points[:, 1]) == pytest.approx(50, rel=1e-3)
    for points in measured(tmp_path, "xz", "--x-height", "20mm"):
        assert np.ptp(points[:, 1]) == pytest.approx(20, rel=1e-3)
    for words, more in (("oSo", ()), ("fire\nexit", ("--letter-spacing", "0.2em")), ("i", ())):
        for points in measured(tmp_path, words, "--fit-width", "300mm", *more):
            assert np.ptp(points[:, 0]) == pytest.approx(300, rel=1e-3)


def test_the_title_is_the_text(tmp_path: Path) -> None:
    for form, title in (("svg", "A & g"), ("source", "A & g"), ("curvature", "Curvature of A & g")):
        root = root_of(text("A & g", "-o", "-", "--format", form))
        assert root.attrib["aria-label"] == title


def test_a_map_of_a_text_shows_what_is_asked_for(tmp_path: Path) -> None:
    root = root_of(text("gO", "-o", "-", "--format", "curvature", "--comb", "both"))
    assert "source-comb" in [path.get("class") for path in root.iter(f"{SVG}path")]
    root = root_of(text("gO", "-o", "-", "--format", "curvature", "--comb", "source"))
    assert next(path for path in root if path.get("class") == "source").attrib["d"]
    files = [tmp_path / f"{comb}.png" for comb in ("result", "both")]
    for file in files:
        assert text("g", "-o", file, "--format", "curvature-png", "--comb", file.stem).exit_code == 0
    assert files[0].read_bytes() != files[1].read_bytes()


def test_a_line_is_as_wide_as_asked_for() -> None:
    look = ("-o", "-", "--format", "svg", "--fill", "none", "--stroke", "red")
    for width, units in (("0.5mm", 0.05 * EM), ("0.02em", 0.02 * EM), ("7", 7)):
        root = root_of(text("A", *look, "--size", "10mm", "--stroke-width", width))
        assert float(next(root.iter(f"{SVG}path")).attrib["stroke-width"]) == pytest.approx(units, abs=1e-3)


def test_lengths_are_font_units_ems_or_of_paper() -> None:
    def lines(*arguments: str) -> int:
        root = root_of(text("AgAg AgAg AgAg", "-o", "-", "--format", "svg", "--each-glyph", *arguments))
        return sum(group.get("class") == "line" for group in root.iter(f"{SVG}g"))

    assert lines() == 1
    assert lines("--width", "3em") == lines("--width", str(3 * EM)) == lines("--width", "3in", "--size", "1in") == 3


def test_the_text_comes_from_a_file_or_standard_input(tmp_path: Path) -> None:
    file = tmp_path / "words.txt"
    file.write_text("\ufeffgA\n", encoding="utf-8")
    arguments = ("-o", "-", "--format", "svg")
    plain = text("gA", *arguments).stdout
    assert text("--text-file", file, *arguments).stdout.replace('"gA\n"', '"gA"') == plain
    assert text("-", *arguments, stdin="gA").stdout == plain


def test_a_fallback_font_stands_in() -> None:
    variable = FONTS / "variable.ttf"
    arguments = ["text", str(variable), "o龍", "-o", "-", "--format", "svg", "--each-glyph"]
    alone = runner.invoke(app, arguments)
    assert alone.exit_code == 1
    assert "no glyph for 龍 (U+9F8D): .notdef stands there" in alone.stderr
    together = runner.invoke(app, [*arguments, "--fallback-font", str(BRUSH)])
    assert together.exit_code == 0, together.output
    assert 'data-glyph="uni9F8D"' in together.stdout


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("A", "-o", "a.xyz"), "its suffix says no format"),
        (("A", "-o", "a.svg", "--format", "nonsense"), "nonsense"),
        (("A", "-o", "a.svg", "-o", "b.svg", "--format", "svg"), "--format is for one --out"),
        (("-o", "a.svg"), "give a text, or --text-file"),
        (("", "-o", "a.svg"), "at least one character"),
        (("A", "-o", "a.svg", "--features", "zzzz"), "no feature 'zzzz'"),
        (("A", "-o", "a.svg", "--script", "Nope"), "ISO 15924"),
        (("A", "-o", "a.svg", "--size", "12"), "--size is a length"),
        (("A", "-o", "a.svg", "--width", "nan"), "--width is a length"),
        (("A", "-o", "a.svg", "--width", "-3em"), "width is a positive length"),
        (("A", "-o", "a.svg", "--width", "80mm"), "needs --size"),
        (("A", "-o", "a.svg", "--size", "9mm", "--fit-width", "9mm"), "give one of --size, --cap-height"),
        (("A", "-o", "a.svg", "--cap-height", "9mm", "--x-height", "9mm"), "not --cap-height and --x-height"),
        (("A", "-o", "a.svg", "--cap-height", "9mm"), "no H to measure"),
        (("A", "-o", "a.svg", "--cap-height", "9"), "--cap-height is a length"),
        ((" ", "-o", "a.svg", "--fit-width", "9mm"), "no ink"),
        (("A", "-o", "a.svg", "--stroke-width", "0.1mm"), "--stroke-width is of a line"),
        (("A", "-o", "a.svg", "--stroke", "red", "--stroke-width", "0.1mm"), "there is none"),
        (("A", "-o", "a.svg", "--stroke", "red", "--stroke-width", "thin"), "--stroke-width is font units"),
    ],
)
def test_what_is_wrong_is_said_and_nothing_is_written(
    arguments: tuple[str, ...], said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    result = text(*arguments)
    assert result.exit_code == 2
    assert said in result.stderr
    assert not [*tmp_path.iterdir()]


def test_a_text_of_spaces_is_an_empty_drawing() -> None:
    root = root_of(text(" ", "-o", "-", "--format", "svg"))
    assert next(root.iter(f"{SVG}path")).attrib["d"] == ""


def test_binary_drawings_go_to_standard_output_whole() -> None:
    result = text("g", "-o", "-", "--format", "png", "--count", "20")
    assert result.exit_code == 0
    assert io.BytesIO(result.stdout_bytes).read(8) == b"\x89PNG\r\n\x1a\n"


def test_letters_that_join_are_named_once_if_they_come_apart(tmp_path: Path) -> None:
    for words, spacing, said in (("سلام سلام", "0.1em", "Arabic"), ("سلام", "0", ""), ("abc", "0.1em", "")):
        result = runner.invoke(
            app, ["text", str(DEJAVU), words, "--letter-spacing", spacing, "--out", str(tmp_path / "t.svg")]
        )
        assert result.exit_code == 0
        assert (result.stderr.count("join"), said in result.stderr) == (bool(said), True)
