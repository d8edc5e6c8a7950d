"""Curvature along Bézier pieces, as data for combs: points, normals, curvature, and a shared scale."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ..types import BoolArray, FloatArray, IntArray
from .bezier import as_cubic, cross

BEND, REACH, LEAST = np.radians(45), 1 / 40, 1 / 20
"""A bowl turns by less than ``BEND`` within ``REACH`` em on both sides, and has a radius of ``LEAST`` em or more. Round
dots are none, and counters of e and a of text faces are."""

ANGLE = np.radians(15)
"""Default turn between samples. A larger value shows straight lines between the tips of a rounded corner."""


@dataclass(frozen=True, eq=False)
class Comb:
    """Samples of one contour in curve order, both ends of every piece included.

    Attributes:
        points: (k, 2) on the curve.
        normals: (k, 2) unit vectors to the left of the direction of travel; zero on a piece without extent.
        curvature: (k,) signed, in 1/unit; positive turns left. Always finite.
        weights: (k,) arc length that each sample represents; their sum is the length of the curve.
        pieces: (m + 1,) samples ``pieces[j]`` up to ``pieces[j + 1]`` belong to piece j.
    """

    points: FloatArray
    normals: FloatArray
    curvature: FloatArray
    weights: FloatArray
    pieces: IntArray


def comb(pieces: FloatArray, spacing: float, *, angle: float = ANGLE) -> Comb:
    """Sample Bézier pieces evenly by arc length, and closer where they turn sharply.

    Args:
        pieces: (m, degree + 1, 2) of degree 1 to 3.
        spacing: the largest distance of samples along the curve.
        angle: the largest turn, in radians, from one sample to the next.

    Raises:
        ValueError: ``spacing`` or ``angle`` is not positive, or the degree is higher.
    """
    if not (spacing > 0 and angle > 0):
        raise ValueError(f"spacing and angle are positive, not {spacing!r} and {angle!r}")
    from .comb import sampled  # imports the compiler, which opening the package does not need

    if pieces.shape[1] > 4:
        raise ValueError(f"pieces are of degree 1 to 3, not {pieces.shape[1] - 1}")
    # as_cubic raises the degree along the first axis; pieces and coordinates together are the second.
    cubics = as_cubic(np.moveaxis(pieces, 1, 0).reshape(pieces.shape[1], -1)).reshape(4, -1, 2)
    samples, starts = sampled(
        np.ascontiguousarray(cubics.swapaxes(0, 1), dtype=float), float(spacing), float(angle), 0.0
    )
    return Comb(samples[:, :2], samples[:, 2:4], samples[:, 4], samples[:, 5], starts)


def robust_scale(combs: Iterable[Comb], percentile: float = 80.0) -> float:
    """A curvature, in 1/unit, that represents many combs; teeth and colours are relative to it.

    It is the percentile of |κ| over the arc length of all that is not straight; zero if nothing is curved. Weights by
    length make it independent of the spacing, and short sharp places do not set it. Without the straight lines, fonts
    with and without long stems have similar scales.
    """
    magnitudes, weights = [np.empty(0)], [np.empty(0)]
    for item in combs:
        size = float(np.ptp(item.points, axis=0).max()) if len(item.points) else 0.0
        magnitude = np.abs(item.curvature)
        # Curvature times size below which the scale ignores a sample as straight; a larger value drops flat curves.
        curved = magnitude * size > 1e-9
        magnitudes.append(magnitude[curved])
        weights.append(item.weights[curved])
    values, lengths = np.concatenate(magnitudes), np.concatenate(weights)
    if not lengths.sum() > 0:
        return 0.0
    order = np.argsort(values, kind="stable")
    covered = np.cumsum(lengths[order])
    index = np.searchsorted(covered, percentile / 100 * covered[-1])
    return float(values[order][min(int(index), len(order) - 1)])


def shared_scale(combs: Iterable[Comb], em: float) -> float:
    """The scale, in 1/unit, of maps: :func:`robust_scale`, or half the largest curvature of a bowl if that is more.

    So no tooth of a bowl is cut, only those near corners and in tight turns.
    """
    every = list(combs)
    found = robust_scale(every)
    # Curvature of the sharpest bowl in units of the scale. At 1, other bowls of brush faces have hardly any teeth.
    largest = 2.0 * found
    for item in every if found else ():  # of lines, curvature is rounding
        bent = np.abs(item.curvature)
        if ((bent > largest) & (bent * em * LEAST <= 1)).any():
            largest = float(bent[bowls(item, em)].max(initial=largest))
    return largest / 2.0


def bowls(item: Comb, em: float) -> BoolArray:
    """(k,) which samples of a closed contour lie on bowls: see :data:`BEND`. Corners count as turns."""
    after = np.roll(item.normals, -1, axis=0)
    turns = np.abs(np.arctan2(cross(item.normals, after), (item.normals * after).sum(axis=1)))
    steps = np.hypot(*(np.roll(item.points, -1, axis=0) - item.points).T)
    ends = [np.concatenate([[0.0], np.cumsum(values)]) for values in (steps, turns)]
    if not ends[0][-1] > 0:
        return np.zeros(len(turns), dtype=np.bool_)
    at, turned = (np.concatenate([own[:-1] - own[-1], own[:-1], own + own[-1]]) for own in ends)
    here, reach = ends[0][:-1], min(REACH * em, ends[0][-1] / 2)
    bend = np.interp(here + reach, at, turned) - np.interp(here - reach, at, turned)
    return (bend < BEND) & (np.abs(item.curvature) * em * LEAST <= 1)


def relative(curvature: FloatArray, scale: float) -> FloatArray:
    """Curvature in units of the scale, for colours and tooth lengths; zero if the scale is zero."""
    return curvature / scale if scale > 0 else np.zeros_like(curvature)
