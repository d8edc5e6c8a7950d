"""Formats with one file a font, written at the end of a run from the stored results of its glyphs."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path

from ..errors import OutputError
from ..extras import need
from ..files import replacing, write_whole, writing
from ..fitting.options import Options
from ..fitting.results import GlyphResult
from ..readers import Source
from ..types import rounded_up
from ..writers.formats import format_named
from .manifest import entries_of
from .result_text import from_text
from .spec import OF_RUNS, RESULTS, RunSpec


def write_fonts(source: Source, out: Path, spec: RunSpec) -> list[str]:
    """Write these formats for all glyphs of the folder's manifest; returns remarks for the summary.

    Raises:
        OutputError: a file cannot be written, or a stored result cannot be read.
        GlyphsplineError: the source cannot become such a font.
    """
    remarks = []
    for name in spec.whole:
        path = out / f"{file_stem(source)}.{name}"
        with writing(path):
            remarks += WRITERS[name](source, stored(source, out, spec.options), path, spec)
    return remarks


def missing(source: Source, out: Path, spec: RunSpec) -> bool:
    """Whether any of the files does not exist."""
    return any(not (out / f"{file_stem(source)}.{name}").exists() for name in spec.whole)


def file_stem(source: Source) -> str:
    """The files' name without suffix."""
    return (re.sub(r"[^\w-]+", "", source.family)[:50] or "font") + "-spline"


def stored(source: Source, out: Path, options: Options) -> Iterator[GlyphResult]:
    """The results of a finished run in glyph index order, with empty glyphs and without failed ones."""
    for entry in entries_of(out):
        file = entry["files"].get(RESULTS)
        if entry["status"] == "empty":
            yield GlyphResult(source.outline(entry["glyph"]), options, ())
        elif file is not None:
            path = out / RESULTS / Path(file).name
            try:
                yield from_text(path.read_text(encoding="utf-8"))
            except (OSError, ValueError) as error:
                raise OutputError(f"cannot be read: {error}", font=str(path)) from error


def _ufo(source: Source, glyphs: Iterator[GlyphResult], path: Path, spec: RunSpec) -> list[str]:
    from ..writers.ufo_folder import write_ufo

    return [f"{path.name}: {write_ufo(source, glyphs, path)} glyphs"]


def _font(source: Source, glyphs: Iterator[GlyphResult], path: Path, spec: RunSpec) -> list[str]:
    from ..writers.font.font_file import to_font
    from ..writers.font.font_glyphs import Flavour

    flavour: Flavour = "otf" if path.suffix == ".otf" else "ttf"
    tolerance = spec.options.tolerance_for(source.metrics.units_per_em)
    data, summary = to_font(source, glyphs, flavour, tolerance=tolerance)
    write_whole(str(path), data, durable=True)
    remark = f"{path.name}: {summary.replaced} glyphs replaced"
    if summary.largest_error is not None:
        remark += f", within {rounded_up(summary.largest_error, 3):.3g} units of the source"
    remark += f", {summary.extrema} points added at extrema"
    if summary.beyond:
        remark += f"; {len(summary.beyond)} may be beyond the tolerance: {', '.join(summary.beyond[:5])}"
    return [remark]


def _parquet(source: Source, glyphs: Iterator[GlyphResult], path: Path, spec: RunSpec) -> list[str]:
    from ..writers.parquet import write_table

    with replacing(path) as file:
        count = write_table(source, glyphs, file)
    return [f"{path.name}: {count} contours"]


WRITERS: dict[str, Callable[[Source, Iterator[GlyphResult], Path, RunSpec], list[str]]] = {
    "ufo": _ufo,
    "otf": _font,
    "ttf": _font,
    "parquet": _parquet,
}


def check_possible(spec: RunSpec) -> None:
    """Raise a GlyphsplineError before the run starts if a library that it needs is not installed."""
    if "parquet" in spec.whole:
        need("parquet")
    for name in spec.folders:
        extra = None if name in OF_RUNS else format_named(name).extra
        if extra is not None:
            need(extra)
    if spec.options.remove_overlaps:
        need("overlaps")
