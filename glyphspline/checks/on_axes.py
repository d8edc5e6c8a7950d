"""Glyphs of a variable font checked at their masters and along each axis; each finding once, where it is worst.

Kinks are exact along an axis, :mod:`.axis_kinks`; everything else is measured at even steps of it. A joint that is a
corner in one master is meant as one: elsewhere it has no kinks, nor jumps of curvature.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from ..outlines.contour_arrays import ContourArrays, offsets_of
from ..outlines.masters import Masters
from ..types import FloatArray
from .axis_kinks import AxisKinks, Glyphs, joint_controls, kinks_along
from .axis_numbers import AxisNumbers
from .between_ticks import turns_of
from .columns import Measured
from .joints import rounding_turn
from .kinds import CROSSING, DIRECTION, DOUBLED, JUMP, KINK, OVERLAP, Thresholds
from .measured import measured

OF_CONTOURS = (OVERLAP, DIRECTION, DOUBLED, CROSSING)
"""Kinds that are told once a contour, wherever on it."""

ALIKE = 9
"""Decimals of values up to which two places are equally bad; the first is told then."""


class _Turn(NamedTuple):
    """A joint's turn at a place of the design space; see :class:`.axis_kinks.Kink`."""

    glyph: int
    contour: int
    joint: int
    turn: float
    made: float
    at: FloatArray
    between: tuple[float, float]


def on_axes(
    glyphs: Sequence[Masters], location: Mapping[str, float], tags: Sequence[str], steps: int, thresholds: Thresholds,
    outer: int = 0,
) -> tuple[Measured, list[tuple[AxisNumbers, ...]]]:  # fmt: skip
    """Measure glyphs of a variable font: each finding at its worst place, and each glyph's kinks in numbers.

    Args:
        glyphs: in all their masters. location: user-space values of the axes that are not looked along.
        tags: of the axes along which they are looked at. steps: of an axis. outer: see :attr:`.Source.outer`.

    Raises:
        GlyphsplineError: masters of a glyph cannot be told apart.
    """
    axes, em = glyphs[0].axes, glyphs[0].metrics.units_per_em
    chosen = [k for k, axis in enumerate(axes) if axis.tag in tags]
    places = [places_of(masters, location, chosen, steps) for masters in glyphs]
    instances = [item for masters, at in zip(glyphs, places, strict=True) for item in instances_of(masters, at)]
    rows = measured(instances, thresholds, em, outer)
    every = np.concatenate(places)
    owners = np.repeat(np.arange(len(glyphs)), [len(at) for at in places])
    rows = rows._replace(glyphs=owners[rows.glyphs], locations=every[rows.glyphs])
    along_axes = kinks_along(Glyphs(glyphs, location), None, chosen, thresholds.corner_angle)
    turns, smooth = _turns(glyphs, location, chosen, along_axes, thresholds)
    of_joints = np.column_stack([rows.glyphs, rows.contours, rows.segments])
    known = np.array([tuple(row) in smooth for row in of_joints.tolist()], dtype=np.bool_)
    rows = rows.chosen(np.flatnonzero((rows.kinds != KINK) & ((rows.kinds != JUMP) | known)))
    worst = _worst(_with_turns(rows, glyphs, turns))
    users = [[axis.user(x) for axis, x in zip(axes, at, strict=True)] for at in worst.locations.tolist()]
    numbers = [tuple(along.numbers_of(g) for along in along_axes) for g in range(len(glyphs))]
    return worst._replace(locations=np.array(users).reshape(-1, len(axes))), numbers


def places_of(masters: Masters, location: Mapping[str, float], axes: Sequence[int], steps: int) -> FloatArray:
    """(V, A) normalised: the location, the masters that differ from it on the axes only, and steps of each axis.

    A glyph that does not change along an axis is not looked at along it.
    """
    base = masters.normalised(location)
    others = np.delete(np.arange(len(base)), axes)
    places = [base[None], masters.peaks[(masters.peaks[:, others] == base[others]).all(axis=1)]]
    for a in axes:
        if (masters.regions[:, a, 1] != 0).any():
            axis = masters.axes[a]
            along = np.tile(base, (steps + 1, 1))
            along[:, a] = [axis.normalised(float(x)) for x in np.linspace(axis.minimum, axis.maximum, steps + 1)]
            places.append(along)
    every = np.concatenate(places)
    _, first = np.unique(every, axis=0, return_index=True)
    found: FloatArray = every[np.sort(first)]
    return found


def instances_of(masters: Masters, at: FloatArray) -> list[ContourArrays]:
    """The glyph at normalised places (V, A)."""
    contours, weights = masters.contours, masters.weights_at(at)
    every = np.concatenate([np.empty((len(masters), 0, 2)), *(contour.points for contour in contours)], axis=1)
    degrees = np.concatenate([np.empty(0, dtype=np.int64), *(contour.degrees for contour in contours)])
    offsets = offsets_of([len(contour.degrees) for contour in contours])
    starts = offsets_of([contour.points.shape[1] for contour in contours])
    return [ContourArrays(points, degrees, offsets, starts) for points in np.tensordot(weights, every, axes=1)]


def _turns(
    glyphs: Sequence[Masters], location: Mapping[str, float], axes: Sequence[int], along_axes: Sequence[AxisKinks],
    thresholds: Thresholds,
) -> tuple[list[_Turn], set[tuple[int, int, int]]]:  # fmt: skip
    """Turns of smooth joints that count, along axes and in masters off them; and which joints are smooth."""
    found, smooth = list[_Turn](), set[tuple[int, int, int]]()
    controls = [[joint_controls(contour) for contour in masters.contours] for masters in glyphs]
    for along in along_axes:
        smooth.update(map(tuple, along.joints.tolist()))
        count = int((along.turns >= thresholds.kink).sum())
        for kink, (g, contour, joint) in zip(along[:count], along.joints[:count].tolist(), strict=True):
            at = glyphs[g].normalised(kink.location)
            found.append(_Turn(g, contour, joint, kink.turn, kink.made, at, kink.between))
    for g, masters in enumerate(glyphs):
        base, peaks = masters.normalised(location), masters.peaks
        others = np.delete(np.arange(len(base)), axes)
        off = np.flatnonzero(((peaks != base).sum(axis=1) > 1) & (peaks[:, others] == base[others]).all(axis=1))
        if not len(off):
            continue
        for contour, of_contour in enumerate(controls[g]):
            turns = np.abs(turns_of(of_contour[off]))
            for k, joint in np.argwhere(turns >= thresholds.kink).tolist():
                if (g, contour, joint) in smooth:
                    found.append(_Turn(g, contour, joint, turns[k, joint], 0.0, peaks[off[k]], (np.nan, np.nan)))
    counted = [
        turn
        for turn in found
        if turn.turn >= by_rounding(glyphs[turn.glyph], turn, controls[turn.glyph][turn.contour][:, turn.joint])
        and not (turn.turn - turn.made >= thresholds.line_angle and is_of_lines(glyphs[turn.glyph], turn))
    ]
    return counted, smooth


def is_of_lines(masters: Masters, turn: _Turn) -> bool:
    """Whether two lines meet at the joint."""
    degrees = masters.contours[turn.contour].degrees
    return bool(degrees[turn.joint - 1] == degrees[turn.joint] == 1)


def by_rounding(masters: Masters, turn: _Turn, controls: FloatArray) -> float:
    """Degrees by which rounding may turn a joint: see :func:`.joints.rounding_turn`.

    It is 0 where the default master is not in whole units.

    Deltas are whole too. Those of points between others are not, but no farther off.

    Args:
        controls: (K, 2, 4, 2) of the joint; see :func:`.axis_kinks.joint_controls`.
    """
    degrees = masters.contours[turn.contour].degrees[[turn.joint - 1, turn.joint]]
    handles = 3 / degrees[:, None] * (controls[0, :, 1] - controls[0, :, 0])  # segments are raised to cubics
    if np.abs(handles - np.rint(handles)).max() > 1e-6:
        return 0.0
    here = np.tensordot(masters.weights_at(turn.at), controls, axes=1)
    before, behind = 3 / degrees * np.hypot(*(here[:, 1] - here[:, 0]).T)
    return float(np.degrees(rounding_turn(before, behind)))


def _with_turns(rows: Measured, glyphs: Sequence[Masters], turns: Sequence[_Turn]) -> Measured:
    """Kinks before all other rows, whose locations are normalised."""
    if not turns:
        return rows
    points = []
    for turn in turns:
        masters = glyphs[turn.glyph]
        contour = masters.contours[turn.contour]
        start = int(contour.degrees[: turn.joint].sum())
        points.append(masters.weights_at(turn.at) @ contour.points[:, start])
    places = np.array([turn[:3] for turn in turns], dtype=np.int64)
    own = Measured(
        places[:, 0], places[:, 1], places[:, 2], np.full(len(turns), KINK),
        np.array([(0.0, turn.turn, turn.made, -1.0) for turn in turns]),
        np.array(points), np.array([turn.at for turn in turns]), np.array([turn.between for turn in turns]),
    )  # fmt: skip
    return Measured._make([np.concatenate(pair) for pair in zip(own, rows, strict=True)])


def _worst(rows: Measured) -> Measured:
    """Of each finding the row with the largest value; those of a kind together, the largest value first."""
    segments = np.where(np.isin(rows.kinds, OF_CONTOURS), 0, rows.segments)
    keys = np.column_stack([rows.glyphs, rows.kinds, rows.contours, segments, rows.numbers[:, 3].astype(np.int64)])
    order = np.lexsort((-rows.numbers[:, 1].round(ALIKE), *keys.T[::-1]))  # stable: of equals, the first
    _, first = np.unique(keys[order], axis=0, return_index=True)
    kept = rows.chosen(order[first])
    return kept.chosen(np.lexsort((-kept.numbers[:, 1], kept.kinds)))
