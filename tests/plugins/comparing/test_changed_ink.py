"""Ink that differs between two outlines: known shapes, and letters against winding numbers on a grid."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from fontTools.fontBuilder import FontBuilder
from fontTools.pens.ttGlyphPen import TTGlyphPen
from typer.testing import CliRunner

import glyphspline as gs
from glyphspline.cli.app import app
from glyphspline.curves.bezier import evaluate
from glyphspline.outlines.outline_distance import chains_of
from glyphspline.plugins.comparing.changed_ink import deepest_point
from glyphspline.types import BoolArray, FloatArray
from tests.places import DEJAVU

ANGLES = (0.0, 0.3, 2.0)
LETTERS = "oBg&@8QR"
runner = CliRunner()


def box(x: float, y: float, width: float, height: float, turn: int = 1) -> gs.Contour:
    """Counter-clockwise, or clockwise for ``turn`` -1."""
    corners = np.array([(x, y), (x + width, y), (x + width, y + height), (x, y + height)], dtype=np.float64)
    return gs.Contour(corners[::turn], np.ones(4, dtype=np.int64))


RING = [box(0, 0, 300, 200), box(50, 50, 60, 40, -1)]
PATCH = box(150, 60, 20, 20)
LENS = [box(0, 0, 100, 100), box(80, 20, 100, 40)]


def compared(old: list[gs.Contour], new: list[gs.Contour], angle: float, tolerance: float = 1.0) -> gs.Difference:
    way = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    one, other = (
        gs.Outline("a", contours=[gs.Contour(each.points @ way, each.degrees) for each in contours])
        for contours in (old, new)
    )
    return gs.compare(one, other, tolerance)


@pytest.mark.parametrize("angle", ANGLES)
@pytest.mark.parametrize(
    ("old", "new", "changed", "lost", "gained", "depth"),
    [
        pytest.param(RING, [RING[0], RING[1].reversed()], 2400, 1, 0, 20, id="a counter filled"),
        pytest.param([RING[0], RING[1].reversed()], RING, 2400, 0, 1, 20, id="a counter cut"),
        pytest.param(LENS, [LENS[0], LENS[1].reversed()], 800, 0, 1, 10, id="an overlap cut"),
        pytest.param([*RING, PATCH], [*RING, PATCH.reversed()], 400, 0, 1, 10, id="a patch cuts"),
        pytest.param([RING[0], RING[0]], [RING[0], RING[0].reversed()], 60000, 1, 0, 100, id="a twin cuts"),
    ],
)  # fmt: skip
def test_ink_that_changed_in_the_same_outline(
    old: list[gs.Contour], new: list[gs.Contour], changed: float, lost: int, gained: int, depth: float, angle: float
) -> None:
    found = compared(old, new, angle)
    assert found.bound < 1e-9
    assert found.ink is not None
    assert found.ink.changed == pytest.approx(changed)
    assert abs(found.ink.new_area - found.ink.area) == pytest.approx(changed)
    assert (found.ink.lost, found.ink.gained) == (lost, gained)
    assert depth / 1.26 <= found.ink.depth <= depth
    assert found.is_beyond(1.0)
    assert found.is_beyond(0.7 * depth)
    assert not found.is_beyond(depth)


@pytest.mark.parametrize("angle", ANGLES)
@pytest.mark.parametrize(
    ("old", "new"),
    [
        pytest.param(RING, [each.reversed() for each in reversed(RING)], id="turned round"),
        pytest.param([*RING, box(150, 50, 20, 20)], [*RING, box(150.6, 50, 20, 20)], id="a patch on ink"),
        pytest.param([box(0, 0, 99, 50), box(99, 0, 90, 50)], [box(0, 0, 98.5, 50), box(99.5, 0, 90, 50)], id="a gap"),
        pytest.param([box(0, 0, 99, 50), box(90, 9, 1.8, 9, -1)], [box(0, 0, 99, 50), box(90, 9, 1.8, 9)], id="hair"),
        pytest.param([*RING, box(300.2, 9, 0.6, 1.4)], RING, id="a speck gone"),
    ],
)  # fmt: skip
def test_what_the_tolerance_explains_is_not_beyond(old: list[gs.Contour], new: list[gs.Contour], angle: float) -> None:
    found = compared(old, new, angle)
    assert found.ink is None
    assert not found.is_beyond(1.0)
    assert not found.is_undecided(1.0)


def font_of(outline: gs.Outline, path: Path) -> str:
    """A TTF of one glyph."""
    builder = FontBuilder(1000, isTTF=True)
    builder.setupGlyphOrder([".notdef", outline.name])
    pen = TTGlyphPen(None)
    for contour in outline.contours:
        contour.draw(pen)
    builder.setupGlyf({".notdef": TTGlyphPen(None).glyph(), outline.name: pen.glyph()})
    builder.setupCharacterMap({ord(outline.name): outline.name})
    builder.setupHorizontalMetrics(dict.fromkeys([".notdef", outline.name], (600, 0)))
    builder.setupHorizontalHeader(ascent=800, descent=-200)
    builder.setupNameTable({"familyName": "Ring", "styleName": "Regular"})
    builder.save(path)
    return str(path)


def test_a_filled_counter_has_status_1_and_is_named(tmp_path: Path) -> None:
    ring = font_of(gs.Outline("o", contours=RING), tmp_path / "ring.ttf")
    disc = font_of(gs.Outline("o", contours=[RING[0], RING[1].reversed()]), tmp_path / "disc.ttf")
    page = tmp_path / "diff.html"
    said = runner.invoke(app, ["diff", ring, disc, "--jobs", "0", "--html", str(page)])
    assert said.exit_code == 1
    assert "4.17 %" in said.stdout
    assert "with other ink: 1 glyph: o" in said.stderr
    assert '<circle class="ink"' in page.read_text(encoding="utf-8")
    told = runner.invoke(app, ["diff", ring, disc, "--jobs", "0", "--json"])
    (glyph,) = json.loads(told.stdout)["glyphs"]
    assert list(glyph["ink"]) == [
        "changed", "error", "area", "new_area", "lost", "gained", "depth", "deepest",
    ]  # fmt: skip
    assert (glyph["beyond_tolerance"], glyph["ink"]["area"], glyph["ink"]["new_area"]) == (True, 57600, 60000)
    assert runner.invoke(app, ["diff", ring, disc, "--jobs", "0", "--tolerance", "21"]).exit_code == 0


def test_ink_is_not_measured_beyond_the_tolerance() -> None:
    filled = [box(1.5, 0, 300, 200), RING[1].reversed()]
    assert compared(RING, filled, 0).ink is None
    assert compared(RING, [], 0).ink is None
    found = compared(RING, filled, 0, tolerance=2)
    assert found.ink is not None
    assert found.is_beyond(2)


def test_a_search_that_would_not_end_is_given_up_and_undecided() -> None:
    chains, deepest = chains_of(gs.Outline("o", contours=RING).arrays), np.zeros(3)
    boxes = np.array([[-9.0, -9, 310, 210]])
    assert deepest_point(chains, chains, boxes, 1.0, deepest)
    assert not deepest_point(chains, chains, boxes, 1e-4, deepest)
    assert deepest.tolist() == [0, 0, 0]
    left_open = replace(compared(RING, RING[::-1], 0), ink_known=False)
    assert left_open.is_undecided(1.0)
    assert not left_open.is_beyond(1.0)


def polygons(outline: gs.Outline, steps: int = 24) -> list[FloatArray]:
    """A polygon for each contour."""
    t = np.arange(steps) / steps
    cubics = [contour.cubics() for contour in outline.contours]
    return [evaluate(np.repeat(each, steps, axis=0), np.tile(t, len(each))) for each in cubics]


def filled(outline: gs.Outline, points: FloatArray) -> BoolArray:
    """(n,) whether points are in the ink: by the sum of the angles at which the sides are seen."""
    total = np.zeros(len(points))
    for polygon in polygons(outline):
        z = (polygon - points[:, None]) @ np.array([1, 1j])
        total += np.angle(np.roll(z, -1, axis=1) / z).sum(axis=1)
    return np.abs(total) > np.pi


def away(outline: gs.Outline, points: FloatArray) -> FloatArray:
    """(n,) distances of points from an outline, by its chords."""
    least = np.full(len(points), np.inf)
    for polygon in polygons(outline):
        a, u = polygon, np.roll(polygon, -1, axis=0) - polygon
        v = points[:, None] - a
        share = np.clip((v * u).sum(axis=2) / np.maximum((u * u).sum(axis=1), 1e-12), 0, 1)
        least = np.minimum(least, np.hypot(*np.moveaxis(v - share[:, :, None] * u, 2, 0)).min(axis=1))
    return least


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("letter", LETTERS)
def test_letters_with_contours_turned_against_winding_numbers_on_a_grid(letter: str, seed: int) -> None:
    rng = np.random.default_rng([ord(letter), seed])
    font = gs.open_font(DEJAVU)
    old = font.outline(font.select(text=letter)[0])
    tolerance = float(rng.choice([2.0, 10.0, 40.0]))
    contours = [
        (each.reversed() if rng.random() < 0.4 else each)
        for each in (moved(each, rng.uniform(-0.4, 0.4, 2) * tolerance) for each in old.contours)
    ]
    new = replace(old, contours=contours)
    found = gs.compare(old, new, tolerance)
    low, high = np.min(old.arrays.points, axis=0) - 50, np.max(old.arrays.points, axis=0) + 50
    grid = np.stack(np.meshgrid(*np.linspace(low, high, 60).T), axis=2).reshape(-1, 2)
    other = grid[filled(old, grid) != filled(new, grid)]
    deepest = float(np.minimum(away(old, other), away(new, other)).max(initial=0.0))
    assert found.seen <= tolerance
    depth = 0.0 if found.ink is None else found.ink.depth
    assert depth >= deepest / 1.26 or deepest <= 1.26 * tolerance
    if depth:
        assert found.ink is not None
        point = np.array([found.ink.deepest])
        assert filled(old, point) != filled(new, point)
        assert min(float(away(old, point)[0]), float(away(new, point)[0])) == pytest.approx(depth, rel=0.02, abs=0.5)
        share = len(other) * np.prod((high - low) / 59)
        assert found.ink.changed == pytest.approx(share, rel=0.15, abs=3e4)
    assert found.is_beyond(tolerance) == (depth > tolerance)


def moved(contour: gs.Contour, by: FloatArray) -> gs.Contour:
    return gs.Contour(contour.points + by, contour.degrees)
