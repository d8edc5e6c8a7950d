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

from ....compiled import compiled, inlined
from ....curves.cubics import hidden_extrema, length, square
from ....fitting.sharp.corners import Joints
from ....fitting.sharp.nearness import feet, reduced, sample_form, squares_of_two
from ....intrinsics import borrowed, keep_alive
from ....types import FloatArray
from .harmony import AXIS, FIXED, FLAT, FREE, HELD, Run, end_curvature, end_jump, sides

SWEEPS = 4
"""How often all nodes are visited; few move in the fourth."""

TURN, JUMP = 0.0080, 0.15
"""Turn of a joint, in radians, and jump of curvature that are to be avoided."""

TURN_PRICE, JUMP_PRICE = 100.0, 2.0
"""What a joint beyond these costs, in mean squares of distance at the tolerance."""

HIDDEN_PRICE = 10.0
"""The same of an extremum inside a cubic that the source has not: rounding alone makes some beside an extreme node."""

MET, NO_KINK, FAREST = 0.095, np.radians(0.45), 0.5
"""Jump of curvature and turn of a joint at which curvatures are made to meet; and the mean squared distance, in
tolerances, of a cubic beyond which they are not."""

STEPS = (0.0, -1.0, 1.0, -2.0, 2.0)
NEARBY = tuple(sorted(((x, y) for x in STEPS for y in STEPS), key=lambda step: step[0] ** 2 + step[1] ** 2))
"""Moves of a node along an axis, and in both, the smallest first."""


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
def round_run(run: Run, joints: Joints, i: int, tolerance: float, em: float) -> None:
    """Round the cubics of a run, whose first node is joint i of the outline.

    Its ends, and nodes beside cubics that are held, stay where they are, on the grid or not: what they join is as the
    source has it.
    """
    r, P = len(run.P), run.P
    owned, c = Measure(P.copy(), np.empty((r, 8, 9)), np.zeros(r), np.empty((2, 4, 5)), np.empty(2)), np.empty((3, 2))
    measure = borrowed(owned)
    for s in range(r):
        if run.held[s]:
            continue
        a, b = joints.first[i + run.places[s]], joints.first[i + run.places[s + 1]]
        Q, x = joints.samples[0, a : b + 1], np.arange(b - a + 1.0) / (b - a)
        feet(P[s], Q, c, x, np.empty(b - a + 1))
        measure.rest[s] = sample_form(P[s], c, Q, x, np.ones(b - a + 1), tolerance, measure.own[s])
        P[s] = np.rint(P[s])
        if run.held[s - 1] or (s == 0 and not run.closed):
            P[s, 0] = measure.exact[s, 0]
        if run.held[(s + 1) % r] or (s == r - 1 and not run.closed):
            P[s, 3] = measure.exact[s, 3]
    nodes = r if run.closed else r + 1
    work = np.empty((270, 3, 2)), np.empty((3, 2)), np.empty((2, 4)), np.empty((2, 3))
    room, best, seen, parts = borrowed(work)
    waiting, later = np.ones(nodes, dtype=np.bool_), np.zeros(nodes, dtype=np.bool_)
    for _ in range(SWEEPS):
        later[:] = False
        for k in range(nodes):
            after, before = sides(run, k)
            if (after < 0 and before < 0) or not waiting[k]:
                continue
            waiting[k] = False
            if improve(run, k, before, after, measure, em, room, best, seen, parts):
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
def end_cost(run: Run, k: int) -> float:
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
    run: Run, k: int, before: int, after: int, measure: Measure, em: float, least: float, seen: FloatArray,
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
def candidates(
    kind: int, tx: float, ty: float, start: FloatArray, before: bool, after: bool, found: FloatArray
) -> int:  # fmt: skip
    """Neighbouring places (…, 3, 2) of a node and its handles, of which there are those before and after it.

    Args:
        kind, tx, ty: of the node, see :class:`.harmony.Run`. start: (3, 2) where they are.

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
    run: Run, k: int, before: int, after: int, measure: Measure, em: float, room: FloatArray, best: FloatArray,
    seen: FloatArray, parts: FloatArray,
) -> bool:  # fmt: skip
    """Give a node and its handles the cheapest of the neighbouring places on the grid; whether they changed.

    Args:
        room, best: (270, 3, 2), (3, 2) of work: the places, and the cheapest. seen, parts: of :func:`cost_at`.
    """
    P, start = run.P, best
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
            a, b, c = place
            if turn_cost(b[0] - a[0], b[1] - a[1], c[0] - b[0], c[1] - b[1]) >= least:
                continue
        put_points(run, before, after, place, k)
        cost = cost_at(run, k, before, after, measure, em, least, seen, parts)
        if cost < least - 1e-9:
            least, changed, best[:] = cost, code >= 0, place
    put_points(run, before, after, best, k)
    return changed


@compiled
def side_places(
    run: Run, s: int, end: int, level: int, dx: float, dy: float, form: FloatArray, exact: FloatArray, rest: float,
    far: tuple[float, float, float, bool], em: float, dearest: float, found: FloatArray,
) -> int:  # fmt: skip
    """Places of the two inner points of cubic s when the node at one end of it moves by (dx, dy).

    Args:
        level: the axis on which the handle there stays level; -1 if it may turn. form, exact, rest: see
            :func:`.nearness.squares`. far: the vector in which the next cubic begins at the other end, its curvature
            there, and whether that end's handle stays. dearest: the cost from which places are left out.
        found: (2025, 8) receives the cost, the curvature, the handle's vector, and both points.

    Returns:
        Their number.
    """
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
def beyond_end(run: Run, s: int, end: int) -> tuple[float, float, float, bool]:
    """What cubic s of a run meets at an end, see :func:`side_places`."""
    r = len(run.P)
    q = s + 1 if end else s - 1
    if not run.closed and (q < 0 or q == r):
        return 0.0, 0.0, np.inf, True
    p, own = run.P[q % r], 1 - end
    x, y = p[1 + own, 0] - p[3 * own, 0], p[1 + own, 1] - p[3 * own, 1]
    return x, y, (1 - 2 * own) * end_curvature(p, own), False


@compiled
def meet(run: Run, k: int, joints: Joints, i: int, tolerance: float, em: float, room: FloatArray) -> bool:
    """Let curvatures meet at a node, by the nearest places of it, its handles, and the handles beyond these.

    Args:
        room: (2, 2025, 8) of work.

    Returns:
        Whether there are such places.
    """
    r, P = len(run.P), run.P
    a, q = (k - 1) % r, k % r
    n, c, forms, rest = P[q, 0].copy(), np.empty((3, 2)), np.empty((2, 8, 9)), np.empty(2)
    exact = P[np.array([a, q])].copy()
    for side in range(2):
        s = q if side else a
        u, v = joints.first[i + run.places[s]], joints.first[i + run.places[s + 1]]
        Q, x = joints.samples[0, u : v + 1], np.arange(v - u + 1.0) / (v - u)
        feet(P[s], Q, c, x, np.empty(v - u + 1))
        rest[side] = sample_form(P[s], c, Q, x, np.ones(v - u + 1), tolerance, forms[side])
    level = -1
    for axis in range(2):
        if P[a, 2, axis] == n[axis] and P[q, 1, axis] == n[axis]:
            level = axis
    one, two, least = beyond_end(run, a, 0), beyond_end(run, q, 1), np.inf
    best = np.empty((5, 2))
    for code in range(5 if level >= 0 else 25):
        dx, dy = NEARBY[code] if level < 0 else (0.0, STEPS[code]) if level == 0 else (STEPS[code], 0.0)
        before = side_places(
            run, a, 1, level, dx, dy, forms[0], exact[0], rest[0], one, em, min(FAREST, least), room[0]
        )
        left = np.inf
        for u in range(before):
            left = min(left, room[0, u, 0])
        if before == 0 or left >= least:
            continue
        after = side_places(
            run, q, 0, level, dx, dy, forms[1], exact[1], rest[1], two, em, min(FAREST, least - left), room[1]
        )
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
                least = cost
                best[0], best[1] = room[0, u, 6:], room[0, u, 4:6]
                best[2, 0], best[2, 1] = n[0] + dx, n[1] + dy
                best[3], best[4] = room[1, v, 4:6], room[1, v, 6:]
    if least < np.inf:
        P[a, 1:], P[q, :3] = best[:3], best[2:]
    return least < np.inf
