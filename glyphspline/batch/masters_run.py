"""Runs over the masters of a variable font, or of single fonts that become one: a variable font or a designspace out.

Each glyph's result is a file, written whole, so that an interrupted run goes on where it was; the fonts are written
from these files at the end.
"""

from __future__ import annotations

import json
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NamedTuple

from ..errors import GlyphsplineError, OutputError
from ..fitting.convert_masters import MastersResult, convert_masters
from ..fitting.options import Options
from ..outlines.masters import Masters
from ..readers import Font, Source
from ..readers.single_fonts import Unmatched, masters_of_fonts
from ..types import counted, rounded_up
from ..writers.font.font_glyphs import Flavour
from ..writers.font.master_deltas import Redrawn
from .files import make_folder, write_whole, writing
from .font_run import Observer, prepare, tasks_of
from .job import Place, Task
from .lock import locked
from .manifest import MANIFEST
from .pool import sign_of_life
from .schedule import chunks_of, spread
from .spec import RESULTS, RunSpec, describe, write_run
from .store import from_text, to_text
from .whole import file_stem
from .worker import source_of

FORMATS = ("ufo", "otf", "ttf")
"""Formats of a run over masters: a designspace with its UFOs, and variable fonts."""

UNMATCHED = "unmatched"
"""The folder of pictures of glyphs whose outlines in single fonts cannot be matched."""

SHARE = 0.5
"""Share of the tolerance that the curves may use where quadratics are fitted to them, which take the rest."""

NAMED = 5
"""Glyphs that the summary names of those that are left as they were."""


class MastersJob(NamedTuple):
    """What a worker needs: the font, or the single fonts and their axis; the folder of results; the options."""

    places: tuple[Place, ...]
    axis: str | None
    results: Path
    options: Options


class Converted(NamedTuple):
    """What a worker reports of a glyph: why it failed, or None."""

    task: Task
    error: str | None


@dataclass
class MastersSummary:
    """The summary of a run over masters."""

    glyphs: int = 0
    failed: dict[str, str] = field(default_factory=dict)
    outside: list[str] = field(default_factory=list)
    stopping: list[str] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)
    segments: int = 0
    source_segments: int = 0
    bound: float = 0.0
    seconds: float = 0.0

    def lines(self) -> Iterator[str]:
        """What is said at the end of a run."""
        said = f"{counted(self.glyphs, 'glyph')} in all masters at once, {self.segments} segments"
        yield f"{said} for {self.source_segments} of the source, certified within {rounded_up(self.bound, 3):g} units"
        if self.outside:
            yield f"{counted(len(self.outside), 'glyph')} outside the tolerance: {_few(self.outside)}"
        if self.stopping:
            yield f"{counted(len(self.stopping), 'glyph')} not proven free of cusps everywhere: {_few(self.stopping)}"
        for name, error in list(self.failed.items())[:NAMED]:
            yield f"failed: {name}: {error}"
        if len(self.failed) > NAMED:
            yield f"failed: {len(self.failed) - NAMED} more, which the manifest lists"
        yield from self.remarks


def convert_font_masters(
    sources: Sequence[Source],
    glyphs: Sequence[str],
    out: Path,
    spec: RunSpec,
    executor: Executor,
    *,
    axis: str | None = None,
    restart: bool = False,
    observer: Observer | None = None,
) -> MastersSummary:
    """Convert glyphs in all masters, and write variable fonts and a designspace.

    Args:
        sources: a variable font or designspace alone; or, with an ``axis``, the single fonts that become one.
        glyphs: names in the first of them. out: the folder; an earlier run in it with the same options is continued.
        spec: its formats are among ``FORMATS``. executor: see :func:`.schedule.workers`.
        axis: like "wght=300:700", a value for each single font.

    Raises:
        OutputError: the folder cannot be written, or was made with other options; a format that the font cannot have.
        GlyphsplineError: options that are not for masters.
    """
    began, first = time.perf_counter(), sources[0]
    unknown = [name for name in spec.formats if name not in FORMATS]
    if unknown:
        raise GlyphsplineError(f"masters become {', '.join(FORMATS)}, not {', '.join(unknown)}")
    _check(sources, spec, axis)
    with locked(out):
        prepare(first, glyphs, out, spec, restart, sources[1:], axis)
        write_run(out, describe(first, spec, glyphs, None, sources[1:], axis))
        tasks = tasks_of(first, glyphs if axis else _with_components(first, glyphs, spec))
        summary = MastersSummary()
        options = spec.options
        if "ttf" in spec.formats:
            options = replace(options, tolerance=SHARE * options.tolerance_for(first.metrics.units_per_em))
        places = tuple((s.path.absolute(), s.face_index, tuple(s.location.items())) for s in sources)
        job = MastersJob(places, axis, out.absolute() / RESULTS, options)
        left = [task for task in tasks if not (job.results / f"{task.stem}.json").exists()]
        done = len(tasks) - len(left)
        for chunk, found in spread(executor, convert_tasks, job, chunks_of(left, executor)):
            if isinstance(found, Exception):
                summary.failed |= {task.name: str(found) for task in chunk}
            else:
                summary.failed |= {task.name: error for task, error in found if error is not None}
            done += len(chunk)
            if observer:
                observer(done, len(tasks), len(summary.failed))
        results = {task.name: result for task in tasks if (result := _stored(job.results, task)) is not None}
        _count(summary, results)
        stays = _write_fonts(sources, results, out, spec, summary, axis)
        _write_manifest(out, tasks, results, summary, stays)
    summary.seconds = time.perf_counter() - began
    return summary


def convert_tasks(job: MastersJob, tasks: Sequence[Task]) -> list[Converted]:
    """Convert glyphs in all masters and store their results, in a worker. A glyph that fails costs only itself."""
    done = []
    for task in tasks:
        sign_of_life()
        try:
            result = convert_masters(_masters(job, task), job.options)
            write_whole(str(job.results / f"{task.stem}.json"), to_text(result))
            error = None
        except OutputError:
            raise
        except GlyphsplineError as why:
            error = str(why)
        except Exception as why:  # a broken font raises anything
            error = f"{type(why).__name__}: {why}"
        done.append(Converted(task, error))
    return done


def _masters(job: MastersJob, task: Task) -> Masters:
    sources = [source_of(*place) for place in job.places]
    if job.axis is None:
        return sources[0].masters(task.name)
    found = next(iter(masters_of_fonts(sources, job.axis, [task.name])))
    if isinstance(found, Unmatched):
        from ..writers.svg.unmatched import to_unmatched_svg

        if found.outlines:
            folder = job.results.parent / UNMATCHED
            make_folder(folder)
            write_whole(str(folder / f"{task.stem}.svg"), to_unmatched_svg(found.outlines, found.error.message))
        raise found.error
    return found


def _check(sources: Sequence[Source], spec: RunSpec, axis: str | None) -> None:
    """Raise before the run if a format cannot be written."""
    font = sources[0]
    if axis is not None and "otf" in spec.formats:
        raise OutputError("single fonts become a variable font with quadratic outlines: ask for ttf, or ufo")
    for flavour in ("otf", "ttf"):
        if flavour in spec.formats and axis is None:
            from ..writers.font.variable_font import check_flavour

            if not isinstance(font, Font):
                raise OutputError("a designspace has no font whose outlines could be replaced: ask for ufo")
            check_flavour(font, flavour)


def _with_components(source: Source, glyphs: Sequence[str], spec: RunSpec) -> Sequence[str]:
    """The glyphs, and those that they are made of if the font's composites stay composites."""
    if "ttf" not in spec.formats or not isinstance(source, Font):
        return glyphs
    from ..writers.font.variable_font import components

    return list(dict.fromkeys([*glyphs, *components(source, tuple(glyphs))]))


def _stored(folder: Path, task: Task) -> MastersResult | None:
    path = folder / f"{task.stem}.json"
    try:
        result = from_text(path.read_text(encoding="utf-8"), MastersResult)
    except FileNotFoundError:
        return None
    except (OSError, ValueError) as error:
        raise OutputError(f"cannot be read: {error}", font=str(path)) from error
    return result


def _count(summary: MastersSummary, results: dict[str, MastersResult]) -> None:
    summary.glyphs = len(results)
    for name, result in results.items():
        for contour in result.contours:
            summary.segments += len(contour.curve)
            summary.source_segments += len(contour.source)
            summary.bound = max(summary.bound, contour.deviation_bound)
        if not all(contour.within_tolerance for contour in result.contours):
            summary.outside.append(name)
        if not all(contour.regular for contour in result.contours):
            summary.stopping.append(name)


def _write_fonts(
    sources: Sequence[Source],
    results: dict[str, MastersResult],
    out: Path,
    spec: RunSpec,
    summary: MastersSummary,
    axis: str | None,
) -> dict[str, str]:
    """Write the run's fonts; returns why glyphs of them have their old outlines."""
    source, stays = sources[0], dict[str, str]()
    redrawn = {name: redrawn_glyph(result) for name, result in results.items() if result.contours or axis}
    tolerance = spec.options.tolerance_for(source.metrics.units_per_em)
    flavours: list[Flavour] = [flavour for flavour in ("otf", "ttf") if flavour in spec.formats]
    for flavour in flavours:
        path = out / f"{file_stem(source)}.{flavour}"
        with writing(path):
            if axis is None:
                from ..writers.font.variable_font import to_variable_font

                assert isinstance(source, Font)
                data, facts = to_variable_font(source, redrawn, flavour, tolerance=(1 - SHARE) * tolerance)
            else:
                from ..writers.font.new_variable_font import to_new_variable_font

                left = dict(summary.failed)
                data, facts = to_new_variable_font(sources, axis, redrawn, left=left, tolerance=(1 - SHARE) * tolerance)
            write_whole(str(path), data, durable=True)
        remark = f"{path.name}: {counted(len(facts.glyphs), 'glyph')} replaced"
        if facts.largest_distance is not None:
            remark += f", stored within {rounded_up(facts.largest_distance, 3):g} units of the curves"
        summary.remarks.append(remark)
        stays |= facts.left
    if "ufo" in spec.formats:
        from ..writers.designspace_folder import write_designspace

        left = write_designspace(source, redrawn, out / f"{file_stem(source)}.ufo")
        summary.remarks.append(f"designspace: {counted(len(redrawn) - len(left), 'glyph')}")
        stays |= left
    if stays:
        summary.remarks.append(f"{counted(len(stays), 'glyph')} as it was: {_few(list(stays))}; the manifest says why")
    return stays


def redrawn_glyph(result: MastersResult) -> Redrawn:
    """A result as the writers of variable fonts take it."""
    contours = result.contours
    return Redrawn(result.masters, tuple(c.curve for c in contours), tuple(c.inner for c in contours))


def _write_manifest(
    out: Path, tasks: Sequence[Task], results: dict[str, MastersResult], summary: MastersSummary, stays: dict[str, str]
) -> None:
    """A line for each glyph, in glyph index order."""
    lines = []
    for task in tasks:
        result = results.get(task.name)
        line: dict[str, Any] = {
            "glyph": task.name,
            "gid": task.gid,
            "unicodes": [f"U+{code:04X}" for code in task.unicodes],
            "status": "failed" if result is None else ("ok" if result.contours else "empty"),
            "masters": None if result is None else len(result.masters),
            "contours": [] if result is None else [_measures(contour) for contour in result.contours],
            "notes": [] if result is None else list(result.notes),
            "kept": stays.get(task.name),
            "error": summary.failed.get(task.name),
        }
        lines.append(json.dumps(line, ensure_ascii=False))
    write_whole(str(out / MANIFEST), "".join(f"{line}\n" for line in lines), durable=True)


def _measures(contour: Any) -> dict[str, Any]:
    rate = contour.rate_bound
    return {
        "segments": len(contour.curve),
        "source_segments": len(contour.source),
        "iterations": contour.iterations,
        "rate_bound": None if rate is None else rounded_up(rate, 6),
        "deviation_bound": rounded_up(contour.deviation_bound, 6),
        "within_tolerance": contour.within_tolerance,
        "source_segments_kept": contour.kept,
        "regular": contour.regular,
    }


def _few(names: Sequence[str]) -> str:
    return ", ".join(names[:NAMED]) + (", …" if len(names) > NAMED else "")
