"""The command ``check`` as a whole: fonts are checked, and what is found is written where it is asked for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from functools import partial
from pathlib import Path
from typing import Any, get_args

import typer

from ..checks.baseline import Baseline
from ..checks.kinds import KINDS, LEVELS, Level, Thresholds
from ..errors import OptionError, OutputError
from ..files import writing
from ..runs.check_fonts import Asked, Face, check_fonts, worst_first
from ..runs.check_run import STEPS
from ..writers.figures.images import FigureKind
from . import arguments as opt
from .findings import as_csv, as_json, as_markdown, sentences, table
from .messages import say, stop
from .progress import progress

STDOUT = Path("-")

NAMES = [kind.name for kind in KINDS]


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
    from ..runs import find_fonts

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
    faces: list[Face] = []
    for face in check_fonts(
        fonts, asked, chosen=subset.of if subset.is_given else None, face_index=instance.face_index,
        location=instance.place, jobs=run.jobs, watch=partial(progress, run.quiet), alone=alone,
    ):  # fmt: skip
        faces.append(face)
        if face.remark is not None:
            say(face.remark)
    if asked.written is not None and report.write_baseline is not None:
        asked.written.write(report.write_baseline)
    level: Level = report.loglevel or "WARN"
    found = worst_first(faces)
    shown = [pair for pair in found if LEVELS.index(pair[1].level) >= LEVELS.index(level)]
    if report.csv is not None:
        put(report.csv, as_csv(found))
    if report.ghmarkdown is not None:
        put(report.ghmarkdown, as_markdown(faces, shown, level))
    if report.html is not None:
        from ..report.findings_page import CheckedFont, findings_page

        drawn = [CheckedFont(face.font, face.source, face.findings) for face in faces if face.source]
        put(report.html, findings_page(drawn))
    if report.plot is not None and faces[0].kinks is not None:
        from ..readers import open_source
        from ..writers.figures.turns import turns_figure

        kind: Any = report.plot.suffix[1:].lower()
        source = open_source(fonts[0], instance.face_index or 0, instance.place)
        put(report.plot, turns_figure(source, faces[0].kinks, kind))
    if run.as_json:
        put(STDOUT, as_json(faces, asked.thresholds))
    elif shown and not piped and not run.quiet:
        put(STDOUT, table(shown, report.rows, len(faces) > 1))
    if not run.quiet:
        for line in sentences(faces, len(shown), report.rows, level):
            say(line)
    return faces


def thresholds_of(text: str | None, corner_angle: float | None) -> Thresholds:
    """Thresholds as ``kink=1,short=2``; of one that is given twice the last counts.

    Raises:
        GlyphsplineError: one is not known, or is no number above 0.
    """
    names = [each.name for each in fields(Thresholds)]
    found: dict[str, float] = {}
    for item in filter(None, (text or "").replace(" ", "").split(",")):
        name, _, value = item.partition("=")
        if name.replace("-", "_") not in names:
            raise OptionError(f"--thresholds has no {name!r}: there are {', '.join(names)}")
        try:
            found[name.replace("-", "_")] = float(value)
        except ValueError:
            raise OptionError(f"--thresholds is like kink=1,short=2, not {item!r}") from None
    if corner_angle is not None:
        found["corner_angle"] = corner_angle
    return Thresholds(**found)


def kinds_of(text: str | None) -> frozenset[str]:
    """The kinds asked for; without any, all.

    Raises:
        OptionError: there is no such kind.
    """
    names = [name for name in (text or "").replace(" ", "").split(",") if name]
    for name in names:
        if name not in NAMES:
            raise OptionError(f"--kinds has no {name!r}: there are {', '.join(NAMES)}")
    return frozenset(names or NAMES)


def require_figure(path: Path | None) -> None:
    """Raise an error unless a diagram can be written as what the file's suffix says."""
    if path is not None and path.suffix[1:].lower() not in get_args(FigureKind):
        raise OptionError(f"--plot is a file of {', '.join(get_args(FigureKind))}, not {path}")


def asked_of(options: opt.CheckOptions, report: opt.ReportOptions, as_json: bool = False) -> Asked:
    """What is looked for, from the command's arguments.

    Raises:
        GlyphsplineError: an option or the baseline is of no use.
    """
    every = as_json or report.csv or report.html
    return Asked(
        thresholds=thresholds_of(options.thresholds, options.corner_angle),
        kinds=kinds_of(options.kinds),
        kept=report.loglevel or ("INFO" if every else "WARN"),
        axis=options.axis,
        steps=STEPS if options.steps is None else options.steps,
        baseline=None if report.baseline is None else Baseline.read(report.baseline),
        written=None if report.write_baseline is None else Baseline(),
        drawn=report.html is not None,
        joints=report.plot is not None,
    )


def require_folder(path: Path | None) -> None:
    """Raise an error before anything is checked, unless a file's folder exists."""
    if path is not None and path != STDOUT and not path.parent.is_dir():
        raise OutputError("cannot be written: there is no such folder", font=str(path))


def put(path: Path, content: str | bytes) -> None:
    """Write a file, or standard output.

    Raises:
        OutputError: the file cannot be written.
    """
    if path == STDOUT and isinstance(content, str):
        typer.echo(content, nl=not content.endswith("\n"))
        return
    with writing(path):
        path.write_bytes(content.encode(errors="replace") if isinstance(content, str) else content)  # of paths
