"""Small variable fonts, built for tests."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, TypeAlias

from fontTools.fontBuilder import FontBuilder
from fontTools.ttLib.tables._g_l_y_f import Glyph, GlyphCoordinates
from fontTools.ttLib.tables.ttProgram import Program
from fontTools.ttLib.tables.TupleVariation import TupleVariation

Points: TypeAlias = Sequence[tuple[float, float]]
Support: TypeAlias = Mapping[str, tuple[float, float, float]]
Tuples: TypeAlias = Mapping[str, Sequence[tuple[Support, Points]]]

WEIGHT = ("wght", 100, 400, 900, "Weight")
PHANTOMS = [(0, 0)] * 4


def variable_font(
    path: Path,
    glyphs: Mapping[str, Any],
    variations: Tuples,
    axes: Sequence[tuple[str, float, float, float, str]] = (WEIGHT,),
) -> Path:
    """A TrueType font of glyphs and their deltas, which are those of the contours' points, without phantom points."""
    empty = Glyph()
    empty.numberOfContours = 0
    glyphs = {".notdef": empty, **glyphs}
    builder = FontBuilder(1000)
    builder.setupGlyphOrder(list(glyphs))
    builder.setupCharacterMap({ord(name): name for name in glyphs if len(name) == 1})
    builder.setupGlyf(dict(glyphs))
    builder.setupHorizontalMetrics({name: (600, getattr(glyph, "xMin", 0)) for name, glyph in glyphs.items()})
    builder.setupHorizontalHeader(ascent=800, descent=-200)
    builder.setupNameTable({"familyName": "Masters", "styleName": "Regular"})
    builder.setupFvar(list(axes), [])
    tuples = {
        name: [TupleVariation(dict(support), [*deltas, *PHANTOMS]) for support, deltas in of_glyph]
        for name, of_glyph in variations.items()
    }
    builder.setupGvar(tuples)
    builder.setupOS2()
    builder.setupPost()
    builder.save(path)
    return path


def quadratic(points: Points, on: Sequence[bool]) -> Glyph:
    """A glyph of one contour."""
    glyph = Glyph()
    glyph.numberOfContours = 1
    glyph.coordinates = GlyphCoordinates(points)
    glyph.endPtsOfContours = [len(points) - 1]
    glyph.flags = bytearray(on)
    glyph.program = Program()
    glyph.program.fromBytecode(b"")
    return glyph


def polygon(*points: tuple[float, float]) -> Glyph:
    """A glyph of one contour of lines."""
    return quadratic(points, [True] * len(points))
