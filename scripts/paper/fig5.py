"""Fig. 5: spectral radius of the composite matrix, the product of all (I - Bᵏ) so far, for variants 0 to 3."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from glyphspline.plugins.experiments.methods import CUT, composite_radii
from glyphspline.plugins.experiments.style import COLOURS, INK
from glyphspline.types import FloatArray

from .common import Run, verdict
from .study import TOLERANCE

COUNT = 60
"""Polygons a group: all 200 take over three times as long."""


def figure_5(run: Run) -> None:
    """Four panels, a curve a polygon, and what the paper says of them."""
    polygons = [p for group in run.polygons().values() for p in group[:COUNT]]
    curves: dict[int, list[FloatArray]] = {}
    for v in (0, 1, 2, 3):
        curves[v] = [composite_radii(p, v, TOLERANCE) for p in polygons]
    measured = {f"variant {v}": _summary(curves[v]) for v in curves}
    grown = [table["% of polygons at 1 or more in the end"] for table in measured.values()]
    _, one, two, three = (table["median iterations to 1e-3"] for table in measured.values())
    agrees = grown[0] > 50 and max(grown[1:]) == 0 and three > max(one, two)
    run.claim("fig-5-composite-radius", measured, verdict(agrees), count=COUNT, cut=CUT)
    run.save(_picture(curves), "fig-5")


def _summary(curves: list[FloatArray]) -> dict[str, float]:
    lasting = [c for c in curves if len(c)]
    fall = [int(np.argmax(c < 1e-3)) + 1 if (c < 1e-3).any() else len(c) + 1 for c in lasting]
    return {
        "largest first value": max(c[0] for c in lasting),
        "largest of all": max(c.max() for c in lasting),
        "% of polygons at 1 or more in the end": 100 * float(np.mean([c[-1] >= 1 for c in lasting])),
        "median iterations to 1e-3": float(np.median(fall)),
        "longest run": max(len(c) for c in lasting),
    }


def _picture(curves: dict[int, list[FloatArray]]) -> Figure:
    figure, axes = plt.subplots(2, 2, figsize=(7.4, 5.2), layout="constrained")
    for v, ax in zip(curves, axes.flat, strict=True):
        for c in curves[v]:
            ax.plot(np.arange(1, len(c) + 1), c, color=COLOURS[f"variant {v}"], lw=0.3, alpha=0.25, rasterized=True)
        ax.set_title(f"({'abcd'[v]}) variant {v}")
        ax.set_xlabel("iteration")
    axes[0, 0].set_yscale("log")
    axes[0, 0].set_ylim(1e-8, None)
    axes[0, 0].axhline(1, color=INK, lw=0.6)
    for ax in axes.flat[1:]:
        ax.set(ylim=(0, 1), xlim=(0, 60))
    axes.flat[3].set_xlim(0, 300)
    for ax in axes[:, 0]:
        ax.set_ylabel("spectral radius")
    return figure
