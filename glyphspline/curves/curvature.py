"""Curvature along Bézier pieces, as data for combs: points, normals, curvature, and a scale shared by many."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ..types import FloatArray, IntArray
from .bezier import elevate

SCALE_PERCENTILE = 80.0
"""Share of the arc length whose curvature the robust scale covers. Near 100 the rounded corners, a tenth of the length
of many outlines, would flatten every other tooth; near 50 ordinary bowls would already be cut."""

STRAIGHT = 1e-9
"""Curvature times size below which a sample counts as straight in the scale; more would drop flat curves."""

ANGLE = np.radians(15)
"""Default turn from sample to sample. Wider, the tips of a rounded corner are joined by visible straight lines."""


@dataclass(frozen=True, eq=False)
class Comb:
    """Samples of one contour in curve order, both ends of every piece included.

    Attributes:
        points: (k, 2) on the curve.
        normals: (k, 2) unit vectors to the left of the direction of travel; zero on a piece without extent.
        curvature: (k,) signed, in 1/unit; positive turns left. Always finite.
        weights: (k,) arc length each sample stands for; their sum is the length of the curve.
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
    # Here and not above, as it brings the compiler with it: the package opens without.
    from .comb import sampled

    if pieces.shape[1] > 4:
        raise ValueError(f"pieces are of degree 1 to 3, not {pieces.shape[1] - 1}")
    while pieces.shape[1] < 4:
        points = elevate(np.moveaxis(pieces, 1, 0).reshape(pieces.shape[1], -1))
        pieces = np.moveaxis(points.reshape(len(points), -1, 2), 0, 1)
    samples, starts = sampled(np.ascontiguousarray(pieces, dtype=np.float64), float(spacing), float(angle), 0.0)
    return comb_of(samples, starts)


def comb_of(samples: FloatArray, starts: IntArray) -> Comb:
    """A comb from what :func:`.comb.sampled` gave: (k, 6) samples and where pieces begin among them."""
    return Comb(samples[:, :2], samples[:, 2:4], samples[:, 4], samples[:, 5], starts)


def robust_scale(combs: Iterable[Comb], percentile: float = SCALE_PERCENTILE) -> float:
    """A curvature, in 1/unit, that represents many combs: teeth and colours of all are drawn relative to it.

    It is the percentile of |κ| over the arc length of everything that is not straight. Counting by length, not by
    sample, makes it independent of spacing and keeps short sharp places, however curved, from setting it; leaving
    straight lines out keeps it alike for a font with long stems and one with none. Zero if nothing is curved.
    """
    magnitudes, weights = [np.empty(0)], [np.empty(0)]
    for item in combs:
        size = float(np.ptp(item.points, axis=0).max()) if len(item.points) else 0.0
        magnitude = np.abs(item.curvature)
        curved = magnitude * size > STRAIGHT
        magnitudes.append(magnitude[curved])
        weights.append(item.weights[curved])
    values, lengths = np.concatenate(magnitudes), np.concatenate(weights)
    if not lengths.sum() > 0:
        return 0.0
    order = np.argsort(values, kind="stable")
    covered = np.cumsum(lengths[order])
    index = np.searchsorted(covered, percentile / 100 * covered[-1])
    return float(values[order][min(int(index), len(order) - 1)])


def relative(curvature: FloatArray, scale: float) -> FloatArray:
    """Curvature in units of the scale, as colours and tooth lengths take it; zero if there is no scale."""
    return curvature / scale if scale > 0 else np.zeros_like(curvature)
