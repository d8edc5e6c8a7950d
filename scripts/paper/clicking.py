"""Polygons as somebody would click them around a character (the paper used ``ginput``), and where they are kept."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from glyphspline.outlines.outline import Contour
from glyphspline.readers.opentype.font import open_font
from glyphspline.types import FloatArray, IntArray

from .common import SEED

DATA = Path(__file__).parent / "data"
FONTS = Path(__file__).parents[2] / "fonts_test"
CHARACTERS = {"dragon": ("龍", "kouzan-gyosho.ttf"), "good": ("好", "kouzan-kaisho.ttf")}

SAG = 0.006
"""How far, in em, the outline may stray from the chord of two clicks before one more is made."""

TURN, BESIDE = 35.0, 0.028
"""Where the polygon turns by more than so many degrees, clicks are added so far, in em, along long chords."""

DENSE = 32
"""Points a segment from which arc length is summed up."""

LONGEST = 0.24
"""No chord longer than this, in em: on a long straight stroke one still clicks now and then."""


def clicked(contour: Contour, em: float, seed: int) -> FloatArray:
    """(n, 2) whole units: few vertices on straight parts, more at turns, none quite on the outline.

    Vertices are set at the point farthest from the chord, again and again, until none is farther than
    ``SAG`` (Ramer, Douglas and Peucker); then each one is shaken a little.
    """
    places = np.arange(len(contour) * DENSE + 1) / DENSE
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(contour.at(places), axis=0).T))])
    length = float(along[-1])
    steps = max(64, int(length / em * 500))
    outline = contour.at(np.interp(length * np.arange(steps) / steps, along, places))
    start = int(np.argmax(outline @ np.array([-1.0, 1.0])))
    outline = np.roll(outline, -start, axis=0)
    opposite = int(np.argmax(np.hypot(*(outline - outline[0]).T)))
    closed = np.concatenate([outline, outline[:1]])
    kept = [*_simplify(closed, 0, opposite, em), *_simplify(closed, opposite, steps, em)]
    clicks = _beside_turns(closed[kept], np.array(kept), steps, BESIDE * steps * em / length)
    missed = np.random.default_rng(seed).normal(0, 0.0012 * em, (len(clicks), 2))
    return np.rint(closed[clicks] + missed)


def _beside_turns(p: FloatArray, kept: IntArray, steps: int, beside: float) -> IntArray:
    """Indices of the outline's points with some added on both sides of each turn, where the chord is long enough."""
    chord = np.roll(p, -1, axis=0) - p
    heading = np.arctan2(chord[:, 1], chord[:, 0])
    turn = np.abs(np.angle(np.exp(1j * (heading - np.roll(heading, 1)))))
    sharp = turn > np.radians(TURN)
    gap = np.diff(kept, append=kept[0] + steps)
    after = kept[sharp & (gap > 2.5 * beside)] + round(beside)
    before = (kept + gap)[np.roll(sharp, -1) & (gap > 2.5 * beside)] - round(beside)
    return np.unique(np.concatenate([kept, after, before]) % steps)


def _simplify(line: FloatArray, first: int, last: int, em: float) -> list[int]:
    """Indices kept of the line from ``first`` up to, not including, ``last``."""
    a, chord = line[first], line[last] - line[first]
    length = float(np.hypot(*chord))
    offset = line[first : last + 1] - a
    far = np.abs(offset @ np.array([-chord[1], chord[0]])) / length if length > 0 else np.hypot(*offset.T)
    middle = first + int(np.argmax(far))
    if far.max() <= SAG * em:
        if length <= LONGEST * em:
            return [first]
        middle = (first + last) // 2
    return _simplify(line, first, middle, em) + _simplify(line, middle, last, em)


def clicked_character(font_file: Path, character: str) -> dict[str, Any]:
    """The polygons of one character, with where they come from."""
    font = open_font(font_file)
    (name,) = font.select(text=character)
    outline = font.outline(name)
    em = outline.metrics.units_per_em
    return {
        "character": character,
        "face": font.family,
        "file": font_file.name,
        "units_per_em": em,
        "provenance": "Outline of the face named, clicked by the rule of scripts/paper/clicking.py",
        "polygons": [clicked(c, em, SEED + k).tolist() for k, c in enumerate(outline.contours)],
    }


def source_contours(font_file: Path, character: str) -> list[FloatArray]:
    """The original outline as dense closed polylines, for the picture."""
    font = open_font(font_file)
    (name,) = font.select(text=character)
    return [c.at(np.arange(len(c) * 16) / 16) for c in font.outline(name).contours]
