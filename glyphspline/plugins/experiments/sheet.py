"""The sheet of a character, as Figs. 8 and 9 of the paper: original, polygon, curves, zooms, curvature, residuals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from textwrap import wrap
from typing import Any

import numpy as np

from ...curves.curvature import Comb, comb, shared_scale
from ...types import counted
from ...writers.figures.basics import ascii_text, blank
from ...writers.svg.comb import SPACING
from . import VARIANTS
from .measures import farthest_apart, is_tame, span_points
from .methods import Interpolated
from .style import (
    COLOURS,
    CUT_AT,
    GREY,
    INK,
    TOOTH,
    Box,
    bare,
    draw_closed,
    draw_comb,
    fill,
    letter,
    line_of,
    mark,
    styled,
    zoomed,
)  # fmt: skip

NARROW, WIDE = 7.2, 9.6
"""Inches of a sheet of three variants at most, and of more."""

EDGE, GAP, LABEL, LINE = 0.12, 0.14, 0.27, 0.155
"""Inches: margin, between panels, below a panel for its label, a line of the caption."""

LOWEST, HIGHEST = 0.5, 1.45
"""Bounds of the height of a panel over its width; the glyph decides between them."""

LEAST_ZOOM, MOST_ZOOM, TIMES = 0.05, 0.1, 8.0
"""Half of the side of what is zoomed, in em: at least, at most, and in distances of the curves there."""

SPECK = 3.0
"""A glyph of less than a third of an em is drawn as if the em were three of it: teeth, and what is zoomed."""

TINT = "#eef1f4"


@dataclass
class PanelRows:
    """Rows of panels of a figure, which is filled from the top; lengths are in inches."""

    figure: Any
    width: float
    height: float

    def add(self, columns: int, used: int, ratio: float, below: float = GAP, inset: float = 0.0) -> list[Any]:
        """A row of axes of a height over width in the middle ones of some columns.

        Args:
            below: space under it. inset: for ticks, to the left and below.
        """
        each = (self.width - 2 * EDGE - (columns - 1) * GAP) / columns
        high, whole = each * ratio, self.figure.get_size_inches()
        self.height -= high
        lefts = [EDGE + (k + (columns - used) / 2) * (each + GAP) for k in range(used)]
        size = np.array([each - inset, high - 0.7 * inset]) / whole
        made = [
            self.figure.add_axes((*(np.array([left + inset, self.height + 0.7 * inset]) / whole), *size))
            for left in lefts
        ]
        self.height -= below
        return made


def sheet(made: Interpolated, face: str = "") -> Any:
    """The figure of one character; ``face``: the name of its font, for the caption."""
    with styled():
        return _sheet(made, face)


def _sheet(made: Interpolated, face: str) -> Any:
    drawn = [m for m in VARIANTS if made.curves and m in made.curves[0]]
    columns, width = max(3, len(drawn)), NARROW if len(drawn) <= 3 else WIDE
    em, box = made.em, _box_of(made)
    unit = min(em, SPECK * max(box[1] - box[0], box[3] - box[2]))
    ratio = min(max((box[3] - box[2]) / (box[1] - box[0]), LOWEST), HIGHEST)
    each = (width - 2 * EDGE - (columns - 1) * GAP) / columns
    top = (width - 2 * EDGE - 2 * GAP) / 3
    has_radii = any(curve.radii is not None for own in made.curves for curve in own.values())
    combs = _combs(made, drawn, unit)
    scale = shared_scale([each for m in drawn if _is_converged(made, m) for each in combs[m]], em) or 1 / em
    caption = wrap(_caption(made, drawn, face, (TOOTH * unit / em, scale * em), has_radii), int(width * 17.5))
    height = 2 * EDGE + top * min(ratio, 1.1) + each * (2 * ratio + 0.75) + 2 * LABEL + 2 * GAP + LINE * len(caption)
    height += (each * 0.8 + GAP) * has_radii
    figure = blank(width, height)
    rows, names = PanelRows(figure, width, height - EDGE), map("({})".format, "abcdefghij")
    original, polygon, residuals = rows.add(3, 3, min(ratio, 1.1), LABEL)
    fill(original, [contour.cubics() for contour in made.outline.contours], INK, INK)
    for p in made.polygons:
        draw_closed(polygon, p, color=INK, lw=0.6, marker="o", ms=1.5)
    for axes, words in ((original, "original"), (polygon, "polygon")):
        bare(axes)
        _within(axes, box)
        letter(axes, f"{next(names)} {words}")
    close = _zoom_of(made, drawn, unit)
    shapes = (ratio, LABEL), (0.75, GAP), (ratio, GAP)
    above, zooms, maps = (rows.add(columns, len(drawn), own, below) for own, below in shapes)
    for k, method in enumerate(drawn):
        _column(made, method, (above[k], zooms[k]), (box, close))
        for teeth in combs[method]:
            draw_comb(maps[k], teeth, COLOURS[method], TOOTH * unit / scale, CUT_AT * TOOTH * unit)
        bare(maps[k])
        _within(maps[k], box, CUT_AT * TOOTH * unit)
        letter(above[k], f"{next(names)} {method}{'' if _is_converged(made, method) else ', not converged'}")
    _residuals(residuals, f"{next(names)} largest error, step by step", made, drawn)
    if has_radii:
        for axes, method in zip(rows.add(columns, len(drawn), 0.8, inset=0.3), drawn, strict=True):
            _radii(axes, made, method)
    figure.text(
        EDGE / width, (EDGE + LINE * len(caption)) / height, "\n".join(caption), fontsize=7.5, va="top",
        linespacing=1.35, parse_math=False,
    )  # fmt: skip
    return figure


def _column(made: Interpolated, method: str, axes: Sequence[Any], boxes: Sequence[Box]) -> None:
    """One variant: its curves, and what is zoomed of them."""
    above, below = axes
    pieces = [own[method].pieces for own in made.curves if is_tame(own[method].pieces, made.em)]
    for panel, width in ((above, 0.8), (below, 1.2)):
        fill(panel, pieces, TINT, COLOURS[method], width)
    for p in made.polygons:
        draw_closed(below, p, color=GREY, lw=0.6, ls=(0, (3, 2)), marker="o", ms=2.8, mfc=INK, mec=INK)
    mark(above, boxes[1])
    bare(above)
    _within(above, boxes[0])
    zoomed(below, boxes[1])


def _combs(made: Interpolated, methods: Sequence[str], unit: float) -> dict[str, list[Comb]]:
    """The curvature of all curves of each method, as far as they are finite."""
    every = {method: [own[method].pieces for own in made.curves] for method in methods}
    return {m: [comb(own, SPACING * unit) for own in pieces if is_tame(own, made.em)] for m, pieces in every.items()}


def _residuals(axes: Any, label: str, made: Interpolated, methods: Sequence[str]) -> None:
    """The largest residual of all contours against the iteration, as far as one of those that converge goes."""
    place = axes.get_position()
    width, height = axes.figure.get_size_inches()
    axes.figure.text(
        place.x0 + place.width / 2, place.y0 - 0.04 * place.height, label, ha="center", va="top", fontsize=8.5
    )
    left, low = 0.36 / width, 0.2 / height
    axes.set_position((place.x0 + left, place.y0 + low, place.width - left, place.height - low))
    last = 1
    for k, method in enumerate(methods):
        series = [residuals for own in made.curves if (residuals := own[method].residuals) is not None]
        steps = max(map(len, series))
        worst = np.max([np.pad(each, (0, steps - len(each)), "edge") for each in series], axis=0) * (1000 / made.em)
        last = max(last, steps if _is_converged(made, method) else 1)
        how = line_of(method) | {"lw": 0.9 + 0.7 * (len(methods) - k), "markevery": (0.04 * k, 0.2)}
        axes.semilogy(np.where(worst > 0, worst, np.nan), label=method, **how)
    axes.axhline(1000 * made.tolerance / made.em, color=GREY, lw=0.7)
    axes.set(xlim=(0, last if last > 1 else None))
    axes.tick_params(labelsize=7, pad=1.5)
    axes.legend(fontsize=6.5, loc="upper right")


def _radii(axes: Any, made: Interpolated, method: str) -> None:
    """The spectral radius of the composite matrix against the iteration, a line a contour (Fig. 5)."""
    for own in made.curves:
        if (radii := own[method].radii) is not None:
            axes.plot(np.arange(1, len(radii) + 1), radii, color=COLOURS[method], lw=0.8)
    axes.set(xlim=(1, None), ylim=(0, None))
    axes.tick_params(labelsize=7)


def _is_converged(made: Interpolated, method: str) -> bool:
    return all(own[method].converged for own in made.curves)


def _box_of(made: Interpolated) -> Box:
    """The box of original, polygon, and curves that converged."""
    curves = [curve for own in made.curves for method, curve in own.items() if method in VARIANTS and curve.converged]
    lines = [span_points(curve.pieces, curve.places).reshape(-1, 2) for curve in curves]
    points = np.concatenate([*(contour.points for contour in made.outline.contours), *made.polygons, *lines])
    (x0, y0), (x1, y1) = points.min(axis=0), points.max(axis=0)
    return float(x0), float(x1), float(y0), float(y1)


def _zoom_of(made: Interpolated, methods: Sequence[str], unit: float) -> Box:
    """The box around the place where curves lie farthest apart; of a single one, the middle of the glyph."""
    gap, (x, y) = farthest_apart(made.curves, methods)
    if gap < 0:
        left, right, low, high = _box_of(made)
        x, y = (left + right) / 2, (low + high) / 2
    half = min(max(TIMES * gap, LEAST_ZOOM * unit), MOST_ZOOM * unit)
    return float(x - half), float(x + half), float(y - 0.75 * half), float(y + 0.75 * half)


def _within(axes: Any, box: Box, room: float = 0.0) -> None:
    """Show the box with some room around it."""
    x0, x1, y0, y1 = box
    more = room + 0.03 * max(x1 - x0, y1 - y0)
    axes.set(xlim=(x0 - more, x1 + more), ylim=(y0 - more, y1 + more))


def _caption(made: Interpolated, methods: Sequence[str], face: str, tooth: tuple[float, float], has_radii: bool) -> str:
    """What the figure shows, in a sentence as papers have it."""
    outline, letters = made.outline, "cdefgh"
    codes = " ".join(f"U+{code:04X}" for code in outline.unicodes[:2])
    vertices = counted(sum(map(len, made.polygons)), "vertex").replace("vertexs", "vertices")
    last = letters[len(methods)]
    between = ("", "", " and (d)")[len(methods)] if len(methods) < 3 else f" to ({letters[len(methods) - 1]})"
    length, reach = tooth
    parts = [
        f"{ascii_text(outline.name[:60])}{f' ({codes})' if codes else ''}{f' of {ascii_text(face)}' if face else ''}.",
        f"(a) Original. (b) Polygon: {vertices}, {counted(len(made.polygons), 'contour')}.",
        f"(c){between} Curves through it; below, the dotted",
        "part, where they lie farthest apart, with the polygon dashed, and curvature maps on one scale:",
        f"teeth are {length:.2g} em long at {reach:.3g}/em, and cut at {CUT_AT * reach:.3g}/em.",
        f"({last}) Largest distance of a vertex from its footpoint against the step, in 1/1000 em, and the tolerance.",
    ]
    if has_radii:
        parts.append("At the bottom, the spectral radius of the composite matrix at each step, a line a contour.")
    return " ".join(parts)
