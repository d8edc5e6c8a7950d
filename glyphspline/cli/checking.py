"""Fonts checked face by face: which findings are kept, counted, or known already."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args

from ..checks.axis_numbers import AxisNumbers
from ..checks.baseline import Baseline
from ..checks.finding import Finding, severity
from ..checks.kinds import KINDS, LEVELS, Level, Thresholds
from ..errors import GlyphsplineError, OptionError
from ..writers.figures.images import FigureKind
from . import arguments as opt
from .messages import say, stop
from .progress import progress

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from ..readers import Source

POOL_FROM = 2000
POOL_FROM_ALONG_AXES = 100
"""Glyphs of a face, or of one of a variable font, from which worker processes are worth their start."""

PATIENCE = 60.0
"""Seconds that a worker may be silent."""

ORDER = {kind.name: k for k, kind in enumerate(KINDS)}


@dataclass
class Face:
    """What was found in one face of a font.

    Attributes:
        font: its path as given, with the number of the face if there are several. family, style: of the font.
        source: of it, where places are to be drawn. home: user-space value of each axis where the font is open.
        findings: those that are kept, the worst first. counts: of all new ones, by kind. known: number of those that
            the baseline has. levels: those of new findings.
        glyphs: number of those checked. failed: glyphs that could not be checked, with the reasons.
        axes: kinks along each axis in numbers, of all glyphs checked. error: why the font could not be read.
    """

    font: str
    family: str = ""
    style: str = ""
    source: Source | None = None
    home: Mapping[str, float] = field(default_factory=dict)
    findings: list[Finding] = field(default_factory=list)
    counts: Counter[str] = field(default_factory=Counter)
    known: int = 0
    levels: set[Level] = field(default_factory=set)
    glyphs: int = 0
    failed: list[tuple[str, str]] = field(default_factory=list)
    axes: list[AxisNumbers] = field(default_factory=list)
    error: str | None = None

    @property
    def name(self) -> str:
        """Family and style, by which a baseline knows the font."""
        return f"{self.family} {self.style}".strip()


@dataclass(frozen=True)
class Asked:
    """What is looked for, and what is kept of it.

    Attributes:
        kinds: names. kept: findings of this level or above are kept, others only counted.
        axis: tag of the only one, or None. steps: of :func:`glyphspline.batch.check_run.check_font`; None: its own.
        baseline: known findings, or None. written: where all findings are added, or None.
        plot: file of the diagram, or None. drawn: whether sources are kept, for drawings.
    """

    thresholds: Thresholds
    kinds: frozenset[str]
    kept: Level
    axis: str | None
    steps: int | None
    baseline: Baseline | None
    written: Baseline | None
    plot: Path | None
    drawn: bool


def level_number(level: Level) -> int:
    """Higher is more serious."""
    return LEVELS.index(level)


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
        if name not in ORDER:
            raise OptionError(f"--kinds has no {name!r}: there are {', '.join(ORDER)}")
    return frozenset(names or ORDER)


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
        steps=options.steps,
        baseline=None if report.baseline is None else Baseline.read(report.baseline),
        written=None if report.write_baseline is None else Baseline(),
        plot=report.plot,
        drawn=report.html is not None,
    )


def reaches(face: Face, level: Level) -> bool:
    """Whether a new finding of a face is of a level or above."""
    return any(level_number(own) >= level_number(level) for own in face.levels)


def check_fonts(
    fonts: Sequence[Path], asked: Asked, subset: opt.Subset, instance: opt.Instance, run: opt.RunOptions, *, alone: bool
) -> Iterator[Face]:
    """Check the faces of fonts, one after the other.

    Of several, every glyph is checked unless some are asked for, and a font that cannot be read has an error instead
    of findings. One font alone is its first face, and an error of it ends the command.
    """
    from ..batch import faces_of

    face_index = instance.face_index
    if alone:
        face_index = face_index or 0
    location = instance.place
    with ExitStack() as stack:
        pool: Executor | None = None
        for font in fonts:
            try:
                for source in faces_of(font, location, face_index):
                    least = POOL_FROM_ALONG_AXES if source.axes else POOL_FROM
                    names = subset.of(source) if subset.is_given else source.glyph_names
                    if pool is None and (run.jobs or (run.jobs is None and len(names) >= least)):
                        from ..batch.schedule import workers

                        pool = stack.enter_context(workers(run.jobs, PATIENCE, also=("checks",)))
                    name = str(font) if alone or source.num_faces == 1 else f"{font}, face {source.face_index}"
                    yield check_face(source, name, names, asked, pool, alone=alone, quiet=run.quiet)
            except GlyphsplineError as error:
                if alone:
                    raise
                yield Face(str(font), error=str(error))


def check_face(
    source: Source, name: str, names: Sequence[str], asked: Asked, pool: Executor | None, *, alone: bool, quiet: bool
) -> Face:
    """Check glyphs of one face of the font called ``name``."""
    from ..batch.check_run import STEPS, check_font
    from ..report.findings_page import home_of

    if alone and not names:
        stop("none of the glyphs asked for is in the font")
    tags = tags_of(source, asked, alone)
    face = Face(name, source.family, source.style, source if asked.drawn else None, home_of(source))
    face.axes = [AxisNumbers(axis.tag, 0, (axis.default,)) for axis in source.axes if axis.tag in tags]
    with progress(quiet) as observer:
        steps = STEPS if asked.steps is None else asked.steps
        rows = check_font(source, names, asked.thresholds, axes=tags, steps=steps, executor=pool, observer=observer)
        for row in rows:
            face.glyphs += row.error is None
            if row.error is not None:
                face.failed.append((row.glyph, row.error))
            if row.axes:
                face.axes = [known + own for known, own in zip(face.axes, row.axes, strict=True)]
            keep(face, [item for item in row.findings if item.kind in asked.kinds], asked)
    if alone and face.failed and not face.glyphs:
        glyph, error = face.failed[0]
        stop(f"{name}, glyph {glyph!r}: {error}")
    face.findings.sort(key=severity)
    if tags and asked.plot is not None:
        write_plot(asked.plot, source, names, asked)
    return face


def tags_of(source: Source, asked: Asked, alone: bool) -> list[str]:
    """The axes along which a font is checked.

    Raises:
        GlyphsplineError: the only font has no axes, or not the one asked for.
    """
    from ..checks.axis_kinks import tags_of

    if asked.axis is None and not (alone and asked.plot):
        return [axis.tag for axis in source.axes]
    try:
        return [tag for tag in tags_of(source, asked.axis) if asked.axis in (None, tag)]
    except GlyphsplineError as error:
        if alone:
            raise
        say(f"{error}; checked without it")
        return []


def keep(face: Face, findings: list[Finding], asked: Asked) -> None:
    """Sort the findings of a glyph into what is known, counted and kept."""
    if asked.written is not None:
        asked.written.add(face.name, findings)
    if asked.baseline is not None:
        fresh = asked.baseline.new(face.name, findings)
        face.known += len(findings) - len(fresh)
        findings = fresh
    face.counts.update([item.kind for item in findings])
    face.levels.update([item.level for item in findings])
    least = level_number(asked.kept)
    face.findings += [item for item in findings if level_number(item.level) >= least]


def write_plot(path: Path, source: Source, names: Sequence[str], asked: Asked) -> None:
    """Draw the largest turn of any joint against the axes; see :func:`require_figure`."""
    from ..checks.axis_kinks import kinks
    from ..writers.figures.turns import turns_figure

    kind: Any = path.suffix[1:].lower()
    report = kinks(source, names, asked.axis, corner_angle=asked.thresholds.corner_angle)
    path.write_bytes(turns_figure(source, report, kind))
