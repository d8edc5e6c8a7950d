"""The command ``experiment``: the paper's figures and tables for any character."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from ..errors import GlyphsplineError
from ..experiments.spec import ExperimentSpec
from . import arguments as opt
from .convert import chosen, workplace
from .groups import grouped, without
from .messages import progress, say, stop


@grouped
def experiment(
    fonts: opt.FontFiles,
    out: opt.Out,
    spec: Annotated[ExperimentSpec, without(*ExperimentSpec.unshown)],
    subset: opt.Subset,
    instance: opt.Instance,
    run: Annotated[opt.RunOptions, without("as_json")],
) -> bool:
    """Make the paper's figures and tables for any characters: variants and peers through one polygon a contour.

    A sheet of each of the first characters has the original, the polygon, the curves, a zoom where they differ most,
    curvature maps on one scale, and the error at each step. Tables have a row for each contour and method; several
    fonts come into the same tables. Without glyphs asked for it takes those of --clicked, or all.
    """
    with workplace(run, spec) as executor:  # first: workers start while fonts are opened
        from ..experiments.polygons import read_clicked
        from ..experiments.run import experiment_face, of_glyphs
        from ..runs.file_names import folders_for
        from ..runs.font_search import faces_of, find_fonts

        found = find_fonts(fonts)
        if not found:
            stop("no fonts found")
        if alone := found == [Path(fonts[0])] and len(fonts) == 1:
            instance = instance if instance.face_index is not None else opt.Instance(0, instance.location)
        undone, folders = False, list[Path]()
        for font, folder in zip(found, folders_for(found), strict=True):
            try:
                for source in faces_of(font, instance.place, instance.face_index):
                    asked = subset
                    if not subset.is_given and spec.clicked is not None:
                        names = list(of_glyphs(source, read_clicked(spec.clicked)))
                        asked = opt.Subset(glyphs=",".join(names))
                    elif not subset.is_given:
                        asked = opt.Subset(all_glyphs=True)
                    glyphs = chosen(source, asked, run.quiet, None if alone else f"{font}")
                    place = out if alone else out / folder / (f"face-{source.face_index}" * (source.num_faces > 1))
                    with progress(run.quiet) as observer:
                        experiment_face(
                            source, glyphs, place, spec, executor, restart=not run.resume, observer=observer
                        )
                    folders.append(place)
                    undone |= bool(glyphs.missing)
            except GlyphsplineError as error:
                if alone:
                    raise
                say(str(error))
                undone = True
    from ..experiments.page import write_report

    failed, lines = write_report(out, folders, spec)
    if not run.quiet:
        for line in lines:
            say(line)
    return undone or failed
