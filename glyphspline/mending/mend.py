"""Findings of a glyph mended, in one master or in all: no point comes, and nothing new is found.

Each finding has a list of moves, of joints that kink (:mod:`.joints`) and of others (:mod:`.shapes`). Those that keep
the curves within the tolerance, everywhere between the masters, are tried: the first of every finding, then the next
ones of those that are still found or bring a new finding. The kinds follow each other. Last come those for which points
go, or change their order (:mod:`.fewer`), one finding after the other.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple, overload

import numpy as np

from ..checks.kinds import KINDS, MENDED, THRESHOLDS, Thresholds
from ..errors import OptionError, is_positive, require
from ..outlines.masters import MasterContour, Masters
from ..outlines.outline import Outline
from ..types import FloatArray, IntArray
from .joints import controls_of, moves, obstacle, points_of
from .state import Design, State, distances

PER_EM = 1e-3
"""The tolerance as a share of the em, unless another is given."""

GOOD = 0.25
"""Share of its turn that a mended joint may keep: where handles are short the grid is coarse."""

TRIES = 24
"""Moves of a joint that are checked for new findings at most."""


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
    before = State.of(masters, thresholds, outer)
    kinks = {} if "kink" not in kinds else before.kinks
    if not kinks:
        return masters, []
    design = Design.of(masters, tolerance, thresholds.kink)
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
        after = State.of(trial, thresholds, outer)
        if not _advance(joints, before, after, _beyond(masters, trial, joints, design)):
            return trial, [joint.result() for joint in joints]


class _Try(NamedTuple):
    """New places (K, 3, 2) of the points at a joint, the distance that curves move, and the joint's largest turn."""

    places: FloatArray
    distance: float
    turn: float


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
    def of(cls, change: Change, contour: MasterContour, design: Design, fixed: str | None) -> _Joint:
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


def _advance(joints: Sequence[_Joint], before: State, after: State, beyond: Collection[tuple[int, int]]) -> bool:
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
    """A contour with other places of some points; one midway between two control points of quadratics stays so."""
    points = contour.points.copy()
    points[:, numbers] = new
    if (contour.degrees == 2).any():
        starts = np.cumsum(contour.degrees) - contour.degrees
        at = starts[(contour.degrees == 2) & (np.roll(contour.degrees, 1) == 2)]
        behind = (at + 1) % points.shape[1]
        implied = (contour.points[:, at - 1] + contour.points[:, behind] == 2 * contour.points[:, at]).all(axis=(0, 2))
        at, behind = at[implied], behind[implied]
        points[:, at] = (points[:, at - 1] + points[:, behind]) / 2
    return MasterContour(points, contour.degrees)


def _with(masters: Masters, joints: Sequence[_Joint]) -> Masters:
    """The glyph with the first move of every joint."""
    contours = list(masters.contours)
    for joint in joints:
        if joint.is_moved:
            own = contours[joint.change.contour]
            contours[joint.change.contour] = _moved(own, joint.numbers, joint.tries[0].places)
    return replace(masters, contours=contours)


def _beyond(old: Masters, new: Masters, joints: Sequence[_Joint], design: Design) -> set[tuple[int, int]]:
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
