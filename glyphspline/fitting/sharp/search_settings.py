"""How long splines of few spans are searched."""

from __future__ import annotations

from typing import NamedTuple


class Search(NamedTuple):
    """How long is searched.

    Attributes:
        margin, residual: of the interpolation.
        cubic_rounds: most steps of a single span. rounds: of a first guess. few_rounds: of one with up to three spans.
        guess: spans of the first guess, as a share of what the density asks for.
        growth: power of a span's error with which vertices are added.
        removals: share of the vertices that are tried to take out in a pass. passes: of removal.
        dear: estimated cost of a vertex, in tolerances, from which it is not tried.
        removal_rounds: most steps after a removal.
        fairness: weight of the curve's wobble beside its distances: of the integral of (dκ/ds)², by the cube
            of the mean chord.
        reach: vertices on either side of a change that move.
    """

    margin: float
    residual: float
    cubic_rounds: int
    rounds: int
    few_rounds: int
    guess: float
    growth: float
    removals: float
    passes: int
    dear: float
    removal_rounds: int
    fairness: float
    reach: int
    most: int
