"""How often a written glyph has crossings that its source has not, or contours without area, and is not flagged.

``python scripts/topology.py [--glyphs 60] [--jobs 2] [--faces serif,ukai]``

Glyphs are spread evenly over the ideographs of five faces, of the Debian packages fonts-lxgw-wenkai, fonts-arphic-ukai,
fonts-noto-cjk and fonts-kouzan-mouhitsu, or in a folder of GLYPHSPLINE_FACES; those that are not installed are skipped.
Each is converted with the default options in both modes of corners and both efforts, and ``tests/topology.py``, which
shares nothing with the package, counts in exact arithmetic what went wrong in the text of the SVG, compared with the
font as fontTools reads it. Glyphs where something did once, ``Face.known``, are always among them.

Every defect that is not flagged is listed, then a table: glyphs with new crossings of a contour with itself, with new
crossings of two contours, and with collapsed contours; of all these, glyphs whose measures say all of it, and those
whose measures do not. The exit status is 1 if there are any of the last kind.
"""

from __future__ import annotations

import logging
import sys
import time
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from itertools import product
from pathlib import Path
from typing import Any

from fontTools.ttLib import TTFont

import glyphspline as gs

sys.path.insert(0, str(Path(__file__).parents[1]))
from scripts.survey import faces, parser, surveyed, table
from tests.topology import defects, font_contours, unflagged


@dataclass(frozen=True)
class Face:
    """A face by its file, and the characters of which a glyph went wrong once."""

    name: str
    file: str
    known: str = ""


FACES = (
    Face("LXGW WenKai", "LXGWWenKai-Regular.ttf", "餪"),
    Face("AR PL UKai", "ukai.ttc", "煕犼當藼"),
    Face("Noto Sans CJK", "NotoSansCJK-Regular.ttc", "撇壑毣夆醟"),
    Face("Noto Serif CJK", "NotoSerifCJK-Regular.ttc", "荴槚鶧橾簞袿拏覿陃"),
    Face("Kouzan gyosho", "kouzan-mouhitsu-gyosho.ttf", "龍槌矜隧授"),
)

WAYS: tuple[tuple[Any, Any], ...] = tuple(product(("smooth", "sharp"), ("fast", "best")))


@dataclass(frozen=True)
class Glyph:
    """What went wrong with a glyph in one way of converting it.

    Attributes:
        face, character, way: which it is.
        own, pairs, collapsed: new crossings of contours with themselves and with others, and contours without area.
        silent: in words, what its measures say nothing of.
        seconds: of counting.
    """

    face: str
    character: str
    way: str
    own: int
    pairs: int
    collapsed: int
    silent: tuple[str, ...]
    seconds: float

    @property
    def wrong(self) -> bool:
        """Whether anything went wrong."""
        return bool(self.own or self.pairs or self.collapsed)


@cache
def opened(path: Path) -> tuple[Any, Any, dict[int, str]]:
    """A font through the package, and its glyph set and character map through fontTools."""
    font = TTFont(path, fontNumber=0, lazy=True)
    return gs.open_font(path), font.getGlyphSet(), font.getBestCmap()


def survey(task: tuple[Face, Path, str]) -> list[Glyph]:
    """A glyph in every way."""
    face, path, character = task
    font, glyphs, names = opened(path)
    name = names[ord(character)]
    source, outline = font_contours(glyphs, name), font.outline(name)
    found = []
    for corners, effort in WAYS:
        result = gs.convert(outline, gs.Options(corners=corners, effort=effort))
        text, start = gs.to_svg(result), time.process_time()
        new, collapsed = defects(text, source)
        seconds = time.process_time() - start
        own = sum(count for (i, j), count in new.items() if i == j)
        silent = unflagged(new, collapsed, [contour.measures for contour in result.contours])
        pairs, way = sum(new.values()) - own, f"{corners} {effort}"
        found.append(Glyph(face.name, character, way, own, pairs, len(collapsed), tuple(silent), seconds))
    return found


def tasks(count: int, names: Iterable[str]) -> list[tuple[Face, Path, str]]:
    """So many ideographs of each face, and those that went wrong once."""
    chosen = []
    for face in FACES:
        paths = faces(face.file)
        if not paths or not any(part.lower() in face.name.lower() for part in names):
            continue
        codes = sorted(code for code in opened(paths[0])[2] if 0x4E00 <= code <= 0x9FFF)
        spread = (chr(codes[k * len(codes) // count]) for k in range(min(count, len(codes))))
        chosen += [(face, paths[0], character) for character in dict.fromkeys([*face.known, *spread])]
    return chosen


def table_of(glyphs: list[Glyph]) -> str:
    """A line for each face and way, in Markdown."""
    rows: list[list[object]] = []
    for face, (corners, effort) in product(FACES, WAYS):
        those = [g for g in glyphs if (g.face, g.way) == (face.name, f"{corners} {effort}")]
        if those:
            columns = [(g.own, g.pairs, g.collapsed) for g in those]
            counts = [sum(bool(x) for x in column) for column in zip(*columns, strict=True)]
            silent = sum(bool(g.silent) for g in those)
            flagged = sum(g.wrong for g in those) - silent
            rows.append([face.name, f"{corners} {effort}", len(those), *counts, flagged, silent])
    headings = "face,way,glyphs,cross themselves,cross others,collapsed,all flagged,not flagged"
    return table(headings.split(","), rows)


def main() -> int:
    """Survey the faces, print what is not flagged and the table."""
    options = parser(__doc__)
    options.add_argument("--glyphs", type=int, default=60, help="of each face")
    options.add_argument("--faces", default="", help="parts of names, with commas between them")
    arguments = options.parse_args()
    logging.getLogger("fontTools").setLevel(logging.ERROR)
    found: list[Glyph] = []
    for glyphs in surveyed(survey, tasks(arguments.glyphs, arguments.faces.split(",")), jobs=arguments.jobs, chunk=4):
        found += glyphs
        for glyph in glyphs:
            for words in glyph.silent:
                print(f"{glyph.face} {glyph.character} {glyph.way}: {words}", flush=True)
    if not found:
        print("none of the faces is installed", file=sys.stderr)
        return 2
    print(table_of(found))
    print(f"{1e3 * sum(glyph.seconds for glyph in found) / len(found):.0f} ms to count a glyph's")
    return int(any(glyph.silent for glyph in found))


if __name__ == "__main__":
    sys.exit(main())
