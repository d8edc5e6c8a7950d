"""The curvature atlas of a font: a PDF with the combs of all glyphs on one scale, and κ(s) of selected glyphs."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import islice
from typing import Any

import numpy as np

from ...curves.curvature import Comb, comb
from ...fitting.results import ContourResult, GlyphResult
from ...outlines.ink import ink_sides
from ...outlines.joins import Kind, joins
from ...types import FloatArray
from ...writers.figures.basics import (
    OUTLINE,
    ascii_text,
    colour_legend,
    comb_patches,
    glyph_label,
    headed,
    outline_patch,
)
from ...writers.settings import Combs
from ...writers.svg.comb import LONGEST, SOURCE, SPACING, Teeth, legend, shown_by, teeth

COLUMNS, ROWS = 3, 4
"""Glyphs on a page. With more, the teeth of a CJK glyph run together in print."""

CELL = 1.3
"""Side of a glyph's cell in em: the glyph and its comb."""

JUMP = 0.25
"""Smallest jump of curvature, in units of the scale, that is marked as a break: half a colour class."""

MARKS: dict[Kind, tuple[str, str, str]] = {
    "corner": ("s", "#d6336c", "corners"),
    "G1": ("^", "#e8590c", "tangent breaks (G1)"),
    "G2": ("o", "#1098ad", "curvature jumps (G2)"),
}
"""Marker, colour and label of the breaks, by kind."""

Glyph = GlyphResult | tuple[str, str]
"""A result, or the name of a glyph without one and the reason."""


def atlas_pages(
    glyphs: Iterable[Glyph],
    scale: float,
    *,
    heading: str,
    combs: Combs,
    in_corners: bool,
    profiled: Callable[[GlyphResult], bool],
) -> Iterator[Any]:
    """The pages of the atlas as matplotlib figures.

    Args:
        heading: the font's name.
        glyphs: results in the order of the pages; only one page and the profiled glyphs are held in memory.
        scale: curvature in 1/unit of a full tooth, from :func:`.svg.comb.curvature_scale`.
        combs: of the overview pages; of "both", the source's is a line.
        in_corners: also where a smooth result turns about a corner.
        profiled: whether a glyph has a profile page, after the overview pages.
    """
    chosen: list[GlyphResult] = []
    rest = iter(glyphs)
    number = 0
    while part := list(islice(rest, COLUMNS * ROWS)):
        number += 1
        yield overview(part, scale, f"{heading}, page {number}", combs, in_corners=in_corners)
        chosen += [glyph for glyph in part if isinstance(glyph, GlyphResult) and profiled(glyph)]
    for glyph in chosen:
        yield profile(glyph, scale)


def overview(
    glyphs: Sequence[Glyph], scale: float, heading: str, combs: Combs = "both", *, in_corners: bool = False
) -> Any:
    """A page of combs as a matplotlib figure, on one pair of axes: ten times as fast as one pair per glyph."""
    figure = headed(heading, next((glyph.options.words for glyph in glyphs if isinstance(glyph, GlyphResult)), ""))
    axes = figure.add_axes((0.04, 0.085, 0.92, 0.865))
    axes.set(xlim=(0, COLUMNS * CELL), ylim=(-ROWS * CELL, 0), aspect="equal")
    axes.set_axis_off()
    outlines, drawn, of_source, whose = list[FloatArray](), list[Teeth](), list[Teeth](), shown_by(combs)
    for index, glyph in enumerate(glyphs):
        corner = np.array([CELL * (index % COLUMNS), -CELL * (index // COLUMNS)])
        if isinstance(glyph, GlyphResult):
            place = _placed(glyph, corner)
            shown = [c.curve if whose == "result" else c.source for c in glyph.contours]
            outlines += [place(curve.cubics().reshape(-1, 2)).reshape(-1, 4, 2) for curve in shown]
            drawn += [t.placed(place) for t in teeth(glyph, scale, whose, in_corners=in_corners)]
            of_source += [t.placed(place) for t in teeth(glyph, scale, "source")] if combs == "both" else []
            words = glyph_label(glyph.outline)
        else:
            words = f"{glyph[0]}: {glyph[1]}"[:60]
        x, y = corner[0] + 0.04, corner[1] - CELL + 0.03
        axes.text(x, y, ascii_text(words), fontsize=6, color="0.35", parse_math=False)
    _draw(axes, outlines, drawn)
    for line in comb_patches(of_source)[-1:]:
        line.set(edgecolor=SOURCE, alpha=1.0, linewidth=0.4, linestyle=(0, (4, 2)))
        axes.add_patch(line)
    em = next((g.outline.metrics.units_per_em for g in glyphs if isinstance(g, GlyphResult)), 1000.0)
    words = legend(combs, sum(int(t.cut.sum()) for t in drawn), scale * em)
    colour_legend(figure, (0.3, 0.05, 0.4, 0.012), scale * em, words)
    return figure


def profile(glyph: GlyphResult, scale: float) -> Any:
    """One glyph: the source with its breaks, the result, and κ(s) of its longest contours, as a figure."""
    em = glyph.outline.metrics.units_per_em
    figure = headed(glyph_label(glyph.outline), glyph.options.words)
    # Maximum number of contours of a glyph whose κ(s) is drawn, the longest first.
    lengths = [float(np.hypot(*np.diff(c.source.points, axis=0).T).sum()) for c in glyph.contours]
    longest = sorted(range(len(lengths)), key=lambda k: -lengths[k])[:4]
    grid = figure.add_gridspec(
        1 + len(longest), 2, left=0.09, right=0.96, top=0.94, bottom=0.09, hspace=0.35, wspace=0.08,
        height_ratios=[2.2] + [1] * len(longest),
    )  # fmt: skip
    sides = ink_sides(glyph.arrays.source)
    for column, title in enumerate(("source", "result")):
        axes = figure.add_subplot(grid[0, column])
        shown = [c.source if title == "source" else c.curve for c in glyph.contours]
        _draw(axes, [curve.cubics() for curve in shown], teeth(glyph, scale, "source" if column == 0 else "result"))
        axes.autoscale_view()
        axes.set_aspect("equal")
        axes.set_axis_off()
        axes.set_title(title, fontsize=9)
        if column == 0:
            _mark_breaks(axes, glyph, scale)
    for row, index in enumerate(longest):
        _draw_profile(figure.add_subplot(grid[1 + row, :]), glyph.contours[index], index, sides[index], scale, em)
    colour_legend(figure, (0.3, 0.035, 0.4, 0.01), scale * em)
    return figure


def _placed(glyph: GlyphResult, corner: FloatArray) -> Callable[[FloatArray], FloatArray]:
    """The map from font units to the cell with the given upper left corner, in em."""
    metrics, em = glyph.outline.metrics, glyph.outline.metrics.units_per_em
    middle = np.array([glyph.outline.advance / 2, (metrics.ascender + metrics.descender) / 2])
    centre = corner + np.array([CELL / 2, -CELL / 2])
    return lambda points: (points - middle) / em + centre


def _draw(axes: Any, curves: Sequence[FloatArray], drawn: Sequence[Teeth]) -> None:
    for patch in [*outline_patch(curves, **OUTLINE), *comb_patches(drawn)]:
        axes.add_patch(patch)
    ends = [part.tips[part.cut] for part in drawn if part.cut.any()]
    if ends:
        axes.plot(*np.concatenate(ends).T, "k.", markersize=0.8, markeredgewidth=0)


def _mark_breaks(axes: Any, glyph: GlyphResult, scale: float) -> None:
    found = [joins(contour.source) for contour in glyph.contours]
    for kind, (marker, colour, label) in MARKS.items():
        points = [point for own in found for point in own.points[own.of(kind, JUMP * scale)]]
        if points:
            axes.plot(*np.array(points).T, marker, color=colour, markersize=3, label=f"{label}: {len(points)}",
                      linestyle="none", markeredgewidth=0)  # fmt: skip
    if axes.get_legend_handles_labels()[0]:
        axes.legend(fontsize=6, loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=3, frameon=False)


def _draw_profile(axes: Any, contour: ContourResult, index: int, side: float, scale: float, em: float) -> None:
    """κ over arc length of the source, its breaks, and the result, from the same point; positive where it is convex."""
    source, result = (comb(c.cubics(), SPACING * em / 2) for c in (contour.source, contour.curve))
    s, total = _arc_length(source)
    t, length = _arc_length(result)
    start = s[np.argmin(np.hypot(*(source.points - result.points[0]).T))]
    t = (start + t * total / length) % total
    order = np.argsort(t, kind="stable")
    limit = 2 * LONGEST * scale * em
    axes.axhspan(-scale * em, scale * em, color="0.96", zorder=0)
    axes.plot(s / em, np.clip(side * source.curvature * em, -limit, limit), color=SOURCE, linewidth=0.9, label="source")
    curvature = np.clip(side * result.curvature * em, -limit, limit)[order]
    axes.plot(t[order] / em, curvature, color="black", linewidth=0.8, label="result")
    found = joins(contour.source)
    at = s[source.pieces[:-1]]
    for kind, (marker, colour, _) in MARKS.items():
        where = at[found.of(kind, JUMP * scale)] / em
        axes.plot(where, np.full(len(where), -0.95 * limit), marker, color=colour, markersize=3, linestyle="none")
    axes.set(xlim=(0, total / em), ylim=(-limit, limit))
    axes.set_ylabel(f"contour {index}\nκ in 1/em", fontsize=6)
    axes.tick_params(labelsize=6)
    axes.set_xlabel("arc length in em", fontsize=6, labelpad=1)
    axes.legend(fontsize=6, loc="upper right", frameon=False, ncols=2)


def _arc_length(item: Comb) -> tuple[FloatArray, float]:
    """Arc length from the first sample to each, and the total."""
    s = np.concatenate([[0.0], np.cumsum((item.weights[:-1] + item.weights[1:]) / 2)])
    return s, max(float(s[-1]), 1e-12)
