"""Rounding of a run's cubics to the grid: node and handles together, so that the turn is the least the grid allows.

Rounded one by one, a node and two handles of 20 steps turn by 2 degrees. Here each node in turn takes, of its
neighbours on the grid, those that cost least: distance from the outline, turn, and jumps of curvature at the node and
its two neighbours. Handles that are horizontal or vertical stay so. Distances are a quadratic form of the moves of a
cubic's points, as samples keep their normals.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...curves.cubics import length
from ...types import FloatArray
from .corners import Joints
from .harmony import AXIS, FIXED, HELD, Run, end_jump, feet

SWEEPS = 4
"""How often all nodes are visited; few move in the fourth."""

TURN, JUMP = 0.0080, 0.095
"""Turn of a joint, in radians, and jump of curvature that are to be avoided."""

TURN_PRICE, JUMP_PRICE = 100.0, 2.0
"""What a joint beyond these costs, in mean squares of distance at the tolerance."""


@compiled
def round_run(run: Run, joints: Joints, i: int, tolerance: float, em: float) -> None:
    """Round the cubics of a run, whose first node is joint i of the outline."""
    r, P = len(run.P), run.P
    exact, forms, pulls = P.copy(), np.zeros((r, 8, 8)), np.zeros((r, 8))
    for s in range(r):
        if not run.held[s]:
            a, b = joints.first[i + run.places[s]], joints.first[i + run.places[s + 1]]
            set_form(P[s], joints.samples[0, a : b + 1], tolerance, forms[s], pulls[s])
    nodes = r if run.closed else r + 1
    for s in range(r):
        if not run.held[s]:
            P[s] = np.rint(P[s])
    best = np.empty((3, 2))
    for _ in range(SWEEPS):
        changed = False
        for k in range(nodes):
            after, before = k if k < r else -1, k - 1 if k > 0 else (r - 1 if run.closed else -1)
            if after >= 0 and run.held[after]:
                after = -1
            if before >= 0 and run.held[before]:
                before = -1
            if after < 0 and before < 0:
                continue
            changed = improve(run, k, before, after, exact, forms, pulls, em, best) or changed
        if not changed:
            break


@compiled
def set_form(p: FloatArray, Q: FloatArray, tolerance: float, form: FloatArray, pull: FloatArray) -> None:
    """The mean squared distance of samples from a cubic, in tolerances, as a quadratic form of its points' moves."""
    n = len(Q)
    x, e, c, row = np.empty(n), np.empty(n), np.empty((3, 2)), np.empty(8)
    for k in range(n):
        x[k] = k / (n - 1)
    feet(p, Q, c, x, e)
    w = 1 / (max(n - 2, 1) * tolerance * tolerance)
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
        gap = nx * (px - Q[k, 0]) + ny * (py - Q[k, 1])
        B = (z * z * z, 3 * z * z * t, 3 * z * t * t, t * t * t)
        for q in range(4):
            row[2 * q], row[2 * q + 1] = B[q] * nx, B[q] * ny
        for q in range(8):
            pull[q] += w * gap * row[q]
            for o in range(8):
                form[q, o] += w * row[q] * row[o]


@compiled
def distance_cost(p: FloatArray, exact: FloatArray, form: FloatArray, pull: FloatArray) -> float:
    """By how much moving a cubic's points from the exact ones changes its mean squared distance."""
    total = 0.0
    for q in range(8):
        move = p[q // 2, q % 2] - exact[q // 2, q % 2]
        part = 2 * pull[q]
        for o in range(8):
            part += form[q, o] * (p[o // 2, o % 2] - exact[o // 2, o % 2])
        total += move * part
    return total


@compiled
def turn_cost(turn: float) -> float:
    """What a joint's turn costs."""
    turn = abs(turn)
    return 0.3 * (turn / TURN) ** 2 + (TURN_PRICE * turn / TURN if turn > TURN else 0.0)


@compiled
def joint_cost(run: Run, k: int, em: float) -> float:
    """What the turn and the jump of curvature at a node cost."""
    r, P = len(run.P), run.P
    if not run.closed and k in (0, r):
        if run.kind[k] == FIXED:
            return 0.0
        p, end = (P[0], 0) if k == 0 else (P[r - 1], 1)
        sign = 1 - 2 * end
        x, y = sign * (p[1 + end, 0] - p[3 * end, 0]), sign * (p[1 + end, 1] - p[3 * end, 1])
        tx, ty = run.T[k, 0], run.T[k, 1]
        return turn_cost(np.arctan2(tx * y - ty * x, tx * x + ty * y))
    p, q = P[k - 1], P[k % r]
    ax, ay, bx, by = p[3, 0] - p[2, 0], p[3, 1] - p[2, 1], q[1, 0] - q[0, 0], q[1, 1] - q[0, 1]
    if (ax == 0.0 and ay == 0.0) or (bx == 0.0 and by == 0.0):
        return 10.0 * TURN_PRICE
    cost = turn_cost(np.arctan2(ax * by - ay * bx, ax * bx + ay * by))
    jump = min(end_jump(p, q, em), 1.0)
    return cost + run.ease[k] * (0.25 * (jump / JUMP) ** 2 + (JUMP_PRICE if jump > JUMP else 0.0))


@compiled
def cost_at(
    run: Run, k: int, before: int, after: int, exact: FloatArray, forms: FloatArray, pulls: FloatArray, em: float
) -> float:
    """What changes with the points at a node: distances of the cubics there, and joints up to the next nodes."""
    r, total = len(run.P), joint_cost(run, k, em)
    if before >= 0:
        total += distance_cost(run.P[before], exact[before], forms[before], pulls[before])
        if run.closed or k > 1:
            total += joint_cost(run, (k - 1) % r, em)
    if after >= 0:
        total += distance_cost(run.P[after], exact[after], forms[after], pulls[after])
        if run.closed or k + 1 < r:
            total += joint_cost(run, (k + 1) % r if run.closed else k + 1, em)
    return total


@compiled
def put_points(run: Run, before: int, after: int, points: FloatArray, k: int) -> None:
    """Set a node and its handles: the one before it, the node, and the one after it."""
    P, moves = run.P, run.kind[k] >= AXIS
    for axis in range(2):
        if before >= 0:
            P[before, 2, axis] = points[0, axis]
            if moves:
                P[before, 3, axis] = points[1, axis]
        if after >= 0:
            if moves:
                P[after, 0, axis] = points[1, axis]
            P[after, 1, axis] = points[2, axis]


@compiled
def improve(
    run: Run, k: int, before: int, after: int, exact: FloatArray, forms: FloatArray, pulls: FloatArray, em: float,
    best: FloatArray,
) -> bool:  # fmt: skip
    """Give a node and its handles the cheapest of the neighbouring places on the grid; whether they changed."""
    P, kind = run.P, run.kind[k]
    start, now = np.empty((3, 2)), np.empty((3, 2))
    for axis in range(2):
        start[1, axis] = P[after, 0, axis] if after >= 0 else P[before, 3, axis]
        start[0, axis] = P[before, 2, axis] if before >= 0 else start[1, axis]
        start[2, axis] = P[after, 1, axis] if after >= 0 else start[1, axis]
    if kind == AXIS:
        across = 1 if abs(run.T[k, 0]) > 0.5 else 0
        start[0, across] = start[2, across] = start[1, across]
        put_points(run, before, after, start, k)
    best[:] = start
    least, changed = cost_at(run, k, before, after, exact, forms, pulls, em), False
    tx, ty = run.T[k, 0], run.T[k, 1]
    steep = abs(ty) > abs(tx)
    if kind == AXIS:
        axis = 1 if steep else 0
        for code in range(27):
            now[:] = start
            now[1, axis] += code % 3 - 1
            now[0, axis] += code // 3 % 3 - 1
            now[2, axis] += code // 9 - 1
            put_points(run, before, after, now, k)
            cost = cost_at(run, k, before, after, exact, forms, pulls, em)
            if cost < least - 1e-9:
                least, changed, best[:] = cost, True, now
    elif kind == FIXED:
        for code in range(9):
            now[:] = start
            row = 2 if after >= 0 else 0
            now[row, 0] += code % 3 - 1
            now[row, 1] += code // 3 - 1
            put_points(run, before, after, now, k)
            cost = cost_at(run, k, before, after, exact, forms, pulls, em)
            if cost < least - 1e-9:
                least, changed, best[:] = cost, True, now
    elif kind == HELD:
        # Along the tangent, on the grid's lines across it, and a step to either side.
        for row, s in ((0, before), (2, after)):
            if s < 0:
                continue
            one, two = (1, 0) if steep else (0, 1)
            slope = (tx / ty) if steep else (ty / tx)
            for code in range(15):
                now[:] = start
                now[row, one] += code % 5 - 2
                now[row, two] = np.rint(now[1, two] + slope * (now[row, one] - now[1, one])) + code // 5 - 1
                put_points(run, before, after, now, k)
                cost = cost_at(run, k, before, after, exact, forms, pulls, em)
                if cost < least - 1e-9:
                    least, changed, best[:] = cost, True, now
    else:
        one, two = (1, 0) if steep else (0, 1)
        for code in range(45):
            for row in range(0, 3, 2):
                # The node and one handle among their neighbours, the other handle on the line through both.
                other = 2 - row
                now[:] = start
                place = code // 9
                if place > 0:
                    now[1, (place - 1) // 2] += 1.0 if place % 2 else -1.0
                now[row, 0] += code % 3 - 1
                now[row, 1] += code // 3 % 3 - 1
                run_one, run_two = now[1, one] - now[row, one], now[1, two] - now[row, two]
                if run_one == 0.0:
                    continue
                for step in range(-1, 2):
                    now[other, one] = start[other, one] + step
                    now[other, two] = np.rint(now[1, two] + run_two / run_one * (now[other, one] - now[1, one]))
                    ax, ay, bx, by = (
                        now[1, 0] - now[0, 0],
                        now[1, 1] - now[0, 1],
                        now[2, 0] - now[1, 0],
                        now[2, 1] - now[1, 1],
                    )
                    if abs(ax * by - ay * bx) > 2 * TURN * (ax * bx + ay * by):
                        continue
                    put_points(run, before, after, now, k)
                    cost = cost_at(run, k, before, after, exact, forms, pulls, em)
                    if cost < least - 1e-9:
                        least, changed, best[:] = cost, True, now
    put_points(run, before, after, best, k)
    return changed
