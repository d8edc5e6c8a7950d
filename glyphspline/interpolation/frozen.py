"""The end of ``finish="solve"``: the curve through all vertices at the footpoints reached, by a banded system."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..curves.bspline import Spline
from ..curves.parameters import lengths
from ..types import FloatArray
from .driver import natural_weights
from .method import Tangents
from .result import Interpolation


def solved(found: Interpolation, points: FloatArray, end_tangents: Tangents | None, tolerance: float) -> Interpolation:
    """A result with the control points whose curve passes through every vertex at its present parameter.

    The control points stay as they are where that is impossible: variants 0, 1 and 4 may bring two footpoints together.

    Args:
        points: (n, d) the polygon as it was given.
    """
    spline, t = found.spline, found.parameters
    if not np.isfinite(found.max_error) or not (spline.closed or len(t) > 2):
        return found
    p = np.delete(points, found.merged, axis=0)
    natural = np.zeros(2) if spline.closed else natural_weights(np.diff(spline.knots), end_tangents or (None, None))
    best, error = spline, found.max_error
    for _ in range(2):  # the second time for the rounding errors of the first
        better = _corrected(best, t, p - best(t), natural)
        left = float(lengths(p - better(t)).max())
        if left < error:
            best, error = better, left
    residuals = np.append(found.residuals, error)
    return replace(
        found, spline=best, residuals=residuals, iterations=found.iterations + 1, converged=error < tolerance
    )


def _corrected(spline: Spline, t: FloatArray, e: FloatArray, natural: FloatArray) -> Spline:
    """The spline moved by e (n, d) at its vertices' parameters (n,); NaN or infinite if the system is singular."""
    from scipy.linalg import LinAlgError, solve_banded

    columns, weights = spline.basis_rows(t)
    n, P = len(t), spline.control_points.copy()
    if spline.closed:  # in the order 0, n-1, 1, n-2, … neighbours on the ring are near each other
        i = np.arange(n)
        place = np.minimum(2 * i, 2 * (n - 1 - i) + 1)
        rows, columns, order = place, place[columns], np.argsort(place)
    else:  # control points beside natural ends follow their neighbours, the others at the ends are fixed
        free = np.arange(1, n - 1)
        columns, weights, e = columns[free] - 2, weights[free], e[free]
        weights[columns == -1] *= natural[0]
        weights[columns == n - 2] *= natural[1]
        weights[(columns < -1) | (columns > n - 2)] = 0.0
        rows, columns, order = free - 1, columns.clip(0, n - 3), free - 1
    width = int(np.abs(columns - rows[:, None]).max())
    band = np.zeros((2 * width + 1, len(rows)))
    np.add.at(band, (width + rows[:, None] - columns, columns), weights)
    try:
        moves = solve_banded((width, width), band, e[order], check_finite=False)
    except LinAlgError:
        moves = np.full_like(e, np.nan)
    if spline.closed:
        P += moves[rows]
    else:
        P[2:-2] += moves
        P[[1, -2]] += natural[:, None] * moves[[0, -1]]
    return Spline(P, spline.knots, spline.degree, spline.closed)
