"""Parameters of the vertices of a polygon, and the knots of the B-spline through them."""

from __future__ import annotations

from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..errors import PolygonError
from ..types import FloatArray
from .choices import CHORD_EXPONENT, Parametrisation


def lengths(vectors: FloatArray) -> Any:
    """Euclidean lengths of vectors (..., d), d ≥ 2: (...,). Squares of the coordinates may overflow."""
    return reduce(np.hypot, np.moveaxis(vectors, -1, 0))


def vertex_parameters(
    points: FloatArray, knots: Parametrisation | ArrayLike = "chord", closed: bool = True
) -> FloatArray:
    """The parameter s_i of every vertex; the first is 0.

    Args:
        points: (n, d) vertices, consecutive ones distinct. closed: whether the polygon returns to its first vertex.
        knots: "chord", "uniform", "centripetal", or the parameters themselves, increasing.

    Returns:
        (n + 1,) for a closed polygon, where the last entry is the period T; (n,) for an open one.

    Raises:
        PolygonError: the number of given parameters is wrong, or they are not finite or not increasing.
    """
    n = len(points)
    if isinstance(knots, str):
        if knots not in CHORD_EXPONENT:
            raise PolygonError(f"knots are {', '.join(CHORD_EXPONENT)} or an array, not {knots!r}")
        ends = np.concatenate([points, points[:1]]) if closed else points
        chords = lengths(np.diff(ends, axis=0))
        return np.concatenate([[0.0], np.cumsum(chords ** CHORD_EXPONENT[knots])])
    given, expected = np.asarray(knots, dtype=np.float64), n + closed
    if given.shape != (expected,):
        raise PolygonError(f"{n} vertices need {expected} knots, not an array of shape {given.shape}")
    if not np.isfinite(given).all() or not (np.diff(given) > 0).all():
        raise PolygonError("knots have to be finite and increasing")
    return given - given[0]


def closed_knots(parameters: FloatArray, degree: int) -> FloatArray:
    """The (n + 1,) knots of a closed spline whose B_i is centred on vertex parameter s_i, from 0 to T.

    For odd degrees the knots are the parameters. For even degrees they are the midpoints of neighbouring parameters,
    counted from the one before s_0. ``B_i`` is centred on s_i either way.
    """
    if degree % 2:
        return parameters
    before = parameters[-2] - parameters[-1]
    middles = (np.concatenate([[before], parameters[:-1]]) + parameters) / 2
    return middles - middles[0]


def vertex_centres(parameters: FloatArray, degree: int) -> FloatArray:
    """(n,) the parameter s_i of each vertex, relative to the first knot of :func:`closed_knots`."""
    centres = parameters[:-1]
    return centres if degree % 2 else centres + (parameters[-1] - parameters[-2]) / 2
