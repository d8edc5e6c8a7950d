"""Convergence of a run: the matrices of the paper's Section 3, from the recorded footpoints."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ..types import FloatArray

History = list[tuple[FloatArray, FloatArray]]
"""The control points of every iteration, and the footpoints on their curve."""


def diagnose(matrix: Callable[[FloatArray], FloatArray], history: History, at_once: bool) -> dict[str, Any]:
    """Error iteration matrices of a run: the largest row-sum norm, and the spectral radius of their product so far.

    In Algorithm 2 the factor of a step is I - Bᵐ (the paper's equation 3). In Algorithm 3, with L the part of B
    below the diagonal, the corrections of a sweep are (I + L)⁻¹ times the errors before it, so that the factor
    from one sweep's corrections to the next one's is I - (I + L)⁻¹ B.

    Args:
        matrix: from (f,) footpoints to the (f, f) matrix B of the free control points.
        at_once: whether the run is one of Algorithm 3.
    """
    factors = []
    for _, t in history[:-1]:
        B = matrix(t)
        identity = np.eye(len(B))
        factors.append(identity - (np.linalg.solve(identity + np.tril(B, -1), B) if at_once else B))
    radii, product = [], np.eye(len(history[0][1]))
    for factor in factors:
        product = factor @ product
        radii.append(float(np.abs(np.linalg.eigvals(product)).max(initial=0.0)))
    norms = [float(np.abs(factor).sum(axis=1).max(initial=0.0)) for factor in factors]
    return {
        "history": tuple(history),
        "rate_observed": max(norms, default=0.0),
        "spectral_radii": np.array(radii),
    }
