"""Points at the horizontal and vertical extrema of contours, where type designers expect them: exact splits."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...compiled import compiled
from ...curves.bezier import evaluate, roots_inside, split
from ...curves.fairness import swings
from ...outlines.outline import Contour
from ...types import FloatArray

UNIT = 1e-3
"""Of the em: the height by which a curve rises to an extremum and falls again, or it is a wave as high as the default
tolerance, the fit's and not the letter's; with a point at each, straight stems of closed splines would get dozens."""

SHORTEST = 2e-3
"""Of the em: chord of the shortest piece that a split may leave. A third of it, a handle, still rounds to a whole
unit of 1/1000 em; off tight turns the nearer joint misses the extremum by far less."""


def with_extrema(contour: Contour, em: float) -> Contour:
    """The same curve with its quadratics and cubics split at their extrema in x and y; see :func:`extremal_pieces`."""
    return Contour.from_segments(piece for pieces in extremal_pieces(contour, em) for piece in pieces)


def extremal_pieces(contour: Contour, em: float) -> list[list[FloatArray]]:
    """The pieces of each segment, (degree + 1, 2), between its extrema in x and y.

    Where a point is added, it and its handles agree exactly in one coordinate, and so they do when rounded. None is
    added on a wave lower than ``UNIT``, nor closer to a joint than ``SHORTEST``, in parts of ``em``, the units per em.
    """
    cubics = contour.cubics()
    cuts: dict[int, list[tuple[float, int]]] = {}
    for k in (0, 1):
        for place in extremal_places(cubics[..., k], UNIT * em):
            if place % 1:
                cuts.setdefault(int(place), []).append((place % 1, k))
    segments = enumerate(contour.segments())
    return [parts(segment, sorted(cuts[j]), SHORTEST * em) if j in cuts else [segment] for j, segment in segments]


def parts(segment: FloatArray, cuts: Sequence[tuple[float, int]], shortest: float) -> list[FloatArray]:
    """A segment, (degree + 1, 2), cut at extrema: ascending parameters, each with its coordinate, 0 or 1."""
    done, pieces, flat, rest = 0.0, [], [], segment
    for t, k in cuts:
        left, right = split(rest, (t - done) / (1 - done))
        if min(np.hypot(*(left[-1] - left[0])), np.hypot(*(right[-1] - right[0]))) >= shortest:
            pieces.append(left)
            flat.append(k)
            done, rest = t, right
    pieces.append(rest)
    for k, left, right in zip(flat, pieces, pieces[1:], strict=False):
        left[-2, k] = right[1, k] = left[-1, k]  # equal but for rounding errors: now they round alike
    return pieces


def extremal_places(values: FloatArray, height: float) -> list[float]:
    """The places where a closed chain of cubics is largest or smallest around, in one coordinate.

    Args:
        values: (m, 4) the coordinate of the Bézier points. height: see :func:`peaks`.

    Returns:
        j + t for an extremum at local parameter t of segment j; whole numbers are joints.
    """
    steps = np.diff(values, axis=1)
    turning = np.flatnonzero(~((steps >= 0).all(axis=1) | (steps <= 0).all(axis=1)))
    first, second, third = steps[turning].T
    roots = roots_inside(first - 2 * second + third, 2 * (second - first), first)
    inner = ~np.isnan(roots)
    of, t = np.repeat(turning, inner.sum(axis=1)), roots[inner]
    places = np.concatenate([np.arange(float(len(values))), of + t])
    heights = np.concatenate([values[:, 0], evaluate(values[of, :, None], t)[:, 0]])
    order = np.argsort(places)
    return [float(places[order[i]]) for i in peaks(heights[order].tolist(), height)]


def peaks(values: Sequence[float], height: float) -> list[int]:
    """Indices of the largest and smallest around in a cyclic sequence, in turn, from the largest of all on.

    Only those between which the sequence rises and falls by ``height`` or more.
    """
    n = len(values)
    if n == 0:
        return []
    first, found = int(np.argmax(values)), np.empty(n + 1, dtype=np.int64)
    count = swings(np.array(values), n, first, first + n + 1, 1.0, 0.0, height, found)
    return [i % n for i in found[:count].tolist()]


@compiled
def hidden_extrema(cubic: FloatArray) -> int:
    """The number of horizontal and vertical extrema inside a cubic (4, 2), between its ends."""
    count = 0
    for axis in range(2):
        # The derivative's Bernstein coefficients, but for a factor.
        a, b, c = cubic[1, axis] - cubic[0, axis], cubic[2, axis] - cubic[1, axis], cubic[3, axis] - cubic[2, axis]
        if a * c < 0.0:
            count += 1
        elif b * (a + c) < 0.0 and b * b > a * c:
            count += 1 if a * c == 0.0 else 2
    return count
