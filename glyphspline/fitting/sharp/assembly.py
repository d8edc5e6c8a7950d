"""Pieces put together to contours, and their distance from the source."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...curves.cubics import spline_beziers
from ...curves.nearest import near_places
from ...curves.pairing import pair_instances, pair_stretches
from ...curves.slip import regular
from ...outlines.contour_arrays import ContourArrays, Polylines
from ...outlines.segments import all_cubics
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
    pieces: Pieces, v: int, contours: int, knots: FloatArray, controls: FloatArray, chords: FloatArray
) -> Assembly:
    """The curves of all pieces in master v.

    Args:
        contours: their number.
        knots, controls: of the splines of more than one span, one after the other: k + 1 knots each, and k + 3 control
            points of an arc or k of a closed curve.
        chords: (P,) the chord of each piece in all masters: what the tangents of an arc of one span go by.
    """
    P, arcs = len(pieces.spans), int((pieces.spans > 0).sum())
    segments = np.zeros(P + 1, dtype=np.int64)
    segments[1:] = np.cumsum(np.maximum(pieces.spans, 1))
    total = segments[P]
    points, degrees, b = np.empty((3 * total, 2)), np.full(total, 3), np.empty((total, 4, 2))
    offsets, starts = np.zeros(contours + 1, dtype=np.int64), np.zeros(contours + 1, dtype=np.int64)
    own, ends, closed = np.empty((total + 3 * arcs, 2)), np.zeros(arcs + 1, np.int64), np.empty(arcs, np.bool_)
    at = knot = control = arc = 0
    for q in range(P):
        c, k, ring, first = pieces.contour[q], pieces.spans[q], pieces.closed[q], pieces.starts[q]
        p, tau, count, end = pieces.vertices[first:, v], pieces.tangents[q, v], k + 3 * (1 - ring), ends[arc]
        if k == 0:
            points[at], degrees[segments[q]] = p[0], 1
        elif k == 1:
            third = chords[q] / 3
            for axis in range(2):
                own[end, axis], own[end + 3, axis] = p[0, axis], p[1, axis]
                own[end + 1, axis] = p[0, axis] + third * tau[0, axis]
                own[end + 2, axis] = p[1, axis] - third * tau[1, axis]
            points[at : at + 3] = own[end : end + 3]
        else:
            own[end : end + count] = controls[control : control + count]
            spline_beziers(own[end : end + count], knots[knot : knot + k + 1], ring > 0, b[:k])
            for s in range(k):
                points[at + 3 * s : at + 3 * s + 3] = b[s, :3]
            knot, control = knot + k + 1, control + count
        if k > 0:
            ends[arc + 1], closed[arc] = end + count, ring > 0
            arc += 1
        at += max(3 * k, 1)
        offsets[c + 1], starts[c + 1] = segments[q + 1], at
    return Assembly(
        ContourArrays(points[:at], degrees, offsets, starts), Polylines(own[: ends[arc]], ends, closed), segments
    )


@compiled
def find_anchors(pieces: Pieces, cubics: FloatArray, offsets: IntArray, contours: Chains) -> FloatArray:
    """(spans + C, 2) places on curves and on their sources where every span begins, and where every contour ends.

    A knot is paired with the point of the outline nearest to it, sought near the place of its vertex.

    Args:
        cubics: of all curves as they are written. offsets: (C + 1,) where each contour begins in them.
    """
    anchors = np.empty((len(cubics) + len(offsets) - 1, 2))
    at = 0
    for q in range(len(pieces.spans)):
        c, k, closed = pieces.contour[q], max(pieces.spans[q], 1), pieces.closed[q]
        outline = contours.cubics[0, contours.offsets[c] : contours.offsets[c + 1]]
        own = pieces.places[pieces.starts[q] : pieces.starts[q + 1]]
        m = len(outline)
        end = own[0] + m if closed else own[k]
        for s in range(k):
            anchors[at + c + s, 0], anchors[at + c + s, 1] = at - offsets[c] + s, own[s]
        if closed or k > 1:
            s = 0 if closed else 1  # an arc begins where the source's does
            places = anchors[at + c + s : at + c + k, 1]
            near_places(1, outline, own[s:k], cubics[at + s : at + k], closed > 0, own[0], end, places)
        anchors[at + c + k, 0] = at - offsets[c] + k
        anchors[at + c + k, 1] = anchors[at + c, 1] + m if closed else end
        if closed and anchors[at + c, 1] < 0.0:
            for s in range(k + 1):
                anchors[at + c + s, 1] += m
        at += k
    return anchors


def certify(
    contours: Chains, pieces: Pieces, segments: IntArray, written: ContourArrays, sharpness: float, limit: float
) -> tuple[FloatArray, FloatArray]:
    """(P,) certified bound between each piece, as written, and its stretch of contour; and the largest gap seen.

    Every span is paired on its own: a long piece paired as a whole may lose its way.

    Args:
        segments: see :class:`Assembly`. written: the curves, rounded.
        sharpness, limit: see :func:`...curves.pairing.pair_stretches`.
    """
    cubics, ends = all_cubics(written), written.offsets + np.arange(len(written.offsets))
    anchors = find_anchors(pieces, cubics, written.offsets, contours)
    bounds, gaps = pair_stretches(
        cubics, written.offsets, contours.cubics[0], contours.offsets, anchors, ends, sharpness, limit
    )
    return np.maximum.reduceat(bounds, segments[:-1]), np.maximum.reduceat(gaps, segments[:-1])


def certify_masters(
    contours: Chains, pieces: Pieces, segments: IntArray, curves: FloatArray, offsets: IntArray,
    mixes: FloatArray, limit: float, bounds: FloatArray, speed: BoolArray,
) -> None:  # fmt: skip
    """Certify pieces in a whole design space.

    Args:
        curves: (K, M, 4, 2) the curves in all masters; offsets: (C + 1,) where each contour begins in them.
        mixes: (V, K) weights of the masters at the corners of the design space's grid.
        bounds: (P,) receives the certified bounds of those pieces for which it is NaN.
        speed: (P,) receives whether their curves have speed everywhere.
    """
    V = len(mixes)
    results, sources = (
        np.einsum("vk,kmpc->mvpc", mixes, cubics).reshape(-1, 4, 2) for cubics in (curves, contours.cubics)
    )
    first = pieces.starts[:-1]
    spans = np.diff(segments)
    for c, a, b in zip(range(len(offsets) - 1), offsets[:-1], offsets[1:], strict=True):
        own = np.flatnonzero(pieces.contour == c)
        wanted = np.isnan(bounds[own])
        if not wanted.any():
            continue
        source = sources[V * contours.offsets[c] : V * contours.offsets[c + 1]]
        result, m, r = results[V * a : V * b], len(source) // V, b - a
        closed = bool(pieces.closed[own[0]])
        places, arcs = np.empty(r), np.empty((r, 4))
        for q, look in zip(own, wanted, strict=True):
            s, e = segments[q] - a, segments[q + 1] - a
            low, high = pieces.joints[q].astype(np.float64).tolist()
            arcs[s:e] = (-np.inf, np.inf, -np.inf, np.inf) if closed else (s, e, low, high)
            places[s:e] = pieces.places[first[q] : first[q] + e - s]
            inner = s if closed else s + 1  # an arc begins where the source's does
            if look and inner < e:
                begins = result[V * inner : V * e]
                near_places(V, source, places[inner:e], begins, closed, low, high, places[inner:e])
        if closed:
            places += m * np.ceil(max(-places[0], 0.0) / m)
        anchors = np.stack([np.arange(r + 1.0), np.append(places, places[0] + m)], axis=1)
        each = np.repeat(wanted, spans[own])
        found = np.where(each, np.nan, 0.0)
        ends = [np.array([0, count]) for count in (r, m, r + 1)]
        pair_instances(V, result, ends[0], source, ends[1], anchors, ends[2], arcs, 0.0, limit, found, np.zeros(r))
        good = regular(result.reshape(r, V, 4, 2)[each])
        starts = np.cumsum(spans[own][wanted]) - spans[own][wanted]
        bounds[own[wanted]] = np.maximum.reduceat(found[each], starts)
        speed[own[wanted]] = np.logical_and.reduceat(good, starts)
