"""One closed spline a contour, whatever it is made of: triple knots stand at corners and at the ends of lines.

The control point at a triple knot is the vertex itself. Arcs between such knots are the clamped splines of variant 2,
with their own control points and knot intervals; straight lines, and segments kept from a source, are spans alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from ..interpolation.result import Interpolation
from ..outlines.contour_arrays import ContourArrays, Polylines, joined_offsets, members_of, offsets_of
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

    C, curved = curves.num_contours, curves.degrees > 1
    of_segment, of_arc = (np.repeat(np.arange(C), np.diff(offsets)) for offsets in (curves.offsets, arc_offsets))
    given = [arc.spline.knots for arc in arcs]
    spans, still = np.array([(len(u) - 1, u[0] == u[-1]) for u in given], dtype=np.int64).reshape(-1, 2).T
    fitted = np.bincount(of_arc, spans, C) == np.bincount(of_segment, curved, C)
    fitted &= np.bincount(of_arc, still, C) == 0
    curved &= fitted[of_segment]
    used, lone = np.flatnonzero(fitted[of_arc]), np.flatnonzero(~curved)
    cubics = all_cubics(curves)[lone]
    legs = np.hypot(*np.moveaxis(np.diff(cubics, axis=1), 2, 0)).sum(axis=1)
    lone, cubics, legs = lone[legs > 0.0], cubics[legs > 0.0], legs[legs > 0.0]

    # Pieces: the arcs, then the segments alone; and in the order of the curves.
    ends = np.stack([np.zeros_like(legs), legs], axis=1)
    knots, points = np.concatenate([*given, ends.ravel()]), np.concatenate([controls.points, cubics.reshape(-1, 2)])
    every = np.concatenate([spans, np.ones(len(lone), dtype=np.int64)])
    own = np.concatenate([used, len(spans) + np.arange(len(lone))])
    first = np.flatnonzero(curved)[offsets_of(spans[used])[:-1]]
    own = own[np.argsort(np.concatenate([first, lone]))]
    k, of_piece = every[own], np.concatenate([of_arc, of_segment[lone]])[own]
    broken = ~np.concatenate([controls.closed, np.zeros(len(lone), dtype=np.bool_)])[own]
    at = offsets_of(every + 1)[own]
    lengths = knots[at + k] - knots[at]
    of_contour = np.searchsorted(of_piece, np.arange(C + 1))
    starts, total = np.zeros(len(own)), np.zeros(C)
    for c, (a, b) in enumerate(pairwise(of_contour.tolist())):
        until = np.cumsum(lengths[a:b])  # of each contour alone: its bytes do not depend on others
        starts[a + 1 : b], total[c : c + (b > a)] = until[:-1], until[-1:]

    # The last control point of an arc is the first one of what follows, and its first knot is triple.
    of_points, parts = members_of(joined_offsets([controls.offsets, offsets_of(np.full(len(lone), 4))]), own)
    points = np.delete(points[of_points], parts[1:][broken] - 1, axis=0)
    of_knots, parts = members_of(offsets_of(every + 1), own)
    times = np.ones(len(of_knots), dtype=np.int64)
    times[parts[:-1][broken]], times[parts[1:][~broken] - 1] = 2, 0
    placed = np.repeat(knots[of_knots] - np.repeat(knots[at], k + 1) + np.repeat(starts, k + 1), times)
    offsets = offsets_of(k + 2 * broken)[of_contour]
    return np.insert(placed, offsets[1:], total), Polylines(points, offsets, np.ones(C, dtype=np.bool_))
