"""Every face that is installed, read by HarfBuzz in bulk and by fontTools: equal, or listed with what differs.

    python scripts/compare_readers.py
    GLYPHSPLINE_FACES=FOLDER:FOLDER python scripts/compare_readers.py --every 12

Variable fonts are read at their default and at each named instance, or without these at both ends of each axis.
HarfBuzz has coordinates in single precision, and does not round them where fontTools does, in components and instances:
up to that they are equal. Of a char string's move without a line after it HarfBuzz says nothing. The exit status is 1
if any glyph differs.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import repeat
from pathlib import Path
from typing import NamedTuple

import numpy as np

from glyphspline.errors import FontError, GlyphsplineError
from glyphspline.outlines.outline import Contour, Outline
from glyphspline.readers import Font
from glyphspline.readers.opentype.font import open_faces, open_font
from glyphspline.readers.opentype.routes import HarfBuzz
from glyphspline.readers.pens import ContourPen
from glyphspline.types import FloatArray
from scripts.survey import faces, parser, surveyed, table

SUFFIXES = ("ttf", "otf", "ttc", "otc", "woff", "woff2")

LARGE = 5000
"""Glyphs of a face from which only every 50th is read."""

EXACT, NEAR = 1e-6, 2e-3
"""In em/1000: what counts as the same number, and as the same but for single precision."""

ROUNDED = 0.75
"""In font units, each coordinate: fontTools rounds components, and points of instances."""


class Found(NamedTuple):
    """What was found in a file: counts by kind, and a line for each glyph that differs."""

    counts: Counter[str]
    lines: list[str]


def look(path: Path, every: int) -> Found:
    """Compare the glyphs of all faces of a file, at all named instances."""
    counts, lines = Counter[str](), list[str]()
    try:
        for index, location in places(path):
            font = open_font(path, index, location)
            counts["variable" if location else "faces"] += 1
            step = max(every, 50 if font.num_glyphs > LARGE else 1)
            kinds = Counter[str]()
            for name, kind in compared(font, font.glyph_names[::step]):
                kinds[kind.partition(":")[0]] += 1
                if kind.startswith("differs"):
                    lines.append(f"{path.name} {index} {dict(location)} {name}: {kind}")
            counts.update(kinds)
    except FontError as error:
        counts["not opened"] += 1
        lines.append(f"not opened: {error}")
    return Found(counts, lines)


def places(path: Path) -> Iterator[tuple[int, dict[str, float]]]:
    """The faces of a file, each at its default and at its named instances."""
    for font in open_faces(path):
        yield font.face_index, {}
        known = {tuple(axis.default for axis in font.axes)}
        ends = [{axis.tag: end} for axis in font.axes for end in (axis.minimum, axis.maximum)]
        for instance in font.instances.values() or ends:
            place = tuple(instance.get(axis.tag, axis.default) for axis in font.axes)
            if place not in known:
                known.add(place)
                yield font.face_index, dict(instance)


def compared(font: Font, names: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Each glyph, and how the two readings of it compare."""
    other = HarfBuzz(font.path, font.face_index, font.location).fonttools
    for name, outline in zip(names, font.outlines(names, errors="return"), strict=True):
        try:
            pen, advance = other.draw(name)
        except Exception as error:
            kind = (
                "both refuse" if isinstance(outline, GlyphsplineError) else f"differs: only fontTools fails: {error!r}"
            )
            yield name, kind
            continue
        if isinstance(outline, GlyphsplineError):
            yield name, f"differs: only HarfBuzz fails: {outline.message}"
        else:
            yield name, kind_of(outline, pen, advance)


def kind_of(outline: Outline, pen: ContourPen, advance: float) -> str:
    """How two readings of a glyph compare: "equal", "equal up to …", or "differs: …"."""
    if abs(outline.advance - advance) > 1:
        return f"differs: advance {outline.advance:g}, {advance:g}"
    if len(outline.contours) != len(pen.contours):
        return f"differs: {len(outline.contours)} contours, {len(pen.contours)}"
    if set(outline.notes) - set(pen.notes):
        return f"differs: notes {outline.notes}, {pen.notes}"
    more = ", but for a lone move" * (outline.notes != pen.notes)
    worst = 0.0
    for number, (own, its) in enumerate(zip(outline.contours, pen.contours, strict=True)):
        if len(own.degrees) != len(its.degrees):
            return f"differs: contour {number} has {len(own.degrees)} segments, {len(its.degrees)}"
        worst = max(worst, apart(own, its))
    unit = outline.metrics.units_per_em / 1000
    if worst <= EXACT * unit:
        return f"equal{more}"
    if worst <= NEAR * unit:
        return f"equal in single precision{more}"
    return f"equal up to rounding{more}" if worst <= ROUNDED else f"differs: by {worst:.3g} units"


def apart(own: Contour, its: Contour) -> float:
    """The largest distance of coordinates of two contours of as many segments, wherever they begin."""
    a, b = own.cubics(), its.cubics()
    if own.degrees.tolist() == its.degrees.tolist() and (found := spread(a, b)) <= ROUNDED:
        return found
    near = np.argsort(np.abs(b[:, 0] - a[0, 0]).max(axis=1))[:8]
    return min(spread(a, np.roll(b, -int(k), axis=0)) for k in near)


def spread(a: FloatArray, b: FloatArray) -> float:
    """The largest difference of two arrays."""
    return float(np.abs(a - b).max(initial=0.0))


def main() -> int:
    """The command."""
    options = parser(__doc__)
    options.add_argument(
        "--every", type=int, default=1, help="compare every Nth glyph (1), of large faces every 50th at least"
    )
    options.add_argument("--lines", type=int, default=40, help="glyphs that differ, listed (40)")
    given = options.parse_args()
    files = sorted({path.resolve() for suffix in SUFFIXES for path in faces(f"*.{suffix}")})
    counts, lines = Counter[str](), list[str]()
    for path, found in zip(files, surveyed(look, files, repeat(given.every), jobs=given.jobs), strict=True):
        counts.update(found.counts)
        lines += found.lines
        if found.lines:
            print(f"{path.name}: {len(found.lines)} differ", file=sys.stderr)
    print(table(("kind", "number"), [("files", len(files)), *sorted(counts.items())]))
    print("\n".join(lines[: given.lines]))
    return int(counts["differs"] > 0)


if __name__ == "__main__":
    sys.exit(main())
