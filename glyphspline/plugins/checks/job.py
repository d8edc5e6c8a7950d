"""Fonts checked: glyph by glyph in workers, in glyph index order; which findings are kept, counted, or known already.

Between processes findings are columns of numbers; they become values one glyph at a time, when their glyph's turn has
come.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import AbstractContextManager, nullcontext, suppress
from dataclasses import dataclass, field, replace
from functools import cache
from hashlib import blake2b
from itertools import pairwise
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from ...errors import FontError, GlyphsplineError
from ...hooks import away_words, find, service
from ...outlines.contour_arrays import end_to_end
from ...outlines.flaws.kinds import DIRECTION, KINDS, LEVELS, THRESHOLDS, Level, Thresholds
from ...outlines.masters import Masters
from ...outlines.outline import Outline
from ...readers import Source
from ...readers.source import Location, tags_of
from ...runs.engine import Item, Job, Observer, reason, run
from ...runs.font_search import faces_of
from ...runs.schedule import Place, heads_of, place_of, sources, workers
from ...runs.shapes import Shapes
from ...runs.spec import LIMITS
from ...types import FloatArray, Head, IntArray
from .baseline import Baseline
from .finding import Finding, Measured, findings, severity

STEPS = 8
"""Steps of each axis of a variable font, at whose ends its glyphs are checked besides the masters."""

BASELINE = (0.0,)
"""The height at which points are aligned in every font."""


class Checked(NamedTuple):
    """What a worker found in some glyphs.

    Attributes:
        rows: of the tasks that were done together. axes: kinks of each along each axis, in numbers.
        shapes: (n,) of the row's contour, in whichever glyph. scores: of each task; see :class:`GlyphFindings`.
        kinks: along each axis, if they are asked for.
        error: why the only task could not be checked, or None. unread: of each task, what of it was not read.
    """

    rows: Measured
    axes: Sequence[tuple[Any, ...]]
    shapes: IntArray
    scores: Sequence[float | None]
    kinks: Sequence[Any] = ()
    error: str | None = None
    unread: Sequence[tuple[str, ...]] = ()


@dataclass(frozen=True)
class CheckJob(Job[Head, Checked]):
    """Glyphs checked where their font is open.

    Attributes:
        kinds: names of those that are looked for. outer: direction of outer contours; see :attr:`.Source.outer`.
        heights: of baseline, x-height and cap height.
    """

    place: Place
    thresholds: Thresholds
    kinds: frozenset[str]
    outer: int
    heights: tuple[float, ...] = BASELINE

    joints = False

    chunk = 200
    """A few megabytes of outlines."""

    def read(self, tasks: Sequence[Head]) -> Sequence[Item | Exception]:
        """Outlines of one em together: each drawing has its own."""
        (source,) = sources(self.place)
        return [
            each if isinstance(each, GlyphsplineError) else _item(each, len(each.arrays.degrees))
            for each in source.read(tasks)
        ]

    def together(self, tasks: Sequence[Head], contents: Sequence[Any]) -> Checked:
        """Measure glyphs."""
        rows, kinks = self.measured(contents)
        seen = np.bincount(rows.glyphs, np.nan_to_num(rows.numbers[:, 4]), len(contents))
        scores: list[float] = (seen * (1000 / contents[0].metrics.units_per_em)).tolist()
        looked_for = [number for number, kind in enumerate(KINDS) if kind.name in self.kinds]
        kept = np.flatnonzero(np.isin(rows.kinds, looked_for))
        rows = rows.chosen(kept[np.argsort(rows.glyphs[kept], kind="stable")])
        numbers = [tuple(along.numbers_of(g) for along in kinks) for g in range(len(contents))]
        unread = [each.unread for each in contents]
        return Checked(rows, numbers, _shapes(contents, rows), scores, kinks if self.joints else (), unread=unread)

    def measured(self, glyphs: Sequence[Any]) -> tuple[Measured, Sequence[Any]]:
        """Findings of every kind, and all smooth joints along each axis."""
        from .check import measured

        em = glyphs[0].metrics.units_per_em
        contours = [outline.contours for outline in glyphs]
        return measured(contours, self.thresholds, em, self.outer, self.heights), ()

    def failed(self, task: Head, error: Exception) -> Checked:
        """Why a glyph could not be checked."""
        return Checked(Measured.joined(()), [()], np.zeros(0, dtype=np.int64), [None], (), reason(error), [()])


@dataclass(frozen=True)
class AxesJob(CheckJob):
    """Glyphs checked in their masters and along ``axes``, which are tags, at the ends of ``steps`` of each.

    ``joints``: all smooth joints are part of the result.
    """

    axes: tuple[str, ...] = ()
    steps: int = STEPS
    joints: bool = False

    chunk = 8

    read = Job.read

    def item(self, task: Head) -> Item | Exception:
        """A glyph in all its masters."""
        (source,) = sources(self.place)
        masters = source.masters(task[0])
        return _item(masters, sum(map(len, masters.contours)))

    def measured(self, glyphs: Sequence[Any]) -> tuple[Measured, Sequence[Any]]:
        """As for a font where it is open, at the worst place of each finding; heights but the baseline move."""
        found: tuple[Measured, Sequence[Any]] = service("on_axes")(
            glyphs, dict(self.place[2]), self.axes, self.steps, self.thresholds, self.outer,
            heights=self.heights,
        )  # fmt: skip
        return found


def _item(glyph: Outline | Masters, segments: int) -> Item | Exception:
    """A glyph that is checked with others of its em; one that is too large is an error."""
    return LIMITS.error_of(segments) or Item(glyph, segments, glyph.metrics.units_per_em)


def _shapes(glyphs: Sequence[Outline | Masters], rows: Measured) -> IntArray:
    """(n,) a number for the shape of each row's contour, the same in all glyphs; and of the other one, if any."""

    @cache
    def contours_of(g: int) -> tuple[list[bytes], FloatArray]:
        """The shapes of a glyph's contours, and where they begin."""
        glyph = glyphs[g]
        if isinstance(glyph, Outline):
            arrays = glyph.arrays
        else:
            arrays = end_to_end([(contour.points, contour.degrees) for contour in glyph.contours])
        points, degrees, offsets, starts = arrays
        begins = points[..., starts[:-1], :]
        moved = _two_decimals(points - np.repeat(begins, np.diff(starts), axis=-2))
        if glyph.repeats is not None:
            degrees = degrees + 4 * glyph.repeats
        ends = zip(pairwise(starts.tolist()), pairwise(offsets.tolist()), strict=True)
        return [moved[..., a:b, :].tobytes() + degrees[i:j].tobytes() for (a, b), (i, j) in ends], begins

    @cache
    def shape(g: int, contour: int, other: int) -> int:
        shapes, begins = contours_of(g)
        data = shapes[contour]
        if other >= 0:
            data += shapes[other] + _two_decimals(begins[..., other, :] - begins[..., contour, :]).tobytes()
        return int.from_bytes(blake2b(data, digest_size=8).digest(), "little", signed=True)

    others = rows.numbers[:, 3].astype(np.int64)
    found = map(shape, rows.glyphs.tolist(), rows.contours.tolist(), others.tolist())
    return np.array(list(found), dtype=np.int64)


def _two_decimals(points: FloatArray) -> FloatArray:
    """Coordinates, and no negative zero, up to which two contours have one shape."""
    return np.round(points, 2) + 0.0


@dataclass(frozen=True)
class Asked:
    """What is looked for, and what is kept of it.

    Attributes:
        kinds: names. kept: findings of this level or above are kept, others only counted.
        axis: tag of the only one, or None. steps: of each axis, at whose ends glyphs are checked besides the masters.
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


ALL = Asked()
"""Findings of every kind."""


class GlyphFindings(NamedTuple):
    """What was found in a glyph.

    Attributes:
        findings: kinks first, the largest value of each kind first. error: why it could not be checked, or None.
        axes: its kinks along each axis in numbers; () if it is not looked at along axes, or could not be checked.
        score: how far all its kinks, turns and jumps are seen, in thousandths of an em, whatever is looked for and in
            whichever glyph they are reported; None if it could not be checked.
        kinks: along each axis, of it and the glyphs after it up to the next that has some, if joints are asked for.
        unread: what of it was not read, as of :class:`.Outline`.
        repeated: by kind, the number of findings of contours that an earlier glyph has, of which it was said there.
    """

    glyph: str
    gid: int
    findings: list[Finding]
    error: str | None
    axes: tuple[Any, ...]
    score: float | None
    kinks: Sequence[Any] = ()
    unread: tuple[str, ...] = ()
    repeated: Mapping[str, int] = MappingProxyType({})


def check_font(
    source: Source,
    names: Sequence[str],
    asked: Asked = ALL,
    *,
    axes: Sequence[str] | None = None,
    executor: Executor | None = None,
    observer: Observer | None = None,
    once: bool = True,
) -> Iterator[GlyphFindings]:
    """Check glyphs of a font; yield them in glyph index order. Nothing is fitted.

    The result does not depend on the number of workers. A glyph that cannot be read, or takes longer than the workers'
    time limit, has an error, and costs no other glyph.

    Args:
        source: the opened font; workers open it again by its path.
        names: of its glyphs. asked: what is looked for.
        axes: tags of the axes along which glyphs of a variable font are checked; without it all, of () none: glyphs
            are checked where the font is open.
        executor: see :func:`.schedule.workers`; without it, glyphs are checked in this process. It is not closed.
        observer: called after each chunk of glyphs.
        once: a contour that occurs in several glyphs, as components do, is reported in the first one only, and so are
            two that touch or cross. Directions, which depend on all contours of a glyph, are reported in each.

    Raises:
        FontError: the source has no such glyph, or no such axis.
    """
    tags = tuple(axis.tag for axis in source.axes)
    chosen = tags if axes is None else tuple(axes)
    if unknown := [tag for tag in chosen if tag not in tags]:
        raise FontError(f"no axis {unknown[0]!r}: it has {', '.join(tags) or 'none'}", font=str(source.path))
    if unknown := [name for name in names if name not in source.gids]:
        raise FontError("the font has no such glyph", font=str(source.path), glyph=unknown[0])
    tasks = list(heads_of(source, names).values())
    of_font = place_of(source), asked.thresholds, asked.kinds, source.outer
    job = AxesJob(*of_font, BASELINE, chosen, asked.steps, asked.joints) if chosen else CheckJob(*of_font)

    def glyphs() -> Iterator[GlyphFindings]:
        reported = Shapes()
        with workers(0, executor=executor) as pool:
            here = job if chosen else replace(job, heights=heights_in(pool, job))
            for part in run(here, tasks, pool, ordered=True, observer=observer):
                rows, numbers, shapes, scores, along, error, parts = part.result
                again = Counter[str]()
                if once:
                    first = reported.first(shapes)
                    fresh = (first >= 0) & (rows.glyphs[first] == rows.glyphs)  # rows are in the order of glyphs
                    fresh |= rows.kinds == DIRECTION
                    again.update(KINDS[kind].name for kind in rows.kinds[~fresh].tolist())
                    rows = rows.chosen(np.flatnonzero(fresh))
                found = findings([(name, gid) for name, gid, _ in part.tasks], rows, tags if chosen else ())
                every = zip(part.tasks, found, numbers, scores, parts, strict=True)
                for (name, gid, _), own, of_axes, score, unread in every:
                    yield GlyphFindings(name, gid, own, error, of_axes, score, along, unread, again)
                    along, again = (), Counter()

    return glyphs()


def heights_in(pool: Executor, job: CheckJob) -> tuple[float, ...]:
    """:func:`heights_of` the font of a job, by a worker, which has loaded what reads outlines."""
    with suppress(GlyphsplineError):  # the letter that has the height is broken, or ends its worker: it is said of it
        return tuple(pool.submit(heights_of, job).result())
    return BASELINE


def heights_of(job: CheckJob) -> tuple[float, ...]:
    """Heights of baseline, x-height and cap height, as far as the font has them.

    Raises:
        GlyphsplineError: x or H is broken.
    """
    (source,) = sources(job.place)
    if source.each_its_em:
        return BASELINE
    return tuple(dict.fromkeys([*BASELINE, *(each for each in (source.x_height, source.cap_height) if each)]))


@dataclass
class FaceFindings:
    """What was found in one face of a font.

    Attributes:
        font: its path as given, with the number of the face if there are several. family, style: of the font.
        source: of it, where places are to be drawn. home: user-space value of each axis where the font is open.
        findings: those that are kept, the worst first. counts: of all new ones, by kind. repeated: by kind, those of
            contours that an earlier glyph has. known: number of those that the baseline has. levels: those of new
            findings.
        scores: of glyphs, those above 0; see :class:`GlyphFindings`.
        glyphs: number of those checked. failed: glyphs that could not be checked, with the reasons. unread: glyphs that
            were not read in full, with what was not.
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
    repeated: Counter[str] = field(default_factory=Counter)
    known: int = 0
    levels: set[Level] = field(default_factory=set)
    scores: dict[str, float] = field(default_factory=dict)
    glyphs: int = 0
    failed: list[tuple[str, str]] = field(default_factory=list)
    unread: list[tuple[str, str]] = field(default_factory=list)
    axes: list[Any] = field(default_factory=list)
    kinks: Any = None
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


def worst_first(faces: Sequence[FaceFindings]) -> list[tuple[FaceFindings, Finding]]:
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
    executor: Executor | None = None,
    watch: Callable[[], AbstractContextManager[Observer | None]] = nullcontext,
    alone: bool = False,
) -> Iterator[FaceFindings]:
    """Check the faces of fonts, one after the other. A font that cannot be read has an error instead of findings.

    Args:
        fonts: files. asked: what is looked for. chosen: the glyphs of each font; without it, all.
        face_index: the only face of each file; without it, all. location: of variable fonts.
        jobs: worker processes; None takes all cores, 0 does everything in this process, without a time limit.
        executor: used instead of worker processes; it is not closed.
        watch: opened for each face; yields its observer, see :data:`.engine.Observer`.
        alone: one face of one font is checked; its errors are raised.
    """
    if alone:
        face_index = face_index or 0
    with workers(jobs, kinds=["checks"], expected=1, count=len(fonts), executor=executor) as pool:
        for font in fonts:
            try:
                for source in faces_of(font, location, face_index):
                    names = source.glyph_names if chosen is None else chosen(source)
                    name = str(font) if alone or source.num_faces == 1 else f"{font}, face {source.face_index}"
                    with watch() as observer:
                        face = check_face(source, name, names, asked, pool, observer, alone=alone)
                    yield face
            except GlyphsplineError as error:
                if alone:
                    raise
                yield FaceFindings(str(font), error=str(error))


def check_face(
    source: Source,
    name: str,
    names: Sequence[str],
    asked: Asked,
    pool: Executor | None,
    observer: Observer | None,
    *,
    alone: bool,
) -> FaceFindings:
    """Check glyphs of one face of the font called ``name``.

    Raises:
        GlyphsplineError: of a font ``alone``: no glyph is chosen or can be checked, or it lacks the axis asked for.
    """
    if alone and not names:
        raise GlyphsplineError("none of the glyphs asked for is in the font")
    home = {axis.tag: axis.default for axis in source.axes} | dict(source.location)
    face = FaceFindings(name, source.family, source.style, source if asked.drawn else None, home)
    tags = [axis.tag for axis in source.axes]
    if tags and find("services", "on_axes") is None:
        face.remark, tags = f"{name}: checked where it is open, not along its axes{away_words()}", []
    if asked.axis is not None or (alone and asked.joints):
        try:
            tags = [tag for tag in tags_of(source, asked.axis) if asked.axis in (None, tag)]
        except GlyphsplineError as error:
            if alone:
                raise
            face.remark, tags = f"{error}; checked without it", []
    face.axes = [service("no_joints")(axis) for axis in source.axes if axis.tag in tags]
    kinks: list[Sequence[Any]] = []
    for row in check_font(source, names, asked, axes=tags, executor=pool, observer=observer):
        kinks += [row.kinks] if row.kinks else []
        face.glyphs += row.error is None
        if row.error is not None:
            face.failed.append((row.glyph, row.error))
        if row.unread:
            face.unread.append((row.glyph, "; ".join(row.unread)))
        if row.score:
            face.scores[row.glyph] = row.score
        if row.axes:
            face.axes = [known + own for known, own in zip(face.axes, row.axes, strict=True)]
        face.repeated.update(row.repeated)
        face.keep(row.findings, asked)
    if alone and face.failed and not face.glyphs:
        glyph, why = face.failed[0]
        raise GlyphsplineError(f"{name}, glyph {glyph!r}: {why}")
    face.findings.sort(key=severity)
    if kinks:
        face.kinks = service("kink_report")(kinks, face.glyphs, asked.thresholds.corner_angle, tuple(face.failed))
    return face
