"""How long splines of few spans are searched."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple


class Search(NamedTuple):
    """How long is searched.

    Attributes:
        margin, residual: of the interpolation.
        most: spans at most: 1 where cubics alone are wanted.
        lays: whether closed curves go round corners: 1 to lay those vertices on the outline that do not get near enough
            by moving, 2 to lay all at once.
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
    most: int
    lays: int
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


SEARCHES = {
    "fast": partial(
        Search, cubic_rounds=4, rounds=6, few_rounds=12, guess=1.0, growth=0.4, removals=0.3, passes=1, dear=0.5,
        removal_rounds=2, fairness=1e-2, reach=3,
    ),
    "best": partial(
        Search, cubic_rounds=12, rounds=10, few_rounds=20, guess=0.8, growth=0.3, removals=0.7, passes=2, dear=1.5,
        removal_rounds=8, fairness=1e-2, reach=4,
    ),
}  # fmt: skip
"""The search of each effort, but for what the options say."""

MOST_SPANS = {"c2": 1000, "g1": 1}
"""Spans of one spline at most, by continuity."""
