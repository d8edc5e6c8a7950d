"""The slip bound: how far two chains are from each other in a design space, whatever their pace along each other.

The plain bound of :mod:`.pairing` charges a result for running along its outline at another pace, which instances do
in different ways, and no pairing of places suits all of them. The *slip* bound does not.

Let A and B be a pair of sections in V instances, e the direction of their chords, the same for all instances, and
D = A - B. The chain of B is followed beyond the end of the section until it extends along e, in each instance, by the
largest e·D there, and beyond its start by the largest -e·D: so far do mixed instances get, too. Then a point A(t) lies
at the height along e of some point B(s) of the chain. Let h be the way B(s) - B(t) from there:

    |A(t) - B(s)| = |h × D(t)| / e·h

In an instance with weights λ the numerator is Σ λ_u λ_v h_u × D_v(t), and the denominator Σ λ_u e·h_u. The way inside
the section is a mean of the Bézier points of the derivative, and the way from the section's end to a part of the chain
one of those of the part. With these, h_ui, and D_vk of the section, let all e·h_ui be positive. The quotient is a mean
of

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

from ..compiled import compiled, inlined
from ..types import BoolArray, FloatArray
from .bezier import split
from .cubics import length, section

FLAT = 1e-9
"""Least extent of a derivative along a chord, as a share of its length, that counts as positive."""

SCRATCH = 3
"""Stacks (V, 4, 2) that :func:`slip_bound` works in: the differences of the sections, and two for :func:`_follow`."""

Vector = tuple[float, float]


@compiled
def slip_bound(
    A: FloatArray, B: FloatArray, result: FloatArray, source: FloatArray, places: FloatArray, arc: FloatArray,
    enough: float, scratch: FloatArray,
) -> float:  # fmt: skip
    """The slip bound of sections (V, 4, 2) of two chains; infinite if it does not hold, or is not small ``enough``.

    Args:
        result, source: the chains (n V, 4, 2) of A and B. places: first and last place of A, and of B.
        arc: likewise of the arc, infinite for closed curves. scratch: (SCRATCH V, 4, 2).
    """
    V, D, ex, ey = len(A), scratch[: len(A)], 0.0, 0.0
    for v in range(V):
        ex += A[v, 3, 0] - A[v, 0, 0] + B[v, 3, 0] - B[v, 0, 0]
        ey += A[v, 3, 1] - A[v, 0, 1] + B[v, 3, 1] - B[v, 0, 1]
    size = length(ex, ey)
    if size <= 0.0:
        return np.inf
    e = ex, ey = ex / size, ey / size
    # How far A's points are behind B's, and before them, in each instance; and as far as can be.
    reach = np.zeros((3, V))
    reach[2] = np.inf
    for v in range(V):
        for k in range(4):
            D[v, k, 0], D[v, k, 1] = A[v, k, 0] - B[v, k, 0], A[v, k, 1] - B[v, k, 1]
            ahead = ex * D[v, k, 0] + ey * D[v, k, 1]
            reach[0, v], reach[1, v] = max(reach[0, v], -ahead), max(reach[1, v], ahead)
    slip, inside = np.zeros((2, 3)), np.empty((0, 4, 2))
    if not (_add_part(A, D, e, inside, slip[0], enough) and _add_part(B, D, e, inside, slip[1], enough)):
        return np.inf
    for side in range(2):
        x, y, x_end, y_end = places[side], places[2 + side], arc[side], arc[2 + side]
        good, ended = _follow(source, side, y, y_end, reach[side], e, slip[1], enough, scratch)
        if not good:
            return np.inf
        far = reach[2 if ended else 1 - side]
        good, also = _follow(result, side, x, x_end, far, e, slip[0], enough, scratch)
        if good and also and not ended:
            good, _ = _follow(source, side, y, y_end, reach[2], e, slip[1], enough, scratch)
        if not good:
            return np.inf
    return max(_one_way(slip[0], V), _one_way(slip[1], V))


@inlined
def _one_way(slip: FloatArray, V: int) -> float:
    """The bound in one direction, from what :func:`_add_part` gathered."""
    alone, mixed, ratio = slip[0], slip[1], slip[2]
    share = 2 * np.sqrt(ratio) / (V * (1 + ratio))
    return alone if mixed <= alone else share * alone + (1 - share) * mixed


@compiled
def _add_part(b: FloatArray, D: FloatArray, e: Vector, start: FloatArray, slip: FloatArray, enough: float) -> bool:
    """Take a part (V, 4, 2) of the chain into the largest q_uu and q_uv, and quotient of two instances' e·h; False
    unless all e·h are positive and the slip bound is still small ``enough``: more parts never make it smaller.

    Args:
        start: (V, 4, 2) the first points are those where the section ends; (0, 4, 2) in the section itself.
    """
    V, way, (ex, ey) = len(b), np.empty((len(b), 2)), e
    for i in range(3):
        least, most_ahead = np.inf, 0.0
        for u in range(V):
            for c in range(2):
                way[u, c] = b[u, i + 1, c] - (start[u, 0, c] if len(start) else b[u, i, c])
            ahead = ex * way[u, 0] + ey * way[u, 1]
            if not ahead > FLAT * (abs(way[u, 0]) + abs(way[u, 1])):
                return False
            least, most_ahead = min(least, ahead), max(most_ahead, ahead)
        slip[2] = max(slip[2], most_ahead / least)
        for u in range(V):
            ux, uy = way[u, 0], way[u, 1]
            for v in range(u + 1):
                vx, vy, most = way[v, 0], way[v, 1], 0.0
                for k in range(4):
                    cross = ux * D[v, k, 1] - uy * D[v, k, 0] + vx * D[u, k, 1] - vy * D[u, k, 0]
                    most = max(most, abs(cross))
                mixed = 1 if v < u else 0
                slip[mixed] = max(slip[mixed], most / (ex * (ux + vx) + ey * (uy + vy)))
                if slip[0] > enough:
                    return False
    return _one_way(slip, V) <= enough


@compiled
def _follow(
    chain: FloatArray, side: int, first: float, last: float, reach: FloatArray, e: Vector, slip: FloatArray,
    enough: float, scratch: FloatArray,
) -> tuple[bool, bool]:  # fmt: skip
    """Take in what a chain (m V, 4, 2) has beyond a place, until it extends by ``reach`` (V,) or its arc ends.

    Args:
        side: 0 to look back from the place ``first``, 1 to look ahead. last: the arc's end.

    Returns:
        Whether the chain gets that far along e, with a slip bound that is small enough, and whether the arc ended.
    """
    V, (ex, ey) = len(reach), e
    D, part, start, m = scratch[:V], scratch[V : 2 * V], scratch[2 * V :], len(chain) // V
    near, far = (0, 3) if side else (3, 0)
    at = first
    if reach.max() <= 0.0:
        return True, False
    for turn in range(24):  # so many parts are looked at at most
        if at >= last if side else at <= last:
            return True, True
        s = int(np.floor(at)) if side else int(np.ceil(at)) - 1
        # The first part, as a share of a segment; each is twice as long as the one before.
        step = min(s + 1 - at if side else at - s, (1 / 64) * 2.0**turn)
        a, b = (at, min(at + step, last)) if side else (max(at - step, last), at)
        there = True
        for v in range(V):
            section(chain[s % m * V + v], a - s, b - s, part[v])
            if turn == 0:
                start[v, 0, 0], start[v, 0, 1] = part[v, near, 0], part[v, near, 1]
            x, y = part[v, far, 0] - start[v, 0, 0], part[v, far, 1] - start[v, 0, 1]
            there &= abs(ex * x + ey * y) >= reach[v]
        for v in range(V if side == 0 else 0):  # mirrored at the section's end, looking back is looking ahead
            for c in range(2):
                for k in range(2):
                    one, other = part[v, k, c], part[v, 3 - k, c]
                    part[v, k, c], part[v, 3 - k, c] = 2 * start[v, 0, c] - other, 2 * start[v, 0, c] - one
        if not _add_part(part, D, e, start, slip, enough):
            return False, False
        if there:
            return True, False
        at = b if side else a
    return False, False


def regular(chain: FloatArray) -> BoolArray:
    """(m,) whether no convex combination of the instances of a segment (m, V, 4, 2) has a point without speed.

    The derivatives' Bézier points of all instances lie in one half-plane then, for each of the parts into which the
    segment is halved.
    """
    good = np.zeros(len(chain), dtype=np.bool_)
    parts = chain[:, None]
    for halvings in range(5):  # a segment is halved so often at most
        if halvings:
            parts = np.concatenate(split(parts), axis=1)
        legs, chords = np.diff(parts, axis=3), parts[..., 3, :] - parts[..., 0, :]
        e = (chords / np.maximum(np.hypot(chords[..., :1], chords[..., 1:]), 1e-300)).sum(axis=2)
        ahead = np.einsum("mpc,mpvkc->mpvk", e, legs)
        good |= (ahead > FLAT * np.abs(legs).sum(axis=-1)).all(axis=(1, 2, 3))
        if good.all():
            break
    return good
