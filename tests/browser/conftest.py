"""A headless Chromium, a gallery of real runs opened from disk, and a viewer that the shell has started."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import expect, sync_playwright

import glyphspline as gs
from glyphspline.runs.convert import convert_font, write_gallery
from glyphspline.runs.spec import RunSpec
from tests.places import FONTS

from ..variable_fonts import WEIGHT, quadratic, variable_font

PATIENCE = 60_000
"""Milliseconds: a slow machine is not an error, and what never comes fails all the same."""

SANDBOXED = hasattr(os, "getuid") and os.getuid() != 0  # Chromium's sandbox does not work for root

expect.set_options(timeout=PATIENCE)


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(
            executable_path=shutil.which("chromium"), args=[] if SANDBOXED else ["--no-sandbox"]
        )
        yield chromium
        chromium.close()


@pytest.fixture
def page(browser: Any) -> Iterator[Any]:
    """A page on which any error, and any request beyond this machine, fails the test."""
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    page = context.new_page()
    page.set_default_timeout(PATIENCE)
    wrong: list[str] = []
    page.on("console", lambda message: wrong.append(message.text) if message.type in ("error", "warning") else None)
    page.on("pageerror", lambda error: wrong.append(str(error)))
    here = ("file:", "http://127.0.0.1:", "data:", "blob:")
    page.on("request", lambda request: None if request.url.startswith(here) else wrong.append(request.url))
    yield page
    context.close()
    assert not wrong


@pytest.fixture(scope="session")
def gallery(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two runs below one folder, with an index of their own."""
    out = tmp_path_factory.mktemp("gallery")
    for name, options in (("kouzan-gyosho", gs.Options(count=24, measure=True)), ("variable", gs.Options(step=90))):
        font = gs.open_font(FONTS / f"{name}.ttf")
        convert_font(font, font.glyph_names, out / name, RunSpec(options), jobs=0)
    write_gallery(out)
    return out


@pytest.fixture(scope="session")
def viewer() -> Iterator[str]:
    """The address of a viewer, started as a user does."""
    yield from viewed(FONTS / "kouzan-gyosho.ttf")


@pytest.fixture(scope="session")
def variable_viewer(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """The address of a viewer of a font of five axes, in whose glyph k a joint kinks between the masters."""
    yield from viewed(kinked(tmp_path_factory.mktemp("fonts") / "variable.ttf"))


def viewed(font: Path) -> Iterator[str]:
    command = [sys.executable, "-m", "glyphspline", "view", str(font), "--no-browser"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        yield process.stderr.readline().split()[0]
        process.terminate()


def kinked(path: Path) -> Path:
    """A glyph of handles that are level in one master and slanted in the other, of unlike lengths."""
    points = [(0, 0), (150, 0), (500, 300), (-300, 300), (-60, 0)]
    bold = [(0, 0), (60, 30), (560, 340), (-330, 290), (-200, -100)]
    deltas = [(x - a, y - b) for (x, y), (a, b) in zip(bold, points, strict=True)]
    wide = [(0, 0), (20, 0), (80, 0), (-40, 0), (-10, 0)]
    axes = [WEIGHT, *((tag, 0.0, 0.0, 100.0, tag.title()) for tag in ("wdth", "opsz", "slnt", "XTRA"))]
    variations = [({"wght": (0, 1, 1)}, deltas), ({"wdth": (0, 1, 1)}, wide)]
    return variable_font(path, {"k": quadratic(points, [True, False, True, True, False])}, {"k": variations}, axes)
