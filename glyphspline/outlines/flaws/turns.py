"""How far joints turn, and curvature jumps there, between two ticks of an axis.

Ticks are the starts, peaks and ends of regions; between two of them control points are linear in the axis's value, and
so are the tangents on both sides of a joint. The sine and cosine of its turn, times the tangents' lengths, are then
quadratic polynomials, and the turn is stationary at the roots of another: its largest value is exact. The jump of
curvature is sampled, and its maximum is refined.

A joint is an array (…, 2, 4, 2): the control points from the joint on, of the segment that arrives, reversed, and of
the next; see :func:`joint_controls`.
"""

from __future__ import annotations

import numpy as np

from ...curves.bezier import AT_END, cross, roots_inside
from ...types import FloatArray
from ..masters import MasterContour

NO_HANDLE = 1e-6
"""Length in font units up to which a handle gives no tangent; the next control point then gives one."""

SAMPLES = 9
"""Places between two ticks where the jump of curvature is sampled first."""

GOLDEN, STEPS = 0.5 * (np.sqrt(5.0) - 1.0), 32
"""Steps of golden section from two samples' distance: to 1e-7 of it."""


def joint_controls(contour: MasterContour) -> FloatArray:
    """(K, m, 2, 4, 2) the control points from each joint on: of the segment that arrives, reversed, and of the next."""
    cubics = contour.cubics()
    return np.stack([np.roll(cubics, 1, axis=1)[:, :, ::-1], cubics], axis=2)


def turns_of(controls: FloatArray) -> FloatArray:
    """(…,) turn in degrees, positive to the left, of joints (…, 2, 4, 2); NaN where a side has no direction."""
    vectors = controls[..., 1:, :] - controls[..., :1, :]  # (…, 2, 3, 2) from the joint
    long = np.abs(vectors).sum(axis=-1) > NO_HANDLE
    chosen = np.take_along_axis(vectors, long.argmax(axis=-1)[..., None, None], axis=-2)[..., 0, :]
    turns = _angle(-chosen[..., 0, :], chosen[..., 1, :])
    turns[~long.any(axis=-1).all(axis=-1)] = np.nan
    return turns


def _angle(a: FloatArray, b: FloatArray) -> FloatArray:
    """(…,) degrees from vectors a to vectors b (…, 2), positive to the left."""
    return np.degrees(np.arctan2(cross(a, b), (a * b).sum(axis=-1)))


def jumps_of(controls: FloatArray, units_per_em: FloatArray) -> FloatArray:
    """(…,) relative jump of curvature of joints (…, 2, 4, 2); 0 where both sides are straight or lack a handle."""
    first, second = (controls[..., k, :] - controls[..., 0, :] for k in (1, 2))
    length = np.hypot(first[..., 0], first[..., 1])
    with np.errstate(divide="ignore", invalid="ignore"):
        curvature = 2 / 3 * cross(first, second) / length**3
        curvature[..., 0] *= -1  # the segment that arrives is reversed
        most = np.abs(curvature).max(axis=-1)
        jump = np.abs(curvature[..., 1] - curvature[..., 0]) / most
    # Curvature, in 1/em, up to which both sides of a joint are straight, and none jumps against the other.
    valid = (length > NO_HANDLE).all(axis=-1) & (most * units_per_em > 1e-3)
    return np.where(valid, jump, 0.0)


def largest_turns(start: FloatArray, end: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(N,) the largest turn of joints between two ticks, without sign, and at which share of the way.

    Args:
        start, end: (N, 2, 4, 2) control points at the ticks; they are linear between.
    """
    vectors = np.stack([start[..., 1:, :] - start[..., :1, :], end[..., 1:, :] - end[..., :1, :]])  # (2, N, 2, 3, 2)
    # A handle without length at one tick has it at no other.
    long = (np.abs(vectors).sum(axis=-1) > NO_HANDLE).any(axis=0)
    level = np.broadcast_to(long.argmax(axis=-1)[None, ..., None, None], (*vectors.shape[:3], 1, 1))
    chosen = np.take_along_axis(vectors, level, axis=-2)[..., 0, :]
    a, b = -chosen[0, :, 0], chosen[0, :, 1]
    da, db = -chosen[1, :, 0] - a, chosen[1, :, 1] - b
    sines = (cross(a, b), cross(a, db) + cross(da, b), cross(da, db))
    cosines = ((a * b).sum(-1), (a * db + da * b).sum(-1), (da * db).sum(-1))
    roots = roots_inside(
        sines[2] * cosines[1] - sines[1] * cosines[2],
        2 * (sines[2] * cosines[0] - sines[0] * cosines[2]),
        sines[1] * cosines[0] - sines[0] * cosines[1],
    )
    inner = np.broadcast_to([AT_END, 1 - AT_END], roots.shape)  # at a tick itself a handle may have no length
    shares = np.nan_to_num(np.concatenate([inner, roots], axis=1), nan=AT_END)
    s = shares[..., None]
    inside = np.abs(_angle(a[:, None] + s * da[:, None], b[:, None] + s * db[:, None]))
    at_ticks = np.abs(np.stack([turns_of(start), turns_of(end)], axis=1))
    turns = np.nan_to_num(np.concatenate([at_ticks, inside], axis=1), nan=0.0)
    ways = np.concatenate([np.zeros((len(a), 1)), np.ones((len(a), 1)), shares], axis=1)
    best = (turns + 1e-9 * (np.arange(6) < 2)).argmax(axis=1)[:, None]  # of two alike, the tick
    return np.take_along_axis(turns, best, axis=1)[:, 0], np.take_along_axis(ways, best, axis=1)[:, 0]


def largest_jumps(start: FloatArray, end: FloatArray, units_per_em: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(N,) the largest relative jump of curvature between two ticks, and at which share of the way.

    Sampled evenly; the largest sample is refined by golden section.

    Args:
        start, end: (N, 2, 4, 2) control points at the ticks; they are linear between. units_per_em: (N,).
    """
    ways, step = np.linspace(0.0, 1.0, SAMPLES), end - start
    values = np.stack([jumps_of(start + way * step, units_per_em) for way in ways], axis=1)
    best = values.argmax(axis=1)
    found, where = values.max(axis=1, initial=0.0), ways[best]
    low, high = ways[np.maximum(best - 1, 0)], ways[np.minimum(best + 1, SAMPLES - 1)]

    def jump(at: FloatArray) -> FloatArray:
        return jumps_of(start + at[:, None, None, None] * step, units_per_em)

    x0, x1 = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    f0, f1 = jump(x0), jump(x1)
    for _ in range(STEPS if found.any() else 0):
        left = f0 > f1
        low, high = np.where(left, low, x0), np.where(left, x1, high)
        fresh = np.where(left, high - GOLDEN * (high - low), low + GOLDEN * (high - low))
        value = jump(fresh)
        x0, x1 = np.where(left, fresh, x1), np.where(left, x0, fresh)
        f0, f1 = np.where(left, value, f1), np.where(left, f0, value)
    refined = np.maximum(f0, f1)
    better = refined > found + 1e-12
    return np.where(better, refined, found), np.where(better, np.where(f0 > f1, x0, x1), where)
