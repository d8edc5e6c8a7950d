"""The smallest moves of a joint's handles, and of its node, after which its two sides meet in one tangent.

In each of K masters ``a`` is the handle that arrives at the joint and ``b`` the one that leaves it, both in the
contour's direction. Where ``b = r a`` in all masters with one ratio r, the joint turns nowhere between them either, as
mixing the masters mixes both sides alike. With costs of moving the handles' ends and the node, the least sum of squares
is an eigenvalue problem of two unknowns. Its moves are then put on the grid.

A horizontal or vertical handle keeps its direction, and the other one is turned into it.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ..checks.turns import joint_controls
from ..outlines.masters import MasterContour
from ..types import FloatArray, IntArray

EXACT = 1e-9
"""Difference of coordinates up to which they are equal."""

AROUND = (2, 1)
"""Steps of the grid around the best place within which ends of handles are sought, in one master and in several."""

ACROSS, ALONG, AWAY = 4.0, 1.0, 0.02
"""Weights of what is left across a handle (it turns the joint), of what is left along it, and of being away from the
best place."""

PARTS = (1.0, 0.85, 0.7, 0.55, 0.4)
"""Shares of the whole move that are tried between masters: a smaller one may do."""

SHARES = (0.2, 0.5, 1.0)
"""How far the ratio of two handles' lengths goes to where curvatures meet, in one master."""

NODE = 0.25
"""By how much cheaper handles move than the node, which moves the curve most."""


class Free(NamedTuple):
    """What may move, as inverse costs: the end of the handle that arrives, of the one that leaves, and the node."""

    arriving: float
    leaving: float
    node: float = 0.0


def points_of(contour: MasterContour, joint: int) -> tuple[IntArray, FloatArray]:
    """(3,) numbers of the points at a joint, before, on and behind it, and (K, 3, 2) where they are."""
    at = int(contour.degrees[:joint].sum())
    numbers = np.array([at - 1, at, at + 1]) % contour.points.shape[1]
    return numbers, contour.points[:, numbers]


def obstacle(contour: MasterContour, joint: int) -> str | None:
    """Why a joint cannot be mended, or None."""
    degrees = contour.degrees[[joint - 1, joint]]
    _, points = points_of(contour, joint)
    if (degrees == 1).all():
        return "is between two lines"
    if np.abs(np.diff(points, axis=1)).max(axis=2).min() <= EXACT:
        return "has a handle of no length"
    return None


def moves(contour: MasterContour, joint: int, step: float) -> Iterator[FloatArray]:
    """(K, 3, 2) new places of the points at a joint on a grid of ``step``."""
    curved = (contour.degrees[[joint - 1, joint]] > 1).tolist()
    _, points = points_of(contour, joint)
    several = len(points) > 1
    frees = [Free(*map(float, curved))]
    if all(curved):
        frees += [Free(0.0, 1.0), Free(1.0, 0.0)]
        frees += [Free(1.0, 1.0, NODE)] * (not any(_level(handle) is not None for handle in _handles(points)))
    for part in PARTS if several else PARTS[:1]:
        for free in frees:
            found = _moved(points, free, part, step)
            if found is not None:
                yield found
    if (
        not several and (contour.degrees[[joint - 1, joint]] == 3).all()
    ):  # with lengths by which curvatures meet, or nearly
        meets = _curvature_ratio(contour, joint)
        for share in SHARES if meets else ():
            for free in frees[:3]:
                found = _moved(points, free, 1.0, step, share, meets)
                if found is not None:
                    yield found
    if several:  # each master by itself: directions without ratios
        for free in frees:
            each = [_moved(own[None], free, 1.0, step) for own in points]
            if all(one is not None for one in each):
                yield np.concatenate([one for one in each if one is not None])


def controls_of(contour: MasterContour, joint: int, new: FloatArray) -> FloatArray:
    """(K, n, 2, 4, 2) a joint as :func:`.turns.joint_controls` has it, with new places (n, K, 3, 2) of its points."""
    controls = np.repeat(joint_controls(contour)[:, None, joint], len(new), axis=1)
    for side in (0, 1):
        degree = contour.degrees[joint - 1 + side]
        if degree > 1:
            node, end = np.moveaxis(new[:, :, [1, 2 * side]], 0, 2).swapaxes(0, 1)
            # A quadratic is raised to a cubic.
            controls[:, :, side, 0], controls[:, :, side, 1] = node, end if degree == 3 else node + (end - node) * 2 / 3
    return controls


def _handles(points: FloatArray) -> FloatArray:
    """(2 K, 2) handles of joints, in the contour's direction."""
    return np.diff(points, axis=1).reshape(-1, 2)


def _level(handle: FloatArray) -> int | None:
    """The axis across a handle that is horizontal (1) or vertical (0); None of any other."""
    flat = np.abs(handle) <= EXACT
    return int(flat.argmax()) if flat.any() else None


def _curvature_ratio(contour: MasterContour, joint: int) -> float | None:
    """The ratio of the handles' lengths in the default master at which curvatures meet; None if they bend apart."""
    (i, _, k), points = points_of(contour, joint)
    every = contour.points[0]
    a, b = np.diff(points[0], axis=0)
    way = a / np.hypot(*a) + b / np.hypot(*b)
    before, behind = points[0, 1] - every[i - 1], every[(k + 1) % len(every)] - points[0, 1]
    first, second = (float(way[0] * v[1] - way[1] * v[0]) for v in (before, behind))
    return None if first * second >= 0 else float(np.sqrt(-second / first))


def _moved(
    points: FloatArray, free: Free, part: float, step: float, share: float = 0.0, meets: float | None = None
) -> FloatArray | None:
    """(K, 3, 2) the points at a joint, moved by a share of the least move; None if it has none.

    Args:
        share: by which the ratio of the handles' lengths is between the one that costs least and ``meets``.
    """
    a, b = points[:, 1] - points[:, 0], points[:, 2] - points[:, 1]
    levels = [[_level(own) for own in pair] for pair in zip(a, b, strict=True)]
    counts = np.ones_like(a)  # 0 across a level handle, where the other one is turned whatever the ratio is
    for k, (first, second) in enumerate(levels):
        if first is not None and second is not None and first != second:
            return None
        if (first is None) != (second is None):
            across = second if first is None else first
            if not (free.arriving if first is None else free.leaving):
                return None
            counts[k, across or 0] = 0.0
    ratio = _ratio(a, b, counts, free)
    if ratio is None:
        return None
    if meets is not None:
        ratio = ratio ** (1 - share) * meets**share
    left = b - ratio * a  # what has to vanish
    away = counts * left / (ratio**2 * free.arriving + free.leaving + (1 + ratio) ** 2 * free.node)
    best = points + part * np.stack(
        [-ratio * free.arriving * away, (1 + ratio) * free.node * away, -free.leaving * away], axis=1
    )
    found = points.copy()
    for k, own in enumerate(levels):
        across = next((level for level in own if level is not None), None)
        rest = (1 - part) * left[k] * counts[k]
        along = ALONG if len(points) > 1 or meets is not None else 0.0
        around = AROUND[len(points) > 1]
        found[k] = _on_grid(points[k], best[k], free, across, ratio, rest, along, step, around)
    return found


def _ratio(a: FloatArray, b: FloatArray, counts: FloatArray, free: Free) -> float | None:
    """The ratio of the handles' lengths that costs least; None if it is not positive."""
    aa, ab, bb = (float((counts * u * v).sum()) for u, v in ((a, a), (a, b), (b, b)))
    if ab <= 0:
        return None
    if not free.node and not (free.arriving and free.leaving):
        return ab / aa if free.leaving else bb / ab
    costs = np.array([
        [free.arriving + free.node, -free.node],
        [-free.node, free.leaving + free.node],
    ])  # fmt: skip
    _, vectors = np.linalg.eig(np.linalg.solve(costs, np.array([[aa, ab], [ab, bb]])))
    ratios = [-float(x / y) for x, y in vectors.T.real if abs(y) > EXACT and x * y < 0]
    return min(ratios, key=lambda r: _cost(r, aa, ab, bb, free), default=None)


def _cost(r: float, aa: float, ab: float, bb: float, free: Free) -> float:
    """Sum of the squares of the moves at a ratio."""
    return (bb - 2 * r * ab + r * r * aa) / (r * r * free.arriving + free.leaving + (1 + r) ** 2 * free.node)


def _on_grid(
    old: FloatArray, best: FloatArray, free: Free, across: int | None, ratio: float, rest: FloatArray, along: float,
    step: float, around: int,
) -> FloatArray:  # fmt: skip
    """(3, 2) places on the grid near the best ones (3, 2), between which least is left.

    Args:
        across: the coordinate that all three points have in common, or None. rest: what may be left of ``b - ratio a``.
        along: weight of what is left along the handle.
    """
    node = np.round(best[1] / step) * step if free.node else old[1]
    ends = []
    for end, is_free in ((0, free.arriving), (2, free.leaving)):
        places = _near(best[end], step, around) if is_free else old[None, end]
        if is_free and across is not None:
            places = places.copy()
            places[:, across] = node[across]
        ends.append(places)
    a, b = (node - ends[0])[:, None], (ends[1] - node)[None]
    left = (b - ratio * a - rest) / step
    way = old[2] - old[0]
    way = way / np.hypot(*way)
    left_along, left_across = left @ way, left @ np.array([-way[1], way[0]])
    far = ((ends[0] - best[0]) ** 2).sum(axis=1)[:, None] + ((ends[1] - best[2]) ** 2).sum(axis=1)
    score = ACROSS * left_across**2 + along * left_along**2 + AWAY * far / step**2
    i, j = np.unravel_index(score.argmin(), score.shape)
    return np.stack([ends[0][i], node, ends[1][j]])


def _near(place: FloatArray, step: float, around: int) -> FloatArray:
    """(n, 2) places on the grid around one."""
    steps = np.arange(-around, around + 1)
    grid = np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)
    found: FloatArray = (np.round(place / step) + grid) * step
    return found
