"""Figs. 8 and 9: the characters 'Dragon' and 'Good', from clicked polygons."""

from __future__ import annotations

import json
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib import font_manager
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Outline

import glyphspline as gs
from glyphspline.types import FloatArray

from .clicking import CHARACTERS, DATA, FONTS, clicked_character, load_polygons, source_contours
from .common import GREY, INK, Run, bare, draw_closed, letter, verdict
from .curves import VARIANTS, Box, colour, interpolate_variants, mark, zoomed
from .fairness import result_bulge

FIGURES = {"fig-8": ("dragon", "Fig. 8", "STXingkai"), "fig-9": ("good", "Fig. 9", "STLiti")}
ZOOM = 0.2
"""Side of the zoomed part, in em."""


def figures_8_and_9(run: Run) -> None:
    """Both pictures, and how far each variant overshoots."""
    for name, (stem, source, family) in FIGURES.items():
        character = CHARACTERS[stem][0]
        given = run.fonts.get(name) or _installed(family)
        data = clicked_character(given, character) if given else json.loads((DATA / f"{stem}.json").read_text("utf-8"))
        polygons, em = load_polygons(data), float(data["units_per_em"])
        results = interpolate_variants(polygons, em * 1e-7)
        beyond = {
            v: [1000 * result_bulge(r, p) / em for r, p in zip(results[v], polygons, strict=True)] for v in VARIANTS
        }
        splines = {v: [r.spline for r in results[v]] for v in VARIANTS}
        far = {f"variant {v}": {"largest": max(b), "mean of contours": float(np.mean(b))} for v, b in beyond.items()}
        run.claim(
            f"{name}-overshoot",
            source,
            f"On {character} the results of variants 1 and 2 look nice; variant 3 overshoots at some corners.",
            "shown as a picture",
            {"vertices": sum(len(p) for p in polygons), "contours": len(polygons), **far},
            verdict(far["variant 3"]["largest"] > 1.2 * max(far[f"variant {v}"]["largest"] for v in (1, 2))),
            f"Largest distance of a span from its chord, in 1/1000 em. Polygon clicked around {data['face']}; the "
            f"paper used {'Huawen Xingkai' if stem == 'dragon' else 'Huawen Lishu'}, which is not free.",
            "fig8",
        )
        contours = source_contours(given or FONTS / CHARACTERS[stem][1], character)
        run.save(_picture(contours, polygons, splines, _worst_place(polygons, splines, em)), name)


def _installed(family: str) -> Path | None:
    """The paper's face, if this machine has it."""
    return next((Path(f) for f in sorted(font_manager.findSystemFonts()) if family.lower() in f.lower()), None)


def _worst_place(polygons: list[FloatArray], splines: dict[int, list[gs.Spline]], em: float) -> Box:
    """The box around the place where variants 2 and 3 lie farthest apart."""
    best, centre = -1.0, np.zeros(2)
    for two, three in zip(splines[2], splines[3], strict=True):
        t = (two.knots[:-1] + two.knots[1:]) / 2
        gap = np.hypot(*(two(t) - three(t)).T)
        if gap.max() > best:
            best, centre = float(gap.max()), three(t)[np.argmax(gap)]
    half = ZOOM * em / 2
    return centre[0] - half, centre[0] + half, centre[1] - half, centre[1] + half


def _fill(axes: Axes, outlines: list[FloatArray], shade: str, edge: str) -> None:
    """Contours as one filled path, holes left out."""
    path = Outline.make_compound_path(*(Outline(np.concatenate([o, o[:1]]), closed=True) for o in outlines))
    axes.add_patch(PathPatch(path, facecolor=shade, edgecolor=edge, lw=0.8))
    axes.autoscale_view()


def _picture(
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
            _fill(ax, curves, "#eef1f4", colour(v))
            ax.patches[0].set_linewidth(width)
        for p in polygons:
            draw_closed(below, p, color=GREY, lw=0.6, ls=(0, (3, 2)), marker="o", ms=3.2, mfc=INK, mec=INK)
        mark(above, box)
        bare(above)
        letter(above, f"({'cde'[k]}) variant {v}")
        zoomed(below, box)
    return figure
