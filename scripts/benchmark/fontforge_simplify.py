"""Run by FontForge's own Python: glyphs in on stdin, each simplified with every setting, the results out on stdout.

One JSON line a glyph each way. In: contours, each a list of segments of 2 or 4 points. Out: a list of such glyphs.
"""

from __future__ import annotations

import json
import sys
from typing import Any

import fontforge

BOUNDS = (0.3, 0.5, 0.7, 0.85, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0)
FLAGS = (
    ("mergelines",),
    ("mergelines", "smoothcurves", "ignoreextrema"),
    ("mergelines", "ignoreslopes", "smoothcurves", "ignoreextrema"),
)


def simplified(glyph: Any, contours: list[Any], bound: float, flags: tuple[str, ...]) -> list[Any]:
    """The contours as lists of segments after ``simplify``."""
    layer = fontforge.layer()
    for segments in contours:
        contour = fontforge.contour()
        contour.moveTo(*segments[0][0])
        for segment in segments:
            if len(segment) == 2:
                contour.lineTo(*segment[1])
            else:
                contour.cubicTo(*segment[1:])
        contour.closed = True
        layer += contour
    glyph.foreground = layer
    glyph.simplify(bound, flags)
    result = []
    for contour in glyph.foreground:
        points = [(p.x, p.y, p.on_curve) for p in contour]
        first = next(i for i, p in enumerate(points) if p[2])
        points = points[first:] + points[:first] + points[first : first + 1]
        segments, open_segment = [], [points[0][:2]]
        for x, y, on in points[1:]:
            open_segment.append((x, y))
            if on:
                segments.append(open_segment)
                open_segment = [(x, y)]
        result.append([s for s in segments if len(s) != 2 or s[0] != s[1]])
    return result


font = fontforge.font()
font.em = 1000
canvas = font.createChar(-1, "canvas")
for line in sys.stdin:
    contours = json.loads(line)
    print(json.dumps([simplified(canvas, contours, bound, flags) for bound in BOUNDS for flags in FLAGS]), flush=True)
