"""Glyphs converted one by one to the pages of an atlas."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from ...checks.kinks import tags_of
from ...errors import GlyphsplineError
from ...files import make_folder
from ...fitting.convert_masters import check_options
from ...fitting.options import Options
from ...fitting.results import GlyphResult, as_glyph
from ...readers import Source
from ...writers.figures.atlas import write_atlas
from ...writers.figures.axis_pages import write_axis_atlas
from ...writers.settings import BOTH, Maps
from ...writers.svg.comb import curvature_scale
from ..engine import Item, Job, Observer, reason, run
from ..schedule import Place, kinds_for, place_of, sources, workers
from ..spec import Limits
from .convert import SCALE_SAMPLE

if TYPE_CHECKING:
    from ...fitting.convert_masters import MastersResult

PROFILED = 12
"""Up to this number of glyphs, each has a profile page by default."""


class Atlas(NamedTuple):
    """An atlas that is written.

    Attributes:
        pages: their number. failed: glyphs that failed, with the reasons. outside: glyphs not within the tolerance.
    """

    pages: int
    failed: list[str]
    outside: list[str]


Converted: TypeAlias = "GlyphResult | MastersResult | tuple[str, str]"
"""A result, or a glyph's name and why it could not be converted."""


@dataclass(frozen=True)
class AtlasJob(Job[str, Converted]):
    """Glyphs by name, converted where their font is open, or in all masters."""

    place: Place
    options: Options
    masters: bool = False

    chunk = 1
    budget = 1.0

    def read(self, tasks: Sequence[str]) -> list[Item | Exception]:
        """Glyphs in all masters by name; or outlines, of which one that is too large is an error."""
        from ..worker import items

        if self.masters:
            return [Item(name) for name in tasks]
        (source,) = sources(self.place)
        return items(source.outlines(tasks, errors="return"), self.options, Limits())

    def together(self, tasks: Sequence[str], contents: Sequence[Any]) -> Converted:
        """Convert one glyph."""
        from ...fitting.convert import convert
        from ...fitting.convert_masters import convert_masters

        ((source,), (content,)) = sources(self.place), contents
        if self.masters:
            return convert_masters(source.masters(content), self.options)
        return convert(content, self.options)

    def failed(self, task: str, error: Exception) -> Converted:
        """Why a glyph could not be converted."""
        return task, reason(error)


def make_atlas(
    source: Source,
    names: Sequence[str],
    path: Path,
    options: Options,
    *,
    profiles: Sequence[str] | None = None,
    maps: Maps = BOTH,
    jobs: int | None = 0,
    observer: Observer | None = None,
) -> Atlas:
    """Write the atlas of some glyphs.

    Args:
        source: the opened font. names: its glyphs, in order. path: the PDF.
        options: of the conversion.
        profiles: glyphs with a page of κ(s); by default all if they are at most ``PROFILED``, else none.
        maps: what the pages of combs show.
        jobs: worker processes; None takes all cores, 0 does everything in this process, without a time limit.
        observer: called with the number of glyphs done, of all, and of those that failed.
    """
    make_folder(path.parent)
    chosen = set(names if len(names) <= PROFILED else ()) if profiles is None else set(profiles)
    job, total, notable = AtlasJob(place_of(source), options), len(names), Atlas(0, [], [])
    em = source.metrics.units_per_em
    with workers(jobs, kinds=kinds_for(options), expected=total) as pool:
        sample = names[:: -(-total // SCALE_SAMPLE) or 1]
        kept = {part.tasks[0]: part.result for part in run(job, sample, pool, observer=observer, total=total)}
        scale = maps.scale_for(em) or curvature_scale(g for g in kept.values() if isinstance(g, GlyphResult)) or 1 / em
        left = [name for name in names if name not in kept]
        others = run(job, left, pool, ordered=True, observer=observer, before=len(kept), total=total)
        made: Iterator[Any] = (kept.pop(name) if name in kept else next(others).result for name in names)
        pages = write_atlas(
            path, _shown(made, notable), scale, heading=f"{source.family} {source.style}", combs=maps.comb,
            in_corners=maps.corner_teeth,
            profiled=lambda glyph: glyph.outline.name in chosen,
        )  # fmt: skip
    return notable._replace(pages=pages)


def make_axis_atlas(
    source: Source,
    names: Sequence[str],
    path: Path,
    options: Options,
    axis: str,
    *,
    maps: Maps = BOTH,
    jobs: int | None = 0,
    observer: Observer | None = None,
) -> Atlas:
    """Write the atlas of some glyphs of a variable font along an axis, a page a glyph.

    Args:
        source: the opened font; its location is that of the other axes. names: its glyphs, in order. path: the PDF.
        options: of the conversion, whose corners are sharp: so masters are converted. axis: tag of the axis.
        maps: its scale, if it has one. jobs: as of :func:`make_atlas`.
        observer: called with the number of glyphs done, of all, and of those that failed.

    Raises:
        GlyphsplineError: the font is not variable, or has no such axis.
        OptionError: options that masters cannot be converted with.
    """
    tags_of(source, axis)
    make_folder(path.parent)
    options = replace(options, corners="sharp")
    sources = source.outlines(names[:: -(-len(names) // SCALE_SAMPLE) or 1], errors="return")
    em, read = source.metrics.units_per_em, [each for each in sources if not isinstance(each, GlyphsplineError)]
    scale = maps.scale_for(em) or curvature_scale(map(as_glyph, read)) or 1 / em
    check_options(options)
    notable = Atlas(0, [], [])
    with workers(jobs, kinds=kinds_for(options, masters=True), expected=len(names)) as pool:
        parts = run(AtlasJob(place_of(source), options, masters=True), names, pool, ordered=True, observer=observer)
        made: Iterator[Any] = (part.result for part in parts)
        pages = write_axis_atlas(
            path, _shown(made, notable), axis, source.location, scale, f"{source.family} {source.style}",
        )  # fmt: skip
    return notable._replace(pages=pages)


def _shown(glyphs: Iterator[Any], notable: Atlas) -> Iterator[Any]:
    """Results, and names and errors of glyphs that failed, without those that are empty; ``notable`` gets the rest."""
    for glyph in glyphs:
        if isinstance(glyph, tuple):
            notable.failed.append(": ".join(glyph))
        elif _is_outside(glyph):
            notable.outside.append((glyph.outline if isinstance(glyph, GlyphResult) else glyph.masters).name)
        if isinstance(glyph, tuple) or glyph.contours:
            yield glyph


def _is_outside(glyph: GlyphResult | MastersResult) -> bool:
    """Whether a tolerance was asked for, and a contour is not within it."""
    if glyph.options.is_fixed:
        return False
    if isinstance(glyph, GlyphResult):
        return False in glyph.arrays.measures.get("within_tolerance", ())
    return not all(contour.within_tolerance for contour in glyph.contours)
