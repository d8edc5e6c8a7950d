"""Render the README's pictures into ``outputs/pictures/``, in a headless Chromium: ``python scripts/make_pictures.py``.

Needs Debian's chromium and the extra ``browser``. Everything shown is made by the tools themselves, from the fonts in
``fonts_test/``.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from io import BytesIO
from pathlib import Path
from typing import Any

from PIL import Image
from playwright.sync_api import sync_playwright

import glyphspline as gs
from glyphspline.fitting.options import Corners

ROOT = Path(__file__).resolve().parent.parent
FONTS = ROOT / "fonts_test"
PROGRAM = [sys.executable, "-m", "glyphspline"]

PAIR = """
body { margin: 0; background: #fff; font: 17px 'DejaVu Sans', sans-serif; display: flex; gap: 10px; color: #222 }
figure { margin: 0; width: 490px } svg { width: 490px; height: 520px }
figcaption { text-align: center; padding: 0 0 14px }
"""

LINE = """
body { margin: 0; background: #fff }
svg { display: block; width: 950px; height: 200px; margin: 10px 20px; overflow: visible }
"""


def main() -> None:
    """All pictures, one after the other. The first one is that of the demonstration."""
    gs.experiment(outline("kouzan-gyosho.ttf", "龍")).save(
        ROOT / "outputs/pictures/dragon.png", "Kouzan Gyosho Subset Regular"
    )
    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as place:
        sandbox = [] if os.getuid() else ["--no-sandbox"]
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=sandbox)
        for picture in (corners, text, gallery, viewer, checks):
            page = browser.new_page(viewport={"width": 1280, "height": 800}, device_scale_factor=1.25)
            picture(page, Path(place))
            # 256 colours: drawings do not miss the others, and take a third of the bytes.
            with Image.open(BytesIO(page.screenshot())) as image:
                few = image.convert("RGB").quantize(256, dither=Image.Dither.NONE)
                few.save(ROOT / "outputs" / "pictures" / f"{picture.__name__}.png", optimize=True)
            page.close()
        browser.close()


def corners(page: Any, _: Path) -> None:
    """One closed curve a contour, and arcs between corners."""
    found = {}
    captions: dict[Corners, str] = {"smooth": "smooth: one C2 curve a contour", "sharp": "sharp: arcs between corners"}
    for kind, words in captions.items():
        glyph = gs.convert(outline("kouzan-gyosho.ttf", "好"), gs.Options(corners=kind, tolerance=2.0))
        count = sum(contour.measures.segments for contour in glyph.contours)
        found[gs.to_curvature_svg(glyph, scale=0.008)] = f"{words}, {count} segments"
    side_by_side(page, found)


def text(page: Any, _: Path) -> None:
    """A line of characters, and their curvature."""
    line = gs.layout(gs.open_font(FONTS / "kouzan-kaisho.ttf"), "龍好AgO永善")
    result = line.convert(gs.Options(tolerance=2.0))
    drawings = gs.to_svg(result, view_box="ink"), gs.to_curvature_svg(result, vertices=False)
    page.set_content(f"<style>{LINE}</style>{''.join(drawings)}")
    page.set_viewport_size({"width": 990, "height": 440})


def gallery(page: Any, place: Path) -> None:
    """The gallery of a font, and one glyph of it zoomed into."""
    made(page, place / "index.html", "convert", FONTS / "kouzan-gyosho.ttf", "--all", "--out", place, "--quiet")
    page.keyboard.press("s")
    page.keyboard.press("c")
    page.wait_for_timeout(800)


def viewer(page: Any, _: Path) -> None:
    """The viewer with the three variants side by side; the font's path is relative, as it stands in the picture."""
    command = [*PROGRAM, "view", "fonts_test/kouzan-gyosho.ttf", "--no-browser"]
    with subprocess.Popen(command, cwd=ROOT, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        page.emulate_media(color_scheme="dark")
        page.goto(process.stderr.readline().split()[0])
        page.fill("#words", "g")
        page.wait_for_selector("#picture .result", state="attached")
        page.locator("[name=preset][value=paper]").check(force=True)
        page.locator("#compare").check()
        for layer in ("comb", "control"):
            page.locator(f"[data-layer={layer}]").check(force=True)
        page.fill("#text", "龍好 Ag8")
        page.wait_for_selector("#text-line use")
        page.wait_for_selector("#compared figure")
        page.wait_for_load_state("networkidle")
        page.wait_for_timeout(1500)
        process.terminate()


def checks(page: Any, place: Path) -> None:
    """The page of what is found in a font."""
    findings = place / "findings.html"
    made(page, findings, "check", FONTS / "kouzan-gyosho.otf", "--html", findings, "--quiet")
    page.wait_for_timeout(1500)


def made(page: Any, what: Path, *arguments: str | Path) -> None:
    """Open a page that a command makes."""
    subprocess.run([*PROGRAM, *map(str, arguments)], check=True)
    page.goto(what.as_uri())
    page.wait_for_selector("body[data-ready]")


def outline(font: str, text: str) -> gs.Outline:
    """A glyph of one of the repository's fonts."""
    source = gs.open_font(FONTS / font)
    return source.outline(source.select(text=text)[0])


def side_by_side(page: Any, drawings: dict[str, str]) -> None:
    """Drawings in a row with their captions."""
    figures = "".join(f"<figure>{svg}<figcaption>{words}</figcaption></figure>" for svg, words in drawings.items())
    page.set_content(f"<style>{PAIR}</style>{figures}")
    page.set_viewport_size({"width": 990, "height": 570})


if __name__ == "__main__":
    main()
