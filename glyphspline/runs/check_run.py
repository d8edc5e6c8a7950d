"""Fonts checked whole: findings glyph by glyph, in glyph index order, from workers.

Between processes findings are columns of numbers; they become values one glyph at a time, when their glyph's turn has
come.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from contextlib import nullcontext
from typing import NamedTuple

import numpy as np

from ..checks.finding import Finding, findings
from ..checks.kinds import DIRECTION, KINDS, THRESHOLDS, Thresholds
from ..checks.kinks import AxisKinks, AxisNumbers
from ..errors import FontError
from ..readers import Source
from ..types import BoolArray, IntArray
from .engine import Observer, run
from .jobs.check import AxesJob, CheckJob, Task
from .places import side_of
from .schedule import InProcess

STEPS = 8
"""Steps of each axis of a variable font, at whose ends its glyphs are checked besides the masters."""


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


def check_font(
    source: Source,
    names: Sequence[str],
    thresholds: Thresholds = THRESHOLDS,
    *,
    kinds: frozenset[str] | None = None,
    axes: Sequence[str] | None = None,
    steps: int = STEPS,
    executor: Executor | None = None,
    observer: Observer | None = None,
    once: bool = True,
    kinks: list[Sequence[AxisKinks]] | None = None,
) -> Iterator[GlyphFindings]:
    """Check glyphs of a font; yield them in glyph index order. Nothing is fitted.

    The result does not depend on the number of workers. A glyph that cannot be read, or takes longer than the workers'
    time limit, has an error, and costs no other glyph.

    Args:
        source: the opened font; workers open it again by its path.
        names: of its glyphs. thresholds: from which values on it counts. kinds: names of those looked for; None: all.
        axes: tags of the axes along which glyphs of a variable font are checked; without it all, of () none: glyphs
            are checked where the font is open.
        steps: of each axis, at whose ends glyphs are checked besides the masters.
        executor: see :func:`.schedule.workers`; without it, glyphs are checked in this process. It is not closed.
        observer: called after each chunk of glyphs.
        once: a contour that stands in several glyphs, as components do, is reported in the first one only, and so are
            two that touch or cross. Directions, which depend on all contours of a glyph, are reported in each.
        kinks: gets the smooth joints of each batch of glyphs along each axis.

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
    looked = frozenset(kind.name for kind in KINDS) if kinds is None else kinds
    job = CheckJob(side_of(source), thresholds, looked, source.outer)
    if chosen:
        job = AxesJob(job.side, thresholds, looked, source.outer, chosen, steps, kinks is not None)
    return _found(job, tasks, tags if chosen else (), executor, observer, once, kinks)


def _found(
    job: CheckJob,
    tasks: list[Task],
    tags: Sequence[str],
    executor: Executor | None,
    observer: Observer | None,
    once: bool,
    kinks: list[Sequence[AxisKinks]] | None,
) -> Iterator[GlyphFindings]:
    """Findings glyph by glyph, without those of a shape that was reported for an earlier glyph."""
    reported = _Reported() if once else None
    with nullcontext(executor) if executor else InProcess() as pool:
        for part in run(job, tasks, pool, ordered=True, observer=observer):
            rows, axes, shapes, along, error = part.result
            if kinks is not None and along:
                kinks.append(along)
            if reported is not None:
                rows = rows.chosen(np.flatnonzero(reported.fresh(shapes, rows.glyphs) | (rows.kinds == DIRECTION)))
            found = findings([(task.name, task.gid) for task in part.tasks], rows, tags)
            for task, own, numbers in zip(part.tasks, found, axes, strict=True):
                yield GlyphFindings(task.name, task.gid, own, error, numbers)


class _Reported:
    """Sorted array of the hashes of shapes that were reported; it uses a tenth of the memory of a set."""

    def __init__(self) -> None:
        self._shapes = np.zeros(0, dtype=np.int64)

    def fresh(self, shapes: IntArray, glyphs: IntArray) -> BoolArray:
        """(n,) whether the shape of a row's contour stands in no glyph before the row's glyph; adds them."""
        unique, rows = np.unique(shapes, return_inverse=True)
        first = np.full(len(unique), np.iinfo(np.int64).max)
        np.minimum.at(first, rows, glyphs)
        at = np.searchsorted(self._shapes, unique)
        new = np.searchsorted(self._shapes, unique, side="right") == at
        self._shapes = np.insert(self._shapes, at[new], unique[new])
        found: BoolArray = new[rows] & (first[rows] == glyphs)
        return found
