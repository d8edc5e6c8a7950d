"""Runs of cubics: what their nodes may do, and how these and the handles beside them move."""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

from ....compiled import compiled, inlined
from ....curves.cubics import directions, length
from ....fitting.sharp.corners import NO_HANDLE
from ....types import BoolArray, FloatArray, IntArray

FIXED, HELD, AXIS, FREE = range(4)
"""What a node may do: nothing, while its handle is free, at a corner; nothing, while its handle keeps its direction;
slide along its tangent, which stays; move and turn."""

SHORTEST = 0.05
"""Length in chords from which handles are not made shorter."""


class Guide(NamedTuple):
    """What a run of n segments follows in one master.

    Attributes:
        samples: (N, 2) of the outline. first: (n + 1,) where among them the joints of the run are.
        corner: (n + 1,) joints that are corners. upright: (n + 1,) those whose tangent is an axis.
        arriving, leaving: (n + 1, 2) unit tangents of what ends and begins at the joints.
    """

    samples: FloatArray
    first: IntArray
    corner: BoolArray
    upright: BoolArray
    arriving: FloatArray
    leaving: FloatArray


class CubicRun(NamedTuple):
    """Cubics from one cut of a contour to the next.

    Attributes:
        P: (r, 4, 2) the cubics. held: (r,) those that do not move.
        kind: (r + 1,) what the nodes may do. T: (r + 1, 2) unit tangents of nodes that are not corners. Both are set by
            :func:`.harmony.harmonise`.
        places: (r + 1,) joints of the outline, counted from the first, at which the nodes were.
        extrema: (r,) most extrema inside each cubic: as many as the source's segments have there.
        ease: (r + 1,) weights of the nodes' equations of curvature. slack: (r + 1,) jumps of curvature that may stay.
        closed: whether the last node is the first again.
    """

    P: FloatArray
    held: BoolArray
    kind: IntArray
    T: FloatArray
    places: IntArray
    extrema: IntArray
    ease: FloatArray
    slack: FloatArray
    closed: bool


GuideArrays: TypeAlias = tuple[FloatArray, IntArray, BoolArray, BoolArray, FloatArray, FloatArray]
RunArrays: TypeAlias = tuple[
    FloatArray, BoolArray, IntArray, FloatArray, IntArray, IntArray, FloatArray, FloatArray, bool
]  # fmt: skip
"""The arrays of these, for calls of compiled functions: see :data:`.corners.JointArrays`."""


@compiled
def set_kinds(run: CubicRun, corner: BoolArray, upright: BoolArray, arriving: FloatArray, leaving: FloatArray) -> None:
    """What the nodes of a run may do, and their tangents: beside cubics that are held, those of these."""
    r = len(run.P)
    for s in range(r + 1):
        k, way = run.places[s], leaving
        before, behind = s - 1 if s > 0 else r - 1, s if s < r else 0
        run.kind[s] = AXIS if upright[k] else FREE
        if not run.closed and s in (0, r):
            run.kind[s], way = FIXED if corner[k] else HELD, leaving if s == 0 else arriving
        run.T[s, 0], run.T[s, 1] = way[k, 0], way[k, 1]
        if (run.closed or 0 < s < r) and (run.held[before] or run.held[behind]):
            ax, ay, bx, by = directions(run.P, before if run.held[before] else behind, NO_HANDLE)
            x, y = (bx, by) if run.held[before] else (ax, ay)
            size = max(length(x, y), 1e-12)
            run.kind[s], run.T[s, 0], run.T[s, 1] = HELD, x / size, y / size


@compiled
def align(run: CubicRun) -> None:
    """Put the handles of a run on the tangents of their nodes, at the length they have; but not at corners."""
    r = len(run.P)
    for s in range(r):
        if run.held[s]:
            continue
        p = run.P[s]
        for end in range(2):
            k = (s + end) % r if run.closed else s + end
            if run.kind[k] == FIXED:
                continue
            size = length(p[1 + end, 0] - p[3 * end, 0], p[1 + end, 1] - p[3 * end, 1])
            size = max(size, SHORTEST * length(p[3, 0] - p[0, 0], p[3, 1] - p[0, 1]))
            for axis in range(2):
                p[1 + end, axis] = p[3 * end, axis] + (1 - 2 * end) * size * run.T[k, axis]


@compiled
def set_moves(run: CubicRun, i: int, end: int, s: int, J: FloatArray, row: int, at: int) -> None:
    """How node i moves the two points at one end of cubic s, by its unknowns.

    These are: along the tangent, across it, its turn, and the lengths of the handles after and before the node. At a
    corner they are the coordinates of the two handles.

    Args:
        J: (…, 2, u) of zeros. Row ``row`` receives the moves of the node, and the one beside it, inwards, those of its
            handle, both in the five columns from ``at`` on.
    """
    kind, tx, ty = run.kind[i], run.T[i, 0], run.T[i, 1]
    inner = row - 1 if end else row + 1
    if kind == FIXED:
        J[inner, 0, at + 2 * end], J[inner, 1, at + 2 * end + 1] = 1.0, 1.0
        return
    sign, own = 1.0 - 2.0 * end, at + 3 + end
    J[inner, 0, own], J[inner, 1, own] = sign * tx, sign * ty
    if kind == HELD:
        return
    for k in (row, inner):
        J[k, 0, at], J[k, 1, at] = tx, ty
        if kind == FREE:
            J[k, 0, at + 1], J[k, 1, at + 1] = -ty, tx
    if kind == FREE:
        p = run.P[s]
        hx, hy = p[1 + end, 0] - p[3 * end, 0], p[1 + end, 1] - p[3 * end, 1]
        size = sign * length(hx, hy)
        J[inner, 0, at + 2], J[inner, 1, at + 2] = -ty * size, tx * size


@inlined
def sides(run: CubicRun, k: int) -> tuple[int, int]:
    """The cubics after and before a node that move; -1 where there is none."""
    r = len(run.P)
    after, before = k if k < r else -1, k - 1 if k > 0 else (r - 1 if run.closed else -1)
    return -1 if after < 0 or run.held[after] else after, -1 if before < 0 or run.held[before] else before


@inlined
def handles_at(run: CubicRun, k: int) -> tuple[float, float]:
    """The lengths of the handles after and before a node; one at an end of the run counts for both."""
    r, P = len(run.P), run.P
    after, before = k if k < r else -1, k - 1 if k > 0 else (r - 1 if run.closed else -1)
    a = length(P[after, 1, 0] - P[after, 0, 0], P[after, 1, 1] - P[after, 0, 1]) if after >= 0 else 0.0
    b = length(P[before, 3, 0] - P[before, 2, 0], P[before, 3, 1] - P[before, 2, 1]) if before >= 0 else 0.0
    return (b, b) if after < 0 else (a, a) if before < 0 else (a, b)


@compiled
def moved(run: CubicRun, g: FloatArray, number: IntArray, tolerance: float) -> bool:
    """Move all nodes by their unknowns; whether anything moved by more than a tenth of a step of the grid."""
    r, P = len(run.P), run.P
    most = 0.0
    for k, at in enumerate(number):
        if at < 0:
            continue
        (a, b), (after, before) = handles_at(run, k), sides(run, k)
        y = g[at : at + 5]
        kind = run.kind[k]
        if kind == FIXED:
            for end, s in ((0, after), (1, before)):
                if s < 0:
                    continue
                dx, dy, own = y[2 * end], y[2 * end + 1], b if end else a
                size = length(dx, dy)
                share = min(1.0, 0.4 * own / max(size, 1e-12))
                P[s, 1 + end, 0] += share * dx
                P[s, 1 + end, 1] += share * dy
                most = max(most, share * size)
            continue
        along = min(max(y[0], -0.3 * min(a, b)), 0.3 * min(a, b)) if kind >= AXIS else 0.0
        across = min(max(y[1], -tolerance), tolerance) if kind == FREE else 0.0
        turn = min(max(y[2], -0.06), 0.06) if kind == FREE else 0.0
        tx, ty = run.T[k, 0], run.T[k, 1]
        dx, dy = along * tx - across * ty, along * ty + across * tx
        if turn != 0.0:
            tx, ty = tx - turn * ty, ty + turn * tx
            size = length(tx, ty)
            tx, ty = tx / size, ty / size
            run.T[k, 0], run.T[k, 1] = tx, ty
        most = max(most, max(abs(along), abs(across)))
        for end, s in ((0, after), (1, before)):
            if s < 0:
                continue
            own = b if end else a
            new = own + min(max(y[3 + end], -0.4 * own), 0.4 * own)
            p = P[s]
            new = max(new, SHORTEST * length(p[3, 0] - p[0, 0], p[3, 1] - p[0, 1]))
            most = max(most, abs(new - own) + abs(turn) * own)
            for axis in range(2):
                p[3 * end, axis] += dy if axis else dx
                p[1 + end, axis] = p[3 * end, axis] + (1 - 2 * end) * new * (ty if axis else tx)
    if run.closed:
        run.T[r], run.kind[r] = run.T[0], run.kind[0]
    return most > 0.1
