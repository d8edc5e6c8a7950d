"""Kinks along the axes of a variable font: how far smooth joints turn between the masters.

A joint that is smooth in every master need not be so between them: the tangents on its two sides are mixed, not their
directions. An axis is measured from tick to tick; :mod:`.between_ticks` has the formulas.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any, Protocol, overload

import numpy as np

from ..errors import GlyphsplineError, is_positive, require
from ..outlines.masters import DesignAxis, MasterContour, Masters
from ..outlines.sampling_limits import CORNER_ANGLE
from ..types import BoolArray, FloatArray, IntArray, counted
from .axis_numbers import AxisNumbers
from .between_ticks import largest_jumps, largest_turns, turns_of

PROFILE = 96
"""Intervals of an axis, in user space, at whose ends the largest turn of all joints is kept."""

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


class Glyphs:
    """Some glyphs as a font of their own.

    Args:
        masters: one glyph or more, of one font. location: axis tag to user-space value.
    """

    def __init__(self, masters: Sequence[Masters], location: Mapping[str, float]) -> None:
        self.path, self.axes, self.location = Path(masters[0].name), masters[0].axes, location
        self.glyph_names = tuple([item.name for item in masters])
        self._masters = {item.name: item for item in masters}

    def masters(self, name: str) -> Masters:
        """A glyph."""
        return self._masters[name]


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


@dataclass(frozen=True, eq=False)
class AxisKinks(Sequence[Kink]):
    """All smooth joints of the glyphs along one axis, the largest turn first.

    Attributes:
        axis: which axis. base: normalised location, of which the axis's own value does not count.
        positions: user-space values of the masters on the axis.
        turns, jumps: (n,) of the joints, as in :class:`Kink`.
        turns_at_masters: (n,) the largest turn of each joint in the masters on the axis.
        profile: (v, 2) user-space values of the axis, ascending, and the largest turn of any joint there; even steps,
            and where joints turn most.
    """

    axis: DesignAxis
    axes: tuple[DesignAxis, ...]
    base: FloatArray
    positions: tuple[float, ...]
    turns: FloatArray
    turns_at_masters: FloatArray
    jumps: FloatArray
    profile: FloatArray
    _where: tuple[FloatArray, FloatArray]
    _glyphs: Sequence[tuple[str, int]]
    _rows: IntArray
    _points: FloatArray
    _masters: Sequence[FloatArray]

    @property
    def joints(self) -> IntArray:
        """(n, 3) which joints: number of the glyph, of its contour, and of the segment that begins there."""
        return self._rows

    @property
    def made(self) -> FloatArray:
        """(n,) degrees by which the turn of each joint exceeds its turns in the masters."""
        made: FloatArray = np.maximum(self.turns - self.turns_at_masters, 0.0)
        return made

    def __len__(self) -> int:
        return len(self.turns)

    @overload
    def __getitem__(self, index: int) -> Kink: ...
    @overload
    def __getitem__(self, index: slice) -> list[Kink]: ...
    def __getitem__(self, index: int | slice) -> Kink | list[Kink]:
        """The kink of so many larger ones."""
        if isinstance(index, slice):
            return [self[k] for k in range(*index.indices(len(self)))]
        if not -len(self) <= index < len(self):
            raise IndexError(index)
        glyph, contour, joint = self._rows[index].tolist()
        name, gid = self._glyphs[glyph]
        x, jump_x = (float(values[index]) for values in self._where)
        at, turns = self._masters[index]
        x0 = max([value for value in at.tolist() if value <= x], default=x)
        x1 = min([value for value in at.tolist() if value >= x], default=x)
        return Kink(
            name, gid, contour, joint, (float(self._points[index, 0]), float(self._points[index, 1])), self.axis.tag,
            float(self.turns[index]), self._location(x), (self.axis.user(x0), self.axis.user(x1)),
            tuple((self.axis.user(float(value)), float(turn)) for value, turn in zip(at, turns, strict=True)),
            float(self.made[index]), float(self.jumps[index]), self._location(jump_x),
        )  # fmt: skip

    def numbers_of(self, glyph: int) -> AxisNumbers:
        """The joints of one glyph, by its number, in numbers."""
        own = np.flatnonzero(self._rows[:, 0] == glyph)
        at = [0.0, *(self._masters[own[0]][0].tolist() if len(own) else ())]
        masters = tuple(sorted({self.axis.user(x) for x in at}))
        if not len(own):
            return AxisNumbers(self.axis.tag, 0, masters)
        turns, made = self.turns[own], self.made[own]
        return AxisNumbers(
            self.axis.tag, len(own), masters, float(turns.max()), float(self.turns_at_masters[own].max()),
            float(made.max()), int((turns > 1).sum()), int((made > 1).sum()), int((self.jumps[own] > 0.1).sum()),
        )  # fmt: skip

    def _location(self, x: float) -> dict[str, float]:
        values = {axis.tag: axis.user(float(value)) for axis, value in zip(self.axes, self.base, strict=True)}
        return values | {self.axis.tag: self.axis.user(x)}

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
    return kinks_along(source, glyphs, [k for k, tag in enumerate(tags) if axis in (None, tag)], corner_angle)


def kinks_along(source: Source, glyphs: Iterable[str] | None, chosen: Sequence[int], corner_angle: float) -> KinkReport:
    """As :func:`kinks`, along the ``chosen`` of the source's axes, by their numbers."""
    parts: list[list[_Measured]] = [[] for _ in chosen]
    names: list[tuple[str, int]] = []
    failed: list[tuple[str, str]] = []
    axes: tuple[DesignAxis, ...] = source.axes
    base: FloatArray = np.zeros(len(axes))
    for masters in _batches(source, source.glyph_names if glyphs is None else glyphs, failed):
        axes, base = masters[0].axes, masters[0].normalised(source.location)
        joints = [_Joints(item, corner_angle) for item in masters]
        for k, part in zip(chosen, parts, strict=True):
            part.append(_measured(joints, k, base, len(names)))
        names += [(item.name, item.gid) for item in masters]
    found = [_gathered(part, axes[k], axes, base, names) for k, part in zip(chosen, parts, strict=True)]
    return KinkReport(tuple(found), len(names), corner_angle, tuple(failed))


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


def _batches(source: Source, names: Iterable[str], failed: list[tuple[str, str]]) -> Iterator[list[Masters]]:
    """Glyphs in their masters, many at once; those that cannot be read are added to ``failed``."""

    def read() -> Iterator[Masters]:
        for name in names:
            try:
                yield source.masters(name)
            except GlyphsplineError as error:
                failed.append((name, error.message))

    each = read()
    while batch := list(islice(each, AT_ONCE)):
        yield batch


def joint_turns(masters: Masters, kink: Kink, values: FloatArray) -> FloatArray:
    """(v,) the turn of a kink's joint, in degrees without sign, at (v,) user-space values of its axis."""
    tags = [axis.tag for axis in masters.axes]
    at = np.tile(masters.normalised(kink.location), (len(values), 1))
    axis = tags.index(kink.axis)
    at[:, axis] = [masters.axes[axis].normalised(float(value)) for value in values]
    controls = joint_controls(masters.contours[kink.contour])[:, kink.joint]
    turns: FloatArray = np.abs(turns_of(np.tensordot(masters.weights_at(at), controls, axes=1)))
    return turns


def joint_controls(contour: MasterContour) -> FloatArray:
    """(K, m, 2, 4, 2) the control points from each joint on: of the segment that arrives, reversed, and of the next."""
    cubics = contour.cubics()
    return np.stack([np.roll(cubics, 1, axis=1)[:, :, ::-1], cubics], axis=2)


class _Joints:
    """The smooth joints of a glyph.

    Attributes:
        masters: of the glyph. places: (J, 2) contour and segment of each joint.
        controls: (K, J, 2, 4, 2) in each master; see :func:`joint_controls`.
    """

    def __init__(self, masters: Masters, corner_angle: float) -> None:
        self.masters = masters
        controls, places = [np.zeros((len(masters), 0, 2, 4, 2))], [np.zeros((0, 2), dtype=np.int64)]
        for number, contour in enumerate(masters.contours):
            controls.append(joint_controls(contour))
            places.append(np.stack([np.full(len(contour), number), np.arange(len(contour))], axis=1))
        every = np.concatenate(controls, axis=1)
        kept = (np.abs(turns_of(every)) < corner_angle).all(axis=0)  # false where there is no direction
        self.controls, self.places = every[:, kept], np.concatenate(places)[kept]

    def along(self, axis: int, base: FloatArray, values: FloatArray) -> FloatArray:
        """(T, J, 2, 4, 2) the control points at T values of an axis."""
        at = np.tile(base, (len(values), 1))
        at[:, axis] = values
        return np.tensordot(self.masters.weights_at(at), self.controls, axes=1)


def ticks_of(masters: Masters, axis: int) -> FloatArray:
    """Normalised values of an axis between which every master's weight is linear: of regions and of the axis's ends."""
    of_axis = masters.axes[axis]
    ends = [-1.0 * (of_axis.minimum < of_axis.default), 0.0, 1.0 * (of_axis.maximum > of_axis.default)]
    counts = masters.regions[:, axis, 1] != 0
    return np.unique([*ends, *np.clip(masters.regions[counts, axis].ravel(), ends[0], ends[2])])


def grid_of(axis: DesignAxis) -> FloatArray:
    """Normalised values of an axis, even in user space, with those where its mapping bends."""
    users = [*np.linspace(axis.minimum, axis.maximum, PROFILE + 1).tolist(), axis.default]
    low, high = axis.normalised(axis.minimum), axis.normalised(axis.maximum)
    bends = [after for _, after in axis.mapping if low <= after <= high]
    return np.unique([*(axis.normalised(value) for value in users), *bends])


def masters_on(masters: Masters, axis: int, base: FloatArray, ticks: FloatArray) -> BoolArray:
    """Which ticks are at a master: at the default, or at the peak of a region that acts there."""
    at = np.tile(base, (len(ticks), 1))
    at[:, axis] = ticks
    acts = masters.scalars(at)[:, 1:] > 0
    peaks = masters.regions[:, axis, 1]
    found: BoolArray = (acts & (peaks != 0) & (ticks[:, None] == peaks)).any(axis=1) | (ticks == 0)
    return found


@dataclass(frozen=True, eq=False)
class _Measured:
    """Columns of the joints of a batch of glyphs; see :class:`AxisKinks`.

    Attributes:
        masters: of each joint (2, P), positions of masters on the axis and turns there.
        largest: at each value of :func:`grid_of` the axis, the largest turn of any joint.
    """

    rows: IntArray
    turns: FloatArray
    at: FloatArray
    jumps: FloatArray
    jump_at: FloatArray
    points: FloatArray
    at_masters: FloatArray
    masters: list[FloatArray]
    largest: FloatArray


def _measured(glyphs: Sequence[_Joints], axis: int, base: FloatArray, first: int) -> _Measured:
    """The joints of glyphs along an axis, all at once; ``first`` is the number of the first glyph."""
    ticks = [ticks_of(glyph.masters, axis) for glyph in glyphs]
    ends = [glyph.along(axis, base, values) for glyph, values in zip(glyphs, ticks, strict=True)]
    # A row for each joint and each interval of its glyph; those of a joint are neighbours.
    start = np.concatenate([np.swapaxes(item[:-1], 0, 1).reshape(-1, 2, 4, 2) for item in ends])
    end = np.concatenate([np.swapaxes(item[1:], 0, 1).reshape(-1, 2, 4, 2) for item in ends])
    joints = [len(glyph.places) for glyph in glyphs]
    intervals = np.repeat([len(values) - 1 for values in ticks], joints)  # of each joint
    low = np.concatenate([np.tile(values[:-1], count) for values, count in zip(ticks, joints, strict=True)])
    high = np.concatenate([np.tile(values[1:], count) for values, count in zip(ticks, joints, strict=True)])
    em = np.repeat(np.repeat([glyph.masters.metrics.units_per_em for glyph in glyphs], joints), intervals)
    turns, turn_ways = largest_turns(start, end)
    jumps, jump_ways = largest_jumps(start, end, em)
    row, jump_row = _first_largest(turns, intervals), _first_largest(jumps, intervals)
    masters: list[FloatArray] = []
    grid = grid_of(glyphs[0].masters.axes[axis])
    largest = np.zeros(len(grid))
    for glyph, values, at_ticks in zip(glyphs, ticks, ends, strict=True):
        on = masters_on(glyph.masters, axis, base, values)
        of_masters = np.abs(turns_of(at_ticks[on]))  # (P, J)
        masters += [np.stack([values[on], of_joint]) for of_joint in of_masters.T]
        k = np.searchsorted(values, grid, side="right").clip(1, max(len(values) - 1, 1)) - 1
        way = ((grid - values[k]) / (values[k + 1] - values[k]))[:, None, None, None, None]
        on_grid = np.abs(turns_of((1 - way) * at_ticks[k] + way * at_ticks[k + 1]))
        largest = np.maximum(largest, np.nan_to_num(on_grid).max(axis=1, initial=0.0))
    return _Measured(
        np.column_stack(
            [np.repeat(first + np.arange(len(glyphs)), joints), np.concatenate([glyph.places for glyph in glyphs])]
        ),
        turns[row], low[row] + turn_ways[row] * (high - low)[row],
        jumps[jump_row], low[jump_row] + jump_ways[jump_row] * (high - low)[jump_row],
        start[row, 0, 0] + turn_ways[row, None] * (end - start)[row, 0, 0],
        np.array([item[1].max() for item in masters]), masters, largest,
    )  # fmt: skip


def _first_largest(values: FloatArray, counts: IntArray) -> IntArray:
    """Index of the first largest value of each group of neighbours."""
    if not len(counts):
        return counts
    starts = np.cumsum(counts) - counts
    owners = np.repeat(np.arange(len(counts)), counts)
    hits = np.flatnonzero(values == np.maximum.reduceat(values, starts)[owners])
    return hits[np.searchsorted(owners[hits], np.arange(len(counts)))]


def _gathered(
    parts: Sequence[_Measured], axis: DesignAxis, axes: tuple[DesignAxis, ...], base: FloatArray,
    names: Sequence[tuple[str, int]],
) -> AxisKinks:  # fmt: skip
    """All batches along an axis, the largest turn first."""

    def column(name: str, shape: tuple[int, ...] = (0,)) -> Any:
        return np.concatenate([np.zeros(shape, dtype=np.int64), *(getattr(part, name) for part in parts)])

    turns, at, at_masters, rows = column("turns"), column("at"), column("at_masters"), column("rows", (0, 3))
    order = np.argsort(-turns, kind="stable")
    masters = [item for part in parts for item in part.masters]
    positions = sorted({0.0, *(value for item in masters for value in item[0].tolist())})
    grid = grid_of(axis)
    largest = np.max([np.zeros(len(grid)), *(part.largest for part in parts)], axis=0)
    above = turns > np.interp(at, grid, largest)  # where a joint's largest turn lies between the grid's values
    profile = np.column_stack([np.append(grid, at[above]), np.append(largest, turns[above])])
    profile = profile[np.argsort(profile[:, 0], kind="stable")]
    profile[:, 0] = [axis.user(float(value)) for value in profile[:, 0]]
    return AxisKinks(
        axis, axes, base, tuple(axis.user(value) for value in positions), turns[order], at_masters[order],
        column("jumps")[order], profile, (at[order], column("jump_at")[order]), names, rows[order],
        column("points", (0, 2))[order], [masters[k] for k in order],
    )  # fmt: skip
