"""Outlines of one glyph that cannot be matched, side by side, with their contours and corners numbered."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...outlines.joins import joins
from ...outlines.outline import Contour, Outline
from .document import head, id_prefix, number, text, title, view_box_value
from .path_data import path_data

CONTOURS = ("#d33", "#06c", "#082", "#a0a", "#b60", "#077")
"""Colours of contours and of their numbers, again from the first one after the last."""

SIZE, GAP = 0.028, 0.15
"""Of the em: the height of numbers. Of the em: space between two outlines."""


def to_unmatched_svg(outlines: Sequence[Outline], reason: str = "") -> str:
    """Two outlines or more as an SVG document: contours in colours, "2:7" at corner 7 of contour 2.

    Numbers count from 0: contours in the outline's order, and corners along each contour from its start, which has a
    circle, and a stroke in the direction in which the contour runs. All outlines have the em of the first.

    Args:
        outlines: at least one.
        reason: a sentence below them, such as the message of the error that was raised.

    Example:
        >>> from glyphspline import open_font
        >>> from glyphspline.writers.svg.unmatched import to_unmatched_svg
        >>> outlines = [open_font(f"fonts_test/kouzan-{style}.ttf").outline("B") for style in ("gyosho", "kaisho")]
        >>> "0:3" in to_unmatched_svg(outlines, "as an example")
        True
    """
    first = outlines[0]
    em = first.metrics.units_per_em
    low, high = first.metrics.descender, first.metrics.ascender
    parts, x = [], 0.0
    for outline in outlines:
        scale = em / outline.metrics.units_per_em
        every = [contour.points * scale for contour in outline.contours] or [np.zeros((1, 2))]
        points = np.concatenate(every)
        left, right = float(points[:, 0].min()), float(points[:, 0].max())
        low, high = min(low, float(points[:, 1].min())), max(high, float(points[:, 1].max()))
        for index, contour in enumerate(outline.contours):
            moved = Contour(contour.points * scale + (x - left, 0.0), contour.degrees)
            parts += _contour(moved, index, em)
        x += right - left + GAP * em
    below = low - 2 * SIZE * em
    words = f'<text x="0" y="{number(-below, 2)}" fill="currentColor">{text(reason)}</text>\n' if reason else ""
    edge = 2 * SIZE * em
    box = view_box_value((-edge, below - edge, x - GAP * em + edge, high + edge), 2)
    prefix = id_prefix(first.name, first.gid)
    begin = head(box, f"{prefix}-title", f"{len(outlines)} outlines of {title(first)}")
    group = f'<g font-family="sans-serif" font-size="{number(SIZE * em, 2)}" stroke-width="{number(em / 400, 3)}">\n'
    return "".join([begin, group, *parts, words, "</g>\n</svg>\n"])


def _contour(contour: Contour, index: int, em: float) -> list[str]:
    """The drawing of one contour with its corners."""
    if not len(contour):
        return []
    colour, found = CONTOURS[index % len(CONTOURS)], joins(contour)
    (x, y), away = found.points[0], contour.points - contour.points[0]
    away = away[away.any(axis=1)][:1]  # along the tangent where the contour starts; none if all of it is one point
    tip_x, tip_y = found.points[0] + 2 * SIZE * em * (away / np.hypot(*away.T)[:, None]).sum(axis=0)
    lines = [
        f'<path fill="none" stroke="{colour}" d="{path_data([contour], 2)}"/>\n',
        f'<circle cx="{number(x, 2)}" cy="{number(-y, 2)}" r="{number(em / 150, 3)}" fill="none" stroke="{colour}"/>',
        f'<path stroke="{colour}" d="M{number(x, 2)} {number(-y, 2)}L{number(tip_x, 2)} {number(-tip_y, 2)}"/>\n',
    ]
    for k, (x, y) in enumerate(found.points[found.of("corner", 0.0)]):
        lines.append(f'<text x="{number(x, 2)}" y="{number(-y, 2)}" fill="{colour}">{index}:{k}</text>\n')
    return lines
