"""Glyphs of a variable font checked at their masters and along each axis; each finding once, where it is worst.

Kinks are exact along an axis, :mod:`.kinks`; everything else is measured at even steps of it. A joint that is a
corner in one master is meant as one: elsewhere it has no kinks, nor jumps of curvature.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ...outlines.contour_arrays import end_to_end
from ...outlines.flaws.joints import arc, rounding_turns
from ...outlines.flaws.kinds import COVERED, CROSSING, DIRECTION, DOUBLED, JUMP, KINK, OVERLAP, TURN, Thresholds
from ...outlines.flaws.turns import joint_controls, turns_of
from ...outlines.masters import Masters
from ...outlines.outline import Contours
from ...types import FloatArray, IntArray
from ..checks.check import measured
from ..checks.finding import Measured
from .kinks import AxisKinks, along_from, kinks_along

OF_CONTOURS = (OVERLAP, DIRECTION, COVERED, DOUBLED, CROSSING)
"""Kinds that are reported once a contour."""

OF_SMOOTH = (JUMP, TURN)
"""Kinds that a joint has only if it is a corner in no master."""

NEAR = 1e-4
"""How far a handle in whole units may be from them: CFF2 stores what a raised quadratic has in 65536ths. With less,
such outlines have kinks that those of ``glyf`` have not."""


def on_axes(
    glyphs: Sequence[Masters], location: Mapping[str, float], tags: Sequence[str], steps: int, thresholds: Thresholds,
    outer: int = 0, turns_only: bool = False, heights: Sequence[float] = (),
) -> tuple[Measured, list[AxisKinks]]:  # fmt: skip
    """Measure glyphs of a variable font: each finding at its worst place, and all smooth joints along each axis.

    Args:
        glyphs: in all their masters. location: user-space values of the axes that are not looked along.
        tags: of the axes along which they are looked at. steps: of an axis. outer: see :attr:`.Source.outer`.
        turns_only: what of joints along axes is left out, see :func:`.kinks_along`. heights: see :func:`.check`.

    Raises:
        GlyphsplineError: masters of a glyph cannot be distinguished.
    """
    axes, em = glyphs[0].axes, glyphs[0].metrics.units_per_em
    chosen = [k for k, axis in enumerate(axes) if axis.tag in tags]
    places = [places_of(masters, location, chosen, steps) for masters in glyphs]
    instances = [item for masters, at in zip(glyphs, places, strict=True) for item in instances_of(masters, at)]
    rows = measured(instances, thresholds, em, outer, heights)
    every = np.concatenate(places)
    owners = np.repeat(np.arange(len(glyphs)), [len(at) for at in places])
    rows = rows._replace(glyphs=owners[rows.glyphs], locations=every[rows.glyphs])
    along_axes = kinks_along(glyphs, axes, location, chosen, thresholds.corner_angle, turns_only=turns_only)
    smooth = smooth_joints(along_axes)
    kinks = kinks_of(glyphs, location, chosen, along_axes, thresholds)
    joints = zip(rows.glyphs.tolist(), rows.contours.tolist(), rows.segments.tolist(), strict=True)
    known = np.array([joint in smooth for joint in joints], dtype=np.bool_)
    rows = rows.chosen(np.flatnonzero((rows.kinds != KINK) & (~np.isin(rows.kinds, OF_SMOOTH) | known)))
    worst = _worst(Measured.joined([kinks, rows]))
    users = [[axis.user(x) for axis, x in zip(axes, at, strict=True)] for at in worst.locations.tolist()]
    return worst._replace(locations=np.array(users).reshape(-1, len(axes))), along_axes


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
            along = [axis.normalised(float(x)) for x in np.linspace(axis.minimum, axis.maximum, steps + 1)]
            places.append(along_from(base, a, np.array(along)))
    every = np.concatenate(places)
    _, first = np.unique(every, axis=0, return_index=True)
    found: FloatArray = every[np.sort(first)]
    return found


def instances_of(masters: Masters, at: FloatArray) -> list[Contours]:
    """The glyph at normalised places (V, A); the first has all points that the masters have more than once."""
    every = end_to_end([(contour.points, contour.degrees) for contour in masters.contours])
    instances = np.tensordot(masters.weights_at(at), every.points.reshape(len(masters), -1, 2), axes=1)
    return [Contours(every._replace(points=p), None if k else masters.repeats) for k, p in enumerate(instances)]


def smooth_joints(along_axes: Sequence[AxisKinks]) -> set[tuple[int, int, int]]:
    """Glyph, contour and segment of the joints that are a corner in no master."""
    return {(g, contour, joint) for along in along_axes for g, contour, joint in along.joints.tolist()}


def kinks_of(
    glyphs: Sequence[Masters], location: Mapping[str, float], axes: Sequence[int], along_axes: Sequence[AxisKinks],
    thresholds: Thresholds,
) -> Measured:  # fmt: skip
    """Kinks along axes and in masters off them, at normalised locations; none that rounding or a chamfer explains."""
    parts, smooth = [], smooth_joints(along_axes)
    for along in along_axes:
        rows = along.rows.chosen(np.flatnonzero(along.turns >= thresholds.kink))
        at = [[axis.normalised(x) for axis, x in zip(along.axes, at, strict=True)] for at in rows.locations.tolist()]
        parts.append(rows._replace(locations=np.array(at).reshape(rows.locations.shape)))
    parts += [_off_axes(g, masters, location, axes, thresholds.kink) for g, masters in enumerate(glyphs)]
    rows = Measured.joined(parts)
    height = thresholds.kink_height * glyphs[0].metrics.units_per_em / 1000
    kept = np.zeros(len(rows.glyphs), dtype=np.bool_)
    for g, contour in sorted({*zip(rows.glyphs.tolist(), rows.contours.tolist(), strict=True)}):
        own = np.flatnonzero((rows.glyphs == g) & (rows.contours == contour))
        of_contour, joints = glyphs[g].contours[contour], rows.segments[own]
        degrees = np.stack([of_contour.degrees[joints - 1], of_contour.degrees[joints]], axis=1)
        turns, made = rows.numbers[own, 1], rows.numbers[own, 2]
        meant = (degrees == 1).all(axis=1) & (turns - made >= thresholds.kink)
        controls = joint_controls(of_contour)[:, joints]
        weights = glyphs[g].weights_at(rows.locations[own][:, None])  # (n, 1, K)
        here = (weights @ np.swapaxes(controls, 0, 1).reshape(len(own), -1, 16)).reshape(-1, 2, 4, 2)
        rounded = thresholds.rounding * by_rounding(controls[0], here, degrees)
        arms = np.array([min(map(arc, points)) for points in here.view(np.complex128)[..., 0]])
        rows.numbers[own, 4] = turns / thresholds.corner_angle * arms
        known = np.array([(g, contour, joint) in smooth for joint in joints.tolist()])
        kept[own] = known & (turns >= rounded) & (np.radians(turns) * arms >= height) & ~meant
    return rows.chosen(np.flatnonzero(kept))


def _off_axes(g: int, masters: Masters, location: Mapping[str, float], axes: Sequence[int], least: float) -> Measured:
    """Joints of a glyph that turn by ``least`` degrees in a master that leaves the location along several axes."""
    base, peaks = masters.normalised(location), masters.peaks
    others = np.delete(np.arange(len(base)), axes)
    off = np.flatnonzero(((peaks != base).sum(axis=1) > 1) & (peaks[:, others] == base[others]).all(axis=1))
    parts = []
    for number, contour in enumerate(masters.contours if len(off) else ()):
        turns = np.abs(turns_of(joint_controls(contour)[off]))
        k, joints = np.nonzero(turns >= least)
        n, starts = len(k), np.cumsum(contour.degrees) - contour.degrees
        numbers = np.column_stack([np.zeros(n), turns[k, joints], np.zeros(n), np.full(n, -1.0), np.full(n, np.nan)])
        parts.append(Measured(
            np.full(n, g), np.full(n, number), joints, np.full(n, KINK), numbers,
            contour.points[off[k], starts[joints]], peaks[off[k]], np.full((n, 2), np.nan),
        ))  # fmt: skip
    return Measured.joined(parts, len(base))


def by_rounding(default: FloatArray, here: FloatArray, degrees: IntArray) -> FloatArray:
    """(n,) standard deviations in degrees of joints that rounding turns, see :func:`.joints.rounding_turn`.

    It is 0 where the default master is not in whole units. Deltas are whole too. Those of points between others are
    not, but no farther off. A cubic may be a quadratic in whole units that was raised, as CFF2 has those of ``glyf``.

    Args:
        default, here: (n, 2, 4, 2) in the default master and where they are looked at, of
            :func:`.turns.joint_controls`. degrees: (n, 2) of the segments before and behind.
    """
    handles = default[:, :, 1] - default[:, :, 0]
    shares = np.where((degrees == 3) & (off_grid(handles) > NEAR), 1.5, 3 / degrees)  # segments are raised to cubics
    arms = here[:, :, 1] - here[:, :, 0]
    turns = np.degrees(rounding_turns(*(shares * np.hypot(arms[..., 0], arms[..., 1])).T))
    return np.where((off_grid(shares[..., None] * handles) > NEAR).any(axis=1), 0.0, turns)


def off_grid(handles: FloatArray) -> FloatArray:
    """(…,) how far handles (…, 2) are from whole units."""
    return np.asarray(np.abs(handles - np.rint(handles)).max(axis=-1))


def _worst(rows: Measured) -> Measured:
    """Of each finding the row with the largest value; those of a kind together, the largest value first."""
    segments = np.where(np.isin(rows.kinds, OF_CONTOURS), 0, rows.segments)
    keys = np.column_stack([rows.glyphs, rows.kinds, rows.contours, segments, rows.numbers[:, 3].astype(np.int64)])
    # Decimals of values up to which two places are equally bad; then the first is reported.
    order = np.lexsort((-rows.numbers[:, 1].round(9), *keys.T[::-1]))  # stable: of equals, the first
    _, first = np.unique(keys[order], axis=0, return_index=True)
    kept = rows.chosen(order[first])
    return kept.chosen(np.lexsort((-kept.numbers[:, 1], kept.kinds)))
