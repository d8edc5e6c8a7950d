"""A run over the masters of a variable font, or of single fonts that become one: a variable font or designspace out.

Each glyph's result is a file, and a row of the record, so that an interrupted run goes on where it was. The fonts are
written from these files at the end, glyph by glyph: results of a whole CJK font need not fit into memory.
"""

from __future__ import annotations

import json
import time
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import asdict, dataclass, replace
from functools import partial
from math import inf, isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from ...errors import GlyphsplineError, OptionError, OutputError
from ...files import remove_partials, write_whole, writing
from ...fitting.options import Options
from ...fitting.results import ContourResults, GlyphResult, not_fitted
from ...outlines.masters import DesignAxis, MasterContour, Masters
from ...outlines.outline import Contours, partly_read
from ...readers import Font, Source
from ...report import FOLDER as GALLERY
from ...report.data import contours_in
from ...runs.choice import USUAL
from ...runs.convert import tasks_of
from ...runs.engine import Item, Job, Observer, reason
from ...runs.folder import (
    Done,
    Output,
    Progress,
    Task,
    done,
    entries_of,
    progress_of,
)
from ...runs.result_text import read_result
from ...runs.schedule import Place, place_of, sources
from ...runs.spec import RESULTS, RunSpec, describe, write_run
from ...runs.summary import NAMED
from ...types import FloatArray, MadeOnDemand, counted, listed, rounded_up
from ...writers.formats import OURS
from ...writers.svg.document import PolygonData, source_data
from ...writers.svg.path_data import PathData, curves_data
from ..fonts.back.back import editable
from ..fonts.formats import back_to_source
from ..fonts.spec import RefitSpec
from ..fonts.tables.font_glyphs import SHARE, Flavour
from .convert_masters import MastersContourResult, MastersResult, check_options, convert_masters
from .designspace import Designspace
from .glyphs_file import GlyphsFile
from .redrawn import Redrawn, StoredGlyph, bound_of, of_masters
from .single_fonts import Unmatched, axis_of, masters_of_fonts
from .summary import MastersSummary

if TYPE_CHECKING:
    from ...cli.convert import Conversion
    from ...readers import Selection
    from .variable_font import VariableSummary

FORMATS = (*OURS, GALLERY, "ufo", "otf", "ttf")
"""Formats of a run over masters: drawings of the default, a gallery with sliders, a designspace with its UFOs, and
variable fonts."""


STORED = (DesignAxis, MasterContour, Masters, MastersContourResult, MastersResult)
"""The classes in a result."""


@dataclass(frozen=True, kw_only=True)
class MastersJob(Output, Job[Task, list[Done]]):
    """Glyphs of a font, or of single fonts and their axis, converted in all masters and written to files."""

    places: tuple[Place, ...]
    axis: str | None
    options: Options

    budget = 1.0

    def item(self, task: Task) -> Item:
        """A glyph, which is read when it is converted."""
        return Item(task, USUAL)

    def together(self, tasks: Sequence[Task], contents: Sequence[Any]) -> list[Done]:
        """Convert one glyph, store its result and write its drawings: those of the default master."""
        from ...runs.worker import DrawnGlyph, write_files

        (task,) = tasks
        masters = self._masters(task)
        for whole in self.spec.whole:
            if error := whole.refused(masters.instance({})):
                raise error
        if in_quadratics(self.spec):
            from .quadratic_masters import quadratic_masters

            (font, *others) = sources(*self.places)
            result = quadratic_masters(font if isinstance(font, Font) and not others else None, masters, self.options)
        else:
            result = convert_masters(masters, self.options)
        glyph, nothing = default_glyph(result), PathData("", None)
        (source,), (path,) = source_data([glyph]), curves_data(glyph.arrays.curves, self.options.precision)
        contours = [_measures(contour) for contour in result.contours]
        facts = {
            "masters": len(result.masters), "contours": contours, "notes": list(result.notes),
            "stored": None, "kept": None, "error": None,
        }  # fmt: skip
        axes = along_axes(result) if GALLERY in self.spec.formats else None
        drawn = DrawnGlyph(glyph, path, source, PolygonData(nothing, nothing), contours, result, axes)
        return [write_files(self, task, drawn, facts, _encoded)]

    def failed(self, task: Task, error: Exception) -> list[Done]:
        """The line of a glyph that has no result; it names the font that is at fault, if that is not the first."""
        others = {str(path): path.name for path, _, _ in self.places[1:]}
        where = others.get(error.font or "") if isinstance(error, GlyphsplineError) else None
        entry: dict[str, Any] = {
            "advance": None, "status": "failed", "files": {}, "masters": None, "contours": [], "notes": [],
            "stored": None, "kept": None,
            "error": f"{where}: {reason(error)}" if where else reason(error),
        }  # fmt: skip
        return [done(task, entry, encode=_encoded)]

    def _masters(self, task: Task) -> Masters:
        fonts = sources(*self.places)
        if self.axis is None:
            masters = fonts[0].masters(task.head.name)
            if error := partly_read(masters.unread):
                raise error
            return masters
        found = next(iter(masters_of_fonts(fonts, self.axis, [task.head.name])))
        if isinstance(found, Unmatched):
            raise found.error
        return found


def in_quadratics(spec: RunSpec) -> bool:
    """Whether glyphs are fitted with quadratics, as ``glyf`` stores them."""
    return spec.options.is_for_fonts and "ttf" in spec.formats


def along_axes(result: MastersResult) -> dict[str, Any]:
    """A glyph in all masters as the page mixes it: axes, regions, and the default and a delta for each region."""
    masters = result.masters
    deltas: FloatArray = np.asarray(np.linalg.inv(masters.scalars(masters.peaks)), dtype=np.float64)
    return {
        "axes": [asdict(axis) for axis in masters.axes], "regions": masters.regions.tolist(),
        "source": contours_in(deltas, [contour.source for contour in result.contours]),
        "result": contours_in(deltas, [contour.curve for contour in result.contours]),
    }  # fmt: skip


_encoded = json.JSONEncoder(ensure_ascii=False).encode


def _measures(contour: MastersContourResult) -> dict[str, Any]:
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
        "new_crossings": contour.new_crossings,
        "collapsed": contour.collapsed,
    }


def convert_font_masters(
    sources: Sequence[Source],
    glyphs: Sequence[str],
    out: Path,
    spec: RefitSpec,
    executor: Executor,
    *,
    axis: str | None = None,
    restart: bool = False,
    observer: Observer | None = None,
) -> MastersSummary:
    """Convert glyphs in all masters, and write variable fonts and a designspace.

    An earlier run in the folder with the same fonts and options is continued; its other glyphs remain.

    Args:
        sources: a variable font or designspace alone; or, with an ``axis``, the single fonts that become one.
        glyphs: names in the first of them. out: the folder.
        spec: its formats are among ``FORMATS``. executor: see :func:`.schedule.workers`.
        axis: like "wght=300:700", a value for each single font.
        restart: remove the files of an earlier run first.

    Raises:
        OutputError: the folder cannot be written, or was made with other options; a format that the font cannot have.
        GlyphsplineError: options that are not for masters.
    """
    began, first = time.perf_counter(), sources[0]
    _check(sources, spec, axis)
    if axis is None and "ttf" in spec.formats and isinstance(first, Font):  # its composites stay composites
        from .variable_font import components, flavour_of

        wanted: Sequence[str] = list(dict.fromkeys([*glyphs, *components(first, tuple(glyphs))]))
        if in_quadratics(spec) and flavour_of(first) != "ttf":
            wanted = list(first.glyph_names)  # they all become quadratics
    else:
        wanted = glyphs
    summary = MastersSummary()
    run = describe(first, spec, glyphs, None, sources[1:], axis)
    with progress_of(out, spec, run, restart) as progress:
        write_run(out, run)
        options = spec.options.for_em(first.metrics.units_per_em)
        if "ttf" in spec.formats and not in_quadratics(spec):
            options = replace(options, tolerance=SHARE * options.tolerance_for(first.metrics.units_per_em))
        job = MastersJob(out.absolute(), spec, places=tuple(map(place_of, sources)), axis=axis, options=options)
        tasks = tasks_of(first, wanted, spec.names, progress.stems)
        left = [task for task in tasks if task.head.gid not in progress.finished]
        for _ in progress.advance(job, left, executor, observer):
            pass
        for name in spec.folders:
            remove_partials(out / name)
        written = _write_fonts(sources, _results(out, progress, axis is not None), out, spec, summary, axis)
        progress.conclude(GALLERY in spec.formats, changed=partial(_with_written, *written))
        for entry in entries_of(out):
            summary.add(entry)
    summary.seconds = time.perf_counter() - began
    return summary


def _with_written(kept: Mapping[str, str], stored: Mapping[str, Any], line: bytes) -> bytes:
    """A line of the manifest that says what a font stores of the glyph, or why it has the old outline."""
    entry = json.loads(line)
    name = entry["glyph"]
    return f"{_encoded(entry | {'stored': stored.get(name), 'kept': kept.get(name)})}\n".encode()


def _check(sources: Sequence[Source], spec: RefitSpec, axis: str | None) -> None:
    """Raise before the run if its options are not for masters, or a format cannot be written."""
    font = sources[0]
    if unknown := [name for name in spec.formats if name not in FORMATS]:
        raise GlyphsplineError(f"masters become {', '.join(FORMATS)}, not {', '.join(unknown)}")
    check_options(spec.options)
    if in_quadratics(spec) and {"otf", "ufo"} & {*spec.formats}:
        raise GlyphsplineError("ttf has quadratics: ask for otf and ufo in another run, or for --continuity c2")
    if spec.is_back and (axis is not None or not isinstance(font, Designspace)):
        editable(font)
        raise OutputError("the outlines of a UFO go back without --masters", font=str(font.path))
    if axis is not None:
        axis_of(axis, len(sources))
        if "otf" in spec.formats:
            raise OutputError("single fonts become a variable font with quadratic outlines: ask for ttf, or ufo")
        return
    if _flavours(spec):
        from .variable_font import flavour_of

        if not isinstance(font, Font):
            raise OutputError("a designspace has no font whose outlines could be replaced: ask for ufo")
        flavour_of(font)


def _flavours(spec: RefitSpec) -> list[Flavour]:
    return [flavour for flavour in ("otf", "ttf") if flavour in spec.formats]


def _results(out: Path, progress: Progress, with_empty: bool) -> Mapping[str, Redrawn]:
    """The new contours of the folder's glyphs by name, each read from its file when it is asked for."""
    files = {}
    for entry in map(json.loads, (known.line for known in progress.entries())):
        path = entry["files"].get(RESULTS)  # None in a run of drawings alone
        if path and (entry["status"] == "ok" or (with_empty and entry["status"] == "empty")):
            files[entry["glyph"]] = path
    return MadeOnDemand(files, lambda name: redrawn_glyph(read_result(out / files[name], MastersResult, STORED)))


def default_glyph(result: MastersResult) -> GlyphResult:
    """The default master of a result and of its source, as single outlines are drawn; nothing is measured."""
    weights = np.eye(len(result.masters))[0]
    source, curves = (
        Contours([each.mixed(weights) for each in contours]).arrays
        for contours in ([each.source for each in result.contours], [each.curve for each in result.contours])
    )
    contours = ContourResults(not_fitted(source, curves), 0, len(result.contours))
    return GlyphResult(replace(result.mixed(weights), contours=Contours(source)), result.options, contours)


def redrawn_glyph(result: MastersResult) -> Redrawn:
    """A result as the writers of variable fonts take it."""
    contours, every = result.contours, iter(enumerate(result.masters.contours))
    # Contours that enclose nothing have no result.
    numbers = [next(k for k, each in every if np.array_equal(each.points, c.source.points)) for c in contours]
    return Redrawn(
        result.masters, tuple(c.curve for c in contours), tuple(c.inner for c in contours),
        tuple(c.deviation_bound for c in contours), tuple(numbers), result.options.corners == "sharp",
        result.tally,
    )  # fmt: skip


def _stored(glyph: StoredGlyph, redrawn: Mapping[str, Redrawn], name: str, tolerance: float) -> dict[str, Any]:
    """What the manifest says of a glyph as a font stores it."""
    bound, counts = bound_of(glyph, redrawn[name]), dict[str, Any]()
    if glyph.tally is not None:
        counts = dict(zip(("points", "kinks", "kinks_between_masters"), glyph.tally.tolist(), strict=True))
    return {**_bounded(bound, tolerance), **counts}


def _bounded(bound: float, tolerance: float) -> dict[str, Any]:
    return {"bound": rounded_up(bound, 6) if isfinite(bound) else None, "within_tolerance": bool(bound <= tolerance)}


def _replaced(path: Path, facts: VariableSummary, bounds: Sequence[float]) -> str:
    """What became of the glyphs of a written font, in words."""
    remark = f"{path.name}: {counted(len(facts.glyphs), 'glyph')} replaced"
    if bounds:
        remark += f", certified as stored within {rounded_up(max(bounds), 3):g} units of the source"
    if (tally := facts.tally) is not None:
        points, kinks, between = (f"{before:,} → {after:,}" for before, after in tally.tolist())
        what = "points" if path.suffix == ".ttf" else "segments"
        remark += f"; {what} {points}, kinks at masters and along axes {kinks}, of them between masters {between}"
    return remark


def _font(
    sources: Sequence[Source], redrawn: Mapping[str, Redrawn], flavour: Flavour, spec: RefitSpec, axis: str | None
) -> tuple[bytes, VariableSummary]:
    """A variable font of the new contours: the source's own, with outlines of its kind or the other, or a new one."""
    from .new_variable_font import to_new_variable_font
    from .other_outlines import to_other_outlines
    from .variable_font import flavour_of, to_variable_font

    source = sources[0]
    tolerance = spec.options.tolerance_for(source.metrics.units_per_em)
    rest = (1 - SHARE) * tolerance
    family = spec.family_of(source)
    if axis is not None:
        return to_new_variable_font(sources, axis, redrawn, tolerance=rest, family=family)
    assert isinstance(source, Font)
    how: dict[str, Any] = {"tolerance": tolerance, "family": None if spec.keep_name else family}
    if flavour == flavour_of(source):
        return to_variable_font(source, redrawn, flavour, **how)
    return to_other_outlines(source, redrawn, flavour, rest=rest, **how)


def _write_fonts(
    sources: Sequence[Source],
    redrawn: Mapping[str, Redrawn],
    out: Path,
    spec: RefitSpec,
    summary: MastersSummary,
    axis: str | None,
) -> tuple[dict[str, str], dict[str, Any]]:
    """Write the run's fonts; returns why glyphs of them have their old outlines, and what is stored of the others."""
    source, stays, stored = sources[0], dict[str, str](), dict[str, Any]()
    tolerance = spec.options.tolerance_for(source.metrics.units_per_em)
    paths = {each.name: each.path(source, out) for each in spec.files}
    for flavour in _flavours(spec):
        path = paths[flavour]
        with writing(path):
            data, facts = _font(sources, redrawn, flavour, spec, axis)
            write_whole(str(path), data, durable=True)
        stored |= {name: _bounded(bound, tolerance) for name, bound in facts.composed.items()}
        stored |= {name: _stored(glyph, redrawn, name, tolerance) for name, glyph in facts.glyphs.items()}
        summary.remarks.append(_replaced(path, facts, [each["bound"] or inf for each in stored.values()]))
        stays |= facts.left
    if isinstance(source, Designspace) and ("ufo" in spec.formats or spec.is_back):
        copy = paths.get("ufo")
        if copy and isinstance(source, GlyphsFile):
            copy = copy.with_suffix(".glyphs")
        for to in [copy] * ("ufo" in spec.formats) + [None] * spec.is_back:
            summary.remarks += back_to_source(source, of_masters(source, redrawn), spec, to)
    elif "ufo" in spec.formats:
        from .new_designspace import write_designspace

        left = write_designspace(source, redrawn, paths["ufo"])
        summary.remarks.append(f"designspace: {counted(len(redrawn) - len(left), 'glyph')}")
        stays |= left
    if stays:
        named = listed([*stays][:NAMED], len(stays))
        summary.remarks.append(f"{counted(len(stays), 'glyph')} as it was: {named}; the manifest says why")
    return stays, stored


def refit_masters(
    paths: Sequence[Path], call: Conversion, axis: str | None, executor: Executor
) -> tuple[Selection, MastersSummary]:
    """Fit a variable font or designspace, or single fonts that become one, in all masters.

    Args:
        paths: one, or with an ``axis`` several. call: of ``refit``.

    Returns:
        The glyphs that were asked for, and the summary.
    """
    if (len(paths) > 1) != (axis is not None):
        raise OptionError("several fonts become masters on --axis TAG=A:B; one font has masters of its own")
    from ...cli.convert import chosen, opened
    from ...cli.messages import progress

    run, spec = call.run, cast(RefitSpec, call.spec)
    sources = [opened(path, call.instance, run.quiet) for path in paths]
    names = chosen(sources[0], call.subset, run.quiet)
    with progress(run.quiet, json_lines=run.as_json) as observer:
        return names, convert_font_masters(
            sources, names, call.out, spec, executor, axis=axis, restart=not run.resume, observer=observer
        )
