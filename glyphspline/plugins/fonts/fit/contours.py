"""Chains of cubics as fonts store them: the fewest nodes, on the grid, with one tangent and one curvature at each.

``continuity="g2"``. A contour is cut at corners and long lines. The *run* between two cuts is a chain of segments;
nodes are chosen among its joints, one cubic fitted between each node and the next (:mod:`.fit.nodes`). Then all cubics
of the run are moved together until curvatures meet (:mod:`.harmony`), rounded together (:mod:`.lattice`), and certified
as rounded. Where a cubic fails, its stretch is fitted again more closely, and in the end stays as the source has it, to
the byte. So does a run in which nothing is gained. Where curvatures still jump, single nodes are moved
(:mod:`.fit.meeting`). What decides is here, in Python; what computes is compiled.

A contour in K masters has the same nodes in all of them, and is fitted in each by itself. What a joint turns by is
looked at in mixes of the masters too, and the certificate holds in the whole design space.

Lengths here are in steps of the grid, on which points have whole coordinates.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ....arrays import put
from ....compiled import compiled
from ....curves.nearest import near_places
from ....fitting.first_good import first_good
from ....fitting.sharp.settings import SharpSettings
from ....types import BoolArray, FloatArray, IntArray
from .gates import FitLimits, jumps_of, mixed, on_grid
from .meeting import let_meet
from .run_source import RunSource, Stretch
from .tries import KEPT, Tries

ATTEMPTS = 20
"""Tries of a run before it stays as it is. With 10, EB Garamond has 5 more curves, in the same time."""


class Fitted(NamedTuple):
    """A contour fitted, in steps of the grid.

    Attributes:
        cubics: (K, r, 4, 2) in K masters. nodes: (r,) joints of the source at which these begin.
        degrees: (r,) 1 or 3. inner: (r,) whether a segment begins inside a run.
        anchors: (r + 1, 2) places on it and on its source that belong together, see
            :func:`...curves.pairing.pair_stretches`.
    """

    cubics: FloatArray
    nodes: IntArray
    degrees: IntArray
    inner: BoolArray
    anchors: FloatArray


def fit_contour(
    cubics: FloatArray, degrees: IntArray, tries: IntArray, settings: SharpSettings, limits: FitLimits,
    fresh: BoolArray, last: Fitted | None,
) -> Fitted:  # fmt: skip
    """A contour (K, m, 4, 2) fitted from its own first joint on, if that is still a node, or else the next one.

    Args:
        tries: (m,) of each segment that were in vain. fresh: (m,) segments whose tries are not those of the last fit.
            Runs without any stay as they were in it.
    """
    m = len(degrees)
    if m == 1 or ((tries >= KEPT).all() and not (degrees == 2).any()):
        return unchanged(cubics, degrees)
    k, source = RunSource.of(cubics, degrees, settings, limits)
    if source is None:
        return unchanged(cubics, degrees)
    old = None
    if last is not None:
        at = (last.nodes - k) % m
        order = at.argsort()
        old = np.take(last.cubics, order, axis=1), at[order]
    around = np.concatenate((np.arange(k, m), np.arange(k)))
    found, starts, inner = fit_runs(source, tries[around], fresh[around], old)
    return Fitted(*turned_back(found, starts, inner, k, degrees, cubics, limits.corners))


def unchanged(cubics: FloatArray, degrees: IntArray) -> Fitted:
    """A contour (K, m, 4, 2) as it is."""
    m = len(degrees)
    anchors, kinds = np.empty((m + 1, 2)), np.full(m, 3)
    anchors[:, 0] = anchors[:, 1] = np.arange(m + 1)
    kinds[degrees == 1] = 1
    return Fitted(cubics, np.arange(m), kinds, np.zeros(m, np.bool_), anchors)


@compiled
def turned_back(
    cubics: FloatArray, starts: IntArray, inner: BoolArray, k: int, degrees: IntArray, source: FloatArray,
    corners: FloatArray,
) -> tuple[FloatArray, IntArray, IntArray, BoolArray, FloatArray]:  # fmt: skip
    """The arrays of :class:`Fitted`, of a contour (K, r, 4, 2) that was fitted from joint k of its source on.

    Args:
        starts: (r,) joints, counted from k, at which its cubics begin. inner: (r,) whether that is inside a run.
        degrees, source: (m,), (K, m, 4, 2). corners: (V, K) see :class:`.fit.gates.Limits`.
    """
    (K, r), m, V, first = cubics.shape[:2], len(degrees), len(corners), 0
    while first < r and starts[first] + k < m:
        first += 1
    found, nodes, kinds = np.empty_like(cubics), np.empty(r, np.int64), np.full(r, 3)
    inside, hints, places = np.empty(r, np.bool_), np.empty(r), np.empty(r)
    for s in range(r):
        old = (first + s) % r
        end = starts[old + 1] if old + 1 < r else m
        nodes[s], inside[s] = (starts[old] + k) % m, inner[old]
        if end - starts[old] == 1 and degrees[nodes[s]] == 1:
            kinds[s] = 1
        hints[s] = places[s] = nodes[s]
        for v in range(K):
            put(cubics[v, old], found[v, s])
    outline, begins, alike = mixed(corners, source), mixed(corners, found), np.ones(r, dtype=np.bool_)
    for s in range(r):
        for v in range(V):  # where it stays: the outline may come by here twice
            here, p = nodes[s] * V + v, s * V + v
            alike[s] = alike[s] and outline[here, 0, 0] == begins[p, 0, 0] and outline[here, 0, 1] == begins[p, 0, 1]
    near_places(V, outline, hints, begins, alike, True, 0.0, 0.0, places)
    lap, anchors = m if places[0] < 0.0 else 0, np.empty((r + 1, 2))
    for s in range(r):
        anchors[s, 0], anchors[s, 1] = s, places[s] + lap
    anchors[r, 0], anchors[r, 1] = r, anchors[0, 1] + m
    return found, nodes, kinds, inside, anchors


def fit_runs(
    source: RunSource, tries: IntArray, fresh: BoolArray, last: tuple[FloatArray, IntArray] | None
) -> tuple[FloatArray, IntArray, BoolArray]:  # fmt: skip
    """The runs of a contour.

    Args:
        tries, fresh: see :func:`fit_contour`. last: (K, r', 4, 2) the last fit, and the joints at which its cubics
            begin, in order.

    Returns:
        (K, r, 4, 2) its lines and cubics; (r,) the joints at which they begin; (r,) whether that is inside a run.
    """
    m, parts, starts, inner = len(tries), list[FloatArray](), list[int](), list[bool]()
    for i, j in pairwise([0, *(source.cuts[1:m].nonzero()[0] + 1).tolist(), m]):
        closed = i == 0 and j == m and not source.cuts[0]
        if j == i + 1 and not closed and source.alone[i]:
            run, own = source.cubics[:, i:j], [i]
        elif last is not None and not fresh[i:j].any():
            a, b = last[1].searchsorted((i, j)).tolist()
            run, own = last[0][:, a:b], last[1][a:b].tolist()
        else:
            run, nodes = fit_run(Stretch.of(source, i, j, closed), tries[i:j])
            own = (i + nodes).tolist()
        parts.append(run)
        starts += own
        inner += [closed] + [True] * (len(own) - 1)
    return np.concatenate(parts, axis=1), np.array(starts), np.array(inner)


def fit_run(own: Stretch, start: IntArray) -> tuple[FloatArray, IntArray]:
    """The n segments between two cuts as fewer cubics, or with curvatures that meet; or as they are.

    Args:
        start: (n,) tries of each segment that were in vain.

    Returns:
        (K, r, 4, 2) the cubics, and (r,) the nodes at which they begin.
    """
    n, source, degrees, em, closed = len(start), own.cubics, own.degrees, own.limits.em, own.closed
    jumps, whole = jumps_of(source, degrees, closed, em), on_grid(source, degrees, closed)
    tries = Tries(own, start, KEPT + (not whole and bool((degrees == 2).any())))

    def chains() -> Iterator[tuple[FloatArray, IntArray, bool]]:
        for _ in range(ATTEMPTS):
            P, places = tries.chosen()
            if P.shape[1] == n and jumps == 0 and whole:
                break
            yield P, places, tries.passes(P, places)
        yield source, np.arange(n + 1), True

    P, places, _ = first_good(chains(), lambda chain: (int(not chain[2]),))
    if P.shape[1] == n and whole and jumps_of(P, degrees, closed, em) >= jumps:
        P, places = source, np.arange(n + 1)
    if len(source) == 1:
        P = let_meet(own, P, places, start)
    return P, places[:-1]
