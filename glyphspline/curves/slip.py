"""The slip bound: how far two chains are from each other in a design space, whatever their pace along each other.

The plain bound of :mod:`.pairing` charges a result for running along its outline at another pace, which instances do
in different ways, and no pairing of places suits all of them. The *slip* bound does not.

Let A and B be a pair of sections in V instances, e the direction of their chords, the same for all instances,
D = A - B, and σ the largest ``|e·D|``. The chain of B is followed beyond both ends of the section until it extends by σ
along e in every instance. Let all its derivatives h have e·h > 0. A point A(t) lies at the height along e of some point
B(s) of the chain, and the way from B(t) to there is the integral of the h(ξ) in between. Hence, for some of these,

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

from ..compiled import compiled, inlined
from ..types import BoolArray, FloatArray
from .bezier import split
from .cubics import length, section

FLAT = 1e-9
"""Least extent of a derivative along a chord, as a share of its length, that counts as positive."""

SCRATCH = 3
"""Stacks (V, 4, 2) that :func:`slip_bound` works in."""


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
    V, D, ex, ey, reach = len(A), scratch[: len(A)], 0.0, 0.0, 0.0
    for v in range(V):
        ex += A[v, 3, 0] - A[v, 0, 0] + B[v, 3, 0] - B[v, 0, 0]
        ey += A[v, 3, 1] - A[v, 0, 1] + B[v, 3, 1] - B[v, 0, 1]
    size = length(ex, ey)
    if size <= 0.0:
        return np.inf
    ex, ey = ex / size, ey / size
    for v in range(V):
        for k in range(4):
            D[v, k, 0], D[v, k, 1] = A[v, k, 0] - B[v, k, 0], A[v, k, 1] - B[v, k, 1]
            reach = max(reach, abs(ex * D[v, k, 0] + ey * D[v, k, 1]))
    slip = np.zeros((2, 4))
    slip[:, 2] = np.inf
    if not (_add_part(A, D, ex, ey, slip[0], enough) and _add_part(B, D, ex, ey, slip[1], enough)):
        return np.inf
    for side in range(2):
        x, y, x_end, y_end = places[side], places[2 + side], arc[side], arc[2 + side]
        good, ended = _follow(source, D, side, y, y_end, reach, ex, ey, slip[1], enough, scratch)
        if not good:
            return np.inf
        far = np.inf if ended else reach
        good, also = _follow(result, D, side, x, x_end, far, ex, ey, slip[0], enough, scratch)
        if good and also and not ended:
            good, _ = _follow(source, D, side, y, y_end, np.inf, ex, ey, slip[1], enough, scratch)
        if not good:
            return np.inf
    return max(_one_way(slip[0], V), _one_way(slip[1], V))


@inlined
def _one_way(slip: FloatArray, V: int) -> float:
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
    for mixed in range(2):
        for i in range(3):
            for u in range(V):
                ux, uy = b[u, i + 1, 0] - b[u, i, 0], b[u, i + 1, 1] - b[u, i, 1]
                ahead = ex * ux + ey * uy
                if not mixed:
                    if not ahead > FLAT * (abs(ux) + abs(uy)):
                        return False
                    slip[2], slip[3] = min(slip[2], ahead), max(slip[3], ahead)
                for v in range(0 if mixed else u, u if mixed else u + 1):
                    vx, vy, most = b[v, i + 1, 0] - b[v, i, 0], b[v, i + 1, 1] - b[v, i, 1], 0.0
                    for k in range(4):
                        cross = ux * D[v, k, 1] - uy * D[v, k, 0] + vx * D[u, k, 1] - vy * D[u, k, 0]
                        most = max(most, abs(cross))
                    slip[mixed] = max(slip[mixed], most / (ahead + ex * vx + ey * vy))
        if slip[0] > enough:
            return False
    return _one_way(slip, V) <= enough


@compiled
def _follow(
    chain: FloatArray, D: FloatArray, side: int, first: float, last: float, reach: float, ex: float, ey: float,
    slip: FloatArray, enough: float, scratch: FloatArray,
) -> tuple[bool, bool]:  # fmt: skip
    """Take in what a chain (m V, 4, 2) has beyond a place, until it extends by ``reach`` or its arc ends.

    Args:
        side: 0 to look back from the place ``first``, 1 to look ahead. last: the arc's end.

    Returns:
        Whether the chain gets that far along e, with a slip bound that is small enough, and whether the arc ended.
    """
    V = len(D)
    m, part, start = len(chain) // V, scratch[V : 2 * V], scratch[2 * V :]
    near, far = (0, 3) if side else (3, 0)
    at = first
    for turn in range(24):  # so many parts are looked at at most
        if at >= last if side else at <= last:
            return True, True
        s = int(np.floor(at)) if side else int(np.ceil(at)) - 1
        # The first part, as a share of a segment; each is twice as long as the one before.
        step = min(s + 1 - at if side else at - s, (1 / 64) * 2.0**turn)
        a, b = (at, min(at + step, last)) if side else (max(at - step, last), at)
        least = np.inf
        for v in range(V):
            section(chain[s % m * V + v], a - s, b - s, part[v])
            if turn == 0:
                start[v, 0, 0], start[v, 0, 1] = part[v, near, 0], part[v, near, 1]
            x, y = part[v, far, 0] - start[v, 0, 0], part[v, far, 1] - start[v, 0, 1]
            least = min(least, abs(ex * x + ey * y))
        if not _add_part(part, D, ex, ey, slip, enough):
            return False, False
        if least >= reach:
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
