"""Chains of quadratics as TrueType stores them: as few points as follow an outline, most of them implied.

Between two corners or lines, a *run*, all points on the curve become implied: midway between control points. There is
no kink there then, wherever the grid has these. Horizontal and vertical extrema cut a run into *sections*; the legs
there stay horizontal or vertical, at the source's height. Each section gets the fewest control points that follow it;
all points of the run are then moved together. Those that are to lie on the tangents at its ends take places on the grid
in that direction, the others are moved once more, rounded together, and certified as rounded.

A section that fails is tried again with more points. Where the source is one of quadratics on the grid, it is tried
with its ends on the curve too, and in the end stays as the source has it, as does a run that would have more points.

A contour in K masters has the same points in all of them, and samples have the same parameters in all, so that an
instance of the result follows the instance of the source. What turns is looked at in mixes of the masters too, and the
certificate holds in the whole design space. A single outline is a master with the weight 1.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ....curves.cubics import directions, length
from ....fitting.first_good import first_good
from ....fitting.sharp.corners import NO_HANDLE
from ....fitting.sharp.settings import SharpSettings
from ....types import BoolArray, FloatArray, IntArray
from .chains import relax
from .grid import EXPLICIT, aim, round_quads
from .harmony import end_jump
from .outlines import Given, Stored, is_ring, read_contour, set_unit
from .refusals import distances, wrong_quads
from .sections import Sections, next_tries

ATTEMPTS = 10
"""Tries of a run."""

Points = tuple[FloatArray, BoolArray, float]
"""Points (K, n, 2), whether each is on the curve, and their certified distance from the source."""


class Rounded(NamedTuple):
    """Quadratics on the grid that may be the points of a run.

    Attributes:
        c, node, implied: see :class:`.fit.chains.Quads`. far: the certified distance from the source.
        wrong: 1 where they are refused; by how much they miss or turn then; and else how many points they are.
    """

    c: FloatArray
    node: FloatArray
    implied: BoolArray
    far: float
    wrong: tuple[int, float, int]


def fit_run(given: Given, i: int, j: int, tolerance: float) -> Points:
    """Points of the quadratics from joint i to joint j, without the last: at most as many as are stored."""
    best = first_good(_rounded(given, i, j, tolerance), lambda each: each.wrong)
    return (*points_of(best.c, best.node, best.implied), best.far)


def _rounded(given: Given, i: int, j: int, tolerance: float) -> Iterator[Rounded]:
    """What is stored of a run, and then other quadratics, cut into ever more sections, each of which has its tries."""
    n, K, stored, nearest = j - i, len(given.cubics), given.stored, np.inf
    own = n + 1 + int(np.count_nonzero(~stored.implied[i + 1 : j]))
    wrong = (0, 0.0, own) if stored.known else (1, np.inf, 0)
    yield Rounded(stored.control[:, i:j], stored.node[:, i : j + 1], stored.implied[i:j], stored.drift, wrong)
    if stored.known and (n == 1 or stored.stays[i:j].any()):
        return
    sections = Sections(given, tolerance)
    # Sections end nowhere inside: extrema of all masters at one parameter are more than most have; then at extrema; and
    # where nothing is near enough, at all joints.
    for cut in range(1 if K == 1 else 0, 3):
        stops = given.upright[i : j + 1] & (cut == 1) | (cut == 2)
        stops[0] = stops[n] = True
        ends = (i + np.flatnonzero(stops)).tolist()
        if (cut == 1 and K > 1 and len(ends) == 2) or (cut == 2 and (stored.known or nearest <= tolerance)):
            continue
        for each in _of_sections(sections, ends, EXPLICIT if cut == 2 else 0):
            if cut < 2 or each.far <= tolerance:
                nearest = min(nearest, each.far)
                yield each


def _of_sections(sections: Sections, ends: list[int], first: int) -> Iterator[Rounded]:
    """The quadratics of a run cut at joints, from try ``first`` on: each time other tries of those that are wrong."""
    given, tolerance, i, j = sections.given, sections.tolerance, ends[0], ends[-1]
    stored, samples, tries = given.stored, given.joints.samples, np.full(len(ends) - 1, first)
    ring, near = is_ring(given.cuts, i, j), 0.999 * tolerance
    for _ in range(ATTEMPTS):
        q = sections.assembled(ends, tries)
        relax(q, samples, 0.1 * tolerance, np.inf)
        if aim(q, tries, ring):
            relax(q, samples, 0.1 * tolerance, np.inf)
        round_quads(q, samples, tolerance)
        bounds = distances(q, given.joints.places, given.outline, given.corners, i, j, near)
        far, beyond = max(0.0, *bounds.tolist()), ~(bounds <= near)
        bad, kinks = wrong_quads(q, beyond, given.way, given.line, given.joints.corner, given.mixes, i, j, ring)
        if ring:
            q.implied[0] = (np.abs(q.c[:, 0] + q.c[:, -1] - 2 * q.node[:, 0]) < 1e-6).all()
        if not bad.any():
            yield Rounded(q.c, q.node, q.implied, far, (0, 0.0, len(bad) + int(np.count_nonzero(~q.implied[:-1]))))
            return
        if not stored.known:  # or else what is stored is better
            miss = far / tolerance if far <= tolerance else 1e3 * far
            yield Rounded(q.c, q.node, q.implied, far, (1, kinks + miss, 0))
        if not next_tries(q, bad, stored.known, tries):
            return


def points_of(c: FloatArray, node: FloatArray, implied: BoolArray) -> tuple[FloatArray, BoolArray]:
    """What is stored of quadratics: points (K, n, 2), and whether they are on the curve."""
    K, R = c.shape[:2]
    points, there, on = np.empty((K, R, 2, 2)), np.empty((R, 2), np.bool_), np.empty((R, 2), np.bool_)
    points[:, :, 0], there[:, 0], on[:, 0] = node[:, :R], ~implied[:R], True
    points[:, :, 1], there[:, 1], on[:, 1] = c, True, False
    kept = there.reshape(-1)
    return points.reshape(K, 2 * R, 2)[:, kept], on.reshape(-1)[kept]


def evenest_joint(cubics: FloatArray) -> int:
    """The joint of a contour (m, 4, 2) with long handles, and curvatures that are nearly alike: where a point midway
    between two control points has both near the outline. Ties go to the rightmost, then the uppermost."""
    best, most = 0, -1.0
    for j in range(len(cubics)):
        ax, ay, _, _ = directions(cubics, j, NO_HANDLE)
        _, _, bx, by = directions(cubics, j - 1, NO_HANDLE)
        even = 1.0 - min(end_jump(cubics[j - 1], cubics[j], 1e9), 1.0)
        score = float(np.rint(even * min(length(ax, ay), length(bx, by)) * 1e6))
        x_ahead, y_ahead = cubics[j, 0] - cubics[best, 0]
        if score > most or (score == most and (x_ahead > 0 or (x_ahead == 0 and y_ahead > 0))):
            best, most = j, score
    return best


def first_joint(given: Given) -> int | None:
    """The joint at which what is stored of a contour begins: one at which runs end, or an extremum; None if there is
    none on the grid, and a source to be kept there."""
    if given.cuts.any():
        return int(given.cuts.argmax())
    whole = (given.stored.node == given.node[:, :-1]).all(axis=(0, 2)) | (not given.stored.known)
    if (whole := given.upright[:-1] & whole).any():
        return int(whole.argmax())
    return None if given.stored.known else evenest_joint(given.cubics[0])


def far_off(a: FloatArray, b: FloatArray) -> float:
    """The largest distance of points (…, 2) from others."""
    gap = a - b
    return float(np.sqrt((gap * gap).sum(axis=-1)).max())


def fit_contour(
    cubics: FloatArray, degrees: IntArray, settings: SharpSettings, tolerance: float, stored: Stored,
    corners: FloatArray, mixes: FloatArray,
) -> Points:  # fmt: skip
    """The points of a contour (K, m, 4, 2), whether they are on the curve, and how far it moved, certified.

    Args:
        stored: what is of it; nodes are given of any. None if it has neither a corner nor an extremum on the grid at
            which it could begin.
        corners, mixes: see :class:`Given`.
    """
    K, m = cubics.shape[:2]
    given = read_contour(cubics, degrees, settings, tolerance, stored, corners, mixes)
    k = first_joint(given)
    if k is None:
        return np.empty((K, 0, 2)), np.empty(0, dtype=np.bool_), 0.0
    if k > 0:
        order = (np.arange(m) + k) % m
        cubics, degrees = cubics.take(order, axis=1), degrees[order]
        node, control = stored.node.take(order, axis=1), stored.control.take(order, axis=1)
        stored = Stored(stored.known, node, control, stored.implied[order], stored.drift, stored.stays[order])
        given = read_contour(cubics, degrees, settings, tolerance, stored, corners, mixes)
    found, joints, (arriving, leaving) = list[Points](), given.joints, given.way
    for i, j in pairwise([0, *(1 + np.flatnonzero(given.cuts[1:m])).tolist(), m]):
        if given.line[i]:
            found.append(
                (given.node[:, i:j], np.ones(1, np.bool_), far_off(cubics[:, i, ::3], given.node[:, i : j + 1]))
            )
            continue
        found.append(fit_run(given, i, j, tolerance))
        # What follows meets what is written.
        points = found[-1][0]
        if i == 0 and j < m and not given.line[m - 1]:
            leaving[:, m] = points[:, 1] - points[:, 0]
            for w in range(K):
                set_unit(leaving[w, m], joints.leaving[w, m])
        if j < m and not given.line[j]:
            arriving[:, j] = given.node[:, j] - points[:, -1]
            for w in range(K):
                set_unit(arriving[w, j], joints.arriving[w, j])
    # What is on the grid but for rounding errors is on it: a writer may cut decimals off.
    points, on = np.concatenate([own[0] for own in found], axis=1), np.concatenate([own[1] for own in found])
    whole = np.rint(points)
    return np.where(np.abs(points - whole) < 1e-6, whole, points), on, max(far for *_, far in found)
