"""Conversion of glyphs one by one to the pages of an atlas."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TypeAlias, TypeVar

from ..checks.kinks import tags_of
from ..errors import GlyphsplineError, OptionError
from ..files import make_folder
from ..fitting.convert import convert
from ..fitting.convert_masters import MastersResult, convert_masters
from ..fitting.options import Options
from ..fitting.results import GlyphResult, as_glyph
from ..readers import Source
from ..writers.figures.atlas import Glyph, write_atlas
from ..writers.figures.axis_pages import OfAxis, write_axis_atlas
from ..writers.svg.appearance import Whose
from ..writers.svg.curvature_map import curvature_scale
from .font_run import SCALE_SAMPLE

Result = TypeVar("Result", GlyphResult, MastersResult)

Failed: TypeAlias = tuple[str, str]
"""Name of a glyph, and why it could not be converted."""

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
    failed: list[str] = []
    glyphs = _each(names, lambda name: kept.pop(name, None) or _converted(source, name, options), failed, observer)
    pages = write_atlas(
        path, glyphs, scale or 1 / source.metrics.units_per_em, heading=f"{source.family} {source.style}",
        whose=comb, in_corners=in_corners, profiled=lambda glyph: glyph.outline.name in chosen,
    )  # fmt: skip
    return pages, len(failed)


def make_axis_atlas(
    source: Source,
    names: Sequence[str],
    path: Path,
    options: Options,
    axis: str,
    *,
    observer: Callable[[int, int], None] | None = None,
) -> tuple[int, int]:
    """Write the atlas of some glyphs of a variable font along an axis, a page a glyph.

    Args:
        source: the opened font; its location is that of the other axes. names: its glyphs, in order. path: the PDF.
        options: of the conversion, whose corners are sharp: so masters are converted. axis: tag of the axis.
        observer: called with the number of glyphs done and of all.

    Returns:
        Pages written, and glyphs that failed.

    Raises:
        GlyphsplineError: the font is not variable, or has no such axis.
        OptionError: options that masters cannot be converted with.
    """
    tags_of(source, axis)
    make_folder(path.parent)
    options = replace(options, corners="sharp")
    sources = source.outlines(names[:: -(-len(names) // SCALE_SAMPLE) or 1], errors="return")
    scale = curvature_scale(as_glyph(outline) for outline in sources if not isinstance(outline, GlyphsplineError))
    failed: list[str] = []
    glyphs = _each(names, lambda name: _in_all_masters(source, name, options), failed, observer)
    pages = write_axis_atlas(
        path, glyphs, axis, source.location, scale or 1 / source.metrics.units_per_em,
        f"{source.family} {source.style}",
    )  # fmt: skip
    return pages, len(failed)


def _each(
    names: Sequence[str],
    made: Callable[[str], Result | Failed],
    failed: list[str],
    observer: Callable[[int, int], None] | None,
) -> Iterator[Result | Failed]:
    """The glyphs of an atlas, made one by one, without those that are empty; ``failed`` gets the names of failures."""
    for done, name in enumerate(names, 1):
        glyph = made(name)
        if isinstance(glyph, tuple):
            failed.append(name)
            yield glyph
        elif glyph.contours:
            yield glyph
        if observer:
            observer(done, len(names))


def _in_all_masters(source: Source, name: str, options: Options) -> OfAxis:
    try:
        return convert_masters(source.masters(name), options)
    except OptionError:
        raise
    except GlyphsplineError as error:
        return name, error.message


def _converted(source: Source, name: str, options: Options) -> Glyph:
    try:
        return convert(source.outline(name), options)
    except GlyphsplineError as error:
        return name, error.message
