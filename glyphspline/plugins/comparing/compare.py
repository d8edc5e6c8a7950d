"""Two outlines of a glyph compared: distance, advance, contours and kinks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import inf
from typing import Any

import numpy as np

from ...curves.pairing import ROUNDING
from ...errors import GlyphsplineError, is_positive, require
from ...outlines.contour_arrays import ContourArrays
from ...outlines.flaws.kinds import KINK, Thresholds
from ...outlines.outline import Outline
from ...outlines.outline_distance import EVEN
from ...types import FloatArray, IntArray
from .difference import PER_EM, SIDES, Apart, Difference, Turn

DIRECTIONS = 16
"""Directions in which contours are measured to pair them."""

KINKS = Thresholds()
"""A kink is what :func:`glyphspline.check` finds without other thresholds."""


def compare(old: Outline, new: Outline, tolerance: float | None = None) -> Difference:
    """What differs between two outlines of one glyph.

    Outlines are compared as they are drawn, not their ink: overlaps that are removed are a difference. Start points,
    directions, the order of contours and the kinds of segments are none. An outline of another em is scaled to the old
    one's.

    Args:
        old, new: the outlines; see :meth:`glyphspline.Font.outline`.
        tolerance: in units of the old em: how far a kink may be and still be the same. Without it, 1/1000 em. Where the
            outlines are farther apart than that, kinks may be, up to 1/100 em.

    Raises:
        OptionError: the tolerance is not positive. GlyphsplineError: coordinates are too large to be compared.

    Example:
        >>> import glyphspline as gs
        >>> old, new = (gs.open_font(f"fonts_test/kouzan-gyosho.{kind}") for kind in ("ttf", "otf"))
        >>> gs.compare(old.outline("uni9F8D"), new.outline("uni9F8D")).contours_gone
        ()
    """
    require(tolerance is None or is_positive(tolerance), "tolerance is a positive number", tolerance)
    scale = old.metrics.units_per_em / new.metrics.units_per_em
    mine, its = old.arrays, new.arrays
    its = its if scale == 1 else its._replace(points=its.points * scale)
    identical = all(u.tobytes() == v.tobytes() or np.array_equal(u, v) for u, v in zip(mine, its, strict=True))
    codes = tuple(sorted({*old.unicodes, *new.unicodes}))
    found = Difference(
        old.name, old.gid, new.name, new.gid, codes, identical, 0.0, 0.0, None, old.advance, new.advance * scale, scale
    )
    return found if identical else replace(found, **_changed(old, new, its, scale, tolerance))


def _changed(old: Outline, new: Outline, its: ContourArrays, scale: float, tolerance: float | None) -> dict[str, Any]:
    """How outlines differ whose contours are not the same; ``its``: the contours of the new one, scaled."""
    from ...outlines.segments import all_cubics  # here, so that the package opens without a compiler

    mine, em = old.arrays, old.metrics.units_per_em
    tolerance = em * PER_EM if tolerance is None else tolerance
    far = np.max([np.abs(contours.points).max(initial=0.0) for contours in (mine, its)])
    if not far < em * PER_EM / ROUNDING:
        raise GlyphsplineError(f"coordinates up to {far:.3g} are too large to be compared", glyph=old.name)
    distances = _distances(mine, its, em, tolerance, old.snapped + scale * new.snapped)
    hulls, other_hulls = (extents(all_cubics(contours), contours.offsets) for contours in (mine, its))
    # Share of the em by which the extents of two contours may differ that are partners.
    gone, came = without_partner(np.abs(hulls[:, None] - other_hulls).max(axis=2), 0.1 * em)
    gone, came = (wider(each, 2 * tolerance, of) for each, of in ((gone, hulls), (came, other_hulls)))
    # Share of the em by which a kink may move with its outline and still be the same.
    reach = max(tolerance, min(distances["bound"], 0.01 * em))
    turns_gone, turns_new = unmatched(turns(old), turns(new, scale), reach)
    return distances | {
        "contours_gone": gone, "contours_new": came, "kinks_gone": turns_gone, "kinks_new": turns_new,
    }  # fmt: skip


def _distances(mine: ContourArrays, its: ContourArrays, em: float, tolerance: float, snapped: float) -> dict[str, Any]:
    """How far outlines are apart, and how their ink differs; ``snapped``: by how much they may be off themselves."""
    from ...outlines.outline_distance import chains_of, outline_distance
    from .changed_ink import LEAST, SHARP, changed_ink, deepest_point
    from .following import unfollowed

    if not (len(mine.degrees) and len(its.degrees)):
        return {"bound": inf, "seen": inf}
    old, new, limit = chains_of(mine), chains_of(its), tolerance * (1 + EVEN)
    row, nearest = outline_distance(old, new, em / 1000, tolerance - snapped)
    bound, seen, x, y, side, contour, near_x, near_y = row.tolist()
    worst = Apart(SIDES[int(side)], int(contour), (x, y), (near_x, near_y)) if side >= 0 else None
    found = {"bound": bound + snapped, "seen": max(seen - snapped, 0.0), "worst": worst}
    if found["seen"] > limit:
        return found
    explained, deepest = max(limit, LEAST * em) + snapped, np.zeros(3)
    boxes = unfollowed(old, new, nearest[: len(old.cubics), :2], explained * (1 + SHARP))
    known = deepest_point(old, new, boxes, explained, deepest)
    ink = changed_ink(mine, its, deepest, explained) if deepest[0] > 0 else None
    return found | {"ink": ink, "ink_known": known or ink is not None}


def extents(cubics: FloatArray, offsets: IntArray) -> FloatArray:
    """(C, DIRECTIONS + 1) how far contours reach in each direction, and the square roots of their areas.

    The distance of the convex hulls of two contours is the largest difference of their extents in any direction. The
    areas tell a ring's outer contour from a disc in several pieces. A contour is taken as the polygon of its points at
    every quarter of a segment.
    """
    from ...curves.cubics import bernstein

    if len(cubics) == 0:
        return np.empty((len(offsets) - 1, DIRECTIONS + 1))
    weights, starts, counts = bernstein(4)[:, :4], 4 * offsets[:-1], 4 * np.diff(offsets)
    x, y = (sum(weights[k] * cubics[:, k, axis, None] for k in range(4)).ravel() for axis in range(2))
    angles = np.pi * np.arange(DIRECTIONS // 2) / (DIRECTIONS // 2)
    along = np.cos(angles) * x[:, None] + np.sin(angles) * y[:, None]
    most, least = np.maximum.reduceat(along, starts), np.minimum.reduceat(along, starts)
    x, y = x - np.repeat(x[starts], counts), y - np.repeat(y[starts], counts)  # so that each begins and ends at 0
    areas = np.add.reduceat(np.roll(x, 1) * y - np.roll(y, 1) * x, starts) / 2
    return np.column_stack([most, -least, np.sqrt(np.abs(areas))])


def without_partner(costs: FloatArray, most: float) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """The rows and the columns of a matrix of distances that have no partner up to ``most``, at the least sum."""
    from scipy.optimize import linear_sum_assignment

    rows, columns = linear_sum_assignment(costs)
    near = costs[rows, columns] <= most
    gone, came = (set(range(n)) - set(p[near].tolist()) for n, p in zip(costs.shape, (rows, columns), strict=True))
    return tuple(sorted(gone)), tuple(sorted(came))


def wider(which: tuple[int, ...], least: float, hulls: FloatArray) -> tuple[int, ...]:
    """Those of the contours that are wider in some direction; ``hulls``: their :func:`extents`."""
    half = DIRECTIONS // 2
    return tuple(c for c in which if (hulls[c, :half] + hulls[c, half : 2 * half]).max() > least)


def turns(outline: Outline, scale: float = 1.0) -> list[Turn]:
    """The kinks of an outline, as :func:`glyphspline.check` finds them; their points are multiplied by the scale."""
    from ...outlines.flaws.joints import CONTOUR, PLACE, VALUE, WHAT, Segments, joint_findings
    from ...outlines.segments import all_cubics

    cubics = all_cubics(outline.arrays)
    limits = KINKS.limits(outline.metrics.units_per_em)
    table = joint_findings(Segments.of(cubics, outline.arrays), limits)
    found = []
    for row in table[table[:, WHAT] == KINK]:
        contour, segment = int(row[CONTOUR]), int(row[PLACE])
        x, y = (cubics[outline.arrays.offsets[contour] + segment, 0] * scale).tolist()
        found.append(Turn(contour, segment, (x, y), float(row[VALUE])))
    return found


def unmatched(old: Sequence[Turn], new: Sequence[Turn], reach: float) -> tuple[tuple[Turn, ...], tuple[Turn, ...]]:
    """The kinks of each list that have no partner in the other within a distance; the nearest pairs come first."""
    pairs = []
    for i, one in enumerate(old):
        for j, other in enumerate(new):
            apart = float(np.hypot(one.point[0] - other.point[0], one.point[1] - other.point[1]))
            if apart <= reach:
                pairs.append((apart, i, j))
    gone, came = dict(enumerate(old)), dict(enumerate(new))
    for _, i, j in sorted(pairs):
        if i in gone and j in came:
            del gone[i], came[j]
    return tuple(gone.values()), tuple(came.values())
