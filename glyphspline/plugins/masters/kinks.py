"""Kinks along the axes of a variable font: how far smooth joints turn between the masters.

A joint that is smooth in every master need not be so between them: the tangents on its two sides are mixed, not their
directions. Every joint is a row of findings at its worst place; :func:`glyphspline.kinks` shows all rows, and
:func:`.on_axes.on_axes` takes those that count. The mathematics is in :mod:`.turns`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import astuple, dataclass
from functools import cache, cached_property
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple, Protocol, overload

import numpy as np

from ...errors import GlyphsplineError, is_positive, require
from ...outlines.flaws.kinds import KINK
from ...outlines.flaws.turns import NO_HANDLE, joint_controls, largest_jumps, largest_turns, turns_of
from ...outlines.masters import DesignAxis, Masters
from ...outlines.outline import Outline
from ...outlines.sampling import CORNER_ANGLE
from ...readers.source import tags_of
from ...types import BoolArray, FloatArray, IntArray, counted
from ..checks.finding import Measured


class VariableSource(Protocol):
    """What kinks are measured of: :class:`glyphspline.Font`, or any other source of a variable font."""

    path: Path
    axes: tuple[DesignAxis, ...]
    location: Mapping[str, float]

    @property
    def glyph_names(self) -> Sequence[str]:
        """All glyphs."""

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
        pairs: list[Any] = [*zip(astuple(self), astuple(other), strict=True)]
        largest: list[Any] = [max((value for value in pair if value is not None), default=None) for pair in pairs[3:6]]
        masters = tuple(sorted({*self.masters, *other.masters}))
        return AxisNumbers(self.axis, sum(pairs[1]), masters, *largest, *map(sum, pairs[6:]))


@dataclass(frozen=True, eq=False)
class AxisKinks(Sequence[Kink]):
    """All smooth joints of the glyphs along one axis, the largest turn first.

    Attributes:
        axes: of the font. number: which of them. glyphs: name and glyph index of each glyph that was measured.
        rows: (n,) the joints as findings: the value is the largest turn, the detail what interpolation makes of it.
        at_masters: of each joint (2, P) normalised values of the masters on the axis, and the turns there.
        jumps: (n,) largest relative jumps of curvature, as in :class:`Kink`; jumps_at: user-space values of the axis.
        on_grid: largest turn of any joint at each value of :func:`grid_of` the axis.
    """

    axes: tuple[DesignAxis, ...]
    number: int
    glyphs: Sequence[tuple[str, int]]
    rows: Measured
    at_masters: Sequence[FloatArray]
    jumps: FloatArray
    jumps_at: FloatArray
    on_grid: FloatArray

    @property
    def axis(self) -> DesignAxis:
        """Which axis."""
        return self.axes[self.number]

    @cached_property
    def profile(self) -> FloatArray:
        """(v, 2) user-space values of the axis, ascending, and the largest turn of any joint there.

        Even steps, and where joints turn most.
        """
        grid = np.array([self.axis.user(x) for x in grid_of(self.axis).tolist()])
        at = self.rows.locations[:, self.number]
        above = self.turns > np.interp(at, grid, self.on_grid)  # where its largest turn lies between the grid's values
        profile = np.column_stack([np.append(grid, at[above]), np.append(self.on_grid, self.turns[above])])
        return profile[np.argsort(profile[:, 0], kind="stable")]

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
        glyph, contour, joint, _, (_, turn, made, _, _), (x, y), location, (low, high) = (
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
        first, glyphs, rows = parts[0], list[tuple[str, int]](), []
        for part in parts:
            rows.append(part.rows._replace(glyphs=part.rows.glyphs + len(glyphs)))
            glyphs += part.glyphs
        every = Measured.joined(rows, len(first.axes))
        order = np.argsort(-every.numbers[:, 1], kind="stable")
        at_masters = [item for part in parts for item in part.at_masters]
        jumps, jumps_at = (np.concatenate(each) for each in zip(*((p.jumps, p.jumps_at) for p in parts), strict=True))
        return cls(
            first.axes, first.number, glyphs, every.chosen(order), [at_masters[k] for k in order], jumps[order],
            jumps_at[order], np.max([part.on_grid for part in parts], axis=0),
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
    source: VariableSource, glyphs: Iterable[str] | None = None, axis: str | None = None, *,
    corner_angle: float = CORNER_ANGLE,
) -> KinkReport:  # fmt: skip
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
    corner_angle: float, turns_only: bool = False,
) -> list[AxisKinks]:  # fmt: skip
    """The smooth joints of glyphs along the ``chosen`` of a font's axes, by their numbers.

    Args:
        glyphs: in all their masters. axes: of a font without glyphs; otherwise those of its glyphs count.
        location: user-space values of the other axes. turns_only: whether jumps of curvature, and turns at even values
            of an axis, are left out, as zeros.
    """
    none = np.zeros(0)
    parts = [
        [AxisKinks(axes, k, [], Measured.joined((), len(axes)), [], none, none, np.zeros(len(grid_of(axes[k]))))]
        for k in chosen
    ]
    each = iter(glyphs)
    while batch := list(islice(each, 64)):  # glyphs that are measured in one pass
        base = batch[0].normalised(location)
        joints = [_smooth_joints(masters, corner_angle) for masters in batch]
        for k, part in zip(chosen, parts, strict=True):
            part.append(_joints_along(batch, joints, k, base, turns_only))
    return [AxisKinks.joined(part[1:] or part) for part in parts]


def joint_turns(masters: Masters, kink: Kink, values: FloatArray) -> FloatArray:
    """(v,) the turn of a kink's joint, in degrees without sign, at (v,) user-space values of its axis."""
    axis = [axis.tag for axis in masters.axes].index(kink.axis)
    along = np.array([masters.axes[axis].normalised(float(value)) for value in values])
    at = along_from(masters.normalised(kink.location), axis, along)
    controls = joint_controls(masters.contours[kink.contour])[:, kink.joint]
    turns: FloatArray = np.abs(turns_of(np.tensordot(masters.weights_at(at), controls, axes=1)))
    return turns


@cache
def grid_of(axis: DesignAxis) -> FloatArray:
    """Normalised values of an axis, even in user space, with those where its mapping bends."""
    # Places along an axis, evenly in user space, at which the largest turn of all joints is kept.
    users = [*np.linspace(axis.minimum, axis.maximum, 97).tolist(), axis.default]
    low, high = axis.normalised(axis.minimum), axis.normalised(axis.maximum)
    bends = [after for _, after in axis.mapping if low <= after <= high]
    return np.unique([*(axis.normalised(value) for value in users), *bends])


class AlongAxis(NamedTuple):
    """Curvature of one glyph along one axis: how far smooth joints turn, and how much energy arcs have.

    Attributes:
        masters: the glyph. location: user-space values of the other axes. axis: which axis.
        found: its smooth joints. worst: the one that turns most along the axis; None if no joint is smooth.
        values: (v,) user-space values of the axis, ascending: even steps, and where joints turn most.
        turns: (v,) the largest turn of a smooth joint there, in degrees.
        energies: (v,) bending energy of the arcs there, in 1/em; infinite at a cusp.
    """

    masters: Masters
    location: Mapping[str, float]
    axis: DesignAxis
    found: AxisKinks
    worst: Kink | None
    values: FloatArray
    turns: FloatArray
    energies: FloatArray

    def instance(self, value: float) -> Outline:
        """The glyph at a user-space value of the axis."""
        return self.masters.instance({**self.location, self.axis.tag: value})


def along_axis(
    masters: Masters, tag: str, location: Mapping[str, float] | None = None, *, corner_angle: float = CORNER_ANGLE
) -> AlongAxis:
    """Measure a glyph along an axis. Nothing is fitted.

    Args:
        masters: the glyph. tag: of the axis. location: user-space values of the other axes; without it, their defaults.
        corner_angle: degrees of turn from which a joint is a corner.

    Raises:
        GlyphsplineError: there is no such axis.
    """
    from ...curves.integrals import integrals  # imports the compiler

    location = location or {}
    chosen = [k for k, axis in enumerate(masters.axes) if axis.tag == tag]
    if not chosen:
        raise GlyphsplineError(f"no axis {tag!r}", glyph=masters.name)
    (found,) = kinks_along([masters], masters.axes, location, chosen, corner_angle)
    values, turns = found.profile.T
    at = np.array([masters.normalised({**location, tag: float(value)}) for value in values])
    weights = masters.weights_at(at)
    energies = np.zeros(len(at))
    for contour in masters.contours:
        arcs = contour.cubics()[:, contour.degrees > 1]
        for k, cubics in enumerate(np.tensordot(weights, arcs, axes=1)):
            lasts = np.abs(cubics - cubics[:, :1]).max(axis=(1, 2)) > NO_HANDLE  # it may have a length elsewhere only
            energies[k] += integrals(cubics[lasts])[1]
    energies *= masters.metrics.units_per_em
    return AlongAxis(masters, location, found.axis, found, next(iter(found), None), values, turns, energies)


def places_along(along: AlongAxis, count: int) -> list[float]:
    """Values of the axis at which to look: its masters, where the glyph's worst joint turns most, and between.

    Args:
        along: of the source. count: of values; of more masters, some are left out evenly.

    Returns:
        User-space values, ascending.
    """
    worst = along.worst
    values = sorted({*along.found.positions, along.axis.minimum, along.axis.maximum})
    if worst is not None and worst.turn > 0:
        values = sorted({*values, worst.location[worst.axis]})
    if len(values) > count:
        return [values[round(k)] for k in np.linspace(0, len(values) - 1, count)]
    while 1 < len(values) < count:
        gaps = np.diff(values)
        k = int(gaps.argmax())
        if not gaps[k] > 0:
            break
        values.insert(k + 1, (values[k] + values[k + 1]) / 2)
    return values


def _smooth_joints(masters: Masters, corner_angle: float) -> tuple[FloatArray, IntArray]:
    """(K, J, 2, 4, 2) a glyph's smooth joints in each master, and (J, 2) contour and segment of each."""
    controls, places = [np.zeros((len(masters), 0, 2, 4, 2))], [np.zeros((0, 2), dtype=np.int64)]
    for number, contour in enumerate(masters.contours):
        controls.append(joint_controls(contour))
        places.append(np.stack([np.full(len(contour), number), np.arange(len(contour))], axis=1))
    every = np.concatenate(controls, axis=1)
    kept = (np.abs(turns_of(every)) < corner_angle).all(axis=0)  # false where there is no direction
    return every[:, kept], np.concatenate(places)[kept]


def _joints_along(
    glyphs: Sequence[Masters], smooth: Sequence[tuple[FloatArray, IntArray]], axis: int, base: FloatArray,
    turns_only: bool,
) -> AxisKinks:  # fmt: skip
    """The smooth joints of glyphs along an axis, unsorted; ``base``: their normalised location, but for the axis."""
    axes, users = glyphs[0].axes, glyphs[0].axes[axis].users
    ticks = [
        np.resize(values, max(len(values), 2)) for values in (glyph.ticks(axis) for glyph in glyphs)
    ]  # or no range
    ends = []  # (T, J, 2, 4, 2) the joints of each glyph at its ticks
    for glyph, (controls, _), values in zip(glyphs, smooth, ticks, strict=True):
        ends.append(np.tensordot(glyph.weights_at(along_from(base, axis, values)), controls, axes=1))
    counts = [len(values[1:]) * len(places) for values, (_, places) in zip(ticks, smooth, strict=True)]
    start, end = (
        np.concatenate([each[part].reshape(-1, 2, 4, 2) for each in ends]) for part in (np.s_[:-1], np.s_[1:])
    )
    em = np.repeat([glyph.metrics.units_per_em for glyph in glyphs], counts)
    largest_of_jumps = np.zeros((2, len(em))) if turns_only else largest_jumps(start, end, em)
    largest = np.split(np.stack([*largest_turns(start, end), *largest_of_jumps]), np.cumsum(counts)[:-1], axis=1)
    rows, at_masters, jumps = [], list[FloatArray](), [np.zeros((2, 0))]
    grid = grid_of(axes[axis])
    on_grid = np.zeros(len(grid))
    of_glyphs = zip(glyphs, ticks, ends, smooth, largest, strict=True)
    for g, (glyph, values, at_ticks, (_, places), found) in enumerate(of_glyphs):
        steps, joints = np.diff(values), np.arange(len(places))
        turn, way, jump, jump_way = found.reshape(4, len(steps), len(joints))
        k, i = turn.argmax(axis=0), jump.argmax(axis=0)  # the first interval of the largest
        turn, way, jump, jump_way = turn[k, joints], way[k, joints], jump[i, joints], jump_way[i, joints]
        at, first = values[k] + way * steps[k], at_ticks[k, joints, 0, 0]
        on = _masters_on(glyph, axis, along_from(base, axis, values))
        in_masters = np.abs(turns_of(at_ticks[on])).T
        at_masters += [np.stack([values[on], of_joint]) for of_joint in in_masters]
        location = np.tile([each.user(x) for each, x in zip(axes, base.tolist(), strict=True)], (len(joints), 1))
        location[:, axis] = users(at)
        made, none = np.maximum(turn - in_masters.max(axis=1), 0.0), np.zeros(len(joints))
        rows.append(Measured(
            np.full(len(joints), g), places[:, 0], places[:, 1], np.full(len(joints), KINK),
            np.column_stack([none, turn, made, none - 1.0, none + np.nan]),
            first + way[:, None] * (at_ticks[k + 1, joints, 0, 0] - first), location, users(_around(values[on], at)),
        ))  # fmt: skip
        jumps.append(np.stack([jump, users(values[i] + jump_way * steps[i])]))
        if turns_only:
            continue
        k = np.searchsorted(values, grid, side="right").clip(1, max(len(values) - 1, 1)) - 1
        way = ((grid - values[k]) / np.where(steps[k] > 0, steps[k], 1.0))[:, None, None, None, None]
        there = np.abs(turns_of((1 - way) * at_ticks[k] + way * at_ticks[k + 1]))
        on_grid = np.maximum(on_grid, np.nan_to_num(there).max(axis=1, initial=0.0))
    names = [(glyph.name, glyph.gid) for glyph in glyphs]
    largest_jump, jump_at = np.concatenate(jumps, axis=1)
    return AxisKinks(axes, axis, names, Measured.joined(rows), at_masters, largest_jump, jump_at, on_grid)


def along_from(base: FloatArray, axis: int, values: FloatArray) -> FloatArray:
    """(v, A) a normalised location with other values (v,) of an axis."""
    at = np.tile(base, (len(values), 1))
    at[:, axis] = values
    return at


def _masters_on(masters: Masters, axis: int, at: FloatArray) -> BoolArray:
    """Which locations along an axis are at a master: at the default, or at the peak of a region that acts there."""
    peaks = masters.regions[:, axis, 1]
    acts = (masters.scalars(at)[:, 1:] > 0) & (peaks != 0) & (at[:, axis, None] == peaks)
    found: BoolArray = acts.any(axis=1) | (at[:, axis] == 0)
    return found


def _around(masters: FloatArray, at: FloatArray) -> FloatArray:
    """(n, 2) the masters before and behind (n,) places; a place itself where there is none."""
    bounds = np.concatenate([[-np.inf], masters, [np.inf]])
    found = np.column_stack([bounds[np.searchsorted(bounds, at, "right") - 1], bounds[np.searchsorted(bounds, at)]])
    return np.where(np.isfinite(found), found, at[:, None])


def no_joints(axis: DesignAxis) -> AxisNumbers:
    """The numbers of no glyphs along an axis."""
    return AxisNumbers(axis.tag, 0, (axis.default,))


def kink_report(
    parts: Sequence[Sequence[AxisKinks]], glyphs: int, corner_angle: float, failed: Sequence[tuple[str, str]]
) -> KinkReport:
    """The joints of parts of a font's glyphs, along the same axes each, as one report."""
    found = tuple(AxisKinks.joined(along) for along in zip(*parts, strict=True))
    return KinkReport(found, glyphs, corner_angle, tuple(failed))
