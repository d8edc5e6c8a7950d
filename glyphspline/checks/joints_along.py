"""How far joints turn, and curvature jumps there, along an axis: from tick to tick.

Ticks are the starts, peaks and ends of regions; between two of them control points are linear in the axis's value, and
so are the tangents on both sides of a joint. The sine and cosine of its turn, times the tangents' lengths, are then
quadratic polynomials, and the turn is stationary at the roots of another: its largest value is exact. The jump of
curvature is sampled, and its maxima are refined.

A joint is an array (…, 2, 4, 2): the control points from the joint on, of the segment that arrives, reversed, and of
the next; see :func:`joint_controls`.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..outlines.masters import DesignAxis, MasterContour, Masters
from ..types import BoolArray, FloatArray, IntArray
from .finding import Measured
from .kinds import KINK

PROFILE = 96
"""Intervals of an axis, in user space, at whose ends the largest turn of all joints is kept."""

LEAST = 1e-6
"""Length in font units up to which a tangent has no direction; the next control point then gives one."""

STRAIGHT = 1e-3
"""Curvature, in 1/em, up to which both sides of a joint are straight, and none jumps against the other."""

INSIDE = 1e-9
"""Share of an interval that separates its inside from a tick, where a handle may have no length."""

SAMPLES = 9
"""Places between two ticks where the jump of curvature is sampled first."""

GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)
STEPS = 32
"""Steps of golden section from two samples' distance: to 1e-7 of it."""


def turns_of(controls: FloatArray) -> FloatArray:
    """(…,) turn in degrees, positive to the left, of joints (…, 2, 4, 2); NaN where a side has no direction."""
    vectors = controls[..., 1:, :] - controls[..., :1, :]  # (…, 2, 3, 2) from the joint
    long = np.abs(vectors).sum(axis=-1) > LEAST
    first = long.argmax(axis=-1)
    chosen = np.take_along_axis(vectors, first[..., None, None], axis=-2)[..., 0, :]
    turns = _angle(-chosen[..., 0, :], chosen[..., 1, :])
    turns[~long.any(axis=-1).all(axis=-1)] = np.nan
    return turns


def _angle(a: FloatArray, b: FloatArray) -> FloatArray:
    """(…,) degrees from vectors a to vectors b (…, 2), positive to the left."""
    return np.degrees(np.arctan2(_cross(a, b), (a * b).sum(axis=-1)))


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def jumps_of(controls: FloatArray, units_per_em: FloatArray) -> FloatArray:
    """(…,) relative jump of curvature of joints (…, 2, 4, 2); 0 where both sides are straight or lack a handle."""
    first, second = (controls[..., k, :] - controls[..., 0, :] for k in (1, 2))
    length = np.hypot(first[..., 0], first[..., 1])
    with np.errstate(divide="ignore", invalid="ignore"):
        curvature = 2 / 3 * _cross(first, second) / length**3
        curvature[..., 0] *= -1  # the segment that arrives is reversed
        most = np.abs(curvature).max(axis=-1)
        jump = np.abs(curvature[..., 1] - curvature[..., 0]) / most
    valid = (length > LEAST).all(axis=-1) & (most * units_per_em > STRAIGHT)
    return np.where(valid, jump, 0.0)


def largest_turns(start: FloatArray, end: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(N,) the largest turn of joints between two ticks, without sign, and at which share of the way.

    Args:
        start, end: (N, 2, 4, 2) control points at the ticks; they are linear between.
    """
    vectors = np.stack([start[..., 1:, :] - start[..., :1, :], end[..., 1:, :] - end[..., :1, :]])  # (2, N, 2, 3, 2)
    long = (np.abs(vectors).sum(axis=-1) > LEAST).any(axis=0)  # a handle without length at one tick has it at no other
    level = np.broadcast_to(long.argmax(axis=-1)[None, ..., None, None], (*vectors.shape[:3], 1, 1))
    chosen = np.take_along_axis(vectors, level, axis=-2)[..., 0, :]
    a, b = -chosen[0, :, 0], chosen[0, :, 1]
    da, db = -chosen[1, :, 0] - a, chosen[1, :, 1] - b
    sines = (_cross(a, b), _cross(a, db) + _cross(da, b), _cross(da, db))
    cosines = ((a * b).sum(-1), (a * db + da * b).sum(-1), (da * db).sum(-1))
    shares = np.full((len(a), 4), INSIDE)
    shares[:, 1] = 1 - INSIDE
    shares[:, 2], shares[:, 3] = _roots(
        sines[2] * cosines[1] - sines[1] * cosines[2],
        sines[2] * cosines[0] - sines[0] * cosines[2],
        sines[1] * cosines[0] - sines[0] * cosines[1],
    )
    shares = np.where((shares > INSIDE) & (shares < 1 - INSIDE), shares, shares.clip(INSIDE, 1 - INSIDE))
    shares = np.nan_to_num(shares, nan=INSIDE)
    s = shares[..., None]
    inside = np.abs(_angle(a[:, None] + s * da[:, None], b[:, None] + s * db[:, None]))
    at_ticks = np.abs(np.stack([turns_of(start), turns_of(end)], axis=1))
    turns = np.nan_to_num(np.concatenate([at_ticks + 1e-9, inside], axis=1), nan=0.0)  # of two alike, the tick
    best = turns.argmax(axis=1)[:, None]
    ways = np.concatenate([np.zeros((len(a), 1)), np.ones((len(a), 1)), shares], axis=1)
    values = np.nan_to_num(np.concatenate([at_ticks, inside], axis=1), nan=0.0)
    return np.take_along_axis(values, best, axis=1)[:, 0], np.take_along_axis(ways, best, axis=1)[:, 0]


def _roots(a: FloatArray, half: FloatArray, c: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(N,) the roots of a s² + 2 half s + c; NaN or infinite where there are none."""
    with np.errstate(divide="ignore", invalid="ignore"):
        q = -(half + np.copysign(np.sqrt(half * half - a * c), half))
        return q / a, c / q


def largest_jumps(start: FloatArray, end: FloatArray, units_per_em: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(N,) the largest relative jump of curvature between two ticks, and at which share of the way.

    Sampled evenly; each local maximum of the samples is refined by golden section.

    Args:
        start, end: (N, 2, 4, 2) control points at the ticks; they are linear between. units_per_em: (N,).
    """
    ways = np.linspace(0.0, 1.0, SAMPLES)
    step = end - start
    values = np.stack([jumps_of(start + way * step, units_per_em) for way in ways], axis=1)
    padded = np.pad(values, ((0, 0), (1, 1)), constant_values=-1.0)
    peaks = (values >= padded[:, :-2]) & (values > padded[:, 2:]) & (values > 0)
    rows, columns = np.nonzero(peaks)
    low, high = ways[np.maximum(columns - 1, 0)], ways[np.minimum(columns + 1, SAMPLES - 1)]
    first, moves, em = start[rows], step[rows], units_per_em[rows]

    def jump(at: FloatArray) -> FloatArray:
        return jumps_of(first + at[:, None, None, None] * moves, em)

    x0, x1 = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    f0, f1 = jump(x0), jump(x1)
    for _ in range(STEPS if len(rows) else 0):
        left = f0 > f1
        low, high = np.where(left, low, x0), np.where(left, x1, high)
        fresh = np.where(left, high - GOLDEN * (high - low), low + GOLDEN * (high - low))
        value = jump(fresh)
        x0, x1 = np.where(left, fresh, x1), np.where(left, x0, fresh)
        f0, f1 = np.where(left, value, f1), np.where(left, f0, value)
    best_sample = values.argmax(axis=1)
    best, where = values.max(axis=1), ways[best_sample]
    order = np.argsort(np.maximum(f0, f1), kind="stable")  # the largest is written last
    rows, refined, at = rows[order], np.maximum(f0, f1)[order], np.where(f0 > f1, x0, x1)[order]
    better = refined > best[rows] + 1e-12
    best[rows[better]], where[rows[better]] = refined[better], at[better]
    return best, where


def joint_controls(contour: MasterContour) -> FloatArray:
    """(K, m, 2, 4, 2) the control points from each joint on: of the segment that arrives, reversed, and of the next."""
    cubics = contour.cubics()
    return np.stack([np.roll(cubics, 1, axis=1)[:, :, ::-1], cubics], axis=2)


class Joints:
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


def joints_along(
    glyphs: Sequence[Joints], axis: int, base: FloatArray
) -> tuple[Measured, list[FloatArray], FloatArray, FloatArray, list[FloatArray]]:
    """The joints of glyphs along an axis, all at once; ``base`` is their normalised location, but for the axis.

    Returns:
        Rows, masters on the axis, jumps and their places, as in :class:`.kinks.AxisKinks`; and of each glyph the
        largest turn of any joint at each value of :func:`grid_of` the axis.
    """
    axes = glyphs[0].masters.axes
    ticks = [glyph.masters.ticks(axis) for glyph in glyphs]
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
    at, jumps_at = (
        low[row] + turn_ways[row] * (high - low)[row],
        low[jump_row] + jump_ways[jump_row] * (high - low)[jump_row],
    )
    owners, user = np.repeat(np.arange(len(glyphs)), joints), axes[axis].user
    at_masters: list[FloatArray] = []
    between = np.empty((len(row), 2))
    grid = grid_of(axes[axis])
    largest: list[FloatArray] = []
    for g, (glyph, values, at_ticks) in enumerate(zip(glyphs, ticks, ends, strict=True)):
        on = masters_on(glyph.masters, axis, base, values)
        at_masters += [np.stack([values[on], of_joint]) for of_joint in np.abs(turns_of(at_ticks[on])).T]
        between[owners == g] = _around(values[on], at[owners == g])
        k = np.searchsorted(values, grid, side="right").clip(1, max(len(values) - 1, 1)) - 1
        way = ((grid - values[k]) / (values[k + 1] - values[k]))[:, None, None, None, None]
        on_grid = np.abs(turns_of((1 - way) * at_ticks[k] + way * at_ticks[k + 1]))
        largest.append(np.nan_to_num(on_grid).max(axis=1, initial=0.0))
    made = np.maximum(turns[row] - [of_joint.max() for _, of_joint in at_masters], 0.0)
    locations = np.tile([of_font.user(x) for of_font, x in zip(axes, base.tolist(), strict=True)], (len(row), 1))
    locations[:, axis] = [user(x) for x in at.tolist()]
    contours, segments = np.concatenate([glyph.places for glyph in glyphs]).T
    rows = Measured(
        owners, contours, segments, np.full(len(row), KINK),
        np.column_stack([np.zeros(len(row)), turns[row], made, np.full(len(row), -1.0)]),
        start[row, 0, 0] + turn_ways[row, None] * (end - start)[row, 0, 0], locations,
        np.array([user(x) for x in between.ravel().tolist()]).reshape(-1, 2),
    )  # fmt: skip
    return rows, at_masters, jumps[jump_row], np.array([user(x) for x in jumps_at.tolist()]), largest


def _around(masters: FloatArray, at: FloatArray) -> FloatArray:
    """(n, 2) the masters before and behind (n,) places; a place itself where there is none."""
    bounds = np.concatenate([[-np.inf], masters, [np.inf]])
    found = np.column_stack([bounds[np.searchsorted(bounds, at, "right") - 1], bounds[np.searchsorted(bounds, at)]])
    return np.where(np.isfinite(found), found, at[:, None])


def _first_largest(values: FloatArray, counts: IntArray) -> IntArray:
    """Index of the first largest value of each group of neighbours."""
    if not len(counts):
        return counts
    starts = np.cumsum(counts) - counts
    owners = np.repeat(np.arange(len(counts)), counts)
    hits = np.flatnonzero(values == np.maximum.reduceat(values, starts)[owners])
    return hits[np.searchsorted(owners[hits], np.arange(len(counts)))]
