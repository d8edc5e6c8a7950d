"""Certified bounds as they are written: rounded up, with what the reader snapped, and of the written curve."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fontTools.fontBuilder import FontBuilder
from fontTools.pens.ttGlyphPen import TTGlyphPen
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

import glyphspline as gs
from glyphspline.cli.app import app
from glyphspline.curves.integrals import area
from glyphspline.readers.pens import ContourPen
from glyphspline.types import rounded_up
from scripts.paper.measures import shape
from tests.places import GYOSHO as FONT
from tests.topology import path_contours, svg_contours


@given(st.floats(1e-12, 1e12), st.integers(1, 9))
def test_rounded_up_is_the_next_number_of_so_many_digits(value: float, digits: int) -> None:
    up = rounded_up(value, digits)
    assert up >= value
    assert float(f"{up:.{digits}g}") == up
    assert up - value <= 10.0 ** (np.floor(np.log10(value)) - digits + 1) * (1 + 1e-9)


def test_the_manifest_never_has_less_than_the_bound(tmp_path: Path) -> None:
    call = ["convert", str(FONT), "--text", "龍好gO", "--corners", "smooth", "--out", str(tmp_path), "--format", "svg"]
    CliRunner().invoke(app, call)  # arcs of one span have no rate
    font = gs.open_font(FONT)
    lines = [json.loads(line) for line in (tmp_path / "manifest.jsonl").read_text().splitlines()]
    below = 0
    for line in lines:
        contours = gs.convert(font.outline(line["glyph"]), gs.Options(corners="smooth")).contours
        for written, contour in zip(line["contours"], contours, strict=True):
            for name in ("deviation_bound", "rate_bound"):
                exact = getattr(contour.measures, name)
                assert exact <= written[name] <= exact * (1 + 2e-6)
                below += float(f"{exact:.7g}") < exact
    assert below > 3  # to the nearest number, these were below


def outlines_with_a_gap(gap: float) -> gs.Outline:
    pen = ContourPen()
    pen.moveTo((0, 0))
    pen.curveTo((200, -100), (400, -100), (600, 0))
    pen.lineTo((600 + gap, 0))
    pen.curveTo((400, 300), (200, 300), (0, gap))
    pen.closePath()
    return gs.Outline("gap", contours=tuple(pen.contours), snapped=pen.snapped)


@pytest.mark.parametrize(
    "options", [{"tolerance": 0.02}, {"tolerance": 0.02, "corners": "sharp"}, {"count": 24, "measure": True}]
)
def test_what_the_reader_snaps_is_in_the_bound(options: dict[str, Any]) -> None:
    whole, snapped = outlines_with_a_gap(0.0), outlines_with_a_gap(8e-4)
    assert whole.snapped == 0
    assert snapped.snapped == pytest.approx(8e-4)
    assert len(snapped.contours[0]) == len(whole.contours[0]) == 2
    for outline in (whole, snapped):
        (contour,) = gs.convert(outline, gs.Options(precision=5, **options)).contours
        measures = contour.measures
        assert measures.deviation_bound is not None
        assert measures.deviation_bound >= outline.snapped
        tolerance = options.get("tolerance", 1.0)
        assert measures.within_tolerance == (measures.deviation_bound <= tolerance)
        assert measures.within_tolerance or "count" in options


def test_bulk_reading_and_the_pen_snap_alike(tmp_path: Path) -> None:
    """A variable glyph whose deltas leave a closing segment shorter than a thousandth of a unit."""
    pen = TTGlyphPen(None)
    pen.moveTo((0, 0))
    for point in ((500, 0), (500, 500), (0, 500), (0, 1)):
        pen.lineTo(point)
    pen.closePath()
    builder = FontBuilder(1000, isTTF=True)
    builder.setupGlyphOrder([".notdef", "A"])
    builder.setupCharacterMap({65: "A"})
    empty = TTGlyphPen(None).glyph()
    builder.setupGlyf({".notdef": empty, "A": pen.glyph()})
    builder.setupHorizontalMetrics({".notdef": (500, 0), "A": (500, 0)})
    builder.setupHorizontalHeader(ascent=800, descent=-200)
    builder.setupNameTable({"familyName": "Gap", "styleName": "Regular"})
    builder.setupFvar([("wght", 0, 0, 1, "Weight")], [])
    from fontTools.ttLib.tables.TupleVariation import TupleVariation

    deltas = [(0, 0)] * 4 + [(0, -1)] + [(0, 0)] * 4
    builder.setupGvar({"A": [TupleVariation({"wght": (0, 1, 1)}, deltas)]})
    builder.setupOS2()
    builder.setupPost()
    builder.save(tmp_path / "gap.ttf")
    font = gs.open_font(tmp_path / "gap.ttf", location={"wght": 0.9995})
    bulk = font.outline("A")
    pen = ContourPen()
    font.shaper.draw_glyph_with_pen(1, pen)
    pen.finish()
    assert len(pen.contours[0]) == len(bulk.contours[0]) == 4
    assert pen.snapped == pytest.approx(bulk.snapped)
    assert 1e-4 < bulk.snapped < 1e-3


def test_measures_are_of_the_written_curve() -> None:
    box = gs.Contour(np.array([(0.2, 0.2), (800.2, 0.2), (800.2, 0.7), (0.2, 0.7)]), np.ones(4, dtype=np.int64))
    outline = gs.Outline("thin", contours=(box,))
    for precision in (0, 1, 2):
        result = gs.convert(outline, gs.Options(corners="sharp", precision=precision))
        (contour,) = result.contours
        written = result.arrays.curves.rounded(precision)
        cubics = np.concatenate([gs.Contour(written.points, written.degrees).cubics()])
        assert contour.measures.area_change == pytest.approx(area(cubics) - 400, abs=1e-9)
        assert contour.measures.length == pytest.approx(shape(cubics).length)
        lost = precision == 0  # both sides are written on each other
        assert contour.measures.collapsed is False or lost


@pytest.mark.parametrize("width", [0.05, 0.1, 1.0])
def test_a_lens_that_stays_is_the_sources_to_the_last_digit(width: float) -> None:
    """Chords of both differ by 1e-6, which looks like a bound that is too small."""
    lens = path_contours(f"M0 0C300 {width} 600 {width} 900 0C600 {-width} 300 {-width} 0 0Z")
    segments = [np.array(piece, dtype=np.float64) / lens.unit for piece in lens.contours[0]]
    outline = gs.Outline("lens", contours=(gs.Contour.from_segments(segments),))
    result = gs.convert(outline, gs.Options(corners="sharp", tolerance=5.0, precision=2))
    written, bound = svg_contours(gs.to_svg(result)), result.contours[0].measures.deviation_bound
    assert bound is not None
    assert bound < 1e-9
    exact = [
        {tuple((Fraction(x, of.unit), Fraction(y, of.unit)) for x, y in piece) for piece in of.contours[0]}
        for of in (lens, written)
    ]
    assert exact[0] == exact[1]
