"""What the contours of a glyph enclose: overlaps, self-crossings, doubled strands, wrong directions, what is covered.

Contours *cross* where one changes to the other side of the other; to touch is no crossing. Strands are *doubled* where
they lie on each other. Of a contour that runs to a tip and straight back, a spur, they may be apart by what rounding to
whole units makes of them, and one of the two segments at the tip lies on the other side as a whole: a sharp tip is no
spur. Other strands are doubled if they are the same but for rounding errors: a bridge to a counter, edges of two
contours that abut, a copy of a contour. In a glyph of parts that overlap, edges may abut or be shared.

What is filled on both sides of a contour, by the nonzero rule, changes only where it meets others or itself: it is
looked at between all such places. An *outer* contour has white outside along most of what bounds ink. It runs in the
*wrong direction* if it runs unlike most outer contours of its glyph: fonts draw them clockwise or counter-clockwise,
and both are right. A contour with ink on both sides all along draws nothing and has no wrong direction. Over a joint
of others it is a patch. Inside a single contour, where a patch is of no use, it is *covered*: a counter, say, that runs
like the contour around it.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...curves.bezier import evaluate
from ...curves.contacts import Strand, all_crossings
from ...curves.crossings import meetings
from ...curves.cubics import jet, length
from ...curves.integrals import area, integrals
from ...outlines.flaws.joints import ROUNDING, Segments, rows
from ...outlines.flaws.kinds import CANCELLING, COVERED, CROSSING, DIRECTION, DOUBLED, OVERLAP, SPIKE, Limits
from ...outlines.winding import MOST_HALVINGS, winding
from ...types import BoolArray, FloatArray, IntArray

SHARP = np.radians(30.0)
"""Angle between the sides of a spike's tip, at most."""

STEPS = 16
"""Chords a segment on the two sides of a spur."""

ANYWHERE = 0.41
"""Parameter at which the sides of a contour that meets nothing are looked at: contours may share ends and middles."""

ONE_WAY = 0.8
"""Share of an outer contour's length by which more of it runs one way than the other: a contour that crosses itself may
run both ways."""

BESIDE = 1e-3
"""Distance from a contour, in thousandths of an em, at which its sides are looked at."""


def enclosed_findings(
    cubics: FloatArray, segments: Segments, glyphs: IntArray, limits: Limits, unit: float, outer: int
) -> FloatArray:
    """(n, 7) overlaps, self-crossings, doubled strands, wrong directions and what is covered; see :mod:`.segments`.

    Two contours that cross are reported once, of the first, where it first crosses; the value is the number of places.
    The value of the last two is the area enclosed. Of glyphs with thousands of strands on each other, for which
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
    crosses = np.zeros(len(offsets) - 1, dtype=np.bool_)
    crosses[crossed[crossed[:, 0] != crossed[:, 1], :2].astype(np.int64)] = True
    doubled = _doubled(cubics, offsets, touching, crosses, limits.doubled)
    spurs = _spurs(cubics, segments, limits, min(ROUNDING, unit))
    known = (doubled[:, 5] < 0) & np.isin(doubled[:, 1], spurs[spurs[:, 0] == DOUBLED, 1])
    directed = _directed(cubics, offsets, glyphs, met, unit, outer, limits.doubled)
    return np.concatenate([_crossed(crossed), doubled[~known], spurs, directed])


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


def _directed(
    cubics: FloatArray, offsets: IntArray, glyphs: IntArray, met: FloatArray, unit: float, way: int, least: float
) -> FloatArray:
    """Covered contours, outer ones that run against ``way``, or, if it is 0, against most of the glyph's, and those
    that cancel another one.

    Args:
        met: (K, 6) where contours meet, see :func:`..curves.crossings.meetings`.
        least: length of an edge along which a contour that cancels another one is seen to do so.
    """
    count, owners = len(offsets) - 1, np.repeat(np.arange(len(glyphs) - 1), np.diff(glyphs))
    places, lengths = _between_meetings(cubics, offsets, met)
    contours = places[:, 0].astype(np.int64)
    areas, own, every, around = sides(cubics, offsets, glyphs, owners, places, BESIDE * unit, unit * unit)
    white = every == 0
    bounds = white[:, 0] != white[:, 1]
    outside = (white & (own == 0)).any(axis=1)  # where white is, the contour does not wind
    lean = np.where(bounds, np.sign(every.sum(axis=1)), 0)
    of_outer, of_counters = (np.bincount(contours, lengths * (bounds & each), count) for each in (outside, ~outside))
    outer = of_outer > of_counters
    leans = np.bincount(contours, lengths * (lean * outside), count)
    runs = np.sign(leans) * (outer & (np.abs(leans) >= ONE_WAY * of_outer))
    most, total = (np.bincount(owners, values, len(glyphs) - 1) for values in (runs, areas * outer))
    wanted = np.full(len(most), way) if way else np.where(most != 0, most, total)
    within = np.full(count, -1)
    within[contours] = around
    # The others wind once, as this contour does; and nowhere another one of them.
    inside = (every - own == own.sum(axis=1)[:, None]).all(axis=1) & (around >= 0) & (around == within[contours])
    covered = (np.bincount(contours, ~inside, count) == 0) & (areas != 0) & (within >= 0)
    which = np.flatnonzero(covered | (runs * wanted[owners] < 0))
    what, other = np.where(covered, COVERED, DIRECTION), np.where(covered, within, -1)
    empty = white.all(axis=1) & (own != 0).any(axis=1)
    lost = np.bincount(contours, lengths * (empty | (bounds & ~outside)), count)
    lost[(of_outer < least) & (np.bincount(contours, ~empty & (lengths > 0.0), count) > 0)] = 0.0
    return np.concatenate([
        rows(what[which], which, 0.0, np.abs(areas[which]), other=other[which]),
        _cancelling(areas, met, np.where(lost >= least, lost, 0.0)),
    ])  # fmt: skip


def _cancelling(areas: FloatArray, met: FloatArray, lost: FloatArray) -> FloatArray:
    """Pairs of contours that meet, run in opposite directions, and both bound white inside them.

    Args:
        lost: (C,) length along which each does, of contours that elsewhere bound ink, or draw nothing at all.
    """
    pairs = np.unique(np.sort(met[:, :2].astype(np.int64), axis=1), axis=0)
    one, other = pairs[(lost[pairs] > 0).all(axis=1) & (areas[pairs].prod(axis=1) < 0)].T
    return rows(CANCELLING, one, 0.0, np.minimum(lost[one], lost[other]), other=other)


def _between_meetings(cubics: FloatArray, offsets: IntArray, met: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(k, 2) contours and places on them between any two where they meet something, and (k,) the lengths between these.

    A contour that meets nothing has one place, and a length of 1.
    """
    ends = np.concatenate([met[:, [0, 2]], met[:, [1, 3]], met[:, [0, 4]], met[:, [1, 5]]])
    ends = np.unique(ends[~np.isnan(ends[:, 1])], axis=0)
    alone = np.setdiff1d(np.flatnonzero(np.diff(offsets)), ends[:, 0])
    found, lengths = [np.column_stack([alone, np.full(len(alone), ANYWHERE)])], [np.ones(len(alone))]
    for c in np.unique(ends[:, 0]).astype(np.int64).tolist():
        strand, own = Strand(cubics[offsets[c] : offsets[c + 1]]), ends[ends[:, 0] == c, 1]
        at, again = strand.positions(own), own[0] + len(strand.cubics)
        middles = (own + np.append(own[1:], again)) / 2 % len(strand.cubics)
        found.append(np.column_stack([np.full(len(own), c), middles]))
        lengths.append(np.diff(at, append=at[0] + strand.total))
    return np.concatenate(found), np.concatenate(lengths)


@compiled
def sides(
    cubics: FloatArray, offsets: IntArray, glyphs: IntArray, owners: IntArray, places: FloatArray, beside: float,
    least: float,
) -> tuple[FloatArray, IntArray, IntArray, IntArray]:  # fmt: skip
    """How often contours of a glyph wind on both sides of one of them.

    Args:
        owners: (C,) glyphs of contours. places: (k, 2) contours and places on them. beside: distance of the two sides.

    Returns:
        (C,) signed area of contours, 0 up to ``least``. (k, 2) how often the contour winds to its left and right, and
        (k, 2) all of its glyph together. (k,) which other one winds on its left, -1 if none or several do.
    """
    count = len(offsets) - 1
    areas, boxes = np.empty(count), np.full((count, 4), np.nan)
    pieces = np.empty((MOST_HALVINGS + 1, 4, 2))
    for c in range(count):
        areas[c] = area(cubics[offsets[c] : offsets[c + 1]])
        if abs(areas[c]) <= least:
            areas[c] = 0.0
        for k in range(4 if offsets[c] < offsets[c + 1] else 0):
            own = cubics[offsets[c] : offsets[c + 1], :, k % 2]
            boxes[c, k] = own.min() if k < 2 else own.max()
    owns, every = np.zeros((len(places), 2), np.int64), np.zeros((len(places), 2), np.int64)
    around = np.full(len(places), -1)
    for i in range(len(places)):
        c = int(places[i, 0])
        if areas[c] == 0:
            continue
        s = int(places[i, 1])
        x, y, dx, dy, _, _ = jet(cubics, offsets[c] + s, places[i, 1] - s)
        step = beside / max(length(dx, dy), 1e-300)
        others = 0
        for d in range(glyphs[owners[c]], glyphs[owners[c] + 1]):
            box = boxes[d]
            if x < box[0] - beside or y < box[1] - beside or x > box[2] + beside or y > box[3] + beside:
                continue
            for side in range(2):
                away = step if side == 0 else -step
                turns = winding(cubics, offsets[d], offsets[d + 1], x - away * dy, y + away * dx, pieces)
                every[i, side] += turns
                if d == c:
                    owns[i, side] = turns
                elif side == 0 and turns != 0:
                    others += 1
                    around[i] = d
        if others != 1:
            around[i] = -1
    return areas, owns, every, around


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
