"""Fig. 4: mean time a polygon, with the compiled search and in the paper's own way (``numpy.roots``)."""

from __future__ import annotations

import time
from collections.abc import Callable

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

import glyphspline as gs
from glyphspline.interpolation.reference import interpolate_reference, prepare
from glyphspline.types import FloatArray

from .common import COLOURS, MARKERS, Run, verdict
from .study import MAX_ITERATIONS, TOLERANCE

VARIANTS = (1, 2, 3, 4)
ROUNDS = 3
COMPILED, PLAIN = 50, 10
"""Polygons a group for the compiled and the plain way."""


def _compiled(polygons: list[FloatArray], variant: int) -> None:
    for p in polygons:
        gs.interpolate(p, variant, residual_tolerance=TOLERANCE, max_iterations=MAX_ITERATIONS)


def _plain(polygons: list[FloatArray], variant: int) -> None:
    """The paper's way. Variant 3 needs no search, so it gets none."""
    for p in polygons:
        if variant == 3:
            _fixed_parameters(p)
        else:
            interpolate_reference(p, variant, residual_tolerance=TOLERANCE, max_iterations=MAX_ITERATIONS)


def _fixed_parameters(polygon: FloatArray) -> None:
    problem = prepare(polygon, 3)
    P, t = polygon.copy(), problem.centres
    for _ in range(MAX_ITERATIONS):
        e = polygon - problem.spline(P)(t)
        if np.hypot(*e.T).max() < TOLERANCE:
            return
        P = P + e


def _interleaved(
    work: Callable[[list[FloatArray], int], None], polygons: list[FloatArray], rounds: int
) -> dict[int, float]:
    """Median seconds a polygon and variant. The variants take turns, so that a busy moment hits all of them."""
    seconds: dict[int, list[float]] = {v: [] for v in VARIANTS}
    for _ in range(rounds):
        for v in VARIANTS:
            start = time.perf_counter()
            work(polygons, v)
            seconds[v].append((time.perf_counter() - start) / len(polygons))
    return {v: float(np.median(s)) for v, s in seconds.items()}


def figure_4(run: Run) -> None:
    """Times of both ways; the claim itself is about their order only, as times are a machine's own."""
    _compiled([run.polygons()[run.groups[0]][0]], 2)
    fast: dict[str, dict[str, float]] = {f"variant {v}": {} for v in VARIANTS}
    plain: dict[str, dict[str, float]] = {f"variant {v}": {} for v in VARIANTS}
    for n, polygons in run.polygons().items():
        for times, result in (
            (_interleaved(_compiled, polygons[:COMPILED], run.size(ROUNDS, 2)), fast),
            (_interleaved(_plain, polygons[: run.size(PLAIN, 1)], 1), plain),
        ):
            for v, s in times.items():
                result[f"variant {v}"][str(n)] = 1000 * s
    run.times["fig-4, ms a polygon, compiled"] = fast
    run.times["fig-4, ms a polygon, numpy.roots"] = plain
    last = str(run.groups[-1])
    searching = [plain[f"variant {v}"][last] for v in (1, 2, 4)]
    observed = {
        "variant 3 least with numpy.roots": plain["variant 3"][last] < min(searching),
        "variants 1, 2, 4 within a factor of 2 with numpy.roots": max(searching) < 2 * min(searching),
    }
    run.claim(
        "fig-4-mean-time",
        "Fig. 4",
        "Variant 3 takes the least time, as it searches no footpoints; variants 1, 2 and 4 take about the same.",
        "up to 6 s a polygon in MATLAB; variant 3 least",
        observed,
        verdict(all(observed.values())),
        "For the largest polygons. Times are a machine's own and stand apart from the claims, under “times”. Variant 3 "
        "is first by far in the plain way; of the others variant 4, which moves one control point after another, takes "
        "more than twice as long as variant 2, as only the others' footpoints are found for a whole polygon at once. "
        "With a compiled search footpoints are no longer what costs most, and variant 3 loses its lead to the "
        "iterations it needs.",
        "fig4",
    )
    run.save(_picture(fast, plain, run), "fig-4", svg=True)


def _picture(fast: dict[str, dict[str, float]], plain: dict[str, dict[str, float]], run: Run) -> Figure:
    figure, axes = plt.subplots(1, 2, figsize=(7.2, 2.9), layout="constrained")
    for ax, times, title in ((axes[0], plain, "numpy.roots, the paper's way"), (axes[1], fast, "compiled")):
        for name, series in times.items():
            ax.plot(
                [int(n) for n in series], list(series.values()), color=COLOURS[name], marker=MARKERS[name], label=name
            )
        ax.set(xlabel="vertices", title=title, ylim=(0, None), xticks=run.groups[::2])
    axes[0].set_ylabel("mean time, ms a polygon")
    axes[0].legend()
    return figure
