"""The landmarks of a contour, by which unlike masters of a glyph recognise each other: corners, extrema, smooth joints.

A *place* j + x on a contour is local parameter x of its segment j; places count on past the number of segments.
"""

from __future__ import annotations

import numpy as np

from ..curves.bezier import evaluate
from ..curves.cubics import bernstein
from ..outlines.extrema import extremal_places
from ..outlines.outline import Contour
from ..outlines.sampling import CORNER_ANGLE
from ..types import BoolArray, FloatArray, IntArray

STEPS = 16
"""Steps a segment of the tables of length and turn."""

_T = np.arange(STEPS + 1) / STEPS
SLOPES = np.array([(1 - _T) ** 2, 2 * _T * (1 - _T), _T**2])
"""(3, STEPS + 1) the quadratic Bernstein polynomials, of the derivative of a cubic, at the steps."""

FULL_TURN = 60.0
"""Degrees of turn from which a corner is as weighty as a corner can be."""

CORNER = (0.4, 1.0)
"""Weight of a corner of the least turn, and of a full one."""

EXTREMUM, STRAIGHT_END, DRAWN_END, BREAK = 0.3, 0.25, 0.2, 0.15
"""Weights of joints that turn by less: at a horizontal or vertical tangent; where a straight line ends; between a line
and a cubic or quadratic, though it may be straight; where the curvature jumps. The rest, such as a point that someone
inserted, have none."""

STRONG = 0.3
"""Weight from which landmarks take part in the search for the surest pair."""

STRAIGHT = 2.0
"""Degrees of turn up to which a segment is straight."""

SHOWS, REACH = 12.0, 0.06
"""Degrees of turn from which the end of a line or a jump of curvature has its full weight; of a jump those within so
much of the em."""

CURVED = 5.0
"""Degrees of turn from which a segment is curved enough to have an extremum of its own."""

HEIGHT = 2e-3
"""Of the em: the height by which a contour rises to an extremum and falls again."""

CHORD = 5e-3
"""Of the em: length of the chords whose directions are those on both sides of a landmark; less where a segment ends."""

ROUNDING = 0.7
"""Units by which the direction of a handle may be off at its end: coordinates are often rounded to units."""

NEAR, TILT = (6e-3, 15e-3), 2.5
"""Of the em: a smooth joint nearer than the first to an extremum stands for it, and one nearer than the second if its
tangent is within so many degrees of that at the extremum."""


class Landmarks:
    """A closed contour with tables of its length and turn, and its landmarks.

    Attributes:
        contour: without segments of no length. cubics: (m, 4, 2) its segments.
        places: (n,) of the landmarks, ascending; all joints are among them, and the extrema between joints.
        weights: (n,) what it costs to leave a landmark without a partner; 0 for joints that nothing distinguishes.
        points: (n, 2). before, after: (n,) direction on both sides, in radians, unwrapped: it tells how far the contour
            turned from its start. lengths: (n,) along the contour, as parts of its whole length.
    """

    def __init__(self, contour: Contour, em: float) -> None:
        self.contour = lasting_segments(contour)
        self.cubics = cubics = self.contour.cubics()
        self.em = em
        m = len(cubics)
        samples = np.einsum("ks,mkc->msc", bernstein(STEPS), cubics)
        chords = np.diff(samples, axis=1)
        ways = np.einsum("ks,mkc->msc", SLOPES, np.diff(cubics, axis=1))
        ways[:, 0], ways[:, -1] = first_direction(cubics), first_direction(-cubics[:, ::-1])
        angles = np.arctan2(ways[..., 1], ways[..., 0])
        bends = wrapped(np.diff(angles, axis=1))
        self.turns = wrapped(angles[:, 0] - np.roll(angles[:, -1], 1))
        self.bent: FloatArray = np.abs(bends).sum(axis=1)
        steps = np.zeros((m, STEPS + 1, 3))
        steps[:, 1:, 0] = np.hypot(chords[..., 0], chords[..., 1])
        steps[:, 1:, 1], steps[:, 1:, 2] = bends, np.abs(bends)
        steps[1:, 0, 1] += self.turns[1:]
        steps[1:, 0, 2] += np.abs(self.turns[1:])
        rows = steps.reshape(-1, 3).cumsum(axis=0)
        lap = rows[-1] + (0.0, self.turns[0], abs(self.turns[0]))
        self.length: float = rows[-1, 0]
        self.lap_turn: float = lap[1]
        rows[:, 1] += angles[0, 0]
        at = (np.arange(m)[:, None] + np.arange(STEPS + 1) / STEPS).ravel()
        self._at: FloatArray = np.concatenate([at - m, at, at + m, at + 2 * m])
        self._rows: FloatArray = np.concatenate([rows - lap, rows, rows + lap, rows + 2 * lap])
        self._find()

    def _find(self) -> None:
        m = len(self.cubics)
        joints = np.arange(float(m))
        degrees = np.degrees(np.maximum(np.abs(self.turns) - self._doubts(), 0.0))
        share = np.clip((degrees - CORNER_ANGLE) / (FULL_TURN - CORNER_ANGLE), 0, 1)
        corner: BoolArray = degrees >= CORNER_ANGLE
        straight = (self.contour.degrees == 1) | (np.degrees(self.bent) < STRAIGHT)
        line = self.contour.degrees == 1
        smooth = np.where(straight != np.roll(straight, 1), STRAIGHT_END * self._ends(), BREAK * self._jumps())
        smooth = np.maximum(smooth, np.where(line != np.roll(line, 1), DRAWN_END, 0.0))
        weights = np.where(corner, CORNER[0] + (CORNER[1] - CORNER[0]) * share, smooth)
        table = self.rows(joints)[:, 0]
        places = []
        curved = self.bent >= np.radians(CURVED)
        for k in (0, 1):
            tilt = np.abs(np.sin(self.rows(joints)[:, 1] + (np.pi / 2 if k == 0 else 0.0)))
            for place in extremal_places(self.cubics[..., k], HEIGHT * self.em):
                along = (self.rows(np.array([place]))[0, 0] - table + self.length / 2) % self.length - self.length / 2
                away = np.abs(along)
                stands = (away < NEAR[0] * self.em) | ((away < NEAR[1] * self.em) & (tilt < np.sin(np.radians(TILT))))
                if stands.any():
                    nearest = int(np.argmin(np.where(stands, away, np.inf)))
                    if not corner[nearest] and curved[nearest] and curved[nearest - 1]:
                        weights[nearest] = max(EXTREMUM, weights[nearest])
                elif curved[int(place)]:
                    places.append(place)
        every = np.concatenate([joints, places])
        order = np.argsort(every, kind="stable")
        self.places: FloatArray = every[order]
        self.weights: FloatArray = np.concatenate([weights, np.full(len(places), EXTREMUM)])[order]
        self.points: FloatArray = self.at(self.places)
        self.before, self.after = self._directions()
        self.lengths: FloatArray = self.rows(self.places)[:, 0] / self.length

    def _directions(self) -> tuple[FloatArray, FloatArray]:
        """Directions before and after each landmark, of chords: a short handle, off by a unit, points anywhere."""
        here, found = self.rows(self.places)[:, 0], []
        for side, ends in ((-1, np.ceil(self.places) - 1), (1, np.floor(self.places) + 1)):
            stop = self.rows(ends)[:, 0] - here
            along = here + side * np.minimum(CHORD * self.em, np.abs(stop))
            step = side * (self.at(np.interp(along, self._rows[:, 0], self._at)) - self.points)
            direction = self.rows(self.places, before=side < 0)[:, 1]
            turned = wrapped(np.arctan2(step[:, 1], step[:, 0]) - direction)
            found.append(direction + np.where(step.any(axis=1), turned, 0.0))
        return found[0], found[1]

    def _doubts(self) -> FloatArray:
        """(m,) radians of the turn at each joint that rounded coordinates may have made."""
        arms = [np.hypot(*first_direction(cubics).T) for cubics in (self.cubics, self.cubics[:, ::-1])]
        one, other = (np.arctan2(ROUNDING, arm) for arm in arms)
        return one + np.roll(other, 1)

    def _ends(self) -> FloatArray:
        """(m,) how much one of the segments at each joint bends more, in the mean, than the other: 0 to 1."""
        spans = np.diff(self.rows(np.arange(len(self.cubics) + 1.0))[:, 0])
        means = np.stack([self.bent / spans, np.roll(self.bent / spans, 1)])
        most = np.where(means[0] > means[1], self.bent, np.roll(self.bent, 1))
        contrast = 1 - means.min(axis=0) / np.maximum(means.max(axis=0), 1e-12)
        return contrast * np.minimum(np.degrees(most) / SHOWS, 1.0)

    def _jumps(self) -> FloatArray:
        """(m,) how much the curvature jumps at each joint: 0 to 1, of the larger one and of what shows."""
        first, last = _curvatures(self.cubics), -_curvatures(self.cubics[:, ::-1])
        one, other = np.roll(last, 1), first
        largest = np.maximum(np.abs(one), np.abs(other))
        spans = np.diff(self.rows(np.arange(len(self.cubics) + 1.0))[:, 0])
        shown = largest * np.minimum(np.minimum(spans, np.roll(spans, 1)), REACH * self.em) / np.radians(SHOWS)
        relative = np.abs(other - one) / np.where(largest > 0, largest, 1.0)
        return np.minimum(relative, 1.0) * np.minimum(shown, 1.0)

    def __len__(self) -> int:
        return len(self.places)

    @property
    def corners(self) -> IntArray:
        """Indices of the landmarks that are corners."""
        return np.flatnonzero(self.weights >= CORNER[0])

    def at(self, places: FloatArray) -> FloatArray:
        """(k, 2) points at places."""
        segments = np.floor(places).astype(np.int64)
        return evaluate(self.cubics[segments % len(self.cubics)], places - segments)

    def rows(self, places: FloatArray, *, before: bool = False) -> FloatArray:
        """(k, 3) length from the start, signed turn and sum of absolute turns at places; at joints after their turn."""
        i = np.searchsorted(self._at, places, side="left" if before else "right") - 1
        i = np.clip(i, 0, len(self._at) - 2)
        low, high = self._at[i], self._at[i + 1]
        share = np.where(high > low, (places - low) / np.where(high > low, high - low, 1.0), 1.0 * before)
        return self._rows[i] + share[:, None] * (self._rows[i + 1] - self._rows[i])

    def table(self, which: IntArray) -> FloatArray:
        """(k, 4) weight, length and directions of landmarks, as :func:`.alignment.cheapest_pairs` takes them."""
        return np.stack([self.weights, self.lengths, self.before, self.after], axis=1)[which]

    def lap_places(self, which: IntArray) -> FloatArray:
        """The places of landmarks whose indices count on past their number."""
        return self.places[which % len(self)] + which // len(self) * len(self.cubics)

    def between(self, start: float, end: float) -> tuple[FloatArray, FloatArray]:
        """Places from ``start`` to ``end``, with both, and their rows, (k,) and (k, 3): the table's, joints twice."""
        low, high = np.searchsorted(self._at, start, side="right"), np.searchsorted(self._at, end, side="left")
        head, tail = self.rows(np.array([start])), self.rows(np.array([end]), before=True)
        at = np.concatenate([[start], self._at[low:high], [end]])
        return at, np.concatenate([head, self._rows[low:high], tail])


def lasting_segments(contour: Contour) -> Contour:
    """The contour without its segments of no length."""
    cubics = contour.cubics()
    lasting = (cubics[:, 1:] != cubics[:, :1]).any(axis=(1, 2))
    if lasting.all():
        return contour
    return Contour.from_segments(
        segment for segment, keep in zip(contour.segments(), lasting.tolist(), strict=True) if keep
    )


def first_direction(cubics: FloatArray) -> FloatArray:
    """(m, 2) from the first point of each cubic (m, 4, 2) to the nearest control point that is another."""
    arms = cubics[:, 1:] - cubics[:, :1]
    first = (arms != 0).any(axis=2).argmax(axis=1)
    return arms[np.arange(len(cubics)), first]


def _curvatures(cubics: FloatArray) -> FloatArray:
    """(m,) signed curvature where each cubic begins; 0 where it begins without speed."""
    d = cubics[:, 1] - cubics[:, 0]
    e = cubics[:, 2] - cubics[:, 0]
    speed = np.hypot(d[:, 0], d[:, 1])
    safe = np.where(speed > 0, speed, 1.0)
    return np.where(speed > 0, (d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0]) / safe**3 * 2 / 3, 0.0)


def wrapped(angles: FloatArray) -> FloatArray:
    """Angles brought to -π … π."""
    return (angles + np.pi) % (2 * np.pi) - np.pi
