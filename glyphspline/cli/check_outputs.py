"""The command ``check`` as a whole: fonts are checked, and what is found is written where it is asked for."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import typer

from ..checks.kinds import Level
from ..errors import OutputError
from . import arguments as opt
from .checking import Face, asked_of, check_fonts, level_number, require_figure
from .findings import as_csv, as_json, as_markdown, sentences, table, worst_first
from .messages import say, stop

STDOUT = Path("-")


def run(
    inputs: Sequence[str],
    options: opt.CheckOptions,
    report: opt.ReportOptions,
    subset: opt.Subset,
    instance: opt.Instance,
    run: opt.RunOptions,
) -> list[Face]:
    """The command with its arguments: check write what is asked for, and say the rest.

    Raises:
        GlyphsplineError: an option or a file of it is of no use.
    """
    from ..batch import find_fonts

    piped = [path for path in (report.csv, report.ghmarkdown, report.html) if path == STDOUT]
    if len(piped) + run.as_json > 1:
        stop("only one of --json, --csv - and the like goes to standard output")
    require_figure(report.plot)
    for path in (report.csv, report.ghmarkdown, report.html, report.plot, report.write_baseline):
        require_folder(path)
    asked = asked_of(options, report, run.as_json)
    fonts = find_fonts(inputs)
    if not fonts:
        stop("no fonts found")
    alone = len(inputs) == 1 and fonts == [Path(inputs[0])]
    if report.plot is not None and not alone:
        stop("--plot takes one font")
    faces = list(check_fonts(fonts, asked, subset, instance, run, alone=alone))
    if asked.written is not None and report.write_baseline is not None:
        asked.written.write(report.write_baseline)
    level: Level = report.loglevel or "WARN"
    found = worst_first(faces)
    shown = [pair for pair in found if level_number(pair[1].level) >= level_number(level)]
    if report.csv is not None:
        put(report.csv, as_csv(found))
    if report.ghmarkdown is not None:
        put(report.ghmarkdown, as_markdown(faces, shown, level))
    if report.html is not None:
        from ..report.findings_page import CheckedFont, findings_page

        drawn = [CheckedFont(face.font, face.source, face.findings) for face in faces if face.source]
        put(report.html, findings_page(drawn))
    if run.as_json:
        put(STDOUT, as_json(faces, asked.thresholds))
    elif shown and not piped and not run.quiet:
        put(STDOUT, table(shown, report.rows, len(faces) > 1))
    if not run.quiet:
        for line in sentences(faces, len(shown), report.rows, level):
            say(line)
    return faces


def require_folder(path: Path | None) -> None:
    """Raise an error before anything is checked, unless a file's folder exists."""
    if path is not None and path != STDOUT and not path.parent.is_dir():
        raise OutputError("cannot be written: there is no such folder", font=str(path))


def put(path: Path, text: str) -> None:
    """Write a file, or standard output.

    Raises:
        OutputError: the file cannot be written.
    """
    if path == STDOUT:
        typer.echo(text, nl=not text.endswith("\n"))
        return
    try:
        path.write_text(text, encoding="utf-8", errors="replace", newline="")  # paths need not be UTF-8
    except OSError as error:
        raise OutputError(f"cannot be written: {error.strerror or error}", font=str(path)) from error
