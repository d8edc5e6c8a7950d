"""The loop of Algorithms 1, 2 and 3 in Python: passes until the error is small enough."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..types import FloatArray
from .diagnostics import History

Pass = Callable[[FloatArray], tuple[FloatArray, FloatArray, float]]
"""From control points to footpoints, control points after the update, and the largest error before it."""

MEMORY = 5
"""Number of earlier passes that :class:`Anderson` combines with the last one; more of them save few passes."""

FALL = 0.95
"""Largest factor of the error in an accelerated step that stands."""

DAMPING = 1e-12
"""Share of its trace added to the diagonal of the normal equations, which are singular when changes are dependent."""


class Run(NamedTuple):
    """The end of an iteration: control points, their footpoints, the error of every pass, and the history if kept."""

    controls: FloatArray
    footpoints: FloatArray
    residuals: list[float]
    history: History


class Anderson:
    """Anderson acceleration of the passes, with the plain step as a safeguard.

    With the steps f = updated - controls of the last few passes, the affine combination of those passes is sought
    whose combined step is shortest; the same combination of the updated control points is tried next. Where that does
    not multiply the error by ``FALL`` or less, it is taken back for the plain step. Theorem 2 holds from any control
    points, so that every step that stands multiplies the error by at most the larger of ``FALL`` and the certified
    factor. The fixed points of the iteration are a family: the limit is another one than by plain steps.

    Args:
        free: the rows of free control points; others depend on them.
    """

    def __init__(self, free: slice = slice(None)) -> None:
        self.free = free
        self.updated: list[FloatArray] = []
        self.steps: list[FloatArray] = []
        self.error = np.inf
        self.trying = False

    def next(self, controls: FloatArray, updated: FloatArray, error: float) -> FloatArray:
        """The control points of the next pass, from those of a pass, its update and its error."""
        if self.trying and not error <= FALL * self.error:
            self.trying, self.updated, self.steps = False, self.updated[-1:], self.steps[-1:]
            return self.updated[-1]
        self.updated = [*self.updated[-MEMORY:], updated]
        self.steps = [*self.steps[-MEMORY:], (updated - controls)[self.free]]
        changes = np.diff(self.steps, axis=0)
        gram = np.einsum("ikc,jkc->ij", changes, changes)  # not by BLAS, whose sums may depend on the number of cores
        size = float(np.trace(gram))
        self.error, self.trying = error, size > 0
        if not self.trying:
            return updated
        weights = np.linalg.solve(
            gram + DAMPING * size * np.eye(len(gram)), np.einsum("ikc,kc->i", changes, self.steps[-1])
        )
        return updated - np.einsum("i,ikc->kc", weights, np.diff(self.updated, axis=0))


def iterate(
    one_pass: Pass,
    controls: FloatArray,
    limit: float,
    max_iterations: int,
    at_once: bool = False,
    keep: bool = False,
    anderson: Anderson | None = None,
) -> Run:
    """Make passes until the error is below ``limit``, is not finite, or ``max_iterations`` updates have been made.

    Args:
        at_once: as in Algorithm 3, where the pass that reaches the limit has already updated the control points.
        keep: keep the control points and the footpoints of every pass.
        anderson: accelerates the passes. A step that is taken back counts, and has its error among the residuals.
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
        controls = anderson.next(controls, updated, error) if anderson else updated
