"""Approximation order: how fast the limit curve tends to a smooth curve that its vertices are taken from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure
from scipy.interpolate import BSpline

import glyphspline as gs
from glyphspline.interpolation.method import Method
from glyphspline.interpolation.polygon import vertex_parameters
from glyphspline.interpolation.reference import iterate
from glyphspline.plugins.experiments.style import COLOURS, GREY, INK, MARKERS
from glyphspline.types import FloatArray

from .common import Run
from .passes import Passes
from .smooth_curves import ELLIPSE, SAMPLINGS, TREFOIL, Waves, distance, order, steps

COUNTS = (8, 16, 32, 64, 128, 256, 512)
FROM = 64
"""Orders are fitted to the curves of this many vertices and more."""

TOLERANCE = 1e-12
VARIANTS = (0, 1, 2, 3, 4)
CURVES = {"ellipse": ELLIPSE, "trefoil": TREFOIL}

ONCE, TWICE, GREVILLE = "u ← t, once", "u ← t, twice", "Greville start"
Errors = dict[str, list[float]]


def approximation_order(run: Run) -> None:
    """Orders of all variants, what re-parametrisation changes, and a start that restores the order."""
    counts = COUNTS if not run.quick else (32, 64, 128)
    errors = {f"{c}, {s}": errors_of(CURVES[c], s, counts) for c in CURVES for s in SAMPLINGS}
    offsets = {key: table.pop("max |t - u| / h") for key, table in errors.items()}
    ends = counts[-1]
    orders = {key: {name: order(counts, e, FROM) for name, e in table.items()} for key, table in errors.items()}
    variants = [f"variant {v}" for v in VARIANTS]
    measured = {
        f"order, fitted from {FROM} vertices on": {k: {v: orders[k][v] for v in variants} for k in orders},
        f"distance at {ends} vertices": {k: {v: errors[k][v][-1] for v in variants} for k in errors},
        f"max |t - u| / h at {ends} vertices": {k: o[-1] for k, o in offsets.items()},
    }
    run.claim("beyond-order", measured, "measured")
    model = [local_error((1.0, 2.0))]
    for _ in range(2):
        model.append(local_error((1.0, 2.0), model[-1].intervals))
    run.claim(
        "beyond-order-alternating",
        {
            "|t - u|, shorter chord 1": model[0].offset,
            "least B_i at the footpoints": model[0].least_basis,
            "E": model[0].error,
            f"distance over κ a² at {ends} vertices": {
                c: errors[f"{c}, alternating"]["variant 2"][-1] / _unit(CURVES[c], ends) for c in CURVES
            },
        },
        "proven",
    )

    def alternating(ways: Sequence[str], with_order: Sequence[str]) -> dict[str, object]:
        tables = {c: (orders[f"{c}, alternating"], errors[f"{c}, alternating"]) for c in CURVES}
        return {
            "order": {c: {k: own[k] for k in with_order} for c, (own, _) in tables.items()},
            f"distance at {ends} vertices": {c: {k: away[k][-1] for k in ways} for c, (_, away) in tables.items()},
        }

    limits: dict[str, object] = {"E": {"variant 2": model[0].error, ONCE: model[1].error, TWICE: model[2].error}}
    limits |= alternating(("variant 2", ONCE, TWICE), (ONCE, TWICE))
    run.claim("beyond-order-reparametrised", limits, "proven")
    run.claim("beyond-order-greville", alternating(("variant 3", GREVILLE), ("variant 3", GREVILLE)), "measured")
    run.save(_picture(counts, errors), "order", svg=True)


def _unit(curve: Waves, n: int) -> float:
    """Largest curvature times the square of the shorter of alternating chords."""
    angle, length = curve.lengths()
    return float(np.abs(curve.curvature(angle)).max() * (length[-1] / (1.5 * n)) ** 2)


def errors_of(curve: Waves, sampling: str, counts: Sequence[int]) -> Errors:
    """Distances of all curves from the smooth one, by number of vertices; infinite where a run does not converge."""
    found: Errors = {}
    for n in counts:
        p = curve(curve.angles(steps(n, sampling)))  # type: ignore[arg-type]
        results = {f"variant {v}": gs.interpolate(p, v, residual_tolerance=TOLERANCE) for v in VARIANTS}
        second = results["variant 2"]
        results[ONCE] = reparametrised(p, second)
        results[TWICE] = reparametrised(p, results[ONCE])
        for name, r in results.items():
            found.setdefault(name, []).append(distance(curve, r.spline) if r.converged else np.inf)
        found.setdefault(GREVILLE, []).append(distance(curve, greville_start(p)))
        u = second.spline.knots
        found.setdefault("max |t - u| / h", []).append(float(np.abs(second.parameters - u[:-1]).max() * n / u[-1]))
    return found


def reparametrised(p: FloatArray, r: gs.Interpolation) -> gs.Interpolation:
    """Variant 2 again, with the footpoints of a result for knots."""
    t = r.parameters
    return gs.interpolate(p, 2, knots=np.append(t, t[0] + r.spline.period) - t[0], residual_tolerance=TOLERANCE)


def greville_start(p: FloatArray) -> gs.Spline:
    """Variant 2 begun not at the vertices but at the polygon's points of the Greville abscissae.

    With chord length for the parameter of the polygon, P_i is its point at (u_{i-1} + u_i + u_{i+1}) / 3.
    """
    u = vertex_parameters(p)
    h = np.diff(u)
    before = np.roll(h, 1)
    by = ((h - before) / 3)[:, None]
    towards = np.where(by > 0, (np.roll(p, -1, axis=0) - p) / h[:, None], (p - np.roll(p, 1, axis=0)) / before[:, None])
    scaled = Passes(p, Method(2))
    first = (p + by * towards - scaled.origin) * scaled.unit
    done = iterate(scaled.one_pass, first, TOLERANCE * scaled.unit, scaled.method.max_iterations)
    return gs.Spline(scaled.points_of(done.controls), u)


@dataclass(frozen=True, eq=False)
class Local:
    """The limit in the neighbourhood of a point where chords repeat themselves, as h → 0: a parabola y = x²/2.

    Attributes:
        offset: max |t - u|. intervals: between footpoints. least_basis: the least B_i at its footpoint.
        error: E, the largest distance; of the order of the square of the lengths of the chords.
    """

    offset: float
    intervals: FloatArray
    least_basis: float
    error: float


REPEATS = 20
"""Periods of a pattern, in whose middle one the far ends are not felt."""


def local_error(chords: Sequence[float], intervals: Sequence[float] | FloatArray | None = None) -> Local:
    """Vertices (s_i, s_i²/2) with a pattern of chords, and knots with one of intervals; None: those of the chords.

    The first coordinate of the curve stays Σ s_j B_j, which has the footpoints; the second one is interpolated there.
    """
    m = len(chords)
    n, a = REPEATS * m, REPEATS // 2 * m
    s = np.concatenate([[0.0], np.cumsum(np.tile(chords, REPEATS))])
    u = np.concatenate([[0.0], np.cumsum(np.tile(chords if intervals is None else intervals, REPEATS))])

    def curve(coefficients: FloatArray) -> BSpline:
        return BSpline(u, coefficients[2 : n - 1], 3, extrapolate=False)

    along = curve(s)
    low, high = u[a - 1 : a + m - 1].copy(), u[a + 1 : a + m + 1].copy()
    for _ in range(60):
        t = (low + high) / 2
        low, high = np.where(along(t) < s[a : a + m], t, low), np.where(along(t) < s[a : a + m], high, t)
    patterns = np.stack([curve((np.arange(n + 1) % m == j).astype(np.float64))(t) for j in range(m)], axis=1)
    rest = np.linalg.solve(patterns, s[a : a + m] ** 2 / 2 - curve(s**2 / 2)(t))
    across = curve(s**2 / 2 + np.resize(rest, n + 1))
    x = np.linspace(u[a], u[a + m], 20_001)
    least = min(float(curve(np.eye(n + 1)[a + i])(t[i])) for i in range(m))
    period = u[a + m] - u[a]
    return Local(
        float(np.abs(t - u[a : a + m]).max()), np.diff(np.append(t, t[0] + period)), least,
        float(np.abs(across(x) - along(x) ** 2 / 2).max()),
    )  # fmt: skip


def _picture(counts: Sequence[int], errors: dict[str, Errors]) -> Figure:
    figure, axes = plt.subplots(2, 3, figsize=(7.4, 5.2), layout="constrained", sharex=True, sharey="row")
    for row, curve in zip(axes, CURVES, strict=True):
        for ax, sampling in zip(row, SAMPLINGS, strict=True):
            table = errors[f"{curve}, {sampling}"]
            for v in VARIANTS[1:]:
                name = f"variant {v}"
                ax.plot(counts, table[name], color=COLOURS[name], marker=MARKERS[name], label=name)
            ax.plot(counts, table[ONCE], color=INK, ls=(0, (4, 2)), lw=0.8, label=ONCE)
            ax.plot(counts, table[GREVILLE], color=INK, ls=(0, (1, 1.5)), label=GREVILLE)
            n = np.array([counts[len(counts) // 2], counts[-1]])
            for q, label in ((2, "h²"), (4, "h⁴")):
                line = 0.3 * table["variant 3"][len(counts) // 2] * (n[0] / n) ** q
                ax.plot(n, line, color=GREY, lw=0.7)
                ax.annotate(label, (n[1], line[1]), color=GREY, fontsize=7, va="center")
            ax.set(xscale="log", yscale="log", title=f"{curve}, {sampling}")
            ax.set_xticks(counts, [str(c) for c in counts], minor=False)
            ax.minorticks_off()
        row[0].set_ylabel("distance")
    for ax in axes[1]:
        ax.set_xlabel("vertices")
    axes[0, 0].legend(fontsize=6.5)
    return figure
