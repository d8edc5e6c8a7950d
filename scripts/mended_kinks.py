"""How many kinks are mended, and how: ``python scripts/mended_kinks.py SOURCE…`` for fonts, UFOs and designspaces.

Of each source it mends glyphs that have a kink of a degree or more, at masters or along axes, and nothing is written.
Mended glyphs are checked again, and compared with what they were at random locations, by sampling. With ``--planted``
kinks of 2° to 10° are planted in the faces of ``scripts/planted_faults.py`` and the mended outlines are compared with
the clean ones. Lengths are in thousandths of an em.
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib import get_data_path

import glyphspline as gs
from glyphspline.checks.kinds import THRESHOLDS
from glyphspline.mending.mend import mended
from glyphspline.mending.state import Into, State
from glyphspline.outlines.masters import Masters
from glyphspline.outlines.outline import Contour
from glyphspline.readers import Font, open_source

sys.path.insert(0, str(Path(__file__).parents[1]))
from scripts.planted_faults import FACES, cubics_of, planted
from scripts.survey import faces, parser, table

FAULTS = [*(f"kink of {d}°" for d in (2, 3, 5, 8, 10)), *(f"line into curve, {d}°" for d in (2, 3, 5))]


def of_source(path: Path, tolerance: float, most: int, rng: np.random.Generator) -> list[object]:
    """A row of the table: what becomes of the kinks of a source."""
    source = open_source(path)
    into = Into(step=1.0) if isinstance(source, Font) and source.outer < 0 else Into()
    names = [name for name in source.glyph_names if not name.startswith(".")]
    changes, new, beyond, glyphs, spent = [], 0, 0, 0, 0.0
    for name in [names[k] for k in rng.permutation(len(names))]:
        masters = source.masters(name)
        if isinstance(masters, Masters) and masters.contours and glyphs < most:
            glyphs, em = glyphs + 1, masters.metrics.units_per_em / 1000
            before = time.process_time()
            found, own = mended(masters, ["kink"], tolerance * em, THRESHOLDS, source.outer, into)
            spent += time.process_time() - before
            changes += [(change, change.moved / em) for change in own if change.before >= 1]
            if found is not masters:
                states = [State.of(each, THRESHOLDS, source.outer).found for each in (found, masters)]
                new += (states[0] - states[1]).total()
                for _ in range(5):
                    at = {axis.tag: rng.uniform(axis.minimum, axis.maximum) for axis in masters.axes}
                    beyond += gs.compare(masters.instance(at), found.instance(at)).seen > tolerance * em
    done = [moved for change, moved in changes if change.is_mended]
    far = sum(moved > 3 for moved in done)
    return [
        source.family, glyphs, len(changes), f"{len(done)} ({len(done) / max(len(changes), 1):.0%})",
        f"{far} ({far / max(len(done), 1):.0%})", new, beyond, f"{1000 * spent / max(glyphs, 1):.0f} ms",
    ]  # fmt: skip


def of_planted(tolerance: float, each: int, rng: np.random.Generator) -> list[list[object]]:
    """Rows of the table: what becomes of kinks planted in real outlines."""
    count, done, near, new = (Counter[str]() for _ in range(4))
    for face in FACES:
        font = gs.open_font([*faces(face), *Path(get_data_path(), "fonts", "ttf").glob(face)][0])
        outlines = [o for o in font.outlines(font.select(text="".join(map(chr, range(33, 127))))) if o.contours]
        for fault in FAULTS:
            left = each
            for k in rng.permutation(len(outlines)):
                clean = cubics_of(outlines[k])
                em = clean.metrics.units_per_em / 1000
                made = planted([list(c.segments()) for c in clean.contours], 1000 * em, gs.check(clean), fault, rng)
                if made is None or not left:
                    continue
                outline = replace(clean, contours=[Contour.from_segments(segments) for segments in made[0]])
                found, changes = gs.mend(outline, ["kink"], tolerance * em)
                own = [change for change in changes if np.allclose(change.point, made[1].point)]
                if own:
                    left, count[fault], done[fault] = left - 1, count[fault] + 1, done[fault] + own[0].is_mended
                    near[fault] += own[0].is_mended and gs.compare(clean, found).bound <= 2 * em
                    kinds = [Counter((f.kind, f.contour, f.segment) for f in gs.check(o)) for o in (found, outline)]
                    new[fault] += (kinds[0] - kinds[1]).total()
    rows = [[name, count[name], done[name], near[name], new[name]] for name in FAULTS]
    return [
        *rows,
        ["all", count.total(), done.total(), f"{near.total()} ({near.total() / count.total():.0%})", new.total()],
    ]


def main() -> None:
    """Print the tables."""
    options = parser(__doc__, jobs=False)
    options.add_argument("sources", nargs="*", type=Path)
    options.add_argument("--tolerance", type=float, default=1.0, help="thousandths of an em")
    options.add_argument("--glyphs", type=int, default=200, help="of each source, chosen at random")
    options.add_argument("--planted", type=int, default=0, help="of each fault in each face")
    given = options.parse_args()
    rng = np.random.default_rng(0)
    if given.sources:
        headings = [
            "family",
            "glyphs",
            "kinks of 1° or more",
            "mended",
            "moved by more than 3",
            "new findings",
            "beyond",
        ]
        rows = [of_source(path, given.tolerance, given.glyphs, rng) for path in given.sources]
        print(table([*headings, "a glyph"], rows))
    if given.planted:
        rows = of_planted(given.tolerance, given.planted, rng)
        print(table(["planted", "", "mended", "within 2 of the clean outline", "new findings"], rows))


if __name__ == "__main__":
    main()
