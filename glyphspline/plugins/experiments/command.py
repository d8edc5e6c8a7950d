"""The command ``experiment``: the paper's figures and tables for any character."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from ...cli import arguments as opt
from ...cli.convert import Conversion, chosen, workplace
from ...cli.groups import grouped, without
from ...cli.messages import progress, say, stop
from ...errors import GlyphsplineError
from .spec import ExperimentSpec

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from ...readers import Selection, Source


@grouped
def experiment(
    fonts: opt.FontFiles,
    out: opt.Out,
    spec: Annotated[ExperimentSpec, without(*ExperimentSpec.unshown)],
    subset: opt.Subset,
    instance: opt.Instance,
    run: Annotated[opt.RunOptions, without("as_json")],
) -> bool:
    """Make the paper's figures and tables for any characters: variants side by side, and peers.

    A sheet of each of the first characters has the original, the polygon, the curves, a zoom where they differ most,
    curvature maps on one scale, and the error at each step. Tables have a row for each contour and method; several
    fonts come into the same tables. Without glyphs asked for it takes those of --clicked, or all.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # of workers: systems are small, and threads wait for each other
    with workplace(run, spec) as executor:  # first: workers start while fonts are opened
        from ...runs.font_search import find_fonts

        found = find_fonts(fonts)
        if not found:
            stop("no fonts found")
        alone = found == [Path(fonts[0])] and len(fonts) == 1
        return experiment_fonts(found, Conversion(out, spec, subset, instance, run), executor, alone)


def demonstrate(font: Path, text: str, clicked: Path | None, out: Path, run: opt.RunOptions, executor: Executor) -> str:
    """Experiments on the characters of a font that it has, as the demonstration shows them; the page."""
    spec = ExperimentSpec(clicked=clicked, formats=("png",))
    call = Conversion(out, spec, opt.Subset(text), opt.Instance(), replace(run, resume=False))
    experiment_fonts([font], call, executor, alone=True)
    return str(out / "index.html")


def experiment_fonts(fonts: Sequence[Path], call: Conversion, executor: Executor, alone: bool) -> bool:
    """Experiments on one font alone, into the folder itself, or on several, each face into a folder of its own.

    Tables and page are of all. Whether something asked for was not done: a font that cannot be read is passed over.
    """
    from ...runs.file_names import folders_for
    from .page import write_report
    from .run import experiment_face

    assert isinstance(call.spec, ExperimentSpec)
    undone, folders = False, list[Path]()
    for font, name in zip(fonts, folders_for(fonts), strict=True):
        try:
            for source in _faces(font, call, alone):
                glyphs = _glyphs(source, call, None if alone else str(font))
                face = f"face-{source.face_index}" if source.num_faces > 1 else ""
                out = call.out if alone else call.out / name / face
                with progress(call.run.quiet) as observer:
                    experiment_face(
                        source, glyphs, out, call.spec, executor, restart=not call.run.resume, observer=observer
                    )
                folders.append(out)
                undone |= bool(glyphs.missing)
        except GlyphsplineError as error:
            if alone:
                raise
            say(str(error))
            undone = True
    failed, lines = write_report(call.out, folders, call.spec)
    for line in () if call.run.quiet else lines:
        say(line)
    return undone or failed


def _faces(font: Path, call: Conversion, alone: bool) -> Iterator[Source]:
    """The faces of a font: of one alone the first, unless another is asked for."""
    from ...runs.font_search import faces_of

    index = call.instance.face_index
    return faces_of(font, call.instance.place, 0 if alone and index is None else index)


def _glyphs(source: Source, call: Conversion, name: str | None) -> Selection:
    """The glyphs asked for; without any, those that points are clicked of, or all."""
    from .polygons import read_clicked
    from .run import of_glyphs

    subset, spec = call.subset, call.spec
    if not subset.is_given:
        subset = opt.Subset(all_glyphs=True)
        if isinstance(spec, ExperimentSpec) and spec.clicked is not None:
            subset = opt.Subset(glyphs=",".join(of_glyphs(source, read_clicked(spec.clicked))))
    return chosen(source, subset, call.run.quiet, name)
