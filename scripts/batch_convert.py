"""Convert many fonts: ``python scripts/batch_convert.py FONT|FOLDER|GLOB|@LIST … --out DIR [options]``.

Each font gets a folder of its own under ``--out``, each face of a collection one in it; options are those of
``glyphspline convert``, and without a selection every glyph is converted. A font that cannot be read is named and
passed over. Ends with 0 if all was converted, 1 if a glyph or a font failed, 2 if the call is unusable.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from concurrent.futures import Executor
from pathlib import Path
from typing import Annotated, Any

import typer

from glyphspline.batch import OutputError, RunSpec, find_fonts, folders_for
from glyphspline.cli import arguments as opt
from glyphspline.cli.commands import errors, run, say, stop, workplace
from glyphspline.errors import GlyphsplineError
from glyphspline.readers import AnySource, open_source

Inputs = Annotated[list[str], typer.Argument(help="Fonts, folders, globs, or @file with one of these a line.")]


def main(
    inputs: Inputs,
    out: opt.Out,
    text: opt.Text = None,
    text_file: opt.TextFile = None,
    unicodes: opt.Unicodes = None,
    glyphs: opt.Glyphs = None,
    gids: opt.Gids = None,
    every: opt.Every = False,
    location: opt.Location = None,
    variant: opt.Variant = 2,
    margin: opt.Margin = 0.02,
    fallback: opt.WhereNone = "peak",
    preset: opt.Choice = None,
    corners: opt.CornerMode = "smooth",
    continuity: opt.Between = "c2",
    tolerance: opt.Tolerance = None,
    step: opt.Step = None,
    count: opt.Count = None,
    effort: opt.HowHard = "fast",
    view_box: opt.Region = "em",
    precision: opt.Precision = 2,
    remove_overlaps: opt.RemoveOverlaps = False,
    measure: opt.Measure = False,
    formats: opt.Formats = "svg,curvature,gallery",
    jobs: opt.Jobs = None,
    scheduler: opt.Scheduler = None,
    resume: opt.Resume = True,
    quiet: opt.Quiet = False,
    json_log: opt.JsonLog = False,
) -> None:
    """Convert fonts, folders, globs and lists of fonts, each into a folder of its own."""
    given: dict[str, Any] = dict(locals())
    given["every"] = every or all(given[name] is None for name in ("text", "text_file", "unicodes", "glyphs", "gids"))
    failures = 0
    with errors():
        spec = opt.spec_of(given)
        fonts = find_fonts(inputs)
        if not fonts:
            stop("no fonts found")
        with workplace(jobs, scheduler, spec) as executor:
            for font, name in zip(fonts, folders_for(fonts), strict=True):
                try:
                    failures += convert_file(font, out / name, spec, executor, given)
                except OutputError:
                    raise
                except GlyphsplineError as error:
                    say(str(error))
                    failures += 1
    raise typer.Exit(1 if failures else 0)


def convert_file(font: Path, out: Path, spec: RunSpec, executor: Executor, given: Mapping[str, Any]) -> int:
    """Convert all faces of a font file; how many glyphs failed."""
    failed = 0
    for source in faces(font, opt.location_of(given["location"])):
        names = opt.selection_of(source, given)
        folder = out / f"face-{source.face_index}" if source.num_faces > 1 else out
        if not given["quiet"]:
            say(f"{font}, face {source.face_index}: {len(names)} glyphs")
        how = {"restart": not given["resume"], "quiet": given["quiet"], "json_log": given["json_log"]}
        failed += run(source, names, folder, spec, executor, **how).failed
    return failed


def faces(font: Path, location: Mapping[str, float] | str) -> Iterator[AnySource]:
    """The faces of a font file, one after the other."""
    first = open_source(font, 0, location)
    yield first
    for index in range(1, first.num_faces):
        yield open_source(font, index, location)


if __name__ == "__main__":
    typer.run(main)
