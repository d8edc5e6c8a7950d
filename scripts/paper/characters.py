"""Figs. 6 to 9: curves of variants 1, 2 and 3 side by side, on two polygons and on two characters."""

from __future__ import annotations

import json
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib import font_manager
from matplotlib.figure import Figure

import glyphspline as gs
from glyphspline.curves.curvature import comb
from glyphspline.plugins.experiments.style import (
    COLOURS,
    GREY,
    INK,
    Box,
    bare,
    draw_closed,
    draw_comb,
    letter,
    mark,
    zoomed,
)  # fmt: skip
from glyphspline.types import FloatArray

from .common import Run, verdict
from .faces import CHARACTERS, DATA, FONTS, Character
from .fairness import curve_of, quality, relative_to

VARIANTS = (1, 2, 3)

COMB, LONGEST, SPACING = 0.05, 1.0, 0.04
"""Length of a tooth for curvature 1, of the longest tooth, and from tooth to tooth, for polygons in [0, 5]²."""


def load(name: str) -> tuple[FloatArray, Box]:
    """A polygon and the part to zoom."""
    data = json.loads((DATA / f"{name}.json").read_text(encoding="utf-8"))
    return np.array(data["polygon"]), tuple(data["zoom"])


def figure_6(run: Run) -> None:
    """Curvature maps on a polygon with sharp turns."""
    seen = (
        "The picture shows what the paper says: variant 3 waves beside the turns and has a spike at the tip. Yet its "
        "integrals are the lower ones: they weigh the sharp turns alone, where variants 1 and 2 are a little sharper."
    )
    _on_polygon(run, "fig-6", "Fig. 6", seen)


def figure_7(run: Run) -> None:
    """The same on a hook with a spike."""
    seen = "Variants 1 and 2 are one curve here: no footpoint of either reaches an end of its interval."
    _on_polygon(run, "fig-7", "Fig. 7", seen)


def _on_polygon(run: Run, name: str, source: str, seen: str) -> None:
    """The picture and the comparison in numbers."""
    polygon, box = load(name)
    results = {v: gs.interpolate(polygon, v, residual_tolerance=1e-8) for v in VARIANTS}
    values = {f"variant {v}": quality(*curve_of(results[v]), polygon) for v in VARIANTS}
    fair = {v: q["∫(dκ/ds)² ds"] for v, q in values.items()}
    worst = max(fair, key=lambda v: fair[v])
    alike = all(abs(r - 1) < 0.1 for r in relative_to(values, "variant 2")["variant 1"].values() if r)
    said = "reproduced" if worst == "variant 3" and alike else "not decidable"
    run.claim(f"{name}-curvature", values, said, words="fig-6-and-7", source=source, more=seen)
    run.save(_maps(polygon, box, results), name)


def _maps(polygon: FloatArray, box: Box, results: dict[int, gs.Interpolation]) -> Figure:
    figure, axes = plt.subplots(2, 4, figsize=(9.6, 5.0), layout="constrained", height_ratios=(1, 0.9))
    for column, v in enumerate(VARIANTS):
        above, below = axes[:, column]
        teeth = comb(results[v].spline.to_bezier(), SPACING)
        for ax in (above, below):
            draw_comb(ax, teeth, COLOURS[f"variant {v}"], COMB, LONGEST)
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


def figure_8(run: Run) -> None:
    """'Dragon'."""
    _on_character(run, CHARACTERS[0])


def figure_9(run: Run) -> None:
    """'Good'."""
    _on_character(run, CHARACTERS[1])


def _on_character(run: Run, each: Character) -> None:
    """The picture, and how far each variant overshoots; of the paper's own face where that is given or installed."""
    installed = (Path(f) for f in sorted(font_manager.findSystemFonts()) if each.family.lower() in f.lower())
    given = run.fonts.get(each.name) or next(installed, None)
    font = gs.open_font(given or FONTS / f"{each.stem}.ttf")
    outline = font.outline(font.select(text=each.character)[0])
    made = gs.experiment(outline, VARIANTS, polygons=None if given else each.polygons(), peers=False)
    far = {}
    for v in VARIANTS:
        beyond = [row["bulge"] for row in made.rows if row["method"] == f"variant {v}"]
        far[f"variant {v}"] = {"largest": max(beyond), "mean of contours": float(np.mean(beyond))}
    measured = {"vertices": sum(map(len, made.polygons)), "contours": len(made.polygons), **far}
    run.claim(
        f"{each.name}-overshoot",
        measured,
        verdict(far["variant 3"]["largest"] > 1.2 * max(far[f"variant {v}"]["largest"] for v in (1, 2))),
        words="fig-8-and-9",
        source=each.source,
        character=each.character,
        face=font.family,
        theirs=each.theirs,
    )
    run.save(made.figure(f"{font.family} {font.style}"), each.name)
