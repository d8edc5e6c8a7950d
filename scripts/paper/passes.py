"""Passes from any control points, by the pass in NumPy: the public functions begin at the vertices."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import glyphspline as gs
from glyphspline.interpolation.batch import interpolate_batch
from glyphspline.interpolation.method import Method
from glyphspline.interpolation.plain import State
from glyphspline.interpolation.polygon import Polygons, as_points
from glyphspline.interpolation.reference import Iteration
from glyphspline.types import FloatArray


class Passes:
    """A polygon in units near 1, by variants 1 to 3.

    Attributes:
        start: (n, d) the first control points, one a vertex; those of the ends of an arc stand beside its ends.
        free: which of them move freely. unit, limit: of lengths, and the error to stop below. origin: (d,) of them.
    """

    def __init__(self, points: FloatArray, method: Method, end_tangents: FloatArray | None = None) -> None:
        q, closed = as_points(points), method.closed
        offsets, pair = np.array([0, len(q)]), None if end_tangents is None else end_tangents[None]
        tangents = np.full((1, 2, q.shape[1]), np.nan) if pair is None else pair
        polygons = Polygons(q, offsets, tangents=tangents)
        batch = interpolate_batch(polygons, replace(method, max_iterations=0))
        self.result, self.method, found = batch.results()[0], method, batch.arrays
        n = len(self.result.parameters)
        self.knots, bounds = np.resize(self.result.spline.knots, n), found.bounds.copy()
        bounds[:n] -= self.knots[:, None]
        with np.errstate(all="ignore"):
            self.state = State(np.array([0]), polygons, closed, found._replace(bounds=bounds))
        self.first, self.n = int(self.state.strip.origins[0]), n
        self.free = slice(0, n) if closed else slice(1, n - 1)
        self.unit, self.origin = float(self.state.units[0]), q[found.kept[0]]
        self.start = self.state.P[:, self.first : self.first + n].T.copy()
        self.limit = float(found.tolerances[0]) * self.unit

    def one_pass(self, controls: FloatArray) -> tuple[FloatArray, FloatArray, float]:
        """Footpoints on the curve of control points (n, d), these after the update, and the largest error before it."""
        self._set(controls)
        with np.errstate(all="ignore"):
            squared, _, _ = self.state.one_pass()
        updated, t = self.state.P[:, self.first : self.first + self.n].T.copy(), np.zeros(self.n)
        updated[self.free], t[self.free] = self.state.moved.T, self.state.x
        return self.knots + t / self.state.knot_units[0], updated, float(np.sqrt(squared[0]))

    def points_of(self, controls: FloatArray) -> FloatArray:
        """Control points in the caller's units, those of the ends of an arc with them."""
        self._set(controls)
        more = 0 if self.method.closed else 1
        found: FloatArray = self.state.P[:, self.first - more : self.first + self.n + more].T / self.unit + self.origin
        return found

    def _set(self, controls: FloatArray) -> None:
        self.state.P[:, self.first : self.first + self.n] = controls.T
        self.state.fill_edges()

    def result_of(self, run: Iteration) -> gs.Interpolation:
        """The result of a run."""
        residuals = np.array(run.residuals) / self.unit
        old, closed = self.result, self.method.closed
        return replace(
            old, spline=gs.Spline(self.points_of(run.controls), old.spline.knots, 3, closed),
            parameters=run.footpoints, iterations=len(residuals) - 1, residuals=residuals,
            converged=bool(run.residuals[-1] < self.limit),
        )  # fmt: skip
