"""Whether strands that touch change sides: contacts of contours, in a point or along a stretch.

A contact is a set of pairs of chords that touch, each at a place of the two contours or along a stretch, and that hang
together. At its two ends, which are one point if it is no stretch, the second contour leaves the first one to its left
or to its right. The contours cross if it leaves to different sides. What side that is, is read from the points at which
the strands cross a small circle around the end.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..compiled import compiled
from ..types import FloatArray, IntArray
from .bezier import evaluate
from .cubics import jet, length

STEPS, HALVINGS = 32, 50
"""Points of a piece that are looked at for where it leaves the circle first. Of an interval of parameters, for the
point at which a strand crosses the circle."""


def crossing_contacts(cubics: FloatArray, offsets: IntArray, touching: FloatArray) -> FloatArray:
    """Of the contacts of contours, those in which they change sides.

    Args:
        cubics: (m, 4, 2) segments of all contours. offsets: (C + 1,) where each contour begins.
        touching: (K, 6) pairs of chords that touch: the contours c <= d, and the places (a, b), (a', b') where the
            contact of the two chords begins and ends, a <= a'.

    Returns:
        (L, 4) the contours, and the places where a contact begins.
    """
    # Radius of the circle, as a share of the extent: far above the chord errors, far below what a contour draws.
    radius = 2e-5 * float(np.abs(cubics).max())
    found = []
    for c, d in np.unique(touching[:, :2].astype(np.int64), axis=0).tolist():
        one, other = (_Strand(cubics[offsets[k] : offsets[k + 1]]) for k in (c, d))
        for contact in _contacts(touching[(touching[:, :2] == (c, d)).all(axis=1), 2:], one, other, radius):
            (a, b), (a_end, b_end) = contact.begin, contact.end
            small = radius
            if c == d:  # the strands may be the two sides of a fold, or of a small loop
                small = min(radius, one.reach(a, b) / 2, one.reach(a_end, b_end) / 2)
                # A contact shorter than this share of the radius is a point. Beside a longer one that ends in a fold,
                # the strands may cross where it begins.
                if small < radius and one.reach(a, a_end) > 0.1 * radius:
                    (a, b) = (a_end, b_end) = max(contact.begin, contact.end, key=lambda at: one.reach(*at))
                    if one.reach(a, b) < 2 * radius:
                        continue
                    small = radius
            along = other.way(b, b_end) >= 0
            # Directions nearer to each other than this, in radians, are the same.
            circles = [(small, 1e-8)]
            # In a point, strands may cross plainly, at an angle that chord errors do not change. Then a smaller circle
            # decides, which leaves out other crossings, as at the tip of a fold.
            if (a, b) == (a_end, b_end) and radius / 200 < small:
                circles = [(radius / 200, 0.1), *circles]
            for size, tied in circles:
                sides = [
                    _is_left(one, x, other, y, way, size, tied)
                    for x, y, way in ((a, b, not along), (a_end, b_end, along))
                ]
                if None not in sides:
                    if sides[0] != sides[1]:
                        found.append((c, d, a, b))
                    break
    return np.array(found, dtype=np.float64).reshape(-1, 4)


class _Strand:
    """A contour along which one walks."""

    def __init__(self, cubics: FloatArray) -> None:
        self.cubics = cubics
        legs = np.hypot(*np.moveaxis(np.diff(cubics, axis=1), 2, 0)).sum(axis=1)
        self.lengths = np.concatenate([[0.0], np.cumsum(legs)])
        self.total = float(self.lengths[-1])

    def positions(self, places: FloatArray) -> FloatArray:
        """Lengths of the control polygon up to places (k,), with which they grow."""
        found: FloatArray = np.interp(places, np.arange(len(self.lengths)), self.lengths)
        return found

    def way(self, place: float, to: float) -> float:
        """The shorter way between two places as positions count it, negative if it runs back."""
        begin, end = self.positions(np.array([place, to])).tolist()
        return float((end - begin + self.total / 2) % self.total - self.total / 2)

    def reach(self, place: float, to: float) -> float:
        """How far the contour goes from a place on the shorter way to another one: to points of each piece."""
        low, high = (place, to) if self.way(place, to) >= 0 else (to, place)
        high += len(self.cubics) * (high < low)
        ends = np.array([low, *range(int(low) + 1, int(np.ceil(high))), high])
        pieces = ends[:-1].astype(np.int64)
        x = ends[:-1, None] - pieces[:, None] + np.diff(ends)[:, None] * np.linspace(0, 1, STEPS + 1)
        chain = self.cubics[np.repeat(pieces % len(self.cubics), STEPS + 1)]
        points = evaluate(chain, x.ravel())
        return float(np.hypot(*(points - points[0]).T).max())


@compiled
def leaving_angle(
    cubics: FloatArray, centre: float, place: float, forward: bool, radius: float, other: FloatArray
) -> float:
    """The angle at which a closed chain leaves a circle, from a place on.

    Args:
        centre: the circle's, as a place of the chain ``other``.
    """
    s = min(int(centre), len(other) - 1)
    cx, cy, _, _, _, _ = jet(other, s, centre - s)
    m, s = len(cubics), min(int(place), len(cubics) - 1)
    inside, end, step = place - s, 1.0 if forward else 0.0, 1 if forward else -1
    outside = end
    for _ in range(m + 1):
        begin, found = inside, False
        for k in range(1, STEPS + 1):
            outside = begin + (end - begin) * k / STEPS
            x, y, _, _, _, _ = jet(cubics, s, outside)
            if length(x - cx, y - cy) >= radius:
                found = True
                break
            inside = outside
        if found:
            break
        s, inside = (s + step) % m, 1.0 - end
    for _ in range(HALVINGS):
        middle = (inside + outside) / 2
        x, y, _, _, _, _ = jet(cubics, s, middle)
        if length(x - cx, y - cy) < radius:
            inside = middle
        else:
            outside = middle
    x, y, _, _, _, _ = jet(cubics, s, outside)
    return np.arctan2(y - cy, x - cx)


@dataclass
class _Contact:
    """Where a contact begins and ends.

    Attributes:
        begin, end: places on both contours. position: of the end, on the first contour.
        beside: positions on the second contour of the ends of chords, the last ones at the end.
    """

    begin: tuple[float, float]
    end: tuple[float, float]
    position: float
    beside: list[float]

    def is_beside(self, positions: list[float], total: float, radius: float) -> bool:
        """Whether one of some positions is near one of the last ones; ``total`` is the length of the contour."""
        for x in positions:
            # Ends of chords at the end of a contact that the next pair of chords may hang on.
            for y in self.beside[-8:]:
                away = abs(x - y) % total
                if min(away, total - away) <= radius:
                    return True
        return False


def _contacts(touching: FloatArray, one: _Strand, other: _Strand, radius: float) -> list[_Contact]:
    """Pairs of chords that hang together; see :func:`crossing_contacts`."""
    ordered = touching[np.lexsort(touching.T[::-1])]
    along = [one.positions(ordered[:, k]) for k in (0, 2)]
    across = [other.positions(ordered[:, k]) for k in (1, 3)]
    found: list[_Contact] = []
    still: list[_Contact] = []  # those that later pairs may hang on
    for (a, b, a_end, b_end), s, s_end, *beside in zip(
        ordered.tolist(), *(x.tolist() for x in (*along, *across)), strict=True
    ):
        still = [contact for contact in still if s - contact.position <= radius]
        for contact in reversed(still):
            if contact.is_beside(beside, other.total, radius):
                if a_end > contact.end[0]:
                    contact.end, contact.position = (a_end, b_end), s_end
                contact.beside += beside
                break
        else:
            still.append(_Contact((a, b), (a_end, b_end), s_end, beside))
            found.append(still[-1])
    for contact in found[1:]:  # one that runs over the contour's start is in two parts
        first = found[0]
        over = abs(one.way(contact.end[0], first.begin[0])) <= radius
        if over and abs(other.way(contact.end[1], first.begin[1])) <= radius:
            contact.end = first.end
            return found[1:]
    return found


def _is_left(
    one: _Strand, a: float, other: _Strand, b: float, forward: bool, radius: float, tied: float
) -> bool | None:
    """Whether a contour leaves another one to its left, from a contact at places a and b; None if along it."""
    ahead, back = (leaving_angle(one.cubics, a, a, way, radius, one.cubics) for way in (True, False))
    leaves = leaving_angle(other.cubics, a, b, forward, radius, one.cubics)
    whole = 2 * np.pi
    if any(abs((leaves - x + np.pi) % whole - np.pi) <= tied for x in (ahead, back)):
        return None
    return bool((leaves - ahead) % whole < (back - ahead) % whole)
