"""Algorithms 2 and 3 in the paper's plain way: ``numpy.roots`` on the pieces that an interval meets, vertex by vertex.

One routine finds the footpoint of one vertex, whatever the variant and the order of updates, so that the times of the
variants can be compared, as in Fig. 4 beside compiled code, and so that control points can be moved in any order.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from statistics import median

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

import glyphspline as gs
from glyphspline.curves.bspline import Spline, bezier_pieces
from glyphspline.interpolation.method import Method, Parametrisation
from glyphspline.interpolation.reference import prepare
from glyphspline.plugins.experiments.style import COLOURS
from glyphspline.types import FloatArray, IntArray

from ..benchmark.measure import interleaved
from .common import Run, draw_series, verdict
from .study import MAX_ITERATIONS, TOLERANCE

POWERS = np.array([[-1.0, 3, -3, 1], [3, -6, 3, 0], [-3, 3, 0, 0], [1, 0, 0, 0]])
"""From the Bézier points of a cubic to its coefficients by descending powers."""

TIE = 1e-12
"""Squared distances that agree to so many parts are a tie."""


@dataclass(frozen=True, eq=False)
class Piece:
    """The part of a knot span in which a footpoint may lie: ``low`` to ``high`` of the way from ``start``."""

    controls: IntArray
    to_powers: FloatArray
    start: float
    length: float
    low: float
    high: float


class LocalMethod:
    """A closed polygon, its knots, and for each vertex the pieces that its search interval meets."""

    def __init__(
        self, points: FloatArray, variant: int, knots: Parametrisation | ArrayLike = "chord", margin: float = 0.0
    ) -> None:
        ruled = isinstance(knots, str)
        method = Method(variant, margin=margin, knots=knots if ruled else None)  # type: ignore[arg-type]
        problem = prepare(points, method, None if ruled else knots)
        spline = Spline(problem.points, problem.knots)
        spans = len(problem.knots) - 1
        local = bezier_pieces(spline.full_knots, np.broadcast_to(np.eye(4), (spans, 4, 4)))
        self.points, self.centres, self.knots = problem.points, problem.centres, problem.knots
        self.bounds = problem.intervals.bounds
        self.rate_bound = problem.intervals.rate_bound
        self._to_powers, self._controls = POWERS @ local, spline.span_controls
        self._pieces = [self._meeting(low, high) for low, high in self.bounds]

    def _meeting(self, low: float, high: float) -> list[Piece]:
        u, found = self.knots, []
        for lap in (-1, 0, 1):
            for k in range(len(u) - 1):
                start, h = u[k] + lap * u[-1], u[k + 1] - u[k]
                a, b = max(low, start), min(high, start + h)
                if a < b or (a == b == low == high and a < start + h):
                    x = np.clip(((a - start) / h, (b - start) / h), 0, 1)
                    found.append(Piece(self._controls[k], self._to_powers[k], start, h, *x.tolist()))
        return found

    def candidates(self, P: FloatArray, i: int) -> tuple[FloatArray, FloatArray]:
        """Parameters where vertex i may have its footpoint on the curve of P, and its deviations (k, 2) there."""
        parameters, deviations = list[float](), list[FloatArray]()
        for piece in self._pieces[i]:
            c = piece.to_powers @ P[piece.controls]
            c[3] -= self.points[i]
            x = [piece.low]
            if piece.low < piece.high:
                zeros = np.roots(_slope(c))
                real = zeros.real[np.abs(zeros.imag) < 1e-7]  # those with a smaller imaginary part count as real
                x += [piece.high, *real[(piece.low < real) & (real < piece.high)].tolist()]
            for y in x:
                parameters.append(piece.start + piece.length * y)
                deviations.append(-(((c[0] * y + c[1]) * y + c[2]) * y + c[3]))
        return np.array(parameters), np.array(deviations)

    def footpoint(self, P: FloatArray, i: int) -> tuple[float, FloatArray]:
        """The parameter of vertex i's footpoint on the curve of P, and the deviation of the vertex there."""
        parameters, deviations = self.candidates(P, i)
        squared = np.square(deviations).sum(axis=1)
        tied = np.flatnonzero(squared <= squared.min() * (1 + TIE))
        best = min(tied.tolist(), key=lambda k: abs(parameters[k] - float(self.centres[i])))
        return float(parameters[best]), deviations[best]

    def sweep(self, P: FloatArray, order: Sequence[Sequence[int]]) -> tuple[FloatArray, float]:
        """One sweep: the vertices of a block are measured on one curve and moved together, block after block.

        Algorithm 2 has all vertices in one block, Algorithm 3 one vertex a block.

        Returns:
            The control points after the sweep, and its largest correction.
        """
        P, largest = P.copy(), 0.0
        for block in order:
            found = [self.footpoint(P, i)[1] for i in block]
            for i, e in zip(block, found, strict=True):
                P[i] += e
                largest = max(largest, float(np.hypot(*e)))
        return P, largest

    def run(
        self, order: Sequence[Sequence[int]], tolerance: float = TOLERANCE, limit: int = MAX_ITERATIONS
    ) -> tuple[FloatArray, list[float]]:
        """Sweep from the polygon until the largest correction is below the tolerance, or ``limit`` sweeps are made.

        Returns:
            The control points, and the largest correction of every sweep; the last sweep only measures.
        """
        P, corrections = self.points, []
        for _ in range(limit + 1):
            after, largest = self.sweep(P, order)
            corrections.append(largest)
            if largest < tolerance:
                break
            P = after
        return P, corrections


def order_of(variant: int, n: int) -> list[list[int]]:
    """The blocks of a sweep: Algorithm 3 for variant 4, else Algorithm 2."""
    return [[i] for i in range(n)] if variant == 4 else [list(range(n))]


def _slope(c: FloatArray) -> list[float]:
    """Half the derivative of the squared length of a cubic with vector coefficients c (descending powers)."""
    (aa, ab, ac, ad), (_, bb, bc, bd), (_, _, cc, cd), _ = (c @ c.T).tolist()
    return [3 * aa, 5 * ab, 4 * ac + 2 * bb, 3 * (ad + bc), 2 * bd + cc, cd]


VARIANTS = (1, 2, 3, 4)
ROUNDS = 3
COMPILED, PLAIN = 50, 6
"""Polygons a group for the compiled and the plain way."""


def _compiled(polygons: list[FloatArray], variant: int) -> None:
    for p in polygons:
        gs.interpolate(p, variant, residual_tolerance=TOLERANCE, max_iterations=MAX_ITERATIONS)


def _plain(polygons: list[FloatArray], variant: int) -> None:
    """The paper's way. All variants find a footpoint by the same routine; variant 3 has one candidate only."""
    for p in polygons:
        LocalMethod(p, variant).run(order_of(variant, len(p)))


def _interleaved(
    work: Callable[[list[FloatArray], int], None], polygons: list[FloatArray], rounds: int
) -> dict[int, float]:
    """Median seconds a polygon and variant."""
    times = interleaved({v: partial(work, polygons, v) for v in VARIANTS}, rounds, warm=False)
    return {v: seconds / len(polygons) for v, seconds in times.items()}


def figure_4(run: Run) -> None:
    """Times of both ways; the claim itself is about their order only, as times are a machine's own."""
    _compiled([run.polygons()[run.groups[0]][0]], 2)
    fast: dict[str, dict[str, float]] = {f"variant {v}": {} for v in VARIANTS}
    plain: dict[str, dict[str, float]] = {f"variant {v}": {} for v in VARIANTS}
    for n, polygons in run.polygons().items():
        each = [_interleaved(_plain, [p], 1) for p in polygons[: run.size(PLAIN, 1)]]
        for times, result in (
            (_interleaved(_compiled, polygons[:COMPILED], run.size(ROUNDS, 2)), fast),
            ({v: float(np.mean([s[v] for s in each])) for v in VARIANTS}, plain),
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
    run.claim("fig-4-mean-time", observed, verdict(all(observed.values())))
    ahead = {
        f"groups where variant 1 takes less time than variant {v}": sum(
            plain["variant 1"][n] < plain[f"variant {v}"][n] for n in plain["variant 1"]
        )
        for v in (2, 4)
    }
    measured = {"groups": len(run.groups), **ahead}
    run.claim("section-4.2-variant-1-time", measured, verdict(min(ahead.values()) > len(run.groups) / 2))
    run.save(picture(fast, plain, run), "fig-4", svg=True)


def picture(fast: dict[str, dict[str, float]], plain: dict[str, dict[str, float]], run: Run) -> Figure:
    """Both ways beside each other; a line that would flatten all others has a scale of its own."""
    figure, axes = plt.subplots(1, 2, figsize=(7.2, 2.9), layout="constrained")
    for ax, times, title in ((axes[0], plain, "numpy.roots, the paper's way"), (axes[1], fast, "compiled")):
        slow = {name: values for name, values in times.items() if _is_flattening(name, times)}
        draw_series(ax, {name: values for name, values in times.items() if name not in slow})
        ax.set(xlabel="vertices", title=title, ylim=(0, None), xticks=run.groups[::2])
        for name, values in slow.items():
            own = ax.twinx()
            draw_series(own, {name: values})
            own.set(ylim=(0, None))
            own.spines["right"].set(visible=True, color=COLOURS[name])
            own.tick_params(axis="y", colors=COLOURS[name])
            own.set_ylabel(f"{name}, on a scale of its own", color=COLOURS[name])
            own.grid(visible=False)
    axes[0].set_ylabel("mean time, ms a polygon")
    axes[0].legend()
    return figure


def _is_flattening(name: str, times: dict[str, dict[str, float]]) -> bool:
    """Whether on the scale of this line all others would be flat."""
    return median(times[name].values()) > 4 * max(max(times[other].values()) for other in times if other != name)
