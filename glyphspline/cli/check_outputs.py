"""The command ``check`` as a whole: fonts are checked, and what is found is written where it is asked for."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import typer

from ..checks.kinds import Level
from ..errors import OutputError
from .checking import Face, asked_of, check_fonts, level_number, require_figure
from .findings import as_csv, as_json, as_markdown, sentences, table, worst_first
from .messages import say, stop

STDOUT = Path("-")


def run(given: Mapping[str, Any]) -> list[Face]:
    """The command, from its arguments by name: check, write what is asked for, and say the rest.

    Raises:
        GlyphsplineError: an option or a file of it is of no use.
    """
    from ..batch import find_fonts

    piped = [name for name in ("csv", "ghmarkdown", "html") if given[name] == STDOUT]
    if len(piped) + given["as_json"] > 1:
        stop("only one of --json, --csv - and the like goes to standard output")
    require_figure(given["plot"])
    for name in ("csv", "ghmarkdown", "html", "plot", "write_baseline"):
        require_folder(given[name])
    asked = asked_of(given)
    fonts = find_fonts(given["fonts"])
    if not fonts:
        stop("no fonts found")
    alone = len(given["fonts"]) == 1 and fonts == [Path(given["fonts"][0])]
    if given["plot"] is not None and not alone:
        stop("--plot takes one font")
    faces = list(check_fonts(fonts, asked, given, alone))
    if asked.written is not None:
        asked.written.write(given["write_baseline"])
    level: Level = given["loglevel"] or "WARN"
    found = worst_first(faces)
    shown = [pair for pair in found if level_number(pair[1].level) >= level_number(level)]
    if given["csv"] is not None:
        put(given["csv"], as_csv(found))
    if given["ghmarkdown"] is not None:
        put(given["ghmarkdown"], as_markdown(faces, shown, level))
    if given["html"] is not None:
        from ..report.findings_page import CheckedFont, findings_page

        drawn = [CheckedFont(face.font, face.source, face.findings) for face in faces if face.source]
        put(given["html"], findings_page(drawn))
    if given["as_json"]:
        put(STDOUT, as_json(faces, asked.thresholds))
    elif shown and not piped and not given["quiet"]:
        put(STDOUT, table(shown, given["rows"], len(faces) > 1))
    if not given["quiet"]:
        for line in sentences(faces, len(shown), given["rows"], level):
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
