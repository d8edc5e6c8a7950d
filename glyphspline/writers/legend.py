"""The legend of a curvature map: a row of teeth over a scale in 1/em."""

from __future__ import annotations

import numpy as np

from .colours import SIDES, class_colour
from .markup import Box, number, segments_data

WIDTH = 0.56
"""Length in em of the scale's axis, from -κ to κ of the shared scale."""

TEETH_PER_CLASS = 4
"""Teeth drawn for each colour class."""

FONT = 0.034
"""Height of the legend's letters in em."""


def legend_svg(box: Box, em: float, scale: float, precision: int, tooth: float, longest: float) -> tuple[str, Box]:
    """The legend, set under a drawing's box, and the box that holds both.

    Args:
        box: the drawing, y up. em: units per em. scale: κ of a full tooth in 1/unit. precision: decimals.
        tooth: length in em of a full tooth. longest: where teeth are cut, in units of the scale.
    """
    gap, height, letters = 0.06 * em, tooth * em, FONT * em
    width = WIDTH * em
    left = box[0] + 0.02 * em
    base = box[1] - gap - height
    strength = np.linspace(-1, 1, 2 * SIDES * TEETH_PER_CLASS + 1)
    feet = np.stack([left + (strength + 1) / 2 * width, np.full(len(strength), base)], axis=1)
    tips = feet + np.stack([np.zeros(len(strength)), np.abs(strength) * height], axis=1)
    classes = np.rint(strength * SIDES).astype(int)
    paths = []
    for index in range(-SIDES, SIDES + 1):
        data = segments_data(feet[classes == index], tips[classes == index], precision)
        paths.append(f'<path stroke="{class_colour(index)}" d="{data}"/>')
    reach = scale * em
    labels = [
        (left, f"\N{MINUS SIGN}{reach:.3g}", "start"),
        (left + width / 2, "0", "middle"),
        (left + width, f"{reach:.3g}", "end"),
    ]
    texts = [_label(x, base - 1.35 * letters, words, anchor, precision) for x, words, anchor in labels]
    words = f"κ in 1/em, left turns positive; dots: cut at {longest * reach:.3g}"
    texts.append(_label(left, base - 2.75 * letters, words, "start", precision))
    axis = segments_data(np.array([[left, base]]), np.array([[left + width, base]]), precision)
    svg = (
        f'<g class="legend" stroke-width="{number(0.003 * em, 3)}">'
        + "\n".join(paths)
        + f'\n<path stroke="currentColor" d="{axis}"/>\n<g fill="currentColor" font-family="sans-serif" font-size="'
        + f'{number(letters, precision)}">'
        + "".join(texts)
        + "</g></g>"
    )
    right = left + max(width, 0.5 * letters * len(words))
    return svg, (box[0], base - 3.1 * letters, max(box[2], right), box[3])


def _label(x: float, y: float, words: str, anchor: str, precision: int) -> str:
    return f'<text x="{number(x, precision)}" y="{number(-y, precision)}" text-anchor="{anchor}">{words}</text>'
