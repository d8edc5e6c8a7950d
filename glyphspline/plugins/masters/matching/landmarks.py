"""The landmarks of a contour, by which unlike masters of a glyph recognise each other: corners, extrema, smooth joints.

A *place* j + x on a contour is local parameter x of its segment j; places count on past the number of segments.
"""

from __future__ import annotations

import numpy as np

from ....curves.comb import end_curvatures
from ....curves.cubics import bernstein
from ....outlines.outline import Contour
from ....outlines.sampling import CORNER_ANGLE
from ....outlines.segments import lasting
from ....types import BoolArray, FloatArray, IntArray
from ...fonts.extrema import extremal_places

STEPS = 16
"""Steps a segment of the tables of length and turn."""

_T = np.arange(STEPS + 1) / STEPS
SLOPES = np.array([(1 - _T) ** 2, 2 * _T * (1 - _T), _T**2])
"""(3, STEPS + 1) the quadratic Bernstein polynomials, of the derivative of a cubic, at the steps."""

CORNER = (0.4, 1.0)
"""Weight of a corner of the least turn, and of a full one."""

EXTREMUM, STRAIGHT_END, DRAWN_END, BREAK = 0.3, 0.25, 0.2, 0.15
"""Weights of joints that turn by less: at a horizontal or vertical tangent; where a straight line ends; between a line
and a cubic or quadratic, though it may be straight; where the curvature jumps. The rest, such as a point that someone
inserted, have none."""

STRONG = 0.3
"""Weight from which landmarks take part in the search for the surest pair."""

SHOWS, REACH = 12.0, 0.06
"""Degrees of turn from which the end of a line or a jump of curvature has its full weight; of a jump those within so
much of the em."""

HEIGHT, CHORD = 2e-3, 5e-3
"""Of the em: the height by which a contour rises to an extremum and falls again. Of the em: length of the chords whose
directions are those on both sides of a landmark; less where a segment ends."""

NEAR, TILT = (6e-3, 15e-3), 2.5
"""Of the em: a smooth joint nearer than the first to an extremum stands for it, and one nearer than the second if its
tangent is within ``TILT`` degrees of that at the extremum."""


class Landmarks:
    """A closed contour with tables of its length and turn, and its landmarks.

    Attributes:
        contour: without segments of no length. cubics: (m, 4, 2) its segments.
        places: (n,) of the landmarks, ascending; all joints are among them, and the extrema between joints.
        weights: (n,) what it costs to leave a landmark without a partner; 0 for joints that nothing distinguishes.
        points: (n, 2). before, after: (n,) direction on both sides, in radians, unwrapped: it tells how far the contour
            turned from its start.
    """

    def __init__(self, contour: Contour, em: float) -> None:
        lasts = np.isin(np.arange(len(contour)), lasting(contour.cubics()[None]))
        self.contour = Contour(contour.points[np.repeat(lasts, contour.degrees)], contour.degrees[lasts])
        self.cubics = cubics = self.contour.cubics()
        self.em = em
        m = len(cubics)
        chords = np.diff(np.einsum("ks,mkc->msc", bernstein(STEPS), cubics), axis=1)
        ways = np.einsum("ks,mkc->msc", SLOPES, np.diff(cubics, axis=1))
        ways[:, 0], ways[:, -1] = arms = _first_arm(cubics), _first_arm(-cubics[:, ::-1])
        angles = np.arctan2(ways[..., 1], ways[..., 0])
        bends = wrapped(np.diff(angles, axis=1))
        self._turns: FloatArray = wrapped(angles[:, 0] - np.roll(angles[:, -1], 1))
        self._bent: FloatArray = np.abs(bends).sum(axis=1)
        steps = np.zeros((m, STEPS + 1, 2))
        steps[:, 1:, 0] = np.hypot(chords[..., 0], chords[..., 1])
        steps[:, 1:, 1] = bends
        steps[1:, 0, 1] += self._turns[1:]
        rows = steps.reshape(-1, 2).cumsum(axis=0)
        lap = rows[-1] + (0.0, self._turns[0])
        self.length, self._lap_turn = lap.tolist()
        rows[:, 1] += angles[0, 0]
        at = (np.arange(m)[:, None] + np.arange(STEPS + 1) / STEPS).ravel()
        self._at: FloatArray = np.concatenate([at - m, at, at + m, at + 2 * m])
        self._rows: FloatArray = np.concatenate([rows - lap, rows, rows + lap, rows + 2 * lap])
        self._find(*arms)

    def _find(self, first_arms: FloatArray, last_arms: FloatArray) -> None:
        m, line = len(self.cubics), self.contour.degrees == 1
        joints = np.arange(float(m))
        # Units by which the direction of a handle may be off at its end: coordinates are often rounded to units.
        one, other = (np.arctan2(0.7, np.hypot(*arms.T)) for arms in (first_arms, last_arms))
        degrees = np.degrees(np.maximum(np.abs(self._turns) - one - np.roll(other, 1), 0.0))
        corner: BoolArray = degrees >= CORNER_ANGLE
        # Degrees of turn from which a corner is as weighty as a corner can be.
        share = np.clip((degrees - CORNER_ANGLE) / (60.0 - CORNER_ANGLE), 0, 1)
        # Degrees of turn up to which a segment is straight.
        straight = line | (np.degrees(self._bent) < 2.0)
        end, jump = self._breaks()
        smooth = np.where(straight != np.roll(straight, 1), STRAIGHT_END * end, BREAK * jump)
        smooth = np.maximum(smooth, np.where(line != np.roll(line, 1), DRAWN_END, 0.0))
        weights = np.where(corner, CORNER[0] + (CORNER[1] - CORNER[0]) * share, smooth)
        table, directions = self.rows(joints).T
        places = []
        # Degrees of turn from which a segment is curved enough to have an extremum of its own.
        curved = self._bent >= np.radians(5.0)
        for k in (0, 1):
            tilt = np.abs(np.sin(directions + (np.pi / 2 if k == 0 else 0.0)))
            for place in extremal_places(self.cubics[..., k], HEIGHT * self.em):
                along = (self.rows(np.array([place]))[0, 0] - table + self.length / 2) % self.length - self.length / 2
                away = np.abs(along)
                near = (away < NEAR[0] * self.em) | ((away < NEAR[1] * self.em) & (tilt < np.sin(np.radians(TILT))))
                if near.any():
                    nearest = int(np.argmin(np.where(near, away, np.inf)))
                    if not corner[nearest] and curved[nearest] and curved[nearest - 1]:
                        weights[nearest] = max(EXTREMUM, weights[nearest])
                elif curved[int(place)]:
                    places.append(place)
        every = np.concatenate([joints, places])
        order = np.argsort(every, kind="stable")
        self.places: FloatArray = every[order]
        self.weights: FloatArray = np.concatenate([weights, np.full(len(places), EXTREMUM)])[order]
        self.points: FloatArray = self.contour.at(self.places)
        self.before, self.after = self._direction(-1), self._direction(1)

    def _direction(self, side: int) -> FloatArray:
        """Directions before or after each landmark, of chords: a short handle, off by a unit, points anywhere."""
        here = self.rows(self.places)[:, 0]
        ends = np.where(side < 0, np.ceil(self.places), np.floor(self.places)) + side
        along = here + side * np.minimum(CHORD * self.em, np.abs(self.rows(ends)[:, 0] - here))
        step = side * (self.contour.at(np.interp(along, self._rows[:, 0], self._at)) - self.points)
        direction = self.rows(self.places, before=side < 0)[:, 1]
        turned = wrapped(np.arctan2(step[:, 1], step[:, 0]) - direction)
        return direction + np.where(step.any(axis=1), turned, 0.0)

    def _breaks(self) -> tuple[FloatArray, FloatArray]:
        """How much breaks at each joint, 0 to 1.

        (m,) how much one of its segments bends more, in the mean, than the other; (m,) how much the curvature jumps, of
        the larger one and of what shows.
        """
        spans = np.diff(self.rows(np.arange(len(self.cubics) + 1.0))[:, 0])
        mean = self._bent / spans
        before = np.roll(mean, 1)
        most = np.where(mean > before, self._bent, np.roll(self._bent, 1))
        contrast = 1 - np.minimum(mean, before) / np.maximum(np.maximum(mean, before), 1e-12)
        curvature = np.nan_to_num(end_curvatures(self.cubics), nan=0.0, posinf=0.0, neginf=0.0)
        after, before = curvature[:, 0], np.roll(curvature[:, 1], 1)
        largest = np.maximum(np.abs(after), np.abs(before))
        shown = largest * np.minimum(np.minimum(spans, np.roll(spans, 1)), REACH * self.em) / np.radians(SHOWS)
        relative = np.abs(after - before) / np.where(largest > 0, largest, 1.0)
        return contrast * np.minimum(np.degrees(most) / SHOWS, 1.0), np.minimum(relative, 1.0) * np.minimum(shown, 1.0)

    def __len__(self) -> int:
        return len(self.places)

    @property
    def corners(self) -> IntArray:
        """Indices of the landmarks that are corners."""
        return np.flatnonzero(self.weights >= CORNER[0])

    def rows(self, places: FloatArray, *, before: bool = False) -> FloatArray:
        """(k, 2) length and turn from the start at places; at joints after their turn, or before it."""
        i = np.searchsorted(self._at, places, side="left" if before else "right") - 1
        i = np.clip(i, 0, len(self._at) - 2)
        low, high = self._at[i], self._at[i + 1]
        share = np.where(high > low, (places - low) / np.where(high > low, high - low, 1.0), 1.0 * before)
        return self._rows[i] + share[:, None] * (self._rows[i + 1] - self._rows[i])

    def table(self, which: IntArray) -> FloatArray:
        """(2k, 4) weight, length and directions of landmarks in two laps, for :func:`.alignment.cheapest_pairs`."""
        lengths = self.rows(self.places)[:, 0] / self.length
        rows = np.stack([self.weights, lengths, self.before, self.after], axis=1)[which]
        return np.concatenate([rows, rows + np.array([0.0, 1.0, self._lap_turn, self._lap_turn])])

    def lap(self, first: int) -> tuple[FloatArray, FloatArray]:
        """Places once around from a landmark, and the lengths up to them: those of the table, joints twice."""
        start = self.places[first : first + 1]
        end = start + len(self.cubics)
        low, high = np.searchsorted(self._at, start[0], side="right"), np.searchsorted(self._at, end[0], side="left")
        lengths = [self.rows(start)[:, 0], self._rows[low:high, 0], self.rows(end, before=True)[:, 0]]
        return np.concatenate([start, self._at[low:high], end]), np.concatenate(lengths)


def _first_arm(cubics: FloatArray) -> FloatArray:
    """(m, 2) from the first point of each cubic (m, 4, 2) to the nearest control point that is another."""
    arms = cubics[:, 1:] - cubics[:, :1]
    first = (arms != 0).any(axis=2).argmax(axis=1)
    return arms[np.arange(len(cubics)), first]


def wrapped(angles: FloatArray) -> FloatArray:
    """Angles brought to -π … π."""
    return (angles + np.pi) % (2 * np.pi) - np.pi
