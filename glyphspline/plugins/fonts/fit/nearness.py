"""How near cubics are to the samples of an outline: as equations of what moves their points, and as a certificate."""

from __future__ import annotations

import numpy as np

from ....compiled import compiled, inlined
from ....curves.cubics import length
from ....curves.nearest import near_places
from ....curves.pairing import Demand, pair_span, room_for
from ....fitting.sharp.cubics import project
from ....types import BoolArray, FloatArray


@compiled
def shared_feet(P: FloatArray, Q: FloatArray, c: FloatArray, x: FloatArray, e: FloatArray) -> float:
    """Pair samples (K, n, 2) with points of a cubic (K, 4, 2) in K masters, see :func:`.cubics.project`.

    Args:
        c: (K, 3, 2) receives the cubic's coefficients.
    """
    for v in range(len(P)):
        for axis in range(2):
            c[v, 0, axis] = 3 * (P[v, 1, axis] - P[v, 0, axis])
            c[v, 1, axis] = 3 * (P[v, 2, axis] - 2 * P[v, 1, axis] + P[v, 0, axis])
            c[v, 2, axis] = P[v, 3, axis] - P[v, 0, axis] - 3 * (P[v, 2, axis] - P[v, 1, axis])
    return project(Q, P, c, x, e)


@inlined
def feet(p: FloatArray, Q: FloatArray, c: FloatArray, x: FloatArray, e: FloatArray) -> float:
    """The same of samples (n, 2) and a cubic (4, 2) in one master, with coefficients (3, 2)."""
    return shared_feet(p[None], Q[None], c[None], x, e)


@compiled
def reweight(weight: FloatArray, e: FloatArray, worst: float) -> None:
    """Weights of inner samples grow with their errors, their mean staying 1: squares turn to the least maximum."""
    n, total = len(weight), 0.0
    for k in range(1, n - 1):
        weight[k] *= 0.2 + e[k] / worst
        total += weight[k]
    for k in range(1, n - 1):
        weight[k] *= (n - 2) / total


@compiled
def sample_form(
    p: FloatArray, c: FloatArray, Q: FloatArray, x: FloatArray, weight: FloatArray, unit: float, form: FloatArray,
    slip: float = 0.0,
) -> float:  # fmt: skip
    """The normal equations of what brings a cubic nearer to samples, across it, when its points move.

    Args:
        p: (4, 2) the cubic. c, x: of :func:`feet`. Q: (n, 2), weight: (n,) samples. unit: of length.
        form: (8, 9) receives the form in the points' coordinates, and its right-hand side.
        slip: weight of what brings it nearer along it.

    Returns:
        The mean squared distance as it is.
    """
    n, rest, scale = len(Q), 0.0, 1 / (max(len(Q) - 2, 1) * unit * unit)
    # Products of two Bernstein polynomials are seven powers, times the normal's two coordinates.
    powers, right = np.zeros((7, 3)), np.zeros((4, 2))
    for k in range(1, n - 1):
        t = x[k]
        z = 1 - t
        dx, dy = (3 * c[2, 0] * t + 2 * c[1, 0]) * t + c[0, 0], (3 * c[2, 1] * t + 2 * c[1, 1]) * t + c[0, 1]
        size = length(dx, dy)
        if size <= 0.0:
            continue
        nx, ny = -dy / size, dx / size
        px = ((c[2, 0] * t + c[1, 0]) * t + c[0, 0]) * t + p[0, 0]
        py = ((c[2, 1] * t + c[1, 1]) * t + c[0, 1]) * t + p[0, 1]
        gap, w = nx * (Q[k, 0] - px) + ny * (Q[k, 1] - py), scale * weight[k]
        rest += w * gap * gap
        slide = slip * (ny * (Q[k, 0] - px) - nx * (Q[k, 1] - py))
        u, v = w * gap * nx + w * slide * ny, w * gap * ny - w * slide * nx
        z2, t2 = z * z, t * t
        B = (z2 * z, 3 * z2 * t, 3 * z * t2, t2 * t)
        for i in range(4):
            right[i, 0] += u * B[i]
            right[i, 1] += v * B[i]
        xx, xy, yy = w * nx * nx, w * nx * ny, w * ny * ny
        xx, xy, yy = xx + slip * yy, xy - slip * xy, yy + slip * xx
        z4, t4 = z2 * z2, t2 * t2
        T = (z4 * z2, z4 * z * t, z4 * t2, z2 * z * t2 * t, z2 * t4, z * t4 * t, t4 * t2)
        for i in range(7):
            powers[i, 0] += xx * T[i]
            powers[i, 1] += xy * T[i]
            powers[i, 2] += yy * T[i]
    for i in range(8):
        one = i // 2
        form[i, 8] = right[one, i % 2]
        for j in range(8):
            two = j // 2
            share = (3.0 if 0 < one < 3 else 1.0) * (3.0 if 0 < two < 3 else 1.0)
            form[i, j] = share * powers[one + two, i % 2 + j % 2]
    return rest


@compiled
def own_form(p: FloatArray, Q: FloatArray, unit: float, form: FloatArray) -> float:
    """:func:`sample_form` of a cubic with the ends that samples (n, 2) have, at the feet of these."""
    n = len(Q)
    c, x, e, weight = np.empty((3, 2)), np.empty(n), np.empty(n), np.ones(n)
    for k in range(n):
        x[k] = k / (n - 1)
    feet(p, Q, c, x, e)
    return sample_form(p, c, Q, x, weight, unit, form)


@compiled
def add_samples(
    p: FloatArray, c: FloatArray, Q: FloatArray, x: FloatArray, weight: FloatArray, J: FloatArray, unit: float,
    own: FloatArray, slip: float = 0.0,
) -> float:  # fmt: skip
    """Add :func:`sample_form` in other unknowns.

    Args:
        J: (4, 2, u) how u unknowns move the cubic's points, most of them few of these.
        own: (u, u + 1) the lower half of the form, and its right-hand side.

    Returns:
        The mean squared distance as it is.
    """
    u, form, image = J.shape[2], np.empty((8, 9)), np.empty(9)
    rest = sample_form(p, c, Q, x, weight, unit, form, slip)
    for i in range(u):
        image[:] = 0.0
        for k in range(8):
            move = J[k // 2, k % 2, i]
            if move != 0.0:
                for m in range(9):
                    image[m] += move * form[k, m]
        own[i, u] += image[8]
        for j in range(i + 1):
            for k in range(8):
                own[i, j] += J[k // 2, k % 2, j] * image[k]
    return rest


@compiled
def squares(points: FloatArray, exact: FloatArray, own: FloatArray, rest: float) -> float:
    """The mean squared distance of samples when points (k, 2) move from the exact ones.

    Args:
        own: (2 k, 2 k + 1), rest: of :func:`add_samples`, with the points' coordinates as the unknowns.
    """
    n = 2 * len(points)
    for i in range(n):
        move = points[i // 2, i % 2] - exact[i // 2, i % 2]
        if move == 0.0:
            continue
        part = own[i, i] * move - 2 * own[i, n]
        for j in range(i):
            part += 2 * own[i, j] * (points[j // 2, j % 2] - exact[j // 2, j % 2])
        rest += move * part
    return rest


@inlined
def squares_of_two(points: FloatArray, exact: FloatArray, form: FloatArray, rest: float) -> float:
    """The same of two points, without loops."""
    a, b, c, d = (
        points[0, 0] - exact[0, 0],
        points[0, 1] - exact[0, 1],
        points[1, 0] - exact[1, 0],
        points[1, 1] - exact[1, 1],
    )
    rest += a * (form[0, 0] * a - 2 * form[0, 4])
    rest += b * (form[1, 1] * b - 2 * form[1, 4] + 2 * form[1, 0] * a)
    rest += c * (form[2, 2] * c - 2 * form[2, 4] + 2 * form[2, 0] * a + 2 * form[2, 1] * b)
    rest += d * (form[3, 3] * d - 2 * form[3, 4] + 2 * form[3, 0] * a + 2 * form[3, 1] * b + 2 * form[3, 2] * c)
    return rest


@compiled
def reduced(points: FloatArray, exact: FloatArray, own: FloatArray, rest: float, lo: int, form: FloatArray) -> float:
    """The form of :func:`squares` for two neighbouring points of a cubic (4, 2), while the other two stay.

    Args:
        lo: the first of the two. form: (4, 5) receives theirs.

    Returns:
        Its rest.
    """
    for u in range(8):
        move = points[u // 2, u % 2] - exact[u // 2, u % 2]
        mine = 0 <= u - 2 * lo < 4
        if mine:
            form[u - 2 * lo, 4] = own[u, 8]
        else:
            rest -= 2 * own[u, 8] * move
        for v in range(8):
            away = points[v // 2, v % 2] - exact[v // 2, v % 2]
            if 0 <= v - 2 * lo < 4:
                if mine:
                    form[u - 2 * lo, v - 2 * lo] = own[u, v]
            elif mine:
                form[u - 2 * lo, 4] -= own[u, v] * away
            else:
                rest += own[u, v] * move * away
    return rest


@compiled
def certified(
    V: int, chain: FloatArray, hints: FloatArray, stays: BoolArray, skip: BoolArray, closed: bool, other: FloatArray,
    arc: FloatArray, tolerance: float,
) -> FloatArray:  # fmt: skip
    """(r,) bounds of the distance of cubics from stretches of the source, in V instances; inf where not finite.

    Args:
        chain: (r V, 4, 2) the cubics. other: (m V, 4, 2) the source. arc: see :class:`...curves.pairing.Demand`.
        hints: (r + 1,) places of the source near which the cubics begin and end. stays: (r + 1,) where exactly there.
        skip: (r,) which cubics are not measured, and get 0. closed: whether the last end is the first again.
    """
    r, m = len(chain) // V, len(other) // V
    room, demand = room_for(V), Demand(arc, True, tolerance, 0.02 * tolerance)
    places, bounds = hints.copy(), np.zeros(r)
    near_places(V, other, hints[:r], chain, stays, False, hints[r - 1] - m, hints[r], places)
    if closed:
        places[r] = places[0] + m
    if places[0] < 0.0:
        places += m
    for s in range(r):
        if skip[s]:
            continue
        room.found[:] = 0.0
        pair_span(room, chain, (s, 0.0, 1.0), other, (places[s], places[s + 1]), demand)
        bounds[s] = room.found[0] if np.isfinite(chain[s * V : (s + 1) * V]).all() else np.inf
    return bounds
