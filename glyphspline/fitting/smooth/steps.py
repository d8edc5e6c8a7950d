"""The steps of a fit for all contours of a glyph that are not done yet, on ragged arrays."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...types import BoolArray, FloatArray, IntArray
from .canonical_contours import Chains, vertices
from .insertion import MOST_VERTICES, graded, with_more
from .pruning import put_back, sparse
from .spacing import seeds
from .span_distance import check, sharpened

ROUGHLY = 0.1
"""While vertices are still sought: spans that are too far off need be measured no sharper than this share of near."""


@compiled
def first_places(
    chains: Chains, which: IntArray, corner_angle: float, ratio: float, near: FloatArray, variant: int
) -> tuple[FloatArray, IntArray]:
    """Ragged places to begin with, of the contours ``which``."""
    parts = [np.empty(0)]
    for k in which:
        a, b = chains.offsets[k], chains.offsets[k + 1]
        cubics, lengths = chains.cubics[a:b], chains.lengths[a:b]
        some = seeds(cubics, lengths, chains.turns[a:b], corner_angle, ratio, near[k], variant)
        parts.append(graded(cubics, lengths, some, ratio))
    return _joined(parts)


@compiled
def _joined(parts: list[FloatArray]) -> tuple[FloatArray, IntArray]:
    """All but the first of some arrays as one, and where each begins."""
    offsets = np.zeros(len(parts), dtype=np.int64)
    for k in range(1, len(parts)):
        offsets[k] = offsets[k - 1] + len(parts[k])
    values = np.empty(offsets[-1])
    for k in range(1, len(parts)):
        values[offsets[k - 1] : offsets[k]] = parts[k]
    return values, offsets


@compiled
def polygons(chains: Chains, which: IntArray, places: FloatArray, offsets: IntArray) -> FloatArray:
    """Ragged points of the outline at the places."""
    points = np.empty((len(places), 2))
    for i in range(len(which)):
        k = which[i]
        cubics = chains.cubics[chains.offsets[k] : chains.offsets[k + 1]]
        points[offsets[i] : offsets[i + 1]] = vertices(cubics, places[offsets[i] : offsets[i + 1]])
    return points


@compiled
def beziers(controls: FloatArray, knots: FloatArray, offsets: IntArray, unit: float) -> tuple[FloatArray, FloatArray]:
    """Ragged Bézier pieces (n, 4, 2) of closed cubic splines, and the same rounded to multiples of 1/unit.

    Knots of part k begin at ``offsets[k] + k``.
    """
    pieces = np.empty((len(controls), 4, 2))
    for k in range(len(offsets) - 1):
        a, n = offsets[k], offsets[k + 1] - offsets[k]
        u = knots[a + k :]
        for i in range(n):
            j = (i + 1) % n
            before = u[i] - u[i - 1] if i > 0 else u[n] - u[n - 1]
            here = u[i + 1] - u[i]
            after = u[j + 1] - u[j]
            whole = before + here + after
            for c in range(2):
                p, q = controls[a + i, c], controls[a + j, c]
                pieces[a + i, 1, c] = p + before / whole * (q - p)
                pieces[a + i, 2, c] = p + (before + here) / whole * (q - p)
        for i in range(n):
            j = i - 1 if i > 0 else n - 1
            before = u[j + 1] - u[j]
            share = before / (before + u[i + 1] - u[i])
            for c in range(2):
                p, q = pieces[a + j, 2, c], pieces[a + i, 1, c]
                pieces[a + i, 0, c] = pieces[a + j, 3, c] = p + share * (q - p)
    written = np.empty_like(pieces)
    for i in range(len(pieces)):
        for j in range(4):
            for c in range(2):
                written[i, j, c] = np.rint(pieces[i, j, c] * unit) / unit
    return pieces, written


@compiled
def examined(
    chains: Chains, which: IntArray, places: FloatArray, offsets: IntArray, pieces: FloatArray, near: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Ragged bounds, gaps, worst places and stretches of all spans; see :func:`.span_distance.check`.

    Stretches of part i begin at ``offsets[i] + i``.
    """
    n = len(places)
    bounds, gaps, worst, ends = np.empty(n), np.empty(n), np.empty(n), np.empty(n + len(which))
    for i in range(len(which)):
        k, a, b = which[i], offsets[i], offsets[i + 1]
        cubics = chains.cubics[chains.offsets[k] : chains.offsets[k + 1]]
        check(
            pieces[a:b], cubics, places[a:b], near[k], ROUGHLY * near[k], bounds[a:b], gaps[a:b], worst[a:b],
            ends[a + i :],
        )  # fmt: skip
    return bounds, gaps, worst, ends


@compiled
def _corners(places: FloatArray, turns: FloatArray, corner_angle: float) -> BoolArray:
    """(n,) which vertices of a contour are at corners."""
    corners = np.zeros(len(places), dtype=np.bool_)
    for v in range(len(places)):
        j = int(places[v])
        corners[v] = places[v] == j and turns[j] >= corner_angle
    return corners


@compiled
def changed(
    chains: Chains, which: IntArray, places: FloatArray, offsets: IntArray, points: FloatArray, bounds: FloatArray,
    gaps: FloatArray, worst: FloatArray, near: FloatArray, more: BoolArray, fewer: BoolArray, corner_angle: float,
    ratio: float, power: float,
) -> tuple[IntArray, FloatArray, IntArray]:  # fmt: skip
    """The contours that change, and their ragged places.

    Args:
        more: (K,) whether to put vertices where a contour is too far off; fewer: (K,) whether to take out those that
            seem not to be needed. Of all contours, by their numbers in ``which``.
        power: of a span's length with which its error is taken to grow.
    """
    parts, those = [np.empty(0)], np.empty(len(which), dtype=np.int64)
    for i in range(len(which)):
        k, a, b = which[i], offsets[i], offsets[i + 1]
        s, t = chains.offsets[k], chains.offsets[k + 1]
        cubics, lengths, turns = chains.cubics[s:t], chains.lengths[s:t], chains.turns[s:t]
        here, bound, at = places[a:b], bounds[a:b], worst[a:b]
        if fewer[k]:
            corners = _corners(here, turns, corner_angle)
            keep = sparse(points[a:b], corners, np.zeros(b - a, dtype=np.bool_), gaps[a:b], near[k], ratio, power)
            here, bound, at = here[keep], bound[keep], at[keep]
        if more[k]:
            here = with_more(lengths, here, bound, at, near[k])
        if len(here) != b - a or (here != places[a:b]).any():
            here = graded(cubics, lengths, here, ratio)
            if len(here) <= MOST_VERTICES:
                those[len(parts) - 1] = k
                parts.append(here)
    values, new = _joined(parts)
    return those[: len(parts) - 1].copy(), values, new


@compiled
def certificate(
    chains: Chains, k: int, written: FloatArray, bounds: FloatArray, gaps: FloatArray, ends: FloatArray,
    sharpness: float,
) -> tuple[float, float]:  # fmt: skip
    """Bound and gap of contour k as it is written; see :func:`.span_distance.sharpened`."""
    cubics = chains.cubics[chains.offsets[k] : chains.offsets[k + 1]]
    return sharpened(written, cubics, bounds, gaps, ends, sharpness)


class Good(NamedTuple):
    """Polygons that passed, and what is to be tried next; all ragged, with ``offsets``.

    Attributes:
        places, points, gaps: of the polygons and their spans.
        keep: the vertices that the next trial has. needed: those that no trial leaves out any more.
    """

    places: FloatArray
    offsets: IntArray
    points: FloatArray
    gaps: FloatArray
    keep: BoolArray
    needed: BoolArray


@compiled
def thinned(
    chains: Chains, near: FloatArray, corner_angle: float, ratio: float, power: float, which: IntArray,
    places: FloatArray, offsets: IntArray, points: FloatArray, bounds: FloatArray, gaps: FloatArray, good: Good,
) -> tuple[IntArray, Good]:  # fmt: skip
    """What to try next, to find the vertices that are needed.

    A trial that passes takes the place of the good polygon, and vertices of it that look spare are left out of the
    next trial. Of one that fails, those are put back that were beside the failure, and are needed from then on.

    Args:
        places, offsets, points, bounds, gaps: of the trial, ragged, of the contours ``which``.
        good: the polygons that passed, of the same contours.

    Returns:
        Numbers and polygons of the contours that are not finished.
    """
    n = len(good.places)
    those, count, at = np.empty_like(which), 0, 0
    new = Good(
        np.empty(n), np.zeros(len(which) + 1, dtype=np.int64), np.empty((n, 2)), np.empty(n),
        np.empty(n, dtype=np.bool_), np.empty(n, dtype=np.bool_),
    )  # fmt: skip
    for i in range(len(which)):
        k, a, b, c, d = which[i], offsets[i], offsets[i + 1], good.offsets[i], good.offsets[i + 1]
        here, p, e, keep, needed = good.places[c:d], good.points[c:d], good.gaps[c:d], good.keep[c:d], good.needed[c:d]
        if bounds[a:b].max() <= near[k]:
            here, p, e, needed = places[a:b], points[a:b], gaps[a:b], needed[keep]
            keep = np.ones(b - a, dtype=np.bool_)
        else:
            back = put_back(p, keep, bounds[a:b], near[k], ratio)
            needed = needed | (back & ~keep)
            keep = back
        if keep.all():
            corners = _corners(here, chains.turns[chains.offsets[k] : chains.offsets[k + 1]], corner_angle)
            keep = sparse(p, corners, needed, e, near[k], ratio, power)
        if keep.all():
            continue
        those[count] = k
        stop = at + len(here)
        new.places[at:stop], new.points[at:stop], new.gaps[at:stop] = here, p, e
        new.keep[at:stop], new.needed[at:stop] = keep, needed
        count, at = count + 1, stop
        new.offsets[count] = stop
    return those[:count].copy(), Good(
        new.places[:at].copy(), new.offsets[: count + 1].copy(), new.points[:at].copy(), new.gaps[:at].copy(),
        new.keep[:at].copy(), new.needed[:at].copy(),
    )  # fmt: skip
