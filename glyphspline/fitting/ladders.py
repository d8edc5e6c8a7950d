"""What fits try in turn, and how long they search: one table of all ladders, with what each rung gains.

Gains are measured by leaving a rung out: on 924 contours of 400 glyphs (DejaVu Sans and Serif, STIX General, Computer
Modern) and of two brush faces, which have 10,575 segments with ``effort="fast"`` and 10,155 with "best".
"""

from __future__ import annotations

from functools import partial
from typing import NamedTuple


class Search(NamedTuple):
    """How long splines of few spans are searched.

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
        starts: first guesses, each with more vertices, before a stretch is given up. The second one saves 25 segments
            with "best", the third one none.
        some_more: a cubic that misses the tolerance by less than this factor is followed by a try with two spans: this
            saves 483 segments with "fast"; without a limit 289 more, for 1.4 times the time.
        patience: insertions after a first guess from which on all spans that miss the tolerance are cut. On long
            stretches of fine detail very many miss it by little, and would get two or three vertices at a time. It
            saves 13 of 35,142 segments.
        far, few: a closed curve that may go round corners is laid on the outline once its vertices, moved, leave it
            this many tolerances off, or after so many insertions.
        respacings: how often laid vertices are spaced anew, before spans that miss the tolerance are cut. Of 169
            contours of two masters, with 9,117 segments, 206 segments stay the source's; without respacing 221, with
            one respacing 74, of 9,279 segments in 0.74 of the time.
        aim, power: share of the tolerance that spacing aims at, and the power of a span's error with which its vertices
            become denser: a quarter is right where the outline is smooth, one beside a corner.
        steep: ratio of adjacent chords from which the longer one is cut where vertices are laid on the outline.
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
    starts: int = 3
    some_more: float = 30.0
    patience: int = 12
    far: float = 2.0
    few: int = 3
    respacings: int = 4
    aim: float = 0.85
    power: float = 0.4
    steep: float = 3.0


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

SMOOTH_TRIES = ((1.0, None), (1.0, 3), (0.25, 3))
"""Of contours that cross or collapse, in the smooth mode: shares of the tolerance, and rounds in which vertices are
taken out as well; None for the usual number.

Strands of an outline that lie on each other are crossed the less the fewer vertices they have: at a tolerance of 5/1000
em the second try saves 27 of 68,144 segments. The third one saves 731 of 257,403. Shares of 0.5, 0.1 and 0.04 besides
change nothing in 8,233 contours of four faces. A single try leaves 122 changes for 8.
"""

SHARP_TRIES = (1.0, 0.5, 0.25, 0.1)
"""The same in the sharp mode, and of masters: shares of the tolerance.

With "best", a single try would keep nine contours as the source has them, with 80 segments more; 0.5 saves 39 segments.
The last two change nothing in these contours; without them one of 3,557 is kept as the source has it.
"""

TRY_APART, APART = 2, (0.35, 0.7)
"""Which of the smooth mode's tries fits contours that are drawn apart, and by which shares of the tolerance.

In 8,233 contours the first share saves 6 segments, the second one 6 crossings; without either there are 93 changes for
8.
"""

RETRIES = {"c2": ((0.9, False), (0.75, False), (1.0, True)), "g1": ((0.8, False),)}
RETRIES_OF_MASTERS = ((0.9, False), (0.75, False), (0.5, False), (1.0, True), (0.6, True))
"""What is tried for pieces that fail the certificate: a share of the samples' tolerance, and whether to cut at all
corners. In the end the source's own segments take their place.

With "best", all together save 56 segments, 0.9 alone 13, 0.75 six, and the cut none; 0.8 of "g1" saves three. Of two
masters (169 contours, smooth and sharp) the retries save 481 segments from staying as the source has them, 0.9 alone
109 and 0.75 seven; the last three none.
"""

MOVED = 0.9
"""Share of the tolerance below which vertices of closed curves round corners are no longer moved, but laid at once.

It changes nothing in 169 contours of two masters.
"""
