"""The command ``dataset``: the glyphs of many fonts as one table."""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import typer

from ..dataset.dataset_spec import FIT, DatasetSpec, Instances, Normalise, Rows
from ..errors import OptionError
from . import arguments as opt
from .messages import errors, listen, say
from .progress import progress

row_option = partial(typer.Option, rich_help_panel="What rows hold")
which_option = partial(typer.Option, rich_help_panel="Which fonts and glyphs")
split_option = partial(typer.Option, rich_help_panel="Splits, by family")

Folder = Annotated[
    str,
    opt.file_option(
        "--out", "-o", parser=opt.place_or_url, metavar="DIR|URL", help="Folder to write to, or s3://bucket/folder.",
        show_default=False,
    ),
]  # fmt: skip
RowKind = Annotated[Rows, row_option("--rows", help="A row a glyph, or a contour.")]
Points = Annotated[
    str, row_option("--points", metavar="N|polygon", help="Points of a contour at equal arc lengths, or its polygon.")
]
Unit = Annotated[Normalise, row_option("--normalise", help="Coordinates in em, or in font units.")]
Fit = Annotated[bool, row_option("--fit/--no-fit", help="Fit splines and measure them.")]
Raster = Annotated[
    int | None,
    row_option("--raster", parser=opt.whole, metavar="N", help="A grey picture too, of N by N pixels."),
]
Characters = Annotated[str | None, which_option("--characters", help="Only glyphs of these characters.")]
TextFile = Annotated[Path | None, which_option("--text-file", help="Only glyphs of a UTF-8 file's characters.")]
Scripts = Annotated[
    str, which_option("--script", metavar="CODE,…", help="Only glyphs of these scripts, by ISO 15924: Latn,Grek.")
]
Licences = Annotated[
    str, which_option("--licence", metavar="ID,…", help="Only fonts of these licences, by SPDX, or unknown.")
]
Where = Annotated[
    Instances, which_option("--instances", help="Variable fonts at their default, or at each named instance.")
]
Coverage = Annotated[
    float,
    which_option("--coverage", parser=opt.number, metavar="SHARE", help="Of the characters that a font has to have."),
]
Seed = Annotated[int, split_option("--seed", parser=opt.whole, metavar="N", help="Of the hash of a family's name.")]
Validation = Annotated[float, split_option("--validation", parser=opt.number, metavar="SHARE", help="Of families.")]
Test = Annotated[float, split_option("--test", parser=opt.number, metavar="SHARE", help="Of families.")]


def dataset(
    fonts: opt.FontFiles,
    out: Folder,
    rows: RowKind = DatasetSpec.rows,
    points: Points = str(DatasetSpec.points),
    normalise: Unit = DatasetSpec.normalise,
    fit: Fit = True,
    raster: Raster = DatasetSpec.raster,
    characters: Characters = None,
    text_file: TextFile = None,
    script: Scripts = "",
    licence: Licences = "",
    instances: Where = DatasetSpec.instances,
    coverage: Coverage = DatasetSpec.coverage,
    seed: Seed = DatasetSpec.seed,
    validation: Validation = DatasetSpec.validation,
    test: Test = DatasetSpec.test,
    variant: opt.Variant = FIT.variant,
    margin: opt.Margin = FIT.margin,
    fallback: opt.WhereNone = FIT.fallback,
    preset: opt.Choice = None,
    corners: opt.CornerMode = FIT.corners,
    corner_angle: opt.CornerAngle = FIT.corner_angle,
    continuity: opt.Between = FIT.continuity,
    tolerance: opt.Tolerance = FIT.tolerance,
    step: opt.Step = FIT.step,
    count: opt.Count = FIT.count,
    effort: opt.HowHard = FIT.effort,
    measure: opt.Measure = FIT.measure,
    precision: opt.Precision = FIT.precision,
    remove_overlaps: opt.RemoveOverlaps = FIT.remove_overlaps,
    jobs: opt.Jobs = None,
    scheduler: opt.Scheduler = None,
    resume: opt.Resume = True,
    config: opt.Config = None,
    quiet: opt.Quiet = False,
    as_json: opt.JsonSummary = False,
) -> None:
    """Make a data set of the glyphs of fonts: Parquet files that datasets, pandas, DuckDB and Arrow open.

    Splits are by family. The same fonts and options give the same bytes, and a run that was interrupted goes on.
    """
    given = dict(locals())
    with errors(quiet):
        listen(quiet)
        spec = spec_of(given)
        from ..dataset.dataset_run import dataset as make

        with progress(quiet) as observer:
            summary = make(fonts, out, spec, jobs=jobs, scheduler=scheduler, restart=not resume, observer=observer)
        if not quiet:
            for line in summary.lines():
                say(line)
            say(f"written to {out}: read {out.rstrip('/')}/README.md")
        if as_json:
            typer.echo(json.dumps(summary.facts(), indent=1, ensure_ascii=False))
    raise typer.Exit(1 if summary.failed or summary.fonts["failed"] else 0)


def spec_of(given: Mapping[str, Any]) -> DatasetSpec:
    """What the data set holds, from the command's arguments by name.

    Raises:
        OptionError: an option is out of its range.
    """
    if given["text_file"] is not None and given["characters"] is not None:
        raise OptionError("give --characters or --text-file, not both")
    characters = given["characters"] or ""
    if given["text_file"] is not None:
        text = given["text_file"].read_text(encoding="utf-8-sig")
        characters = "".join(sorted(set(text) - set("\r\n")))
    points = None if given["points"] == "polygon" else opt.whole(given["points"])
    names = ("rows", "normalise", "raster", "instances", "coverage", "seed", "validation", "test")
    try:
        return DatasetSpec(
            points=points, options=opt.options_of(given) if given["fit"] else None, characters=characters,
            scripts=_listed(given["script"]), licences=_listed(given["licence"]),
            **{name: given[name] for name in names},
        )  # fmt: skip
    except OptionError as error:
        raise OptionError(error.message if error.message.startswith("--") else f"--{error.message}") from None


def _listed(text: str) -> tuple[str, ...]:
    return tuple(part.strip() for part in text.split(",") if part.strip())
