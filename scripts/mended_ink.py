"""Whether mending keeps ink: ``python -m scripts.mended_ink SOURCE… [--tolerance 1] [--glyphs 300] [--kinds each]``.

Sources are UFOs and fonts. Copies of them are mended, each kind by itself and then all together, and read again by
fontTools alone. Of every glyph that is drawn otherwise than before, composites too, pictures are made: a point is black
where the contours wind around it, by where they cross its row. Counted are glyphs whose pictures differ by more than
the tolerance times the length of the outline, or by an island or a counter of two pixels and more. Lengths are in
thousandths of an em, of which each has ``--pixels``. ``--kinds`` are those between commas, ``each`` of them, ``all``
together, or both without it; ``--pictures FOLDER`` gets what differs, and ten others, in red and blue. ``--check``
counts new findings of all kinds besides.
"""

from __future__ import annotations

import tempfile
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from fontTools.ttLib import TTFont
from fontTools.ufoLib import UFOReader
from scipy.ndimage import label

from glyphspline.curves.bezier import evaluate
from glyphspline.outlines.flaws.kinds import MENDED
from glyphspline.plugins.checks.check import check_many
from glyphspline.plugins.mending.ink import INK
from glyphspline.plugins.mending.job import MendedSource, Scope, mend_source
from glyphspline.readers import Font, open_source
from glyphspline.readers.ufo import Ufo
from glyphspline.types import BoolArray, FloatArray

from .survey import SegmentPen, parser, table

Segments = list[list[FloatArray]]

CHORDS = 24
"""Chords a curve."""

CENTRE = 0.5 + 0.0361
"""Where in a pixel a point is looked at: not where a grid of points has its lines."""


def drawings(path: Path) -> dict[str, Segments]:
    """The segments of all glyphs of a UFO or font, components decomposed."""
    glyphs: Any
    if path.is_dir():
        glyphs = UFOReader(path).getGlyphSet()
        names = list(glyphs.keys())
    else:
        font = TTFont(path)
        glyphs, names = font.getGlyphSet(), font.getGlyphOrder()
    found = {}
    for name in names:
        pen = SegmentPen(glyphs)
        glyphs[name].draw(pen)
        found[name] = pen.contours
    return found


def polygons(contours: Segments) -> list[FloatArray]:
    """The contours as polygons (n, 2), by chords."""
    found = []
    for segments in contours:
        parts = [np.empty((0, 2))]
        for segment in segments:
            t = np.arange(CHORDS if len(segment) > 2 else 1) / CHORDS
            parts.append(evaluate(np.broadcast_to(segment, (len(t), *segment.shape)), t))
        found.append(np.concatenate(parts))
    return found


def picture(lines: Sequence[FloatArray], low: FloatArray, size: tuple[int, int], pixel: float) -> BoolArray:
    """(height, width) which points of a grid the polygons wind around, as nonzero fills them."""
    turns = np.zeros((size[0], size[1] + 1), dtype=np.int16)
    for points in lines:
        scaled = (points - low) / pixel - CENTRE
        for a, b in zip(scaled, np.roll(scaled, -1, axis=0), strict=True):
            (ax, ay), (bx, by) = (a, b) if a[1] < b[1] else (b, a)
            rows = np.arange(int(np.ceil(ay)), int(np.ceil(by)))
            x = np.ceil(ax + (rows - ay) / max(by - ay, 1e-300) * (bx - ax)).astype(np.int64)
            np.add.at(turns, (rows, np.clip(x, 0, size[1])), 1 if a[1] < b[1] else -1)
    return turns.cumsum(axis=1, dtype=np.int16)[:, :-1] != 0


def parts(black: BoolArray) -> int:
    """How many parts hang together of what is black, without those that are thinner than two pixels everywhere."""
    labels, count = label(black)
    corner = labels[:-1, :-1]
    thick = (labels[1:, :-1] == corner) & (labels[:-1, 1:] == corner) & (labels[1:, 1:] == corner)
    return int((np.bincount(corner[thick], minlength=count + 1)[1:] > 0).sum())


class Ink:
    """How the ink of two drawings differs.

    Attributes:
        pictures: of both. area: of what only one has, as a share of the length of the first. islands, counters: of
            both. differs: whether it is more than the tolerance, or an island or a counter.
    """

    def __init__(self, before: Segments, after: Segments, pixel: float, tolerance: float) -> None:
        both = [polygons(each) for each in (before, after)]
        every = np.concatenate([np.zeros((1, 2)), *both[0], *both[1]])
        low, high = every.min(axis=0) - 3 * pixel, every.max(axis=0) + 3 * pixel
        width, height = np.ceil((high - low) / pixel).astype(int).tolist()
        self.pictures = [picture(each, low, (height, width), pixel) for each in both]
        length = sum(float(np.hypot(*(np.roll(each, -1, axis=0) - each).T).sum()) for each in both[0])
        self.area = float((self.pictures[0] != self.pictures[1]).sum()) * pixel**2 / max(length, pixel)
        self.islands = [parts(each) for each in self.pictures]
        self.counters = [parts(~each) - 1 for each in self.pictures]
        parts_differ = self.islands[0] != self.islands[1] or self.counters[0] != self.counters[1]
        self.differs = self.area > tolerance or parts_differ

    def save(self, path: Path) -> None:
        """What is in both in grey, only in the first in red, only in the second in blue."""
        from PIL import Image

        one, other = self.pictures
        colours = np.full((*one.shape, 3), 255, dtype=np.uint8)
        colours[one & other], colours[one & ~other], colours[~one & other] = (150, 150, 150), (255, 0, 0), (0, 0, 255)
        Image.fromarray(np.ascontiguousarray(colours[::-1])).save(path)


def mended(
    source: Ufo | Font, names: Sequence[str], kinds: Sequence[str], tolerance: float, copy: Path
) -> MendedSource:
    """A copy of a source with its glyphs mended."""
    return mend_source(source, names, Scope(kinds, tolerance), copy=copy)


def new_findings(source: Ufo | Font, copy: Path, names: Sequence[str]) -> Counter[str]:
    """The findings of glyphs in a copy by their kinds, beyond those of the source."""
    other, found = open_source(copy), Counter[str]()
    for name in names:
        before, after = (check_many([each.outline(name)], outer=source.outer)[0] for each in (source, other))
        found += Counter(each.kind for each in after) - Counter(each.kind for each in before)
    return found


def rows(path: Path, given: Any) -> Iterator[list[object]]:
    """A row of the table for each way to mend a source."""
    source = open_source(path)
    assert isinstance(source, (Ufo, Font)), path
    em = source.metrics.units_per_em / 1000
    names = [name for name in source.glyph_names if not name.startswith(".")]
    rng = np.random.default_rng(0)
    names = [names[k] for k in rng.permutation(len(names))[: given.glyphs]]
    ways = {"": [*([kind] for kind in MENDED), [*MENDED]], "each": [[kind] for kind in MENDED], "all": [[*MENDED]]}
    before = drawings(path)
    for kinds in ways.get(given.kinds, [given.kinds.split(",")]):
        with tempfile.TemporaryDirectory() as folder:
            copy, began = Path(folder) / path.name, time.process_time()
            found = mended(source, names, kinds, given.tolerance * em, copy)
            spent = time.process_time() - began
            after = drawings(copy)
            changed = [name for name in before if not alike(before[name], after[name])]
            new = new_findings(source, copy, found.changed) if given.check else Counter[str]()
            worst, wrong = 0.0, []
            for number, name in enumerate(changed):
                ink = Ink(before[name], after[name], em / given.pixels, given.tolerance * em)
                worst = max(worst, ink.area / em)
                if ink.differs:
                    wrong.append(name)
                    print(path.name, kinds, name, ink.area / em, ink.islands, ink.counters, flush=True)
                if given.pictures and (ink.differs or number < 10):
                    ink.save(Path(given.pictures) / f"{path.stem}-{'-'.join(kinds[:2])}-{name}.png")
        left = sum((change.why or "").startswith(INK) for change in found.left)
        yield [
            path.stem, ", ".join(kinds) if len(kinds) < len(MENDED) else "all", len(found.changed), len(found.mended),
            left, len(changed) - len(found.changed), len(wrong), f"{worst:.2f}", dict(new) or "",
            f"{1000 * spent / max(len(names), 1):.0f} ms",
        ]  # fmt: skip


def alike(one: Segments, other: Segments) -> bool:
    """Whether two drawings have the same points."""
    flat = [[segment.tolist() for contour in each for segment in contour] for each in (one, other)]
    return flat[0] == flat[1]


def main() -> int:
    """Print the table; 1 if the ink of a glyph changed."""
    options = parser(__doc__, tolerance=1.0, glyphs=300, pixels=2.0, kinds="", pictures="", check=False)
    options.add_argument("sources", nargs="+", type=Path)
    given = options.parse_args()
    if given.pictures:
        Path(given.pictures).mkdir(parents=True, exist_ok=True)
    headings = [
        "", "kinds", "glyphs changed", "mended", "left for their ink", "composites changed", "ink changed",
        "largest area / length", "new findings", "a glyph",
    ]  # fmt: skip
    print(table(headings))
    wrong = 0
    for path in given.sources:
        for row in rows(path, given):
            wrong += int(str(row[6]))
            print(table(list(map(str, row))).splitlines()[0], flush=True)
    return int(wrong > 0)


if __name__ == "__main__":
    raise SystemExit(main())
