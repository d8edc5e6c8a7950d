"""Runs over fonts: the workers, a folder for each face, progress, and the summary."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, nullcontext, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from . import arguments as opt
from .messages import say, stop
from .progress import json_lines, progress

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from ..batch import RunSpec, Summary
    from ..readers import Source
    from .closing import FontRun

LOOKED_AT = 64
"""Outlines that are looked at to tell type from brush."""


@contextmanager
def workplace(jobs: int | None, scheduler: str | None, spec: RunSpec) -> Iterator[Executor]:
    """The executor of a run: worker processes (None: one a core, 0: none, in this process), or a cluster."""
    from ..batch.schedule import workers

    with workers(
        jobs, spec.limits.seconds, spec.options, spec.formats, 1, spec.masters, scheduler=scheduler
    ) as executor:
        yield executor


def convert_fonts(
    fonts: Sequence[Path], spec: RunSpec, executor: Executor, given: Mapping[str, Any], alone: bool
) -> list[FontRun]:
    """Convert one font alone into the folder itself, or several, each face into a folder of its own.

    Of several, every glyph is converted unless some are asked for, and a font that cannot be read is passed over.
    """
    from ..batch import OutputError, faces_of, folders_for, locked
    from ..errors import GlyphsplineError
    from .closing import FontRun

    if alone:
        given, folders = {**given, "face_index": given["face_index"] or 0}, [given["out"]]
    else:
        given = {**given, "every": given["every"] or not opt.is_selected(given)}
        folders = [given["out"] / name for name in folders_for(fonts)]
    location = opt.location_of(given["location"])
    runs: list[FontRun] = []
    with nullcontext() if alone else locked(given["out"]):
        for font, folder in zip(fonts, folders, strict=True):
            try:
                for source in faces_of(font, location, given["face_index"]):
                    runs.append(convert_face(source, str(font), folder, spec, executor, given, alone))
            except GlyphsplineError as error:
                if alone or isinstance(error, OutputError):
                    raise
                if given["quiet"] or given["json_log"]:  # or else it is said below the table
                    say(str(error))
                runs.append(FontRun(str(font), folder, error=str(error)))
    return runs


def convert_face(
    source: Source, name: str, out: Path, spec: RunSpec, executor: Executor, given: Mapping[str, Any], alone: bool
) -> FontRun:
    """Convert one face of the font called ``name``; those of a collection go to a folder each unless it is alone."""
    from .closing import FontRun, missing_words

    if source.num_faces > 1 and not alone:
        name, out = f"{name}, face {source.face_index}", out / f"face-{source.face_index}"
    quiet, json_log = given["quiet"], given["json_log"]
    names = opt.selection_of(source, given)
    if names.missing and not quiet:
        say(("" if alone else f"{name}: ") + f"not in the font: {missing_words(names.missing)}")
    if alone and not names:
        stop("none of the glyphs asked for is in the font")
    heading, restart = None if alone else name, not given["resume"]
    summary = run(source, names, out, spec, executor, restart=restart, quiet=quiet, json_log=json_log, name=heading)
    if alone and not (quiet or json_log) and looks_like_type(source, names, spec, executor):
        say("most joints of these glyphs are corners or lines, which --corners sharp (or --preset type) keeps")
    return FontRun(name, out, summary)


NOT_OF_MASTERS = {
    "location": "masters are of the whole design space",
    "scheduler": "masters are converted on this machine",
    "each": "a run over masters has one folder",
}
"""Options that a run over masters does not have, and why."""


def check_masters(given: Mapping[str, Any]) -> None:
    """Stop if the options of a run over masters clash."""
    if bool(given["others"]) != bool(given["axis"]):
        stop("--from FONT and --axis TAG=A:B go together")
    for name, why in NOT_OF_MASTERS.items():
        if given[name]:
            stop(f"--{name} is not for --masters: {why}")


def convert_masters(fonts: Sequence[Path], spec: RunSpec, executor: Executor, given: Mapping[str, Any]) -> bool:
    """Convert a variable font, or single fonts that become one, in all masters; whether a glyph failed."""
    from ..batch import convert_font_masters
    from ..readers import open_source

    others, axis = given["others"] or [], given["axis"]
    if len(fonts) != 1:
        stop("--masters takes one font")
    quiet, json_log = given["quiet"], given["json_log"]
    sources = [open_source(font, given["face_index"] or 0) for font in (*fonts, *others)]
    names = opt.selection_of(sources[0], given)
    if not names:
        stop("none of the glyphs asked for is in the font")
    with json_lines() if json_log else progress(quiet) as observer:
        summary = convert_font_masters(
            sources, names, given["out"], spec, executor, axis=axis, restart=not given["resume"], observer=observer
        )
    facts = {"font": str(fonts[0]), "out": str(given["out"]), **summary.facts()}
    if json_log:
        say(json.dumps(facts))
    elif not quiet:
        for line in summary.lines():
            say(line)
    if given["as_json"]:
        typer.echo(json.dumps(facts, indent=1, ensure_ascii=False))
    return bool(summary.failed)


def run(
    source: Source,
    names: Sequence[str],
    out: Path,
    spec: RunSpec,
    executor: Executor,
    *,
    restart: bool,
    quiet: bool,
    json_log: bool = False,
    name: str | None = None,
) -> Summary:
    """Convert glyphs with progress on a terminal, then print the summary; ``name`` is that of one font of several."""
    from ..batch import convert_font
    from ..report.gallery_files import FOLDER as GALLERY

    with json_lines() if json_log else progress(quiet) as observer:
        summary = convert_font(source, names, out, spec, executor=executor, restart=restart, observer=observer)
    if json_log:
        say(json.dumps({"out": str(out), **summary.facts()}))
    elif not quiet:
        seen = f"open {out / 'index.html'}" if GALLERY in spec.formats else f"written to {out}"
        say(f"{name}: {summary.headline()}" if name else f"{summary.headline()}; {seen}")
        for line in summary.lines():
            say(f"  {line}" if name else line)
    return summary


def looks_like_type(source: Source, names: Sequence[str], spec: RunSpec, executor: Executor) -> bool:
    """Whether a run in smooth mode is over glyphs most of whose joints are corners or ends of lines."""
    from ..batch.jobs.glyphs import Task
    from ..batch.jobs.survey import corners_of
    from ..batch.places import side_of
    from ..errors import GlyphsplineError

    if spec.options.corners != "smooth" or spec.options.is_fixed or not spec.is_fitted:
        return False
    chosen = names[:: max(len(names) // LOOKED_AT, 1)][:LOOKED_AT]
    tasks = [Task(source.glyph_names.index(name), name, "", ()) for name in chosen]
    with suppress(GlyphsplineError):  # its worker is lost or killed: nothing is known of these glyphs
        return executor.submit(corners_of, side_of(source), tasks).result() > 0.5
    return False
