"""Places on the grid of a node, its handles and the handles beyond these, at which curvatures meet.

All costs are at least 0, as in :mod:`.lattice`: a place is given up as soon as a part of them is as much as the best
place's.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....arrays import put
from ....compiled import compiled, inlined
from ....curves.cubics import length
from ....types import FloatArray, IntArray
from ..extrema import hidden_extrema
from .harmony import FLAT, end_curvature
from .nearness import own_form, reduced, squares_of_two
from .run_nodes import CubicRun, RunArrays

MET, NO_KINK, FAREST = 0.095, np.radians(0.45), 0.5
"""Jump of curvature and turn of a joint at which curvatures are made to meet; and the mean squared distance, in
tolerances, of a cubic beyond which they are not."""

STEPS = (0.0, -1.0, 1.0, -2.0, 2.0)
NEARBY = tuple(sorted(((x, y) for x in STEPS for y in STEPS), key=lambda step: step[0] ** 2 + step[1] ** 2))
"""Moves of a node along an axis, and in both, the smallest first."""


class Move(NamedTuple):
    """How a node moves: by (dx, dy); ``level``: the axis on which its handles stay level, -1 if they may turn."""

    level: int
    dx: float
    dy: float


class MoveCost(NamedTuple):
    """What moving the points of a cubic costs in distance, see :func:`.nearness.squares`."""

    form: FloatArray
    exact: FloatArray
    rest: float


@compiled
def side_places(
    run: CubicRun, s: int, end: int, move: Move, of: MoveCost, far: tuple[float, float, float, bool], em: float,
    dearest: float, found: FloatArray,
) -> int:  # fmt: skip
    """Places of the two inner points of cubic s when the node at one end of it moves.

    Args:
        of: the cubic's. far: the vector in which the next cubic begins at the other end, its curvature there, and
            whether that end's handle stays. dearest: the cost from which places are left out.
        found: (2025, 8) receives the cost, the curvature, the handle's vector, and both points.

    Returns:
        Their number.
    """
    (level, dx, dy), (form, exact, rest) = move, of
    n, h, b, f = (0, 1, 2, 3) if end == 0 else (3, 2, 1, 0)
    p, own, count, part = run.P[s], run.P[s].copy(), 0, np.empty((4, 5))
    own[n, 0], own[n, 1] = p[n, 0] + dx, p[n, 1] + dy
    base = reduced(own, exact, form, rest, 1, part)
    ux, uy, beyond, stays = far
    x, y = p[b, 0] - p[f, 0], p[b, 1] - p[f, 1]
    was, jumped = abs(np.arctan2(x * uy - y * ux, -(x * ux + y * uy))), False
    for step in range(-1, 25):
        if step == 12 or (stays and step >= 0):
            continue
        u, v = (0.0, 0.0) if step < 0 else (step % 5 - 2.0, step // 5 - 2.0)
        own[b, 0], own[b, 1] = p[b, 0] + u, p[b, 1] + v
        bx, by = own[b, 0] - p[f, 0], own[b, 1] - p[f, 1]
        if step >= 0:
            turn = abs(np.arctan2(bx * uy - by * ux, -(bx * ux + by * uy)))
            if turn > max(was, NO_KINK) or turn < min(was, 0.22):
                continue
        if step >= 0 and least_square(own, exact, part, base, b) >= dearest:
            continue
        size = max(length(bx, by), 1e-9)
        for code in range(-1, 13 if level >= 0 else 81):
            if level >= 0:
                u, v = (0.0, 0.0) if code < 0 else (code - 6.0, 0.0)
                u, v = (v, u) if level == 0 else (u, v)
                u, v = u + dx, v + dy
            else:
                u, v = (0.0, 0.0) if code < 0 else (dx + code % 9 - 4.0, dy + code // 9 - 4.0)
            if code < 0 and (step >= 0 or dx != 0.0 or dy != 0.0):
                continue
            own[h, 0], own[h, 1] = p[h, 0] + u, p[h, 1] + v
            ax, ay, ex, ey = own[h, 0] - own[n, 0], own[h, 1] - own[n, 1], own[b, 0] - own[h, 0], own[b, 1] - own[h, 1]
            if ax * (p[h, 0] - p[n, 0]) + ay * (p[h, 1] - p[n, 1]) < 1.0:
                continue
            other = 2 / 3 * (bx * (own[h, 1] - own[b, 1]) - by * (own[h, 0] - own[b, 0])) / (size * size * size)
            most = max(abs(other), abs(beyond))
            jump = most * em > 1.0 and abs(other + beyond) > 0.1 * most
            if code < 0:
                jumped = jump
                continue
            if jump and not jumped and beyond < np.inf:
                continue
            cost = squares_of_two(own[1:3], exact[1:3], part, base)
            if cost < dearest and hidden_extrema(own) <= run.extrema[s]:
                arm = length(ax, ay)
                found[count, 0], found[count, 1] = cost, 2 / 3 * (ax * ey - ay * ex) / (arm * arm * arm)
                found[count, 2], found[count, 3] = ax, ay
                found[count, 4], found[count, 5] = own[h, 0], own[h, 1]
                found[count, 6], found[count, 7] = own[b, 0], own[b, 1]
                count += 1
    return count


@compiled
def least_square(points: FloatArray, exact: FloatArray, form: FloatArray, rest: float, b: int) -> float:
    """The least of :func:`.nearness.squares` of the inner points of a cubic (4, 2), of which point b stays."""
    u, v, i, j = points[b, 0] - exact[b, 0], points[b, 1] - exact[b, 1], 2 * b - 2, 4 - 2 * b
    rest += u * (form[i, i] * u - 2 * form[i, 4]) + v * (
        form[i + 1, i + 1] * v + 2 * (form[i + 1, i] * u - form[i + 1, 4])
    )
    x = form[j, 4] - form[j, i] * u - form[j, i + 1] * v
    y = form[j + 1, 4] - form[j + 1, i] * u - form[j + 1, i + 1] * v
    a, c, d = form[j, j], form[j + 1, j], form[j + 1, j + 1]
    size = a * d - c * c
    # Rounding may leave a little less than the least.
    return rest - (d * x * x - 2 * c * x * y + a * y * y) / size - 1e-9 if size > 1e-9 * a * d else 0.0


@inlined
def beyond_end(run: CubicRun, s: int, end: int) -> tuple[float, float, float, bool]:
    """What cubic s of a run meets at an end, see :func:`side_places`."""
    r = len(run.P)
    q = s + 1 if end else s - 1
    if not run.closed and (q < 0 or q == r):
        return 0.0, 0.0, np.inf, True
    p, own = run.P[q % r], 1 - end
    x, y = p[1 + own, 0] - p[3 * own, 0], p[1 + own, 1] - p[3 * own, 1]
    return x, y, (1 - 2 * own) * end_curvature(p, own), False


@compiled
def meet(
    arrays: RunArrays, k: int, samples: FloatArray, first: IntArray, tolerance: float, em: float, room: FloatArray
) -> bool:  # fmt: skip
    """Let curvatures meet at a node, by the nearest places of it, its handles, and the handles beyond these.

    Args:
        arrays: of a :class:`.run_nodes.Run`. samples, first: of :class:`.run_nodes.Guide`. room: (2, 2025, 8) of work.

    Returns:
        Whether there are such places.
    """
    run = CubicRun(*arrays)
    r, P = len(run.P), run.P
    a, q = (k - 1) % r, k % r
    nx, ny, exact, forms, rest = P[q, 0, 0], P[q, 0, 1], np.empty((2, 4, 2)), np.empty((2, 8, 9)), np.empty(2)
    for side, s in enumerate((a, q)):
        put(P[s], exact[side])
        Q = samples[first[run.places[s]] : first[run.places[s + 1]] + 1]
        rest[side] = own_form(P[s], Q, tolerance, forms[side])
    level = 0 if P[a, 2, 0] == nx and P[q, 1, 0] == nx else -1
    level = 1 if P[a, 2, 1] == ny and P[q, 1, 1] == ny else level
    one, two, least = beyond_end(run, a, 0), beyond_end(run, q, 1), np.inf
    best, costs = np.empty((5, 2)), (MoveCost(forms[0], exact[0], rest[0]), MoveCost(forms[1], exact[1], rest[1]))
    for code in range(5 if level >= 0 else 25):
        dx, dy = NEARBY[code] if level < 0 else (0.0, STEPS[code]) if level == 0 else (STEPS[code], 0.0)
        move = Move(level, dx, dy)
        before = side_places(run, a, 1, move, costs[0], one, em, min(FAREST, least), room[0])
        left = np.inf
        for u in range(before):
            left = min(left, room[0, u, 0])
        if before == 0 or left >= least:
            continue
        after = side_places(run, q, 0, move, costs[1], two, em, min(FAREST, least - left), room[1])
        for u in range(before):
            if room[0, u, 0] >= least:
                continue
            for v in range(after):
                cost, x, y = room[0, u, 0] + room[1, v, 0], room[0, u, 1], room[1, v, 1]
                most = max(abs(x), abs(y))
                if cost >= least or (most * em > FLAT and abs(x + y) > MET * most):
                    continue
                ax, ay, bx, by = -room[0, u, 2], -room[0, u, 3], room[1, v, 2], room[1, v, 3]
                along = ax * bx + ay * by
                if along <= 0.0 or abs(ax * by - ay * bx) > NO_KINK * along:
                    continue
                least, best[2, 0], best[2, 1] = cost, nx + dx, ny + dy
                for axis in range(2):
                    best[0, axis], best[1, axis] = room[0, u, 6 + axis], room[0, u, 4 + axis]
                    best[3, axis], best[4, axis] = room[1, v, 4 + axis], room[1, v, 6 + axis]
    if least < np.inf:
        put(best[:3], P[a, 1:])
        put(best[2:], P[q, :3])
    return least < np.inf
