"""The command ``dataset``."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated, Any

from ...cli import arguments as opt
from ...cli.groups import as_path, grouped, only
from ...cli.messages import print_json, progress, say
from ...fields import About
from .spec import ROWS, DatasetSpec


def place_or_url(text: Any) -> str:
    """Parse a path or URL, which stays as it is written."""
    as_path(text)
    return str(text)


@grouped
def dataset(
    fonts: opt.FontFiles,
    out: Annotated[
        str, opt.out("Write to this folder, or s3://bucket/folder.", "DIR|URL", parser=place_or_url, show_default=False)
    ],
    spec: DatasetSpec,
    run: Annotated[opt.RunOptions, only("jobs", "resume", "config", "quiet", "as_json")],
    fit: Annotated[bool, About("Fit splines and measure them.", ROWS, flags=("--fit/--no-fit",))] = True,
) -> bool:
    """Make a data set of the glyphs of fonts: Parquet files that datasets, pandas, DuckDB and Arrow open.

    Splits are by family. The same fonts and options give the same bytes, and a run that was interrupted goes on.
    """
    from .run import dataset as make

    characters = opt.characters_of(spec.characters) if spec.characters else ""
    if characters != opt.as_typed(spec.characters):  # a file's
        characters = "".join(sorted(set(characters) - set("\r\n")))
    spec = replace(spec, characters=characters, options=spec.options if fit else None)
    with progress(run.quiet) as observer:
        jobs = None if run.scheduler else run.processes
        summary = make(fonts, out, spec, jobs=jobs, scheduler=run.scheduler, restart=not run.resume, observer=observer)
    if not run.quiet:
        for line in summary.lines():
            say(line)
        say(f"written to {out}: read {out.rstrip('/')}/README.md")
    if run.as_json:
        print_json(summary.facts())
    return bool(summary.failed or summary.outside_tolerance or summary.fonts["failed"])
