"""The lines and arcs of a glyph's new contours, each of which may stay as the font has it.

An arc from joint to joint of the source takes the place of some of the source's segments. Where it would turn a joint
that the source does not turn, or needs more points, the next candidate for it is taken, and in the end these segments
themselves: a glyph drawn anew has no kink that its source has not, at any location.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from ...fitting.first_good import first_good
from ...outlines.flaws.kinds import THRESHOLDS
from ...outlines.flaws.turns import joint_controls, turns_of
from ...outlines.masters import MasterContour, Masters
from ...types import BoolArray, FloatArray, IntArray
from .kinks import kinks_along
from .on_axes import kinks_of
from .redrawn import Redrawn

NEAR = 1e-3
"""Distance in font units up to which points are one: curves come back from their fit as exact as numbers are."""

NOTHING_NEW = "none of its arcs can be drawn anew without a kink or more points"
"""Why a glyph keeps its outline."""


class Turning:
    """Where a glyph turns between its lines and arcs: at joints that are a corner in no master.

    Attributes:
        joints: (n, 2) contour and segment of those that turn, whatever the reason, along an axis or at
            :func:`.locations`. places: (n, K, 2) where they are. turns: (n,) their largest turns, in degrees.
    """

    def __init__(self, masters: Masters) -> None:
        moving = np.flatnonzero((masters.regions[:, :, 1] != 0).any(axis=0)).tolist() or [0]
        along = kinks_along([masters], masters.axes, {}, moving, THRESHOLDS.corner_angle)
        largest: dict[tuple[int, int], float] = {}
        for each in along:
            for (_, c, s), turn in zip(each.joints.tolist(), each.turns.tolist(), strict=True):
                largest[c, s] = max(largest.get((c, s), 0.0), turn)
        weights = masters.weights_at(locations(masters))
        starts: dict[tuple[int, int], FloatArray] = {}
        for c, contour in enumerate(masters.contours):
            controls = joint_controls(contour)
            turns = np.nan_to_num(np.abs(turns_of(np.tensordot(weights, controls, axes=1)))).max(axis=0)
            for s, turn in enumerate(turns.tolist()):
                starts[c, s] = controls[:, s, 0, 0]
                if (c, s) in largest:
                    largest[c, s] = max(largest[c, s], turn)
        chosen = [joint for joint, turn in sorted(largest.items()) if turn >= THRESHOLDS.kink]
        self.joints = chosen
        self.turns = np.array([largest[joint] for joint in chosen])
        self.places = np.array([starts[joint] for joint in chosen]).reshape(len(chosen), len(masters), 2)
        self._seen = lambda: kinks_of([masters], {}, moving, along, THRESHOLDS)

    @cached_property
    def reported(self) -> dict[tuple[int, int], float]:
        """The joints that ``check`` reports, and by how much they turn more between masters than in them."""
        if not self.joints:
            return {}
        seen, made = self._seen(), dict[tuple[int, int], tuple[float, float]]()
        rows = zip(seen.contours.tolist(), seen.segments.tolist(), *seen.numbers[:, 1:3].T.tolist(), strict=True)
        for c, s, turn, more in rows:
            made[c, s] = max(made.get((c, s), (0.0, 0.0)), (turn, more))
        return {joint: more for joint, (_, more) in made.items()}

    def not_in(self, source: Turning) -> list[tuple[int, int]]:
        """Contour and segment of the joints that do not turn so in the source, or are not reported there."""
        found, known = [], np.array([joint in source.reported for joint in source.joints], dtype=np.bool_)
        for joint, place, turn in zip(self.joints, self.places, self.turns.tolist(), strict=True):
            # Distance in font units, in every master, up to which a joint is the source's: rounding moves it by half a
            # unit.
            near = np.abs(source.places - place).max(axis=(1, 2), initial=0.0) <= 1.0
            # Degrees by which a joint may turn more than the source's before another candidate is taken.
            alike = near & (source.turns >= turn - 0.05)
            if not alike.any() or (joint in self.reported and not (near & known).any()):
                found.append(joint)
        return found


def settle(
    masters: Masters, stored: Callable[[], Sequence[MasterContour]], retreat: Callable[[int, Sequence[int]], bool]
) -> tuple[Turning, Turning]:
    """Take other candidates until nothing turns that the source does not turn; where source and result turn.

    Args:
        stored: gives the contours that are drawn.
        retreat: takes the next candidates for what meets where these segments of a contour begin; False if there are
            none.
    """
    source = Turning(masters)

    def drawings() -> Iterator[tuple[Turning, int]]:
        while True:
            contours = stored()
            found = Turning(replace(masters, contours=contours, repeats=None))
            bad = found.not_in(source)
            segments = [[s for owner, s in bad if owner == c] + vanished(contour) for c, contour in enumerate(contours)]
            yield found, sum(retreat(c, own) for c, own in enumerate(segments) if own)

    found, _ = first_good(drawings(), lambda drawing: drawing[1:])
    return source, found


def locations(masters: Masters) -> FloatArray:
    """(V, A) normalised locations: the corners of the grid, and some inside."""
    corners = masters.grid()
    low, high = corners.min(axis=0), corners.max(axis=0)
    # Locations inside the design space, besides the corners of its grid, where what cannot be certified is measured.
    return np.vstack([corners, np.random.default_rng(0).uniform(low, high, (16, len(low)))])


def vanished(contour: MasterContour) -> list[int]:
    """Segments that have no length in any master: readers drop them, and other joints are there."""
    whole = np.concatenate([contour.points, contour.points[:, :1]], axis=1)
    starts = np.cumsum(contour.degrees) - contour.degrees
    lengths = np.array([
        np.abs(whole[:, a : a + degree + 1] - whole[:, a : a + 1]).max()
        for a, degree in zip(starts.tolist(), contour.degrees.tolist(), strict=True)
    ])  # fmt: skip
    return np.flatnonzero(lengths <= NEAR).tolist()


def spans_of(inner: BoolArray) -> list[IntArray]:
    """The segments of each line and arc, from the first that does not begin inside one."""
    starts = np.flatnonzero(~inner)
    if not len(starts):
        return [np.arange(len(inner))]
    return [np.arange(a, b) % len(inner) for a, b in pairwise([*starts.tolist(), int(starts[0]) + len(inner)])]


def ranges_of(contour: MasterContour, inner: BoolArray, source: MasterContour) -> list[range] | None:
    """The segments of the source in whose place each line and arc is; numbers beyond the last count on from the first.

    None where that is not known: an end is at no joint of the source, or at several.
    """
    firsts = [int(span[0]) for span in spans_of(inner)]
    if inner.all():
        return [range(len(source))]
    starts = [(np.cumsum(each.degrees) - each.degrees) for each in (contour, source)]
    here, there = contour.points[:, starts[0][firsts]], source.points[:, starts[1]]
    close = np.abs(here[:, :, None] - there[:, None]).max(axis=(0, 3)) <= NEAR
    if (close.sum(axis=1) != 1).any():
        return None
    at = close.argmax(axis=1)
    steps = np.diff([*at, at[0]]) % len(source)
    if len(at) == 1:
        steps[:] = len(source)
    if steps.sum() != len(source) or (steps == 0).any():
        return None
    return [range(a, a + step) for a, step in zip(at.tolist(), steps.tolist(), strict=True)]


def is_own(contour: MasterContour, span: IntArray, source: MasterContour, own: range) -> bool:
    """Whether a line or arc is the source's, unchanged."""
    if len(span) != len(own):
        return False
    there = np.array(own) % len(source)
    lines = (contour.degrees[span] == 1) == (source.degrees[there] == 1)
    apart = np.abs(contour.cubics()[:, span] - source.cubics()[:, there]).max()
    return bool(lines.all() and apart <= NEAR)


class StretchPlan:
    """A contour of lines and cubics, any of whose stretches can be the source's own segments.

    Where it is not known which of these a stretch replaces, the whole contour is one.
    """

    def __init__(self, redrawn: Redrawn, c: int) -> None:
        self.contour, self.inner = redrawn.contours[c], redrawn.inner[c]
        self.source = redrawn.masters.contours[redrawn.numbers[c]]
        self.spans, ranges = spans_of(self.inner), ranges_of(self.contour, self.inner, self.source)
        if ranges is None:
            self.spans, self.ranges, self.own = [np.concatenate(self.spans)], [range(len(self.source))], [False]
        else:
            pairs = zip(self.spans, ranges, strict=True)
            self.ranges, self.own = ranges, [is_own(self.contour, span, self.source, own) for span, own in pairs]

    @property
    def is_own(self) -> bool:
        """Whether all of it stays as the font has it."""
        return all(self.own)

    def _pieces(self) -> list[tuple[MasterContour, IntArray, bool]]:
        """The contours and segments of them that follow one another, and whether they are the source's."""
        if self.is_own:
            return [(self.source, np.arange(len(self.source)), True)]
        return [
            (self.source, np.array(own) % len(self.source), True) if stays else (self.contour, span, False)
            for span, own, stays in zip(self.spans, self.ranges, self.own, strict=True)
        ]

    def stored(self) -> MasterContour:
        """What is drawn."""
        points, degrees = [], []
        for contour, span, _ in self._pieces():
            starts = np.cumsum(contour.degrees) - contour.degrees
            points += [contour.points[:, starts[j] : starts[j] + contour.degrees[j]] for j in span.tolist()]
            degrees.append(contour.degrees[span])
        return MasterContour(np.concatenate(points, axis=1), np.concatenate(degrees))

    def inside(self) -> BoolArray:
        """(m,) whether a segment of :meth:`stored` begins inside an arc that is drawn anew."""
        parts = [np.zeros(len(span), bool) if own else self.inner[span] for _, span, own in self._pieces()]
        return np.concatenate(parts)

    def retreat(self, segments: Sequence[int]) -> bool:
        """Leave stretches that meet where segments of :meth:`stored` begin as the font has them; see :func:`settle`."""
        if self.is_own:
            return False
        owners = np.repeat(np.arange(len(self.own)), [len(span) for _, span, _ in self._pieces()]).tolist()
        moved = False
        for pair in [(owners[segment - 1], owners[segment]) for segment in segments]:
            new = next((k for k in pair if not self.own[k]), None)
            if new is not None:
                self.own[new] = moved = True
        return moved


def fewest(plans: Sequence[StretchPlan]) -> None:
    """Leave stretches as the font has them, those that need most more segments first, until a glyph has no more."""
    while sum(len(plan.stored()) - len(plan.source) for plan in plans) > 0:
        every = [
            (len(span) - len(own), -c, -k)
            for c, plan in enumerate(plans)
            for k, (span, own, stays) in enumerate(zip(plan.spans, plan.ranges, plan.own, strict=True))
            if not stays
        ]
        if not every:
            return
        _, c, k = max(every)
        plans[-c].own[-k] = True


def tally(points: tuple[int, int], turning: tuple[Turning, Turning]) -> IntArray:
    """(3, 2) points of a glyph before and after, its kinks, as ``check`` reports them, and those between masters."""
    kinks = [[*each.reported.values()] for each in turning]
    return np.array([points, [len(each) for each in kinks], [sum(more > 0 for more in each) for each in kinks]])
