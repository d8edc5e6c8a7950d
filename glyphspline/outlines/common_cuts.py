"""Two contours that do not correspond, cut into as many segments each: landmarks paired, and arcs put on common places.

A *place* is as :mod:`.landmarks` says. Cuts are exact: each contour stays the curve that it was.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from ..curves.bezier import split
from ..types import FloatArray, IntArray
from .elastic import elastic_nodes
from .landmarks import CORNER, STRONG, WEAK, Landmarks, wrapped
from .outline import Contour
from .pairing import cheapest_pairs

POSITION, DIRECTION, UNLIKE = 3.0, 0.5, 0.8
"""Cost of a pair: of the squared distance between its places in the contours' boxes, which are 1 wide and high, of the
squared differences of its unit tangents on both sides, and of the difference of its weights."""

APART, KIND = 0.5, 0.15
"""Cost of a pair inside an arc: of the squared distance of its places as shares of the arcs' lengths, instead of that
in the boxes; and of a line on one side of a landmark where the other has a curve."""

STRETCH = (1.0, 0.1)
"""Cost of a stretch between two pairs that is longer by the whole contour's, or the whole arc's, length."""

STARTS = (4, 5)
"""Landmarks from which alignments are tried, the most distinct ones, and partners tried for each."""

PLACE = 1.0

GAIN = 0.03

NODES = 128
"""Nodes of an arc, besides its joints."""

BEND = 1.5
"""Weight of direction beside length: pieces of arcs whose directions differ by a quarter circle over this are unlike."""

SNAP = 5e-3
"""Of the em: joints of both contours that would be cut nearer than this to each other become a pair."""

SLIVER = 5e-4
"""Of the em: joints nearer than this are one, whatever their tangents."""

PARALLEL = np.radians(25.0)
"""Largest angle between the tangents of two joints that become a pair by being near."""


def common_cuts(one: Landmarks, other: Landmarks) -> tuple[FloatArray, FloatArray, float]:
    """Places on two contours that correspond, all joints of both among them.

    Returns:
        (k,) ascending places on one, and (k,) those on the other, ascending too and within a lap; and the cost of the
        pairs of strong landmarks, a landmark.
    """
    pairs, cost = strong_pairs(one, other)
    laps = len(one.cubics), len(other.cubics)
    i, j = sure_pair(one, other, pairs)
    a, b = float(one.places[i]), float(other.places[j])
    cuts = [(a, b), *_arc(one, a, a + laps[0], other, b, b + laps[1])]
    found = np.array(cuts)
    found -= np.floor(found[:, :1] / laps[0]) * laps
    found = found[np.argsort(found[:, 0], kind="stable")]
    return found[:, 0], found[:, 1], cost


def strong_pairs(one: Landmarks, other: Landmarks) -> tuple[IntArray, float]:
    """(p, 2) indices of strong landmarks that correspond, at least one pair, and the cost of the alignment, a landmark.

    Without any, the nearest landmarks of all are a pair.
    """
    rows, columns = np.flatnonzero(one.weights >= STRONG), np.flatnonzero(other.weights >= STRONG)
    costs = pair_costs(one, other)
    bars = one.weights[rows, None] + other.weights[columns]
    own = costs[np.ix_(rows, columns)]
    allowed = np.where(own < bars, own, np.inf)
    turns = np.array([one.lap_turn, other.lap_turn])
    tables = one.table(rows), other.table(columns)
    cost, pairs = cheapest_pairs(allowed, *tables, turns, _starts(allowed, bars), STRETCH[0])
    if not cost < np.inf:
        return np.array([np.unravel_index(int(costs.argmin()), costs.shape)]), 0.0
    return np.stack([rows[pairs[:, 0]], columns[pairs[:, 1]]], axis=1), cost / (len(rows) + len(columns))


def sure_pair(one: Landmarks, other: Landmarks, pairs: IntArray) -> tuple[int, int]:
    """The pair of which no landmark has another partner that is nearly as good."""
    costs = pair_costs(one, other)
    gains = one.weights[:, None] + other.weights - costs
    best = -np.inf
    for i, j in pairs.tolist():
        others = np.concatenate([np.delete(gains[i], j), np.delete(gains[:, j], i)])
        clear = gains[i, j] - 0.9 * others.max(initial=0.0)
        if clear > best:
            best, chosen = clear, (i, j)
    return chosen


def pair_costs(one: Landmarks, other: Landmarks) -> FloatArray:
    """(n, m) costs of all pairs of landmarks."""
    apart = in_box(one)[:, None] - in_box(other)
    total = POSITION * (apart * apart).sum(axis=2) + UNLIKE * np.abs(one.weights[:, None] - other.weights)
    for mine, its in ((one.before, other.before), (one.after, other.after)):
        total += DIRECTION * 2 * (1 - np.cos(mine[:, None] - its))
    return total


def in_box(landmarks: Landmarks) -> FloatArray:
    """(n, 2) the landmarks in the box of all of them, from 0 to 1."""
    low, high = landmarks.points.min(axis=0), landmarks.points.max(axis=0)
    return (landmarks.points - low) / np.where(high > low, high - low, 1.0)


def _starts(allowed: FloatArray, bars: FloatArray) -> IntArray:
    """(k, 2) pairs of which one is surely right: of landmarks whose best partner is far better than the next."""
    gains = np.sort(np.where(allowed < np.inf, bars - allowed, 0.0), axis=1)[:, ::-1]
    distinct = gains[:, 0] - (0.9 * gains[:, 1] if gains.shape[1] > 1 else 0.0)
    starts = []
    for i in np.argsort(-distinct, kind="stable")[: STARTS[0]].tolist():
        for j in np.argsort(allowed[i], kind="stable")[: STARTS[1]].tolist():
            if allowed[i, j] < np.inf:
                starts.append((i, j))
    return np.array(starts, dtype=np.int64).reshape(-1, 2)


class _Arc:
    """An arc of a contour, with nodes at its ends, its joints, and evenly between them.

    Attributes:
        joints: places of those inside. length: of the arc. nodes: (n + 1,) from 0 to 1, as shares of the length.
        ways: (n,) directions of the chords between nodes.
    """

    def __init__(self, of: Landmarks, start: float, end: float) -> None:
        self.joints: FloatArray = np.arange(np.floor(start) + 1.0, np.ceil(end))
        self._at, rows = of.between(start, end)
        along = rows[:, 0] - rows[0, 0]
        self.length: float = along[-1]
        self._along = along / self.length
        within = of.places + np.ceil((start - of.places) / len(of.cubics)) * len(of.cubics)
        which = np.flatnonzero((within > start) & (within < end))
        which = which[np.argsort(within[which])]
        inner = self.shares(within[which])
        self.which = which
        even = np.arange(1, NODES) / NODES
        apart = np.abs(even[:, None] - inner).min(axis=1, initial=np.inf)
        self.nodes: FloatArray = np.concatenate([[0.0], np.sort([*inner, *even[apart > 0.3 / NODES]]), [1.0]])
        self.marks: IntArray = np.searchsorted(self.nodes, inner)
        steps = np.diff(of.at(self.places(self.nodes)), axis=0)
        low, high = of.points.min(axis=0), of.points.max(axis=0)
        points = (of.at(self.places(self.nodes)) - low) / np.where(high > low, high - low, 1.0)
        self.middles: FloatArray = (points[1:] + points[:-1]) / 2
        self.ways: FloatArray = np.arctan2(steps[:, 1], steps[:, 0])

    def shares(self, places: FloatArray) -> FloatArray:
        """The shares of the length up to places inside."""
        return np.interp(places, self._at, self._along)

    def places(self, shares: FloatArray) -> FloatArray:
        """The places at shares of the length."""
        return np.interp(shares, self._along, self._at)


def _arc(one: Landmarks, a: float, b: float, other: Landmarks, c: float, d: float) -> list[tuple[float, float]]:
    """The common places inside two arcs that correspond."""
    first, second = _Arc(one, a, b), _Arc(other, c, d)
    if not len(first.joints) and not len(second.joints):
        return []
    alike = np.cos(np.minimum(BEND * np.abs(wrapped(first.ways[:, None] - second.ways)), np.pi / 2))
    apart = first.middles[:, None] - second.middles
    alike -= PLACE * (apart * apart).sum(axis=2)
    steps = [np.maximum(np.diff(arc.nodes), 1e-9) for arc in (first, second)]
    gains = np.zeros((len(first.nodes), len(second.nodes)))
    bars = one.weights[:, None] + other.weights
    saved = GAIN * np.maximum(bars - pair_costs(one, other), 0.0)
    gains[np.ix_(first.marks, second.marks)] = saved[np.ix_(first.which, second.which)]
    pairs = elastic_nodes(*steps, alike, gains)
    s, t = first.nodes[pairs[:, 0]], second.nodes[pairs[:, 1]]
    common = (s + t) / 2
    x = np.interp(first.shares(first.joints), s, common)
    y = np.interp(second.shares(second.joints), t, common)
    same = _same(one, first.joints, x, other, second.joints, y, (first.length + second.length) / 2)
    i, j = same[:, 0], same[:, 1]
    mine = second.places(np.interp(np.interp(x, [0, *x[i], 1], [0, *y[j], 1]), common, t))
    its = first.places(np.interp(np.interp(y, [0, *y[j], 1], [0, *x[i], 1]), common, s))
    mine[i] = second.joints[j]
    left = np.delete(np.arange(len(y)), j)
    return sorted([*zip(first.joints, mine, strict=True), *zip(its[left], second.joints[left], strict=True)])


def _same(
    one: Landmarks, mine: FloatArray, x: FloatArray, other: Landmarks, its: FloatArray, y: FloatArray, length: float
) -> IntArray:
    """(p, 2) which joints of both arcs are one, as they are near enough: the nearest first, and in order."""
    apart = np.abs(x[:, None] - y) * length / one.em
    gap = apart
    for before in (True, False):
        turned = one.rows(mine, before=before)[:, None, 1] - other.rows(its, before=before)[:, 1]
        gap = np.where((np.abs(wrapped(turned)) < PARALLEL) | (apart < SLIVER), gap, np.inf)
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
    lines = contour.degrees[segments % m] == 1
    kept = np.where(lines[:, None], [True, False, False, False], [True, True, True, False])
    return Contour(pieces[kept], np.where(lines, 1, 3))
