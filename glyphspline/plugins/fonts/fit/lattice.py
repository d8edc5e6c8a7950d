"""Rounding of a run's cubics to the grid: node and handles together, so that the turn is the least the grid allows.

Rounded one by one, a node and two handles of 20 steps turn by 2 degrees. Here each node in turn takes, of its
neighbours on the grid, those that cost least: distance from the outline, turn, and jumps of curvature at the node and
its two neighbours. Handles that are horizontal or vertical stay so. Distances are a quadratic form of the moves of a
cubic's points, as samples keep their normals.

All costs are at least 0, so that a place is given up as soon as a part of them is as much as the best place's.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....arrays import put
from ....compiled import compiled, inlined
from ....curves.cubics import square
from ....intrinsics import borrowed, keep_alive
from ....types import FloatArray, IntArray
from ..extrema import hidden_extrema
from .harmony import end_jump
from .nearness import own_form, reduced, squares_of_two
from .run_nodes import AXIS, FIXED, FREE, HELD, CubicRun, RunArrays, sides

SWEEPS = 4
"""How often all nodes are visited; few move in the fourth."""

TURN, JUMP = 0.0080, 0.15
"""Turn of a joint, in radians, and jump of curvature that are to be avoided."""

TURN_PRICE, JUMP_PRICE = 100.0, 2.0
"""What a joint beyond these costs, in mean squares of distance at the tolerance."""

HIDDEN_PRICE = 10.0
"""The same of an extremum inside a cubic that the source has not: rounding alone makes some beside an extreme node."""


class Measure(NamedTuple):
    """What moving the points of a run costs in distance.

    Attributes:
        exact: (r, 4, 2) where they were. own, rest: (r, 8, 9), (r,) of :func:`.nearness.sample_form`.
        form, base: (2, 4, 5), (2,) the same for the points of the cubics before and after a node that move with it.
    """

    exact: FloatArray
    own: FloatArray
    rest: FloatArray
    form: FloatArray
    base: FloatArray


@compiled
def round_run(arrays: RunArrays, samples: FloatArray, first: IntArray, tolerance: float, em: float) -> None:
    """Round the cubics of a :class:`.run_nodes.Run`.

    Its ends, and nodes beside cubics that are held, stay where they are, on the grid or not: what they join is as the
    source has it.

    Args:
        samples, first: of :class:`.run_nodes.Guide`.
    """
    run = borrowed(CubicRun(*arrays))
    r, P = len(run.P), run.P
    owned = Measure(P.copy(), np.empty((r, 8, 9)), np.zeros(r), np.empty((2, 4, 5)), np.empty(2))
    measure = borrowed(owned)
    for s in range(r):
        if run.held[s]:
            continue
        Q = samples[first[run.places[s]] : first[run.places[s + 1]] + 1]
        measure.rest[s] = own_form(P[s], Q, tolerance, measure.own[s])
        whole = run.held[s - 1] or (s == 0 and not run.closed), run.held[(s + 1) % r] or (s == r - 1 and not run.closed)
        for k in range(4):
            for axis in range(2):
                if not ((k == 0 and whole[0]) or (k == 3 and whole[1])):
                    P[s, k, axis] = np.rint(P[s, k, axis])
    nodes = r if run.closed else r + 1
    work = np.empty((270, 3, 2)), np.empty((3, 2)), np.empty((2, 4)), np.empty((2, 3))
    room, best, seen, parts = borrowed(work)
    waiting, later = np.ones(nodes, dtype=np.bool_), np.zeros(nodes, dtype=np.bool_)
    for _ in range(SWEEPS):
        later[:] = False
        for k in range(nodes):
            if not waiting[k]:
                continue
            waiting[k] = False
            if improve(run, k, measure, em, room, best, seen, parts):
                # Costs reach as far as the joints beside the neighbours.
                for away in range(-2, 3):
                    o = (k + away) % nodes if run.closed else min(max(k + away, 0), nodes - 1)
                    waiting[o] = later[o] = True
        if not later.any():
            break
    keep_alive((owned, work))


@compiled
def turn_cost(ax: float, ay: float, bx: float, by: float) -> float:
    """What the turn from one vector to another costs."""
    along = ax * bx + ay * by
    if along <= 0.0:
        return 1e4 * TURN_PRICE
    turn = abs(ax * by - ay * bx) / along
    return 0.3 * square(turn / TURN) + (TURN_PRICE * turn / TURN if turn > TURN else 0.0)


@compiled
def end_cost(run: CubicRun, k: int) -> float:
    """What the turn from the tangent at the first or last node of a run costs, but at a corner."""
    if run.kind[k] == FIXED:
        return 0.0
    p, i, j = (run.P[0], 0, 1) if k == 0 else (run.P[k - 1], 2, 3)
    return turn_cost(run.T[k, 0], run.T[k, 1], p[j, 0] - p[i, 0], p[j, 1] - p[i, 1])


@compiled
def joint_cost(P: FloatArray, s: int, q: int, ease: float, slack: float, em: float, least: float) -> float:
    """What the turn and the jump of curvature cost where cubic q follows on cubic s, jumps by their weight; at least
    ``least`` where it would be that much."""
    cost = turn_cost(P[s, 3, 0] - P[s, 2, 0], P[s, 3, 1] - P[s, 2, 1], P[q, 1, 0] - P[q, 0, 0], P[q, 1, 1] - P[q, 0, 1])
    if cost >= least:
        return cost
    jump = max(min(end_jump(P[s], P[q], em), 1.0) - slack, 0.0)
    return cost + ease * (0.25 * square(jump / JUMP) + (JUMP_PRICE if jump > JUMP else 0.0))


@inlined
def cost_at(
    run: CubicRun, k: int, before: int, after: int, measure: Measure, em: float, least: float, seen: FloatArray,
    parts: FloatArray,
) -> float:  # fmt: skip
    """What changes with the points at a node: distances of the cubics there, and joints up to the next nodes.

    At least ``least`` where it would be that much.

    Args:
        seen: (2, 4) the points that move of the cubics before and after the node, at the last call. parts: (2, 3) what
            each cost by itself, as far as that was needed: its distance, extrema, and the joint at its other end.
    """
    r, P, ease, far = len(run.P), run.P, run.ease, 0.0
    for side, s in enumerate((before, after)):
        if s < 0:
            continue
        u, own, part = 2 - 2 * side, seen[side], parts[side]
        if P[s, u, 0] != own[0] or P[s, u, 1] != own[1] or P[s, u + 1, 0] != own[2] or P[s, u + 1, 1] != own[3]:
            own[0], own[1], own[2], own[3] = P[s, u, 0], P[s, u, 1], P[s, u + 1, 0], P[s, u + 1, 1]
            part[0] = squares_of_two(
                P[s, u : u + 2], measure.exact[s, u : u + 2], measure.form[side], measure.base[side]
            )
            part[1] = part[2] = -1.0
        far += part[0]
        if far >= least:
            return far
    left, right = k - 1 if k > 0 else r - 1, k if k < r else 0
    inner = run.closed or 0 < k < r
    total = joint_cost(P, left, right, ease[right], run.slack[right], em, least) if inner else end_cost(run, k)
    for side, s in enumerate((before, after)):
        if s >= 0:
            total += parts[side, 0]
    for side, s in enumerate((before, after)):
        if s >= 0 and total < least:
            if parts[side, 1] < 0.0 or r < 3:
                parts[side, 1] = HIDDEN_PRICE if hidden_extrema(P[s]) > run.extrema[s] else 0.0
            total += parts[side, 1]
    for side, s in enumerate((before, after)):
        if s >= 0 and total < least and (run.closed or 0 < k - 1 + 2 * side < r):
            if parts[side, 2] < 0.0 or r < 3:  # where both sides meet again
                q = s + side if s + side < r else 0
                parts[side, 2] = joint_cost(P, q - 1, q, ease[q], run.slack[q], em, np.inf)
            total += parts[side, 2]
    return total


@compiled
def put_points(run: CubicRun, before: int, after: int, points: FloatArray, k: int) -> None:
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
def candidates(
    kind: int, tx: float, ty: float, start: FloatArray, before: bool, after: bool, found: FloatArray
) -> int:  # fmt: skip
    """Neighbouring places (…, 3, 2) of a node and its handles, of which there are those before and after it.

    Args:
        kind, tx, ty: of the node, see :class:`.run_nodes.Run`. start: (3, 2) where they are.

    Returns:
        Their number.
    """
    one = 1 if abs(ty) > abs(tx) else 0
    two, count = 1 - one, 0
    if kind == AXIS:
        for code in range(27):
            set_place(found, count, start)
            found[count, 1, one] += code % 3 - 1
            found[count, 0, one] += code // 3 % 3 - 1
            found[count, 2, one] += code // 9 - 1
            count += 1
        return count
    for row in range(0, 3, 2):
        if not (after if row else before):
            continue
        if kind == FIXED:
            for code in range(9):
                set_place(found, count, start)
                found[count, row, 0] += code % 3 - 1
                found[count, row, 1] += code // 3 - 1
                count += 1
        elif kind == HELD:
            # Along the tangent, on the grid's lines across it, and a step to either side.
            slope = tx / ty if one else ty / tx
            for code in range(15):
                set_place(found, count, start)
                along = start[row, one] + code % 5 - 2
                found[count, row, one] = along
                found[count, row, two] = np.rint(start[1, two] + slope * (along - start[1, one])) + code // 5 - 1
                count += 1
        else:
            # The node and one handle among their neighbours, the other handle on the line through both.
            for code in range(45):
                place = code // 9
                x0, y0 = start[row, 0] + code % 3 - 1, start[row, 1] + code // 3 % 3 - 1
                x1, y1 = start[1, 0], start[1, 1]
                if place > 2:
                    y1 += 1.0 if place % 2 else -1.0
                elif place > 0:
                    x1 += 1.0 if place % 2 else -1.0
                run_one, run_two = (y1 - y0, x1 - x0) if one else (x1 - x0, y1 - y0)
                if run_one == 0.0:
                    continue
                slope = run_two / run_one
                here_one, here_two = (y1, x1) if one else (x1, y1)
                for step in range(-1, 2):
                    at = start[2 - row, one] + step
                    across = np.rint(here_two + slope * (at - here_one))
                    found[count, row, 0], found[count, row, 1] = x0, y0
                    found[count, 1, 0], found[count, 1, 1] = x1, y1
                    found[count, 2 - row, one], found[count, 2 - row, two] = at, across
                    count += 1
    return count


@inlined
def set_place(found: FloatArray, code: int, place: FloatArray) -> None:
    """Copy a node and its handles to those of a number."""
    for k in range(3):
        found[code, k, 0], found[code, k, 1] = place[k, 0], place[k, 1]


@compiled
def improve(
    run: CubicRun, k: int, measure: Measure, em: float, room: FloatArray, best: FloatArray, seen: FloatArray,
    parts: FloatArray,
) -> bool:  # fmt: skip
    """Give a node and its handles the cheapest of the neighbouring places on the grid; whether they changed.

    Args:
        room, best: (270, 3, 2), (3, 2) of work: the places, and the cheapest. seen, parts: of :func:`cost_at`.
    """
    P, start, (after, before) = run.P, best, sides(run, k)
    if after < 0 and before < 0:
        return False
    for axis in range(2):
        start[1, axis] = P[after, 0, axis] if after >= 0 else P[before, 3, axis]
        start[0, axis] = P[before, 2, axis] if before >= 0 else start[1, axis]
        start[2, axis] = P[after, 1, axis] if after >= 0 else start[1, axis]
    if run.kind[k] == AXIS:
        across = 1 if abs(run.T[k, 0]) > 0.5 else 0
        start[0, across] = start[2, across] = start[1, across]
        put_points(run, before, after, start, k)
    for side, s in enumerate((before, after)):
        if s >= 0:
            measure.base[side] = reduced(
                P[s], measure.exact[s], measure.own[s], measure.rest[s], 2 - 2 * side, measure.form[side]
            )
    least, changed, seen[:] = np.inf, False, np.nan
    turns = run.kind[k] == FREE and before >= 0 and after >= 0
    for code in range(-1, candidates(run.kind[k], run.T[k, 0], run.T[k, 1], start, before >= 0, after >= 0, room)):
        place = start if code < 0 else room[code]
        if turns and code >= 0:
            ax, ay, bx, by = (
                place[1, 0] - place[0, 0],
                place[1, 1] - place[0, 1],
                place[2, 0] - place[1, 0],
                place[2, 1] - place[1, 1],
            )
            if turn_cost(ax, ay, bx, by) >= least:
                continue
        put_points(run, before, after, place, k)
        cost = cost_at(run, k, before, after, measure, em, least, seen, parts)
        if cost < least - 1e-9:
            least, changed = cost, code >= 0
            put(place, best)
    put_points(run, before, after, best, k)
    return changed
