"""Polygons of an outline: by count, by step, clicked by a person, or set by a rule as somebody would click."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from ...errors import GlyphsplineError, PolygonError
from ...files import reading
from ...interpolation.polygon import clean_polygon
from ...outlines.outline import Contour, Outline
from ...outlines.sampling import sample
from ...types import FloatArray, IntArray

COLUMNS = ["glyph", "contour", "x", "y"]
"""Of a file of clicked points: a character or the name of a glyph, a number of the contour, font units, y up."""

SEED = 2012

SAG, LONGEST = 0.006, 0.24
"""How far, in em, the outline may stray from the chord of two clicks before one more is made. No chord is longer than
the second: on a long straight stroke one still clicks now and then."""

TURN, BESIDE = 35.0, 0.028
"""Where the polygon turns by more than so many degrees, clicks are added so far, in em, along long chords."""

SPECK = 40.0
"""A contour of less than 1/40 em is clicked as if the em were this number of it: one zooms in."""

DENSE, AN_EM, MISSED = 32, 500, 0.0012
"""Points a segment from which arc length is summed up, points an em of length, and how far off clicks are, in em."""


def polygons_of(
    outline: Outline,
    count: int | None = None,
    step: float | None = None,
    clicked: Sequence[ArrayLike] | None = None,
) -> list[FloatArray]:
    """A polygon for each contour, without vertices that are there twice.

    Args:
        outline: the outline. count, step: as of :func:`glyphspline.sample`; without them clicks are set by a rule.
        clicked: (n, 2) each, in font units, in the place of these.

    Raises:
        OptionError: more than one of the three.
        GlyphsplineError: a polygon that no curve can be put through; it names the glyph and the contour.
    """
    if clicked is not None:
        found: list[ArrayLike] = list(clicked)
    elif count is not None or step is not None:
        found = [sample(contour, count=count, step=step) for contour in outline.contours]
    else:
        em = outline.metrics.units_per_em
        found = [clicks(contour, em, SEED + k) for k, contour in enumerate(outline.contours)]
    polygons = []
    for k, points in enumerate(found):
        try:
            polygons.append(clean_polygon(points)[0])
        except PolygonError as error:
            raise error.locate(glyph=outline.name, contour=k) from None
    return polygons


def clicks(contour: Contour, em: float, seed: int = SEED) -> FloatArray:
    """(n, 2) points as somebody would click them around a contour, in units of about em/1000.

    There are few on straight parts, more at turns, and none quite on the outline. They are set at the point farthest
    from the chord, again and again, until none is farther than ``SAG`` (Ramer, Douglas and Peucker); then each one is
    shaken a little.
    """
    em = min(em, SPECK * float(np.ptp(contour.points, axis=0).max())) or em
    places = np.arange(len(contour) * DENSE + 1) / DENSE
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(contour.at(places), axis=0).T))])
    length = float(along[-1])
    steps = max(64, int(length / em * AN_EM))
    outline = contour.at(np.interp(length * np.arange(steps) / steps, along, places))
    outline = np.roll(outline, -int(np.argmax(outline @ np.array([-1.0, 1.0]))), axis=0)
    opposite = int(np.argmax(np.hypot(*(outline - outline[0]).T)))
    closed = np.concatenate([outline, outline[:1]])
    kept = np.array(_simplified(closed, [(0, opposite), (opposite, steps)], em), dtype=np.int64)
    chosen = _beside_turns(closed[kept], kept, steps, BESIDE * steps * em / length)
    if len(chosen) < 3:
        chosen = np.arange(8) * steps // 8
    off = np.random.default_rng(seed).normal(0, MISSED * em, (len(chosen), 2))
    unit = 10.0 ** np.floor(np.log10(em / 1000))
    return np.rint((closed[chosen] + off) / unit) * unit


def _simplified(line: FloatArray, stretches: list[tuple[int, int]], em: float) -> list[int]:
    """Indices kept of stretches of a line, without the last one of each, in order."""
    kept = []
    while stretches:
        first, last = stretches.pop()
        a, chord = line[first], line[last] - line[first]
        length, offset = float(np.hypot(*chord)), line[first : last + 1] - a
        far = np.abs(offset @ np.array([-chord[1], chord[0]])) / length if length > 0 else np.hypot(*offset.T)
        middle = first + int(np.argmax(far))
        if far.max() <= SAG * em:
            if length <= LONGEST * em:
                kept.append(first)
                continue
            middle = (first + last) // 2
        stretches += [(first, middle), (middle, last)]
    return sorted(kept)


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


def read_clicked(path: Path) -> dict[str, list[FloatArray]]:
    """The polygons of a CSV file with the columns ``COLUMNS``, by glyph, in the order of the file.

    Lines that begin with # are comments.

    Raises:
        GlyphsplineError: it cannot be read, or a line of it is none of such a file.
    """
    with reading(path, GlyphsplineError):
        text = path.read_text(encoding="utf-8-sig")
    lines = csv.reader(line for line in text.splitlines() if line.strip() and not line.startswith("#"))
    if next(lines, None) != COLUMNS:
        raise GlyphsplineError(f"its first line is not {','.join(COLUMNS)}", font=str(path))
    found: dict[str, dict[str, list[list[float]]]] = {}
    for row in lines:
        try:
            glyph, contour, x, y = row
            found.setdefault(glyph, {}).setdefault(contour, []).append([float(x), float(y)])
        except ValueError:
            raise GlyphsplineError(f"no point: {','.join(row)!r}", font=str(path)) from None
    return {glyph: [np.array(points) for points in contours.values()] for glyph, contours in found.items()}
