"""A minute of damaged fonts; hours of them with ``python -m tests.fuzz.batch``."""

from __future__ import annotations

import random
from pathlib import Path

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from glyphspline import Font, GlyphResult, Options, Outline, convert, open_font, to_svg
from glyphspline.errors import GlyphsplineError
from glyphspline.fitting.convert import convert_many

from .batch import round_of
from .mutants import mutant


@settings(max_examples=100, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))
@given(seed=st.integers(0, 2**32))
def test_a_damaged_font_raises_nothing_but_our_own_errors(seed: int, tmp_path_factory: object) -> None:
    name, data = mutant(random.Random(seed))
    path = Path(tmp_path_factory.mktemp("fuzz")) / name  # type: ignore[attr-defined]
    path.write_bytes(data)
    options = Options(step=60.0)
    try:
        font = open_font(path)
    except GlyphsplineError as error:
        blamed = error.font
    else:
        look_at_glyphs(font, options)
        return
    assert blamed == str(path)


def look_at_glyphs(font: Font, options: Options) -> None:
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


def test_damaged_fonts_through_the_batch_script() -> None:
    outcome, broken = round_of(12, 1, ["--step", "80", "--format", "svg", "--jobs", "2", "--quiet"])
    assert not broken
    assert outcome["ok"] > 0
    assert outcome["readable"] < outcome["fonts"]
