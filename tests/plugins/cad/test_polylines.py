"""Polylines: within their bound of the curves, the same in JSON, by its schema, and in CSV; flatness is of a run."""

from __future__ import annotations

import csv
import json
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from jsonschema import Draft202012Validator

import glyphspline as gs
from glyphspline.curves.bezier import evaluate
from glyphspline.errors import OptionError, OutputError
from glyphspline.outlines.outline import Contour, Contours, Outline
from glyphspline.outlines.polygons import flattened
from glyphspline.plugins.cad.polyline_files import polyline_csv, polyline_json
from glyphspline.runs.convert import convert_font
from glyphspline.runs.spec import RunSpec
from glyphspline.types import FloatArray
from glyphspline.writers.settings import Appearance, Settings
from tests.places import FONTS, ROOT

SCHEMA = ROOT / "glyphspline" / "plugins" / "cad" / "polyline.schema.json"


@pytest.fixture(scope="module")
def font() -> gs.Font:
    return gs.open_font(FONTS / "kouzan-gyosho.ttf")


@pytest.fixture(scope="module", params=["smooth", "sharp"])
def glyph(request: pytest.FixtureRequest, font: gs.Font) -> gs.GlyphResult:
    return gs.convert(font.outline("uni9F8D"), gs.Options(corners=request.param))


@pytest.mark.parametrize("flatness", [20.0, 0.5, 0.01])
def test_the_bound_of_polygons_holds(glyph: gs.GlyphResult, flatness: float) -> None:
    """Dense samples of each piece are within the bound of its chords, and the bound is not idle."""
    found = gs.to_polylines(glyph, flatness)
    assert found.bound <= flatness
    worst = 0.0
    for polygon, contour in zip(found.polygons, glyph.contours, strict=True):
        samples = evaluate(
            np.repeat(contour.curve.cubics(), 60, axis=0), np.tile(np.arange(60) / 60, len(contour.curve))
        )
        worst = max(worst, float(distances(samples, polygon).max()))
    assert worst <= found.bound
    assert worst > found.bound / 20


def distances(points: FloatArray, polygon: FloatArray) -> FloatArray:
    """Distance of each point (k, 2) from the sides of a polygon."""
    a, sides = polygon, np.roll(polygon, -1, axis=0) - polygon
    lengths = np.maximum((sides**2).sum(axis=1), 1e-30)
    found = []
    for part in np.array_split(points, 1 + len(points) // 200):
        along = np.clip(((part[:, None] - a) * sides).sum(axis=2) / lengths, 0, 1)
        found.append(np.hypot(*np.moveaxis(part[:, None] - a - along[..., None] * sides, 2, 0)).min(axis=1))
    return np.concatenate(found)


def test_the_bound_is_reached_by_a_parabola() -> None:
    """A quadratic in one chord is exactly a quarter of its second difference away."""
    hump = Contour(np.array([[0.0, 0.0], [50.0, 40.0], [100.0, 0.0], [50.0, -10.0]]), np.array([2, 1, 1]))
    lines, bound = flattened(Contours([hump]).arrays, 20.0 + 1e-9)
    assert len(lines.points) == 3
    assert bound == pytest.approx(20.0, rel=1e-9)
    assert len(flattened(Contours([hump]).arrays, 19.9)[0].points) == 4


def test_lines_stay_as_they_are() -> None:
    square = Contour(np.array([[0.0, 0.0], [90.0, 0.0], [90.0, 90.0], [0.0, 90.0]]), np.ones(4, dtype=np.int64))
    found = gs.to_polylines(Outline("square", contours=(square, square)))
    assert found.bound == 0.0
    assert [polygon.tolist() for polygon in found.polygons] == [square.points.tolist()] * 2
    assert gs.to_polylines(Outline("space")).polygons == ()


@pytest.mark.parametrize("flatness", [0.0, -1.0, float("nan"), float("inf"), 1e-15, 1e-300, "x"])
def test_a_flatness_that_cannot_be_is_refused(font: gs.Font, flatness: Any) -> None:
    with pytest.raises(OptionError, match="flatness"):
        gs.to_polylines(font.outline("O"), flatness)


def test_files_of_polygons_agree_and_say_their_bound(glyph: gs.GlyphResult) -> None:
    settings = Settings(Appearance(size="20mm"), flatness=2.0).scaled(glyph.outline.metrics)
    schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
    Draft202012Validator.check_schema(schema)
    data = json.loads(polyline_json(glyph, settings))
    Draft202012Validator(schema).validate(data)
    assert not Draft202012Validator(schema).is_valid(json.loads(gs.to_json(glyph)))
    assert 0 < data["bound"] <= data["flatness"] == 2.0 * settings.scale
    rows = list(csv.DictReader(StringIO(polyline_csv(glyph, settings))))
    for c, contour in enumerate(data["contours"]):
        own = [row for row in rows if row["contour"] == str(c)]
        assert [int(row["index"]) for row in own] == list(range(len(contour)))
        assert [[float(row["x"]), float(row["y"])] for row in own] == contour
        curve = glyph.contours[c].curve
        samples = evaluate(np.repeat(curve.cubics(), 30, axis=0), np.tile(np.arange(30) / 30, len(curve)))
        assert distances(samples * settings.scale, np.array(contour)).max() <= data["bound"]


def test_another_flatness_is_another_run(font: gs.Font, tmp_path: Path) -> None:
    options = gs.Options(step=60)
    convert_font(font, ["O"], tmp_path, RunSpec(options, ("polyline",), Settings(flatness=3.0)), jobs=0)
    run = json.loads((tmp_path / "run.json").read_text())
    assert (run["flatness"], run["dxf"]) == (3.0, "spline")
    assert "flatness" not in run["command"], "it is Python's"
    assert json.loads((tmp_path / "polyline" / "O.json").read_text())["flatness"] == 3.0
    with pytest.raises(OutputError, match=r"flatness: 3\.0 in the folder, null now"):
        convert_font(font, ["O"], tmp_path, RunSpec(options, ("polyline",)), jobs=0)
