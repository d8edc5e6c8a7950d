"""Fonts checked face by face: which findings are kept, counted, or known already."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import AbstractContextManager, ExitStack, nullcontext
from dataclasses import dataclass, field
from pathlib import Path

from ..checks.baseline import Baseline
from ..checks.finding import Finding, severity
from ..checks.kinds import KINDS, LEVELS, THRESHOLDS, Level, Thresholds
from ..checks.kinks import AxisKinks, AxisNumbers, KinkReport, tags_of
from ..errors import GlyphsplineError
from ..readers import Source
from ..readers.opentype.tables import Location
from ..report.findings_page import home_of
from .check_run import STEPS, check_font
from .engine import Observer
from .font_search import faces_of
from .schedule import workers

POOL_FROM = 2000
POOL_FROM_ALONG_AXES = 100
"""Glyphs of a face, or of one of a variable font, from which worker processes are worth their start."""


@dataclass(frozen=True)
class Asked:
    """What is looked for, and what is kept of it.

    Attributes:
        kinds: names. kept: findings of this level or above are kept, others only counted.
        axis: tag of the only one, or None. steps: see :func:`.check_run.check_font`.
        baseline: known findings, or None. written: where all findings are added, or None.
        drawn: whether sources are kept, for drawings. joints: whether all smooth joints are kept, for a diagram.
    """

    thresholds: Thresholds = THRESHOLDS
    kinds: frozenset[str] = frozenset(kind.name for kind in KINDS)
    kept: Level = "INFO"
    axis: str | None = None
    steps: int = STEPS
    baseline: Baseline | None = None
    written: Baseline | None = None
    drawn: bool = False
    joints: bool = False


@dataclass
class Face:
    """What was found in one face of a font.

    Attributes:
        font: its path as given, with the number of the face if there are several. family, style: of the font.
        source: of it, where places are to be drawn. home: user-space value of each axis where the font is open.
        findings: those that are kept, the worst first. counts: of all new ones, by kind. known: number of those that
            the baseline has. levels: those of new findings.
        glyphs: number of those checked. failed: glyphs that could not be checked, with the reasons.
        axes: kinks along each axis in numbers, of all glyphs checked. kinks: all smooth joints, if they are asked for.
        remark: what was left undone, or None. error: why the font could not be read, or None.
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
    kinks: KinkReport | None = None
    remark: str | None = None
    error: str | None = None

    @property
    def name(self) -> str:
        """Family and style, by which a baseline knows the font."""
        return f"{self.family} {self.style}".strip()

    def reaches(self, level: Level) -> bool:
        """Whether a new finding is of a level or above."""
        return any(LEVELS.index(own) >= LEVELS.index(level) for own in self.levels)

    def keep(self, findings: Sequence[Finding], asked: Asked) -> None:
        """Sort the findings of a glyph into what is known, counted and kept."""
        if asked.written is not None:
            asked.written.add(self.name, findings)
        if asked.baseline is not None:
            fresh = asked.baseline.new(self.name, findings)
            self.known += len(findings) - len(fresh)
            findings = fresh
        self.counts.update([item.kind for item in findings])
        self.levels.update([item.level for item in findings])
        self.findings += [item for item in findings if LEVELS.index(item.level) >= LEVELS.index(asked.kept)]


def worst_first(faces: Sequence[Face]) -> list[tuple[Face, Finding]]:
    """The findings of all faces in one list."""
    every = [(face, finding) for face in faces for finding in face.findings]
    return sorted(every, key=lambda pair: severity(pair[1])) if len(faces) > 1 else every


def check_fonts(
    fonts: Sequence[Path],
    asked: Asked,
    *,
    chosen: Callable[[Source], Sequence[str]] | None = None,
    face_index: int | None = None,
    location: Location = None,
    jobs: int | None = None,
    watch: Callable[[], AbstractContextManager[Observer | None]] = nullcontext,
    alone: bool = False,
) -> Iterator[Face]:
    """Check the faces of fonts, one after the other. A font that cannot be read has an error instead of findings.

    Args:
        fonts: files. asked: what is looked for. chosen: the glyphs of each font; without it, all.
        face_index: the only face of each file; without it, all. location: of variable fonts.
        jobs: worker processes; None takes all cores if there are many glyphs, 0 does everything in this process.
        watch: opened for each face; yields its observer, see :data:`.engine.Observer`.
        alone: there is one font, of which one face is checked; its errors are raised.
    """
    if alone:
        face_index = face_index or 0
    with ExitStack() as stack:
        pool: Executor | None = None
        for font in fonts:
            try:
                for source in faces_of(font, location, face_index):
                    names = source.glyph_names if chosen is None else chosen(source)
                    least = POOL_FROM_ALONG_AXES if source.axes else POOL_FROM
                    if pool is None and (jobs or (jobs is None and len(names) >= least)):
                        pool = stack.enter_context(workers(jobs, also=("checks",)))
                    name = str(font) if alone or source.num_faces == 1 else f"{font}, face {source.face_index}"
                    with watch() as observer:
                        face = check_face(source, name, names, asked, pool, observer, alone=alone)
                    yield face
            except GlyphsplineError as error:
                if alone:
                    raise
                yield Face(str(font), error=str(error))


def check_face(
    source: Source,
    name: str,
    names: Sequence[str],
    asked: Asked,
    pool: Executor | None,
    observer: Observer | None,
    *,
    alone: bool,
) -> Face:
    """Check glyphs of one face of the font called ``name``.

    Raises:
        GlyphsplineError: of a font ``alone``: no glyph is chosen or can be checked, or it lacks the axis asked for.
    """
    if alone and not names:
        raise GlyphsplineError("none of the glyphs asked for is in the font")
    face = Face(name, source.family, source.style, source if asked.drawn else None, home_of(source))
    tags = [axis.tag for axis in source.axes]
    if asked.axis is not None or (alone and asked.joints):
        try:
            tags = [tag for tag in tags_of(source, asked.axis) if asked.axis in (None, tag)]
        except GlyphsplineError as error:
            if alone:
                raise
            face.remark, tags = f"{error}; checked without it", []
    face.axes = [AxisNumbers(axis.tag, 0, (axis.default,)) for axis in source.axes if axis.tag in tags]
    kinks: list[Sequence[AxisKinks]] | None = [] if asked.joints else None
    for row in check_font(
        source, names, asked.thresholds, kinds=asked.kinds, axes=tags, steps=asked.steps, executor=pool,
        observer=observer, kinks=kinks,
    ):  # fmt: skip
        face.glyphs += row.error is None
        if row.error is not None:
            face.failed.append((row.glyph, row.error))
        if row.axes:
            face.axes = [known + own for known, own in zip(face.axes, row.axes, strict=True)]
        face.keep(row.findings, asked)
    if alone and face.failed and not face.glyphs:
        glyph, why = face.failed[0]
        raise GlyphsplineError(f"{name}, glyph {glyph!r}: {why}")
    face.findings.sort(key=severity)
    if kinks:
        found = tuple(AxisKinks.joined(parts) for parts in zip(*kinks, strict=True))
        face.kinks = KinkReport(found, face.glyphs, asked.thresholds.corner_angle, tuple(face.failed))
    return face
