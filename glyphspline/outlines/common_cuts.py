"""Two contours that do not correspond, cut into as many segments each: landmarks paired, and arcs put on common places.

A *place* is as :mod:`.landmarks` says. Cuts are exact: each contour stays the curve that it was.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from ..curves.bezier import split
from ..types import FloatArray, IntArray
from .landmarks import Landmarks, wrapped
from .outline import Contour
from .pairing import cheapest_pairs

POSITION, DIRECTION = 3.0, 0.5
"""Cost of a pair: of the squared distance between its places in the contours' boxes, which are 1 wide and high, and of
the squared differences of its unit tangents on both sides."""

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
        pairs of landmarks, a landmark.
    """
    pairs, cost = paired_landmarks(one, other)
    u, v = one.places[pairs[:, 0]], other.places[pairs[:, 1]]
    m = len(other.cubics)
    v = v + m * np.concatenate([[0], np.cumsum(np.diff(v) < 0)])
    cuts: list[tuple[float, float]] = []
    ends = zip(pairwise([*u, u[0] + len(one.cubics)]), pairwise([*v, v[0] + m]), strict=True)
    for (a, b), (c, d) in ends:
        cuts += [(a, c), *_arc(one, a, b, other, c, d)]
    found = np.array(cuts)
    lap = np.floor(found[:, 0] / len(one.cubics))
    found -= lap[:, None] * (len(one.cubics), m)
    found = found[np.argsort(found[:, 0], kind="stable")]
    return found[:, 0], found[:, 1], cost


def paired_landmarks(one: Landmarks, other: Landmarks) -> tuple[IntArray, float]:
    """(p, 2) indices of landmarks that correspond, at least one pair, and the cost of the alignment, a landmark."""
    rows, columns = np.flatnonzero(one.weights > 0), np.flatnonzero(other.weights > 0)
    costs = pair_costs(one, other)[np.ix_(rows, columns)]
    bars = one.weights[rows, None] + other.weights[columns]
    allowed = np.where(costs < bars, costs, np.inf)
    starts = _starts(allowed, bars)
    tables = [
        np.stack([of.weights, of.lengths, of.before, of.after], axis=1)[which]
        for of, which in ((one, rows), (other, columns))
    ]
    cost, pairs = cheapest_pairs(allowed, *tables, np.array([one.lap_turn, other.lap_turn]), starts)
    if not cost < np.inf:
        costs = pair_costs(one, other)
        return np.array([np.unravel_index(int(costs.argmin()), costs.shape)]), np.inf
    return np.stack([rows[pairs[:, 0]], columns[pairs[:, 1]]], axis=1), cost / (len(rows) + len(columns))


def pair_costs(one: Landmarks, other: Landmarks) -> FloatArray:
    """(n, m) costs of all pairs of landmarks."""
    apart = in_box(one)[:, None] - in_box(other)
    total = POSITION * (apart * apart).sum(axis=2)
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
        self.mixed: FloatArray = along / self.length + BEND * turned / (np.pi / 2)
        self.mixed /= self.mixed[-1]

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
    segments = np.floor(places).astype(np.int64)
    start, end = (places - segments)[:, None, None], (ends - segments)[:, None, None]
    pieces = split(split(cubics[segments % m], end)[0], start / end)[1]
    lines = contour.degrees[segments % m] == 1
    kept = np.where(lines[:, None], [True, False, False, False], [True, True, True, False])
    return Contour(pieces[kept], np.where(lines, 1, 3))
