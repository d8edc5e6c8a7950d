"""How contours are cut and fitted in the sharp mode."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

LONG_LINE = 0.02
"""Share of the em from which straight lines stay lines."""


class SharpSettings(NamedTuple):
    """How contours are cut and fitted.

    Attributes:
        near: how near samples have to be. angle: turn in radians from which a joint is a corner.
        line: length from which lines stay lines.
        c2: whether splines are fitted, which need more samples beside tight turns; or else single cubics.
        margin, residual: of the interpolation.
        chain_rounds: most Gauss-Newton steps of a cubic among others. cubic_rounds: most steps of a cubic by itself.
        rounds: most steps of a spline's first guess. few_rounds: of one with up to three spans.
        guess: spans of the first guess, as a share of what the density asks for.
        growth: power of a span's error with which vertices are added.
        passes: in which vertices are tried to take out. failures: in a row, after which a pass ends.
        dear: estimated cost of a vertex, in tolerances, from which it is not tried.
        removal_rounds: most steps after a removal. reach: vertices on either side of it that move.
    """

    near: float
    angle: float
    line: float
    c2: bool
    margin: float
    residual: float
    chain_rounds: int
    cubic_rounds: int
    rounds: int
    few_rounds: int
    guess: float
    growth: float
    passes: int
    failures: int
    dear: float
    removal_rounds: int
    reach: int


EFFORTS = {
    "fast": partial(
        SharpSettings, chain_rounds=4, cubic_rounds=4, rounds=5, few_rounds=12, guess=1.0, growth=0.4,
        passes=1, failures=3, dear=0.5, removal_rounds=2, reach=3,
    ),
    "best": partial(
        SharpSettings, chain_rounds=6, cubic_rounds=12, rounds=10, few_rounds=20, guess=0.8, growth=0.3,
        passes=2, failures=8, dear=1.5, removal_rounds=8, reach=4,
    ),
}  # fmt: skip
"""The settings of each effort, but for what the options say."""
