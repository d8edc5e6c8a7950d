"""Anderson acceleration beside plain iteration: passes, times, how far limits lie apart."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal, get_args

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

import glyphspline as gs
from glyphspline.interpolation.method import Method
from glyphspline.interpolation.polygon import as_tangents
from glyphspline.interpolation.reference import iterate
from glyphspline.plugins.experiments.style import COLOURS
from glyphspline.types import FloatArray

from ..benchmark.batch import least, seconds
from .common import Run, random_polygons
from .faces import FONTS
from .passes import Passes
from .study import TOLERANCE

Finish = Literal["iterate", "accelerate"]
FINISHES: tuple[Finish, ...] = get_args(Finish)
SHADES = {f: COLOURS[f"variant {v}"] for f, v in zip(FINISHES, (2, 0), strict=True)}
FACES = ("kouzan-gyosho.ttf", "kouzan-kaisho.ttf")
STEP = 20.0
REPEATS = 7
TIMED = 20
"""Number of polygons of a group that are timed."""

Results = dict[Finish, list[gs.Interpolation]]

MEMORY = 5
"""Number of earlier passes that :class:`Anderson` combines with the last one; more of them save few passes."""

FALL = 0.95
"""Largest factor of the error in an accelerated step that stands."""

DAMPING = 1e-12
"""Share of its trace added to the diagonal of the normal equations, which are singular when changes are dependent."""


class Anderson:
    """Anderson acceleration of the passes, with the plain step as a safeguard.

    With the steps f = updated - controls of the last few passes, the affine combination of those passes is sought
    whose combined step is shortest; the same combination of the updated control points is tried next. Where that does
    not multiply the error by ``FALL`` or less, it is taken back for the plain step. Theorem 2 holds from any control
    points, so that every step that stands multiplies the error by at most the larger of ``FALL`` and the certified
    factor. The fixed points of the iteration are a family: the limit is another one than by plain steps.

    Args:
        free: the rows of free control points; others depend on them.
    """

    def __init__(self, free: slice = slice(None)) -> None:
        self.free = free
        self.updated: list[FloatArray] = []
        self.steps: list[FloatArray] = []
        self.error = np.inf
        self.trying = False

    def next(self, controls: FloatArray, updated: FloatArray, error: float) -> FloatArray:
        """The control points of the next pass, from those of a pass, its update and its error."""
        if self.trying and not error <= FALL * self.error:
            self.trying, self.updated, self.steps = False, self.updated[-1:], self.steps[-1:]
            return self.updated[-1]
        self.updated = [*self.updated[-MEMORY:], updated]
        self.steps = [*self.steps[-MEMORY:], (updated - controls)[self.free]]
        changes = np.diff(self.steps, axis=0)
        gram = np.einsum("ikc,jkc->ij", changes, changes)  # not by BLAS, whose sums may depend on the number of cores
        size = float(np.trace(gram))
        self.error, self.trying = error, size > 0
        if not self.trying:
            return updated
        weights = np.linalg.solve(
            gram + DAMPING * size * np.eye(len(gram)), np.einsum("ikc,kc->i", changes, self.steps[-1])
        )
        return updated - np.einsum("i,ikc->kc", weights, np.diff(self.updated, axis=0))


def accelerated(points: FloatArray, variant: int = 2, **options: Any) -> gs.Interpolation:
    """The result of accelerated passes of variants 1 to 3; options are those of :func:`glyphspline.interpolate`."""
    end_tangents = as_tangents([options.pop("end_tangents", None)], points.shape[1])[0]
    method = Method(variant, **options)
    problem = Passes(points, method, None if method.closed else end_tangents)
    anderson = Anderson(problem.free)

    def one_pass(controls: FloatArray) -> tuple[FloatArray, FloatArray, float]:
        footpoints, updated, error = problem.one_pass(controls)
        done = error < problem.limit or not np.isfinite(error)
        return footpoints, updated if done else anderson.next(controls, updated, error), error

    return problem.result_of(iterate(one_pass, problem.start, problem.limit, method.max_iterations))


def interpolated(
    polygons: list[FloatArray], finish: Finish, variant: int = 2, **options: Any
) -> list[gs.Interpolation]:
    """Results for a list of polygons."""
    if finish == "accelerate":
        return [accelerated(p, variant, **options) for p in polygons]
    return gs.interpolate_many(polygons, variant, **options)


def acceleration(run: Run) -> None:
    """Random polygons by number of vertices, and the contours of two faces."""
    passes: dict[str, dict[str, float]] = {f: {} for f in FINISHES}
    backs = {"random polygons": 0, "contours": 0}
    apart: dict[str, dict[str, float]] = {}
    groups = {n: random_polygons(n, run.size(100, 3)) for n in run.groups}
    times: dict[str, dict[str, float]] = {}
    for n, polygons in groups.items():
        results = {f: interpolated(polygons, f, residual_tolerance=TOLERANCE) for f in FINISHES}
        for f in FINISHES:
            passes[f][str(n)] = _mean_passes(results[f])
        backs["random polygons"] += sum(len(taken_back(r.residuals)) for r in results["accelerate"])
    apart["random polygons"] = _apart(results)
    times[f"random, {n} vertices"] = _times(polygons, run)
    contours: dict[str, dict[str, float]] = {}
    for face in FACES[: run.size(2, 1)]:
        polygons = contours_of(face)
        for tolerance, digits in ((None, "1e-6 of the extent"), (0.005, "0.005 units")):
            results = {f: interpolated(polygons, f, residual_tolerance=tolerance) for f in FINISHES}
            contours[f"{face}, {digits}"] = {
                "contours": len(polygons),
                **{f: _mean_passes(results[f]) for f in FINISHES},
                "iterate / accelerate": _mean_passes(results["iterate"]) / _mean_passes(results["accelerate"]),
            }
            backs["contours"] += sum(len(taken_back(r.residuals)) for r in results["accelerate"])
            if tolerance is None:
                apart[face] = _apart(results)
        times[face] = _times(polygons, run)
    slow = {v: _any_variant(groups[n], v) for v in ((1, 3) if not run.quick else (3,))}
    measured = {
        "mean passes on random polygons": passes,
        "mean passes on contours": contours,
        f"mean passes at {n} vertices, other variants": slow,
        "steps taken back": backs,
        "median and largest distance of control points from the plain limit, in mean chords": apart,
    }
    run.claim("beyond-acceleration", measured, "measured", memory=MEMORY, fall=FALL, step=STEP)
    run.times["acceleration, us a polygon, one thread"] = times
    run.save(_picture(passes, groups[n][0]), "acceleration", svg=True)


def contours_of(face: str) -> list[FloatArray]:
    """Polygons of all contours of a face."""
    font = gs.open_font(FONTS / face)
    polygons = [gs.sample(c, step=STEP) for g in font.glyph_names for c in font.outline(g).contours]
    return [p for p in polygons if len(p) > 3]


def taken_back(residuals: FloatArray) -> list[int]:
    """Passes that did not reduce the error enough, from the error of the last pass that stands."""
    passes, error, back = [], residuals[0], False
    for k, e in enumerate(residuals[1:], 1):
        back = not back and k > 1 and not e <= FALL * error
        if back:
            passes.append(k)
        else:
            error = e
    return passes


def _mean_passes(results: list[gs.Interpolation]) -> float:
    if not all(r.converged for r in results):
        raise ArithmeticError("a run does not converge")
    return float(np.mean([r.iterations for r in results]))


def _apart(results: Results) -> dict[str, float]:
    """Distances of the limits, in mean chords: the median and the largest over polygons of the largest of each."""
    found = {}
    for f in FINISHES[1:]:
        far = [
            np.abs(a.spline.control_points - b.spline.control_points).max() / (a.spline.period / len(a.parameters))
            for a, b in zip(results["iterate"], results[f], strict=True)
        ]
        found[f"{f}, median"], found[f"{f}, largest"] = float(np.median(far)), float(np.max(far))
    return found


def _any_variant(polygons: list[FloatArray], variant: int) -> dict[str, float]:
    """Mean passes, and the runs that do not converge, of another variant."""
    found: dict[str, float] = {}
    for f in FINISHES[:2]:
        results = interpolated(polygons, f, variant, residual_tolerance=TOLERANCE)
        found[f] = float(np.mean([r.iterations for r in results]))
        found[f"{f}, not converged"] = sum(not r.converged for r in results)
    return found


def _plain(points: FloatArray) -> gs.Interpolation:
    problem = Passes(points, Method())
    return problem.result_of(iterate(problem.one_pass, problem.start, problem.limit, 1000))


def _times(polygons: list[FloatArray], run: Run) -> dict[str, float]:
    """The least of several times by passes called one by one, taken in turns, as other work disturbs each."""
    few = polygons[:TIMED]
    cases: dict[str, Callable[[], object]] = {
        "iterate": lambda: [_plain(p) for p in few],
        "accelerate": lambda: [accelerated(p) for p in few],
    }
    best = least(run.size(REPEATS, 1), *map(seconds, cases.values()))
    return {name: 1e6 * time / len(few) for name, time in zip(cases, best, strict=True)}


def _picture(passes: dict[str, dict[str, float]], polygon: FloatArray) -> Figure:
    figure, axes = plt.subplots(1, 2, figsize=(7.4, 2.9), layout="constrained")
    for f in FINISHES:
        series = passes[f]
        axes[0].plot([int(n) for n in series], list(series.values()), color=SHADES[f], marker="o", label=f)
        (r,) = interpolated([polygon], f, residual_tolerance=TOLERANCE)
        axes[1].semilogy(np.maximum(r.residuals, 1e-16), color=SHADES[f], marker="o", ms=2.5, label=f)
    axes[0].set(xlabel="vertices", ylabel="mean passes", ylim=(0, None))
    axes[1].set(xlabel=f"pass, one polygon of {len(polygon)} vertices", ylabel="largest error")
    axes[1].axhline(TOLERANCE, color=COLOURS["variant 3"], lw=0.7, ls=(0, (4, 2)))
    axes[0].legend()
    return figure
