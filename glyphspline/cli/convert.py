"""The command ``convert``: the workers, a folder for each face, progress, and the summary."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from ..errors import GlyphsplineError, OutputError
from ..runs.spec import RunSpec
from ..types import listed
from . import arguments as opt
from .groups import grouped, without
from .messages import print_json, progress, say, stop
from .tables import FontRun, runs_facts, runs_table, with_character

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from ..readers import Selection, Source
    from ..runs.summary import Summary


@dataclass(frozen=True)
class Conversion:
    """A call of ``convert`` or ``refit``.

    Attributes:
        out: folder. spec: how glyphs are converted, and what is written. subset: which glyphs. instance: of the font.
        run: how the command runs, and what it prints. stays: whether the folder is there when the command has ended.
    """

    out: Path
    spec: RunSpec
    subset: opt.Subset
    instance: opt.Instance
    run: opt.RunOptions
    stays: bool = True


@grouped
def convert(
    fonts: opt.FontFiles,
    out: opt.Out,
    spec: Annotated[RunSpec, without(*RunSpec.unshown)],
    subset: opt.Subset,
    instance: opt.Instance,
    run: opt.RunOptions,
) -> bool:
    """Convert glyphs of fonts to SVG drawings and curvature maps, with a manifest and an index.

    One font goes to the folder itself, several to a folder each in it, each face of a collection to one in that.

    Of several fonts, or a folder, glob or list of them, every glyph is converted unless some are asked for.
    """
    call = Conversion(out, spec, subset, instance, run)
    with workplace(run, call.spec) as executor:  # first: workers start while fonts are opened
        from ..runs.font_search import find_fonts

        found = find_fonts(fonts)
        if not found:
            stop("no fonts found")
        alone = found == [Path(fonts[0])] and len(fonts) == 1
        runs = convert_fonts(found, call, executor, alone)
    if not (run.quiet or run.as_json or alone):
        say(f"written to {out}")
        say(runs_table(runs))
    if run.as_json:
        print_json(runs_facts(runs))
    return any(one.undone for one in runs)


def workplace(run: opt.RunOptions, *specs: RunSpec) -> AbstractContextManager[Executor]:
    """The executor of runs: worker processes, or a cluster."""
    from ..runs.schedule import workers

    kinds = dict.fromkeys(kind for one in specs for kind in one.kinds)
    scheduler = run.scheduler
    jobs = None if scheduler else run.processes
    return workers(jobs, specs[0].limits.seconds, kinds, 1, scheduler=scheduler)


def convert_fonts(fonts: Sequence[Path], call: Conversion, executor: Executor, alone: bool) -> list[FontRun]:
    """Convert one font alone into the folder itself, or several, each face into a folder of its own.

    Of several, every glyph is converted unless some are asked for, and a font that cannot be read is passed over.
    """
    from ..runs.choice import choice_of
    from ..runs.file_names import folders_for
    from ..runs.folder import locked
    from ..runs.font_search import faces_of
    from ..runs.summary import Summary

    face_index, folders, location = call.instance.face_index, [call.out], call.instance.place
    if alone:
        face_index = face_index or 0
    else:
        if not call.subset.is_given:
            call = replace(call, subset=opt.Subset(all_glyphs=True))
        folders = [call.out / name for name in folders_for(fonts)]
    quiet = call.run.quiet or call.run.as_json
    runs: list[FontRun] = []
    if choice := choice_of(executor):
        choice.sources = len(fonts)
    with nullcontext() if alone else locked(call.out):
        for font, folder in zip(fonts, folders, strict=True):
            try:
                for source in faces_of(font, location, face_index):
                    name, out = str(font), folder
                    if alone:
                        say_face(source, call.instance, quiet)
                    elif source.num_faces > 1:
                        name, out = f"{font}, face {source.face_index}", folder / f"face-{source.face_index}"
                    shown = None if alone else name
                    names = chosen(source, call.subset, call.run.quiet, shown)
                    runs.append(FontRun(name, out, run_face(source, names, replace(call, out=out), executor, shown)))
            except GlyphsplineError as error:
                if alone or isinstance(error, OutputError):
                    raise
                if quiet:  # or else it is below the table
                    say(str(error))
                runs.append(FontRun(str(font), folder, Summary(), str(error)))
    return runs


def chosen(source: Source, subset: opt.Subset, quiet: bool, name: str | None = None) -> Selection:
    """The glyphs that are asked for, with the ``name`` of one font of several in what is said of them.

    Said is what is not in the font, and what is shown by several glyphs.

    The command ends if there are none of them in a font alone.
    """
    names = subset.of(source)
    before = f"{name}: " if name else ""
    say_missing(() if quiet else names.missing, before)
    if names.composed and not quiet:
        composed = [f"{character} ({', '.join(of)})" for character, of in islice(names.composed.items(), 10)]
        say(f"{before}drawn by several glyphs: {listed(composed, len(names.composed))}")
    if name is None and not names:
        stop("none of the glyphs asked for is in the font")
    return names


def say_missing(missing: Sequence[str], before: str = "") -> None:
    """Name what is asked for and not in a font, by the phrases of :class:`.Selection`."""
    if missing:
        say(f"{before}not in the font: {listed([with_character(one) for one in missing[:10]], len(missing))}")


def say_face(source: Source, instance: opt.Instance, quiet: bool) -> None:
    """Name the face of a collection that is taken where none is asked for."""
    if source.num_faces > 1 and instance.face_index is None and not quiet:
        name = f"{source.family} {source.style}".strip()
        say(f"face {source.face_index} of {source.num_faces} is taken, {name}: --face-index N takes another")


def opened(font: Path, instance: opt.Instance, quiet: bool) -> Source:
    """A font, at the face and the place that are asked for."""
    from ..readers import open_source

    source = open_source(font, instance.face_index or 0, instance.place)
    say_face(source, instance, quiet)
    return source


def run_face(
    source: Source, names: Sequence[str], call: Conversion, executor: Executor, name: str | None = None
) -> Summary:
    """Convert glyphs with progress on a terminal, then print the summary; ``name`` is that of one font of several."""
    from ..report import FOLDER as GALLERY
    from ..runs.convert import convert_font

    run, out = call.run, call.out
    with progress(run.quiet, json_lines=run.as_json) as observer:
        summary = convert_font(
            source, names, out, call.spec, executor=executor, restart=not run.resume, observer=observer
        )
    if not (run.quiet or run.as_json):
        seen = f"; open {out / 'index.html'}" if GALLERY in call.spec.formats else f"; written to {out}"
        say(f"{name}: {summary.headline()}" if name else f"{summary.headline()}{seen if call.stays else ''}")
        for line in summary.lines():
            say(f"  {line}" if name else line)
    return summary
