"""Two contours that do not correspond, cut into as many segments each: landmarks paired, and arcs put on common places.

A *place* is as :mod:`.landmarks` says. Cuts are exact: each contour stays the curve that it was.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from ..curves.bezier import split
from ..types import FloatArray, IntArray
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

BEND = 0.6
"""Weight of a quarter circle of turn on an arc, where the whole length of the arc has the weight 1."""

ROUND = 0.02
"""Of the em: reach, to both sides, over which the turn is averaged."""

SNAP = 5e-3
"""Of the em: joints of both contours that would be cut nearer than this to each other become a pair."""

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
    anchors = np.stack([one.places[pairs[:, 0]], other.places[pairs[:, 1]]], axis=1)
    anchors[:, 1] += laps[1] * np.concatenate([[0], np.cumsum(np.diff(anchors[:, 1]) < 0)])
    cuts: list[tuple[float, float]] = []
    for (a, c), (b, d) in pairwise([*anchors.tolist(), (anchors[0] + laps).tolist()]):
        for (a0, c0), (b0, d0) in pairwise([(a, c), *weak_pairs(one, a, b, other, c, d), (b, d)]):
            cuts += [(a0, c0), *_arc(one, a0, b0, other, c0, d0)]
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


def weak_pairs(one: Landmarks, a: float, b: float, other: Landmarks, c: float, d: float) -> list[tuple[float, float]]:
    """Places of landmarks that correspond inside two arcs, from a to b and from c to d, that do."""
    mine, its = one.inside(a, b), other.inside(c, d)
    if not len(mine) or not len(its):
        return []
    tables, turns = [], []
    for of, start, end, which in ((one, a, b, mine), (other, c, d, its)):
        ends, first = of.rows(np.array([start, end]), before=True), of.rows(np.array([start]))[0]
        inner = np.stack([
            of.weights[which % len(of)],
            of.rows(of.lap_places(which))[:, 0],
            of.rows(of.lap_places(which), before=True)[:, 1],
            of.rows(of.lap_places(which))[:, 1],
        ], axis=1)  # fmt: skip
        table = np.concatenate([[[0.0, first[0], ends[0, 1], first[1]]], inner])
        table[:, 1] = (table[:, 1] - first[0]) / (ends[1, 0] - first[0])
        tables.append(table)
        turns.append(ends[1, 1] - ends[0, 1])
    apart = tables[0][:, None, 1] - tables[1][:, 1]
    costs = APART * apart * apart + UNLIKE * np.abs(tables[0][:, None, 0] - tables[1][:, 0])
    for k in (2, 3):
        costs += DIRECTION * 2 * (1 - np.cos(tables[0][:, None, k] - tables[1][:, k]))
    kinds = one.kinds[mine % len(one)][:, None] - other.kinds[its % len(other)]
    costs[1:, 1:] += KIND * np.abs(kinds).sum(axis=2)
    weights = tables[0][:, None, 0], tables[1][None, :, 0]
    both = (np.minimum(*weights) >= WEAK) | (np.maximum(*weights) >= CORNER[0])
    allowed = np.where(both & (costs < weights[0] + weights[1]), costs, np.inf)
    allowed[0], allowed[:, 0] = np.inf, np.inf
    allowed[0, 0] = 0.0
    _, pairs = cheapest_pairs(
        allowed, tables[0], tables[1], np.array(turns), np.zeros((1, 2), dtype=np.int64), STRETCH[1]
    )
    pairs = pairs[pairs[:, 0] > 0] - 1
    return list(
        zip(one.lap_places(mine[pairs[:, 0]]).tolist(), other.lap_places(its[pairs[:, 1]]).tolist(), strict=True)
    )


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


class _Course:
    """An arc of a contour by a parameter from 0 to 1 that mixes length and turn.

    The turn is the mean of a stretch around, so that a corner which the other contour rounds has a stretch for it.
    """

    def __init__(self, of: Landmarks, start: float, end: float) -> None:
        self.at, rows = of.between(start, end)
        along = rows[:, 0] - rows[0, 0]
        self.length: float = along[-1]
        turned = rows[:, 2] - rows[0, 2]
        reach = np.minimum(ROUND * of.em, np.minimum(along, self.length - along))
        sums = np.append(0.0, np.cumsum(np.diff(along) * (turned[1:] + turned[:-1]) / 2))
        ahead, behind = np.interp(along + reach, along, sums), np.interp(along - reach, along, sums)
        turned = np.where(reach > 0, (ahead - behind) / np.where(reach > 0, 2 * reach, 1.0), turned)
        self.turned: FloatArray = turned
        self.along = along / self.length
        self.mixed = self.along

    def mix(self, turn: float) -> None:
        """Have the turn count for as much as ``turn``, in radians, though the arc may turn more."""
        weight = BEND * turn / (np.pi / 2)
        share = self.turned / self.turned[-1] if self.turned[-1] > 0 else self.along
        self.mixed = (self.along + weight * share) / (1 + weight)

    def parameters(self, places: FloatArray) -> FloatArray:
        """The parameters of places inside the arc."""
        return np.interp(places, self.at, self.mixed)

    def places(self, parameters: FloatArray) -> FloatArray:
        """The places at parameters."""
        return np.interp(parameters, self.mixed, self.at)


def _arc(one: Landmarks, a: float, b: float, other: Landmarks, c: float, d: float) -> list[tuple[float, float]]:
    """The common places inside two arcs that correspond."""
    mine, its = _joints_inside(a, b), _joints_inside(c, d)
    if not len(mine) and not len(its):
        return []
    first, second = _Course(one, a, b), _Course(other, c, d)
    turn = min(float(first.turned[-1]), float(second.turned[-1]))
    first.mix(turn)
    second.mix(turn)
    x, y = first.parameters(mine), second.parameters(its)
    pair = _nearest(one, mine, x, other, its, y, (first.length + second.length) / 2)
    if pair is not None:
        u, v = float(mine[pair[0]]), float(its[pair[1]])
        return [*_arc(one, a, u, other, c, v), (u, v), *_arc(one, u, b, other, v, d)]
    cuts = [*zip(mine, second.places(x), strict=True), *zip(first.places(y), its, strict=True)]
    return sorted(cuts)


def _nearest(
    one: Landmarks, mine: FloatArray, x: FloatArray, other: Landmarks, its: FloatArray, y: FloatArray, length: float
) -> tuple[int, int] | None:
    """Which joints of both arcs are nearest, if they are near enough to be one."""
    if not len(x) or not len(y):
        return None
    gap = np.abs(x[:, None] - y) * length
    for before in (True, False):
        turned = one.rows(mine, before=before)[:, None, 1] - other.rows(its, before=before)[:, 1]
        gap = np.where(np.abs(wrapped(turned)) < PARALLEL, gap, np.inf)
    i, j = np.unravel_index(int(gap.argmin()), gap.shape)
    return (int(i), int(j)) if gap[i, j] < SNAP * one.em else None


def _joints_inside(start: float, end: float) -> FloatArray:
    return np.arange(np.floor(start) + 1.0, np.ceil(end))


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
