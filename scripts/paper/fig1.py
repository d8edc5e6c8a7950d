"""Fig. 1: how often the peak of a random basis function is not above 1/2."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from .certified import peak_values
from .common import COLOURS, INK, SEED, Run, verdict

COUNT = 10_000
SEEDS = range(SEED, SEED + 12)
PAPER_FAILURES, PAPER_RATIO = 25, 16


def draw_maxima(seed: int, count: int = COUNT) -> tuple[np.ndarray, np.ndarray]:
    """Peak, and ratio of the longest to the shortest interval, of ``count`` random five-knot vectors.

    The paper does not say how it draws. Four intervals uniform in (0, 1) give counts like its own; five sorted
    uniform knots give some ten times as many.
    """
    h = np.random.default_rng(seed).uniform(0, 1, (count, 4))
    return peak_values(h), h.max(axis=1) / h.min(axis=1)


def figure_1(run: Run) -> None:
    """Scatter of the maxima, and the claims about it."""
    maxima, ratios = draw_maxima(SEED, run.size(COUNT, 2000))
    failed = maxima <= 0.5
    samples = [draw_maxima(seed, len(maxima)) for seed in list(SEEDS)[: run.size(12, 3)]]
    counts = [int((m <= 0.5).sum()) for m, _ in samples]
    smallest = [float(r[m <= 0.5].min()) for m, r in samples if (m <= 0.5).any()]
    knots = np.sort(np.random.default_rng(SEED).uniform(0, 1, (len(maxima), 5)), axis=1)
    sorted_failures = int((peak_values(np.diff(knots, axis=1)) <= 0.5).sum())

    run.claim(
        "fig-1-failures",
        "Fig. 1",
        "Of 10,000 random basis functions only a handful have no value above 1/2.",
        f"{PAPER_FAILURES} of 10,000",
        int(failed.sum()),
        verdict(run.quick or min(counts) <= PAPER_FAILURES <= max(counts)),
        f"{len(maxima)} vectors of four intervals drawn uniformly from (0, 1); the paper's count lies within "
        "what other seeds give. How the paper drew is not said: five sorted uniform knots give far more.",
    )
    run.claim(
        "fig-1-seeds",
        "Fig. 1",
        "The count is one sample of a rare event.",
        f"{PAPER_FAILURES}",
        {"fewest": min(counts), "most": max(counts), "seeds": len(counts), "sorted knots instead": sorted_failures},
        verdict(run.quick or min(counts) <= PAPER_FAILURES <= max(counts)),
        "Consecutive seeds; the last entry is the count when five sorted uniform knots are drawn instead.",
    )
    run.claim(
        "fig-1-ratio",
        "Fig. 1",
        "Failures have a ratio of longest to shortest knot interval above 16.",
        f"> {PAPER_RATIO}",
        {"smallest ratio, this sample": ratios[failed].min(initial=np.inf), "least of all seeds": min(smallest)},
        verdict(min(smallest) > PAPER_RATIO),
        "“Above 16” is the luck of one sample. The true threshold is R* of claim beyond-thresholds.",
    )
    run.save(_picture(maxima, failed), "fig-1")


def _picture(maxima: np.ndarray, failed: np.ndarray) -> Figure:
    figure, axes = plt.subplots(figsize=(6.4, 2.6), layout="constrained")
    index = np.arange(1, len(maxima) + 1)
    axes.plot(index[~failed], maxima[~failed], ".", color=COLOURS["variant 1"], ms=1.2, alpha=0.6, rasterized=True)
    axes.plot(
        index[failed], maxima[failed], "+", color=COLOURS["variant 0"], ms=6, mew=1.1, label=f"≤ 1/2: {failed.sum()}"
    )
    axes.axhline(0.5, color=INK, lw=0.6)
    axes.set(xlim=(0, len(maxima)), ylim=(0.4, 1.0), xlabel="basis function", ylabel="maximum")
    axes.legend(loc="upper right", bbox_to_anchor=(1, 1.12))
    axes.grid(axis="x", visible=False)
    return figure
