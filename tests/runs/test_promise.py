"""What SECURITY.md promises, with the worst fonts that are known: sound glyphs are made, within its time and memory."""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest

from glyphspline import GlyphsplineError, open_source
from tests import worst_fonts
from tests.measured import measured

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")

SECONDS, BYTES = 60.0, 1 << 30
"""Of processor time of all processes of a command, and of memory of each."""

FONTS: dict[str, Callable[[Path], object]] = {"worst.ttf": worst_fonts.truetype, "worst.otf": worst_fonts.postscript}

FILES: dict[str, tuple[Callable[[Path], object], str]] = {
    "honest.woff2": (partial(worst_fonts.inflating, length=1 << 30), "grows beyond 256 MiB"),
    "lying.woff2": (partial(worst_fonts.inflating, length=1000), "longer than its directory says"),
    "faces.ttc": (worst_fonts.many_faces, "60000 faces, more than the 1000 allowed"),
    "more.ttf": (worst_fonts.more_characters, "more code points than there are"),
    "groups.ttf": (worst_fonts.many_groups, "more code points than there are"),
    "segments.ttf": (worst_fonts.many_segments, "more code points than there are"),
}
"""Files that are refused as a whole, and what is said of them."""

long = pytest.mark.long


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("worst")
    for name, build in FONTS.items():
        build(made / name)
    return made


TEXT = "abcdefghijklmnopqr"

CASES = [
    ("worst.ttf", "convert {font} --all --format svg --jobs 1 --out out", 1, ["laugh4", "laugh10", "self", "loop"]),
    ("worst.otf", "convert {font} --all --format svg --jobs 1 --out out", 1, ["nested", "self", "most", "long"]),
    ("worst.ttf", "refit {font} --gids 0-4,12-14,17,18 --masters --format ttf --jobs 1 --out out", 1, ["most"]),
    ("worst.ttf", "refit {font} --gids 0-4,12-14,17,18 --masters --format otf --jobs 1 --out out", 1, ["most"]),
    ("worst.ttf", f"text {{font}} {TEXT} --out out.svg", 1, ["laugh10"]),
    ("worst.otf", f"text {{font}} {TEXT} --out out.svg", 1, ["nested", "self", "most", "long"]),
    ("worst.ttf", "check {font} --jobs 1", 1, ["laugh4"]),
    ("worst.otf", "check {font} --jobs 1", 1, ["nested", "self", "most"]),
    ("worst.ttf", "diff {font} {font} --jobs 1", 1, ["laugh4"]),
    ("worst.ttf", "atlas {font} --gids 0-3,6-7,13-15 --jobs 1 --out out.pdf", 1, ["laugh4", "self"]),
    ("worst.ttf", "dataset {font} --jobs 1 --out out", 1, ["laugh4"]),
    ("worst.ttf", "info {font}", 0, []),
]


@pytest.mark.parametrize(
    ("font", "command", "status", "named"), [*CASES[:2], *(pytest.param(*case, marks=long) for case in CASES[2:])]
)
def test_the_worst_glyphs_fail_alone_within_what_is_promised(
    font: str, command: str, status: int, named: list[str], folder: Path, tmp_path: Path
) -> None:
    found = measured(*command.format(font=folder / font).split(), cwd=tmp_path)
    assert found.status == status, found.said
    assert "Traceback" not in found.said
    for name in named:
        assert name in found.said + found.out
    assert found.seconds < SECONDS
    assert found.peak < BYTES


@pytest.mark.parametrize("name", FILES)
def test_files_that_ask_for_too_much_are_refused(name: str, tmp_path: Path) -> None:
    build, said = FILES[name]
    build(tmp_path / name)
    with pytest.raises(GlyphsplineError, match=said):
        open_source(tmp_path / name).select(all_glyphs=True)


@pytest.mark.parametrize("name", ["honest.woff2", *(pytest.param(name, marks=long) for name in [*FILES][1:])])
def test_files_that_ask_for_too_much_are_refused_at_once(name: str, tmp_path: Path) -> None:
    build, said = FILES[name]
    build(tmp_path / name)
    found = measured("convert", tmp_path / name, "--all", "--jobs", "1", "--out", "out", cwd=tmp_path)
    assert (found.status, found.out) == (2, "")
    assert said in found.said
    assert found.said.count("\n") == 1
    assert found.seconds < SECONDS
    assert found.peak < BYTES


@long
def test_a_font_of_all_code_points_is_converted(tmp_path: Path) -> None:
    worst_fonts.all_characters(tmp_path / "all.ttf")
    found = measured("convert", tmp_path / "all.ttf", "--all", "--jobs", "1", "--out", "out", cwd=tmp_path)
    assert found.status == 0, found.said
    assert found.seconds < SECONDS
    assert found.peak < BYTES
