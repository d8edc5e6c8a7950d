"""Fig. 2: the share of polygons on which variant 0 converges."""

from __future__ import annotations

import matplotlib.pyplot as plt
from matplotlib.figure import Figure

from .common import COLOURS, INK, Run, verdict
from .study import share_converged, study


def figure_2(run: Run) -> None:
    """Bars of the share, and the claims on convergence of Section 4.1."""
    shares = {f"variant {v}": share_converged(study(run, v)) for v in (0, 1, 2, 3, 4)}
    above_40 = [s for n, s in shares["variant 0"].items() if int(n) > 40]
    run.claim(
        "fig-2-variant-0-share",
        "Fig. 2",
        "With the whole support allowed (variant 0) almost no polygon of more than 40 vertices converges.",
        "share in percent falls with the number of vertices, to almost none above 40",
        shares,
        verdict(max(above_40, default=0.0) <= 5),
        "Percent of polygons below 1e-6 within 1000 iterations, for all variants.",
        "fig2",
    )
    others = {f"variant {v}": sum(int((~g.converged).sum()) for g in study(run, v).values()) for v in (1, 2, 3, 4)}
    run.claim(
        "section-4.1-all-converge",
        "Section 4.1",
        "Variants 1 to 4 converge on all of the 2200 polygons.",
        "0 failures",
        others,
        verdict(not any(others.values())),
        "Number of polygons that are not below 1e-6 after 1000 iterations. A polygon of variant 3 among them is slow, "
        "not divergent: fixed parameters make a linear iteration, whose rate may come near 1 on uneven chords.",
        "fig2",
    )
    run.save(_picture(shares["variant 0"]), "fig-2", svg=True)


def _picture(share: dict[str, float]) -> Figure:
    figure, axes = plt.subplots(figsize=(5.2, 2.6), layout="constrained")
    bars = axes.bar(list(share), list(share.values()), width=0.62, color=COLOURS["variant 0"], alpha=0.85)
    axes.bar_label(bars, [f"{s:.3g}" for s in share.values()], fontsize=7.5, padding=1.5, color=INK)
    axes.set(ylim=(0, 100), xlabel="vertices", ylabel="variant 0 converges, %")
    axes.grid(axis="x", visible=False)
    return figure
