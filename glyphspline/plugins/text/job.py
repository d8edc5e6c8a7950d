"""The drawings of a text, made by a worker: the command lays the text out, a process that can be killed fits it.

A worker that is killed or dies is followed by one that tries each glyph; then the text is drawn without those at fault.
"""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import cache, partial
from typing import Any, NamedTuple

from ...errors import GlyphsplineError, OptionError
from ...fitting.convert import convert_many, unfitted
from ...fitting.options import Options
from ...fitting.results import GlyphResult
from ...outlines.outline import Outline
from ...readers.pens import NO_AREA
from ...runs.choice import is_plain
from ...runs.convert import ConvertJob
from ...runs.engine import Item, Job, choose_to_compile, reason, run, work
from ...runs.pool import TimeLimitError, WorkerLostError, sign_of_life
from ...runs.schedule import Place, place_of, sources
from ...runs.spec import LIMITS, MAPS
from ...writers.formats import format_named
from ...writers.settings import PLAIN_MAPS, Maps, Settings, paper_length
from ...writers.svg.path_data import curves_data
from .placed import LEFT_OUT, Layout


@dataclass(frozen=True)
class TextJob:
    """A text and its drawings, as a worker needs them.

    Attributes:
        layout: the text on its lines. options: of the fit. formats: names, one for each drawing.
        settings: of the drawings. each_glyph: each glyph is an element of an SVG drawing.
        fit_width: length of all ink of the lines with its unit, which makes the size; None: that of ``settings``.
        maps: what curvature maps show.
        alone: whether each glyph is a batch.
    """

    layout: Layout
    options: Options
    formats: tuple[str, ...]
    settings: Settings
    each_glyph: bool = False
    fit_width: str | None = None
    maps: Maps = PLAIN_MAPS
    alone: bool = False


class Drawings(NamedTuple):
    """The drawings of a text.

    Attributes:
        contents: bytes, in the order of the formats. notes: what is left out of them, or worth knowing.
        complete: whether no glyph is left out, all are read whole, and all contours are within the tolerance.
    """

    contents: list[bytes]
    notes: list[str]
    complete: bool


@dataclass(frozen=True)
class FitJob(Job[Outline, list[GlyphResult | GlyphsplineError]]):
    """Outlines fitted in batches, within the limits of a run."""

    options: Options

    budget = ConvertJob.budget

    def read(self, tasks: Sequence[Outline]) -> list[Item | Exception]:
        """Outlines; one that is too large is an error."""
        from ...runs.worker import items

        return items(tasks, self.options, LIMITS)

    def together(self, tasks: Sequence[Outline], contents: Sequence[Any]) -> list[GlyphResult | GlyphsplineError]:
        """The results of a batch."""
        return convert_many(contents, self.options, errors="return")

    def failed(self, task: Outline, error: Exception) -> list[GlyphResult | GlyphsplineError]:
        """Why an outline cannot be fitted."""
        return [error if isinstance(error, GlyphsplineError) else GlyphsplineError(reason(error), glyph=task.name)]


def fitted(outlines: Sequence[Outline], options: Options, alone: bool) -> list[GlyphResult | GlyphsplineError]:
    """The results of outlines, or their errors, with a sign of life after each batch, or each outline ``alone``."""
    return [result for part in work(FitJob(options), outlines, alone) for result in part.result]


@dataclass(frozen=True)
class TrialJob(Job[tuple[int, int], str | None]):
    """Glyphs by font and index read and fitted, each by itself: what is wrong with those that end their worker."""

    places: tuple[Place, ...]
    options: Options

    chunk = 1

    def item(self, task: tuple[int, int]) -> Item:
        """A glyph, with the segments that it has if it can be read."""
        (outline,) = self._read(task)
        return Item(task, 0.0 if isinstance(outline, GlyphsplineError) else len(outline.arrays.degrees))

    def _read(self, task: tuple[int, int]) -> list[Outline | GlyphsplineError]:
        font, gid = task
        return list(sources(*self.places)[font].outlines([gid], errors="return"))

    def together(self, tasks: Sequence[tuple[int, int]], contents: Sequence[Any]) -> None:
        """Nothing: a glyph that can be read and fitted, or has an error of its own, is for the text."""
        (outline,) = self._read(tasks[0])
        if not isinstance(outline, GlyphsplineError):
            fitted([outline], self.options, alone=True)

    def failed(self, task: tuple[int, int], error: Exception) -> str:
        """Why a glyph cannot be in the text."""
        return reason(error)


def draw(job: TextJob, pool: Executor) -> Drawings:
    """The drawings of a text, made in a pool. Glyphs that take too long, or end their worker, are left out of it.

    Raises:
        GlyphsplineError: as :func:`drawings`; or the text takes too long, and none of its glyphs does.
    """
    layout = job.layout
    trial, glyphs = TrialJob(tuple(map(place_of, layout.fonts)), job.options), layout.distinct()
    choose_to_compile(trial, glyphs, pool, len(glyphs))
    job = replace(job, alone=is_plain(pool))
    try:
        return pool.submit(drawings, job).result()
    except (TimeLimitError, WorkerLostError):
        unusable = {part.tasks[0]: part.result for part in run(trial, glyphs, pool) if part.result}
        if not unusable:
            raise
        return pool.submit(drawings, replace(job, layout=replace(layout, unusable=unusable))).result()


def drawings(job: TextJob) -> Drawings:
    """Fit a text and draw it in all formats; it is fitted once for all, and not at all for its source's outline.

    Raises:
        GlyphsplineError: it cannot be fitted, or a format cannot draw it.
    """
    layout, options, fit_each = job.layout, job.options, partial(fitted, alone=job.alone)
    metrics = layout.fonts[0].metrics
    notes, unread = dict[str, None](), dict[str, None]()
    outside = False

    def note(results: Sequence[GlyphResult]) -> None:
        nonlocal outside
        for result in results:
            notes.update(dict.fromkeys([*result.outline.notes, *result.notes]))
            unread.update(dict.fromkeys(f"not read of {result.outline.name}: {part}" for part in result.outline.unread))
            outside |= False in result.arrays.measures.get("within_tolerance", ())

    @cache
    def whole(fit: bool) -> GlyphResult:
        if fit:
            result = layout.convert(options, fit_each)
        else:
            (found,) = unfitted([layout.outline()], options)
            if isinstance(found, GlyphsplineError):
                raise found
            result = found
        note([result])
        return result

    def each_glyph(fit: bool) -> bytes:
        from .drawing import text_document

        results = layout.results(options, fit_each) if fit else layout.unfitted(options)
        note(results)
        settings = sized(job, layout.placed(results)) if job.fit_width else job.settings
        return text_document(layout, results, settings.look)

    contents = []
    for name in job.formats:
        form = format_named(name)
        if job.each_glyph and name in ("svg", "source"):
            contents.append(each_glyph(form.fitted))
        else:
            result = whole(form.fitted)
            settings = sized(job, result) if job.fit_width else job.settings
            write: Any = form.write
            made = write(result, settings.scaled(metrics), **({"maps": job.maps} if name in MAPS else {}))
            contents.append(made.encode() if isinstance(made, str) else made)
        sign_of_life()
    left_out = any(one.startswith(f"{LEFT_OUT}: ") or f": {LEFT_OUT}: " in one for one in notes)
    remarks = [*unread, *(one for one in notes if NO_AREA not in one)]
    return Drawings(contents, remarks, not (left_out or outside or unread))


def sized(job: TextJob, result: GlyphResult) -> Settings:
    """The settings with the length of an em with which the ink of a result is as wide as the job says.

    Raises:
        OptionError: there is no ink.
    """
    box = curves_data(result.arrays.curves, result.options.precision)[0].box
    found = paper_length("--fit-width", job.fit_width)
    if box is None or found is None:
        raise OptionError("--fit-width: the text has no ink")
    em = found[0] * result.outline.metrics.units_per_em / (box[2] - box[0])
    return replace(job.settings, look=replace(job.settings.look, em=f"{em:.9f}{found[1]}"))
