"""Whether glyphs of written fonts are within the bounds that the manifest has of them, measured by another program.

``python -m scripts.bounds [--glyphs 0] [--formats ttf,otf] [--faces garamond,serif] [--jobs 1]``

Faces are those of the Debian packages fonts-dejavu, fonts-ebgaramond, fonts-linuxlibertine and fonts-noto-cjk, or in a
folder of GLYPHSPLINE_FACES; those that are not installed are skipped. Each is written as fonts store outlines in both
formats, all glyphs or so many, and of Noto 2,000, spread evenly. ``tests/farthest.py``, which shares nothing with the
package, then measures each glyph of the written font against the source's, in both directions, as fontTools draws both.

Every glyph beyond its bound is listed, then a table. The exit status is 1 if there are any.
"""

from __future__ import annotations

import json
import logging
import sys
import time
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from fontTools.subset import Options, Subsetter
from fontTools.ttLib import TTFont

import glyphspline as gs
from glyphspline.plugins.fonts.spec import RefitSpec
from glyphspline.runs.convert import convert_font
from tests.farthest import cubics, farthest

from .survey import faces, parser, table


class Face(NamedTuple):
    """A face by its file; ``most`` glyphs of it are looked at, or all."""

    name: str
    file: str
    most: int = 0


FACES = (
    Face("DejaVu Sans", "DejaVuSans.ttf"),
    Face("DejaVu Serif", "DejaVuSerif.ttf"),
    Face("DejaVu Sans Mono", "DejaVuSansMono.ttf"),
    Face("EB Garamond 12", "EBGaramond12-Regular.otf"),
    Face("Linux Libertine", "LinLibertine_R.otf"),
    Face("Linux Biolinum", "LinBiolinum_R.otf"),
    Face("Noto Sans CJK", "NotoSansCJK-Regular.ttc", 2000),
    Face("Noto Serif CJK", "NotoSerifCJK-Regular.ttc", 2000),
)

HEADINGS = (
    "face",
    "format",
    "glyphs",
    "no bound",
    "largest bound",
    "beyond the tolerance",
    "beyond the bound",
    "seconds",
)

SINGLE = 2.0**-22
"""Share of the em by which a source's decimals may be read otherwise: HarfBuzz has single precision."""


class Glyph(NamedTuple):
    """A glyph of a written font.

    Attributes:
        bound: None if the manifest has none. within: whether it is within the tolerance, as is said there.
        seen: a distance seen that is larger than the bound; None if there is none.
    """

    name: str
    bound: float | None
    within: bool
    seen: float | None


def part_of(path: Path, count: int) -> bytes:
    """A font of so many glyphs of another one, spread evenly, and of what they are made of; 0: all."""
    font = TTFont(path, fontNumber=0, lazy=True, recalcBBoxes=False)  # composites are placed by theirs
    names = font.getGlyphOrder()
    if not 0 < count < len(names):
        return path.read_bytes()
    keeping = Options(layout_features=[], hinting=True, glyph_names=True, notdef_outline=True, desubroutinize=False)
    maker = Subsetter(keeping)
    maker.populate(glyphs=[names[k * len(names) // count] for k in range(count)])
    maker.subset(font)
    file = BytesIO()
    font.save(file)
    return file.getvalue()


def written(path: Path, kind: str, folder: Path, jobs: int) -> tuple[list[Glyph], float]:
    """Write a font in a format; its glyphs as they are there, and the seconds that writing took."""
    source, began = gs.open_font(path), time.perf_counter()
    convert_font(source, source.glyph_names, folder, RefitSpec(formats=(kind,)), jobs=jobs)
    seconds = time.perf_counter() - began
    (made,) = folder.glob(f"*.{kind}")
    fonts = TTFont(path), TTFont(made)
    em, drawn = fonts[0]["head"].unitsPerEm, [(font, font.getGlyphSet()) for font in fonts]
    found = []
    for line in (folder / "manifest.jsonl").read_text(encoding="utf-8").splitlines():
        entry = json.loads(line)
        name, facts = entry["glyph"], entry["stored"][kind]
        bound, within = (facts["bound"], facts["within_tolerance"]) if facts else (None, True)
        old, new = (cubics(font, glyphs, font.getGlyphName(entry["gid"])) for font, glyphs in drawn)
        least = 0.0 if bound is None else bound + SINGLE * em
        seen = farthest(old, new, em, least)
        found.append(Glyph(name, bound, within, seen if bound is not None and seen > least else None))
    return found, seconds


def main() -> int:
    """Write the faces, print what is beyond its bound and the table."""
    arguments = parser(__doc__, glyphs=0, formats="ttf,otf", faces="", jobs=1).parse_args()
    logging.getLogger("fontTools").setLevel(logging.ERROR)
    rows: list[list[object]] = []
    wrong = 0
    for face in FACES:
        paths = faces(face.file)
        if not paths or not any(part.lower() in face.name.lower() for part in arguments.faces.split(",")):
            continue
        for kind in arguments.formats.split(","):
            with TemporaryDirectory() as folder:
                part = Path(folder) / f"part{paths[0].suffix.replace('ttc', 'otf')}"
                part.write_bytes(part_of(paths[0], arguments.glyphs or face.most))
                found, seconds = written(part, kind, Path(folder) / "out", arguments.jobs)
            bounds = [each.bound for each in found if each.bound is not None]
            beyond = [each for each in found if each.seen is not None]
            for each in beyond:
                print(f"{face.name} as {kind}, {each.name}: bound {each.bound}, seen {each.seen:.6g}", flush=True)
            wrong += len(beyond)
            rows.append(
                [face.name, kind, len(found), len(found) - len(bounds), max(bounds), len(beyond), f"{seconds:.0f}"]
            )
            print(*rows[-1], flush=True)
    if not rows:
        print("none of the faces is installed", file=sys.stderr)
        return 2
    print(table(HEADINGS, rows))
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
