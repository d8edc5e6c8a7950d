"""Kinks of a glyph mended, in one master or in all: no point comes or goes, and nothing new is found.

Each joint has a list of moves (:mod:`.joints`). Those that keep the curves within the tolerance, everywhere between the
masters, are tried: the first of every joint, then the next ones of those that still kink or bring a new finding.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple, overload

import numpy as np

from ..checks.check import measured
from ..checks.finding import Measured
from ..checks.kinds import KINDS, KINK, MENDED, THRESHOLDS, Thresholds
from ..checks.on_axes import OF_CONTOURS, on_axes
from ..checks.turns import largest_turns, turns_of
from ..curves.pairing import SHARPNESS, pair_instances
from ..errors import OptionError, is_positive, require
from ..outlines.contour_arrays import offsets_of
from ..outlines.masters import MasterContour, Masters
from ..outlines.outline import Outline
from ..types import FloatArray, IntArray
from .joints import controls_of, moves, obstacle, points_of

PER_EM = 1e-3
"""The tolerance as a share of the em, unless another is given."""

STEPS = 8
"""Steps of each axis, at whose ends findings other than kinks are looked for besides the masters."""

GOOD = 0.25
"""Share of its turn that a mended joint may keep: where handles are short the grid is coarse."""

TRIES = 24
"""Moves of a joint that are checked for new findings at most."""

DIGITS = 3
"""Decimals of coordinates at most."""


@dataclass(frozen=True)
class Change:
    """What became of a finding.

    Attributes:
        glyph, gid: which glyph. kind: of the finding. contour, segment: number of the contour, and of the segment that
            begins at the joint. point: the joint in the default master, as it was.
        before: the largest turn at any location, in degrees. after: the same when mended; None if it is left.
        moved: the largest move of a point in any master; 0.0 if it is left.
        moves: master, number of the point in the contour, old and new place of every point that moved.
        distance: certified bound of how far the curves beside it moved, at any location; None if it is left.
        why: the reason why it is left, or None. needs: the distance that it would take, if only the tolerance is
            against it.
    """

    glyph: str
    gid: int
    kind: str
    contour: int
    segment: int
    point: tuple[float, float]
    before: float
    after: float | None = None
    moved: float = 0.0
    moves: tuple[tuple[int, int, tuple[float, float], tuple[float, float]], ...] = ()
    distance: float | None = None
    why: str | None = None
    needs: float | None = None

    @property
    def is_mended(self) -> bool:
        """Whether points moved, so that it is no longer found."""
        return self.why is None


@overload
def mend(
    glyph: Outline, kinds: Collection[str] = ..., tolerance: float | None = ..., *, thresholds: Thresholds = ...,
    outer: int = ...,
) -> tuple[Outline, list[Change]]: ...  # fmt: skip
@overload
def mend(
    glyph: Masters, kinds: Collection[str] = ..., tolerance: float | None = ..., *, thresholds: Thresholds = ...,
    outer: int = ...,
) -> tuple[Masters, list[Change]]: ...  # fmt: skip
def mend(
    glyph: Outline | Masters, kinds: Collection[str] = MENDED, tolerance: float | None = None, *,
    thresholds: Thresholds = THRESHOLDS, outer: int = 0,
) -> tuple[Outline | Masters, list[Change]]:  # fmt: skip
    """Move handles, then nodes, as little as it takes so that joints meant to be smooth no longer kink.

    Points stay in their order, and on the grid of the source: whole units, or its decimals. Horizontal and vertical
    handles stay so. Joints that need more than the tolerance, or would bring a new finding of any kind, are left. In
    masters, no joint that is mended turns by the threshold or more along any axis.

    Args:
        glyph: an outline, or a glyph in all its masters. kinds: names of the kinds to mend: of ``MENDED``.
        tolerance: largest distance of the curves from what they were, in font units, at any location. Without it,
            1/1000 em. thresholds: from which values on findings count. outer: as of :func:`glyphspline.check`.

    Returns:
        The mended glyph, the given one where nothing moved; and what became of each finding.

    Raises:
        OptionError: a kind cannot be mended, or the tolerance is not positive.
        GlyphsplineError: masters of the glyph cannot be distinguished.

    Example:
        >>> import glyphspline as gs
        >>> font = gs.open_font("fonts_test/variable.ttf")
        >>> mended, changes = gs.mend(font.masters("o"))
        >>> changes
        []
    """
    check_kinds(kinds)
    require(tolerance is None or is_positive(tolerance), "tolerance is a positive number", tolerance)
    masters = Masters.of(glyph) if isinstance(glyph, Outline) else glyph
    found, changes = mended(masters, kinds, tolerance, thresholds, outer)
    if found is masters:
        return glyph, changes
    return (replace(glyph, contours=found.master(0).contours) if isinstance(glyph, Outline) else found), changes


def check_kinds(kinds: Collection[str]) -> None:
    """Raise an OptionError if one of the kinds cannot be mended."""
    for name in kinds:
        if name not in MENDED:
            raise OptionError(f"kinds has no {name!r}: what can be mended is {', '.join(MENDED)}")


def mended(
    masters: Masters, kinds: Collection[str], tolerance: float | None, thresholds: Thresholds, outer: int,
    fixed: Mapping[int, str] | None = None,
) -> tuple[Masters, list[Change]]:  # fmt: skip
    """As :func:`mend`; ``fixed``: contours that may not change, and why."""
    tolerance = PER_EM * masters.metrics.units_per_em if tolerance is None else tolerance
    before = _State.of(masters, thresholds, outer)
    kinks = {} if "kink" not in kinds else before.kinks
    if not kinks:
        return masters, []
    design = _Design.of(masters, tolerance, thresholds.kink)
    joints = []
    for (contour, segment), turn in kinks.items():
        of_contour = masters.contours[contour]
        _, points = points_of(of_contour, segment)
        change = Change(
            masters.name, masters.gid, "kink", contour, segment, (float(points[0, 1, 0]), float(points[0, 1, 1])), turn
        )
        joints.append(_Joint.of(change, of_contour, design, (fixed or {}).get(contour)))
    while True:
        trial = _with(masters, joints)
        if not any(joint.is_moved for joint in joints):
            return masters, [joint.left() for joint in joints]
        after = _State.of(trial, thresholds, outer)
        if not _advance(joints, before, after, _beyond(masters, trial, joints, design)):
            return trial, [joint.result() for joint in joints]


class _State:
    """What is found in a glyph: the number of findings by what they are, and the turns of kinks by their places."""

    def __init__(self, rows: Measured) -> None:
        self.found = Counter(_keys(rows))
        self.kinks = {
            (c, s): value
            for c, s, what, value in zip(
                rows.contours.tolist(), rows.segments.tolist(), rows.kinds.tolist(), rows.numbers[:, 1].tolist(),
                strict=True,
            )
            if what == KINK
        }  # fmt: skip

    @classmethod
    def of(cls, masters: Masters, thresholds: Thresholds, outer: int) -> _State:
        """Check a glyph: where it is, or in its masters and along all its axes."""
        if not masters.axes:
            em = masters.metrics.units_per_em
            rows = measured([masters.master(0).arrays], thresholds, em, outer, [masters.repeats])
            return cls(rows)
        rows, _ = on_axes([masters], {}, [axis.tag for axis in masters.axes], STEPS, thresholds, outer)
        return cls(rows)


def _keys(rows: Measured) -> list[tuple[int, int, int, int]]:
    """Kind, contour, segment and other contour of each row; those of whole contours have no segment."""
    segments = np.where(np.isin(rows.kinds, OF_CONTOURS), -1, rows.segments)
    return [*zip(*(x.tolist() for x in (rows.kinds, rows.contours, segments, rows.numbers[:, 3])), strict=True)]


class _Try(NamedTuple):
    """New places (K, 3, 2) of the points at a joint, the distance that curves move, and the joint's largest turn."""

    places: FloatArray
    distance: float
    turn: float


class _Design(NamedTuple):
    """What holds for all joints of a glyph.

    Attributes:
        corners: (V, K) weights of the masters, between which every location lies. ticks: of each axis (T, K), between
            which weights are linear along it. step: of the grid of points, whole units or the source's decimals.
        tolerance: in font units. kink: threshold in degrees.
    """

    corners: FloatArray
    ticks: list[FloatArray]
    step: float
    tolerance: float
    kink: float

    @classmethod
    def of(cls, masters: Masters, tolerance: float, kink: float) -> _Design:
        """Look at a glyph's axes and points."""
        ticks = []
        for axis in range(len(masters.axes)):
            values = masters.ticks(axis)
            at = np.zeros((len(values), len(masters.axes)))
            at[:, axis] = values
            ticks.append(masters.weights_at(at))
        corners = masters.weights_at(masters.grid()) if masters.axes else np.ones((1, 1))
        every = np.concatenate([np.zeros(1), *(contour.points.ravel() for contour in masters.contours)])
        digits = (d for d in range(DIGITS) if np.abs(every - np.round(every, d)).max() < 1e-6)
        return cls(corners, ticks, float(10.0 ** -next(digits, DIGITS)), tolerance, kink)

    def largest_turns(self, controls: FloatArray) -> FloatArray:
        """(n,) degrees by which joints (K, n, 2, 4, 2) turn at most, in the masters and along each axis: exact."""
        found = np.abs(turns_of(controls)).max(axis=0)
        for weights in self.ticks:
            at = np.tensordot(weights, controls, axes=1)  # (T, n, 2, 4, 2)
            turns, _ = largest_turns(*(each.reshape(-1, 2, 4, 2) for each in (at[:-1], at[1:])))
            found = np.maximum(found, turns.reshape(len(at) - 1, -1).max(axis=0, initial=0.0))
        return found


@dataclass
class _Joint:
    """A joint that kinks, the moves that are left to try, and why others failed."""

    change: Change
    segments: int
    numbers: IntArray
    old: FloatArray
    tries: list[_Try]
    why: str | None
    needs: float | None = None

    @classmethod
    def of(cls, change: Change, contour: MasterContour, design: _Design, fixed: str | None) -> _Joint:
        """Find the moves of a joint that are within the tolerance and mend it; in masters nodes come last."""
        numbers, old = points_of(contour, change.segment)
        joint = cls(change, len(contour), numbers, old, [], fixed or obstacle(contour, change.segment))
        if joint.why:
            return joint
        every = {new.tobytes(): new for new in moves(contour, change.segment, design.step)}
        if not every:
            return joint
        new = np.stack([*every.values()])
        turns = design.largest_turns(controls_of(contour, change.segment, new))
        for places, turn in zip(new, turns.tolist(), strict=True):
            if turn <= max(design.kink, GOOD * change.before):
                bound = float(distances(contour, _moved(contour, numbers, places), design).max())
                joint.tries.append(_Try(places, bound, turn))
        within = [each for each in joint.tries if each.distance <= design.tolerance]
        if joint.tries and not within:
            joint.why, joint.needs = "is beyond the tolerance", min(each.distance for each in joint.tries)
        several = len(old) > 1
        node = [bool((each.places[:, 1] != old[:, 1]).any()) for each in within]
        order = sorted(range(len(within)), key=lambda k: (within[k].turn >= design.kink, several and node[k]))
        joint.tries = [within[k] for k in order[:TRIES]]
        return joint

    @property
    def is_moved(self) -> bool:
        """Whether there is a move to try."""
        return bool(self.tries)

    def touches(self, contour: int, segment: int) -> bool:
        """Whether a finding there may come of this joint: at it, at a neighbour, or of the whole contour."""
        if contour != self.change.contour:
            return False
        return segment < 0 or (segment - self.change.segment + 2) % self.segments <= 3 or self.segments <= 4

    def next(self, why: str) -> None:
        """Give up the first move."""
        self.tries.pop(0)
        self.why = self.why or why

    def left(self) -> Change:
        """The joint as it was, with the reason."""
        return replace(self.change, why=self.why or "is mended by no move", needs=self.needs)

    def result(self) -> Change:
        """What became of the joint."""
        if not self.is_moved:
            return self.left()
        new, bound, turn = self.tries[0]
        moved = [
            (k, int(self.numbers[p]), (float(x), float(y)), (float(u), float(v)))
            for k, (before, behind) in enumerate(zip(self.old, new, strict=True))
            for p, ((x, y), (u, v)) in enumerate(zip(before, behind, strict=True))
            if (x, y) != (u, v)
        ]
        return replace(
            self.change, after=turn,
            moved=float(np.hypot(*(new - self.old).reshape(-1, 2).T).max()), moves=tuple(moved), distance=bound,
        )  # fmt: skip


def _advance(joints: Sequence[_Joint], before: _State, after: _State, beyond: Collection[tuple[int, int]]) -> bool:
    """Give up moves that kink, bring new findings or are too far together; returns whether there were any."""
    given_up = False
    moved = [joint for joint in joints if joint.is_moved]
    for joint in moved:
        place = joint.change.contour, joint.change.segment
        if place in after.kinks:
            joint.next("still kinks")
            given_up = True
        elif place in beyond:
            joint.next("is beyond the tolerance together with its neighbour")
            given_up = True
    new = after.found - before.found
    for what, contour, segment, _ in new:
        why = f"would bring a new finding: {KINDS[what].name}"
        touched = [joint for joint in moved if joint.is_moved and joint.touches(contour, segment)]
        touched = touched or [joint for joint in moved if joint.is_moved]
        for joint in touched:
            joint.next(why)
            given_up = True
    return given_up


def _moved(contour: MasterContour, numbers: IntArray, new: FloatArray) -> MasterContour:
    """A contour with other places of some points."""
    points = contour.points.copy()
    points[:, numbers] = new
    return MasterContour(points, contour.degrees)


def _with(masters: Masters, joints: Sequence[_Joint]) -> Masters:
    """The glyph with the first move of every joint."""
    contours = list(masters.contours)
    for joint in joints:
        if joint.is_moved:
            own = contours[joint.change.contour]
            contours[joint.change.contour] = _moved(own, joint.numbers, joint.tries[0].places)
    return replace(masters, contours=contours)


def distances(old: MasterContour, new: MasterContour, design: _Design) -> FloatArray:
    """(m,) certified bounds of how far each segment moved, at any location."""
    m, count = len(old), len(design.corners)
    one, other = (np.tensordot(design.corners, contour.cubics(), axes=1) for contour in (old, new))  # (V, m, 4, 2)
    changed = (one != other).any(axis=(0, 2, 3))
    bounds, gaps = np.where(changed, np.nan, 0.0), np.zeros(m)
    offsets, places = offsets_of([m]), np.arange(m + 1.0)
    rows = [np.ascontiguousarray(np.swapaxes(each, 0, 1).reshape(m * count, 4, 2)) for each in (other, one)]
    pair_instances(
        count, rows[0], offsets, rows[1], offsets, np.column_stack([places, places]), offsets_of([m + 1]),
        np.empty((0, 4)), SHARPNESS * design.tolerance, design.tolerance, bounds, gaps,
    )  # fmt: skip
    return bounds


def _beyond(old: Masters, new: Masters, joints: Sequence[_Joint], design: _Design) -> set[tuple[int, int]]:
    """Joints at a segment that moved by more than the tolerance, as both of its ends did."""
    found = set()
    for contour in sorted({joint.change.contour for joint in joints if joint.is_moved}):
        bounds = distances(old.contours[contour], new.contours[contour], design)
        for segment in np.flatnonzero(~(bounds <= design.tolerance)).tolist():
            ends = {segment, (segment + 1) % len(bounds)}
            own = [j for j in joints if j.is_moved and j.change.contour == contour and j.change.segment in ends]
            if own:
                found.add((contour, max(own, key=lambda joint: joint.tries[0].distance).change.segment))
    return found
