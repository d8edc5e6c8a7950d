"""Plain Python and compiled code write the same bytes, of a few glyphs; ``scripts/same_bytes.py`` takes more."""

from __future__ import annotations

from pathlib import Path

import pytest

from glyphspline.runs.warm import warm
from scripts.same_bytes import KINDS, WAYS, compared, convert, differences, odd_glyphs
from tests.places import FONTS


@pytest.fixture(scope="module", autouse=True)
def compiled_code() -> None:
    warm(None, KINDS)


@pytest.mark.parametrize("way", ["sharp", "smooth"])
def test_glyphs_are_the_same(way: str) -> None:
    assert compared(FONTS / "kouzan-gyosho.ttf", ["--text", "A", *WAYS[way]]) == []


@pytest.mark.parametrize("way", ["sharp", "count"])
def test_glyphs_that_no_designer_draws_are_the_same(way: str, tmp_path: Path) -> None:
    assert compared(odd_glyphs(tmp_path / "odd.ufo"), ["--all", *WAYS[way]]) == []


def test_a_run_begun_plain_and_resumed_compiled_ends_with_the_same_bytes(tmp_path: Path) -> None:
    font, words = odd_glyphs(tmp_path / "odd.ufo"), ["--glyphs", "back,crossed.round,thin,twice.round"]
    convert(font, tmp_path / "both", words, True)
    begun = {path: path.stat().st_mtime_ns for path in (tmp_path / "both" / "svg").iterdir()}
    for path in [path for path in begun if path.stem in ("thin", "twice.round")]:  # as if it had not come to them
        path.unlink()
        del begun[path]
    convert(font, tmp_path / "both", words, False)
    convert(font, tmp_path / "compiled", words, False)
    assert len(begun) == 2
    assert {path: path.stat().st_mtime_ns for path in begun} == begun, "what was there is kept"
    assert (tmp_path / "both" / "svg" / "thin.svg").exists()
    assert differences(tmp_path / "both", tmp_path / "compiled") == []


def test_what_differs_is_named(tmp_path: Path) -> None:
    for name in ("one", "other"):
        (tmp_path / name / "svg").mkdir(parents=True)
        (tmp_path / name / "svg" / "a.svg").write_text(name)
        (tmp_path / name / "svg" / "b.svg").write_text("same")
        (tmp_path / name / "manifest.jsonl").write_text(f'{{"glyph": "a"}}\n{{"glyph": "b", "of": "{name}"}}\n')
    (tmp_path / "one" / "svg" / "c.svg").write_text("more")
    found = differences(tmp_path / "one", tmp_path / "other")
    assert [*map(str, found)] == [
        '{"glyph": "b", "of": "one"}', '{"glyph": "b", "of": "other"}', "svg/a.svg", "svg/c.svg"
    ]  # fmt: skip
