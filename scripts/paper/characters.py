"""Figs. 6 to 9: curves of variants 1, 2 and 3 side by side, on two polygons and on two characters."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib import font_manager
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch, Rectangle
from matplotlib.path import Path as Outline

import glyphspline as gs
from glyphspline.curves.curvature import comb
from glyphspline.types import FloatArray

from .clicking import CHARACTERS, DATA, FONTS, clicked_character, source_contours
from .common import COLOURS, GREY, INK, Run, bare, draw_closed, letter, verdict
from .fairness import bulge, curve_of, quality, relative_to

VARIANTS = (1, 2, 3)
Box = tuple[float, float, float, float]
"""x from, x to, y from, y to."""


def interpolate_variants(polygons: Sequence[FloatArray], tolerance: float) -> dict[int, list[gs.Interpolation]]:
    """Variants 1, 2 and 3 through each polygon."""
    return {v: gs.interpolate_many(polygons, v, residual_tolerance=tolerance) for v in VARIANTS}


def draw_comb(axes: Axes, spline: gs.Spline, colour: str, scale: float, longest: float, spacing: float) -> None:
    """A curvature map: teeth of length ``scale`` |κ| on the convex side, cut at ``longest``, and their outline."""
    teeth = comb(spline.to_bezier(), spacing)
    ends = teeth.points - np.clip(scale * teeth.curvature, -longest, longest)[:, None] * teeth.normals
    lines = list(np.stack([teeth.points, ends], axis=1))
    axes.add_collection(LineCollection(lines, colors=colour, linewidths=0.35, alpha=0.55))
    axes.plot(*ends.T, color=colour, lw=0.6, alpha=0.9)
    axes.plot(*teeth.points.T, color=INK, lw=0.9)


def mark(axes: Axes, box: Box) -> None:
    """The dotted rectangle around what is zoomed."""
    x0, x1, y0, y1 = box
    axes.add_patch(Rectangle((x0, y0), x1 - x0, y1 - y0, fill=False, ls=(0, (1, 1.5)), lw=0.9, ec=INK, zorder=5))


def zoomed(axes: Axes, box: Box) -> None:
    """Show the box only, in a thin frame."""
    axes.set(xlim=box[:2], ylim=box[2:], xticks=[], yticks=[], aspect="equal")
    axes.grid(False)
    for side in axes.spines.values():
        side.set(visible=True, color=GREY, linestyle=(0, (1, 1.5)))


COMB, LONGEST, SPACING = 0.05, 1.0, 0.04
"""Length of a tooth for curvature 1, of the longest tooth, and from tooth to tooth, for polygons in [0, 5]²."""

SEEN = {
    "fig-6": "The picture shows what the paper says: variant 3 waves beside the turns and has a spike at the tip. Yet "
    "its integrals are the lower ones: they weigh the sharp turns alone, where variants 1 and 2 are a little sharper.",
    "fig-7": "Variants 1 and 2 are one curve here: no footpoint of either reaches an end of its interval.",
}


def load(name: str) -> tuple[FloatArray, Box]:
    """A polygon and the part to zoom."""
    data = json.loads((DATA / f"{name}.json").read_text(encoding="utf-8"))
    return np.array(data["polygon"]), tuple(data["zoom"])


def figures_6_and_7(run: Run) -> None:
    """Both pictures and the comparison in numbers."""
    for name, source in (("fig-6", "Fig. 6"), ("fig-7", "Fig. 7")):
        polygon, box = load(name)
        results = {v: r[0] for v, r in interpolate_variants([polygon], 1e-8).items()}
        values = {f"variant {v}": quality(*curve_of(results[v]), polygon) for v in VARIANTS}
        fair = {v: q["∫(dκ/ds)² ds"] for v, q in values.items()}
        worst = max(fair, key=lambda v: fair[v])
        alike = all(abs(r - 1) < 0.1 for r in relative_to(values, "variant 2")["variant 1"].values() if r)
        run.claim(
            f"{name}-curvature",
            values,
            "reproduced" if worst == "variant 3" and alike else "not decidable",
            words="fig-6-and-7",
            source=source,
            more=SEEN[name],
        )
        run.save(_maps(polygon, box, results), name)


def _maps(polygon: FloatArray, box: Box, results: dict[int, gs.Interpolation]) -> Figure:
    figure, axes = plt.subplots(2, 4, figsize=(9.6, 5.0), layout="constrained", height_ratios=(1, 0.9))
    for column, v in enumerate(VARIANTS):
        above, below = axes[:, column]
        for ax in (above, below):
            draw_comb(ax, results[v].spline, COLOURS[f"variant {v}"], COMB, LONGEST, SPACING)
            ax.plot(*polygon.T, "o", color=INK, ms=1.8 if ax is above else 3)
        mark(above, box)
        bare(above)
        above.set(xlim=(-0.6, 5.8), ylim=(-0.6, 5.6))
        letter(above, f"({'abc'[column]}) variant {v}")
        zoomed(below, box)
    draw_closed(axes[0, 3], polygon, color=INK, lw=0.8, marker="o", ms=2.5)
    bare(axes[0, 3])
    axes[0, 3].set(xlim=(-0.6, 5.8), ylim=(-0.6, 5.6))
    letter(axes[0, 3], "(d) polygon")
    axes[1, 3].axis("off")
    axes[1, 3].text(
        0.05, 0.9, f"teeth: {COMB:g} × curvature,\ncut at length {LONGEST:g}", va="top", color=GREY, fontsize=8
    )
    return figure


FIGURES = {"fig-8": ("dragon", "Fig. 8", "STXingkai"), "fig-9": ("good", "Fig. 9", "STLiti")}


def figures_8_and_9(run: Run) -> None:
    """Both pictures, and how far each variant overshoots."""
    for name, (stem, source, family) in FIGURES.items():
        character = CHARACTERS[stem][0]
        installed = (Path(f) for f in sorted(font_manager.findSystemFonts()) if family.lower() in f.lower())
        given = run.fonts.get(name) or next(installed, None)
        data = clicked_character(given, character) if given else json.loads((DATA / f"{stem}.json").read_text("utf-8"))
        polygons, em = [np.array(p) for p in data["polygons"]], float(data["units_per_em"])
        results = interpolate_variants(polygons, em * 1e-7)
        beyond = {
            v: [1000 * bulge(*curve_of(r), p) / em for r, p in zip(results[v], polygons, strict=True)] for v in VARIANTS
        }
        splines = {v: [r.spline for r in results[v]] for v in VARIANTS}
        far = {f"variant {v}": {"largest": max(b), "mean of contours": float(np.mean(b))} for v, b in beyond.items()}
        measured = {"vertices": sum(len(p) for p in polygons), "contours": len(polygons), **far}
        run.claim(
            f"{name}-overshoot",
            measured,
            verdict(far["variant 3"]["largest"] > 1.2 * max(far[f"variant {v}"]["largest"] for v in (1, 2))),
            words="fig-8-and-9",
            source=source,
            character=character,
            face=data["face"],
            theirs="Huawen Xingkai" if stem == "dragon" else "Huawen Lishu",
        )
        contours = source_contours(given or FONTS / CHARACTERS[stem][1], character)
        run.save(_character(contours, polygons, splines, _worst_place(polygons, splines, em)), name)


def _worst_place(polygons: list[FloatArray], splines: dict[int, list[gs.Spline]], em: float) -> Box:
    """The box around the place where variants 2 and 3 lie farthest apart."""
    best, centre = -1.0, np.zeros(2)
    for two, three in zip(splines[2], splines[3], strict=True):
        t = (two.knots[:-1] + two.knots[1:]) / 2
        gap = np.hypot(*(two(t) - three(t)).T)
        if gap.max() > best:
            best, centre = float(gap.max()), three(t)[np.argmax(gap)]
    half = 0.2 * em / 2  # of the side of the zoomed part
    return centre[0] - half, centre[0] + half, centre[1] - half, centre[1] + half


def _fill(axes: Axes, outlines: list[FloatArray], shade: str, edge: str) -> None:
    """Contours as one filled path, holes left out."""
    path = Outline.make_compound_path(*(Outline(np.concatenate([o, o[:1]]), closed=True) for o in outlines))
    axes.add_patch(PathPatch(path, facecolor=shade, edgecolor=edge, lw=0.8))
    axes.autoscale_view()


def _character(
    contours: list[FloatArray], polygons: list[FloatArray], splines: dict[int, list[gs.Spline]], box: Box
) -> Figure:
    figure = plt.figure(figsize=(7.2, 8.2), layout="constrained")
    grid = figure.add_gridspec(3, 6, height_ratios=(1.25, 1.0, 0.95))
    original, polygon = figure.add_subplot(grid[0, :3]), figure.add_subplot(grid[0, 3:])
    _fill(original, contours, INK, INK)
    for p in polygons:
        draw_closed(polygon, p, color=INK, lw=0.7, marker="o", ms=1.6)
    for ax, text in ((original, "(a) original"), (polygon, "(b) polygon")):
        bare(ax)
        letter(ax, text)
    for k, v in enumerate(VARIANTS):
        above, below = (figure.add_subplot(grid[row, 2 * k : 2 * k + 2]) for row in (1, 2))
        curves = [s(np.linspace(0, s.period, 24 * len(s.knots), endpoint=False)) for s in splines[v]]
        for ax, width in ((above, 0.8), (below, 1.3)):
            _fill(ax, curves, "#eef1f4", COLOURS[f"variant {v}"])
            ax.patches[0].set_linewidth(width)
        for p in polygons:
            draw_closed(below, p, color=GREY, lw=0.6, ls=(0, (3, 2)), marker="o", ms=3.2, mfc=INK, mec=INK)
        mark(above, box)
        bare(above)
        letter(above, f"({'cde'[k]}) variant {v}")
        zoomed(below, box)
    return figure
