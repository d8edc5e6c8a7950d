"""The nodes of a contour as font editors store them, and new ones in the place of old ones.

A contour begins at the point where it did. Points that something refers to (a name, an identifier, an anchor at the
same place) stay; a contour that a fit leaves without such a point stays as it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import islice
from typing import NamedTuple

import numpy as np

from ....curves.cubics import turns
from ....outlines.outline import Contour
from ....writers.settings import NO_HANDLE, SMOOTH

KINDS = (None, "line", "qcurve", "curve")
"""Kinds of points on the curve by the degree of the segment that ends there; None is a control point."""

Position = tuple[float, float]


class Node(NamedTuple):
    """A point of a contour.

    Attributes:
        at: its place. kind: one of ``KINDS``, or "move" where an open contour begins. smooth: its flag.
        extra: what else the file says of it, as text; "" for most.
    """

    at: Position
    kind: str | None
    smooth: bool = False
    extra: str = ""


def replaced(
    old: Sequence[Sequence[Node]],
    new: Sequence[Contour],
    held: Sequence[frozenset[Position]],
    digits: int,
    keeps_flags: bool = False,
) -> list[list[Node]] | str | None:
    """The nodes of a contour in each master; a reason why it stays as it is; or None where nothing changes.

    Args:
        old: its nodes, by master. new: its new curves, rounded here to ``digits`` decimals.
        held: places at which a point has to stay, by master. keeps_flags: points that stay are smooth
            if they were. Without it those that are smooth now are so, too.
    """
    if (why := "is open" if new[0].is_open else _unlike(old)) is not None:
        return why
    rounded = [contour.rounded(digits) for contour in new]
    starts = rounded[0].points[rounded[0].offsets]
    flags = {node.at: node.smooth for node in old[0] if node.kind}
    shift = int(np.hypot(*(starts - next(iter(flags))).T).argmin()) if flags else 0
    smooth = [
        flags.get((x, y), flag) or (flag and not keeps_flags)
        for (x, y), flag in zip(starts.tolist(), smooth_ends(rounded), strict=True)
    ]
    made = [nodes_of(contour, smooth, shift) for contour in rounded]
    before = [_from_the_curve(nodes) for nodes in old]
    as_given = [nodes_of(contour, smooth, shift) for contour in new]  # what stays may have more decimals
    drawn, *others = ([[node[:2] for node in nodes] for nodes in each] for each in (before, made, as_given))
    if drawn in others:
        return None
    found = []
    for nodes, its, places in zip(made, before, held, strict=True):
        there = {node.at: node for node in its if node.kind}
        extras = {node.at: node.extra for node in its if node.kind and node.extra}
        found.append([n._replace(extra=extras.get(n.at, "")) if n.kind else n for n in nodes])
        on_curve = {node.at for node in nodes if node.kind}
        for node in its:
            if node.extra and (not node.kind or node.at not in on_curve):
                return f"would lose the point at {node.at[0]:g} {node.at[1]:g}, which something refers to"
        for at in places & there.keys():
            if at not in on_curve:
                return f"would lose the point at {at[0]:g} {at[1]:g}, where an anchor is"
    return found


def moved(
    nodes: Sequence[Sequence[Node]], old: Sequence[Contour], new: Sequence[Contour],
    held: Sequence[frozenset[Position]], digits: int,
) -> list[list[Node]] | str | None:  # fmt: skip
    """The nodes of a contour in each master where points of it moved; why it stays as it is; None where none moved.

    Args:
        nodes: as they are, by master. old: the same contour as it was read. new: the same points, elsewhere.
        held, digits: see :func:`replaced`.
    """
    if all(np.array_equal(a.points, b.points) for a, b in zip(old, new, strict=True)):
        return None
    if (why := _unlike(nodes)) is not None:
        return why
    places = [np.array([node.at for node in own]) for own in nodes]
    if any(at.shape != contour.points.shape for at, contour in zip(places, old, strict=True)):
        return "has points that are not read"
    shifts = (
        k for k in range(len(nodes[0]))
        if all(np.allclose(np.roll(c.points, k, axis=0), at, atol=1e-6) for c, at in zip(old, places, strict=True))
    )  # fmt: skip
    shift = next(shifts, None)
    if shift is None:
        return "is read otherwise than it is drawn"
    found = []
    for own, before, behind, anchors in zip(nodes, old, new, held, strict=True):
        moves = np.roll((before.points != behind.points).any(axis=1), shift)
        to = np.round(np.roll(behind.points, shift, axis=0), digits).tolist()
        for node, goes in zip(own, moves, strict=True):
            if goes and node.kind and node.at in anchors:
                return f"would lose the point at {node.at[0]:g} {node.at[1]:g}, where an anchor is"
        there = [tuple(at) if goes else node.at for node, at, goes in zip(own, to, moves, strict=True)]
        found.append([n._replace(at=(as_number(x), as_number(y))) for n, (x, y) in zip(own, there, strict=True)])
    return found


def _unlike(masters: Sequence[Sequence[Node]]) -> str | None:
    """Why a contour is none that curves are made of."""
    kinds = {node.kind for nodes in masters for node in nodes}
    return "is open" if "move" in kinds else "is drawn in quadratics" if "qcurve" in kinds else None


def as_number(value: float) -> float | int:
    """A number as a property list has it: an int if it is whole."""
    return int(value) if float(value).is_integer() else float(value)


def smooth_ends(masters: Sequence[Contour]) -> list[bool]:
    """Whether the tangent is continuous at the beginning of each segment, in all masters; False between two lines.

    The flag of a point is one for all masters, as it is in editors.
    """
    degrees = masters[0].degrees
    smooth = np.maximum(degrees, np.roll(degrees, 1)) > 1
    for contour in masters:
        smooth &= np.abs(turns(contour.cubics(), NO_HANDLE)) < SMOOTH
    return smooth.tolist()


def nodes_of(contour: Contour, smooth: Sequence[bool], shift: int = 0) -> list[Node]:
    """The nodes of a contour that begins with its segment number ``shift``."""
    points, nodes = iter([(as_number(x), as_number(y)) for x, y in contour.points.tolist()]), list[list[Node]]()
    arriving = np.roll(contour.degrees, 1).tolist()
    for before, degree, flag in zip(arriving, contour.degrees.tolist(), smooth, strict=True):
        own = [Node(next(points), KINDS[before], flag)]
        nodes.append(own + [Node(point, None) for point in islice(points, degree - 1)])
    return [node for part in (*nodes[shift:], *nodes[:shift]) for node in part]


def _from_the_curve(nodes: Sequence[Node]) -> list[Node]:
    """The nodes of a closed contour from the first one on the curve."""
    first = next((k for k, node in enumerate(nodes) if node.kind), 0)
    return [*nodes[first:], *nodes[:first]]
