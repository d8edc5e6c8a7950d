"""The smallest moves of points that mend lines off level and long handles; those at extrema are in :mod:`.extrema`.

Each works on one finding, in all K masters alike: a move is the numbers (P,) of points in the contour and their new
places (K, P, 2), on a grid. None adds a point or takes one away. Whether a move mends the finding, how far it moves the
curves, and what else is found then is measured afterwards; here are only those worth a try, the least first.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from itertools import product
from typing import NamedTuple

import numpy as np

from ...curves.bezier import cross
from ...outlines.flaws.turns import joint_controls, turns_of
from ...outlines.masters import MasterContour, Masters
from ...types import FloatArray, IntArray
from .extrema import extremum_moves, level_moves
from .joints import SMOOTH, ContourLayout, Move, starts_of
from .state import Change

NEARLY = np.tan(np.radians(1.0))
"""Slope up to which a line is level in another master, too; one that is steeper anywhere is meant, and stays."""

SHARES = (0.5, 0.0, 1.0)
"""Where between its ends a line off level comes to lie: midway, or at one of them."""

WITHIN = (1.0, 0.97, 0.93, 0.85)
"""Shares of the length at which handles meet, to which longer ones are cut: on the grid, one may still be too long."""

ROUND = 0.5523
"""The share of a quarter of a circle, for two handles that are both too long."""

PARTS = (0.5523, 0.65, 0.75, 0.85)
"""Other shares of the way to that place."""

STEPS = 16
"""Steps in which lengths of both handles are found at which curvatures meet, as each depends on the other."""

LEAST = 0.5
"""Share that such a length has at least of what the other handle's share makes of it."""


def shape_moves(kind: str, contour: MasterContour, segment: int, step: float) -> Iterator[Move]:
    """Moves for a finding of ``MOVED`` at a segment, or at the joint where it begins; on a grid of ``step``."""
    for numbers, places in MOVED[kind](contour, segment):
        rounded = np.round(places / step) * step
        kept = places == contour.points[:, numbers]
        yield with_nodes(contour, numbers, np.where(kept, places, rounded), step)


def with_nodes(contour: MasterContour, numbers: IntArray, places: FloatArray, step: float) -> Move:
    """A move with that of nodes of quadratics beside it: those about midway between their control points go where, on
    the grid, they turn least."""
    starts, count = starts_of(contour), contour.points.shape[1]
    between = starts[(contour.degrees == 2) & (np.roll(contour.degrees, 1) == 2)]
    beside = np.concatenate([numbers - 1, numbers + 1]) % count
    nodes = np.setdiff1d(np.intersect1d(between, beside), numbers)
    if not len(nodes):
        return numbers, places
    points = contour.points.copy()
    points[:, numbers] = places
    a, b, old = points[:, nodes - 1], points[:, (nodes + 1) % count], points[:, nodes]
    middle = (a + b) / 2
    near = (np.abs(old - middle).max(axis=2) <= step).all(axis=0) & (old != middle).any(axis=(0, 2))
    a, b, old, middle, nodes = a[:, near], b[:, near], old[:, near], middle[:, near], nodes[near]
    around = step * np.stack(np.meshgrid(*[np.arange(-1.0, 2.0)] * 2), axis=-1).reshape(-1, 1, 1, 2)
    tried = np.concatenate([old[None], np.round(middle / step) * step + around])  # (T, K, n, 2)
    off = np.abs(cross(tried - a, b - a)) + np.where(np.abs(tried - middle).max(axis=3) <= step, 0.0, np.inf)
    best = np.take_along_axis(tried, off.argmin(axis=0)[None, ..., None], axis=0)[0]
    return np.append(numbers, nodes), np.concatenate([places, best], axis=1)


def moved(contour: MasterContour, numbers: IntArray, places: FloatArray) -> MasterContour:
    """A contour after a move; a node midway between two control points of quadratics stays so, as fonts imply it."""
    points, at = contour.points.copy(), np.flatnonzero(ContourLayout(contour).implied)
    points[:, numbers] = places
    points[:, at] = (points[:, at - 1] + points[:, (at + 1) % points.shape[1]]) / 2
    return MasterContour(points, contour.degrees)


class Proposal(NamedTuple):
    """New places (K, P, 2) of points (P,) of a contour, and how far its curves move then, certified."""

    numbers: IntArray
    places: FloatArray
    distance: float


def with_moves(masters: Masters, proposals: Iterable[tuple[int, Proposal]]) -> Masters:
    """A glyph after moves of contours, which are given by their numbers."""
    contours = list(masters.contours)
    for c, (numbers, places, _) in proposals:
        contours[c] = moved(contours[c], numbers, places)
    return replace(masters, contours=contours)


def with_result(change: Change, numbers: IntArray, old: FloatArray, new: FloatArray, distance: float) -> Change:
    """What became of a finding that is mended, for which points (P,) went from old to new places (K, P, 2)."""
    moves = tuple(
        (k, p, (x, y), (u, v))
        for k, (before, behind) in enumerate(zip(old.tolist(), new.tolist(), strict=True))
        for p, (x, y), (u, v) in zip(numbers.tolist(), before, behind, strict=True)
        if (x, y) != (u, v)
    )
    most = float(np.hypot(*(new - old).reshape(-1, 2).T).max(initial=0.0))
    return replace(change, moved=most, moves=moves, distance=distance)


def line_moves(contour: MasterContour, segment: int) -> Iterator[Move]:
    """A line made level: its ends, with or without the handles there; first at the height of more nodes."""
    count, m = contour.points.shape[1], len(contour)
    a = int(starts_of(contour)[segment])
    b = (a + 1) % count
    way = contour.points[:, b] - contour.points[:, a]
    axis = int(np.abs(way).max(axis=0).argmin())
    if (np.abs(way[:, axis]) > NEARLY * np.abs(way[:, 1 - axis])).any():
        return
    handles = [(a, (a - 1) % count)] * bool(contour.degrees[segment - 1] > 1)
    handles += [(b, (b + 1) % count)] * bool(contour.degrees[(segment + 1) % m] > 1)
    nodes = contour.points[:, starts_of(contour), axis]
    alike = [int((nodes == contour.points[:, [end], axis]).all(axis=0).sum()) for end in (a, b)]
    shares = sorted(SHARES, key=lambda share: -np.interp(share, [0, 1], alike)) if alike[0] != alike[1] else SHARES
    for share, carried in product(shares, (True, False) if handles else (False,)):
        level = contour.points[:, a, axis] + share * way[:, axis]
        level = np.where(way[:, axis] == 0, level, np.round(level))
        numbers = [a, b, *(end for _, end in handles)] if carried else [a, b]
        places = contour.points[:, numbers].copy()
        for k, number in enumerate(numbers):
            own = number if k < 2 else handles[k - 2][0]
            places[:, k, axis] += level - contour.points[:, own, axis]
        yield np.array(numbers), places


def handle_moves(contour: MasterContour, segment: int) -> Iterator[Move]:
    """Handles cut so that curvature meets the neighbour's; to the other one's share of the way to where both meet; to
    others of it; to that place, or to the other end.

    In masters where they do not reach as far they stay.
    """
    if contour.degrees[segment] != 3:
        return
    count = contour.points.shape[1]
    numbers = (starts_of(contour)[segment] + np.arange(4)) % count
    points = contour.points[:, numbers]
    u, v, chord = points[:, 1] - points[:, 0], points[:, 2] - points[:, 3], points[:, 3] - points[:, 0]
    shares = np.ones((len(points), 2))
    with np.errstate(divide="ignore", invalid="ignore"):
        across = cross(u, v)
        meets = np.stack([cross(chord, v), cross(chord, u)], axis=1) / across[:, None]
        size = (chord * chord).sum(axis=1)
        ends = np.stack([size / (u * chord).sum(axis=1), -size / (v * chord).sum(axis=1)], axis=1)
    both = np.asarray(np.isfinite(meets).all(axis=1) & (meets > 0).all(axis=1))
    shares[both] = np.minimum(shares[both], meets[both])
    if both.any():
        own = np.where(both[:, None], 1 / meets, 1.0)
        other = np.where(own[:, ::-1] < 1, own[:, ::-1], ROUND)
        alike = np.where(own > 1, other / own, 1.0)
        bent = alike_curved(contour, segment, points, alike)
        if bent is not None:
            yield numbers[1:3], cut(points, bent)
        yield numbers[1:3], cut(points, alike)
        for share in PARTS:
            yield numbers[1:3], cut(points, np.where(own > 1, share / own, 1.0))
    shares = np.where((ends > 0) & (ends < shares), ends, shares)
    if (shares >= 1).all():
        return
    for within in WITHIN:
        yield numbers[1:3], cut(points, np.where(shares < 1, within * shares, 1.0))


def alike_curved(contour: MasterContour, segment: int, points: FloatArray, shares: FloatArray) -> FloatArray | None:
    """(K, 2) shares of handles of a cubic (K, 4, 2), from those given, at which curvatures meet its neighbours'.

    Only handles that are cut in all masters, at smooth joints with a cubic, get others; None if there are none.
    """
    m, shares = len(contour), shares.copy()
    controls, ends = joint_controls(contour)[:, [segment, (segment + 1) % m]], points[:, [0, 3]]
    handles, turns = points[:, [1, 2]] - ends, np.abs(turns_of(controls)).max(axis=0)
    beside = contour.degrees[[segment - 1, (segment + 1) % m]] == 3
    chosen = [end for end in (0, 1) if beside[end] and turns[end] < SMOOTH and (shares[:, end] < 1).all()]
    first = shares.copy()
    with np.errstate(divide="ignore", invalid="ignore"):
        for _ in range(STEPS):
            for end in chosen:
                neighbour, own = controls[:, end, end], handles[:, end]
                a, c = (neighbour[:, k] - neighbour[:, 0] for k in (1, 2))
                bend = 2 / 3 * np.abs(cross(a, c)) / np.hypot(*a.T) ** 3
                way = ends[:, 1 - end] + shares[:, [1 - end]] * handles[:, 1 - end] - ends[:, end]
                size = np.hypot(*own.T)
                shares[:, end] = np.sqrt(2 / 3 * np.abs(cross(own, way)) / size / bend) / size
    fits = np.isfinite(shares).all() and (shares <= 1).all() and (shares > LEAST * first).all()
    return shares if chosen and fits else None


def cut(points: FloatArray, shares: FloatArray) -> FloatArray:
    """(K, 2, 2) the ends of the handles of cubics (K, 4, 2), cut to shares (K, 2) of their lengths."""
    ends = points[:, [0, 3]]
    return ends + shares[:, :, None] * (points[:, [1, 2]] - ends)


MOVED: dict[str, Callable[[MasterContour, int], Iterator[Move]]] = {
    "handles": handle_moves, "extremum": extremum_moves, "unlevel": level_moves, "slanted": line_moves,
}  # fmt: skip
"""How findings of a kind are mended by moves of points."""
