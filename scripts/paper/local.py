"""Algorithms 2 and 3 in the paper's plain way: ``numpy.roots`` on the pieces that an interval meets, vertex by vertex.

One routine finds the footpoint of one vertex, whatever the variant and the order of updates, so that the times of the
variants can be compared (Fig. 4), and so that control points can be moved in any order.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from glyphspline.curves.bspline import Spline, bezier_pieces
from glyphspline.interpolation.reference import prepare
from glyphspline.types import FloatArray, IntArray

from .study import MAX_ITERATIONS, TOLERANCE

POWERS = np.array([[-1.0, 3, -3, 1], [3, -6, 3, 0], [-3, 3, 0, 0], [1, 0, 0, 0]])
"""From the Bézier points of a cubic to its coefficients by descending powers."""

REAL = 1e-7
"""Zeros with a smaller imaginary part count as real."""

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

    def __init__(self, points: FloatArray, variant: int, knots: ArrayLike | None = None, margin: float = 0.0) -> None:
        problem = prepare(points, variant, margin=margin, knots="chord" if knots is None else knots)
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
        """Parameters where vertex i may have its footpoint on the curve of P, and the squared distances there."""
        parameters, deviations = self._candidates(P, i)
        return np.array(parameters), np.square(deviations).sum(axis=1)

    def _candidates(self, P: FloatArray, i: int) -> tuple[list[float], list[FloatArray]]:
        parameters, deviations = [], []
        for piece in self._pieces[i]:
            c = piece.to_powers @ P[piece.controls]
            c[3] -= self.points[i]
            x = [piece.low]
            if piece.low < piece.high:
                zeros = np.roots(_slope(c))
                real = zeros.real[np.abs(zeros.imag) < REAL]
                x += [piece.high, *real[(piece.low < real) & (real < piece.high)].tolist()]
            for y in x:
                parameters.append(piece.start + piece.length * y)
                deviations.append(-(((c[0] * y + c[1]) * y + c[2]) * y + c[3]))
        return parameters, deviations

    def footpoint(self, P: FloatArray, i: int) -> tuple[float, FloatArray]:
        """The parameter of vertex i's footpoint on the curve of P, and the deviation of the vertex there."""
        parameters, deviations = self._candidates(P, i)
        squared = np.square(deviations).sum(axis=1)
        tied = np.flatnonzero(squared <= squared.min() * (1 + TIE))
        best = min(tied.tolist(), key=lambda k: abs(parameters[k] - float(self.centres[i])))
        return parameters[best], deviations[best]

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
        self,
        order: Sequence[Sequence[int]],
        tolerance: float = TOLERANCE,
        limit: int = MAX_ITERATIONS,
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
