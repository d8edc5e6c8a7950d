"""The curvature atlas of a font: a PDF with every glyph's comb on one scale, and κ(s) of chosen glyphs' contours."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import islice
from pathlib import Path as FilePath
from typing import Any

import numpy as np

from ...curves.curvature import Comb, comb
from ...fitting.results import ContourResult, GlyphResult
from ...outlines.joins import KINDS, joins
from ...outlines.outline import Contour
from ...types import FloatArray
from ..svg.colours import SIDES, class_colour
from ..svg.curvature_map import LONGEST, SPACING, Teeth, curvature_scale, teeth
from .patches import comb_patches, outline_patch

PAGE = (8.27, 11.69)
"""A4 in inches."""

COLUMNS, ROWS = 3, 4
"""Glyphs on a page. With more, the teeth of a CJK glyph are no longer told apart in print."""

CELL = 1.3
"""Room for a glyph in em: itself and its comb."""

PROFILES = 4
"""Contours of a glyph whose κ(s) is drawn, the longest first."""

JUMP = 0.25
"""Jump of curvature, in units of the scale, that is marked as a break: half a colour class and more."""

MARKS = {"corner": ("s", "#d6336c"), "G1": ("^", "#e8590c"), "G2": ("o", "#1098ad")}
WORDS = {"corner": "corners", "G1": "tangent breaks (G1)", "G2": "curvature jumps (G2)"}
SOURCE = "#e8590c"

Glyph = GlyphResult | tuple[str, str]
"""A result, or the name of a glyph that has none and why."""


def write_atlas(
    path: FilePath,
    glyphs: Iterable[Glyph],
    scale: float,
    *,
    heading: str,
    profiled: Callable[[GlyphResult], bool] = lambda glyph: False,
) -> int:
    """Write the atlas; the same glyphs give the same bytes.

    Args:
        path: the PDF, replaced when it is whole.
        glyphs: results in the order of the pages; one page of them is held at a time, and those profiled.
        scale: curvature in 1/unit of a full tooth, as :func:`..svg.curvature_map.curvature_scale` gives it.
        heading: the font's name.
        profiled: which glyphs get a page of their own, after the others.

    Returns:
        The number of pages.
    """
    from matplotlib.backends.backend_pdf import PdfPages

    nothing = {"CreationDate": None, "Producer": None, "Creator": None}
    partial = path.with_name(f".{path.name}.part")
    chosen: list[GlyphResult] = []
    rest = iter(glyphs)
    count = 0
    try:
        with PdfPages(partial, metadata=nothing) as pages:
            while part := list(islice(rest, COLUMNS * ROWS)):
                count += 1
                pages.savefig(overview(part, scale, f"{heading}, page {count}"))
                chosen += [glyph for glyph in part if isinstance(glyph, GlyphResult) and profiled(glyph)]
            for glyph in chosen:
                count += 1
                pages.savefig(profile(glyph, scale))
        partial.replace(path)
    finally:
        partial.unlink(missing_ok=True)
    return count


def overview(glyphs: Sequence[Glyph], scale: float, heading: str) -> Any:
    """A page of combs as a matplotlib figure: one drawing for them all, which is ten times as fast as one each."""
    figure = _figure(heading)
    axes = figure.add_axes((0.04, 0.085, 0.92, 0.865))
    axes.set(xlim=(0, COLUMNS * CELL), ylim=(-ROWS * CELL, 0), aspect="equal")
    axes.set_axis_off()
    outlines, drawn = [], []
    for index, glyph in enumerate(glyphs):
        corner = np.array([CELL * (index % COLUMNS), -CELL * (index // COLUMNS)])
        if isinstance(glyph, GlyphResult):
            place = _placed(glyph, corner)
            outlines += [place(c.curve.cubics().reshape(-1, 2)).reshape(-1, 4, 2) for c in glyph.contours]
            drawn += [Teeth(place(t.feet), place(t.tips), t.relative, t.cut) for t in teeth(glyph, scale)]
            words = _name(glyph)
        else:
            words = f"{glyph[0]}: {glyph[1]}"[:60]
        axes.text(corner[0] + 0.04, corner[1] - CELL + 0.03, _ascii(words), fontsize=6, color="0.35", parse_math=False)
    _draw(axes, outlines, drawn)
    em = next((g.outline.metrics.units_per_em for g in glyphs if isinstance(g, GlyphResult)), 1000.0)
    _legend(figure, (0.3, 0.05, 0.4, 0.012), scale * em)
    return figure


def profile(glyph: GlyphResult, scale: float) -> Any:
    """One glyph: the source with its breaks, the spline, and κ(s) of its longest contours, as a figure."""
    em = glyph.outline.metrics.units_per_em
    figure = _figure(_name(glyph))
    contours = sorted(glyph.contours, key=lambda c: -_length(c.source))[:PROFILES]
    grid = figure.add_gridspec(
        1 + len(contours), 2, left=0.09, right=0.96, top=0.94, bottom=0.09, hspace=0.35, wspace=0.08,
        height_ratios=[2.2] + [1] * len(contours),
    )  # fmt: skip
    sources = [ContourResult(c.source, c.polygon, (), c.source, c.measures) for c in glyph.contours]
    as_read = GlyphResult(glyph.outline, glyph.options, tuple(sources))
    for column, (shown, title) in enumerate([(as_read, "source"), (glyph, "spline")]):
        axes = figure.add_subplot(grid[0, column])
        _draw(axes, [c.curve.cubics() for c in shown.contours], teeth(shown, scale))
        axes.autoscale_view()
        axes.set_aspect("equal")
        axes.set_axis_off()
        axes.set_title(title, fontsize=9)
        if column == 0:
            _mark_breaks(axes, glyph, scale)
    for row, contour in enumerate(contours):
        index = next(k for k, other in enumerate(glyph.contours) if other is contour)
        _draw_profile(figure.add_subplot(grid[1 + row, :]), contour, index, scale, em)
    _legend(figure, (0.3, 0.035, 0.4, 0.01), scale * em)
    return figure


def _figure(heading: str) -> Any:
    from matplotlib.figure import Figure

    figure = Figure(figsize=PAGE)
    figure.text(0.05, 0.967, _ascii(heading), fontsize=11, weight="bold", parse_math=False)
    return figure


def _placed(glyph: GlyphResult, corner: FloatArray) -> Callable[[FloatArray], FloatArray]:
    """From font units to a cell, whose upper left corner is given, in em."""
    metrics, em = glyph.outline.metrics, glyph.outline.metrics.units_per_em
    middle = np.array([glyph.outline.advance / 2, (metrics.ascender + metrics.descender) / 2])
    centre = corner + np.array([CELL / 2, -CELL / 2])
    return lambda points: (points - middle) / em + centre


def _draw(axes: Any, curves: Sequence[FloatArray], drawn: Sequence[Teeth]) -> None:
    patch = outline_patch(curves, facecolor="0.93", edgecolor="black", linewidth=0.5)
    for each in [patch, *comb_patches(drawn)]:
        if each is not None:
            axes.add_patch(each)


def _breaks(contour: Contour, scale: float) -> Iterator[tuple[str, FloatArray]]:
    found = joins(contour)
    for kind in KINDS:
        yield kind, found.points[found.of(kind, JUMP * scale)]


def _mark_breaks(axes: Any, glyph: GlyphResult, scale: float) -> None:
    for kind in KINDS:
        points = [p for c in glyph.contours for k, part in _breaks(c.source, scale) if k == kind for p in part]
        if points:
            marker, colour = MARKS[kind]
            axes.plot(*np.array(points).T, marker, color=colour, markersize=3, label=f"{WORDS[kind]}: {len(points)}",
                      linestyle="none", markeredgewidth=0)  # fmt: skip
    if axes.get_legend_handles_labels()[0]:
        axes.legend(fontsize=6, loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=3, frameon=False)


def _draw_profile(axes: Any, contour: ContourResult, index: int, scale: float, em: float) -> None:
    """κ over arc length: the source, its breaks, and the spline, from the same point on."""
    source, spline = (comb(c.cubics(), SPACING * em / 2) for c in (contour.source, contour.curve))
    s, total = _arc_length(source)
    t, length = _arc_length(spline)
    start = s[np.argmin(np.hypot(*(source.points - spline.points[0]).T))]
    t = (start + t * total / length) % total
    order = np.argsort(t, kind="stable")
    limit = 2 * LONGEST * scale * em
    axes.axhspan(-scale * em, scale * em, color="0.96", zorder=0)
    axes.plot(s / em, np.clip(source.curvature * em, -limit, limit), color=SOURCE, linewidth=0.9, label="source")
    axes.plot(
        t[order] / em,
        np.clip(spline.curvature * em, -limit, limit)[order],
        color="black",
        linewidth=0.8,
        label="spline",
    )
    found = joins(contour.source)
    at = s[source.pieces[:-1]]
    for kind in KINDS:
        marker, colour = MARKS[kind]
        where = at[found.of(kind, JUMP * scale)] / em
        axes.plot(where, np.full(len(where), -0.95 * limit), marker, color=colour, markersize=3, linestyle="none")
    axes.set(xlim=(0, total / em), ylim=(-limit, limit))
    axes.set_ylabel(f"contour {index}\nκ in 1/em", fontsize=6)
    axes.tick_params(labelsize=6)
    axes.set_xlabel("arc length in em", fontsize=6, labelpad=1)
    axes.legend(fontsize=6, loc="upper right", frameon=False, ncols=2)


def _arc_length(item: Comb) -> tuple[FloatArray, float]:
    """Arc length from the first sample to each, and of the whole."""
    s = np.concatenate([[0.0], np.cumsum((item.weights[:-1] + item.weights[1:]) / 2)])
    return s, max(float(s[-1]), 1e-12)


def _length(contour: Contour) -> float:
    return float(np.hypot(*np.diff(contour.points, axis=0).T).sum())


def _legend(figure: Any, place: tuple[float, float, float, float], reach: float) -> None:
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import ListedColormap, Normalize

    colours = ListedColormap([class_colour(index) for index in range(-SIDES, SIDES + 1)])
    bar = figure.colorbar(
        ScalarMappable(Normalize(-reach, reach), colours), cax=figure.add_axes(place), orientation="horizontal"
    )
    bar.set_label("curvature in 1/em, left turns positive", fontsize=6)
    bar.ax.tick_params(labelsize=6)


def _name(glyph: GlyphResult) -> str:
    codes = " ".join(f"U+{code:04X}" for code in glyph.outline.unicodes[:2])
    return f"gid {glyph.outline.gid}  {glyph.outline.name[:40]}  {codes}"


def _ascii(words: str) -> str:
    """What the PDF's own letters can show; others would need the font itself."""
    return words.encode("ascii", "replace").decode()


__all__ = ["curvature_scale", "overview", "profile", "write_atlas"]
