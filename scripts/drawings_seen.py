"""Small drawings as Chromium shows them and as we read them: the same ink, or what is left out is said.

``python -m scripts.drawings_seen`` takes those of ``tests/plugins/drawings/seen.py``; with a folder of resvg's tests
(``crates/resvg/tests/tests``), those of structure, shapes, painting and masking that are plain filled vector art. Needs
the extra ``browser``, and Debian's Chromium.
"""

from __future__ import annotations

import argparse
import io
import os
import re
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from PIL import Image

from glyphspline.errors import GlyphsplineError
from glyphspline.outlines.outline import Outline
from glyphspline.plugins.drawings.svg import read_drawing, stretch_of
from glyphspline.plugins.drawings.tree.document import parse
from tests.plugins.drawings.seen import HEAD, SEEN

SIZE = 200
"""Pixels of a side of a picture."""

NEAR = 0.01
"""Largest mean difference of ink, from 0 to 1, over a picture's pixels."""

ROOMS = ("structure", "shapes", "painting", "masking")
"""Folders of resvg's tests."""

FRAME = re.compile(rb"""<rect\s+id=["']frame["'][^>]*/>""")
"""A stroked rectangle that most of them have around the picture."""

STROKES = rb"stroke(?:-width)?\s*[=:]"
NOT_PLAIN = (
    rb"<(?:text|image|filter|marker|pattern|foreignObject|animate|set)\b|mix-blend-mode|"
    rb"opacity\s*[=:]\s*[\"']?\s*(?:0?\.|\d\d?%)|enable-background|\bcontext-|isolation|filter\s*[=:]|"
    rb"[\"']#(?:[0-9a-fA-F]{4}){1,2}[\"']|(?:rgba?|hsla?)\((?:[^,)]*,){3}\s*(?:0?\.\d+|\d\d?%)\s*\)"
)
"""What drawings have that are more than filled shapes, or are filled with paint that is partly transparent."""


class Verdict(NamedTuple):
    """How a drawing was read: the mean difference of ink (None: not at all), what is said, and the share of ink."""

    difference: float | None
    said: tuple[str, ...]
    ink: float = 0.0

    def is_right(self) -> bool:
        """Whether it is drawn as seen, or what is not is said."""
        return bool(self.said) or (self.difference is not None and self.difference < NEAR)


def ours(file: Path, outline: Outline) -> str:
    """The outline as a drawing in the view of its file."""
    root = parse(file.read_bytes()).root
    kept = ("width", "height", "viewBox", "preserveAspectRatio")
    attributes = " ".join(f'{name}="{root.get(name)}"' for name in kept if root.get(name))
    parts = []
    for contour in outline.contours:
        for k, piece in enumerate(contour.segments()):
            start = "" if k else f"M{piece[0, 0]!r} {piece[0, 1]!r}"
            numbers = " ".join(repr(float(value)) for value in piece[1:].ravel())
            parts.append(f"{start}{'LQC'[len(piece) - 2]}{numbers}")
        parts.append("Z")
    data = "".join(parts).replace("np.float64(", "").replace(")", "")
    return f'<svg {HEAD} {attributes}><path transform="scale({1 / stretch_of(root)!r} -1)" d="{data}"/></svg>'


def picture(page: Any, file: Path) -> np.ndarray[Any, Any]:
    """(SIZE, SIZE, 4) of a file, from 0 to 1, on nothing."""
    page.goto(file.absolute().as_uri())
    with Image.open(io.BytesIO(page.screenshot(omit_background=True))) as image:
        return np.asarray(image.convert("RGBA"), dtype=float) / 255


def inks(pixels: np.ndarray[Any, Any]) -> Iterator[np.ndarray[Any, Any]]:
    """What counts as ink: all that is painted, or what is not white on paper."""
    alpha = pixels[..., 3]
    yield alpha
    yield 1 - (pixels[..., :3] * alpha[..., None] + 1 - alpha[..., None]).min(axis=-1)


def verdict_on(page: Any, file: Path, work: Path, strokes: bool) -> Verdict:
    """Read a drawing, draw it, and compare it with what Chromium shows."""
    try:
        outline = read_drawing(file, strokes)
    except GlyphsplineError as error:
        return Verdict(None, (error.message,))
    (work / "ours.svg").write_text(ours(file, outline), encoding="utf-8")
    seen, drawn = picture(page, file), picture(page, work / "ours.svg")
    apart, ink = min((float(np.abs(a - drawn[..., 3]).mean()), float(a.mean())) for a in inks(seen))
    return Verdict(apart, outline.unread, ink)


def files_of(folder: Path | None, work: Path, strokes: bool) -> Iterator[tuple[str, Path, str]]:
    """Names of drawings, their files, and what each is to name; "?" is not known. Of resvg's those with strokes alone,
    or those without."""
    if folder is None:
        for name, each in SEEN.items():
            file = work / f"{re.sub(r'[^a-z0-9]+', '-', name)}.svg"
            file.write_text(each.document, encoding="utf-8")
            yield name, file, each.named
        return
    for room in ROOMS:
        for file in sorted((folder / room).rglob("*.svg")):
            data = FRAME.sub(b"", file.read_bytes())
            if not re.search(NOT_PLAIN, data) and bool(re.search(STROKES, data)) == strokes:
                (work / "one.svg").write_bytes(data)
                yield str(file.relative_to(folder)), work / "one.svg", "?"


def main() -> None:
    """Print the drawings that are not right, and how many are."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, nargs="?", help="resvg's tests")
    parser.add_argument("--all", action="store_true", help="print every drawing")
    parser.add_argument("--strokes", action="store_true", help="draw strokes")
    parser.add_argument("--ink", action="store_true", help="print the share of ink that Chromium shows of each")
    call = parser.parse_args()
    from playwright.sync_api import sync_playwright

    counts = {"drawn": 0, "said": 0, "wrong": 0}
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        root = hasattr(os, "getuid") and os.getuid() == 0  # Chromium's sandbox does not work for it
        browser = playwright.chromium.launch(
            executable_path=shutil.which("chromium"), args=["--no-sandbox"] if root else []
        )
        page = browser.new_page(viewport={"width": SIZE, "height": SIZE})
        for name, file, named in files_of(call.folder, Path(folder), call.strokes):
            found = verdict_on(page, file, Path(folder), call.strokes)
            is_drawn = found.difference is not None and found.difference < NEAR
            right = (
                found.is_right()
                if named == "?"
                else (is_drawn and not found.said if not named else any(named in each for each in found.said))
            )
            counts["wrong" if not right else "said" if found.said else "drawn"] += 1
            if call.ink and is_drawn:
                print(f'    "{name}": {found.ink:.4f},')
            if call.all or not right:
                apart = "not read" if found.difference is None else f"{found.difference:.4f}"
                print(f"{'' if right else 'WRONG '}{name}: {apart} {'; '.join(found.said)}")
        browser.close()
    print(", ".join(f"{count} {kind}" for kind, count in counts.items()))


if __name__ == "__main__":
    main()
