"""Kinks along the axes of a variable font: how far smooth joints turn between the masters.

A joint that is smooth in every master need not be so between them: the tangents on its two sides are mixed, not their
directions. Every joint is a row of findings at its worst place; :func:`glyphspline.kinks` shows all rows, and
:func:`.on_axes.on_axes` takes those that count. Joints are measured by :mod:`.joints_along`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Protocol, overload

import numpy as np

from ..errors import GlyphsplineError, is_positive, require
from ..outlines.masters import DesignAxis, Masters
from ..outlines.sampling_limits import CORNER_ANGLE
from ..types import FloatArray, IntArray, counted
from .finding import Measured
from .joints_along import Joints, grid_of, joint_controls, joints_along, turns_of

AT_ONCE = 64
"""Glyphs that are measured in one pass."""


class Source(Protocol):
    """What kinks are measured of: :class:`glyphspline.Font`, or any other source of a variable font."""

    path: Path
    axes: tuple[DesignAxis, ...]
    glyph_names: tuple[str, ...]
    location: Mapping[str, float]

    def masters(self, name: str) -> Masters:
        """A glyph in all its masters."""


@dataclass(frozen=True)
class Kink:
    """The largest turn of one joint along one axis, and its largest jump of curvature.

    Attributes:
        glyph, gid: which glyph. contour: number of the contour.
        joint: number of the segment that begins at the joint. point: the joint at the worst location.
        axis: tag of the axis. turn: largest turn along it, in degrees, without sign.
        location: where that is: axis tag to user-space value.
        between: user-space values, on the axis, of the masters before and behind; one value twice at a master.
        at_masters: user-space value and turn of each master on the axis.
        made: degrees by which ``turn`` exceeds the turn in every master on the axis: made by interpolation.
        jump: largest relative jump of curvature along the axis: ``|κ₁ - κ₀| / max(|κ₀|, |κ₁|)``, from 0 to 2.
        jump_location: where that is.
    """

    glyph: str
    gid: int
    contour: int
    joint: int
    point: tuple[float, float]
    axis: str
    turn: float
    location: dict[str, float]
    between: tuple[float, float]
    at_masters: tuple[tuple[float, float], ...]
    made: float
    jump: float
    jump_location: dict[str, float]


@dataclass(frozen=True)
class AxisNumbers:
    """The smooth joints of some glyphs along one axis; see :class:`Kink`.

    Attributes:
        axis: its tag. joints: how many there are. masters: user-space values of the masters on the axis, ascending.
        largest_turn, largest_turn_at_masters, largest_made: in degrees; None without joints.
        turns_over_1, made_over_1: number of joints with more than a degree.
        jumps_over_10_percent: number of joints where curvature jumps by more.
    """

    axis: str
    joints: int
    masters: tuple[float, ...]
    largest_turn: float | None = None
    largest_turn_at_masters: float | None = None
    largest_made: float | None = None
    turns_over_1: int = 0
    made_over_1: int = 0
    jumps_over_10_percent: int = 0

    def __add__(self, other: AxisNumbers) -> AxisNumbers:
        """Those of the glyphs of both, along the same axis."""
        return AxisNumbers(
            self.axis, self.joints + other.joints, tuple(sorted({*self.masters, *other.masters})),
            _larger(self.largest_turn, other.largest_turn),
            _larger(self.largest_turn_at_masters, other.largest_turn_at_masters),
            _larger(self.largest_made, other.largest_made), self.turns_over_1 + other.turns_over_1,
            self.made_over_1 + other.made_over_1, self.jumps_over_10_percent + other.jumps_over_10_percent,
        )  # fmt: skip


def _larger(a: float | None, b: float | None) -> float | None:
    return max([value for value in (a, b) if value is not None], default=None)


@dataclass(frozen=True, eq=False)
class AxisKinks(Sequence[Kink]):
    """All smooth joints of the glyphs along one axis, the largest turn first.

    Attributes:
        axis: which axis. axes: of the font. glyphs: name and glyph index of each glyph that was measured.
        rows: (n,) the joints as findings: the value is the largest turn, the detail what interpolation makes of it.
        at_masters: of each joint (2, P) normalised values of the masters on the axis, and the turns there.
        jumps: (n,) largest relative jumps of curvature, as in :class:`Kink`; jumps_at: user-space values of the axis.
        profile: (v, 2) user-space values of the axis, ascending, and the largest turn of any joint there; even steps,
            and where joints turn most.
    """

    axis: DesignAxis
    axes: tuple[DesignAxis, ...]
    glyphs: Sequence[tuple[str, int]]
    rows: Measured
    at_masters: Sequence[FloatArray]
    jumps: FloatArray
    jumps_at: FloatArray
    profile: FloatArray

    @property
    def joints(self) -> IntArray:
        """(n, 3) which joints: number of the glyph, of its contour, and of the segment that begins there."""
        return np.column_stack([self.rows.glyphs, self.rows.contours, self.rows.segments])

    @property
    def turns(self) -> FloatArray:
        """(n,) the largest turn of each joint, in degrees."""
        return self.rows.numbers[:, 1]

    @property
    def turns_at_masters(self) -> FloatArray:
        """(n,) the largest turn of each joint in the masters on the axis."""
        return np.array([turns.max() for _, turns in self.at_masters])

    @property
    def made(self) -> FloatArray:
        """(n,) degrees by which the turn of each joint exceeds its turns in the masters."""
        return self.rows.numbers[:, 2]

    @property
    def positions(self) -> tuple[float, ...]:
        """User-space values of the masters on the axis, ascending."""
        return self._users(self.at_masters)

    def _users(self, at_masters: Iterable[FloatArray]) -> tuple[float, ...]:
        return tuple(sorted({self.axis.user(x) for x in (0.0, *(x for at, _ in at_masters for x in at.tolist()))}))

    def __len__(self) -> int:
        return len(self.at_masters)

    @overload
    def __getitem__(self, index: int) -> Kink: ...
    @overload
    def __getitem__(self, index: slice) -> list[Kink]: ...
    def __getitem__(self, index: int | slice) -> Kink | list[Kink]:
        """One kink, or several."""
        if isinstance(index, slice):
            return [self[k] for k in range(*index.indices(len(self)))]
        if not -len(self) <= index < len(self):
            raise IndexError(index)
        glyph, contour, joint, _, (_, turn, made, _), (x, y), location, (low, high) = (
            column[index].tolist() for column in self.rows
        )
        name, gid = self.glyphs[glyph]
        at = dict(zip([axis.tag for axis in self.axes], location, strict=True))
        at_masters = [(self.axis.user(value), turn) for value, turn in self.at_masters[index].T.tolist()]
        return Kink(
            name, gid, contour, joint, (x, y), self.axis.tag, turn, at, (low, high), tuple(at_masters), made,
            float(self.jumps[index]), at | {self.axis.tag: float(self.jumps_at[index])},
        )  # fmt: skip

    def numbers_of(self, glyph: int) -> AxisNumbers:
        """The joints of one glyph, by its number, in numbers."""
        own = np.flatnonzero(self.rows.glyphs == glyph)
        masters = self._users([self.at_masters[k] for k in own[:1]])
        if not len(own):
            return AxisNumbers(self.axis.tag, 0, masters)
        turns, made = self.turns[own], self.made[own]
        return AxisNumbers(
            self.axis.tag, len(own), masters, float(turns.max()), float(self.turns_at_masters[own].max()),
            float(made.max()), int((turns > 1).sum()), int((made > 1).sum()), int((self.jumps[own] > 0.1).sum()),
        )  # fmt: skip

    @classmethod
    def joined(cls, parts: Sequence[AxisKinks]) -> AxisKinks:
        """The joints of all parts along their axis, as if their glyphs had been measured at once."""
        first = parts[0]
        before = np.cumsum([0, *(len(part.glyphs) for part in parts[:-1])]).tolist()
        rows = [part.rows._replace(glyphs=part.rows.glyphs + n) for part, n in zip(parts, before, strict=True)]
        grid = users_of_grid(first.axis)  # a profile has its grid's values before others at the same place
        return _sorted(
            first.axes, [axis.tag for axis in first.axes].index(first.axis.tag),
            [glyph for part in parts for glyph in part.glyphs], Measured.joined(rows, len(first.axes)),
            [item for part in parts for item in part.at_masters], np.concatenate([part.jumps for part in parts]),
            np.concatenate([part.jumps_at for part in parts]),
            [part.profile[np.searchsorted(part.profile[:, 0], grid), 1] for part in parts],
        )  # fmt: skip

    def __repr__(self) -> str:
        largest = f", the largest turn {self.turns[0]:.1f}°" if len(self) else ""
        return f"<AxisKinks along {self.axis.tag}: {counted(len(self), 'joint')}{largest}>"


@dataclass(frozen=True, eq=False)
class KinkReport(Sequence[AxisKinks]):
    """What :func:`kinks` finds: one item for each axis.

    Attributes:
        glyphs: number of glyphs measured. corner_angle: degrees of turn from which joints are corners.
        failed: glyphs that could not be measured, with the reasons.
    """

    of_axes: tuple[AxisKinks, ...]
    glyphs: int
    corner_angle: float
    failed: tuple[tuple[str, str], ...] = ()

    def __len__(self) -> int:
        return len(self.of_axes)

    @overload
    def __getitem__(self, index: int) -> AxisKinks: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[AxisKinks, ...]: ...
    def __getitem__(self, index: int | slice) -> AxisKinks | tuple[AxisKinks, ...]:
        return self.of_axes[index]


def kinks(
    source: Source, glyphs: Iterable[str] | None = None, axis: str | None = None, *, corner_angle: float = CORNER_ANGLE
) -> KinkReport:
    """Measure how far smooth joints turn along the axes of a variable font. Nothing is fitted.

    A joint of two segments is smooth if it turns by less than ``corner_angle`` in every master of its glyph. Every axis
    is measured by itself; the other axes are where the font is open.

    Args:
        source: a variable font, or a designspace. glyphs: names; without them, all.
        axis: tag of the only axis; without it, all.
        corner_angle: degrees of turn from which a joint is a corner.

    Returns:
        For each axis its joints, the largest turn first; glyphs that cannot be measured are in ``failed``.

    Raises:
        GlyphsplineError: the font is not variable, or has no such axis.
        OptionError: ``corner_angle`` is out of its range.

    Example:
        >>> import glyphspline as gs
        >>> report = gs.kinks(gs.open_font("fonts_test/variable.ttf"))
        >>> report[0]
        <AxisKinks along wght: 64 joints, the largest turn 0.0°>
    """
    tags = tags_of(source, axis)
    require(is_positive(corner_angle, 180), "corner_angle is above 0 and up to 180 degrees", corner_angle)
    failed: list[tuple[str, str]] = []

    def read() -> Iterator[Masters]:
        for name in source.glyph_names if glyphs is None else glyphs:
            try:
                yield source.masters(name)
            except GlyphsplineError as error:
                failed.append((name, error.message))

    chosen = [k for k, tag in enumerate(tags) if axis in (None, tag)]
    found = kinks_along(read(), source.axes, source.location, chosen, corner_angle)
    return KinkReport(tuple(found), len(found[0].glyphs), corner_angle, tuple(failed))


def kinks_along(
    glyphs: Iterable[Masters], axes: tuple[DesignAxis, ...], location: Mapping[str, float], chosen: Sequence[int],
    corner_angle: float, at_once: int = AT_ONCE,
) -> list[AxisKinks]:  # fmt: skip
    """The smooth joints of glyphs along the ``chosen`` of a font's axes, by their numbers.

    Args:
        glyphs: in all their masters. axes: of a font without glyphs; otherwise those of its glyphs count.
        location: user-space values of the other axes. at_once: number of glyphs that are measured in one pass.
    """
    parts: list[list[AxisKinks]] = [[] for _ in chosen]
    each = iter(glyphs)
    while batch := list(islice(each, at_once)):
        axes, base = batch[0].axes, batch[0].normalised(location)
        joints = [Joints(item, corner_angle) for item in batch]
        names = [(item.name, item.gid) for item in batch]
        for k, part in zip(chosen, parts, strict=True):
            part.append(_sorted(axes, k, names, *joints_along(joints, k, base)))
    empty: FloatArray = np.zeros(0)
    return [
        AxisKinks.joined(part) if part else _sorted(axes, k, [], Measured.joined((), len(axes)), [], empty, empty, [])
        for k, part in zip(chosen, parts, strict=True)
    ]


def tags_of(source: Source, axis: str | None = None) -> list[str]:
    """The tags of a source's axes.

    Raises:
        GlyphsplineError: the source is not variable, or has no such axis.
    """
    tags = [of_font.tag for of_font in source.axes]
    if not tags:
        raise GlyphsplineError("not a variable font: it has no axes", font=str(source.path))
    if axis is not None and axis not in tags:
        raise GlyphsplineError(f"no axis {axis!r}: it has {', '.join(tags)}", font=str(source.path))
    return tags


def joint_turns(masters: Masters, kink: Kink, values: FloatArray) -> FloatArray:
    """(v,) the turn of a kink's joint, in degrees without sign, at (v,) user-space values of its axis."""
    tags = [axis.tag for axis in masters.axes]
    at = np.tile(masters.normalised(kink.location), (len(values), 1))
    axis = tags.index(kink.axis)
    at[:, axis] = [masters.axes[axis].normalised(float(value)) for value in values]
    controls = joint_controls(masters.contours[kink.contour])[:, kink.joint]
    turns: FloatArray = np.abs(turns_of(np.tensordot(masters.weights_at(at), controls, axes=1)))
    return turns


def _sorted(
    axes: tuple[DesignAxis, ...], axis: int, glyphs: Sequence[tuple[str, int]], rows: Measured,
    at_masters: Sequence[FloatArray], jumps: FloatArray, jumps_at: FloatArray, on_grid: Sequence[FloatArray],
) -> AxisKinks:  # fmt: skip
    """Joints along an axis, the largest turn first; ``on_grid``: largest turns of parts of them on the grid."""
    grid = users_of_grid(axes[axis])
    largest = np.max([np.zeros(len(grid)), *on_grid], axis=0)
    turns, at = rows.numbers[:, 1], rows.locations[:, axis]
    above = turns > np.interp(at, grid, largest)  # where a joint's largest turn lies between the grid's values
    profile = np.column_stack([np.append(grid, at[above]), np.append(largest, turns[above])])
    order = np.argsort(-turns, kind="stable")
    return AxisKinks(
        axes[axis], axes, glyphs, rows.chosen(order), [at_masters[k] for k in order], jumps[order], jumps_at[order],
        profile[np.argsort(profile[:, 0], kind="stable")],
    )  # fmt: skip


def users_of_grid(axis: DesignAxis) -> FloatArray:
    """The values of :func:`grid_of` in user space, ascending."""
    return np.array([axis.user(x) for x in grid_of(axis).tolist()])
