"""Outlines fitted anew by kurbo (``fit_to_bezpath`` through kurbopy) between corners and lines that stay.

kurbopy has the plain fit alone, not the one that is optimised at more cost. Like FontForge, kurbo is given the benefit
of the doubt: of several accuracies the one counts that needs the fewest numbers and truly stays within the tolerance.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from fontTools.svgLib.path import parse_path

import glyphspline as gs
from glyphspline.fitting.sharp.settings import LONG_LINE
from glyphspline.outlines.joins import joins
from glyphspline.types import FloatArray

from ..survey import SegmentPen

ACCURACIES = (4.0, 2.0, 1.5, 1.2, 1.0, 0.8, 0.6, 0.4)
"""In font units; kurbo aims for them and does not promise them."""


class Stretch:
    """Some segments in a row, as a curve over [0, 1] in the way kurbo asks for one."""

    def __init__(self, cubics: FloatArray) -> None:
        from kurbopy import Point, Vec2

        self.point, self.vector = Point, Vec2
        self.cubics = cubics.tolist()

    def sample_pt_deriv(self, t: float) -> tuple[Any, Any]:
        """The point and the derivative at t."""
        count = len(self.cubics)
        s = min(int(t * count), count - 1)
        x = t * count - s
        y = 1 - x
        place, speed = [], []
        for a, b, c, d in zip(*self.cubics[s], strict=True):
            place.append(y * y * (y * a + 3 * x * b) + x * x * (3 * y * c + x * d))
            speed.append(3 * count * (y * y * (b - a) + 2 * x * y * (c - b) + x * x * (d - c)))
        return self.point(*place), self.vector(*speed)

    def sample_pt_tangent(self, t: float, sign: float) -> tuple[Any, Any]:
        """The point and the tangent at t; from the side of ``sign``, where handles have no length."""
        place, speed = self.sample_pt_deriv(t)
        if speed.x == speed.y == 0:
            _, speed = self.sample_pt_deriv(min(max(t + (1e-6 if sign > 0 else -1e-6), 0.0), 1.0))
        return place, speed

    def break_cusp(self, *_: Any) -> None:
        """A stretch has no corners."""


def kurbo_results(glyph: gs.Outline) -> list[list[list[Any]]]:
    """For each accuracy the contours, each a list of segments (degree + 1, 2)."""
    return [[fitted(contour, accuracy, glyph) for contour in glyph.contours] for accuracy in ACCURACIES]


def fitted(contour: gs.Contour, accuracy: float, glyph: gs.Outline) -> list[Any]:
    """One contour, fitted between its corners and long lines; a stretch that kurbo cannot fit stays as it is."""
    from kurbopy import fit_to_bezpath

    cubics = contour.cubics()
    lines = (contour.degrees == 1) & (
        np.hypot(*(cubics[:, 3] - cubics[:, 0]).T) >= LONG_LINE * glyph.metrics.units_per_em
    )
    ends = joins(contour).of("corner", 0.0) | lines | np.roll(lines, 1)
    first = int(ends.argmax())
    cubics, lines, ends = np.roll(cubics, -first, axis=0), np.roll(lines, -first), np.roll(ends, -first)
    cuts = [0, *(np.flatnonzero(ends[1:]) + 1).tolist(), len(cubics)]
    segments: list[Any] = []
    for i, j in pairwise(cuts):
        if lines[i]:
            segments.append(cubics[i][[0, 3]].tolist())
            continue
        pen = SegmentPen()
        parse_path(fit_to_bezpath(Stretch(cubics[i:j]), accuracy).to_svg(), pen)
        found = [segment.tolist() for contour in pen.contours for segment in contour[:-1]]  # the last one closes it
        segments += found or cubics[i:j].tolist()
    return segments
