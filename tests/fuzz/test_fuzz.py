"""A minute of damaged fonts and drawings; hours of them with ``make fuzz``."""

from __future__ import annotations

import random
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from glyphspline import GlyphResult, Options, Outline, convert, to_svg
from glyphspline.errors import GlyphsplineError
from glyphspline.fitting.convert import convert_many
from glyphspline.readers import Source, open_source
from tests.places import ROOT

from .mutants import mutant, sources


@settings(derandomize=True, suppress_health_check=list(HealthCheck))
@given(seed=st.integers(0, 2**32))
def test_a_damaged_font_raises_nothing_but_our_own_errors(seed: int, tmp_path_factory: object) -> None:
    rng = random.Random(seed)
    name = rng.choice([name for name, files in sources().items() if name in files])
    path = Path(tmp_path_factory.mktemp("fuzz")) / name  # type: ignore[attr-defined]
    path.write_bytes(mutant(rng, sources()[name]).files[name])
    options = Options(step=60.0)
    try:
        font = open_source(path)
    except GlyphsplineError as error:
        blamed = error.font
    else:
        look_at_glyphs(font, options)
        return
    assert blamed == str(path)


def look_at_glyphs(font: Source, options: Options) -> None:
    """Convert some glyphs; those that fail say which they are. In a batch they have the same results."""
    batch = []
    for glyph in font.glyph_names[:20]:
        blamed = None
        try:
            document = to_svg(convert(font.outline(glyph), options))
        except GlyphsplineError as error:
            document, blamed = "", error.glyph
        assert "nan" not in document
        assert blamed in (None, glyph)
        batch.append(document or blamed)
    outlines = font.outlines(font.glyph_names[:20], errors="return")
    results = iter(convert_many([o for o in outlines if isinstance(o, Outline)], options, errors="return"))
    found = [next(results) if isinstance(outline, Outline) else outline for outline in outlines]
    assert [to_svg(item) if isinstance(item, GlyphResult) else item.glyph for item in found] == batch


@pytest.mark.parametrize("commands", [0, pytest.param(30, marks=pytest.mark.long)])
def test_damaged_sources_through_commands_with_limits_and_what_was_found_once(commands: int, tmp_path: Path) -> None:
    call = [sys.executable, "-m", "tests.fuzz", "--commands", str(commands), "--seed", "1", "--out", str(tmp_path)]
    done = subprocess.run(call, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr[-2000:]
    assert done.stdout.endswith(" 0 kinds of faults\n")
