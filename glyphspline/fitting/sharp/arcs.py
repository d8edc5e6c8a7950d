"""The splines through pieces of more than one span, interpolated together and kept as columns."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from ...interpolation.batch import interpolate_batch
from ...interpolation.polygon import NO_TANGENTS, Polygons, explain
from ...interpolation.result import Interpolation
from ...outlines.contour_arrays import members_of, offsets_of
from ...types import BoolArray, FloatArray, IntArray
from ..closed_curves import method_for
from ..measures import Columns
from ..options import Options
from .pieces import Pieces


class Arcs(NamedTuple):
    """Splines of more than one span, arcs and closed curves: one curve in R^{2K} for all masters.

    Attributes:
        piece: (A,) the piece of each, ascending. results: of the interpolation; they are not read here.
        knots: of all, with knot_offsets: (A + 1,) where those of each begin. controls: (·, 2K) the control points, with
            control_offsets: likewise.
        iterations, residuals, converged, rates, fallbacks: (A,) as in the results.
    """

    piece: IntArray
    results: list[Interpolation]
    knots: FloatArray
    knot_offsets: IntArray
    controls: FloatArray
    control_offsets: IntArray
    iterations: IntArray
    residuals: FloatArray
    converged: BoolArray
    rates: FloatArray
    fallbacks: IntArray

    def chosen(self, which: IntArray, piece: IntArray) -> Arcs:
        """Some of them, which belong to other pieces now."""
        knots, knot_offsets = members_of(self.knot_offsets, which)
        controls, control_offsets = members_of(self.control_offsets, which)
        results = [self.results[k] for k in which.tolist()]
        return Arcs(
            piece, results, self.knots[knots], knot_offsets, self.controls[controls], control_offsets,
            self.iterations[which], self.residuals[which], self.converged[which], self.rates[which],
            self.fallbacks[which],
        )  # fmt: skip


def in_order(parts: Iterable[Arcs], masters: int) -> Arcs:
    """All of them in the order of their pieces."""
    none, no_number = np.empty(0, dtype=np.int64), np.empty(0)
    start = Arcs(
        none, [], no_number, np.zeros(1, dtype=np.int64), np.empty((0, 2 * masters)), np.zeros(1, dtype=np.int64),
        none, no_number, np.empty(0, dtype=np.bool_), no_number, none,
    )  # fmt: skip
    columns: list[Any] = [*zip(start, *parts, strict=True)]
    piece, results, knots, knot_offsets, controls, control_offsets, *rest = columns
    whole = Arcs(
        np.concatenate(piece), [one for part in results for one in part], np.concatenate(knots),
        offsets_of(np.concatenate([np.diff(each) for each in knot_offsets])), np.concatenate(controls),
        offsets_of(np.concatenate([np.diff(each) for each in control_offsets])), *map(np.concatenate, rest),
    )  # fmt: skip
    order = np.argsort(whole.piece)
    return whole.chosen(order, whole.piece[order])


def interpolated(pieces: Pieces, wanted: BoolArray, options: Options) -> Iterator[Arcs]:
    """The closed curves and the arcs among the (P,) pieces wanted. Lemma 2 has an interval at all their vertices.

    Raises:
        PolygonError: one that cannot be interpolated; its ``contour`` is that of the piece.
    """
    starts, masters, closed = pieces.starts, pieces.vertices.shape[1], pieces.closed > 0
    size = np.sqrt(masters)  # one curve in R^{2K}, whose lengths are root mean squares of those in the masters
    vertices = pieces.vertices.reshape(-1, 2 * masters) / size
    tangents = pieces.tangents.swapaxes(1, 2).reshape(-1, 2, 2 * masters) / size
    for ring in (True, False):
        chosen = np.flatnonzero(wanted & (closed if ring else (pieces.spans > 1) & ~closed))
        if len(chosen) == 0:
            continue
        method = replace(method_for(options, "knot"), closed=ring)
        own, offsets = members_of(starts, chosen)
        polygons = Polygons(vertices[own], offsets, tangents=NO_TANGENTS if ring else tangents[chosen])
        found = interpolate_batch(polygons, method, 1)
        arrays, each = found.arrays, np.arange(len(offsets))
        for k in np.flatnonzero(arrays.whole[:, 0]).tolist():
            error = explain(polygons.points[offsets[k] : offsets[k + 1]], "chord", ring)
            raise error.locate(contour=int(pieces.contour[chosen[k]]))
        residuals, (iterations, fallbacks) = found.last_residuals, arrays.whole[:, 2:4].T
        yield Arcs(
            chosen, found.results(), arrays.knots, offsets + ring * each, arrays.controls,
            offsets + 2 * (1 - ring) * each, iterations, residuals, residuals < arrays.tolerances, arrays.rates,
            fallbacks,
        )  # fmt: skip


def arc_columns(arcs: Arcs, pieces: Pieces, contours: int) -> Columns:
    """The measures of ``results.SOLVED`` for each contour: of several arcs the worst counts, and the most iterations.

    Those without an arc of more than one span have None: nothing is iterated there.
    """
    starts = np.searchsorted(pieces.contour, np.arange(contours))
    segments = np.add.reduceat(np.maximum(pieces.spans, 1), starts).tolist()
    numbers = np.where(pieces.spans > 0, 2 * pieces.spans + 4 * (1 - pieces.closed), 2)
    some, first = np.unique(pieces.contour[arcs.piece], return_index=True)
    columns: dict[str, Any] = {"vertices": segments, "segments": segments}
    columns["numbers"] = np.add.reduceat(numbers, starts).tolist()
    for name, worst, values in (
        ("iterations", np.maximum, arcs.iterations), ("residual", np.maximum, arcs.residuals),
        ("converged", np.logical_and, arcs.converged), ("rate_bound", np.maximum, arcs.rates),
        ("fallbacks", np.add, arcs.fallbacks),
    ):  # fmt: skip
        columns[name] = [None] * contours
        for c, value in zip(some.tolist(), worst.reduceat(values, first).tolist() if len(some) else (), strict=True):
            columns[name][c] = value
    return columns
