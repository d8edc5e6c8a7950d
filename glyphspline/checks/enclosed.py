"""What the contours of a glyph enclose: overlaps, self-crossings, doubled strands, and wrong directions.

Contours *cross* where one changes to the other side of the other; to touch is no crossing. Strands are *doubled* where
they lie on each other. Of a contour that runs to a tip and straight back, a spur, they may be apart by what rounding to
whole units makes of them, and one of the two segments at the tip lies on the other side as a whole: a sharp tip is no
spur. Other strands are doubled if they are the same but for rounding errors: a bridge to a counter, edges of two
contours that abut, a copy of a contour. In a glyph of parts that overlap, edges may abut or be shared.

A contour runs in the *wrong direction* if it bounds no ink: both its sides are filled, by the nonzero rule, wherever
one looks. That is a counter that runs like the contour around it. An outer contour, which has no ink around it, is
wrong if it runs unlike most outer contours of its glyph. Fonts draw outer contours clockwise or counter-clockwise, and
both are right.
"""

from __future__ import annotations

import numpy as np

from ..compiled import compiled
from ..curves.bezier import evaluate
from ..curves.contacts import all_crossings
from ..curves.crossings import meetings
from ..curves.cubics import jet, length, split
from ..curves.integrals import area, integrals
from ..types import BoolArray, FloatArray, IntArray
from .kinds import CROSSING, DIRECTION, DOUBLED, OVERLAP, SPIKE, Limits
from .segments import ROUNDING, Segments, rows

SHARP = np.radians(30.0)
"""Angle between the sides of a spike's tip, at most."""

STEPS, MOST_HALVINGS = 16, 128
"""Chords a segment on the two sides of a spur. Most halvings of a segment for a ray: those around the ray's beginning
are points by then."""


def enclosed_findings(
    cubics: FloatArray, segments: Segments, glyphs: IntArray, limits: Limits, unit: float, outer: int
) -> FloatArray:
    """(n, 7) overlaps, self-crossings, doubled strands and wrong directions; see :mod:`.segments`.

    Two contours that cross are reported once, of the first, where it first crosses; the value is the number of places.
    The value of a wrong direction is the area enclosed. Of glyphs with thousands of strands on each other, for which
    :func:`..curves.crossings.meetings` gives up, only spurs and directions are reported.

    Args:
        cubics: (m, 4, 2) the segments. glyphs: (G + 1,) where the contours of each glyph begin.
        limits: length of a doubled strand, and between the sides of a spike. unit: a thousandth of an em.
        outer: direction of outer contours; 0 for that of most of the glyph's.
    """
    if not len(cubics):
        return np.empty((0, 7))
    offsets = segments.offsets
    met, _ = meetings(cubics, offsets, glyphs)
    crossed, touching = all_crossings(cubics, offsets, met), met[~np.isnan(met[:, 4])]
    crosses, lies = np.zeros((2, len(offsets) - 1), dtype=np.bool_)
    crosses[crossed[crossed[:, 0] != crossed[:, 1], :2].astype(np.int64)] = True
    doubled = _doubled(cubics, offsets, touching, crosses, limits.doubled)
    pairs = doubled[:, [1, 5]].astype(np.int64)
    lies[pairs[pairs[:, 1] >= 0]] = True
    spurs = _spurs(cubics, segments, limits, min(ROUNDING, unit))
    known = (doubled[:, 5] < 0) & np.isin(doubled[:, 1], spurs[spurs[:, 0] == DOUBLED, 1])
    directions = _wrong_directions(cubics, offsets, glyphs, crosses, lies, unit, outer)
    return np.concatenate([_crossed(crossed), doubled[~known], spurs, directions])


def _crossed(crossed: FloatArray) -> FloatArray:
    """Overlaps and self-crossings, a row for each pair of contours: from (k, 4) crossings."""
    crossed = crossed[np.lexsort(crossed.T[::-1])]
    pairs, first, counts = np.unique(crossed[:, :2], axis=0, return_index=True, return_counts=True)
    itself = pairs[:, 0] == pairs[:, 1]
    what, other = np.where(itself, CROSSING, OVERLAP), np.where(itself, -1, pairs[:, 1])
    return rows(what, pairs[:, 0], crossed[first, 2], counts, other=other)


def _doubled(
    cubics: FloatArray, offsets: IntArray, touching: FloatArray, crosses: BoolArray, least: float
) -> FloatArray:
    """Contours that lie on themselves or on others, from (k, 6) contacts.

    Of two contours that run in one direction where they lie on each other, one is reported only if nearly all of it
    does: parts that overlap may share an edge. They may also abut where a third one covers both.

    Args:
        crosses: (C,) whether a contour crosses another one.
    """
    stretches = touching[touching[:, 4] > touching[:, 2]]
    found = []
    for c, d in np.unique(stretches[:, :2].astype(np.int64), axis=0).tolist():
        own = stretches[(stretches[:, :2] == (c, d)).all(axis=1), 2:]
        own = own[np.argsort(own[:, 0], kind="stable")]
        one, other = (cubics[offsets[k] : offsets[k + 1]] for k in (c, d))
        if c == d:
            total = _length_of(one, own[:, ::2])
        else:
            along = own[:, 3] > own[:, 1]
            parts = along.all() or crosses[c] or crosses[d]
            total = 0.0 if parts else _length_of(one, own[~along, ::2])
            spans = np.abs(own[along, 2:] - own[along, :2]).sum(axis=0) > (len(one) / 2, len(other) / 2)
            if total < least and spans.any():
                total = _length_of(one, own[along, ::2])
                # Share of a contour that lies on another one in the same direction, from which it is a copy.
                total *= total >= 0.9 * min(integrals(one)[0], integrals(other)[0])
        if total >= least:
            found.append((c, own[0, 0], total, np.nan, -1 if c == d else d))
    return rows(DOUBLED, *np.array(found, dtype=np.float64).reshape(-1, 5).T)


def _length_of(chain: FloatArray, stretches: FloatArray) -> float:
    """Length of the union of stretches (k, 2) of a chain (m, 4, 2) of cubics, each inside one, by where they begin."""
    begin, end = stretches.T
    begin = np.maximum(begin, np.maximum.accumulate(np.concatenate([[0.0], end]))[:-1])  # where those before end
    begin, end = np.stack([begin, end])[:, begin < end]
    segments = np.minimum(begin.astype(np.int64), len(chain) - 1)
    places = begin[:, None] + (end - begin)[:, None] * np.linspace(0, 1, STEPS + 1) - segments[:, None]
    points = evaluate(np.repeat(chain[segments], STEPS + 1, axis=0), places.ravel()).reshape(-1, STEPS + 1, 2)
    return float(np.hypot(*np.diff(points, axis=1).reshape(-1, 2).T).sum())


def _spurs(cubics: FloatArray, segments: Segments, limits: Limits, apart: float) -> FloatArray:
    """Contours that run to a tip and straight back, from joints whose direction reverses but for rounding; and spikes.

    A spike's sides are farther apart. It is twice as long as they may be, or more, and sharper than ``SHARP``.
    """
    offsets, before = segments.offsets, np.arange(len(cubics)) - 1
    before[offsets[:-1]] = offsets[1:] - 1
    products = segments.last[before].conj() * segments.first
    reverse = np.flatnonzero(products.real < 0)
    arriving, leaving = np.abs(segments.last[before[reverse]]), np.abs(segments.first[reverse])
    opens = np.pi - np.abs(np.angle(products[reverse]))
    exact = opens <= ROUNDING * (1 / arriving + 1 / leaving)
    lines = (segments.degrees[before[reverse]] == 1) & (segments.degrees[reverse] == 1)
    wide = lines & (np.minimum(arriving, leaving) * np.sin(opens) > 2 * limits.spike)  # at the end of the shorter one
    chosen = exact | ((opens <= SHARP) & ~wide)
    tips = reverse[chosen]
    owners = np.searchsorted(offsets, tips, side="right") - 1
    found = []
    for tip, c, exactly in zip(tips.tolist(), owners.tolist(), exact[chosen].tolist(), strict=True):
        contour, joint = cubics[offsets[c] : offsets[c + 1]], tip - int(offsets[c])
        run, what = spur_length(contour, joint, apart) if exactly else 0.0, DOUBLED
        if run < limits.doubled:
            run, what = spur_length(contour, joint, limits.spike), SPIKE
        if run >= (limits.doubled if what == DOUBLED else 2 * limits.spike):
            found.append((what, c, joint, run))
    return rows(*np.array(found, dtype=np.float64).reshape(-1, 4).T)


def _wrong_directions(
    cubics: FloatArray, offsets: IntArray, glyphs: IntArray, crosses: BoolArray, lies: BoolArray, unit: float, way: int
) -> FloatArray:
    """Contours that bound no ink, and outer ones that run against ``way``, or, if it is 0, against most of the glyph's.

    Args:
        crosses, lies: (C,) whether a contour crosses another one, and whether it lies on one: its sides are unknown.
    """
    areas, bounds, outer, around = surroundings(cubics, offsets, glyphs, crosses, unit * unit)
    owners = np.repeat(np.arange(len(glyphs) - 1), np.diff(glyphs))
    most, total = (np.bincount(owners, values * outer, len(glyphs) - 1) for values in (np.sign(areas), areas))
    wanted = np.full(len(most), way) if way else np.where(most != 0, most, total)
    hidden = (areas != 0) & ~bounds & ~lies
    which = np.flatnonzero(hidden | (outer & (areas * wanted[owners] < 0)))
    return rows(DIRECTION, which, 0.0, np.abs(areas[which]), other=np.where(hidden[which], around[which], -1))


@compiled
def surroundings(
    cubics: FloatArray, offsets: IntArray, glyphs: IntArray, crosses: BoolArray, least: float
) -> tuple[FloatArray, BoolArray, BoolArray, IntArray]:
    """(C,) signed area of contours, 0 up to ``least``; whether they bound ink, and are outer; the next one around.

    The last is -1 if there is none. ``crosses``: (C,) whether a contour crosses another one.
    """
    count = len(offsets) - 1
    areas = np.empty(count)
    bounds, outer = np.zeros(count, dtype=np.bool_), np.zeros(count, dtype=np.bool_)
    around = np.full(count, -1)
    pieces = np.empty((MOST_HALVINGS + 1, 4, 2))
    boxes = np.full((count, 4), np.nan)
    for c in range(count):
        areas[c] = area(cubics[offsets[c] : offsets[c + 1]])
        if abs(areas[c]) <= least:
            areas[c] = 0.0
        for k in range(4 if offsets[c] < offsets[c + 1] else 0):
            own = cubics[offsets[c] : offsets[c + 1], :, k % 2]
            boxes[c, k] = own.min() if k < 2 else own.max()
    for g in range(len(glyphs) - 1):
        for c in range(glyphs[g], glyphs[g + 1]):
            if areas[c] == 0:
                continue
            sign = 1 if areas[c] > 0 else -1
            for s in range(offsets[c], offsets[c + 1]):
                # Parameter of the point of a segment whose two sides are examined: contours may share ends and middles.
                x, y, _, _, _, _ = jet(cubics, s, 0.41)
                outside, innermost = 0, -1
                for d in range(glyphs[g], glyphs[g + 1]):
                    box = boxes[d]
                    if d == c or x < box[0] or y < box[1] or x > box[2] or y > box[3]:
                        continue
                    turns = winding(cubics, offsets[d], offsets[d + 1], x, y, pieces)
                    outside += turns
                    if turns * sign > 0 and (innermost < 0 or abs(areas[d]) < abs(areas[innermost])):
                        innermost = d
                if outside == 0 or outside + sign == 0:
                    bounds[c] = True
                    outer[c] = outer[c] or outside == 0
                    if outer[c] or not crosses[c]:
                        break
                elif around[c] < 0:
                    around[c] = innermost
    return areas, bounds, outer, around


@compiled
def spur_length(cubics: FloatArray, joint: int, apart: float) -> float:
    """For how long the two sides of a closed chain (m, 4, 2) lie on each other from a joint on, not farther apart.

    0 if not even one of the two segments at the joint lies on the other side as a whole: a sharp tip is no spur.
    """
    m, run, back = len(cubics), 0.0, 0
    most = m * STEPS // 2
    x0, y0 = cubics[joint, 0, 0], cubics[joint, 0, 1]
    for k in range(most):
        segment = (joint + k // STEPS) % m
        begin, end = k % STEPS / STEPS, (k % STEPS + 1) / STEPS
        x, y, _, _, _, _ = jet(cubics, segment, end)
        near = beside_chord(cubics, joint, back, x, y)
        while back + 1 < most:
            beyond = beside_chord(cubics, joint, back + 1, x, y)
            if beyond > near:
                break
            near, back = beyond, back + 1
        if near > apart:
            low, high = begin, end
            for _ in range(20):  # for the place on the chord where the sides part
                t = (low + high) / 2
                x, y, _, _, _, _ = jet(cubics, segment, t)
                if beside_chord(cubics, joint, back, x, y) > apart:
                    high = t
                else:
                    low = t
            x, y, _, _, _, _ = jet(cubics, segment, low)
            run += length(x - x0, y - y0)
            whole = k >= STEPS or back >= STEPS
            for which in range(3):  # a spur ends at the end of a segment, and what is beyond comes from the tolerance
                end = segment if which == 0 else (joint - 1 - back // STEPS + which - 1) % m
                beyond = length(x - cubics[end, 0, 0], y - cubics[end, 0, 1])
                if end != joint and beyond <= 2 * apart:
                    return run - beyond
            return run if whole else 0.0
        run += length(x - x0, y - y0)
        x0, y0 = x, y
    return run


@compiled
def beside_chord(cubics: FloatArray, joint: int, k: int, x: float, y: float) -> float:
    """Distance of a point from the chord of number k that leads from a joint of a closed chain backwards."""
    m = len(cubics)
    segment, begin = (joint - 1 - k // STEPS) % m, 1 - k % STEPS / STEPS
    ax, ay, _, _, _, _ = jet(cubics, segment, begin)
    bx, by, _, _, _, _ = jet(cubics, segment, begin - 1 / STEPS)
    dx, dy = bx - ax, by - ay
    square = dx * dx + dy * dy
    along = min(max(((x - ax) * dx + (y - ay) * dy) / square, 0.0), 1.0) if square > 0.0 else 0.0
    return length(x - ax - along * dx, y - ay - along * dy)


@compiled
def winding(cubics: FloatArray, first: int, last: int, x: float, y: float, pieces: FloatArray) -> int:
    """How often the contour of the segments from ``first`` up to ``last`` runs around a point, counter-clockwise.

    Args:
        pieces: (MOST_HALVINGS + 1, 4, 2), for the halves of a segment that the ray to the right of the point may meet.
    """
    found = 0
    for s in range(first, last):
        for k in range(8):
            pieces[0, k // 2, k % 2] = cubics[s, k // 2, k % 2]
        top, halvings = 0, 0
        while top >= 0:
            b = pieces[top]
            left = right = above = 0
            for k in range(4):
                left += b[k, 0] < x
                right += b[k, 0] > x
                above += b[k, 1] > y
            if left == 4 or above == 0 or above == 4:
                top -= 1
            elif right == 4 or halvings == MOST_HALVINGS:
                found += int(b[3, 1] > y) - int(b[0, 1] > y)
                top -= 1
            else:
                for k in range(8):
                    pieces[top + 1, k // 2, k % 2] = pieces[top, k // 2, k % 2]
                split(pieces[top + 1], 0.5, pieces[top])
                top, halvings = top + 1, halvings + 1
    return found
