"""Drawings on paper: their size and colours, in SVG, PNG and PDF."""

from __future__ import annotations

import io
import re
import xml.etree.ElementTree as ElementTree
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.image import imread
from typer.testing import CliRunner

import glyphspline as gs
from glyphspline.cli.app import app
from glyphspline.runs.convert import convert_font
from glyphspline.runs.spec import RunSpec
from glyphspline.types import FloatArray
from glyphspline.writers.figures.drawings import write_drawing
from glyphspline.writers.settings import Appearance, Maps, Settings
from tests.drawings import circle, result
from tests.places import GYOSHO as FONT

DISC = gs.Contour.from_segments(list(circle(200, 8, centre=(300, 300))))


def root_of(svg: str) -> Any:
    return ElementTree.fromstring(svg)


def pixels(look: Appearance) -> FloatArray:
    return np.asarray(imread(io.BytesIO(write_drawing(result(DISC), Settings(look), "png"))))[..., :3]


def media_box(pdf: bytes) -> list[float]:
    found = re.search(rb"/MediaBox \[([^]]*)\]", pdf)
    assert found
    return [float(word) for word in found[1].split()]


def test_a_size_is_the_height_and_the_width_is_in_proportion() -> None:
    root = root_of(gs.to_svg(result(DISC), size="20mm"))
    _, _, width, height = map(float, root.attrib["viewBox"].split())
    assert (width, height) == (600, 1000)
    assert (root.attrib["width"], root.attrib["height"]) == ("12mm", "20mm")
    assert "width" not in root_of(gs.to_svg(result(DISC))).attrib
    pdf = write_drawing(result(DISC), Settings(Appearance(size="20mm")), "pdf")
    assert media_box(pdf) == pytest.approx([0, 0, 12 / 25.4 * 72, 20 / 25.4 * 72], abs=0.01)
    assert pixels(Appearance(size="400px")).shape[:2] == (400, 240)
    assert max(pixels(Appearance(size="5000mm")).shape) <= 8000
    assert pixels(Appearance(size="1px")).shape[:2] == (1, 1)


def test_the_size_of_an_em_does_not_depend_on_the_region_shown() -> None:
    for view_box in ("em", "ink"):
        root = root_of(gs.to_svg(result(DISC), view_box=view_box, em="12pt"))
        _, _, width, height = map(float, root.attrib["viewBox"].split())
        lengths = [float(root.attrib[name].removesuffix("pt")) for name in ("width", "height")]
        assert lengths == pytest.approx([width * 12 / 1000, height * 12 / 1000], abs=1e-4)
    assert media_box(write_drawing(result(DISC), Settings(Appearance(em="1in")), "pdf")) == pytest.approx(
        [0, 0, 43.2, 72]
    )
    with pytest.raises(gs.OptionError, match="exclude each other"):
        gs.to_svg(result(DISC), size="20mm", em="12pt")
    with pytest.raises(gs.OptionError, match="em is a length"):
        gs.to_svg(result(DISC), em="12")


def test_colours_are_those_asked_for() -> None:
    path = root_of(gs.to_svg(result(DISC), fill="none", stroke="#f00"))[-1]
    assert (path.attrib["fill"], path.attrib["stroke"], path.attrib["stroke-width"]) == ("none", "#f00", "1")
    plain = root_of(gs.to_svg(result(DISC)))[-1]
    assert plain.attrib["fill"] == "currentColor"
    assert "stroke" not in plain.attrib
    pdf = write_drawing(result(DISC), Settings(Appearance(fill="none", stroke="#f00")), "pdf")
    (content,) = (zlib.decompress(part) for part in re.findall(rb"stream\n(.*?)\nendstream", pdf, re.DOTALL)[:1])
    assert b"1 0 0 RG" in content


def test_a_png_is_the_glyph_as_drawn() -> None:
    drawn = pixels(Appearance("ink", size="200px", fill="navy"))
    assert drawn.shape[:2] == (200, 200)
    np.testing.assert_allclose(drawn[100, 100], [0, 0, 128 / 255], atol=0.01)
    np.testing.assert_allclose(drawn[4, 4], 1)
    assert (drawn < 0.99).any(axis=2).mean() == pytest.approx(np.pi / 4, abs=0.02)
    assert (np.ptp(drawn.reshape(-1, 3), axis=0) > 0.4).all(), "no comb, no legend: ink and paper"
    assert write_drawing(result(DISC), Settings(), "pdf") == write_drawing(result(DISC), Settings(), "pdf")


@pytest.mark.parametrize(
    "wrong",
    [
        {"size": "20"}, {"size": "0mm"}, {"size": "-3mm"}, {"size": "6000mm"}, {"size": "3em"}, {"size": 20},
        {"fill": "#ff"}, {"fill": "blu"}, {"stroke": "red\"/><script>"}, {"stroke": "url(#a)"}, {"fill": None},
        {"size": "9" * 99 + "mm"},
    ],
    ids=str,
)  # fmt: skip
def test_what_is_no_size_or_colour_is_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(gs.OptionError, match=f"{next(iter(wrong))} is a"):
        gs.to_svg(result(DISC), **wrong)


def test_a_height_is_of_the_drawing(tmp_path: Path) -> None:
    spec = RunSpec(gs.Options(count=24), ("svg", "pdf"), Settings(Appearance(size="20mm")))
    convert_font(gs.open_font(FONT), ["O"], tmp_path, spec, jobs=0)
    assert root_of((tmp_path / "svg" / "O.svg").read_text(encoding="utf-8")).attrib["height"] == "20mm"
    assert media_box((tmp_path / "pdf" / "O.pdf").read_bytes())[3] == pytest.approx(20 / 25.4 * 72, abs=0.01)
    with pytest.raises(gs.OptionError, match="size and em exclude each other"):
        Appearance(size="20mm", em="20mm")


def test_from_the_shell(tmp_path: Path) -> None:
    given = [
        "--size",
        "20mm",
        "--fill",
        "none",
        "--stroke",
        "red",
        "--format",
        "svg,png,pdf,curvature-png,curvature-pdf",
    ]
    call = ["convert", str(FONT), "--text", "O", "--count", "24", "--jobs", "0", "--out", str(tmp_path), "--quiet"]
    run = CliRunner().invoke(app, [*call, *given])
    assert run.exit_code == 0, run.output
    files = {path.parent.name: path.read_bytes() for path in tmp_path.rglob("O.*")}
    assert set(files) == {"svg", "png", "pdf", "curvature-png", "curvature-pdf"}
    root = root_of(files["svg"].decode())
    ascent = float(root.attrib["viewBox"].split()[3])
    height = float(root.attrib["height"].removesuffix("mm"))
    assert height == pytest.approx(20 * ascent / 1024), "the size is an em's"
    assert root[-1].attrib["stroke"] == "red"
    assert media_box(files["pdf"])[3] == pytest.approx(height / 25.4 * 72, abs=0.01)
    assert media_box(files["curvature-pdf"])[3] == 432, "the map has its own size"
    assert "curvature of the" not in files["svg"].decode()
    comb = ["--format", "curvature", "--comb", "source", "--restart"]
    run = CliRunner().invoke(app, [*call, *comb])
    assert run.exit_code == 0, run.output
    assert "κ of the source" in (tmp_path / "curvature" / "O.svg").read_text(encoding="utf-8")
    assert '"comb": "source"' in (tmp_path / "run.json").read_text(encoding="utf-8")
    spec = RunSpec(gs.Options(step=60), ("curvature",), maps=Maps("both", comb_scale=12.5))
    convert_font(gs.open_font(FONT), ["O"], tmp_path / "scaled", spec, jobs=0)
    drawn = root_of((tmp_path / "scaled" / "curvature" / "O.svg").read_text(encoding="utf-8"))
    assert float(drawn.attrib["data-scale"]) == pytest.approx(12.5 / 1024, rel=1e-4)
    assert "source-comb" in [path.get("class") for path in drawn.iter()]
    refused = CliRunner().invoke(app, [*call, "--fill", "blu", "--restart"])
    assert refused.exit_code == 2
    assert "fill is a colour" in refused.output
