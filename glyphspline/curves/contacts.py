"""Whether strands that touch change sides: contacts of contours, in a point or along a stretch.

A contact is a set of pairs of chords that touch, each at a place of the two contours or along a stretch, and that hang
together. At its two ends, which are one point if it is no stretch, the second contour leaves the first one to its left
or to its right. The contours cross if it leaves to different sides. What side that is, is read from the points at which
the strands cross a small circle around the end; chords that cross inside these circles are part of what is read there.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..compiled import compiled
from ..types import BoolArray, FloatArray, IntArray
from .bezier import evaluate
from .cubics import bernstein, jet, length

RADIUS = 2e-5
"""Radius of the largest circle, as a share of the extent: far above the chord errors, far below what contours draw."""

FIRST, SMALLER = 256.0, 16.0
"""Circles begin with the radius divided by the first, where strands cross at angles that errors of chords which touch
do not change, and grow by the second: in a small one there are no other contacts."""

STEPS = 1_000
"""Steps, beside one a piece, after which a strand has left the circle: tens are enough but where it runs along it."""

PLACES = 32
"""Chords of a piece that say how long it is and how far it goes."""


def all_crossings(cubics: FloatArray, offsets: IntArray, met: FloatArray) -> FloatArray:
    """Where contours cross: chords that do, and contacts in which contours change sides.

    Args:
        cubics: (m, 4, 2) segments of all contours. offsets: (C + 1,) where each contour begins.
        met: (K, 6) pairs of chords that cross or touch, see :func:`.crossings.meetings`.

    Returns:
        (L, 4) the contours, and the places, of a contact those where it begins.
    """
    if not len(met):
        return np.empty((0, 4))
    touches = ~np.isnan(met[:, 4])
    found = [met[~touches, :4]]
    largest = RADIUS * float(np.abs(cubics).max(initial=0.0))
    for pair in np.unique(met[touches, :2].astype(np.int64), axis=0):
        first, second = pair.tolist()
        one = Strand(cubics[offsets[first] : offsets[first + 1]])
        other = one if first == second else Strand(cubics[offsets[second] : offsets[second + 1]])
        its = (met[:, :2] == pair).all(axis=1)
        left, crossing = met[its & touches, 2:], met[its & ~touches, 2:4]
        radius = largest / FIRST
        while len(left) and radius <= largest:
            undecided = [np.empty((0, 4))]
            for contact in _contacts(left, one, other, 2 * radius):
                crosses = _crosses(contact, one, other, radius, largest, crossing)
                if crosses:
                    crossing = np.concatenate([crossing, [contact.begin]])
                    found.append(np.array([[*pair, *contact.begin]]))
                if crosses is None:
                    undecided.append(np.array([[*contact.begin, *contact.end]]))
            left, radius = np.concatenate(undecided), SMALLER * radius
    return np.concatenate(found)


def _crosses(
    contact: _Contact, one: Strand, other: Strand, radius: float, largest: float, known: FloatArray
) -> bool | None:
    """Whether contours change sides in a contact, beside the crossings (k, 2) that are known; None if not decided."""
    (a, b), (a_end, b_end) = contact.begin, contact.end
    last = radius >= largest
    # A contact shorter than this share of the radius is a point.
    long = a != a_end and one.reach(a, a_end, radius) > 0.1 * radius
    if long and not last:
        return None
    small = radius
    if one is other:  # the strands may be the two sides of a fold, or of a small loop
        small = min(radius, *(one.reach(*at, enough=2 * radius) / 2 for at in {contact.begin, contact.end}))
    if small < radius and not last:
        return None
    if small < radius and long:  # beside a contact that ends in a fold, the strands may cross where it begins
        (a, b) = (a_end, b_end) = max(contact.begin, contact.end, key=lambda at: one.reach(at[0], at[1], np.inf))
        if one.reach(a, b, 2 * radius) < 2 * radius:
            return None
        small = radius
    # Directions nearer to each other than this, in radians, are the same: 25 times what the distance of chords that
    # touch makes of a direction.
    tied = 1e-8 if last else 5e-6 * largest / radius
    along = other.way(b, b_end) >= 0
    begin, its_begin, left = _exit(one, a, other, b, False, not along, small, tied)
    end, its_end, left_at_end = _exit(one, a_end, other, b_end, True, along, small, tied)
    if left is None or left_at_end is None:
        return None
    inside = one.between(known[:, 0], begin, end)
    inside &= other.between(known[:, 1], *((its_begin, its_end) if along else (its_end, its_begin)))
    return bool((inside.sum() + (left != left_at_end)) % 2)


class Strand:
    """A contour along which one walks."""

    def __init__(self, cubics: FloatArray) -> None:
        self.cubics = cubics

    @cached_property
    def lengths(self) -> FloatArray:
        """(PLACES m + 1,) of the contour up to even places, by chords."""
        points = np.einsum("kt,mkc->mtc", bernstein(PLACES), self.cubics)
        chords = np.hypot(*np.moveaxis(np.diff(points, axis=1), 2, 0))
        return np.concatenate([[0.0], np.cumsum(chords)])

    @property
    def total(self) -> float:
        """The length of the contour."""
        return float(self.lengths[-1])

    def positions(self, places: FloatArray) -> FloatArray:
        """Lengths along the contour up to places (k,), by chords."""
        found: FloatArray = np.interp(places * PLACES, np.arange(len(self.lengths)), self.lengths)
        return found

    def way(self, place: float, to: float) -> float:
        """The shorter way between two places as positions count it, negative if it runs back."""
        if place == to:
            return 0.0
        begin, end = self.positions(np.array([place, to])).tolist()
        return float((end - begin + self.total / 2) % self.total - self.total / 2)

    def at(self, place: float) -> complex:
        """The point at a place."""
        s = min(int(place), len(self.cubics) - 1)
        x, y, *_ = jet(self.cubics, s, place - s)
        return complex(x, y)

    def between(self, places: FloatArray, begin: float, end: float) -> BoolArray:
        """(k,) which places (k,) one passes on the way from one place forward to another one."""
        found: BoolArray = (places - begin) % len(self.cubics) <= (end - begin) % len(self.cubics)
        return found

    def reach(self, place: float, to: float, enough: float) -> float:
        """How far the contour goes from a place on the shorter way to another one, to points of each piece: exact if it
        is less than ``enough``."""
        if (apart := abs(self.at(to) - self.at(place))) >= enough:
            return apart
        low, high = (place, to) if self.way(place, to) >= 0 else (to, place)
        high += len(self.cubics) * (high < low)
        ends = np.array([low, *range(int(low) + 1, int(np.ceil(high))), high])
        pieces = ends[:-1].astype(np.int64)
        x = ends[:-1, None] - pieces[:, None] + np.diff(ends)[:, None] * np.linspace(0, 1, PLACES + 1)
        chain = self.cubics[np.repeat(pieces % len(self.cubics), PLACES + 1)]
        points = evaluate(chain, x.ravel())
        return float(np.hypot(*(points - points[0]).T).max())


@compiled
def leaving(
    cubics: FloatArray, centre: float, place: float, forward: bool, radius: float, other: FloatArray
) -> tuple[float, float]:
    """The angle at which a closed chain leaves a circle, from a place on, and where.

    It goes in steps after which it cannot have left yet, by its speed and the most that this changes.

    Args:
        centre: the circle's, as a place of the chain ``other``.
    """
    s = min(int(centre), len(other) - 1)
    cx, cy, _, _, _, _ = jet(other, s, centre - s)
    m, s = len(cubics), min(int(place), len(cubics) - 1)
    t, end, way = place - s, 1.0 if forward else 0.0, 1 if forward else -1
    for _ in range(m + STEPS):
        x, y, dx, dy, _, _ = jet(cubics, s, t)
        left = radius - length(x - cx, y - cy)
        if left <= 1e-12 * radius:
            break
        change = 0.0
        for k in range(2):
            ax = cubics[s, k, 0] - 2 * cubics[s, k + 1, 0] + cubics[s, k + 2, 0]
            ay = cubics[s, k, 1] - 2 * cubics[s, k + 1, 1] + cubics[s, k + 2, 1]
            change = max(change, 6 * length(ax, ay))
        speed = length(dx, dy)
        t += way * 2 * left / max(speed + np.sqrt(speed * speed + 2 * change * left), 1e-300)
        if way * (t - end) >= 0:
            s, t = (s + way) % m, 1.0 - end
    return np.arctan2(y - cy, x - cx), s + t


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


def _contacts(touching: FloatArray, one: Strand, other: Strand, radius: float) -> list[_Contact]:
    """Pairs of chords that hang together; see :func:`all_crossings`."""
    if len(touching) == 1:
        ((a, b, a_end, b_end),) = touching.tolist()
        return [_Contact((a, b), (a_end, b_end), a_end, [])]
    ordered = touching[np.lexsort(touching.T[::-1])]
    apart = (np.abs(ordered[1:, :2] - ordered[:-1, 2:]) > 1e-12).any(axis=1)  # else one goes on where another one ends
    starts = np.concatenate([[0], 1 + np.flatnonzero(apart)])
    ordered = np.concatenate([ordered[starts, :2], ordered[np.append(starts[1:], 0) - 1, 2:]], axis=1)
    along = [one.positions(ordered[:, k]) for k in (0, 2)]
    across = [other.positions(ordered[:, k]) for k in (1, 3)]
    total = other.total
    found: list[_Contact] = []
    still: list[_Contact] = []  # those that later pairs may hang on
    for (a, b, a_end, b_end), s, s_end, *beside in zip(
        ordered.tolist(), *(x.tolist() for x in (*along, *across)), strict=True
    ):
        still = [contact for contact in still if s - contact.position <= radius]
        for contact in reversed(still):
            # From the last ends of chords of a contact that the next pair of chords may hang on.
            away = (abs(x - y) % total for x in beside for y in contact.beside[-8:])
            if any(gap <= radius or total - gap <= radius for gap in away):
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


def _exit(
    one: Strand, a: float, other: Strand, b: float, forward: bool, other_forward: bool, radius: float, tied: float
) -> tuple[float, float, bool | None]:
    """Where strands leave the circle around an end of a contact, places a and b, forward or backward.

    Returns:
        The places of both contours; whether the second one is to the left of the first one, as this runs, or None if
        they leave together.
    """
    (ahead, own), (back, behind) = (leaving(one.cubics, a, a, way, radius, one.cubics) for way in (True, False))
    leaves, its = leaving(other.cubics, a, b, other_forward, radius, one.cubics)
    whole = 2 * np.pi
    ties = any(abs((leaves - x + np.pi) % whole - np.pi) <= tied for x in (ahead, back))
    left = None if ties else bool((leaves - ahead) % whole < (back - ahead) % whole)
    return own if forward else behind, its, left
