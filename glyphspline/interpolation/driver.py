"""The loop of Algorithms 1, 2 and 3 in Python: passes until the error is small enough."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..types import FloatArray
from .diagnostics import History

Pass = Callable[[FloatArray], tuple[FloatArray, FloatArray, float]]
"""From control points to footpoints, control points after the update, and the largest error before it."""


class Run(NamedTuple):
    """The end of an iteration: control points, their footpoints, the error of every pass, and the history if kept."""

    controls: FloatArray
    footpoints: FloatArray
    residuals: list[float]
    history: History


def iterate(
    one_pass: Pass, controls: FloatArray, limit: float, max_iterations: int, at_once: bool = False, keep: bool = False
) -> Run:
    """Make passes until the error is below ``limit``, is not finite, or ``max_iterations`` updates have been made.

    Args:
        at_once: as in Algorithm 3, where the pass that reaches the limit has already updated the control points.
        keep: keep the control points and the footpoints of every pass.
    """
    residuals: list[float] = []
    history: History = []
    while True:
        footpoints, updated, error = one_pass(controls)
        residuals.append(error)
        if keep:
            history.append((controls, footpoints))
        if error < limit:
            return Run(updated if at_once else controls, footpoints, residuals, history)
        if len(residuals) > max_iterations or not np.isfinite(error):
            return Run(controls, footpoints, residuals, history)
        controls = updated
