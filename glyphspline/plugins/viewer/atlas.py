"""Glyphs converted one by one to the pages of an atlas."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

from ...files import make_folder
from ...fitting.convert import convert
from ...fitting.options import Options
from ...fitting.results import GlyphResult, as_glyph
from ...hooks import service
from ...outlines.outline import Outline
from ...readers import Source
from ...runs.choice import USUAL
from ...runs.convert import SCALE_SAMPLE
from ...runs.engine import Item, Job, Observer, reason, run
from ...runs.schedule import Place, place_of, sources, workers
from ...runs.spec import LIMITS, kinds_for
from ...writers.figures.basics import write_pages
from ...writers.settings import BOTH, Maps
from ...writers.svg.comb import curvature_scale
from .atlas_pages import atlas_pages

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


Converted: TypeAlias = Any
"""A result, of masters too, or a glyph's name and why it could not be converted."""


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
        from ...runs.worker import items

        if self.masters:
            return [Item(name, USUAL) for name in tasks]
        (source,) = sources(self.place)
        return items(source.outlines(tasks, errors="return"), self.options, LIMITS)

    def together(self, tasks: Sequence[str], contents: Sequence[Any]) -> Converted:
        """Convert one glyph."""
        ((source,), (content,)) = sources(self.place), contents
        if self.masters:
            return service("convert_masters")(source.masters(content), self.options)
        return convert(content, self.options)

    def failed(self, task: str, error: Exception) -> Converted:
        """Why a glyph could not be converted."""
        return task, reason(error)


def make_atlas(
    source: Source,
    names: Sequence[str],
    path: Path,
    options: Options,
    axis: str | None = None,
    *,
    profiles: Sequence[str] | None = None,
    maps: Maps = BOTH,
    jobs: int | None = 0,
    executor: Executor | None = None,
    observer: Observer | None = None,
) -> Atlas:
    """Write the atlas of some glyphs; along an ``axis``, a page a glyph of a variable font.

    Args:
        source: the opened font; its location is that of the other axes. names: its glyphs, in order. path: the PDF.
        options: of the conversion; along an axis corners are sharp: so masters are converted.
        axis: its tag. profiles: glyphs with a page of κ(s); by default all if they are at most ``PROFILED``, else none.
        maps: what the pages of combs show; along an axis only their scale.
        jobs: worker processes; None takes all cores, 0 does everything in this process, without a time limit.
        executor: used instead of worker processes; it is not closed.
        observer: called with the number of glyphs done, of all, and of those that failed.

    Raises:
        GlyphsplineError: the font is not variable, or has no such axis.
        OptionError: options that masters cannot be converted with.
    """
    if axis is not None:
        options = replace(options, corners="sharp")
        service("check_axis")(source, axis, options)
    make_folder(path.parent)
    total, em, heading = len(names), source.metrics.units_per_em, f"{source.family} {source.style}"
    sample = names[:: -(-total // SCALE_SAMPLE) or 1]
    job, notable = AtlasJob(place_of(source), options, axis is not None), Atlas(0, [], [])
    kept: dict[str, Any] = {}
    kinds = ["masters"] if job.masters else kinds_for(options)
    with workers(jobs, kinds=kinds, expected=total, executor=executor) as pool:
        if axis is None:
            kept = {part.tasks[0]: part.result for part in run(job, sample, pool, observer=observer, total=total)}
            surveyed = [glyph for glyph in kept.values() if isinstance(glyph, GlyphResult)]
        else:
            surveyed = [as_glyph(o) for o in source.outlines(sample, errors="return") if isinstance(o, Outline)]
        scale = maps.scale_for(em) or curvature_scale(surveyed) or 1 / em
        left = [name for name in names if name not in kept]
        others = run(job, left, pool, ordered=True, observer=observer, before=len(kept), total=total)
        made: Iterator[Any] = (kept.pop(name) if name in kept else next(others).result for name in names)
        shown = _shown(made, notable)
        if axis is not None:
            pages = service("axis_pages")(shown, axis, source.location, scale, heading)
        else:
            chosen = set(names if total <= PROFILED else ()) if profiles is None else set(profiles)
            pages = atlas_pages(
                shown, scale, heading=heading, combs=maps.comb, in_corners=maps.corner_teeth,
                profiled=lambda glyph: glyph.outline.name in chosen,
            )  # fmt: skip
        return notable._replace(pages=write_pages(path, pages))


def _shown(glyphs: Iterator[Any], notable: Atlas) -> Iterator[Any]:
    """Results, and names and errors of glyphs that failed, without those that are empty; ``notable`` gets the rest."""
    for glyph in glyphs:
        if isinstance(glyph, tuple):
            notable.failed.append(": ".join(glyph))
        elif _is_outside(glyph):
            notable.outside.append((glyph.outline if isinstance(glyph, GlyphResult) else glyph.masters).name)
        if isinstance(glyph, tuple) or glyph.contours:
            yield glyph


def _is_outside(glyph: Any) -> bool:
    """Whether a tolerance was asked for, and a contour is not within it."""
    if glyph.options.is_fixed:
        return False
    if isinstance(glyph, GlyphResult):
        return False in glyph.arrays.measures.get("within_tolerance", ())
    return not all(contour.within_tolerance for contour in glyph.contours)
