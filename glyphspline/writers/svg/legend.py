"""The legend of a curvature map: a row of teeth over a scale in 1/em."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from ...types import FloatArray
from .colours import SIDES, class_colour
from .markup import number
from .path_data import Box

WIDTH = 0.56
"""Length in em of the scale's axis, from -κ to κ of the shared scale."""

TEETH_PER_CLASS = 4
"""Teeth drawn for each colour class."""

MEANING = (
    "Length and colour of a tooth are the curvature there, 1/radius with the em as the unit: 2 is the bend of a circle"
    " of half an em in radius. Blue to violet: the ink is convex; yellow to red: it is concave."
)
"""Tooltip of the legend."""

FONT = 0.034
"""Height of the legend's letters in em."""


def legend_svg(
    box: Box, em: float, scale: float, precision: int, tooth: float, longest: float, whose: str
) -> tuple[str, Box]:
    """The legend, placed under a drawing's box, and the box around both.

    Args:
        box: of the drawing, y up. em: units per em. scale: κ of a full tooth in 1/unit. precision: decimals.
        tooth: length in em of a full tooth. longest: limit of teeth, in units of the scale.
        whose: "source" or "result".
    """
    left, base = box[0] + 0.02 * em, box[1] - (0.06 + tooth) * em
    content, width, height = _legend(em, scale, precision, tooth, longest, whose)
    place = f"translate({number(left, precision)} {number(-base, precision)})"
    svg = f'<g class="legend" transform="{place}" stroke-width="{number(0.003 * em, 3)}">{content}</g>'
    return svg, (box[0], base - height, max(box[2], left + width), box[3])


@lru_cache(maxsize=8)
def _legend(
    em: float, scale: float, precision: int, tooth: float, longest: float, whose: str
) -> tuple[str, float, float]:
    """The legend's content with its origin at the left end of the axis; its width, and its extent below the axis."""
    letters, width, reach = FONT * em, WIDTH * em, scale * em
    strength = np.linspace(-1, 1, 2 * SIDES * TEETH_PER_CLASS + 1)
    classes = np.rint(strength * SIDES).astype(int)
    paths = []
    for index in range(-SIDES, SIDES + 1):
        chosen = strength[classes == index]
        feet = np.stack([(chosen + 1) / 2 * width, 0 * chosen], axis=1)
        tips = feet + np.stack([0 * chosen, np.abs(chosen) * tooth * em], axis=1)
        paths.append(f'<path stroke="{class_colour(index)}" d="{strokes_data(feet, tips, precision)}"/>')
    labels = [
        (0.0, f"\N{MINUS SIGN}{reach:.3g}", "start"),
        (width / 2, "0", "middle"),
        (width, f"{reach:.3g}", "end"),
    ]
    texts = [_label(x, -1.35 * letters, words, anchor, precision) for x, words, anchor in labels]
    words = f"κ of the {whose} in 1/em, convex positive; dots: cut at {longest * reach:.3g}"
    texts.append(_label(0.0, -2.75 * letters, words, "start", precision))
    content = (
        f"<title>{MEANING}</title>"
        + "\n".join(paths)
        + f'\n<path stroke="currentColor" d="M0 0h{number(width, precision)}"/>\n'
        + f'<g fill="currentColor" font-family="sans-serif" font-size="{number(letters, precision)}">'
        + "".join(texts)
        + "</g>"
    )
    return content, max(width, 0.5 * letters * len(words)), 3.1 * letters


def strokes_data(feet: FloatArray, tips: FloatArray, precision: int) -> str:
    """Path data of strokes from ``feet`` (k, 2) to ``tips``, with relative numbers as in ``comb_text``; y down."""
    data, x, y = "", 0, 0
    for places in np.rint(np.stack([feet, tips], axis=1) * (1, -1) * 10**precision).astype(int).tolist():
        for command, (to_x, to_y) in zip(("m" if data else "M", "l"), places, strict=True):
            data += f"{command}{_short(to_x - x, precision)} {_short(to_y - y, precision)}".replace(" -", "-")
            x, y = to_x, to_y
    return data


def _short(value: int, precision: int) -> str:
    return number(value / 10**precision, precision)


def _label(x: float, y: float, words: str, anchor: str, precision: int) -> str:
    return f'<text x="{number(x, precision)}" y="{number(-y, precision)}" text-anchor="{anchor}">{words}</text>'
