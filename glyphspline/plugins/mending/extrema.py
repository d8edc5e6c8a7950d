"""The smallest moves of points at extreme points: handles off level, and extrema that no point is at.

Each is of one finding, in all K masters alike; see :mod:`.shapes`.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...curves.bezier import cross, split
from ...outlines.masters import MasterContour
from ...types import FloatArray
from .joints import EXACT, Move, starts_of

OUT = (0.0, 0.5, 1.0)
"""How far a point goes out to the extremum beside it: only its handles are levelled, or half of the way, or all."""

LEVEL = 0.36
"""Slope up to which a handle is turned level to end a curve at its extremum."""

DRAWN = 3.0
"""Times its length to which a curve is drawn on at most."""

AT = np.linspace(1 / DRAWN, 1.0, 65)[:-1]
"""Shares that a curve may be of the one drawn on."""

BASIS = (1 - AT) ** 3, 3 * AT * (1 - AT) ** 2, 3 * AT**2 * (1 - AT), AT**3
"""The Bernstein polynomials of cubics there."""

ROUNDED = 0.8
"""Units by which rounding moves what is drawn on, at most."""


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
    before, own, behind = ((starts_of(contour)[(segment + k) % m] + np.arange(degree + 1)) % count for k in (-1, 0, 1))
    moves = [_slid(points[before], points[own], points[behind], axis) for points in contour.points]
    both = [move for move in moves if move is not None]
    if len(both) == len(moves):
        one, other = (np.stack(side) for side in zip(*both, strict=True))
        yield np.concatenate([before[1:], own[1:-1]]), one
        yield np.concatenate([behind[-2::-1], own[-2:0:-1]]), other


def _slid(before: FloatArray, own: FloatArray, behind: FloatArray, axis: int) -> tuple[FloatArray, FloatArray] | None:
    """(2 d - 1, 2) points of a neighbour, from its second one on, and of the curve between, after their joint slid to
    the extremum: of the neighbour before, and of that behind, backwards.

    The extremum is where both neighbours, drawn on, are level at one place: an extreme point that went is put back so.
    Else it is where the curve itself has it. Curves are (d + 1, 2).
    """
    place = _met(before, behind[::-1], axis)
    if place is None:
        inside = [t for t in _level(own[:, axis]) if 0 < t < 1]
        if len(inside) != 1:
            return None
        place = split(own, inside[0])[0][-1]
    level = np.where(np.arange(2) == axis, 0.0, np.sign(own[-1] - own[0]))
    one, other = _drawn_on(before, place, level), _drawn_on(behind[::-1], place, -level)
    if one is None or other is None:
        return None
    return np.concatenate([one[0][1:], other[1][-2:0:-1]]), np.concatenate([other[0][1:], one[1][-2:0:-1]])


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
    if not np.isfinite(off[best]) or not out.any():
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
