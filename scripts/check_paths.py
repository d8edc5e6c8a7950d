"""Compare letters on a path with Chromium's textPath, and measure bends.

    apt-get install chromium fonts-dejavu-core fonts-hosny-amiri fonts-noto-core fonts-noto-cjk
    python scripts/check_paths.py

Chromium sets each text at as many pixels as its font has units, so that it rounds no advance, and says where each
character begins and ends. A ligature counts as one letter here and as its characters there: those are left out, and
counted. Exits with 1 if a letter is elsewhere.
"""

from __future__ import annotations

import base64
import os
import shutil
import sys
import tempfile
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
from playwright.sync_api import sync_playwright

import glyphspline as gs
from glyphspline.typesetting.along_path import letters_of

FONTS = Path("/usr/share/fonts")
CASES = (
    ("Latin, accents", FONTS / "truetype/dejavu/DejaVuSerif.ttf", "Ñandú fiévre AV Çelik ÅÖ x"),
    ("Latin, marks", FONTS / "truetype/dejavu/DejaVuSans.ttf", "q\u0301\u0323 x\u0302 e\u0301 combined"),
    ("Arabic, vowels", FONTS / "opentype/fonts-hosny-amiri/Amiri-Regular.ttf", "بِسْمِ ٱللَّٰهِ ٱلرَّحْمَٰنِ"),
    ("Hebrew, points", FONTS / "truetype/noto/NotoSansHebrew-Regular.ttf", "שָׁלוֹם עֲלֵיכֶם"),
    ("Devanagari", FONTS / "truetype/noto/NotoSansDevanagari-Regular.ttf", "क्षत्रिय हिन्दी श्रृंगार"),
    ("Japanese", FONTS / "opentype/noto/NotoSerifCJK-Regular.ttc", "横書きのテスト"),
)
LINES = "M0 0L3 -1.5L11 .5L15 4.5L30 5"
WAVE = "M0 4C4 -4 8 -4 12 4S20 10 24 4"
"""Paths, in em."""

LINES_LIMIT, WAVE_LIMIT = 2e-5, 5e-4
"""Distances in em that count as the same place: on a curve, whose length Chromium takes of chords, half a pixel."""

POSITIONS = """() => {
  const text = document.querySelector("text");
  return [...Array(text.getNumberOfChars()).keys()].map(i => {
    const [a, b] = [text.getStartPositionOfChar(i), text.getEndPositionOfChar(i)];
    return [a.x, a.y, b.x, b.y];
  });
}"""


def apart(page: Any, folder: Path, file: Path, written: str, data: str) -> tuple[float, int, int]:
    """Largest distance of the middles of letters from Chromium's, in em; letters compared, and left out."""
    font = gs.open_font(file)
    em = font.metrics.units_per_em
    encoded = base64.b64encode(file.read_bytes()).decode()
    svg = (
        f'<svg xmlns="http://www.w3.org/2000/svg"><defs><path id="p" transform="scale({em})" d="{data}"/></defs>'
        f'<text font-family="F" font-size="{em}"><textPath href="#p">{written}</textPath></text></svg>'
    )
    (folder / "curve.svg").write_text(svg, encoding="utf-8")
    page.set_content(f"<style>@font-face{{font-family:F;src:url(data:font/ttf;base64,{encoded})}}</style>{svg}")
    page.evaluate("async text => { await document.fonts.load('20px F', text); }", written)
    positions = np.array(page.evaluate(POSITIONS)) * [1, -1, 1, -1]
    layout = gs.layout(font, written)
    path, letters = gs.open_path(folder / "curve.svg#p"), letters_of(layout)
    points, _ = path.at(letters.middle - letters.left.min())
    theirs = positions[letters.character]
    alike = np.abs(np.hypot(*(theirs[:, 2:] - theirs[:, :2]).T) - (letters.right - letters.left)) < 1e-3 * em
    off = np.hypot(*((theirs[:, 2:] + theirs[:, :2]) / 2 - points).T)[alike] / em
    return float(off.max()), int(alike.sum()), int((~alike).sum())


def bent(file: Path, written: str) -> str:
    """What bending the text along the wave takes: segments before and after, distance in em, milliseconds."""
    font = gs.open_font(file)
    em = font.metrics.units_per_em
    layout = gs.layout(font, written)
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "wave.svg").write_text(f'<svg xmlns="http://www.w3.org/2000/svg"><path d="{WAVE}"/></svg>')
        path = gs.open_path(Path(folder) / "wave.svg").scaled(em)
    times = []
    for _ in range(5):
        start = perf_counter()
        outline = gs.bend(layout, path, em / 10000)
        times.append(perf_counter() - start)
    before, after = (sum(map(len, each.contours)) for each in (layout.outline(), outline))
    return f"{before} | {after} | {outline.snapped / em:.1e} | {1000 * min(times):.0f}"


def main() -> int:
    """Print the table."""
    print("| text | letters | left out | from Chromium, on lines | on a wave | segments | bent | measured | ms |")
    print("|---|---|---|---|---|---|---|---|---|")
    wrong = False
    sandbox = [] if hasattr(os, "getuid") and os.getuid() != 0 else ["--no-sandbox"]  # it does not work for root
    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as folder:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=sandbox)
        page = browser.new_page()
        for name, file, written in CASES:
            lines, count, left_out = apart(page, Path(folder), file, written, LINES)
            wave, _, _ = apart(page, Path(folder), file, written, WAVE)
            wrong |= lines > LINES_LIMIT or wave > WAVE_LIMIT
            print(f"| {name} | {count} | {left_out} | {lines:.0e} | {wave:.0e} | {bent(file, written)} |")
        browser.close()
    return int(wrong)


if __name__ == "__main__":
    sys.exit(main())
