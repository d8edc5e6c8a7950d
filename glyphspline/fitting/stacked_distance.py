"""A certified bound of the two-sided distance between a result and its source in a whole design space at once.

Both are chains of cubics in V instances, the corners of the design space's grid: everywhere else an instance is a
convex combination of some of these, with the same weights for the result as for the source. Both chains are cut into
sections A and B in pairs, at places that are the same in all instances; A_v and B_v are the polynomials of a pair in
instance v.

The *plain* bound of a pair is the largest ``|A_vk - B_vk|`` of its Bézier points, as in :mod:`.certified_distance`:
being convex it holds in between. But it charges the result for running along the outline at another pace, which
instances do in different ways, and no pairing of places suits all of them. The *slip* bound does not.

Let e be the direction of the pair's chords, the same for all instances, D = A - B, and σ the largest ``|e·D|``. The
chain of B is followed beyond both ends of the section until it extends by σ along e in every instance. Let all its
derivatives h have e·h > 0. A point A(t) lies at the height along e of some point B(s) of the chain, and the way from
B(t) to there is the integral of the h(ξ) in between. Hence, for some of these,

    |A(t) - B(s)| ≤ |h(ξ) × D(t)| / e·h(ξ)

In an instance with weights λ the numerator is Σ λ_u λ_v h_u(ξ) × D_v(t), and the denominator Σ λ_u e·h_u(ξ). With the
Bézier points h_ui and D_vk of a part of the chain and of the section, the quotient is a mean of

    q_uv = |h_ui × D_vk + h_vi × D_uk| / (e·h_ui + e·h_vi)

with weights λ_u λ_v (e·h_ui + e·h_vi)/2 and those of the Bernstein polynomials. Where a master slips along its own
outline h_u is parallel to D_u, and q_uu is the distance across; q_uv is what mixing two masters costs that slip apart
and run in different directions. The weights of all q_uu together are at least 2√r/(V (1 + r)), where r is the largest
quotient of the e·h_ui of two instances (the inequalities of Cauchy and Kantorovich), so that the largest q_uu and q_uv
bound the distance of A's points from B. With the roles exchanged the same holds for the points of B.

Where an arc ends, both chains end at the same point: there they are both followed to it, and nothing lies beyond.
"""

from __future__ import annotations

import numpy as np

from ..compiled import compiled
from ..curves.cubics import COARSE, extent, jet, length, newton_step, section, split
from ..curves.paired import ROUNDING
from ..types import BoolArray, FloatArray

DEEPEST = 12
"""Maximum subdivision depth; pairs still above the limit there count as too far apart."""

MOST_HALVINGS = 2_000
"""Halvings of one span, after which what is left counts as too far apart."""

STEPS = 6
"""Newton steps to the nearest place."""

PARTS = 24
"""Most parts of a chain that are looked at beyond either end of a section."""

FIRST_PART = 1 / 64
"""The first of them, as a share of a segment; each is twice as long as the one before."""

FLAT = 1e-9
"""Least extent of a derivative along a chord, as a share of its length, that counts as positive."""


@compiled
def pair_stacks(
    results: FloatArray, sources: FloatArray, anchors: FloatArray, ranges: FloatArray, closed: bool,
    wanted: BoolArray, limit: float,
) -> FloatArray:  # fmt: skip
    """Certified bounds of the spans of one contour. One beyond the limit is a bound, but seldom the best to be had.

    Args:
        results: (V, r, 4, 2) and sources: (V, m, 4, 2) closed chains in all instances.
        anchors: (r + 1, 2) places on both where each span of the result begins, and the first a lap later.
        ranges: (r, 4) first and last place on the result and on the source of the arc that each span belongs to.
        closed: whether there is one arc, the whole contour, which has no ends.
        wanted: (r,) the spans that are looked at; the bounds of others are NaN.
        limit: sections are halved until their bounds are below this, or one of their arc cannot be.
    """
    V, spans = len(results), results.shape[1]
    bounds, lost = np.full(spans, np.nan), -1.0
    work, marks = np.empty((2, DEEPEST + 2, V, 4, 2)), np.empty((DEEPEST + 2, 5))
    scratch = np.empty((3, V, 4, 2))
    rounding = 0.0
    for v in range(V):
        rounding = max(rounding, ROUNDING * max(extent(results[v]), extent(sources[v])))
    m = sources.shape[1]
    for k in range(spans):
        if not wanted[k]:
            continue
        bound, halvings = 0.0, MOST_HALVINGS if ranges[k, 0] == lost else 0
        y, y_end = anchors[k, 1], anchors[k + 1, 1]
        x, last = anchors[k, 0], False
        i = int(np.floor(x))
        while not last:
            s = int(np.floor(y))
            last = y_end <= s + 1
            stop, cut = y_end, i + 1.0
            if not last:
                stop = s + 1.0
                cut = i + nearest_stacked(results, i, x - i, 1.0, sources[:, s % m, 3])[0]
            for v in range(V):
                section(results[v, i % results.shape[1]], x - i, cut - i, work[0, 0, v])
                section(sources[v, s % m], y - s, stop - s, work[1, 0, v])
            marks[0, 0], marks[0, 1], marks[0, 2], marks[0, 3], marks[0, 4] = x, cut, y, stop, 0.0
            top = 0
            while top >= 0:
                A, B = work[0, top], work[1, top]
                x0, x1, y0, y1, depth = marks[top]
                enough = max(limit, bound)
                most = _bound_of_pair(A, B, results, sources, x0, x1, y0, y1, ranges[k], closed, enough, scratch)
                if most > enough and (depth >= DEEPEST or halvings >= MOST_HALVINGS):
                    # The arc is beyond the limit: what is left of it is not halved any more.
                    halvings, lost = MOST_HALVINGS, ranges[k, 0]
                elif most > enough:
                    halvings += 1
                    xm = (x0 + x1) / 2
                    for v in range(V):
                        split(A[v], 0.5, work[0, top + 1, v])
                    z, _ = nearest_stacked(sources, s, y0 - s, y1 - s, A[:, 0])
                    share = (z - (y0 - s)) / (y1 - y0) if y1 > y0 else 0.5
                    for v in range(V):
                        split(B[v], share, work[1, top + 1, v])
                    marks[top, 0], marks[top, 2], marks[top, 4] = xm, z + s, depth + 1
                    top += 1
                    marks[top, 0], marks[top, 1], marks[top, 2], marks[top, 3] = x0, xm, y0, z + s
                    marks[top, 4] = depth + 1
                    continue
                bound = max(bound, most)
                top -= 1
            x, y = cut, stop
        bounds[k] = bound + rounding
    return bounds


@compiled
def _bound_of_pair(
    A: FloatArray, B: FloatArray, results: FloatArray, sources: FloatArray, x0: float, x1: float, y0: float, y1: float,
    arc: FloatArray, closed: bool, enough: float, scratch: FloatArray,
) -> float:  # fmt: skip
    """The smaller of the two bounds of sections (V, 4, 2). Where neither is enough, the plain one."""
    V, plain, ex, ey, D = len(A), 0.0, 0.0, 0.0, scratch[0]
    for v in range(V):
        for k in range(4):
            D[v, k, 0], D[v, k, 1] = A[v, k, 0] - B[v, k, 0], A[v, k, 1] - B[v, k, 1]
            plain = max(plain, length(D[v, k, 0], D[v, k, 1]))
        ex += A[v, 3, 0] - A[v, 0, 0] + B[v, 3, 0] - B[v, 0, 0]
        ey += A[v, 3, 1] - A[v, 0, 1] + B[v, 3, 1] - B[v, 0, 1]
    size = length(ex, ey)
    if plain <= enough or size <= 0.0:
        return plain
    ex, ey = ex / size, ey / size
    reach = 0.0
    for v in range(V):
        for k in range(4):
            reach = max(reach, abs(ex * D[v, k, 0] + ey * D[v, k, 1]))
    slip = np.zeros((2, 4))
    slip[:, 2] = np.inf
    if not (_add_part(A, D, ex, ey, slip[0], enough) and _add_part(B, D, ex, ey, slip[1], enough)):
        return plain
    for side in range(2):
        x, y = (x1, y1) if side else (x0, y0)
        x_end, y_end = (arc[1], arc[3]) if side else (arc[0], arc[2])
        good, ended = _follow(sources, D, side, y, y_end, closed, reach, ex, ey, slip[1], enough, scratch)
        if not good:
            return plain
        far = np.inf if ended else reach
        good, also = _follow(results, D, side, x, x_end, closed, far, ex, ey, slip[0], enough, scratch)
        if good and also and not ended:
            good, _ = _follow(sources, D, side, y, y_end, closed, np.inf, ex, ey, slip[1], enough, scratch)
        if not good:
            return plain
    return min(plain, max(_slip_bound(slip[0], V), _slip_bound(slip[1], V)))


@compiled
def _slip_bound(slip: FloatArray, V: int) -> float:
    """The bound in one direction, from what :func:`_add_part` gathered."""
    alone, mixed, ratio = slip[0], slip[1], slip[3] / slip[2]
    share = 2 * np.sqrt(ratio) / (V * (1 + ratio))
    return alone if mixed <= alone else share * alone + (1 - share) * mixed


@compiled
def _add_part(b: FloatArray, D: FloatArray, ex: float, ey: float, slip: FloatArray, enough: float) -> bool:
    """Take a part (V, 4, 2) of the chain into the largest q_uu and q_uv, and the least and largest e·h; False unless
    all e·h are positive and the slip bound is still small ``enough``: more parts never make it smaller.
    """
    V = len(b)
    for i in range(3):
        for u in range(V):
            ux, uy, most = b[u, i + 1, 0] - b[u, i, 0], b[u, i + 1, 1] - b[u, i, 1], 0.0
            ahead = ex * ux + ey * uy
            if not ahead > FLAT * (abs(ux) + abs(uy)):
                return False
            slip[2], slip[3] = min(slip[2], ahead), max(slip[3], ahead)
            for k in range(4):
                most = max(most, abs(ux * D[u, k, 1] - uy * D[u, k, 0]))
            slip[0] = max(slip[0], most / ahead)
    if slip[0] > enough:
        return False
    for i in range(3):
        for u in range(V):
            ux, uy = b[u, i + 1, 0] - b[u, i, 0], b[u, i + 1, 1] - b[u, i, 1]
            for v in range(u):
                vx, vy, most = b[v, i + 1, 0] - b[v, i, 0], b[v, i + 1, 1] - b[v, i, 1], 0.0
                for k in range(4):
                    cross = ux * D[v, k, 1] - uy * D[v, k, 0] + vx * D[u, k, 1] - vy * D[u, k, 0]
                    most = max(most, abs(cross))
                slip[1] = max(slip[1], most / (ex * ux + ey * uy + ex * vx + ey * vy))
    return _slip_bound(slip, V) <= enough


@compiled
def _follow(
    chains: FloatArray, D: FloatArray, side: int, first: float, last: float, closed: bool, reach: float, ex: float,
    ey: float, slip: FloatArray, enough: float, scratch: FloatArray,
) -> tuple[bool, bool]:  # fmt: skip
    """Take in what chains (V, m, 4, 2) have beyond a place, until they extend by ``reach`` or their arc ends.

    Args:
        side: 0 to look back from the place ``first``, 1 to look ahead. last: the arc's end, unless it is ``closed``.
        scratch: (3, V, 4, 2).

    Returns:
        Whether the chains get that far along e, with a slip bound that is small enough, and whether the arc ended.
    """
    V, m = len(chains), chains.shape[1]
    part, start = scratch[1], scratch[2, :, 0]
    near, far = (0, 3) if side else (3, 0)
    at = first
    for turn in range(PARTS):
        if not closed and (at >= last if side else at <= last):
            return True, True
        s = int(np.floor(at)) if side else int(np.ceil(at)) - 1
        step = min(s + 1 - at if side else at - s, FIRST_PART * 2.0**turn)
        a, b = (at, at + step) if side else (at - step, at)
        if not closed:
            a, b = (a, min(b, last)) if side else (max(a, last), b)
        least = np.inf
        for v in range(V):
            section(chains[v, s % m], a - s, b - s, part[v])
            if turn == 0:
                start[v, 0], start[v, 1] = part[v, near, 0], part[v, near, 1]
            x, y = part[v, far, 0] - start[v, 0], part[v, far, 1] - start[v, 1]
            least = min(least, abs(ex * x + ey * y))
        if not _add_part(part, D, ex, ey, slip, enough):
            return False, False
        if least >= reach:
            return True, False
        at = b if side else a
    return False, False


@compiled
def _squares(chains: FloatArray, s: int, z: float, point: FloatArray) -> float:
    """The squared distance of the instances' points at z of segment s from (V, 2) points, summed."""
    total = 0.0
    for v in range(len(chains)):
        px, py, _, _, _, _ = jet(chains[v], s % chains.shape[1], z)
        total += (px - point[v, 0]) ** 2 + (py - point[v, 1]) ** 2
    return total


@compiled
def nearest_stacked(chains: FloatArray, s: int, low: float, high: float, point: FloatArray) -> tuple[float, float]:
    """The parameter in [low, high] of segment s at which all instances together are nearest to (V, 2) points, and the
    squared distance there, summed.
    """
    V, m = len(chains), chains.shape[1]
    best, at = np.inf, low
    for k in range(COARSE + 1):
        z = low + (high - low) * k / COARSE
        d = _squares(chains, s, z, point)
        if d < best:
            best, at = d, z
    for _ in range(STEPS):
        slope = speed = bend = 0.0
        for v in range(V):
            px, py, dx, dy, ax, ay = jet(chains[v], s % m, at)
            x, y = px - point[v, 0], py - point[v, 1]
            speed += dx * dx + dy * dy
            slope += x * dx + y * dy
            bend += dx * dx + dy * dy + x * ax + y * ay
        if speed <= 0.0:
            break
        before, at = at, newton_step(at, slope, speed, bend, low, high)
        if abs(at - before) < 1e-9:
            break
    return at, _squares(chains, s, at, point)


@compiled
def near_places(
    chains: FloatArray, hints: FloatArray, points: FloatArray, closed: bool, low: float, high: float
) -> FloatArray:
    """(n,) places of closed chains nearest to points, sought half-way to the hints before and after each.

    Args:
        chains: (V, m, 4, 2). hints: (n,) increasing places. points: (V, n, 2).
        closed: whether the first follows the last a lap later. low, high: bounds of all places, unless ``closed``.
    """
    n, m = len(hints), chains.shape[1]
    places = np.empty(n)
    for i in range(n):
        before, after = hints[i - 1] if i > 0 else low, hints[i + 1] if i + 1 < n else high
        if closed:
            before = hints[i - 1] if i > 0 else hints[n - 1] - m
            after = hints[i + 1] if i + 1 < n else hints[0] + m
        a, b = (before + hints[i]) / 2, (hints[i] + after) / 2
        best, places[i] = np.inf, hints[i]
        s = int(np.floor(a))
        while s < b:
            z0, z1 = max(a - s, 0.0), min(b - s, 1.0)
            if z1 >= z0:
                z, d = nearest_stacked(chains, s, z0, z1, points[:, i])
                if d < best:
                    best, places[i] = d, s + z
            s += 1
    return places


@compiled
def regular(chains: FloatArray) -> BoolArray:
    """(m,) whether no convex combination of the instances (V, m, 4, 2) of a cubic has a point without speed.

    The derivatives' Bézier points of all instances lie in one half-plane then, for each of the parts into which the
    cubic is halved.
    """
    V, m = len(chains), chains.shape[1]
    good = np.ones(m, dtype=np.bool_)
    part = np.empty((V, 4, 2))
    for s in range(m):
        pieces = 1
        while pieces <= 16:
            fine = True
            for k in range(pieces):
                ex = ey = 0.0
                for v in range(V):
                    section(chains[v, s], k / pieces, (k + 1) / pieces, part[v])
                    size = max(length(part[v, 3, 0] - part[v, 0, 0], part[v, 3, 1] - part[v, 0, 1]), 1e-300)
                    ex += (part[v, 3, 0] - part[v, 0, 0]) / size
                    ey += (part[v, 3, 1] - part[v, 0, 1]) / size
                for v in range(V):
                    for i in range(3):
                        x, y = part[v, i + 1, 0] - part[v, i, 0], part[v, i + 1, 1] - part[v, i, 1]
                        fine = fine and ex * x + ey * y > FLAT * (abs(x) + abs(y))
            if fine:
                break
            pieces *= 2
        good[s] = pieces <= 16
    return good
