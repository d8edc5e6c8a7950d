"""Two contours that do not correspond, cut into as many segments each, by an elastic alignment.

A *place* is as :mod:`.landmarks` says. Cuts are exact: each contour stays the curve that it was.
"""

from __future__ import annotations

import numpy as np

from ....curves.bezier import split
from ....outlines.contour_arrays import lines_and_cubics
from ....outlines.outline import Contour
from ....types import FloatArray, IntArray
from .alignment import cheapest_pairs, elastic_nodes
from .landmarks import STRONG, Landmarks, wrapped

POSITION, DIRECTION, UNLIKE = 3.0, 0.5, 0.8
"""Cost of a pair: of the squared distance between its places in the contours' boxes, which are 1 wide and high, of the
squared differences of its unit tangents on both sides, and of the difference of its weights."""

STARTS = (4, 5)
"""Landmarks from which alignments are tried, the most distinct ones, and partners tried for each."""

NODES, LEAST = 128, 3
"""Pieces of a whole contour, more or less, and of each stretch between landmarks at least, unless it is a sliver: the
end of a thin stroke becomes that of a bold one, ten times as wide."""

BEND, PLACE = 1.5, 1.0
"""Weight of direction beside length: pieces whose directions differ by a quarter circle over this are not alike. How
much less alike two pieces are for the squared distance between their places in the contours' boxes."""

SNAP = 5e-3
"""Of the em: joints of both contours that would be cut nearer than this to each other become a pair."""

PARALLEL = np.radians(25.0)
"""Largest angle between the tangents of two joints that become a pair by being near."""


def common_cuts(one: Landmarks, other: Landmarks) -> tuple[FloatArray, FloatArray, float]:
    """Places on two contours that correspond, all joints of both among them.

    The surest pair of strong landmarks is where both laps begin. From there an elastic alignment goes once around.

    Returns:
        (k,) ascending places on one, and (k,) those on the other, ascending too and within a lap; and the cost of the
        pairs of strong landmarks, a landmark.
    """
    costs = pair_costs(one, other)
    pairs, cost = _strong_pairs(one, other, costs)
    i, j = _surest(one.weights[:, None] + other.weights - costs, pairs)
    starts = np.array([one.places[i], other.places[j]])
    found = np.concatenate([[starts], _aligned(_Lap(one, i), _Lap(other, j))])
    found -= np.floor(found[:, :1] / len(one.cubics)) * (len(one.cubics), len(other.cubics))
    found = found[np.argsort(found[:, 0], kind="stable")]
    return found[:, 0], found[:, 1], cost


def _strong_pairs(one: Landmarks, other: Landmarks, costs: FloatArray) -> tuple[IntArray, float]:
    """(p, 2) indices of strong landmarks that correspond, or of the nearest two; the alignment's cost a landmark."""
    rows, columns = np.flatnonzero(one.weights >= STRONG), np.flatnonzero(other.weights >= STRONG)
    bars = one.weights[rows, None] + other.weights[columns]
    own = costs[np.ix_(rows, columns)]
    allowed = np.where(own < bars, own, np.inf)
    cost, pairs = cheapest_pairs(allowed, one.table(rows), other.table(columns), _starts(allowed, bars))
    if not cost < np.inf:
        return np.array([np.unravel_index(int(costs.argmin()), costs.shape)]), 0.0
    return np.stack([rows[pairs[:, 0]], columns[pairs[:, 1]]], axis=1), cost / (len(rows) + len(columns))


def _surest(gains: FloatArray, pairs: IntArray) -> tuple[int, int]:
    """The pair in which neither landmark has another partner nearly as good."""
    rows, columns = pairs.T
    own = gains[rows, columns]
    gains[rows, columns] = 0.0
    second = np.maximum(gains[rows].max(axis=1), gains[:, columns].max(axis=0))
    i, j = pairs[np.argmax(own - 0.9 * np.maximum(second, 0.0))].tolist()
    return i, j


def pair_costs(one: Landmarks, other: Landmarks) -> FloatArray:
    """(n, m) costs of all pairs of landmarks."""
    apart = in_box(one, one.points)[:, None] - in_box(other, other.points)
    total = POSITION * (apart * apart).sum(axis=2) + UNLIKE * np.abs(one.weights[:, None] - other.weights)
    for mine, its in ((one.before, other.before), (one.after, other.after)):
        total += DIRECTION * 2 * (1 - np.cos(mine[:, None] - its))
    return total


def pair_gains(one: Landmarks, other: Landmarks) -> FloatArray:
    """(n, m) what taking two landmarks for partners gains over leaving both without: their weights, if alike.

    A corner gains by any joint that turns little against it: a joint that one master shows was drawn in both.
    """
    # Share of the difference of their weights that two landmarks which are a pair do not gain.
    gains = one.weights[:, None] + other.weights - 0.5 * np.abs(one.weights[:, None] - other.weights)
    for mine, its in ((one.before, other.before), (one.after, other.after)):
        gains -= DIRECTION * (1 - np.cos(mine[:, None] - its))
    return np.maximum(gains, 0.0)


def in_box(landmarks: Landmarks, points: FloatArray) -> FloatArray:
    """(n, 2) points in the box of all landmarks, from 0 to 1."""
    low, high = landmarks.points.min(axis=0), landmarks.points.max(axis=0)
    return (points - low) / np.where(high > low, high - low, 1.0)


def _starts(allowed: FloatArray, bars: FloatArray) -> IntArray:
    """(k, 2) pairs, one of them surely right: of landmarks whose best partner is far better than the next."""
    if not allowed.size:
        return np.empty((0, 2), dtype=np.int64)
    gains = np.sort(np.where(allowed < np.inf, bars - allowed, 0.0), axis=1)[:, ::-1]
    distinct = gains[:, 0] - (0.9 * gains[:, 1] if gains.shape[1] > 1 else 0.0)
    starts = []
    for i in np.argsort(-distinct, kind="stable")[: STARTS[0]].tolist():
        for j in np.argsort(allowed[i], kind="stable")[: STARTS[1]].tolist():
            if allowed[i, j] < np.inf:
                starts.append((i, j))
    return np.array(starts, dtype=np.int64).reshape(-1, 2)


class _Lap:
    """A contour once around from a landmark, with nodes at its ends, at its landmarks, and evenly between them.

    Attributes:
        of: the contour. joints: (k,) places of those inside. nodes: (n + 1,) from 0 to 1, as shares of the length.
        inner: the landmarks inside, as they follow. marks: which nodes these are. ways: (n,) directions of the chords
            between nodes. middles: (n, 2) of these chords, in the contour's box, from 0 to 1.
    """

    def __init__(self, of: Landmarks, first: int) -> None:
        self.of, m = of, len(of.cubics)
        self._at, lengths = of.lap(first)
        self._along: FloatArray = (lengths - lengths[0]) / (lengths[-1] - lengths[0])
        self.joints: FloatArray = np.arange(np.floor(self._at[0]) + 1.0, np.ceil(self._at[0] + m))
        around = np.arange(first + 1, first + len(of))
        self.inner: IntArray = around % len(of)
        ends = np.concatenate([[0.0], self.shares(of.places[self.inner] + around // len(of) * m), [1.0]])
        gaps = np.diff(ends)
        least = np.where(gaps * of.length < SNAP * of.em, 1, LEAST)
        counts = np.maximum(np.ceil(gaps * NODES), least).astype(np.int64)
        cells = np.repeat(np.arange(len(gaps)), counts)
        within = np.arange(len(cells)) - np.repeat(np.cumsum(counts) - counts, counts)
        self.nodes: FloatArray = np.append(ends[cells] + gaps[cells] * within / counts[cells], 1.0)
        self.marks: IntArray = np.cumsum(counts)[:-1]
        points = of.contour.at(self.places(self.nodes))
        steps = np.diff(points, axis=0)
        self.ways: FloatArray = np.arctan2(steps[:, 1], steps[:, 0])
        inside = in_box(of, points)
        self.middles: FloatArray = (inside[1:] + inside[:-1]) / 2

    def shares(self, places: FloatArray) -> FloatArray:
        """The shares of the length up to places inside."""
        return np.interp(places, self._at, self._along)

    def places(self, shares: FloatArray) -> FloatArray:
        """The places at shares of the length."""
        return np.interp(shares, self._along, self._at)


def _aligned(one: _Lap, other: _Lap) -> FloatArray:
    """(k, 2) the common places inside two laps, ascending."""
    apart = one.middles[:, None] - other.middles
    alike = np.cos(np.minimum(BEND * np.abs(wrapped(one.ways[:, None] - other.ways)), np.pi / 2))
    alike -= PLACE * (apart * apart).sum(axis=2)
    gains = np.zeros((len(one.nodes), len(other.nodes)))
    # Weight of pairs of landmarks, where two contours that are alike all along have the weight 1.
    gains[np.ix_(one.marks, other.marks)] = 0.03 * pair_gains(one.of, other.of)[np.ix_(one.inner, other.inner)]
    mine, its = (np.maximum(np.diff(lap.nodes), 1e-9) for lap in (one, other))
    pairs = elastic_nodes(mine, its, alike, gains)
    s, t = one.nodes[pairs[:, 0]], other.nodes[pairs[:, 1]]
    common = (s + t) / 2
    x = np.interp(one.shares(one.joints), s, common)
    y = np.interp(other.shares(other.joints), t, common)
    same = _same(one, x, other, y)
    i, j = same[:, 0], same[:, 1]
    mine = other.places(np.interp(np.interp(x, [0, *x[i], 1], [0, *y[j], 1]), common, t))
    its = one.places(np.interp(np.interp(y, [0, *y[j], 1], [0, *x[i], 1]), common, s))
    mine[i] = other.joints[j]
    found = [np.stack([one.joints, mine], axis=1), np.delete(np.stack([its, other.joints], axis=1), j, axis=0)]
    cuts = np.concatenate(found)
    return cuts[np.argsort(cuts[:, 0], kind="stable")]


def _same(one: _Lap, x: FloatArray, other: _Lap, y: FloatArray) -> IntArray:
    """(p, 2) which joints of both laps, by their common parameters, are near enough to be one; the nearest first."""
    apart = np.abs(x[:, None] - y) * (one.of.length + other.of.length) / 2 / one.of.em
    gap = apart
    for before in (True, False):
        mine, its = (lap.of.rows(lap.joints, before=before)[:, 1] for lap in (one, other))
        # Of the em: joints nearer than this are one, whatever their tangents.
        gap = np.where((np.abs(wrapped(mine[:, None] - its)) < PARALLEL) | (apart < 5e-4), gap, np.inf)
    found: list[tuple[int, int]] = []
    for k in np.argsort(gap, axis=None, kind="stable").tolist():
        i, j = divmod(k, len(y))
        if not gap[i, j] < SNAP:
            break
        if all((p - i) * (q - j) > 0 for p, q in found):
            found.append((i, j))
    return np.array(sorted(found), dtype=np.int64).reshape(-1, 2)


def cut(contour: Contour, places: FloatArray) -> Contour:
    """A contour cut at (k,) ascending places, which are within a lap and among which are all joints.

    Its segments are lines and cubics.
    """
    cubics, m = contour.cubics(), len(contour)
    ends = np.concatenate([places[1:], [places[0] + m]])
    first: FloatArray = np.floor(places)
    segments = first.astype(np.int64)
    start, end = (places - first)[:, None, None], (ends - first)[:, None, None]
    pieces = split(split(cubics[segments % m], end)[0], start / end)[1]
    return Contour(*lines_and_cubics(pieces, contour.degrees[segments % m] == 1))
