"""Glyphs checked; what is found goes between processes as columns of numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from hashlib import blake2b
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...checks.finding import Measured
from ...checks.kinds import KINDS, Thresholds
from ...checks.kinks import AxisKinks, AxisNumbers
from ...errors import GlyphsplineError
from ..engine import Item, Job, reason
from ..places import Side, readers, sources

if TYPE_CHECKING:
    from ...outlines.masters import Masters
    from ...outlines.outline import Outline
    from ...types import FloatArray, IntArray

DECIMALS = 2
"""Decimals of coordinates up to which two contours have one shape."""


class Task(NamedTuple):
    """One glyph."""

    gid: int
    name: str


class Checked(NamedTuple):
    """What a worker found in some glyphs.

    Attributes:
        rows: of the tasks that were done together. axes: kinks of each along each axis, in numbers.
        shapes: (n,) of the row's contour, wherever it stands. kinks: along each axis, if they are asked for.
        error: why the only task could not be checked, or None.
    """

    rows: Measured
    axes: Sequence[tuple[AxisNumbers, ...]]
    shapes: IntArray
    kinks: Sequence[AxisKinks] = ()
    error: str | None = None


@dataclass(frozen=True)
class CheckJob(Job[Task, Checked]):
    """Glyphs checked where their font is open.

    Attributes:
        kinds: names of those that are looked for. outer: direction of outer contours; see :attr:`.Source.outer`.
    """

    side: Side
    thresholds: Thresholds
    kinds: frozenset[str]
    outer: int

    joints = False

    chunk = 200
    """A few megabytes of outlines."""

    def read(self, tasks: Sequence[Task]) -> list[Item | Exception]:
        """Outlines of one em together: each drawing has its own."""
        (read,) = readers(self.side)
        found = read([(task.name, task.gid, ()) for task in tasks])
        return [each if isinstance(each, Exception) else Item(each, kind=each.metrics.units_per_em) for each in found]

    def together(self, tasks: Sequence[Task], contents: Sequence[Any]) -> Checked:
        """Measure glyphs."""
        rows, kinks = self.measured(contents)
        looked_for = [number for number, kind in enumerate(KINDS) if kind.name in self.kinds]
        rows = rows.chosen(np.flatnonzero(np.isin(rows.kinds, looked_for)))
        numbers = [tuple(along.numbers_of(g) for along in kinks) for g in range(len(contents))]
        return Checked(rows, numbers, _shapes(contents, rows), kinks if self.joints else ())

    def measured(self, glyphs: Sequence[Any]) -> tuple[Measured, Sequence[AxisKinks]]:
        """Findings of every kind, and all smooth joints along each axis."""
        from ...checks.check import measured

        arrays = [outline.arrays for outline in glyphs]
        return measured(arrays, self.thresholds, glyphs[0].metrics.units_per_em, self.outer), ()

    def failed(self, task: Task, error: Exception) -> Checked:
        """Why a glyph could not be checked."""
        return Checked(Measured.joined(()), [()], np.zeros(0, dtype=np.int64), error=reason(error))

    def failures(self, result: Checked) -> int:
        """Number of glyphs that could not be checked."""
        return int(result.error is not None)


@dataclass(frozen=True)
class AxesJob(CheckJob):
    """Glyphs checked in their masters and along ``axes``, which are tags, at the ends of ``steps`` of each.

    ``joints``: all smooth joints are part of the result.
    """

    axes: tuple[str, ...]
    steps: int
    joints: bool

    chunk = 8

    def read(self, tasks: Sequence[Task]) -> list[Item | Exception]:
        """Glyphs in all their masters."""
        (source,) = sources(self.side.place)
        found: list[Item | Exception] = []
        for task in tasks:
            try:
                found.append(Item(masters := source.masters(task.name), kind=masters.metrics.units_per_em))
            except GlyphsplineError as error:
                found.append(error)
        return found

    def measured(self, glyphs: Sequence[Any]) -> tuple[Measured, Sequence[AxisKinks]]:
        """As for a font where it is open, at the worst place of each finding."""
        from ...checks.on_axes import on_axes

        return on_axes(glyphs, dict(self.side.place[2]), self.axes, self.steps, self.thresholds, self.outer)


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
