"""What fits try in turn: one table of all ladders, with what each rung gains.

Gains are measured by leaving a rung out: on 924 contours of 400 glyphs (DejaVu Sans and Serif, STIX General, Computer
Modern) and of two brush faces, which have 10,575 segments with ``effort="fast"`` and 10,155 with "best".
"""

from __future__ import annotations

SMOOTH_TRIES = ((1.0, None), (1.0, 3), (0.25, 3))
"""Of contours that cross or collapse, in the smooth mode: shares of the tolerance, and rounds in which vertices are
taken out as well; None for the usual number.

Strands of an outline that lie on each other are crossed the less the fewer vertices they have: at a tolerance of 5/1000
em the second try saves 27 of 68,144 segments. The third one saves 731 of 257,403. Shares of 0.5, 0.1 and 0.04 besides
change nothing in 8,233 contours of four faces. A single try leaves 122 changes for 8.
"""

HELD_TRIES = ((1.0, None), (0.75, None))
"""Where corners are held, tries after the first one that hold them too, without fairing; later ones do not.

In 5,651 contours of five faces they leave 3,288 extrema of curvature beyond the floor for 3,502, and four contours that
are fitted sharp or kept for eight; without either 3,341, and without the second one six.
"""

SHARP_TRIES = (1.0, 0.5, 0.25, 0.1)
"""The same in the sharp mode, and of masters: shares of the tolerance.

With "best", a single try would keep nine contours as the source has them, with 80 segments more; 0.5 saves 39 segments.
The last two change nothing in these contours; without them one of 3,557 is kept as the source has it.
"""

RETRIES = {"plain": (0.9, 0.75), "masters": (0.9, 0.75, 0.5)}
"""Shares of the samples' tolerance for pieces that fail the certificate, of a plain outline and of masters. In the end
the source's own segments take their place.

With "best", 0.9 saves 13 segments, 0.75 six. Of the masters of 66 glyphs each of Source Sans 3, Source Serif 4 and
Fraunces 980 of 5,993 segments stay as the source has them; without the last one, 2,040.
"""

STARTS = 3
"""First guesses of a spline, each with more vertices, before its stretch is given up.

The second one saves 25 segments with "best", the third one none of these; without it an oval of four masters stays
the source's at a tolerance of 0.2 units.
"""
