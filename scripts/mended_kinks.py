"""How many kinks are mended, and how: ``python -m scripts.mended_kinks SOURCE… [--tolerance 1] [--glyphs 300]``.

Sources are fonts, UFOs and designspaces, of which glyphs are chosen at random. Counted are kinks of a degree or more,
at masters or along axes; nothing is written. Glyphs that changed are checked again, at masters and along axes, and
compared with what they were at five random locations each, by sampling. Reasons why kinks are left follow, with
quartiles of what they need where only the tolerance is against it. Lengths are in thousandths of an em; times are of
one process, reading included.
"""

from __future__ import annotations

import time
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np

import glyphspline as gs
from glyphspline.outlines.flaws.kinds import THRESHOLDS
from glyphspline.plugins.masters.designspace import Designspace
from glyphspline.plugins.mending.job import Scope, mend_source
from glyphspline.plugins.mending.state import Change, Tally
from glyphspline.readers import Font, open_source
from glyphspline.readers.ufo import Ufo

from .survey import parser, table

LOCATIONS = 5
"""Of each glyph, at which it is compared with what it was."""


def row(name: str, kinks: list[Change], counts: tuple[float, ...]) -> str:
    """A line of the table, of the kinks of a degree or more and what :func:`of_source` counts."""
    moves = [each.moved for each in kinks if each.is_mended]
    far = sum(move > 3 for move in moves)
    glyphs, *found, spent = counts
    mended = share(len(moves), len(kinks)), share(far, len(moves))
    cells = name, glyphs, len(kinks), *mended, *found, f"{1000 * spent / glyphs:.0f} ms"
    return table([*map(str, cells)]).splitlines()[0]


def share(count: int, of: int) -> str:
    """A number and what share it is."""
    return f"{count} ({count / max(of, 1):.0%})"


def of_source(
    path: Path, tolerance: float, most: int, rng: np.random.Generator
) -> tuple[list[Change], tuple[float, ...]]:
    """Mend glyphs of a source: its kinks; numbers of glyphs, new findings, new points and samples beyond, seconds."""
    source = open_source(path)
    assert isinstance(source, (Font, Ufo, Designspace)), path
    names = [name for name in source.glyph_names if not name.startswith(".")]
    names = [names[k] for k in rng.permutation(len(names))[:most]]
    em = source.outline(names[0]).metrics.units_per_em / 1000
    before = time.process_time()
    found = mend_source(source, names, Scope(tolerance=tolerance * em), dry=True)
    spent = time.process_time() - before
    new = points = beyond = 0
    for old, now in found.drawn.values():
        states = [Tally.of(each, THRESHOLDS, source.outer).found for each in (now, old)]
        new += (states[0] - states[1]).total()
        points += sum(each.points.shape[1] for each in now.contours) - sum(e.points.shape[1] for e in old.contours)
        for _ in range(LOCATIONS):
            at = {axis.tag: rng.uniform(axis.minimum, axis.maximum) for axis in old.axes}
            beyond += gs.compare(old.instance(at), now.instance(at)).seen > tolerance * em
    kinks = [
        replace(each, moved=each.moved / em, needs=each.needs and each.needs / em)
        for each in found.changes
        if each.before >= 1
    ]
    return kinks, (found.glyphs, new, points, beyond, spent)


def reasons(kinks: list[Change]) -> str:
    """Why kinks are left, and what they would need."""
    rows: list[list[object]] = []
    for why, count in Counter(each.why for each in kinks if each.why).most_common():
        needs = [each.needs for each in kinks if each.why == why and each.needs]
        quartiles = [f"{np.quantile(needs, share):.1f}" for share in (0.25, 0.5, 0.75) if needs]
        rows.append([why, count, ", ".join(quartiles)])
    return table(["left, as it", "", "needs"], rows)


def main() -> None:
    """Print the tables."""
    options = parser(__doc__, tolerance=1.0, glyphs=300)
    options.add_argument("sources", nargs="+", type=Path)
    given = options.parse_args()
    headings = ["", "glyphs", "kinks", "mended", "moved by over 3", "new findings", "points added", "beyond", "a glyph"]
    print(table(headings))
    kinks: list[Change] = []
    counts: list[tuple[float, ...]] = []
    for path in given.sources:
        own, found = of_source(path, given.tolerance, given.glyphs, np.random.default_rng(0))
        print(row(path.stem, own, found), flush=True)
        kinks, counts = kinks + own, [*counts, found]
    print(row("all", kinks, tuple(map(sum, zip(*counts, strict=True)))))
    print(f"\n{reasons(kinks)}")


if __name__ == "__main__":
    main()
