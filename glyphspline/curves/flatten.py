"""Curves flattened: polylines within a distance that is proven, for programs that draw straight lines only."""

from __future__ import annotations

import numpy as np

from ..types import FloatArray, IntArray
from .bezier import derivative_points, evaluate


def flattened(pieces: FloatArray, flatness: float) -> tuple[FloatArray, IntArray, FloatArray]:
    """Bézier pieces as chords between points at even parameters, as few for each piece as the bound asks for.

    A chord of a piece cut into n is nowhere further than max |B''| / 8n² from it, at equal parameters, and B'' is
    within the convex hull of its Bézier points. A bound at equal parameters is one of the distance in both directions.

    Args:
        pieces: (m, degree + 1, 2). flatness: the distance allowed.

    Returns:
        (k, 2) the points of all pieces in order, each with its beginning and without its end; (m,) how many each has;
        (m,) the bound of each, at most ``flatness``.
    """
    bends = np.zeros(len(pieces))
    if pieces.shape[1] > 2 and len(pieces):
        second = derivative_points(pieces, 2)
        bends = np.hypot(second[..., 0], second[..., 1]).max(axis=1) / 8
    # A share less than what is allowed: rounding shall not lift the bound above it.
    counts = np.maximum(np.ceil(np.sqrt(bends / flatness) * (1 + 1e-12)), 1).astype(np.int64)
    first = np.cumsum(counts) - counts
    own = np.repeat(np.arange(len(pieces)), counts)
    places = (np.arange(len(own)) - first[own]) / counts[own]
    return evaluate(pieces[own], places), counts, bends / counts**2
