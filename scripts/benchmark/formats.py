"""Outlines as a font has them, one SVG file a glyph: ``--format source`` beside the exports of fontTools and FontForge.

Times are of whole exports by one process each, from opening the font on, in turn; ours has one worker, and writes a
manifest. FontForge takes many seconds to open such a font, so its export of the same number of glyphs is timed alone,
too. Nothing is removed before all is measured, and the least of several rounds counts, as in :mod:`.batch`.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Sequence
from pathlib import Path
from time import perf_counter

from .batch import FIRST, FONT, fontforge_export, fonttools_export, least, ours, row
from .measure import Row

FEW, MANY = 2000, int(os.environ.get("GLYPHSPLINE_BENCH_GLYPHS", "10000"))
ROUNDS = 3


def rows() -> list[Row]:
    """The table of what it costs to export outlines, a glyph."""
    if not FONT.exists():
        return [Row(f"outlines as they are: {FONT.name} is not there", 0.0, "s")]
    found = []
    with tempfile.TemporaryDirectory() as folder:
        here = Path(folder)
        source(here / "warm", range(FIRST, FIRST + 50))  # nothing is compiled while it is timed
        for count in (FEW, MANY):
            found += compared(here, range(FIRST, FIRST + count))
    return found


def compared(here: Path, gids: Sequence[int]) -> list[Row]:
    """Rows for so many glyphs."""
    count = len(gids)
    opened: list[float] = []

    def forge(k: int) -> float:
        start = perf_counter()
        seconds = fontforge_export(here / f"forge-{count}-{k}", gids)
        opened.append((perf_counter() - start) / count)
        return seconds

    own, fonttools, forged = least(
        ROUNDS,
        lambda k: source(here / f"ours-{count}-{k}", gids),
        lambda k: fonttools_export(here / f"plain-{count}-{k}", gids),
        forge,
    )
    return [
        row(f"`--format source` of {count} glyphs against fontTools' `SVGPathPen`", own, fonttools, 0.5, None),
        row("the same against FontForge's export, its opening not counted", own, forged, 2.5, None),
        row("the same against FontForge's export, its opening counted", own, min(opened), 2.5, None),
    ]


def source(out: Path, gids: Sequence[int]) -> float:
    """Seconds a glyph of our run."""
    from glyphspline.fitting.options import Options

    return ours(out, gids, Options(), ("source",), 1)
