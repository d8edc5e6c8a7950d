"""Conversion of glyphs one by one to the pages of an atlas."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from ..errors import GlyphsplineError
from ..fitting.convert import convert
from ..fitting.options import Options
from ..fitting.results import GlyphResult
from ..readers import Source
from ..writers.figures.atlas import Glyph, write_atlas
from ..writers.svg.curvature_map import Whose, curvature_scale
from .files import make_folder
from .font_run import SCALE_SAMPLE

PROFILED = 12
"""Up to this number of glyphs, each has a profile page by default."""


def make_atlas(
    source: Source,
    names: Sequence[str],
    path: Path,
    options: Options,
    *,
    profiles: Sequence[str] | None = None,
    comb: Whose = "result",
    in_corners: bool = False,
    observer: Callable[[int, int], None] | None = None,
) -> tuple[int, int]:
    """Write the atlas of some glyphs.

    Args:
        source: the opened font. names: its glyphs, in order. path: the PDF.
        options: of the conversion.
        profiles: glyphs with a page of κ(s); by default all if they are at most ``PROFILED``, else none.
        comb: whose curvature the pages of combs show. in_corners: see :func:`to_curvature_svg`.
        observer: called with the number of glyphs done and of all.

    Returns:
        Pages written, and glyphs that failed.
    """
    make_folder(path.parent)
    chosen = set(names if len(names) <= PROFILED else ()) if profiles is None else set(profiles)
    kept = {name: _converted(source, name, options) for name in names[:: -(-len(names) // SCALE_SAMPLE) or 1]}
    scale = curvature_scale(glyph for glyph in kept.values() if isinstance(glyph, GlyphResult))
    failures = 0

    def glyphs() -> Iterator[Glyph]:
        nonlocal failures
        for done, name in enumerate(names, 1):
            glyph = kept.pop(name, None) or _converted(source, name, options)
            failures += not isinstance(glyph, GlyphResult)
            if not isinstance(glyph, GlyphResult) or glyph.contours:
                yield glyph
            if observer:
                observer(done, len(names))

    pages = write_atlas(
        path, glyphs(), scale or 1 / source.metrics.units_per_em, heading=f"{source.family} {source.style}",
        whose=comb, in_corners=in_corners, profiled=lambda glyph: glyph.outline.name in chosen,
    )  # fmt: skip
    return pages, failures


def _converted(source: Source, name: str, options: Options) -> Glyph:
    try:
        return convert(source.outline(name), options)
    except GlyphsplineError as error:
        return name, error.message
