"""Pieces put together to contours, and their distance from the source."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...arrays import put
from ...compiled import compiled
from ...curves.nearest import near_places
from ...curves.pairing import pair_instances
from ...curves.slip import regular
from ...outlines.contour_arrays import ContourArrays, Polylines
from ...types import BoolArray, FloatArray, IntArray
from .cutting import Chains
from .pieces import Pieces


class Assembly(NamedTuple):
    """Pieces put together.

    Attributes:
        curves: the contours, a segment a span, of degree 1 for lines and 3 for others.
        controls: the control polygons of all arcs and closed curves.
        segments: (P + 1,) where in the segments of all contours each piece begins.
    """

    curves: ContourArrays
    controls: Polylines
    segments: IntArray


@compiled
def put_together(
    pieces: Pieces, v: int, contours: int, splines: FloatArray, controls: FloatArray, chords: FloatArray
) -> Assembly:
    """The curves of all pieces in master v.

    Args:
        contours: their number.
        splines, controls: of the splines of more than one span, one after the other: k cubics (4, 2) each, and k + 3
            control points of an arc or k of a closed curve.
        chords: (P,) the chord of each piece in all masters: what the tangents of an arc of one span go by.
    """
    P, arcs = len(pieces.spans), np.count_nonzero(pieces.spans > 0)
    segments = np.zeros(P + 1, dtype=np.int64)
    for q in range(P):
        segments[q + 1] = segments[q] + max(pieces.spans[q], 1)
    total = segments[P]
    points, degrees = np.empty((3 * total, 2)), np.full(total, 3)
    offsets, starts = np.zeros(contours + 1, dtype=np.int64), np.zeros(contours + 1, dtype=np.int64)
    own, ends, closed = np.empty((total + 3 * arcs, 2)), np.zeros(arcs + 1, np.int64), np.empty(arcs, np.bool_)
    at = span = control = arc = 0
    for q in range(P):
        c, k, ring, first = pieces.contour[q], pieces.spans[q], pieces.closed[q], pieces.starts[q]
        p, tau, count, end = pieces.vertices[first:, v], pieces.tangents[q, v], k + 3 * (1 - ring), ends[arc]
        if k == 0:
            points[at, 0], points[at, 1], degrees[segments[q]] = p[0, 0], p[0, 1], 1
        elif k == 1:
            third = chords[q] / 3
            for axis in range(2):
                own[end, axis], own[end + 3, axis] = p[0, axis], p[1, axis]
                own[end + 1, axis] = p[0, axis] + third * tau[0, axis]
                own[end + 2, axis] = p[1, axis] - third * tau[1, axis]
            put(own[end : end + 3], points[at : at + 3])
        else:
            put(controls[control : control + count], own[end : end + count])
            for s in range(k):
                put(splines[span + s, :3], points[at + 3 * s : at + 3 * s + 3])
            span, control = span + k, control + count
        if k > 0:
            ends[arc + 1], closed[arc] = end + count, ring > 0
            arc += 1
        at += max(3 * k, 1)
        offsets[c + 1], starts[c + 1] = segments[q + 1], at
    return Assembly(
        ContourArrays(points[:at], degrees, offsets, starts), Polylines(own[: ends[arc]], ends, closed), segments
    )


@compiled
def find_anchors(
    V: int, pieces: Pieces, results: FloatArray, offsets: IntArray, sources: FloatArray, source_offsets: IntArray
) -> FloatArray:
    """(spans + C, 2) places on curves and on their sources where every span begins, and where every contour ends.

    A knot is paired with the point of the outline nearest to it, sought near the place of its vertex.

    Args:
        results: (r V, 4, 2) all curves in V instances; offsets: (C + 1,) where each contour begins in them. sources:
            (m V, 4, 2), likewise.
    """
    anchors = np.empty((len(results) // V + len(offsets) - 1, 2))
    at = 0
    for q in range(len(pieces.spans)):
        c, k, closed = pieces.contour[q], max(pieces.spans[q], 1), pieces.closed[q]
        outline = sources[V * source_offsets[c] : V * source_offsets[c + 1]]
        own = pieces.places[pieces.starts[q] : pieces.starts[q + 1]]
        m = len(outline) // V
        end = own[0] + m if closed else own[k]
        for s in range(k):
            anchors[at + c + s, 0], anchors[at + c + s, 1] = at - offsets[c] + s, own[s]
        if closed or k > 1:
            s = 0 if closed else 1  # an arc begins where the source's does
            places, begins = anchors[at + c + s : at + c + k, 1], results[V * (at + s) : V * (at + k)]
            near_places(V, outline, own[s:k], begins, np.zeros(k - s, dtype=np.bool_), closed > 0, own[0], end, places)
        anchors[at + c + k, 0] = at - offsets[c] + k
        anchors[at + c + k, 1] = anchors[at + c, 1] + m if closed else end
        if closed and anchors[at + c, 1] < 0.0:
            for s in range(k + 1):
                anchors[at + c + s, 1] += m
        at += k
    return anchors


def certify(
    contours: Chains, pieces: Pieces, segments: IntArray, curves: FloatArray, offsets: IntArray,
    mixes: FloatArray | None, sharpness: float, limit: float, known: FloatArray,
) -> tuple[FloatArray, FloatArray, BoolArray]:  # fmt: skip
    """(P,) certified bound between each piece and its stretch of contour, of masters in the whole design space; the
    largest gap seen; and whether the curves of masters have speed everywhere.

    Every span is paired on its own: a long piece paired as a whole may lose its way.

    Args:
        segments: see :class:`Assembly`. curves: (K, M, 4, 2) the curves in all masters, or a plain outline's as they
            are written; offsets: (C + 1,) where each contour begins in them.
        mixes: (V, K) weights of the masters at the corners of the design space's grid; None for a plain outline.
        sharpness, limit: see :func:`...curves.pairing.pair_stretches`.
        known: (P,) bounds of pieces that are not measured again; NaN for the others.
    """
    V, spans, arcs = 1, np.diff(segments), np.empty((0, 4))
    results, sources = curves[0], contours.cubics[0]
    if mixes is not None:
        V, own = len(mixes), offsets[pieces.contour]
        results, sources = (
            np.einsum("vk,kmpc->mvpc", mixes, cubics).reshape(-1, 4, 2) for cubics in (curves, contours.cubics)
        )
        ends = np.stack([segments[:-1] - own, segments[1:] - own, *pieces.joints.T], axis=1).astype(np.float64)
        ends[pieces.closed > 0] = (-np.inf, np.inf, -np.inf, np.inf)
        arcs = np.repeat(ends, spans, axis=0)
    anchors = find_anchors(V, pieces, results, offsets, sources, contours.offsets)
    bounds, gaps = np.repeat(known, spans), np.zeros(int(segments[-1]))
    wanted = np.isnan(bounds)
    pair_instances(
        V, (results, offsets), (sources, contours.offsets), (anchors, offsets + np.arange(len(offsets))), arcs,
        sharpness, limit, bounds, gaps,
    )  # fmt: skip
    speed = np.ones(len(wanted), dtype=np.bool_)
    if mixes is not None:
        speed[wanted] = regular(results.reshape(-1, V, 4, 2)[wanted])
    first = segments[:-1]
    return np.maximum.reduceat(bounds, first), np.maximum.reduceat(gaps, first), np.logical_and.reduceat(speed, first)
