"""Chains of quadratics on the grid: legs in the direction of what they meet, and all other control points together."""

from __future__ import annotations

import numpy as np

from ....compiled import compiled
from ....curves.cubics import length, square
from ....fitting.sharp.corners import turn_between
from ....types import FloatArray, IntArray
from .chains import (
    LEAST,
    OWN,
    REACH,
    SLACK,
    SLIP,
    Quads,
    ahead,
    as_cubics,
    set_moves,
    set_nodes,
)
from .gates import CORNER, KINK
from .nearness import add_samples, shared_feet, squares

SWEEPS = 4
"""Visits of all control points on the grid."""

FOLD = 1e3
"""What it costs if the order of control points is lost, in mean squares of distance at the tolerance."""

PARALLEL = 1e-3
"""Sine of the angle between tangents in two masters up to which they have one direction."""

EXPLICIT, LOOSE = 2, 4
"""Tries from which the ends of a section are on the curve; and from which it may turn at the ends of its run, where the
grid has no control point near enough."""


@compiled
def aim(q: Quads, tries: IntArray, ring: bool) -> bool:
    """Put control points on tangents that are not the axes' on the grid, as nearly in that direction; whether any.

    Args:
        ring: whether the last node is the first again: it becomes implied.
    """
    aimed, K, R = False, len(q.c), q.c.shape[1]
    wanted = np.empty(K)
    for s in range(R):
        both = q.tied[s, 0] and q.tied[s, 1]
        for end in range(2):
            if q.fixed[s] or not q.tied[s, end]:
                continue
            flat, upright = True, True
            for w in range(K):
                flat, upright = flat and q.T[w, s + end, 1] == 0.0, upright and q.T[w, s + end, 0] == 0.0
            if not both and (flat or upright):
                continue
            price = 0.5 if tries[q.owner[s]] >= LOOSE else 100.0
            set_lengths(q, s, end, tries[q.owner[s]] % 2 == 1 and not ring, wanted)
            for w in range(K):
                x, y = aimed_at(q, w, s, end, wanted[w], price)
                if ring and 0 < s == R - 1 and q.fixed[0]:
                    x, y = 2 * q.node[w, R, 0] - q.c[w, 0, 0], 2 * q.node[w, R, 1] - q.c[w, 0, 1]
                q.c[w, s, 0], q.c[w, s, 1] = x, y
            q.fixed[s] = aimed = True
    return aimed


@compiled
def set_lengths(q: Quads, s: int, end: int, alike: bool, wanted: FloatArray) -> None:
    """How long the leg of quadratic s at its end is in each master; in proportion to what is beyond where that does not
    have one direction in all, as else the joint turns between masters."""
    K, sign, one, size, turn = len(q.c), 1.0 - 2.0 * end, 0.0, 0.0, 0.0
    for w in range(K):
        (tx, ty), (bx, by), p = q.T[w, s + end], q.beyond[w, s + end], q.node[w, s + end]
        wanted[w] = max(sign * ((q.c[w, s, 0] - p[0]) * tx + (q.c[w, s, 1] - p[1]) * ty), 1.0)
        one, size = one + wanted[w] * length(bx, by), size + bx * bx + by * by
        turn = max(turn, abs(tx * q.T[0, s + end, 1] - ty * q.T[0, s + end, 0]))
    for w in range(K if alike and turn > PARALLEL else 0):
        wanted[w] = max(one / max(size, 1e-12) * length(q.beyond[w, s + end, 0], q.beyond[w, s + end, 1]), 1.0)


@compiled
def aimed_at(q: Quads, w: int, s: int, end: int, wanted: float, price: float) -> tuple[float, float]:
    """The place on the grid for the control point of quadratic s in master w, in the direction of its tangent."""
    both, sign, (tx, ty), p = q.tied[s, 0] and q.tied[s, 1], 1.0 - 2.0 * end, q.T[w, s + end], q.node[w, s + end]
    tx, ty, c = sign * tx, sign * ty, q.c[w, s]
    steep = abs(ty) > abs(tx)
    main, other = (ty, tx) if steep else (tx, ty)
    least, best_x, best_y = np.inf, c[0], c[1]
    for code in range(25 if both else int(2 * wanted) + 12):
        if both:
            x, y = np.rint(c[0]) - p[0] + code % 5 - 2, np.rint(c[1]) - p[1] + code // 5 - 2
        else:
            u, v = np.sign(main) * (code + 1), np.rint((code + 1) * other / abs(main))
            x, y = (v, u) if steep else (u, v)
        along = (x * tx + y * ty - wanted) / (0.3 * wanted + 1.0)
        cost = along * along + off_tangent(q, w, s + end, sign * x, sign * y, price)
        if both:
            r = q.node[w, s + 1]
            cost += off_tangent(q, w, s + 1, r[0] - p[0] - x, r[1] - p[1] - y, price)
        if cost < least:
            least, best_x, best_y = cost, p[0] + x, p[1] + y
    return best_x, best_y


@compiled
def is_kink(q: Quads, s: int, turn: float, leg: float) -> bool:
    """Whether a turn from what is beyond makes node s a kink that the source has not there.

    Args:
        leg: how long the leg is that turns. Where rounding has turned the source, it may turn as that does, beside no
            longer a leg.
    """
    sources = turn <= q.turns[OWN, s] + 1e-9 and leg <= q.turns[REACH, s] + 1e-6
    return (turn > q.turns[SLACK, s] + 1e-9 and not sources) or turn < CORNER < q.turns[LEAST, s]


@compiled
def off_tangent(q: Quads, w: int, s: int, x: float, y: float, price: float) -> float:
    """What a leg (x, y) beside the tangent at node s costs in master w; where it turns from what is beyond, the
    price."""
    T, beyond = q.T[w, s], q.beyond[w, s]
    off, turn = turn_between(x, y, T[0], T[1]), turn_between(x, y, beyond[0], beyond[1])
    turned = max(turn, off) / KINK if is_kink(q, s, turn, length(x, y)) else 0.0
    return price * (0.005 * square(off / KINK) + turned)


@compiled
def round_quads(q: Quads, samples: FloatArray, tolerance: float) -> None:
    """Round control points to the grid, each to the neighbour that leaves the outline least; tangents that are axes
    stay so."""
    K, R = len(q.c), q.c.shape[1]
    # A row before the first control point, and one behind the last.
    points, exact = np.zeros((K, R + 2, 2)), np.zeros((K, R + 2, 2))
    own, rest = np.zeros((K, R, 6, 7)), np.zeros((K, R))
    c, p, J = np.empty((K, 3, 2)), np.empty((K, 4, 2)), np.empty((4, 2, 6))
    for s in range(R):
        if not q.held[s]:
            a, n = q.lo[s], q.lo[s + 1] + 1 - q.lo[s]
            Q, x = samples[:, a : a + n], np.arange(n) / max(n - 1, 1)
            as_cubics(q, s, p)
            shared_feet(p, Q, c, x, np.empty(n))
            set_moves(q, s, J)
            for w in range(K):
                rest[w, s] = add_samples(
                    p[w], c[w], Q[w], x, np.ones(n), J, tolerance, own[w, s], SLIP if K > 1 else 0.0
                )
        for w in range(K):
            for axis in range(2):
                at = q.c[w, s, axis]
                exact[w, s + 1, axis], points[w, s + 1, axis] = at, at if q.fixed[s] else np.rint(at)
    for w in range(K):
        for _ in range(SWEEPS):
            changed = False
            for s in range(R):
                changed = (not q.fixed[s] and moved_on_grid(q, w, s, points[w], exact[w], own[w], rest[w])) or changed
            if not changed:
                break
        for s in range(R):
            for axis in range(2):
                q.c[w, s, axis] = points[w, s + 1, axis]
    set_nodes(q)


@compiled
def moved_on_grid(
    q: Quads, w: int, s: int, points: FloatArray, exact: FloatArray, own: FloatArray, rest: FloatArray
) -> bool:  # fmt: skip
    """Move the control point of quadratic s in master w to the neighbour on the grid that costs least; whether it has
    moved."""
    R, T = q.c.shape[1], q.T[w]
    still_x = (q.tied[s, 0] and T[s, 0] == 0.0) or (q.tied[s, 1] and T[s + 1, 0] == 0.0)
    still_y = (q.tied[s, 0] and T[s, 1] == 0.0) or (q.tied[s, 1] and T[s + 1, 1] == 0.0)
    x0, y0 = points[s + 1]
    best_x, best_y, least, changed = x0, y0, np.inf, False
    for code in range(9):
        u, v = (0.0, 1.0, -1.0)[code % 3], (0.0, 1.0, -1.0)[code // 3]
        if (still_x and u != 0.0) or (still_y and v != 0.0):
            continue
        points[s + 1, 0], points[s + 1, 1] = x0 + u, y0 + v
        cost = 0.0
        for t in (s, s + 1):
            if 0 < t < R and q.implied[t] and ahead(points[1:], T, t) < 0.5:
                cost += FOLD
        for t in range(max(s - 1, 0), min(s + 2, R)):
            if cost < least and not q.held[t]:
                cost += squares(points[t : t + 3], exact[t : t + 3], own[t], rest[t])
        if cost < least - 1e-9:
            best_x, best_y, least, changed = x0 + u, y0 + v, cost, changed or code > 0
    points[s + 1, 0], points[s + 1, 1] = best_x, best_y
    return changed
