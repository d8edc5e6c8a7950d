"""What the summary says of a written font: pairs of numbers, of which both sides are counted alike."""

from __future__ import annotations

from pathlib import Path

import pytest
from fontTools.fontBuilder import FontBuilder
from fontTools.pens.t2CharStringPen import T2CharStringPen
from fontTools.ttLib import TTFont

import glyphspline as gs
from glyphspline.plugins.fonts.tables.stored import StoredFacts, compared, stored_facts
from tests.places import DEJAVU, GYOSHO


def cubic_font(path: Path, shift: float) -> Path:
    """One contour of cubics in an OTF, moved by ``shift``: it turns by 9.5 degrees beside handles of six units."""
    pen = T2CharStringPen(500, None, roundTolerance=0)
    x = 100 + shift
    pen.moveTo((x, 0))
    pen.curveTo((x + 6, 0), (x + 40, 30), (x + 40, 60))
    pen.curveTo((x + 40, 100), (x - 40, 100), (x - 40, 60))
    pen.curveTo((x - 40, 30), (x - 6, 1), (x, 0))
    pen.closePath()
    builder = FontBuilder(1000, isTTF=False)
    builder.setupGlyphOrder([".notdef"])
    builder.setupCFF("Cubic", {}, {".notdef": pen.getCharString()}, {})
    builder.setupHorizontalMetrics({".notdef": (500, 0)})
    builder.setupHorizontalHeader()
    builder.setupNameTable({"familyName": "Cubic", "styleName": "Regular"})
    builder.setupPost()
    builder.save(path)
    return path


def facts(path: Path, *gids: int) -> StoredFacts:
    return stored_facts(gs.open_font(path), gids)


def test_kinks_and_jumps_do_not_depend_on_the_grid(tmp_path: Path) -> None:
    """``check`` lets pass what rounding to whole units makes, and nothing where points have decimals."""
    whole, moved = (facts(cubic_font(tmp_path / f"{shift}.otf", shift), 0) for shift in (0.0, 0.3))
    assert whole[:-1] == moved[:-1]
    assert whole.kinks == 1
    assert whole.jumps is not None


def test_jumps_are_counted_of_fonts_of_cubics_alone(tmp_path: Path) -> None:
    quadratics, cubics = facts(DEJAVU, *range(36, 62)), facts(cubic_font(tmp_path / "c.otf", 0.0), 0)
    assert quadratics.jumps is None
    assert cubics.jumps is not None
    for before, after, said in ((quadratics, cubics, False), (cubics, quadratics, False), (cubics, cubics, True)):
        assert ("jumps" in compared(before, after)) == said
    assert "jumps" not in compared(quadratics, quadratics)


def test_more_points_are_said_to_be_more() -> None:
    of_cubics, of_quadratics = StoredFacts(10, 40, 0, 0), StoredFacts(18, 36, 0, None)
    because = "points 36 → 40 (more: a cubic has two off the curve, a quadratic one)"
    assert because in compared(of_quadratics, of_cubics)
    assert "points 40 → 36," in compared(of_cubics, of_quadratics)
    assert "points 40 → 44 (more)," in compared(of_cubics, of_quadratics._replace(points=44))


@pytest.mark.parametrize("flavor", ["woff", "woff2"])
def test_bytes_are_uncompressed(flavor: str, tmp_path: Path) -> None:
    font = TTFont(GYOSHO)
    font.flavor = flavor
    font.save(tmp_path / f"font.{flavor}")
    packed, plain = facts(tmp_path / f"font.{flavor}").bytes, facts(GYOSHO).bytes
    assert packed is not None
    assert plain is not None
    assert abs(packed - plain) < 0.01 * plain  # fontTools stores flags and padding of its own
