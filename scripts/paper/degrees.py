"""Degrees 2 to 6 on the polygons of Section 4: the paper says its approach applies, and shows cubics only."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from glyphspline.curves.bspline import DEGREES

from .common import MARKERS, Run, random_polygons
from .study import Group, mean_iterations, study_group
from .thresholds import SHADES

COUNT = {"Remark 3": 200, "peak": 200}
"""Polygons a group for each rule."""


def degrees(run: Run) -> None:
    """Variant 2 of every degree, with the paper's rule and with ``fallback="peak"``."""
    rules = {"Remark 3": "knot", "peak": "peak"}
    groups: dict[str, dict[str, dict[int, Group]]] = {rule: {} for rule in rules}
    for rule, fallback in rules.items():
        for d in DEGREES:
            groups[rule][f"degree {d}"] = {
                n: study_group(random_polygons(n, run.size(COUNT[rule], 1)), 2, degree=d, fallback=fallback)
                for n in (run.groups if not run.quick else (5,))
            }
    paper, peak = COUNT.values()
    run.claim(
        "beyond-degrees",
        "Section 1",
        "The approach also applies to degrees 2 to 6, whose uniform basis functions rise above 1/2.",
        "said, not shown",
        {
            "not converged": {
                rule: {d: sum(int((~g.converged).sum()) for g in by_n.values()) for d, by_n in table.items()}
                for rule, table in groups.items()
            },
            "vertices without an interval, %": {
                d: 100 * sum(g.fallbacks for g in by_n.values()) / sum(n * len(g.iterations) for n, g in by_n.items())
                for d, by_n in groups["Remark 3"].items()
            },
            "mean iterations, Remark 3": {d: mean_iterations(by_n) for d, by_n in groups["Remark 3"].items()},
            "mean iterations, peak": {d: mean_iterations(by_n) for d, by_n in groups["peak"].items()},
        },
        "reproduced" if _fails(groups["Remark 3"]) == 0 else "differs",
        f"Knots are midpoints for even degrees. {paper} polygons of each group with the paper's rule, "
        f"{peak} with the other. The higher the degree the more vertices lack an interval (see R*, r*) and rest on "
        "the fallback.",
        "degrees",
    )
    run.save(_picture(groups, run), "degrees", svg=True)


def _fails(table: dict[str, dict[int, Group]]) -> int:
    return sum(int((~g.converged).sum()) for by_n in table.values() for g in by_n.values())


def _picture(groups: dict[str, dict[str, dict[int, Group]]], run: Run) -> Figure:
    figure, axes = plt.subplots(1, 2, figsize=(7.4, 2.9), layout="constrained", sharey=True)
    for ax, (rule, table) in zip(axes, groups.items(), strict=True):
        for (name, by_n), marker in zip(table.items(), MARKERS.values(), strict=True):
            share = [100 * float(np.mean(g.converged)) for g in by_n.values()]
            ax.plot(list(by_n), share, color=SHADES[int(name[-1])], marker=marker, label=name)
        ax.set(title=f"fallback: {rule}", xlabel="vertices", ylim=(0, 104), xticks=run.groups[::2])
    axes[0].set_ylabel("converged, %")
    axes[0].legend(fontsize=7.5)
    return figure
