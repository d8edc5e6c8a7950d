"""Kinks mended by single handles, each turned onto the line of the other one at its joint.

A handle that someone moved comes back so. Which of the two it was shows in what the curves are then: where the wrong
one is turned, curvature jumps at the joint, and tangents or curvatures no longer meet at the other ends.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product

import numpy as np

from ...curves.bezier import cross
from ...outlines.flaws.turns import joint_controls, jumps_of, turns_of
from ...types import BoolArray, FloatArray
from .balance import curvatures_at
from .joints import EXACT, SMOOTH, ContourLayout
from .shapes import moved, with_nodes
from .state import Design

MOST = 3
"""Joints at most that are mended together so."""

HALF = 0.5
"""Weight of a jump of curvature at the other end of a curve, against one at the joint."""

TURN = 10.0
"""Weight of a turn, in radians, against a relative jump of curvature."""

POINT = 0.1
"""What a point more that moves costs, in relative jumps of curvature."""

ALONG = 0.3
"""Price of a step along a handle against one across it, on the grid."""

REACH = 2
"""Steps of the grid around the best place that are tried."""

SLIDE = 2.0
"""What a change of a handle's length costs, as a share of it, in relative jumps of curvature."""

Option = tuple[int, FloatArray, float]
"""A point, its new places (K, 2), and what a change of its handle's length costs."""


def single_handles(layout: ContourLayout, joints: Sequence[int], kind: str, design: Design) -> list[FloatArray]:
    """Points (K, N, 2) after which each of these joints may be smooth; that which fits the curves best comes first."""
    if len(joints) > MOST:
        return []
    m = len(layout.degrees)
    ways = _turned if kind == "kink" else _slid
    options = [[None, *ways(layout, joint, design.step)] for joint in joints]
    near = np.array(sorted({(joint + k) % m for joint in joints for k in (-1, 0, 1)}))
    curved = (layout.degrees[near] > 1) & (layout.degrees[near - 1] > 1)
    weights, em = np.where(np.isin(near, joints), 1.0, HALF) * curved, np.full(len(near), design.em)
    found = []
    for chosen in product(*options):
        moves = {option[0]: option[1] for option in chosen if option is not None}
        if not moves or len(moves) < sum(option is not None for option in chosen):
            continue
        numbers, places = with_nodes(
            layout.contour, np.array([*moves]), np.stack([*moves.values()], axis=1), design.step
        )
        new = moved(layout.contour, numbers, places)
        controls = joint_controls(new)[:, near]
        cost = TURN * np.radians(np.nan_to_num(np.abs(turns_of(controls)), nan=SMOOTH)) + weights * jumps_of(
            controls, em
        )
        cost = np.minimum(cost, TURN * np.radians(SMOOTH)).sum(axis=1).mean()
        other = sum(POINT + option[2] for option in chosen if option is not None)
        found.append((float(cost) + other, new.points))
    return [points for _, points in sorted(found, key=lambda each: each[0])]


def _turned(layout: ContourLayout, joint: int, step: float) -> Iterator[Option]:
    """Ways to turn one handle at a joint: about its node, or to where it meets the line of the other end, too."""
    m, node = len(layout.degrees), layout.points[:, layout.starts[joint]]
    for side in (0, 1):
        if layout.degrees[joint - 1 + side] == 1:
            continue
        number, old = layout.handles[joint, side], layout.points[:, layout.handles[joint, side]]
        way = node - layout.points[:, layout.handles[joint, 1 - side]]
        size, length = np.hypot(*way.T), np.hypot(*(old - node).T)
        if size.min() <= EXACT:
            continue
        way = way / size[:, None]
        lengths = [length]
        other = (joint - 1 + 2 * side) % m
        if layout.degrees[joint - 1 + side] == 2 and np.abs(layout.turns[:, other]).max() < SMOOTH:
            end = layout.points[:, layout.starts[other]]
            along = end - layout.points[:, layout.handles[other, side]]
            with np.errstate(divide="ignore", invalid="ignore"):
                meets = cross(end - node, along) / cross(way, along)
            if (np.abs(meets - length) < length).all():
                lengths.insert(0, meets)
        for each in lengths:
            places = _on_grid(old, node, way, each, layout.frozen[:, number], step)
            if (places != old).any():
                yield int(number), places, SLIDE * float(np.abs(each / length - 1).max())


def _slid(layout: ContourLayout, joint: int, step: float) -> Iterator[Option]:
    """Ways to slide the end of one handle along it, until curvatures meet at a joint."""
    node, around = layout.points[:, layout.starts[joint]], layout.points[:, layout.around(joint)]
    ends = curvatures_at(around)  # (2, K)
    for side in (0, 1):
        number, old = layout.handles[joint, side], layout.points[:, layout.handles[joint, side]]
        length = np.hypot(*(old - node).T)
        with np.errstate(divide="ignore", invalid="ignore"):
            shares = np.sqrt(ends[side] / ends[1 - side])
        if layout.degrees[joint - 1 + side] == 3 and np.isfinite(shares).all() and (shares > 0).all():
            way = (old - node) / length[:, None]
            yield int(number), _on_grid(old, node, way, shares * length, layout.frozen[:, number], step, False), 0.0


def _on_grid(
    old: FloatArray, node: FloatArray, way: FloatArray, length: FloatArray, frozen: BoolArray, step: float,
    keep: bool = True,
) -> FloatArray:  # fmt: skip
    """(K, 2) places on the grid near so far along the way from nodes, old ones if as good; ``frozen``: (K, 2) stay."""
    best = node + length[:, None] * way
    around = np.stack(np.meshgrid(*[np.arange(-REACH, REACH + 1.0)] * 2), axis=-1).reshape(-1, 1, 2)
    tried = np.where(frozen, old, step * (np.round(best / step) + around))  # (T, K, 2)
    off = tried - best
    prices = cross(off, way) ** 2 + ALONG**2 * (off * way).sum(axis=-1) ** 2
    places = np.take_along_axis(tried, prices.argmin(axis=0)[None, :, None], axis=0)[0]
    if not keep:
        return places
    kept = np.abs(cross(old - node, way)) <= np.abs(cross(places - node, way)) + EXACT
    return np.where(kept[:, None], old, places)
