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
from collections.abc import Iterator
from contextlib import contextmanager
from html import escape
from io import BytesIO
from pathlib import Path
from typing import Any

from PIL import Image
from playwright.sync_api import sync_playwright

import glyphspline as gs
from glyphspline.fitting.options import PRESETS, Corners

ROOT = Path(__file__).resolve().parent.parent
FONTS = ROOT / "fonts_test"
OUT = ROOT / "outputs" / "pictures"

PAIR = """
body { margin: 0; background: #fff; font: 17px 'DejaVu Sans', sans-serif; display: flex; gap: 10px; color: #222 }
figure { margin: 0; width: 490px } svg { width: 490px; height: 520px }
figcaption { text-align: center; padding: 0 0 14px }
"""

LINE = """
body { margin: 0; background: #fff }
svg { display: block; width: 950px; height: 270px; margin: 5px 20px; overflow: visible }
.wave { fill: none; stroke: #d33; stroke-width: 12 }
"""

WORDS = "永善好龍永善好"


def main() -> None:
    """All pictures, one after the other."""
    OUT.mkdir(parents=True, exist_ok=True)
    with sync_playwright() as playwright:
        sandbox = [] if os.getuid() else ["--no-sandbox"]
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=sandbox)
        for picture in (dragon, corners, text, gallery, viewer, checks):
            context = browser.new_context(viewport={"width": 1280, "height": 800}, device_scale_factor=1.25)
            picture(context.new_page())
            context.close()
        browser.close()


def dragon(page: Any) -> None:
    """The Dragon and its curvature comb."""
    glyph = gs.convert(outline("kouzan-kaisho.ttf", "龍"), gs.Options(tolerance=2.0, **PRESETS["paper"]))
    drawing = gs.to_curvature_svg(glyph, vertices=False)
    side_by_side(page, "dragon", [("", gs.to_svg(glyph, view_box="ink")), ("", drawing)])


def corners(page: Any) -> None:
    """One closed curve a contour, and arcs between corners."""
    found = []
    captions: dict[Corners, str] = {"smooth": "smooth: one C2 curve a contour", "sharp": "sharp: arcs between corners"}
    for kind, words in captions.items():
        glyph = gs.convert(outline("kouzan-gyosho.ttf", "好"), gs.Options(corners=kind, tolerance=2.0))
        count = sum(contour.measures.segments for contour in glyph.contours)
        found.append((f"{words}, {count} segments", gs.to_curvature_svg(glyph, scale=0.008)))
    side_by_side(page, "corners", found)


def text(page: Any) -> None:
    """A line bent along a path, and its curvature."""
    font = gs.open_font(FONTS / "kouzan-kaisho.ttf")
    wave = "M0 0C1500 -1100 2300 -500 3300 0S5600 900 7100 -300"
    with tempfile.TemporaryDirectory() as place:
        drawing = Path(place) / "wave.svg"
        drawing.write_text(f'<svg xmlns="http://www.w3.org/2000/svg"><path id="wave" d="{wave}"/></svg>')
        path = gs.open_path(f"{drawing}#wave")
    line = gs.layout(font, WORDS)
    bent = gs.convert(gs.bend(line, path, 0.2, align="center"), gs.Options(tolerance=2.0))
    svg = gs.to_svg(bent, view_box="ink").replace("<path", f'<path d="{wave}" class="wave"/><path', 1)
    page.set_content(f"<style>{LINE}</style>{svg}{gs.to_curvature_svg(bent, vertices=False)}")
    page.set_viewport_size({"width": 990, "height": 560})
    shot(page, "text")


def gallery(page: Any) -> None:
    """The gallery of a font, and one glyph of it zoomed into."""
    with tempfile.TemporaryDirectory() as place:
        glyphspline("convert", str(FONTS / "kouzan-gyosho.ttf"), "--all", "--out", place, "--quiet")
        page.goto((Path(place) / "index.html").as_uri())
        page.wait_for_selector("body[data-ready]")
        page.keyboard.press("s")
        page.keyboard.press("c")
        page.wait_for_timeout(800)
        shot(page, "gallery")


def viewer(page: Any) -> None:
    """The viewer with the three variants side by side."""
    with served("fonts_test/kouzan-gyosho.ttf") as address:
        page.emulate_media(color_scheme="dark")
        page.goto(address)
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
        shot(page, "viewer")


def checks(page: Any) -> None:
    """The page of what is found in a font."""
    with tempfile.TemporaryDirectory() as place:
        findings = Path(place) / "findings.html"
        glyphspline("check", str(FONTS / "kouzan-gyosho.otf"), "--html", str(findings), "--quiet")
        page.goto(findings.as_uri())
        page.wait_for_selector("body[data-ready]")
        page.wait_for_timeout(1500)
        shot(page, "checks")


def shot(what: Any, name: str) -> None:
    """A screenshot in 256 colours, which drawings do not miss and which takes a third of the bytes."""
    with Image.open(BytesIO(what.screenshot())) as image:
        image.convert("RGB").quantize(256, dither=Image.Dither.NONE).save(OUT / f"{name}.png", optimize=True)


def outline(font: str, text: str) -> gs.Outline:
    """A glyph of one of the repository's fonts."""
    source = gs.open_font(FONTS / font)
    return source.outline(source.select(text=text)[0])


def side_by_side(page: Any, name: str, drawings: list[tuple[str, str]]) -> None:
    """Drawings in a row with their captions."""
    figures = "".join(f"<figure>{svg}<figcaption>{escape(words)}</figcaption></figure>" for words, svg in drawings)
    page.set_content(f"<style>{PAIR}</style>{figures}")
    page.set_viewport_size({"width": 990, "height": 570})
    shot(page, name)


def glyphspline(*arguments: str) -> None:
    """Run the shell."""
    subprocess.run([sys.executable, "-m", "glyphspline", *arguments], check=True)


@contextmanager
def served(font: str) -> Iterator[str]:
    """The address of a viewer, as long as it is needed; the font's path is relative, as it stands in the picture."""
    command = [sys.executable, "-m", "glyphspline", "view", font, "--no-browser"]
    with subprocess.Popen(command, cwd=ROOT, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        yield process.stderr.readline().split()[0]
        process.terminate()


if __name__ == "__main__":
    main()
