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
    given: Sequence[str],
    sought: opt.Sought,
    reported: opt.Reported,
    subset: opt.Subset,
    instance: opt.Instance,
    run: opt.Run,
) -> list[Face]:
    """The command with its arguments: check write what is asked for, and say the rest.

    Raises:
        GlyphsplineError: an option or a file of it is of no use.
    """
    from ..batch import find_fonts

    piped = [path for path in (reported.csv, reported.ghmarkdown, reported.html) if path == STDOUT]
    if len(piped) + run.as_json > 1:
        stop("only one of --json, --csv - and the like goes to standard output")
    require_figure(reported.plot)
    for path in (reported.csv, reported.ghmarkdown, reported.html, reported.plot, reported.write_baseline):
        require_folder(path)
    asked = asked_of(sought, reported, run.as_json)
    fonts = find_fonts(given)
    if not fonts:
        stop("no fonts found")
    alone = len(given) == 1 and fonts == [Path(given[0])]
    if reported.plot is not None and not alone:
        stop("--plot takes one font")
    faces = list(check_fonts(fonts, asked, subset, instance, run, alone=alone))
    if asked.written is not None and reported.write_baseline is not None:
        asked.written.write(reported.write_baseline)
    level: Level = reported.loglevel or "WARN"
    found = worst_first(faces)
    shown = [pair for pair in found if level_number(pair[1].level) >= level_number(level)]
    if reported.csv is not None:
        put(reported.csv, as_csv(found))
    if reported.ghmarkdown is not None:
        put(reported.ghmarkdown, as_markdown(faces, shown, level))
    if reported.html is not None:
        from ..report.findings_page import CheckedFont, findings_page

        drawn = [CheckedFont(face.font, face.source, face.findings) for face in faces if face.source]
        put(reported.html, findings_page(drawn))
    if run.as_json:
        put(STDOUT, as_json(faces, asked.thresholds))
    elif shown and not piped and not run.quiet:
        put(STDOUT, table(shown, reported.rows, len(faces) > 1))
    if not run.quiet:
        for line in sentences(faces, len(shown), reported.rows, level):
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
