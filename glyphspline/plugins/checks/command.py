"""The command ``check``: fonts are checked, and findings are written where they are asked for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, get_args

from ...cli import arguments as opt
from ...cli.config import settings
from ...cli.convert import chosen, opened, say_face
from ...cli.groups import Command, collected, grouped, only, without
from ...cli.messages import STDOUT, progress, put, say, stop
from ...cli.tables import plain
from ...errors import OptionError
from ...fields import options_of
from ...files import make_place
from ...hooks import service
from ...outlines.flaws.kinds import KINDS, LEVELS, Level, Thresholds
from .options import CheckOptions, ReportOptions

if TYPE_CHECKING:
    from ...readers import Source
    from .job import Asked


class CheckCommand(Command):
    """A command with thresholds beside its options in files of settings."""

    own = ("thresholds", Thresholds)


@partial(grouped, cls=CheckCommand)
def check(
    fonts: opt.FontFiles,
    options: CheckOptions,
    report: ReportOptions,
    subset: opt.Subset,
    instance: opt.Instance,
    run: Annotated[opt.RunOptions, only("as_json", "jobs", "config", "quiet")],
) -> bool:
    """Find what may be wrong with outlines as fonts have them: kinks, jumps of curvature, lumps and the like.

    The worst findings come first; kinks are WARN, the rest INFO. All glyphs are checked unless some are asked for,
    those of a variable font along its axes too. Nothing is converted. Findings end the command with status 1 only if
    --error-level asks for it.
    """
    from ...runs.font_search import find_fonts
    from ...writers.settings import FigureKind
    from .job import FaceFindings, check_fonts, worst_first
    from .tables import NUMBERS, as_csv, as_json, as_markdown, columns, sentences

    texts = (report.csv, report.ghmarkdown, report.html)
    piped = texts.count(STDOUT) + run.as_json
    if piped > 1:
        stop("only one of --json, --csv - and the like goes to standard output")
    if report.plot is not None and report.plot.suffix[1:].lower() not in get_args(FigureKind):
        raise OptionError(f"--plot is a file of {', '.join(get_args(FigureKind))}, not {report.plot}")
    for path in (*texts, report.plot, report.write_baseline):  # before anything is checked
        if path not in (None, STDOUT):
            make_place(path)
    asked = asked_of(options, report, run.as_json)
    files = find_fonts(fonts)
    if not files:
        stop("no fonts found")
    alone = len(fonts) == 1 and files == [Path(fonts[0])]
    if report.plot is not None and not alone:
        stop("--plot takes one font")
    faces: list[FaceFindings] = []
    undone = False

    def names_in(source: Source) -> Sequence[str]:
        nonlocal undone
        if alone:
            say_face(source, instance, run.quiet)
        if not subset.is_given:
            return source.glyph_names
        names = chosen(source, subset, run.quiet, None if alone else str(source.path))
        undone |= bool(names.missing)
        return names

    for face in check_fonts(
        files, asked, chosen=names_in, face_index=instance.face_index,
        location=instance.place, jobs=run.processes, watch=partial(progress, run.quiet), alone=alone,
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
        from .page import findings_page

        put(report.html, findings_page([face for face in faces if face.source]))
    if report.plot is not None and faces[0].kinks is not None:
        kind: Any = report.plot.suffix[1:].lower()
        put(report.plot, service("turns_figure")(opened(files[0], instance, quiet=True), faces[0].kinks, kind))
    if run.as_json:
        put(STDOUT, as_json(faces, asked.thresholds))
    elif shown and not piped and not run.quiet:
        put(STDOUT, plain(*columns(shown[: report.rows], len(faces) > 1), numbers=NUMBERS))
    if not run.quiet:
        for line in sentences(faces, len(shown), report.rows, level):
            say(line)
    undone |= any(face.failed or face.unread or face.error is not None for face in faces)
    return undone or (report.error_level is not None and any(face.reaches(report.error_level) for face in faces))


def asked_of(options: CheckOptions, report: ReportOptions, as_json: bool = False) -> Asked:
    """What is looked for, from the command's options.

    Raises:
        GlyphsplineError: an option or the baseline is unusable.
    """
    from .baseline import Baseline
    from .job import STEPS, Asked

    every = [kind.name for kind in KINDS]
    kinds = opt.items_of(options.kinds)
    for name in kinds:
        if name not in every:
            raise OptionError(f"--kinds has no {name!r}: there are {', '.join(every)}")
    return Asked(
        thresholds=thresholds_of(options.thresholds, options.corner_angle),
        kinds=frozenset(kinds or every),
        kept=report.loglevel or ("INFO" if as_json or report.csv or report.html else "WARN"),
        axis=options.axis,
        steps=STEPS if options.steps is None else options.steps,
        baseline=None if report.baseline is None else Baseline.read(report.baseline),
        written=None if report.write_baseline is None else Baseline(),
        drawn=report.html is not None,
        joints=report.plot is not None,
    )


def project_settings() -> tuple[Asked, opt.Subset, opt.Instance]:
    """What is looked for, in which glyphs and where, as ``[tool.glyphspline.check]`` of the working folder has it.

    Raises:
        GlyphsplineError: a setting is no option of the command, or unusable.
    """
    groups: list[Any] = [CheckOptions, ReportOptions, opt.Subset, opt.Instance, opt.RunOptions]
    named = ((one.flags, one.name) for group in groups for one in options_of(group))
    given = settings(None, named, "check", CheckCommand.own)
    options, report, subset, instance, _ = (collected(group(), without(), given) for group in groups)
    return asked_of(options, report), subset, instance


def thresholds_of(text: str | None, corner_angle: float | None) -> Thresholds:
    """Thresholds as ``kink=1,short=2``; of one that is given twice the last counts.

    Raises:
        OptionError: one is not known, or is no number above 0.
    """
    names = [each.name for each in fields(Thresholds)]
    given = opt.numbers_of(text, "--thresholds is like kink=1,short=2")
    found = {name.replace("-", "_"): value for name, value in given.items()}
    if unknown := [name for name in given if name.replace("-", "_") not in names]:
        raise OptionError(f"--thresholds has no {unknown[0]!r}: there are {', '.join(names)}")
    if corner_angle is not None:
        found["corner_angle"] = corner_angle
    return Thresholds(**found)
