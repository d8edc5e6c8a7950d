"""Contours in which points go, or change their order: short segments, straight curves, wrong directions."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np

from ...curves.bezier import cross, split
from ...outlines.masters import MasterContour
from ...types import FloatArray, IntArray
from .joints import starts_of

SHARES = (1.0, 0.0, 0.5, np.nan)
"""Where on a short segment its two ends become one: at its end, at its beginning, midway, or where its neighbours'
tangents meet."""


class Carried(Enum):
    """What handles do where a short segment goes: the curve is drawn on to its new end, or its handle moves with it."""

    ON = 0
    WITH = 1
    NOT = 2


@dataclass(frozen=True, eq=False)
class Edited:
    """A contour and what it was.

    Attributes:
        contour: as it is now. segments: (m,) the number that each segment had. places: (m,) where it begins, as places
            on the contour as it was: number and local parameter. reversed: whether it runs the other way now; numbers
            and places are then those of the reversed contour. repeats: (m,) points that are there more than once.
    """

    contour: MasterContour
    segments: IntArray
    places: FloatArray
    repeats: IntArray
    reversed: bool = False

    @classmethod
    def of(cls, contour: MasterContour, repeats: IntArray) -> Edited:
        """A contour as it is."""
        every = np.arange(len(contour))
        return cls(contour, every, every.astype(np.float64), repeats)

    @property
    def num_points(self) -> int:
        """Of its points, those that are there more than once among them."""
        return int(self.contour.points.shape[1] + self.repeats.sum())

    def number(self, segment: int) -> int | None:
        """The number now of a segment by its old one; None if it is gone."""
        found = np.flatnonzero(self.segments == segment)
        return int(found[0]) if len(found) else None

    def anchors(self, count: int) -> FloatArray:
        """(m + 1, 2) places of the contour now and as it was, with ``count`` segments, that belong together."""
        before = self.places + count * (self.places < self.places[0])
        return np.column_stack([np.arange(len(before) + 1.0), np.append(before, before[0] + count)])


def single(edited: Edited, segment: int) -> Iterator[Edited]:
    """A point that is there once, of several in one place."""
    repeats = edited.repeats.copy()
    repeats[segment] = 0
    yield replace(edited, repeats=repeats)


def as_line(edited: Edited, segment: int) -> Iterator[Edited]:
    """A line in the place of a curve."""
    contour = edited.contour
    at, degrees = starts_of(contour)[segment], contour.degrees.copy()
    points = np.delete(contour.points, np.arange(at + 1, at + degrees[segment]), axis=1)
    degrees[segment] = 1
    yield replace(edited, contour=MasterContour(points, degrees))


def without(edited: Edited, segment: int) -> Iterator[Edited]:
    """The contour without a segment, whose two ends become one; handles there move with their end, or stay."""
    contour = edited.contour
    m = len(contour)
    if m < 3:
        return
    order = (np.arange(m) + segment) % m  # the segment first, so that the next one begins at its end
    degrees = contour.degrees[order]
    points = np.roll(contour.points, -int(starts_of(contour)[segment]), axis=1)
    first, last = points[:, 0], points[:, degrees[0]]
    kept = points[:, degrees[0] :]
    # Control points of the curves on both sides, from the short segment on, and the share at which each is drawn on.
    sides = [(-np.arange(1, degrees[-1] + 1), first, 1.0), (np.arange(1, degrees[1] + 1), last, 0.0)]
    curves = [side for side in sides if len(side[0]) > 1]
    meeting = np.round(met(first, first - kept[:, -1], last, last - kept[:, 1]))
    for way in Carried if curves else (Carried.NOT,):
        for share in SHARES:
            middle = {0.0: first, 1.0: last, 0.5: np.round((first + last) / 2)}.get(share, meeting)
            new = kept.copy()
            new[:, 0] = middle
            for numbers, end, on in curves if way is not Carried.NOT else ():
                chain = np.concatenate([end[:, None], kept[:, numbers]], axis=1)
                if way is Carried.ON and share == on:
                    chain = drawn_on(chain, middle)
                chain[:, 1] += middle - chain[:, 0]
                new[:, numbers[:-1]] = np.round(chain[:, 1:-1]) if way is Carried.ON else chain[:, 1:-1]
            # The one before ends where the segment ended, the one behind begins where it began, or both midway.
            places = edited.places[order[1:]].copy()
            if share == 0:
                places[0] = edited.places[order[0]]
            numbers, repeats = edited.segments[order[1:]], edited.repeats[order[1:]]
            at = int(numbers.argmin())
            shift = -int(degrees[1 : 1 + at].sum())
            rolled = MasterContour(np.roll(new, shift, axis=1), np.roll(degrees[1:], -at))
            yield replace(
                edited, contour=rolled, segments=np.roll(numbers, -at), places=np.roll(places, -at),
                repeats=np.roll(repeats, -at),
            )  # fmt: skip


def met(a: FloatArray, u: FloatArray, b: FloatArray, v: FloatArray) -> FloatArray:
    """(K, 2) where lines from places a along u and from b along v meet; a where they are parallel."""
    both, across = cross(u, v)[:, None], cross(b - a, v)[:, None]
    found: FloatArray = a + np.where(both == 0, 0.0, across / np.where(both == 0, 1.0, both)) * u
    return found


def drawn_on(chain: FloatArray, to: FloatArray) -> FloatArray:
    """Quadratics or cubics (K, n, 2) that begin as far before their beginning as the places (K, 2) are."""
    way = (len(chain[0]) - 1) * (chain[:, 1] - chain[:, 0])
    speed = (way * way).sum(axis=1)
    t = ((to - chain[:, 0]) * way).sum(axis=1) / np.where(speed > 0, speed, 1.0)
    return split(chain, t[:, None, None])[1]


def turned_round(edited: Edited, segment: int) -> Iterator[Edited]:
    """The contour in the opposite direction, from the same point."""
    if edited.reversed:
        return
    m = len(edited.contour)
    if len(edited.segments) and (edited.segments != np.arange(m)).any():
        return  # in a contour that has lost points already, the rest stays
    repeats = np.concatenate([edited.repeats[:1], edited.repeats[:0:-1]])
    yield replace(edited, contour=edited.contour.reversed(), repeats=repeats, reversed=True)


EDITED = {"repeated": single, "straight": as_line, "short": without, "direction": turned_round}
"""How findings of a kind are mended by fewer points, or points in another order."""
