"""What fits try in turn: one table of all ladders, with what each rung gains.

Gains are measured by leaving a rung out: on 924 contours of 400 glyphs (DejaVu Sans and Serif, STIX General, Computer
Modern) and of two brush faces, which have 10,575 segments with ``effort="fast"`` and 10,155 with "best".
"""

from __future__ import annotations

from typing import NamedTuple


class SmoothTry(NamedTuple):
    """A fit of the smooth mode.

    Attributes:
        share: of the tolerance. early: rounds in which vertices are taken out as well; None for the usual number.
        holds: whether corners are held, if the options say so. fair: whether curves are faired then.
    """

    share: float
    early: int | None = None
    holds: bool = False
    fair: bool = False


SMOOTH_TRIES = SmoothTry(1.0, holds=True, fair=True), SmoothTry(1.0, early=3), SmoothTry(0.25, early=3)
"""Of contours that cross or collapse, in the smooth mode.

Strands of an outline that lie on each other are crossed the less the fewer vertices they have. Of 13,333 contours of
eleven faces with corners passed, whose best results leave 207 changed, 71 are worse without the second try, 37 without
the third one; with corners held, three and four. Shares of 0.5, 0.1 and 0.04 besides change nothing in 8,233 contours.
"""

HELD_TRY = SmoothTry(1.0, holds=True)
"""Where corners are held, a try after the first one that holds them too, without fairing; later ones do not.

Without it four of 13,333 contours of eleven faces have more segments, and nine at a tolerance of 3/1000 em. A second
one, at a share of 0.75, saves one contour's each time, and costs two others some, and eleven.
"""

SHARP_TRIES = (1.0, 0.5, 0.25, 0.1)
"""The same in the sharp mode, and of masters: shares of the tolerance.

With "best", a single try would keep nine contours as the source has them, with 80 segments more; 0.5 saves 39 segments.
Of 3,476 contours of eleven faces 0.5 serves 14, 0.25 and 0.1 two each, and five that are kept without both.
"""

RETRIES = {"plain": (0.9, 0.75), "masters": (0.9, 0.75, 0.5)}
"""Shares of the samples' tolerance for pieces that fail the certificate, of a plain outline and of masters. In the end
the source's own segments take their place.

With "best", 0.9 saves 13 segments, 0.75 six. Of the masters of 66 glyphs each of Source Sans 3, Source Serif 4 and
Fraunces 980 of 5,993 segments stay as the source has them; without the last one, 2,040.
"""

STARTS = 3
"""First guesses of the spline of several masters, each with more vertices, before its stretch is given up: without the
third one an oval of four masters stays the source's at a tolerance of 0.2 units.

A stretch of a single outline that the first guess fails is cut in two. With three guesses 60 glyphs of a brush face
have 58 of 6,957 segments and 180 of 18,206 numbers more, in about the same time.
"""
