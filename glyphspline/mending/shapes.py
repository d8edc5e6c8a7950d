"""The smallest moves of points that mend lines off level, extreme points off level, missing extrema and long handles.

Each works on one finding, in all K masters alike: a move is the numbers (P,) of points in the contour and their new
places (K, P, 2), on a grid. None adds a point or takes one away. Whether a move mends the finding, how far it moves the
curves, and what else is found then is measured afterwards; here are only those worth a try, the least first.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import product

import numpy as np

from ..checks.turns import joint_controls, turns_of
from ..curves.bezier import cross, split
from ..outlines.masters import MasterContour
from ..types import FloatArray, IntArray
from .joints import EXACT, SMOOTH

Move = tuple[IntArray, FloatArray]

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

OUT = (0.0, 0.5, 1.0)
"""How far a point goes out to the extremum beside it: all of the way, half of it, or only its handles are levelled."""

DRAWN = 3.0
"""Times its length to which a curve is drawn on at most."""

AT = np.linspace(1 / DRAWN, 1.0, 65)[:-1]
"""Shares that a curve may be of the one drawn on; and at these the Bernstein polynomials of cubics."""

BASIS = (1 - AT) ** 3, 3 * AT * (1 - AT) ** 2, 3 * AT**2 * (1 - AT), AT**3

ROUNDED = 0.8
"""Units by which rounding moves what is drawn on, at most."""

LEVEL = 0.36
"""Slope up to which a handle is turned level to end a curve at its extremum."""


def starts_of(contour: MasterContour) -> IntArray:
    """(m,) number of the point where each segment begins."""
    starts: IntArray = np.cumsum(contour.degrees) - contour.degrees
    return starts


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
    points = contour.points.copy()
    points[:, numbers] = places
    if (contour.degrees == 2).any():
        at = starts_of(contour)[(contour.degrees == 2) & (np.roll(contour.degrees, 1) == 2)]
        behind = (at + 1) % points.shape[1]
        implied = (contour.points[:, at - 1] + contour.points[:, behind] == 2 * contour.points[:, at]).all(axis=(0, 2))
        at, behind = at[implied], behind[implied]
        points[:, at] = (points[:, at - 1] + points[:, behind]) / 2
    return MasterContour(points, contour.degrees)


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


def level_moves(contour: MasterContour, segment: int) -> Iterator[Move]:
    """The handles at an extreme point made level: at its height, or the point goes to the mean of theirs."""
    yield from _levelled(contour, segment, None, np.zeros(len(contour.points)))


def _levelled(
    contour: MasterContour, segment: int, axis: int | None, out: FloatArray, both: bool = True
) -> Iterator[Move]:
    """The handles at a joint put at the height of its point, which moves ``out`` (K,); ``axis``: of the height."""
    count = contour.points.shape[1]
    node = int(starts_of(contour)[segment])
    curved = contour.degrees[[segment - 1, segment]] > 1
    numbers = [node, *((node + side) % count for side, own in ((-1, curved[0]), (1, curved[1])) if own)]
    points = contour.points[:, numbers]
    if axis is None:
        axis = int(np.abs(points[:, 1:] - points[:, :1]).max(axis=(0, 1)).argmin())
    ways = np.abs(points[:, 1:] - points[:, :1])
    if (ways[:, :, axis] > LEVEL * ways[:, :, 1 - axis]).any():
        return
    heights = [points[:, 0, axis] + out]
    if both and len(numbers) > 2:
        heights.append(np.round(points[:, 1:, axis].mean(axis=1)))
    for height in heights:
        places = points.copy()
        places[:, :, axis] = height[:, None]
        yield np.array(numbers), places


def extremum_moves(contour: MasterContour, segment: int) -> Iterator[Move]:
    """The end of a curve that passes it slid there along the outline; or moved out to its height, or not at all, and
    its handles made level there."""
    cubics = contour.cubics()[:, segment]  # (K, 4, 2)
    at = np.linspace(0.0, 1.0, 65)[1:-1, None, None]
    along = (1 - at) ** 3 * cubics[:, 0] + 3 * at * (1 - at) ** 2 * cubics[:, 1]
    along = along + 3 * at**2 * (1 - at) * cubics[:, 2] + at**3 * cubics[:, 3]  # (63, K, 2)
    ends = cubics[:, [0, 3]]
    above, below = along.max(axis=0) - ends.max(axis=1), ends.min(axis=1) - along.min(axis=0)  # (K, 2)
    for axis in np.argsort(-np.maximum(above, below).max(axis=0)).tolist():
        yield from slid_moves(contour, segment, axis)
        sign = 1.0 if above[:, axis].max() >= below[:, axis].max() else -1.0
        beyond = (above if sign > 0 else below)[:, axis]
        if beyond.max() <= 0:
            continue
        height = sign * ends[:, :, axis]
        end = int(height[:, 1].sum() > height[:, 0].sum())  # the one nearer to the extremum
        joint = (segment + end) % len(contour)
        for share in OUT:
            out = sign * share * (height.max(axis=1) + np.maximum(beyond, 0) - height[:, end])
            yield from _levelled(contour, joint, axis, out, False)
        own = int(starts_of(contour)[joint])
        handle = (own + (1 if end == 0 else -1)) % contour.points.shape[1]
        places = contour.points[:, [handle]].copy()
        places[:, 0, axis] = contour.points[:, own, axis]
        yield np.array([handle]), places


def slid_moves(contour: MasterContour, segment: int, axis: int) -> Iterator[Move]:
    """Either end of a curve slid along the outline to its extremum, to which the curve beside that end is drawn on."""
    m, count, degree = len(contour), contour.points.shape[1], contour.degrees[segment]
    if degree == 1 or m < 3 or (contour.degrees[[segment - 1, (segment + 1) % m]] != degree).any():
        return
    each = [(starts_of(contour)[(segment + k) % m] + np.arange(degree + 1)) % count for k in (-1, 0, 1)]
    for near, own, far in (each, [numbers[::-1] for numbers in each[::-1]]):
        slid = [_slid(points[near], points[own], points[far], axis) for points in contour.points]
        places = [points for points in slid if points is not None]
        if len(places) == len(slid):
            yield np.concatenate([near[1:], own[1:-1]]), np.stack(places)


def _slid(near: FloatArray, own: FloatArray, far: FloatArray, axis: int) -> FloatArray | None:
    """(2 d - 1, 2) points of a curve and the next one, from the second on, after their joint slid to the extremum.

    The extremum is where both neighbours, drawn on, are level at one place: an extreme point that went is put back so.
    Else it is where the curve itself has it. Curves are (d + 1, 2).
    """
    place = _met(near, far[::-1], axis)
    if place is None:
        inside = [t for t in _level(own[:, axis]) if 0 < t < 1]
        if len(inside) != 1:
            return None
        place = split(own, inside[0])[0][-1]
    level = np.where(np.arange(2) == axis, 0.0, np.sign(own[-1] - own[0]))
    drawn, back = _drawn_on(near, place, level), _drawn_on(far[::-1], place, -level)
    return None if drawn is None or back is None else np.concatenate([drawn[0][1:], back[1][-2:0:-1]])


def _drawn_on(curve: FloatArray, end: FloatArray, level: FloatArray) -> tuple[FloatArray, FloatArray] | None:
    """A curve (d + 1, 2) from its start by way of its end to another one, where it has a direction; and what is new."""
    (start, first), (last, via) = curve[:2], curve[-2:]
    along, out = first - start, via - last
    across = cross(along, level)
    with np.errstate(divide="ignore", invalid="ignore"):
        if len(curve) == 3:
            both = [
                (point, point + cross(end - point, level) / cross(way, level) * way, end)
                for point, way in ((start, along), (via, out))
            ]
            fits = all(
                (inner - point) @ way > 0 and (end - inner) @ level > 0
                for (point, inner, _), way in zip(both, (along, out), strict=True)
            )
            return (np.array(both[0]), np.array(both[1])) if fits else None
        before, one, other, behind = BASIS
        aim = via - (before + one)[:, None] * start - (other + behind)[:, None] * end
        sizes = np.stack([cross(aim, level) / one, cross(aim, along) / other], axis=1) / across
        inner = start + sizes[:, :1] * along, end - sizes[:, 1:] * level
        wholes = np.stack(np.broadcast_arrays(start, *inner, end), axis=1)
        olds, news = split(wholes, AT[:, None, None])
        off = np.square(olds - curve).sum(axis=(1, 2))
    off[~(sizes > 0).all(axis=1)] = np.inf
    best = int(off.argmin())
    if not np.isfinite(off[best]):
        return None
    news[best, 1] = via + np.hypot(*(news[best, 1] - via)) / np.hypot(*out) * out
    return wholes[best], news[best]


def _met(before: FloatArray, behind: FloatArray, axis: int) -> FloatArray | None:
    """(2,) where two curves (d + 1, 2), drawn on, are level, if that is one place.

    Their points are rounded: the curves that fit them best are found by least squares, and none if they fit by no more.
    """
    from scipy.optimize import least_squares

    parts = [1 / min([t for t in _level(curve[:, axis]) if t > 1], default=np.inf) for curve in (before, behind)]
    if min(parts) <= 1 / DRAWN:
        return None
    curves = np.stack([before, behind])
    parts = least_squares(lambda parts: _joined(curves, parts, axis)[1], parts, bounds=(1 / DRAWN, 1.0), xtol=1e-4).x
    place, off = _joined(curves, parts, axis)
    return place if np.abs(off).max() <= ROUNDED else None


def _joined(curves: FloatArray, parts: FloatArray, axis: int) -> tuple[FloatArray, FloatArray]:
    """(2,) the common end, level there, of two curves of which two (2, d + 1, 2) are such parts; and how far off
    their points are."""
    degree, place, off = curves.shape[1] - 1, np.empty(2), []
    shares = np.stack([split(np.eye(degree + 1), part)[0] for part in parts])
    # Unknown are the inner control points of both, and the end that they share, whose height their last handles share.
    for k in (0, 1):
        column = np.append(np.arange(2 * degree - 1), degree - 1)
        if k == axis:
            column[[degree - 2, 2 * degree - 2]] = degree - 1
        matrix = np.zeros((2, degree, 2 * degree))
        for side in (0, 1):
            np.add.at(matrix[side].T, column.reshape(2, degree)[side], shares[side, 1:, 1:].T)
        matrix, given = matrix.reshape(2 * degree, -1), (curves[:, 1:, k] - shares[:, 1:, 0] * curves[:, :1, k]).ravel()
        fit = np.linalg.lstsq(matrix, given, rcond=None)[0]
        off.append(matrix @ fit - given)
        place[k] = fit[degree - 1]
    return place, np.concatenate(off)


def _level(heights: FloatArray) -> list[float]:
    """Parameters at which a curve with control points (d + 1,), of degree 2 or 3, is level, also beyond its ends."""
    slopes = np.diff(heights)
    change = np.diff(slopes)
    terms = [*np.diff(change), *change[:1] * (len(slopes) - 1), slopes[0]]
    roots = np.roots(terms)
    return [float(root.real) for root in roots if abs(root.imag) < EXACT]


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
