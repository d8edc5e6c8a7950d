"""Parameters for the vertices of a polygon, and the knots of a B-spline that belong to them."""

from __future__ import annotations

from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from ..errors import PolygonError
from ..types import FloatArray

Parametrisation: TypeAlias = Literal["chord", "uniform", "centripetal"]

CHORD_EXPONENT = {"chord": 1.0, "centripetal": 0.5, "uniform": 0.0}


def vertex_parameters(
    points: FloatArray, knots: Parametrisation | ArrayLike = "chord", closed: bool = True
) -> FloatArray:
    """The parameter s_i of every vertex, beginning with 0.

    Args:
        points: (n, 2) vertices, no two consecutive ones equal.
        knots: "chord", "uniform", "centripetal", or the parameters themselves, increasing.
        closed: whether the polygon returns to its first vertex.

    Returns:
        (n + 1,) for a closed polygon, the last entry being the period T; (n,) for an open one.

    Raises:
        PolygonError: given parameters of the wrong number, not finite, or not increasing.
    """
    n = len(points)
    if isinstance(knots, str):
        if knots not in CHORD_EXPONENT:
            raise PolygonError(f"knots are {', '.join(CHORD_EXPONENT)} or an array, not {knots!r}")
        ends = np.concatenate([points, points[:1]]) if closed else points
        chords = np.hypot(*np.diff(ends, axis=0).T)
        return np.concatenate([[0.0], np.cumsum(chords ** CHORD_EXPONENT[knots])])
    given = np.asarray(knots, dtype=np.float64)
    expected = n + closed
    if given.shape != (expected,):
        raise PolygonError(f"{n} vertices need {expected} knots, not an array of shape {given.shape}")
    if not np.isfinite(given).all() or not (np.diff(given) > 0).all():
        raise PolygonError("knots have to be finite and increasing")
    return given - given[0]


def closed_knots(parameters: FloatArray, degree: int) -> FloatArray:
    """The (n + 1,) knots of a closed spline whose B_i is centred on vertex parameter s_i, from 0 to T.

    For odd degrees the knots are the parameters. For even ones they are the midpoints between
    neighbouring parameters, counted from the one before s_0, so that ``B_i`` is centred on s_i either way.
    """
    if degree % 2:
        return parameters
    before = parameters[-2] - parameters[-1]
    middles = (np.concatenate([[before], parameters[:-1]]) + parameters) / 2
    return middles - middles[0]


def vertex_centres(parameters: FloatArray, degree: int) -> FloatArray:
    """(n,) the parameter s_i of each vertex, counted from the first knot of :func:`closed_knots`."""
    centres = parameters[:-1]
    return centres if degree % 2 else centres + (parameters[-1] - parameters[-2]) / 2
