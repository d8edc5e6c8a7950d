"""Figs. 6 and 7: curvature maps of two polygons with sharp turns and uneven chords."""

from __future__ import annotations

import json

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

import glyphspline as gs
from glyphspline.types import FloatArray

from .clicking import DATA
from .common import GREY, INK, Run, bare, draw_closed, letter
from .curves import VARIANTS, Box, colour, draw_comb, interpolate_variants, mark, zoomed
from .fairness import relative_to, result_quality

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
        values = {f"variant {v}": result_quality(results[v], polygon) for v in VARIANTS}
        fair = {v: q["∫(dκ/ds)² ds"] for v, q in values.items()}
        worst = max(fair, key=lambda v: fair[v])
        alike = all(abs(r - 1) < 0.1 for r in relative_to(values, "variant 2")["variant 1"].values() if r)
        run.claim(
            f"{name}-curvature",
            source,
            "Curvature maps of variants 1 and 2 are very close; variant 3 gives the worst quality.",
            "shown as a picture",
            values,
            "reproduced" if worst == "variant 3" and alike else "not decidable",
            "A polygon of our own, as the paper does not list its vertices, and “worst” is not defined: the paper is "
            "reproduced where ∫(dκ/ds)² ds agrees with it, and where that integral does not, nothing is decided. "
            + SEEN[name],
            "fig6",
        )
        run.save(_picture(polygon, box, results), name)


def _picture(polygon: FloatArray, box: Box, results: dict[int, gs.Interpolation]) -> Figure:
    figure, axes = plt.subplots(2, 4, figsize=(9.6, 5.0), layout="constrained", height_ratios=(1, 0.9))
    for column, v in enumerate(VARIANTS):
        above, below = axes[:, column]
        for ax in (above, below):
            draw_comb(ax, results[v].spline, colour(v), COMB, LONGEST, SPACING)
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
