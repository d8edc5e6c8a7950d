"""Compare layouts with HarfBuzz's programs: the glyphs and positions of hb-shape, and the places in the SVG of hb-view.

    apt-get install libharfbuzz-bin fonts-dejavu-core fonts-hosny-amiri fonts-noto-core fonts-noto-cjk
    python scripts/check_layout.py

HarfBuzz shapes single runs: a text of mixed directions is given to hb-shape run by run, each with the text around it as
context, in the visual order that is written in the table below. Exits with 1 if anything differs.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

import glyphspline as gs

FONTS = Path("/usr/share/fonts")
DEJAVU = FONTS / "truetype/dejavu/DejaVuSans.ttf"
SERIF = FONTS / "truetype/noto/NotoSerif-Regular.ttf"
AMIRI = FONTS / "opentype/fonts-hosny-amiri/Amiri-Regular.ttf"
NASTALIQ = FONTS / "truetype/noto/NotoNastaliqUrdu-Regular.ttf"
HEBREW = FONTS / "truetype/noto/NotoSansHebrew-Regular.ttf"
DEVANAGARI = FONTS / "truetype/noto/NotoSansDevanagari-Regular.ttf"
CJK = FONTS / "opentype/noto/NotoSerifCJK-Regular.ttc"


class Case(NamedTuple):
    """A text, and its runs from left to right, or from top to bottom: their characters and direction."""

    name: str
    font: Path
    text: str
    runs: Sequence[tuple[str, str]]
    arguments: Mapping[str, Any] = MappingProxyType({})


def alone(name: str, font: Path, text: str, direction: str, **arguments: Any) -> Case:
    """A text that is one run."""
    return Case(name, font, text, [(text, direction)], arguments)


CASES = (
    alone("Latin, kerning", DEJAVU, "AVATAR To. Type WAVE", "ltr"),
    alone("Latin, ligatures", DEJAVU, "office fluffy affliction", "ltr"),
    alone("Latin, features", SERIF, "Office 1/2 AVATAR", "ltr", features="-kern,-liga,smcp"),
    alone("Latin, marks", DEJAVU, "q\u0301\u0323 x\u0302 e\u0301", "ltr"),
    alone("Arabic", AMIRI, "السلام عليكم ورحمة الله", "rtl"),
    alone("Arabic, vowels", AMIRI, "بِسْمِ ٱللَّٰهِ ٱلرَّحْمَٰنِ", "rtl"),
    alone("Urdu, Nastaliq", NASTALIQ, "یہ ایک مثال ہے", "rtl", language="ur"),
    alone("Hebrew, points", HEBREW, "שָׁלוֹם עֲלֵיכֶם", "rtl"),
    alone("Devanagari", DEVANAGARI, "क्षत्रिय हिन्दी र्कि श्रृंगार", "ltr"),
    alone("Japanese, vertical", CJK, "「縦書き」は、ー（テスト）。", "ttb", language="ja"),
    alone("Japanese", CJK, "横書きの「テスト」です。", "ltr", language="ja"),
    Case("mixed, Latin first", AMIRI, "abc سلام def", [("abc ", "ltr"), ("سلام", "rtl"), (" def", "ltr")]),
    Case("mixed, number", AMIRI, "سلام 123 عليكم", [(" عليكم", "rtl"), ("123", "ltr"), ("سلام ", "rtl")]),
)


class Placed(NamedTuple):
    """Glyphs, clusters and origins, in visual order."""

    gids: list[int]
    clusters: list[int]
    origins: np.ndarray[Any, Any]


def by_hb_shape(case: Case) -> Placed:
    """The glyphs of a case by hb-shape, run by run."""
    gids: list[int] = []
    clusters: list[int] = []
    origins, pen = [], np.zeros(2)
    for text, direction in case.runs:
        at = case.text.index(text)
        around = [f"--text-before={case.text[:at]}", f"--text-after={case.text[at + len(text) :]}"]
        command = ["hb-shape", "--no-glyph-names", "--output-format=json", *around, *given(case, text, direction)]
        for glyph in json.loads(subprocess.run(command, capture_output=True, check=True).stdout):
            gids.append(glyph["g"])
            clusters.append(glyph["cl"] + at)
            origins.append(np.add(pen, [glyph["dx"], glyph["dy"]]))
            pen = np.add(pen, [glyph["ax"], glyph["ay"]])
    return Placed(gids, clusters, np.array(origins))


def by_hb_view(case: Case) -> np.ndarray[Any, Any] | None:
    """(n, 2) where the SVG of hb-view puts the glyphs of a text of one run, y up; from the first on."""
    if len(case.runs) > 1:
        return None
    size = f"--font-size={gs.open_font(case.font).metrics.units_per_em:g}"
    command = ["hb-view", "--output-format=svg", size, "--margin=0", *given(case, *case.runs[0])]
    drawing = subprocess.run(command, capture_output=True, check=True, text=True).stdout
    places = re.findall(r'<use xlink:href="#[^"]*" x="([^"]*)" y="([^"]*)"', drawing)
    found = np.array(places, dtype=np.float64) * [1.0, -1.0]
    return found - found[0]


def given(case: Case, text: str, direction: str) -> list[str]:
    """Arguments of both programs."""
    options = [f"--{name}={value}" for name, value in case.arguments.items() if name in ("features", "language")]
    return [f"--direction={direction}", *options, f"--font-file={case.font}", f"--text={text}"]


def by_layout(case: Case) -> Placed:
    """The glyphs of a case by this package."""
    direction: Any = "ttb" if case.runs[0][1] == "ttb" else None
    found = gs.layout(gs.open_font(case.font), case.text, direction=direction, **case.arguments)
    if found.missing:
        raise SystemExit(f"{case.name}: the font lacks {found.missing}")
    return Placed(found.gid.tolist(), found.cluster.tolist(), found.origin)


def main() -> int:
    """Print the table."""
    for program in ("hb-shape", "hb-view"):
        if not shutil.which(program):
            raise SystemExit(f"{program} is not installed")
    print("| text | glyphs | same glyphs and clusters | from hb-shape | from hb-view's SVG |")
    print("|---|---|---|---|---|")
    good = True
    for case in CASES:
        if not case.font.exists():
            print(f"| {case.name} | | {case.font.name} is not installed | | |")
            continue
        ours, theirs, drawn = by_layout(case), by_hb_shape(case), by_hb_view(case)
        same = ours.gids == theirs.gids and ours.clusters == theirs.clusters
        apart = float(np.abs(ours.origins - theirs.origins).max()) if same else float("nan")
        from_view = "none: several runs"
        if drawn is not None:
            shown = ours.origins - ours.origins[0]
            off = float(np.abs(drawn - shown).max()) if len(drawn) == len(shown) else float("nan")
            good &= off < 0.01
            from_view = f"{off:.2g}"
        good &= same and apart < 1e-9
        print(f"| {case.name} | {len(ours.gids)} | {'yes' if same else 'NO'} | {apart:.2g} | {from_view} |")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
