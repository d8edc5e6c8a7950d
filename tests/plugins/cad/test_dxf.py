"""DXF: read back by ezdxf, entities are the result's curves; the same bytes at every call; no text of the font."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from dataclasses import replace
from io import StringIO
from pathlib import Path
from typing import Any, get_args

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import cKDTree

import glyphspline as gs
from glyphspline.errors import OptionError
from glyphspline.fitting.results import as_glyph
from glyphspline.plugins.cad import dxf
from glyphspline.types import INCHES
from glyphspline.writers.formats import format_named
from glyphspline.writers.settings import DxfKind, Settings
from tests.places import ROOT

ezdxf: Any = pytest.importorskip("ezdxf")

FONT = ROOT / "fonts_test" / "kouzan-gyosho.ttf"
LOOKS = {
    "smooth": gs.Options(corners="smooth"),
    "sharp": gs.Options(),
    "g2": gs.Options(corners="sharp", continuity="g2"),
}


@pytest.fixture(scope="module")
def results() -> dict[str, gs.GlyphResult]:
    font = gs.open_font(FONT)
    (name,) = font.select(text="g")
    return {look: gs.convert(font.outline(name), options) for look, options in LOOKS.items()}


def opened(text: str) -> Any:
    document = ezdxf.read(StringIO(text))
    audit = document.audit()
    assert not audit.errors
    assert not audit.fixes
    return document


def entities(document: Any) -> list[list[Any]]:
    """The entities of each contour: those of a group, or one alone."""
    grouped = {entity.dxf.handle: name for name, group in document.groups for entity in group}
    found: dict[str, list[Any]] = {}
    for entity in document.modelspace():
        found.setdefault(grouped.get(entity.dxf.handle, entity.dxf.handle), []).append(entity)
    return list(found.values())


def points(entity: Any, count: int = 400) -> np.ndarray:
    if entity.dxftype() == "LINE":
        ends = np.array([tuple(entity.dxf.start)[:2], tuple(entity.dxf.end)[:2]])
        return ends[0] + np.linspace(0, 1, count)[:, None] * (ends[1] - ends[0])
    curve = entity.construction_tool()
    return np.array([tuple(p)[:2] for p in curve.points(np.linspace(0, curve.max_t, count))])


def drawn_by(own: list[Any], count: int = 400) -> np.ndarray:
    """Points along the entities of a contour, each place once."""
    return np.concatenate([points(entity, count)[:-1] for entity in own])


def samples(contour: gs.Contour, count: int = 400) -> np.ndarray:
    return contour.at(np.linspace(0, len(contour), len(contour) * count, endpoint=False))


@pytest.mark.parametrize("degree", range(2, 7))
@pytest.mark.parametrize("n", [3, 4, 9])
def test_a_closed_spline_clamped_is_the_same_curve(degree: int, n: int) -> None:
    rng = np.random.default_rng(degree * n)
    knots = np.concatenate([[0.0], np.cumsum(rng.uniform(0.1, 3.0, n))])
    spline = gs.Spline(rng.normal(size=(n, 2)), knots, degree)
    clamped = spline.clamped()
    assert not clamped.closed
    assert len(clamped.control_points) == n + degree
    assert (clamped.control_points[0] == clamped.control_points[-1]).all()
    at = np.linspace(0.0, knots[-1], 300)[:-1]
    for order in range(degree):
        scale = np.abs(spline(at, derivative=order)).max()
        np.testing.assert_allclose(clamped(at, derivative=order), spline(at, derivative=order), atol=1e-11 * scale)
    assert clamped.clamped() is clamped


@pytest.mark.parametrize("look", LOOKS)
def test_a_contour_is_one_spline(results: dict[str, gs.GlyphResult], look: str) -> None:
    result = results[look]
    contours = entities(opened(gs.to_dxf(result)))
    assert [[e.dxftype() for e in contour] for contour in contours] == [["SPLINE"]] * len(result.contours)
    for (entity,), contour in zip(contours, result.contours, strict=True):
        spline = contour.spline
        assert spline is not None
        assert entity.dxf.degree == 3
        assert entity.dxf.flags == dxf.PLANAR
        assert entity.control_points[0].tolist() == entity.control_points[-1].tolist()
        curve = entity.construction_tool()
        assert curve.is_clamped
        at = np.linspace(0.0, spline.period, 1000)
        at = at if look == "smooth" else at[~np.isin(at, spline.knots)]
        for order in range(3):  # the last place is the first: the curve and its derivatives agree across the seam
            expected = spline(at, derivative=order)
            read = np.array([tuple(v)[:2] for v in _derivatives(curve, at, order)])
            scale = max(np.abs(expected).max(), np.abs(spline.control_points).max() / spline.period**order)
            np.testing.assert_allclose(read, expected, atol=1e-9 * scale)


def _derivatives(curve: Any, at: np.ndarray, order: int) -> list[Any]:
    inside = np.clip(at, 0.0, curve.max_t)
    return [curve.derivative(t, n=2)[order] for t in inside.tolist()]


@pytest.mark.parametrize("look", ["sharp", "g2"])
def test_arcs_and_lines_follow_each_other(results: dict[str, gs.GlyphResult], look: str) -> None:
    result = results[look]
    contours = entities(opened(gs.to_dxf(result, dxf="arcs")))
    assert len(contours) == len(result.contours)
    for own, contour in zip(contours, result.contours, strict=True):
        lines = [e for e in own if e.dxftype() == "LINE"]
        assert len(lines) == np.count_nonzero(contour.curve.degrees == 1)
        assert len({e.dxf.layer for e in own}) == 1
        if look == "sharp":
            assert len(own) - len(lines) == len(contour.interpolations)
        begins, ends = zip(*(_ends(e) for e in own), strict=True)
        assert ends == (*begins[1:], begins[0])  # in every digit
        drawn, true = drawn_by(own), samples(contour.curve)
        assert cKDTree(drawn).query(true)[0].max() < 1.0
        assert _distance(drawn, true) < 0.01


def _ends(entity: Any) -> tuple[tuple[float, ...], tuple[float, ...]]:
    if entity.dxftype() == "LINE":
        return tuple(entity.dxf.start), tuple(entity.dxf.end)
    return tuple(entity.control_points[0]), tuple(entity.control_points[-1])


def _distance(of: np.ndarray, polygon: np.ndarray) -> float:
    """Largest distance of points from a dense closed polygon: from its chords at the nearest corner."""
    near = cKDTree(polygon).query(of)[1]
    best = np.full(len(of), np.inf)
    for a, b in ((near - 1, near), (near, (near + 1) % len(polygon))):
        p, d = polygon[a], polygon[b] - polygon[a]
        along = np.clip(((of - p) * d).sum(axis=1) / np.maximum((d * d).sum(axis=1), 1e-300), 0, 1)
        best = np.minimum(best, np.hypot(*(of - p - along[:, None] * d).T))
    return float(best.max())


@pytest.mark.parametrize("kind", ["spline", "arcs"])
@pytest.mark.parametrize("look", LOOKS)
def test_the_certificate_holds_for_what_is_read(results: dict[str, gs.GlyphResult], look: str, kind: DxfKind) -> None:
    result = results[look]
    rounding = np.sqrt(0.5) * 10.0**-result.options.precision
    for own, contour in zip(entities(opened(gs.to_dxf(result, dxf=kind))), result.contours, strict=True):
        drawn, source = drawn_by(own, 1000 if len(own) > 1 else 40_000), samples(contour.source)
        bound = contour.measures.deviation_bound
        assert bound is not None
        assert 0.0 < max(_distance(drawn, source), _distance(source, drawn)) <= bound + rounding + 0.01


def test_contours_from_elsewhere_are_splines_from_corner_to_corner() -> None:
    k = 0.5522847498
    circle = [[(1, 0), (1, k), (k, 1), (0, 1)], [(0, 1), (-k, 1), (-1, k), (-1, 0)]]
    circle += [[(-x, -y) for x, y in part] for part in circle]
    drop = [np.array([(0, 0), (4, 1), (4, 3)]), np.array([(4, 3), (4, 5), (0, 5)]), np.array([(0, 5), (0, 0)])]
    round_contour = gs.Contour.from_segments([100.0 * np.array(part) for part in circle])
    quadratics = gs.Contour.from_segments([100.0 * part for part in drop])
    found = entities(opened(gs.to_dxf(as_glyph(gs.Outline("x", contours=(round_contour, quadratics))), dxf="arcs")))
    assert [[e.dxftype() for e in own] for own in found] == [["SPLINE"], ["SPLINE", "LINE"]]
    for own, contour in zip(found, (round_contour, quadratics), strict=True):
        drawn, true = drawn_by(own), samples(contour)
        assert _distance(drawn, true) < 0.01
        assert _distance(true, drawn) < 0.01
        assert {e.dxf.degree for e in own if e.dxftype() == "SPLINE"} == {3}


@pytest.mark.parametrize(
    ("given", "left"),
    [
        ("0,0 9,0 9,9 4,9 4,12 4,9 0,9", "0,0 9,0 9,9 4,9 0,9"),  # a spur
        ("0,0 9,0 9,9 4,9 4,12 4,7 0,9", "0,0 9,0 9,9 4,9 4,7 0,9"),  # beyond where it began
        ("0,0 9,0 9,9 3,9 5,9 2,9 7,9 0,9", "0,0 9,0 9,9 7,9 0,9"),  # several, on a line
        ("0,0 9,0 9,9 4,9 4,12 6,14 4,12 4,9 0,9", "0,0 9,0 9,9 4,9 0,9"),  # with a bend
        ("4,3 0,0 9,0 9,9 0,9 0,0", "0,0 9,0 9,9 0,9"),  # at the seam
        ("0,0 9,0 9,9 4,9 4,12 5,9 0,9", "0,0 9,0 9,9 4,9 4,12 5,9 0,9"),  # a spike has an area
        ("0,0 5,5", "0,0 5,5"),  # nothing else
    ],
)
def test_lines_that_run_back_are_left_out(given: str, left: str) -> None:
    points, expected = ([tuple(map(float, p.split(","))) for p in text.split()] for text in (given, left))
    found = dxf.without_spurs(gs.Contour(np.array(points), np.ones(len(points), dtype=np.int64))).points
    assert found.tolist() == [list(p) for p in expected]


@pytest.mark.parametrize("flatness", [None, 5.0, 0.05])
def test_polylines_are_as_near_as_they_say(results: dict[str, gs.GlyphResult], flatness: float | None) -> None:
    result = results["smooth"]
    allowed = result.outline.metrics.units_per_em / 2000 if flatness is None else flatness
    contours = entities(opened(gs.to_dxf(result, dxf="polyline", flatness=flatness)))
    for (entity,), contour in zip(contours, result.contours, strict=True):
        assert entity.dxftype() == "LWPOLYLINE"
        assert entity.closed
        corners = np.array(entity.get_points("xy"))
        true = samples(contour.curve, 100)
        assert 0.0 < _polygon_distance(true, corners) <= allowed
        assert len(corners) >= len(contour.curve)


def _polygon_distance(of: np.ndarray, polygon: np.ndarray) -> float:
    a, d = polygon, np.roll(polygon, -1, axis=0) - polygon
    far = 0.0
    for part in np.array_split(of, len(of) // 500 + 1):
        along = np.clip(((part[:, None] - a) * d).sum(axis=2) / (d * d).sum(axis=1), 0, 1)
        far = max(far, np.hypot(*np.moveaxis(part[:, None] - a - along[..., None] * d, 2, 0)).min(axis=1).max())
    return far


def test_layers_tell_holes() -> None:
    font = gs.open_font(FONT)
    for name in font.select(text="O龍"):
        outline = font.outline(name)
        backwards = replace(outline, contours=tuple(contour.reversed() for contour in outline.contours))
        said = []
        for each in (outline, backwards):
            said.append([own[0].dxf.layer for own in entities(opened(gs.to_dxf(gs.convert(each))))])
        assert said[0] == said[1]
        assert set(said[0]) == {"outlines", "holes"}
    ring = [np.array([(0, 0), (s, 0), (s, s), (0, s)]) + (300 - s) / 2 for s in (300.0, 200.0, 100.0)]
    ones = np.ones(4, dtype=np.int64)
    nested = [gs.Contour(points[:: 1 if k % 2 else -1], ones) for k, points in enumerate(ring)]
    inside = [gs.Contour(points, ones) for points in ring[:2]]  # ink upon ink: no hole by the nonzero rule
    for contours, layers in ((nested, ["outlines", "holes", "outlines"]), (inside, ["outlines", "outlines"])):
        document = opened(gs.to_dxf(as_glyph(gs.Outline("x", contours=contours))))
        assert [own[0].dxf.layer for own in entities(document)] == layers


@pytest.mark.parametrize(
    ("unit", "code"), [(None, 0), ("in", 1), ("mm", 4), ("cm", 5), ("pt", 4), ("pc", 4), ("px", 4)]
)
def test_units(results: dict[str, gs.GlyphResult], unit: str | None, code: int) -> None:
    result = results["smooth"]
    document = opened(dxf.write(result, Settings(scale=0.25, unit=unit)))
    assert document.header["$INSUNITS"] == code
    factor = 0.25 * (INCHES[unit] / INCHES["mm"] if unit in ("pt", "pc", "px") else 1.0)
    first = document.modelspace()[0].control_points[5]
    expected = result.contours[0].interpolations[0].spline.clamped().control_points[5] * factor
    np.testing.assert_allclose(first[:2], expected, rtol=1e-14)


def test_a_size(results: dict[str, gs.GlyphResult]) -> None:
    result = results["smooth"]
    metrics = result.outline.metrics
    large, plain = (opened(gs.to_dxf(result, size=size)) for size in ("20mm", None))
    ratio = large.modelspace()[0].control_points[3][0] / plain.modelspace()[0].control_points[3][0]
    assert ratio == pytest.approx(20 / (metrics.ascender - metrics.descender))
    assert large.header["$INSUNITS"] == 4


@pytest.mark.parametrize(
    "wrong",
    [{"size": "20"}, {"size": "0mm"}, {"size": "nanmm"}, {"dxf": "arc"}, {"flatness": 0.0}, {"flatness": np.nan}],
)
def test_what_is_wrong_is_said(results: dict[str, gs.GlyphResult], wrong: dict[str, Any]) -> None:
    with pytest.raises(OptionError):
        gs.to_dxf(results["smooth"], **wrong)


@pytest.mark.parametrize("scale", [0.0, -1.0, np.inf, np.nan])
def test_a_scale_that_is_none(results: dict[str, gs.GlyphResult], scale: float) -> None:
    with pytest.raises(OptionError):
        dxf.write(results["smooth"], Settings(scale=scale, unit="mm"))


def test_the_same_bytes_in_two_processes(tmp_path: Path) -> None:
    code = (
        "import sys, glyphspline as gs; font = gs.open_font(sys.argv[1]);"
        "results = [gs.convert(font.outline(n), gs.Options(corners=c)) for n in font.select(text='go')"
        " for c in ('smooth', 'sharp')];"
        "sys.stdout.write(''.join(gs.to_dxf(r, size='20mm', dxf=k) for r in results for k in ('spline', 'polyline')))"
    )
    said = [
        subprocess.run(
            [sys.executable, "-c", code, str(FONT)],
            cwd=ROOT, env={**os.environ, "PYTHONHASHSEED": seed}, capture_output=True, check=True, timeout=600,
        ).stdout
        for seed in ("1", "2")
    ]  # fmt: skip
    assert said[0] == said[1]
    assert len(said[0]) > 50_000


def test_the_option_of_the_process_is_restored(results: dict[str, gs.GlyphResult]) -> None:
    before = ezdxf.options.write_fixed_meta_data_for_testing
    gs.to_dxf(results["smooth"])
    assert ezdxf.options.write_fixed_meta_data_for_testing is before
    assert not before


@given(st.text(max_size=30), st.sampled_from(get_args(DxfKind)))
def test_no_name_is_in_the_file(name: str, kind: DxfKind) -> None:
    square = gs.Contour(np.array([(0, 0), (100, 0), (100, 100), (0, 100.0)]), np.ones(4, dtype=np.int64))
    plain = gs.to_dxf(as_glyph(gs.Outline("x", contours=(square,))), dxf=kind)
    odd = replace(as_glyph(gs.Outline(name, contours=(square,), notes=(name,))), notes=(name,))
    assert gs.to_dxf(odd, dxf=kind) == plain
    assert plain.isascii()


@pytest.mark.parametrize("kind", get_args(DxfKind))
def test_a_glyph_without_contours(kind: DxfKind) -> None:
    document = opened(gs.to_dxf(as_glyph(gs.Outline("space", advance=200.0)), dxf=kind))
    assert not len(document.modelspace())


def test_numbers_are_plain(results: dict[str, gs.GlyphResult]) -> None:
    text = format_named("dxf").write(results["sharp"], Settings(scale=0.02, unit="mm"))
    assert isinstance(text, str)
    assert (format_named("dxf").suffix, format_named("dxf").extra) == (".dxf", "cad")
    assert not re.search(r"np\.|nan|inf\b|^-0\.0$", text, re.MULTILINE)


def test_a_single_line_font_is_open_splines(tmp_path: Path) -> None:
    from tests.outlines.test_open_paths import stick_font

    font = stick_font(tmp_path / "stick.ttf", {"V": [[(0, 0), (200, 700), (400, 0), (200, 700)], [(0, 99), (9, 99)]]})
    glyph = gs.convert(font.outline("V"))
    kinds: tuple[DxfKind, ...] = ("spline", "polyline")
    for kind in kinds:
        document = ezdxf.read(StringIO(gs.to_dxf(glyph, dxf=kind)))
        first, last = document.modelspace()
        assert {first.dxf.layer, last.dxf.layer} == {"outlines"}
        assert not first.closed
        points = first.get_points("xy") if kind == "polyline" else list(first.construction_tool().approximate(40))
        ends = [tuple(round(x, 6) for x in (point[0], point[1])) for point in (points[0], points[-1])]
        assert ends == [(0, 0), (400, 0)]
        assert document.audit().errors == []
    found = gs.to_polylines(glyph)
    assert found.opened == (True, True)
    assert found.polygons[0].tolist() == [[0, 0], [200, 700], [400, 0]]
