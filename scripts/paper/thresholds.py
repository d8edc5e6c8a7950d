"""When does every basis function rise above 1/2? Fig. 1, thresholds of unevenness, and degrees 2 to 6."""

from __future__ import annotations

import math

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from glyphspline.plugins.experiments.style import COLOURS, INK, MARKERS
from glyphspline.types import FloatArray

from .certified import POLYNOMIALS, Constraint, certify, crossing, peak_values, root, threshold, worst_corner
from .common import SEED, Run, random_polygons, verdict
from .study import Group, mean_iterations, study_group

VECTORS = 10_000
SEEDS = range(SEED, SEED + 12)
PAPER_FAILURES, PAPER_RATIO = 25, 16


def draw_maxima(seed: int, count: int = VECTORS) -> tuple[np.ndarray, np.ndarray]:
    """Peak, and ratio of the longest to the shortest interval, of ``count`` random five-knot vectors.

    The paper does not say how it draws. Four intervals uniform in (0, 1) give counts like its own; five sorted
    uniform knots give some ten times as many.
    """
    h = np.random.default_rng(seed).uniform(0, 1, (count, 4))
    return peak_values(h), h.max(axis=1) / h.min(axis=1)


def figure_1(run: Run) -> None:
    """Scatter of the maxima, and the claims about it."""
    maxima, ratios = draw_maxima(SEED, run.size(VECTORS, 2000))
    failed = maxima <= 0.5
    samples = [draw_maxima(seed, len(maxima)) for seed in list(SEEDS)[: run.size(12, 3)]]
    counts = [int((m <= 0.5).sum()) for m, _ in samples]
    smallest = [float(r[m <= 0.5].min()) for m, r in samples if (m <= 0.5).any()]
    knots = np.sort(np.random.default_rng(SEED).uniform(0, 1, (len(maxima), 5)), axis=1)
    sorted_failures = int((peak_values(np.diff(knots, axis=1)) <= 0.5).sum())

    few, many = min(counts), max(counts)
    as_many = verdict(run.quick or few <= PAPER_FAILURES <= many)
    run.claim("fig-1-failures", int(failed.sum()), as_many, vectors=len(maxima))
    of_seeds = {"fewest": few, "most": many, "seeds": len(counts), "sorted knots instead": sorted_failures}
    run.claim("fig-1-seeds", of_seeds, as_many)
    least = {"smallest ratio, this sample": ratios[failed].min(initial=np.inf), "least of all seeds": min(smallest)}
    run.claim("fig-1-ratio", least, verdict(min(smallest) > PAPER_RATIO))
    run.save(_maxima(maxima, failed), "fig-1")


def _maxima(maxima: np.ndarray, failed: np.ndarray) -> Figure:
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


DEGREES = (3, 4, 5, 6)
SHADES = dict(zip((2, *DEGREES), ("#9aa5b1", *list(COLOURS.values())[1:]), strict=True))

DIGITS = 10**6
"""Least peaks are proven to so many parts of 1."""

RAISED = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")


def thresholds(run: Run) -> None:
    """R* and r* for degrees 2 to 6, the least peaks at small ratios, and a picture of both."""
    degrees = DEGREES[:1] if run.quick else DEGREES
    measured: dict[str, object] = {"degree 2": {"R*": "none", "r*": "none"}}
    kinds: tuple[tuple[str, Constraint], ...] = (("R*", "box"), ("r*", "adjacent"))
    for d in degrees:
        rows: dict[str, object] = {}
        boxes = 0
        for name, constraint in kinds:
            found = threshold(d, constraint)
            assert found is not None
            polynomial = POLYNOMIALS.get((d, constraint))
            if polynomial:
                root(polynomial, found.ratio)  # raises unless the polynomial has a zero there
            rows[name] = found.ratio
            rows[f"{name} is a zero of"] = written(polynomial) if polynomial else "not written out"
            rows[f"{name} worst intervals"] = [round(h, 5) for h in found.intervals]
            boxes += found.boxes
        measured[f"degree {d}"] = {**rows, "boxes examined": boxes}
    run.claim("beyond-thresholds", measured, "proven for degrees 3 to 6, simple knots (degree 2: always)", digits=10)
    _least_peaks(run)
    run.save(_least_peaks_picture(run.size(60, 8)), "thresholds", svg=True)


def written(coefficients: tuple[int, ...]) -> str:
    """A polynomial in x, by descending powers."""
    text = ""
    for power, c in zip(range(len(coefficients) - 1, -1, -1), coefficients, strict=True):
        if c:
            size = "" if abs(c) == 1 and power else str(abs(c))
            sign = ("-" if c < 0 else "") if not text else (" - " if c < 0 else " + ")
            text += sign + size + ("x" if power else "") + (str(power).translate(RAISED) if power > 1 else "")
    return text


def _least_peaks(run: Run) -> None:
    measured = {}
    for ratio in (1.5, 2, 3, 4, 5, 6):
        least, _ = worst_corner(3, ratio, "adjacent")
        units = math.floor(least * DIGITS - 0.01)  # rounded down, and by more than the proof's own allowance
        if certify(3, ratio, "adjacent", units / DIGITS) is None:
            raise ArithmeticError(f"no proof for the least peak at ratio {ratio}")
        measured[str(ratio)] = {
            "every peak above": units / DIGITS,
            "largest margin c": (units - DIGITS // 2) / DIGITS,
            "factor a step": 2 * (DIGITS - units) / DIGITS,
        }
    s = np.linspace(0.5, 1, 41)[:-1]
    flat = np.full_like(s, 1e-9)
    extreme = peak_values(np.stack([flat, s, 1 - s, flat], axis=1))
    run.claim(
        "beyond-least-peaks",
        {
            **measured,
            "any ratio": {
                "infimum of all peaks, 4/9": 4 / 9,
                "largest difference from 4s/(1 + 2s)²": float(np.abs(extreme - 4 * s / (1 + 2 * s) ** 2).max()),
                "least of these peaks": float(extreme.min()),
                "greatest of these peaks": float(extreme.max()),
            },
        },
        "proven for cubics with simple knots",
    )


def _least_peaks_picture(points: int) -> Figure:
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


COUNT = 200
"""Polygons of a group."""


def degrees(run: Run) -> None:
    """Variant 2 of every degree, with the paper's rule and with ``fallback="peak"``."""
    rules = {"Remark 3": "knot", "peak": "peak"}
    groups: dict[str, dict[str, dict[int, Group]]] = {rule: {} for rule in rules}
    for rule, fallback in rules.items():
        for d in (2, *DEGREES):
            groups[rule][f"degree {d}"] = {
                n: study_group(random_polygons(n, run.size(COUNT, 1)), 2, degree=d, fallback=fallback)
                for n in (run.groups if not run.quick else (5,))
            }
    measured = {
        "not converged": {
            rule: {d: sum(int((~g.converged).sum()) for g in by_n.values()) for d, by_n in table.items()}
            for rule, table in groups.items()
        },
        "vertices without an interval, %": {
            d: 100
            * sum(g.without_interval.sum() for g in by_n.values())
            / sum(n * len(g.iterations) for n, g in by_n.items())
            for d, by_n in groups["Remark 3"].items()
        },
        "mean iterations, Remark 3": {d: mean_iterations(by_n) for d, by_n in groups["Remark 3"].items()},
        "mean iterations, peak": {d: mean_iterations(by_n) for d, by_n in groups["peak"].items()},
    }
    run.claim("beyond-degrees", measured, "measured", count=COUNT)
    _under_the_condition(run, groups["Remark 3"])
    run.save(_shares(groups, run), "degrees", svg=True)


def _under_the_condition(run: Run, plain: dict[str, dict[int, Group]]) -> None:
    """The claim as the paper makes it: for maxima above 1/2."""
    measured: dict[str, dict[str, float]] = {}
    count = run.size(COUNT, 1)
    for d in (2, *DEGREES):
        even = [study_group(random_polygons(n, count), 2, degree=d, knots="uniform") for n in (10, 30)]
        graded = study_group(_graded_polygons(d, 20, 2 * count), 2, degree=d)
        clear = [g.converged[g.without_interval == 0] for g in plain[f"degree {d}"].values()]
        measured[f"degree {d}"] = {
            "uniform knots": sum(len(g.converged) for g in even),
            "failures": sum(int((~g.converged).sum()) for g in even),
            "chords within R*": len(graded.converged),
            "failures there": int((~graded.converged).sum()),
            "vertices without an interval there": int(graded.without_interval.sum()),
            "random, all peaks above 1/2": sum(len(c) for c in clear),
            "failures of these": sum(int((~c).sum()) for c in clear),
        }
    failures = sum(m["failures"] + m["failures there"] + m["failures of these"] for m in measured.values())
    run.claim("degrees-condition", measured, "reproduced" if failures == 0 else "differs")


def _graded_polygons(degree: int, n: int, count: int) -> list[FloatArray]:
    """Closed polygons of n (even) chords within a ratio of R* (less a little) of each other.

    Chords come in opposite pairs, shuffled, so that the polygon closes. For even degrees knots are midpoints, so that
    knot intervals are means of two chords and lie within the same ratio.
    """
    ratio = 10.0 if degree == 2 else 0.999 * crossing(degree, "box")
    rng = np.random.default_rng([SEED, degree])
    polygons = []
    for _ in range(count):
        angle, length = rng.uniform(0, 2 * np.pi, n // 2), ratio ** rng.uniform(0, 1, n // 2)
        steps = length[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        polygons.append(np.cumsum(rng.permutation(np.concatenate([steps, -steps])), axis=0))
    return polygons


def _shares(groups: dict[str, dict[str, dict[int, Group]]], run: Run) -> Figure:
    figure, axes = plt.subplots(1, 2, figsize=(7.4, 2.9), layout="constrained", sharey=True)
    for ax, (rule, table) in zip(axes, groups.items(), strict=True):
        for (name, by_n), marker in zip(table.items(), MARKERS.values(), strict=True):
            share = [100 * float(np.mean(g.converged)) for g in by_n.values()]
            ax.plot(list(by_n), share, color=SHADES[int(name[-1])], marker=marker, label=name)
        ax.set(title=f"fallback: {rule}", xlabel="vertices", ylim=(0, 104), xticks=run.groups[::2])
    axes[0].set_ylabel("converged, %")
    axes[0].legend(fontsize=7.5)
    return figure
