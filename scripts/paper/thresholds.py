"""The paper's open question: how uneven may knot intervals be while every basis function rises above 1/2?"""

from __future__ import annotations

import math
from collections.abc import Callable

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from .certified import Constraint, certify, peak_values, threshold, worst_corner
from .common import COLOURS, INK, Run

DEGREES = (3, 4, 5, 6)
SHADES = dict(zip((2, *DEGREES), ("#9aa5b1", *list(COLOURS.values())[1:]), strict=True))


def thresholds(run: Run) -> None:
    """R* and r* for degrees 2 to 6, the least peaks at small ratios, and a picture of both."""
    degrees = DEGREES[:1] if run.quick else DEGREES
    measured: dict[str, object] = {"degree 2": {"R*": "none", "r*": "none"}}
    for d in degrees:
        R, r = threshold(d, "box"), threshold(d, "adjacent")
        assert R is not None
        assert r is not None
        measured[f"degree {d}"] = {
            "R*": (R.low + R.high) / 2,
            "R* proven up to": _outward(R.low, math.floor),
            "R* refuted at": _outward(R.high, math.ceil),
            "R* worst intervals": [round(h / min(R.intervals), 5) for h in R.intervals],
            "r*": (r.low + r.high) / 2,
            "r* proven up to": _outward(r.low, math.floor),
            "r* refuted at": _outward(r.high, math.ceil),
            "r* worst intervals": [round(h / min(r.intervals), 5) for h in r.intervals],
            "boxes examined": R.boxes + r.boxes,
        }
    run.claim(
        "beyond-thresholds",
        "Section 5",
        "A condition on interval lengths under which every basis function rises above 1/2.",
        "open question",
        measured,
        "proven",
        "R*: all intervals of a basis function within this ratio of each other; r*: each interval within this ratio of "
        "its neighbours. “Proven up to” is the largest ratio for which the whole box was examined; “refuted at” has a "
        "counter-example, the worst intervals. Quadratic peaks always exceed 1/2.",
        "thresholds",
        digits=8,
    )
    _least_peaks(run)
    run.save(_picture(run.size(60, 8)), "thresholds", svg=True)


def _outward(ratio: float, rounding: Callable[[float], int]) -> float:
    """Seven digits, rounded away from the threshold, so that what is written is proven too."""
    unit = 10 ** (7 - math.floor(math.log10(ratio)) - 1)
    return rounding(ratio * unit) / unit


def _least_peaks(run: Run) -> None:
    measured = {}
    for ratio in (1.5, 2, 3, 4, 5, 6):
        least, _ = worst_corner(3, ratio, "adjacent")
        proven = least - 1e-6
        if certify(3, ratio, "adjacent", proven) is None:
            raise ArithmeticError(f"no proof for the least peak at ratio {ratio}")
        measured[str(ratio)] = {
            "least peak": proven,
            "largest margin c": proven - 0.5,
            "factor a step": 2 * (1 - proven),
        }
    infimum = 3 * (1 / 3) * (2 / 3) ** 2
    extreme = float(peak_values(np.array([[1e-9, 1.0, 1e6, 1e-9]]))[0])
    run.claim(
        "beyond-least-peaks",
        "Section 5",
        "What adjacent chords within a ratio certify before the iteration starts (cubics).",
        "not treated",
        {**measured, "without any bound": {"peak of a nearly degenerate case": extreme, "peak of 3x(1-x)²": infimum}},
        "proven",
        "Least peak proven for the ratio (less 1e-6), the margin c it allows, and the factor a step that Theorem 2 "
        "then gives. The last entry: where knots run together the basis function tends to the Bernstein polynomial "
        "3x(1-x)², whose peak is 4/9; lower peaks were not found.",
        "thresholds",
    )


def _picture(points: int) -> Figure:
    figure, axes = plt.subplots(1, 2, figsize=(7.4, 2.9), layout="constrained", sharey=True)
    panels: tuple[tuple[Constraint, str], ...] = (("box", "any two intervals"), ("adjacent", "adjacent intervals"))
    for ax, (constraint, label) in zip(axes, panels, strict=True):
        for d in DEGREES:
            ratios = np.geomspace(1, 16 if constraint == "box" else 9, points)
            least = [worst_corner(d, r, constraint)[0] for r in ratios]
            ax.plot(ratios, least, color=SHADES[d], label=f"degree {d}")
        ax.axhline(0.5, color=INK, lw=0.7)
        ax.set(xscale="log", xlabel=f"largest ratio of {label}", ylim=(0.4, 0.7))
        ax.set_xticks([1, 2, 3, 4, 6, 8, 10, 16] if constraint == "box" else [1, 2, 3, 4, 6, 8], minor=False)
        ax.xaxis.set_major_formatter(lambda x, _: f"{x:g}")
        ax.xaxis.set_minor_formatter(lambda x, _: "")
    axes[0].set_ylabel("least peak")
    axes[0].legend()
    return figure
