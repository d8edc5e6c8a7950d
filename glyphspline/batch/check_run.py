"""Fonts checked whole: findings glyph by glyph, in glyph index order, from workers.

Between processes findings are columns of numbers; they become values one glyph at a time, when their glyph's turn has
come.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from contextlib import nullcontext
from hashlib import blake2b
from itertools import groupby
from typing import NamedTuple

import numpy as np

from ..checks.check import THRESHOLDS
from ..checks.finding import Finding, Measured, findings
from ..checks.kinds import DIRECTION, Thresholds
from ..checks.kinks import AxisNumbers
from ..errors import FontError, GlyphsplineError
from ..outlines.masters import Masters
from ..outlines.outline import FontMetrics, Outline
from ..readers import Font, Source
from ..types import BoolArray, FloatArray, IntArray
from .job import Place
from .pool import sign_of_life
from .schedule import InProcess, pool_size, slices, spread

STEPS = 8
"""Steps of each axis of a variable font, at whose ends its glyphs are checked besides the masters."""

BATCH, MASTERS_BATCH = 200, 8
"""Glyphs measured at once: a few megabytes of outlines. A worker's time limit is for one batch."""

DECIMALS = 2
"""Decimals of coordinates up to which two contours have one shape."""

Observer = Callable[[int, int, int], None]
"""Called with the number of glyphs done, of all glyphs, and of those that failed."""


class GlyphFindings(NamedTuple):
    """What was found in a glyph.

    Attributes:
        findings: kinks first, the largest value of each kind first. error: why it could not be checked, or None.
        axes: its kinks along each axis in numbers; () if it is not looked at along axes, or could not be checked.
    """

    glyph: str
    gid: int
    findings: list[Finding]
    error: str | None
    axes: tuple[AxisNumbers, ...]


class CheckJob(NamedTuple):
    """What a worker needs: the source, and what is looked for.

    Attributes:
        metrics: of a font file that is read as it is, in bulk; None of any other source.
        axes: tags of the axes along which glyphs are looked at; () for the font where it is open.
        outer: direction of outer contours; see :attr:`.Source.outer`.
    """

    place: Place
    metrics: FontMetrics | None
    thresholds: Thresholds
    axes: tuple[str, ...]
    steps: int
    outer: int


class Task(NamedTuple):
    """One glyph."""

    gid: int
    name: str


class Checked(NamedTuple):
    """What a worker found in some glyphs.

    Attributes:
        tasks: those that were measured. rows: of them. axes: of each; see :class:`GlyphFindings`.
        shapes: (n,) of the row's contour, wherever it stands. errors: why others were not.
    """

    tasks: list[Task]
    rows: Measured
    axes: list[tuple[AxisNumbers, ...]]
    shapes: IntArray
    errors: dict[int, str]


def check_font(
    source: Source,
    names: Sequence[str],
    thresholds: Thresholds = THRESHOLDS,
    *,
    axes: Sequence[str] | None = None,
    steps: int = STEPS,
    executor: Executor | None = None,
    observer: Observer | None = None,
    once: bool = True,
) -> Iterator[GlyphFindings]:
    """Check glyphs of a font; yield them in glyph index order. Nothing is fitted.

    The result does not depend on the number of workers. A glyph that cannot be read, or takes longer than the workers'
    time limit, has an error, and costs no other glyph.

    Args:
        source: the opened font; workers open it again by its path.
        names: of its glyphs. thresholds: from which values on it counts.
        axes: tags of the axes along which glyphs of a variable font are checked; without it all, of () none: glyphs
            are checked where the font is open.
        steps: of each axis, at whose ends glyphs are checked besides the masters.
        executor: see :func:`.schedule.workers`; without it, glyphs are checked in this process. It is not closed.
        observer: called after each chunk of glyphs.
        once: a contour that stands in several glyphs, as components do, is told of in the first one only, and so are
            two that touch or cross. Directions, which depend on all contours of a glyph, are told in each.

    Raises:
        FontError: the source has no such glyph, or no such axis.
    """
    tags = tuple(axis.tag for axis in source.axes)
    chosen = tags if axes is None else tuple(axes)
    if unknown := [tag for tag in chosen if tag not in tags]:
        raise FontError(f"no axis {unknown[0]!r}: it has {', '.join(tags) or 'none'}", font=str(source.path))
    index = {name: gid for gid, name in enumerate(source.glyph_names)}
    if unknown := [name for name in names if name not in index]:
        raise FontError("the font has no such glyph", font=str(source.path), glyph=unknown[0])
    tasks = sorted({Task(index[name], name) for name in names})
    place = (source.path.absolute(), source.face_index, tuple(source.location.items()))
    in_bulk = type(source) is Font and not chosen
    job = CheckJob(place, source.metrics if in_bulk else None, thresholds, chosen, steps, source.outer)
    return _found(job, tasks, tags if chosen else (), executor, observer, once)


def _found(
    job: CheckJob,
    tasks: list[Task],
    tags: Sequence[str],
    executor: Executor | None,
    observer: Observer | None,
    once: bool,
) -> Iterator[GlyphFindings]:
    with nullcontext(executor) if executor else InProcess() as pool:
        most = MASTERS_BATCH if job.axes else BATCH
        chunks = slices(tasks, max(1, min(most, len(tasks) // (4 * pool_size(pool)))))
        waiting: dict[
            Task, tuple[Sequence[Task], Checked]
        ] = {}  # by a chunk's first glyph, until those before are done
        told = _Told() if once else None
        done = broken = following = 0
        for chunk, result in spread(pool, check_tasks, job, chunks):
            if isinstance(result, Exception):
                result = _nothing({task.gid: result.message for task in chunk})
            waiting[chunk[0]] = chunk, result
            done, broken = done + len(chunk), broken + len(result.errors)
            if observer:
                observer(done, len(tasks), broken)
            while following < len(tasks) and (ready := waiting.pop(tasks[following], None)) is not None:
                following += len(ready[0])
                yield from _values(*ready, tags, told)


def _values(
    tasks: Sequence[Task], checked: Checked, tags: Sequence[str], told: _Told | None
) -> Iterator[GlyphFindings]:
    """Findings of a chunk's glyphs, but for those of a shape that was told of in an earlier glyph."""
    rows = checked.rows
    if told is not None:
        rows = rows.chosen(np.flatnonzero(told.fresh(checked.shapes, rows.glyphs) | (rows.kinds == DIRECTION)))
    found = findings([(task.name, task.gid) for task in checked.tasks], rows, tags)
    of_gid = {task.gid: k for k, task in enumerate(checked.tasks)}
    for task in tasks:
        if (k := of_gid.get(task.gid)) is None:
            yield GlyphFindings(task.name, task.gid, [], checked.errors.get(task.gid), ())
        else:
            yield GlyphFindings(task.name, task.gid, found[k], None, checked.axes[k])


class _Told:
    """The shapes that have been told of, ascending: in an array, which for a large font is a tenth of a set."""

    def __init__(self) -> None:
        self._shapes = np.zeros(0, dtype=np.int64)

    def fresh(self, shapes: IntArray, glyphs: IntArray) -> BoolArray:
        """(n,) whether the shape of a row's contour stands in no glyph before the row's glyph; they are told then."""
        unique, rows = np.unique(shapes, return_inverse=True)
        first = np.full(len(unique), np.iinfo(np.int64).max)
        np.minimum.at(first, rows, glyphs)
        at = np.searchsorted(self._shapes, unique)
        new = np.searchsorted(self._shapes, unique, side="right") == at
        self._shapes = np.insert(self._shapes, at[new], unique[new])
        found: BoolArray = new[rows] & (first[rows] == glyphs)
        return found


class _Part(NamedTuple):
    """Glyphs measured together; see :class:`Checked`."""

    glyphs: Sequence[Outline | Masters]
    rows: Measured
    axes: list[tuple[AxisNumbers, ...]]


def check_tasks(job: CheckJob, tasks: Sequence[Task]) -> Checked:
    """Check glyphs, in a worker. A glyph that fails costs only itself."""
    sign_of_life()
    errors: dict[int, str] = {}
    read = list[Outline | Masters]()
    for task, glyph in zip(tasks, _read(job, tasks), strict=True):
        if isinstance(glyph, GlyphsplineError):
            errors[task.gid] = glyph.message
        else:
            read.append(glyph)
    parts = []
    for _, group in groupby(read, key=lambda glyph: glyph.metrics.units_per_em):  # each drawing has its own em
        parts += _measured(job, list(group), errors)
        sign_of_life()
    if not parts:
        return _nothing(errors)
    glyphs = [glyph for part in parts for glyph in part.glyphs]
    starts = np.cumsum([0, *(len(part.glyphs) for part in parts)])
    own = [part.rows._replace(glyphs=part.rows.glyphs + start) for part, start in zip(parts, starts, strict=False)]
    rows = Measured._make([np.concatenate(columns) for columns in zip(*own, strict=True)])
    axes = [of_glyph for part in parts for of_glyph in part.axes]
    return Checked([Task(glyph.gid, glyph.name) for glyph in glyphs], rows, axes, _shapes(glyphs, rows), errors)


def _read(job: CheckJob, tasks: Sequence[Task]) -> Sequence[Outline | Masters | GlyphsplineError]:
    from .worker import bulk_reader, source_of

    if job.axes:
        found: list[Outline | Masters | GlyphsplineError] = []
        source = source_of(*job.place)
        for task in tasks:
            try:
                found.append(source.masters(task.name))
            except GlyphsplineError as error:
                found.append(error)
        return found
    if job.metrics is not None:
        return bulk_reader(*job.place).outlines([(task.name, task.gid, ()) for task in tasks], job.metrics)
    return source_of(*job.place).outlines([task.gid for task in tasks], errors="return")


def _measured(job: CheckJob, glyphs: Sequence[Outline | Masters], errors: dict[int, str]) -> list[_Part]:
    """Measure glyphs together; after an unexpected error, one by one."""
    from ..checks.measured import measured
    from ..checks.on_axes import on_axes

    try:
        if job.axes:
            masters = [glyph for glyph in glyphs if isinstance(glyph, Masters)]
            rows, axes = on_axes(masters, dict(job.place[2]), job.axes, job.steps, job.thresholds, job.outer)
        else:
            arrays = [glyph.arrays for glyph in glyphs if isinstance(glyph, Outline)]
            rows = measured(arrays, job.thresholds, glyphs[0].metrics.units_per_em, job.outer)
            axes = [()] * len(glyphs)
        return [_Part(glyphs, rows, axes)]
    except Exception as error:
        if len(glyphs) > 1:
            return [part for glyph in glyphs for part in _measured(job, [glyph], errors)]
        message = error.message if isinstance(error, GlyphsplineError) else f"{type(error).__name__}: {error}"
        errors[glyphs[0].gid] = message
        return []


def _shapes(glyphs: Sequence[Outline | Masters], rows: Measured) -> IntArray:
    """(n,) a number for the shape of each row's contour, the same wherever it stands; and of the other one, if any."""
    found = np.zeros(len(rows.glyphs), dtype=np.int64)
    known: dict[tuple[int, int, int], int] = {}
    others = rows.numbers[:, 3].astype(np.int64).tolist()
    for k, key in enumerate(zip(rows.glyphs.tolist(), rows.contours.tolist(), others, strict=True)):
        if key not in known:
            contours = glyphs[key[0]].contours
            begin: FloatArray = contours[key[1]].points[..., :1, :]
            data = b""
            for contour in [contours[number] for number in key[1:] if number >= 0]:
                data += (np.round(contour.points - begin, DECIMALS) + 0.0).tobytes() + contour.degrees.tobytes()
            known[key] = int.from_bytes(blake2b(data, digest_size=8).digest(), "little", signed=True)
        found[k] = known[key]
    return found


def _nothing(errors: dict[int, str]) -> Checked:
    return Checked([], Measured.joined(()), [], np.zeros(0, dtype=np.int64), errors)
