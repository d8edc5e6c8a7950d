"""Crossings of contours, with themselves and with each other.

Pieces are compared in pairs and halved until a pair is decided. A pair is apart if the boxes around its Bézier points
are, or if its points lie on two sides of a line along one of the chords. Pieces that share a joint do not meet
elsewhere if all legs of their control polygons run forward along a common direction, or if the two leave the joint
within two cones that have no direction in common. Most pairs are decided by these tests before any halving. What is
left in the end are chords that differ from the curve by less than ``FLAT`` of the extent. Every piece has its own
chords, whatever it is compared with, so the chords of a contour are one polyline.

Two chords cross if the ends of each lie on two sides of the other. If an end lies on the other chord, the strands
*touch*, in a point or along a stretch. Pieces that are not straight are then halved on, as they may cross twice within
the errors of chords that touch; :mod:`.contacts` decides whether strands that still touch change sides.
"""

from __future__ import annotations

import numpy as np

from ..arrays import grown, put
from ..compiled import compiled, inlined
from ..types import BoolArray, FloatArray, IntArray
from .contacts import all_crossings
from .cubics import extent, split, square

FLAT = 1e-9
"""Share of a glyph's extent by which the chords that are compared may differ from the curves."""

DEEPEST = 24
"""Most halvings of a piece: from an extent of 1, its chords are nearer than ``FLAT`` after 15."""

MOST_STEPS, MOST_MEETINGS = 20_000_000, 20_000
"""Pairs of a glyph that are looked at, a second's work, and those that meet. Real glyphs take thousands and tens."""

DEEPER = 9
"""Halvings more of pieces that share a joint and are not decided: loops at joints are smaller than chord errors."""

FINER, MOST_FINER = 5, 24
"""Halvings more of pieces whose chords touch: strands may cross twice within chord errors. Beyond these halvings
rounding decides. If more pairs than that touch then and none crosses, strands lie on each other, and touch as they are:
a chord that lies on another one would become 32 that do."""

STACK = 3 * 3 * (DEEPEST + DEEPER)
"""Pairs to do at a time: each halving adds two at most, to a piece's pair with itself and then to pairs of halves."""

SELF, AFTER, BEFORE = 1, 2, 4
"""What is known of a pair: it is one piece with itself; B begins where A ends; A begins where B ends."""


def crossings(cubics: FloatArray, offsets: IntArray, glyphs: IntArray) -> tuple[FloatArray, BoolArray]:
    """Points where contours of a glyph cross, each other or themselves.

    Strands that penetrate each other by less than some ``FLAT`` of the extent touch. Touching is no crossing.

    Args:
        cubics: (m, 4, 2) segments of all contours. offsets: (C + 1,) where each contour begins in them.
        glyphs: (G + 1,) where the contours of each glyph begin.

    Returns:
        (K, 4): the numbers of the two contours, the smaller one first, and the crossing's *place* on each: segment,
        counted from the contour's first, and local parameter. And (G,) whether all of a glyph's were looked for: an
        outline of thousands of coinciding strands would take minutes.
    """
    met, complete = meetings(cubics, offsets, glyphs)
    found = all_crossings(cubics, offsets, met)
    return found[np.lexsort(found.T[::-1])], complete


def meetings(cubics: FloatArray, offsets: IntArray, glyphs: IntArray) -> tuple[FloatArray, BoolArray]:
    """Pairs of chords that cross or touch; arguments as for :func:`crossings`.

    Returns:
        (K, 6): the two contours, and the places where contact begins and ends, by the first of them: (c, d, a, b, a',
        b'). Of a crossing the last two are NaN. And (G,) whether all of a glyph's were looked for.
    """
    pieces, boxes, flat, ends = pieces_of(cubics, offsets, glyphs)
    order = np.lexsort((boxes[:, 0], np.repeat(np.arange(len(flat)), np.diff(ends))))
    return all_meetings(cubics, offsets, pieces, boxes, order, flat, ends)


@compiled
def pieces_of(
    cubics: FloatArray, offsets: IntArray, glyphs: IntArray
) -> tuple[IntArray, FloatArray, FloatArray, IntArray]:  # fmt: skip
    """The segments that have a length.

    Returns:
        (n, 4): segment, contour, the piece after it, halvings until it is as good as its chord. (n, 4) boxes: left,
        right, low, high. And of the G glyphs (G,) by how much chords may differ from curves, and (G + 1,) where the
        pieces of each begin.
    """
    n, G = 0, len(glyphs) - 1
    pieces, boxes = np.empty((len(cubics), 4), np.int64), np.empty((len(cubics), 4))
    flat, ends = np.empty(G), np.zeros(G + 1, np.int64)
    for g in range(G):
        flat[g] = FLAT * extent(cubics[offsets[glyphs[g]] : offsets[glyphs[g + 1]]])
        for c in range(glyphs[g], glyphs[g + 1]):
            begin = n
            for s in range(offsets[c], offsets[c + 1]):
                if legs(cubics[s]) > 0.0:  # rounding may leave pieces of no length
                    pieces[n, 0], pieces[n, 1], pieces[n, 2], pieces[n, 3] = s, c, n + 1, 0
                    n += 1
            if n > begin:
                pieces[n - 1, 2] = begin
        ends[g + 1] = n
        for i in range(ends[g], n):
            b = cubics[pieces[i, 0]]
            for axis in range(2):
                low = high = b[0, axis]
                for k in range(1, 4):
                    low, high = min(low, b[k, axis]), max(high, b[k, axis])
                boxes[i, 2 * axis], boxes[i, 2 * axis + 1] = low, high
            error = chord_error(b)
            while error > flat[g] and pieces[i, 3] < DEEPEST:
                pieces[i, 3] += 1
                error /= 4
    return pieces[:n], boxes[:n], flat, ends


@compiled
def all_meetings(
    cubics: FloatArray, offsets: IntArray, pieces: IntArray, boxes: FloatArray, order: IntArray, flat: FloatArray,
    ends: IntArray,
) -> tuple[FloatArray, BoolArray]:  # fmt: skip
    """The meetings of each glyph; see :func:`meetings`.

    Args:
        pieces, boxes, flat, ends: of :func:`pieces_of`. order: of each glyph's pieces, by their left.
    """
    every, complete, count = np.empty((16, 6)), np.empty(len(flat), np.bool_), 0
    for g in range(len(flat)):
        own = order[ends[g] : ends[g + 1]]
        found, complete[g] = glyph_meetings(cubics, offsets, pieces, boxes, own, flat[g])
        every = grown(every, count + len(found))
        put(found, every[count : count + len(found)])
        count += len(found)
    return every[:count], complete


@compiled
def glyph_meetings(
    cubics: FloatArray, offsets: IntArray, pieces: IntArray, boxes: FloatArray, order: IntArray, flat: float
) -> tuple[FloatArray, bool]:  # fmt: skip
    """The meetings of a glyph, none if there are too many; see :func:`all_meetings`."""
    found, count, n, finest = np.empty((16, 6)), 0, len(order), flat * 0.25**FINER
    A, B = np.empty((STACK, 4, 2)), np.empty((STACK, 4, 2))
    marks, begins = np.empty((STACK, 3), np.int64), np.empty((STACK, 2))
    steps, coarse, floor = 0, -1, 0  # the row of a pair that touches and is halved on, and its place on the stack
    for oi in range(n):
        i = order[oi]
        for oj in range(oi, n):
            j = order[oj]
            if boxes[j, 0] > boxes[i, 1]:
                break
            steps += 1
            if boxes[j, 2] > boxes[i, 3] or boxes[j, 3] < boxes[i, 2]:
                continue
            s, t = min(i, j), max(i, j)  # the order of the contours
            put(cubics[pieces[s, 0]], A[0])
            put(cubics[pieces[t, 0]], B[0])
            marks[0, 0], marks[0, 1] = 0, 0
            after, before = pieces[s, 2] == t, pieces[t, 2] == s
            marks[0, 2] = AFTER * after + BEFORE * before if s != t else SELF + AFTER * after
            begins[0, 0], begins[0, 1] = 0.0, 0.0
            top = 0
            while top >= 0 or coarse >= 0:
                if steps > MOST_STEPS or count > MOST_MEETINGS:
                    return found[:0], False
                steps += 1
                if coarse >= 0 and top < floor:  # all finer pairs are done: they take the place of the coarse one
                    crossed = count - coarse <= MOST_FINER + 1
                    for r in range(coarse + 1, count):
                        crossed = crossed or np.isnan(found[r, 4])
                    if crossed:
                        put(found[coarse + 1 : count], found[coarse : count - 1])
                        count -= 1
                    else:
                        count = coarse + 1
                    coarse = -1
                    continue
                kind = marks[top, 2]
                if decided(A[top], B[top], kind):
                    top -= 1
                    continue
                deepest = DEEPER if kind else FINER if coarse >= 0 else 0
                ended, other_ended = marks[top, 0] >= pieces[s, 3] + deepest, marks[top, 1] >= pieces[t, 3] + deepest
                same = back = not kind  # whether both pieces have the same Bézier points, or in reverse
                for k in range(0 if kind else 4):
                    same = same and A[top, k, 0] == B[top, k, 0] and A[top, k, 1] == B[top, k, 1]
                    back = back and A[top, k, 0] == B[top, 3 - k, 0] and A[top, k, 1] == B[top, 3 - k, 1]
                if kind & SELF:
                    top = top - 1 if ended else halve_itself(A, B, marks, begins, top)
                elif same or back or (ended and other_ended):
                    x, y, x_end, y_end, finer = -1.0, 0.0, 0.0, 0.0, FINER
                    if same or back:
                        x, x_end, y = 0.0, 1.0, 0.0 if same else 1.0
                        y_end = 1.0 - y
                    elif kind == 0:
                        straight = True
                        for one_of in (A, B):
                            straight = straight and is_straight(one_of[top], finest)
                        finer = min(marks[top, 0] - pieces[s, 3], marks[top, 1] - pieces[t, 3])
                        finer = FINER if straight else max(finer, 0)
                        x, y, x_end, y_end = meeting(A[top], B[top], 4.0 * flat * 0.25**finer)
                    if x >= 0.0:
                        found = grown(found, count + 1)
                        found[count, 0], found[count, 1] = pieces[s, 1], pieces[t, 1]
                        for k in range(2):
                            which, one, other = (s, x, x_end) if k == 0 else (t, y, y_end)
                            cubic, share = A[top] if k == 0 else B[top], 0.5 ** marks[top, k]
                            begin = pieces[which, 0] - offsets[pieces[which, 1]] + begins[top, k]
                            found[count, 2 + k] = begin + share * parameter_at(cubic, one)
                            found[count, 4 + k] = begin + share * parameter_at(cubic, other)
                        count += 1
                    if coarse < 0 and x >= 0.0 and x_end >= 0.0 and finer < FINER:
                        coarse, floor = count - 1, top
                    else:
                        top -= 1
                else:
                    first = other_ended or (not ended and legs(A[top]) >= legs(B[top]))
                    top = halve(A, B, marks, begins, top, 0 if first else 1)
    return found[:count], True


@compiled
def chord_error(cubic: FloatArray) -> float:
    """Bound of the distance of a cubic (4, 2) from its chord; halving it makes the bounds of the halves a quarter.

    It is 3/4 of the larger second difference. Along the chord of a cubic that runs forward, one counts by the slope
    only: it does not move the points, but their parameters.
    """
    x, y = cubic[3, 0] - cubic[0, 0], cubic[3, 1] - cubic[0, 1]
    chord = np.sqrt(x * x + y * y)
    whole = along = across = slope = 0.0
    for k in range(3):
        ax, ay = cubic[k + 1, 0] - cubic[k, 0], cubic[k + 1, 1] - cubic[k, 1]
        slope = max(slope, abs(x * ay - y * ax) / abs(x * ax + y * ay)) if ax != 0.0 or ay != 0.0 else slope
        if k < 2:
            bx, by = cubic[k + 2, 0] - cubic[k + 1, 0] - ax, cubic[k + 2, 1] - cubic[k + 1, 1] - ay
            whole = max(whole, abs(bx) + abs(by))
            along, across = max(along, abs(x * bx + y * by) / chord), max(across, abs(x * by - y * bx) / chord)
    if chord > 0.0 and runs_forward(cubic, cubic) and across + slope * along < whole:
        whole = across + slope * along
    return 0.75 * whole


@inlined
def is_straight(cubic: FloatArray, error: float) -> bool:
    """Whether the Bézier points of a cubic are within an error of the line along its chord."""
    x, y = cubic[3, 0] - cubic[0, 0], cubic[3, 1] - cubic[0, 1]
    one = x * (cubic[1, 1] - cubic[0, 1]) - y * (cubic[1, 0] - cubic[0, 0])
    other = x * (cubic[2, 1] - cubic[0, 1]) - y * (cubic[2, 0] - cubic[0, 0])
    return max(abs(one), abs(other)) <= error * np.sqrt(x * x + y * y)


@compiled
def parameter_at(cubic: FloatArray, share: float) -> float:
    """The parameter at which a cubic that hardly differs from its chord has run a share of it; NaN of NaN."""
    x, y = cubic[3, 0] - cubic[0, 0], cubic[3, 1] - cubic[0, 1]
    aim, low, high = share * (x * x + y * y), 0.0, 1.0
    if not 0.0 < share < 1.0:
        return share
    for _ in range(40):
        t = (low + high) / 2
        s, run = 1 - t, 0.0
        for k in range(1, 4):
            weight = 3 * s * s * t if k == 1 else 3 * s * t * t if k == 2 else t * t * t
            run += weight * (x * (cubic[k, 0] - cubic[0, 0]) + y * (cubic[k, 1] - cubic[0, 1]))
        if run < aim:
            low = t
        else:
            high = t
    return (low + high) / 2


@inlined
def legs(cubic: FloatArray) -> float:
    """Length of a control polygon (4, 2), every leg as |x| + |y|."""
    total = 0.0
    for k in range(3):
        total += abs(cubic[k + 1, 0] - cubic[k, 0]) + abs(cubic[k + 1, 1] - cubic[k, 1])
    return total


@compiled
def halve(A: FloatArray, B: FloatArray, marks: IntArray, begins: FloatArray, top: int, which: int) -> int:
    """Replace the pair at the top of the stack by two, with the halves of A (``which`` 0) or B (1)."""
    one, other = (A, B) if which == 0 else (B, A)
    put(other[top], other[top + 1])
    split(one[top], 0.5, one[top + 1])  # the first half to the top, the second one below
    for k in range(3):
        marks[top + 1, k] = marks[top, k]
    begins[top + 1, 0], begins[top + 1, 1] = begins[top, 0], begins[top, 1]
    marks[top, which] += 1
    marks[top + 1, which] += 1
    begins[top, which] += 0.5 ** marks[top, which]
    kind = marks[top, 2]
    ends, starts = (AFTER, BEFORE) if which == 0 else (BEFORE, AFTER)  # the joint at the end of the halved piece
    marks[top, 2], marks[top + 1, 2] = kind & ends, kind & starts
    return top + 1


@inlined
def halve_itself(A: FloatArray, B: FloatArray, marks: IntArray, begins: FloatArray, top: int) -> int:
    """Replace a piece's pair with itself by those of its halves, with themselves and with each other."""
    split(A[top], 0.5, A[top + 1])
    level, begin = marks[top, 0] + 1, begins[top, 0]
    middle = begin + 0.5**level
    put(A[top + 1], A[top + 2])
    put(A[top], B[top + 2])
    for k in range(3):
        marks[top + k, 0], marks[top + k, 1] = level, level
        marks[top + k, 2] = SELF if k < 2 else AFTER + BEFORE * (marks[top, 2] & AFTER > 0)
    begins[top, 0], begins[top + 1, 0], begins[top + 2, 0], begins[top + 2, 1] = middle, begin, begin, middle
    return top + 2


@compiled
def decided(A: FloatArray, B: FloatArray, kind: int) -> bool:
    """Whether Bézier points prove that two pieces do not meet, but for their joint; or one piece not itself."""
    if kind & SELF:
        return kind == SELF and runs_forward(A, A)
    if kind == AFTER:
        return runs_forward(A, B) or leaves_apart(A, B)
    if kind == BEFORE:
        return runs_forward(B, A) or leaves_apart(B, A)
    if kind > 0:  # two joints
        return False
    for axis in range(2):
        low, high, other_low, other_high = A[0, axis], A[0, axis], B[0, axis], B[0, axis]
        for k in range(1, 4):
            low, high = min(low, A[k, axis]), max(high, A[k, axis])
            other_low, other_high = min(other_low, B[k, axis]), max(other_high, B[k, axis])
        if low > other_high or other_low > high:
            return True
    for one, other in ((A, B), (B, A)):  # a line along the chord of one separates the points of both
        x, y = one[3, 0] - one[0, 0], one[3, 1] - one[0, 1]
        low, high, least, most = 0.0, 0.0, np.inf, -np.inf
        for k in range(4):
            across = x * (one[k, 1] - one[0, 1]) - y * (one[k, 0] - one[0, 0])
            low, high = (min(low, across), max(high, across)) if 0 < k < 3 else (low, high)
            across = x * (other[k, 1] - one[0, 1]) - y * (other[k, 0] - one[0, 0])
            least, most = min(least, across), max(most, across)
        slack = 1e-13 * (abs(low) + abs(high) + abs(least) + abs(most))
        if least > high + slack or most < low - slack:
            return True
    return False


@compiled
def runs_forward(A: FloatArray, B: FloatArray) -> bool:
    """Whether all legs of A, and of B that follows it or is A, run along the chord from the first point to the last."""
    x, y = B[3, 0] - A[0, 0], B[3, 1] - A[0, 1]
    for k in range(6):
        cubic, r = (A, k) if k < 3 else (B, k - 3)
        dx, dy = cubic[r + 1, 0] - cubic[r, 0], cubic[r + 1, 1] - cubic[r, 1]
        if dx * x + dy * y <= 0 and (dx != 0 or dy != 0):
            return False
    return True


@compiled
def leaves_apart(A: FloatArray, B: FloatArray) -> bool:
    """Whether A, run back from its end, and B, which begins there, run within cones that share no direction."""
    sign = 0.0
    for k in range(3):
        ax, ay = A[k, 0] - A[k + 1, 0], A[k, 1] - A[k + 1, 1]
        for r in range(3):
            bx, by = B[r + 1, 0] - B[r, 0], B[r + 1, 1] - B[r, 1]
            if (ax == 0 and ay == 0) or (bx == 0 and by == 0):
                continue
            turn = ax * by - ay * bx
            if abs(turn) <= 1e-12 * (abs(ax) + abs(ay)) * (abs(bx) + abs(by)) or sign * turn < 0:
                return False
            sign = turn
    return True


@compiled
def meeting(A: FloatArray, B: FloatArray, touch: float) -> tuple[float, float, float, float]:
    """Where the chords of two pieces meet: parameters x, y of A and B, then NaN if they cross there, and else those
    where their contact ends. x is -1 if they do not meet.

    Args:
        touch: ends of a chord nearer than this to the other chord lie on it.
    """
    ax, ay, bx, by = A[0, 0], A[0, 1], A[3, 0], A[3, 1]
    cx, cy, dx, dy = B[0, 0], B[0, 1], B[3, 0], B[3, 1]
    ux, uy, vx, vy = bx - ax, by - ay, dx - cx, dy - cy
    u, v = ux * ux + uy * uy, vx * vx + vy * vy
    x, y, x_end, y_end = np.inf, 0.0, -np.inf, 0.0
    for k in range(4):
        if k < 2:  # an end of B on A
            px, py = (cx, cy) if k == 0 else (dx, dy)
            along = min(max(((px - ax) * ux + (py - ay) * uy) / u, 0.0), 1.0)
            near = square(ax + along * ux - px) + square(ay + along * uy - py)
            one, other = along, float(k)
        else:
            px, py = (ax, ay) if k == 2 else (bx, by)
            along = min(max(((px - cx) * vx + (py - cy) * vy) / v, 0.0), 1.0)
            near = square(cx + along * vx - px) + square(cy + along * vy - py)
            one, other = k - 2.0, along
        if near <= touch * touch:
            if one < x:
                x, y = one, other
            if one > x_end:
                x_end, y_end = one, other
    if x <= x_end:
        return x, y, x_end, y_end
    c, d = ux * (cy - ay) - uy * (cx - ax), ux * (dy - ay) - uy * (dx - ax)
    a, b = vx * (ay - cy) - vy * (ax - cx), vx * (by - cy) - vy * (bx - cx)
    if (c >= 0) == (d >= 0) or (a >= 0) == (b >= 0):
        return -1.0, 0.0, 0.0, 0.0
    return a / (a - b), c / (c - d), np.nan, np.nan
