"""One closed spline a contour, whatever it is made of: triple knots stand at corners and at the ends of lines.

The control point at a triple knot is the vertex itself. Arcs between such knots are the clamped splines of variant 2,
with their own control points and knot intervals; straight lines, and segments kept from a source, are spans alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from ..interpolation.result import Interpolation
from ..outlines.contour_arrays import ContourArrays, Polylines, offsets_of
from ..types import FloatArray, IntArray


def whole_splines(
    curves: ContourArrays, arcs: Sequence[Interpolation], controls: Polylines, arc_offsets: IntArray
) -> tuple[FloatArray, Polylines]:
    """The curves of C contours as cubic closed splines, from the same first point.

    Args:
        curves, arcs, controls, arc_offsets: as :class:`.results.ConvertedContours` has them. Segments of contours
            without arcs stand for themselves.

    Returns:
        Knots, n + 1 a contour of n control points, and the control points. A spline of one closed arc is that of the
        arc, bit by bit; other knots begin with 0, 0 and end with T, T. A contour without length has the knot 0 alone.
    """
    from ..outlines.segments import all_cubics  # here and not above: the package opens without a compiler

    cubics, lines, begins = all_cubics(curves), curves.degrees == 1, controls.offsets
    legs = np.hypot(*np.moveaxis(np.diff(cubics, axis=1), 2, 0)).sum(axis=1)
    given = [arc.spline.knots for arc in arcs]
    knots, points, counts = [np.empty(0)], [np.empty((0, 2))], []
    for (s, end), (q, last) in zip(pairwise(curves.offsets.tolist()), pairwise(arc_offsets.tolist()), strict=True):
        own, until = given[q:last], 0.0
        fitted = sum(len(u) - 1 for u in own) == (end - s) - lines[s:end].sum() and all(u[0] != u[-1] for u in own)
        counts.append(0)
        while s < end:
            if fitted and not lines[s]:
                u, P, ring = given[q], controls.points[begins[q] : begins[q + 1]], controls.closed[q]
                s, q = s + len(u) - 1, q + 1
            else:
                u, P, ring = np.array([0.0, legs[s]]), cubics[s], False
                s += 1
            if u[0] == u[-1]:
                continue
            placed = u - u[0] + until
            # The last control point of an arc is the first one of what follows, and its first knot is triple.
            knots += [placed[:-1]] if ring else [placed[:1], placed]
            points.append(P if ring else P[:-1])
            counts[-1] += len(points[-1])
            until += u[-1] - u[0]
        knots.append(np.array([until]))
    closed = np.ones(len(counts), dtype=np.bool_)
    return np.concatenate(knots), Polylines(np.concatenate(points), offsets_of(counts), closed)
