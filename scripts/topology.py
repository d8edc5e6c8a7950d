"""How often a written glyph has crossings that its source has not, or contours without area, and is not flagged.

``python -m scripts.topology [--glyphs 60] [--contours 500] [--seed 0] [--jobs 2] [--faces serif,ukai]``

Glyphs are spread evenly over the ideographs of five faces, of the Debian packages fonts-lxgw-wenkai, fonts-arphic-ukai,
fonts-noto-cjk and fonts-kouzan-mouhitsu, or in a folder of GLYPHSPLINE_FACES; those that are not installed are skipped.
Each is converted with the default options in both modes of corners and both efforts, and ``tests/topology.py``, which
shares nothing with the package, counts in exact arithmetic what went wrong in the text of the SVG, compared with the
font as fontTools reads it. Glyphs where something did once, ``Face.known``, are always among them.

``tests/hard_contours.py`` draws contours that are hard to judge, thinner than the tolerance or in tangles. Each is
converted in both modes with three tolerances, and counted in the same way.

Every defect that is not flagged is listed, then a table: glyphs with new crossings of a contour with itself, with new
crossings of two contours, and with collapsed contours; of all these, glyphs whose measures say all of it, and those
whose measures do not. The exit status is 1 if there are any of the last kind.
"""

from __future__ import annotations

import logging
import random
import sys
from collections.abc import Iterable
from functools import cache
from itertools import chain, product
from pathlib import Path
from typing import Any, NamedTuple, get_args

from fontTools.ttLib import TTFont

import glyphspline as gs
from glyphspline.fitting.options import Corners, Effort
from tests.hard_contours import hard_contour, outline_of
from tests.topology import Drawing, defects, font_contours, unflagged

from .survey import faces, parser, surveyed, table


class Face(NamedTuple):
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

MODES: tuple[tuple[Corners, bool], ...] = (("smooth", True), ("smooth", False), ("sharp", True))
"""Corners, and whether their control points are held."""

WAYS = [gs.Options(corners=c, hold_corners=h, effort=e) for (c, h), e in product(MODES, get_args(Effort))]
HARD_WAYS = [gs.Options(corners=c, hold_corners=h, tolerance=t) for (c, h), t in product(MODES, (0.5, 1.0, 5.0))]


class Glyph(NamedTuple):
    """What went wrong with a glyph in one way of converting it.

    Attributes:
        face, character, way: which it is; of what is drawn here, its kind and number.
        wrong: whether contours newly cross themselves, cross others, and have lost their area.
        uncounted: whether the measures say that crossings were not counted.
        silent: in words, what its measures say nothing of.
    """

    face: str
    character: str
    way: str
    wrong: tuple[bool, bool, bool]
    uncounted: bool
    silent: tuple[str, ...]


@cache
def opened(path: Path) -> tuple[Any, Any, dict[int, str]]:
    """A font through the package, and its glyph set and character map through fontTools."""
    font = TTFont(path, fontNumber=0, lazy=True)
    return gs.open_font(path), font.getGlyphSet(), font.getBestCmap()


def survey(task: tuple[Face, Path, str]) -> list[Glyph]:
    """A glyph of a font in every way."""
    face, path, character = task
    font, glyphs, names = opened(path)
    name = names[ord(character)]
    source, outline = font_contours(glyphs, name), font.outline(name)
    return [
        converted(face.name, character, f"{mode(options)} {options.effort}", outline, source, options)
        for options in WAYS
    ]


def hard(number: int) -> list[Glyph]:
    """A hard contour in every way."""
    kind, source = hard_contour(random.Random(number))
    outline = outline_of(kind, source)
    return [
        converted(kind, str(number), f"{mode(options)} {options.tolerance:g}", outline, source, options)
        for options in HARD_WAYS
    ]


def mode(options: gs.Options) -> str:
    """The mode in a word or two."""
    return f"{options.corners}{'' if options.hold_corners else ', corners passed'}"


def converted(face: str, character: str, way: str, outline: gs.Outline, source: Drawing, options: gs.Options) -> Glyph:
    """Convert a glyph, and count what went wrong."""
    result = gs.convert(outline, options)
    new, collapsed = defects(gs.to_svg(result), source)
    measures = [contour.measures for contour in result.contours]
    found = [pair for pair, count in new.items() if count]
    wrong = any(i == j for i, j in found), any(i != j for i, j in found), bool(collapsed)
    uncounted = any(each.new_crossings is None for each in measures)
    return Glyph(face, character, way, wrong, uncounted, tuple(unflagged(new, collapsed, measures)))


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
    for face, way in dict.fromkeys((g.face, g.way) for g in glyphs):
        those = [g for g in glyphs if (g.face, g.way) == (face, way)]
        counts = map(sum, zip(*((*g.wrong, g.uncounted) for g in those), strict=True))
        silent = sum(bool(g.silent) for g in those)
        rows.append([face, way, len(those), *counts, sum(any(g.wrong) for g in those) - silent, silent])
    headings = "glyphs of,way,glyphs,cross themselves,cross others,collapsed,not counted,all flagged,not flagged"
    return table(headings.split(","), rows)


def main() -> int:
    """Survey the faces and hard contours, print what is not flagged and the table."""
    arguments = parser(__doc__, jobs=2, glyphs=60, contours=500, seed=0, faces="").parse_args()
    logging.getLogger("fontTools").setLevel(logging.ERROR)
    found: list[Glyph] = []
    drawn = range(arguments.seed, arguments.seed + arguments.contours)
    for glyphs in chain(
        surveyed(survey, tasks(arguments.glyphs, arguments.faces.split(",")), jobs=arguments.jobs, chunk=4),
        surveyed(hard, drawn, jobs=arguments.jobs, chunk=4),
    ):
        found += glyphs
        for glyph in glyphs:
            for words in glyph.silent:
                print(f"{glyph.face} {glyph.character} {glyph.way}: {words}", flush=True)
    if not found:
        print("none of the faces is installed", file=sys.stderr)
        return 2
    found.sort(key=lambda glyph: (not glyph.way.endswith(("fast", "best")), glyph.face, glyph.way))
    print(table_of(found))
    return int(any(glyph.silent for glyph in found))


if __name__ == "__main__":
    sys.exit(main())
