"""Findings of a glyph mended, in one master or in all: no point comes, and nothing new is found.

Each finding has a list of moves, of joints that kink (:mod:`.kinks`) and of others (:mod:`.shapes`). Those that keep
the curves within the tolerance, everywhere between the masters, are tried: the first of every finding, then the next
ones of those that are still found or bring a new finding. The kinds follow each other. Last come those for which points
go, or change their order (:mod:`.fewer`), one finding after the other.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from ..checks.kinds import KINDS, MENDED, MENDED_UNASKED, THRESHOLDS, Thresholds
from ..errors import OptionError, is_positive, require
from ..outlines.masters import MasterContour, Masters
from ..outlines.outline import Outline
from .fewer import EDITED, Edited
from .joints import starts_of
from .kinks import smoothed
from .shapes import Proposal, moved, shape_moves, with_moves, with_result
from .state import Change, Design, Into, Key, State, distances

PER_EM = 1e-3
"""The tolerance as a share of the em, unless another is given."""

TRIES = 24
"""Moves of a joint that are checked for new findings at most."""

LIKED = ("handles", "slanted", "extremum")
"""Kinds whose moves come in the order in which they are tried; of others the least comes first."""

SMOOTHED = ("kink", "jump")
"""Kinds of joints, of which several are mended together."""

ANYWHERE = Into()

Glyph = TypeVar("Glyph", Outline, Masters)


def mend(
    glyph: Glyph, kinds: Collection[str] = MENDED_UNASKED, tolerance: float | None = None, *,
    thresholds: Thresholds = THRESHOLDS, outer: int = 0,
) -> tuple[Glyph, list[Change]]:  # fmt: skip
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
    found, changes = mended(masters, State.of(masters, thresholds, outer), kinds, tolerance, thresholds, outer)
    if found is masters:
        return glyph, changes
    return (replace(glyph, contours=found.master(0).contours) if isinstance(glyph, Outline) else found), changes


def check_kinds(kinds: Collection[str]) -> None:
    """Raise an OptionError if one of the kinds cannot be mended."""
    for name in kinds:
        if name not in MENDED:
            raise OptionError(f"kinds has no {name!r}: what can be mended is {', '.join(MENDED)}")


def mended(
    masters: Masters, state: State, kinds: Collection[str], tolerance: float | None, thresholds: Thresholds, outer: int,
    into: Into = ANYWHERE,
) -> tuple[Masters, list[Change]]:  # fmt: skip
    """As :func:`mend`; ``state``: what is found in it. ``into``: what it goes back into."""
    tolerance = PER_EM * masters.metrics.units_per_em if tolerance is None else tolerance
    if not any(state.values[kind] for kind in kinds):
        return masters, []
    glyph = _Glyph(masters, Design.of(masters, tolerance, thresholds, into.step), thresholds, outer, into)
    new, changes = masters, []
    for kind in MENDED:
        if kind in kinds and state.values[kind] and kind not in EDITED:
            new, state, own = glyph.moved(new, state, kind)
            changes += own
    edited = [kind for kind in EDITED if kind in kinds and state.values[kind]]
    if edited:
        new, own = glyph.edited(new, state, edited)
        changes += own
    return new, changes


@dataclass(frozen=True)
class _Glyph:
    """A glyph as it was, and what holds for all its findings; see :func:`mended`."""

    masters: Masters
    design: Design
    thresholds: Thresholds
    outer: int
    into: Into

    def change(self, kind: str, place: tuple[int, int], value: float) -> Change:
        """A finding that is still there."""
        c, segment = place
        contour = self.masters.contours[c]
        x, y = contour.points[0, starts_of(contour)[segment]].tolist()
        return Change(self.masters.name, self.masters.gid, kind, c, segment, (x, y), value)

    def checked(self, glyph: Masters) -> tuple[Masters, State]:
        """What the file makes of a glyph, and what is found in it."""
        stored = glyph if self.into.stored is None else self.into.stored(glyph)
        return stored, State.of(stored, self.thresholds, self.outer)

    def moved(self, now: Masters, before: State, kind: str) -> tuple[Masters, State, list[Change]]:
        """Mend the findings of a kind by moves: the glyph, what is found in it then, and what became of them."""
        if kind in SMOOTHED:
            changes = {place: self.change(kind, place, value) for place, value in before.values[kind].items()}
            return smoothed(self.masters, now, before, changes, kind, self.design, self.checked, self.into.fixed)
        faults = []
        for place, value in before.values[kind].items():
            old, own = self.masters.contours[place[0]], now.contours[place[0]]
            faults.append(
                _Fault.of(self.change(kind, place, value), old, own, self.design, self.into.fixed.get(place[0]))
            )
        while True:
            if not any(fault.is_moved for fault in faults):
                return now, before, [fault.left() for fault in faults]
            trial, after = self.checked(
                with_moves(now, [(fault.change.contour, fault.tries[0]) for fault in faults if fault.is_moved])
            )
            beyond = _beyond(self.masters, trial, faults, self.design)
            if not _advance(faults, before, after, beyond, kind):
                return trial, after, [fault.result() for fault in faults]

    def edited(self, now: Masters, before: State, kinds: Sequence[str]) -> tuple[Masters, list[Change]]:
        """Mend findings for which points go, one after the other."""
        contours = [Edited.of(*each) for each in zip(now.contours, now.repeats_of, strict=True)]
        changes, most = [], before.found.total()
        for kind in kinds:
            for (c, segment), value in before.values[kind].items():
                change = self.change(kind, (c, segment), value)
                why = self.into.fixed.get(c) or self.into.points_stay
                at = contours[c].number(segment)
                if why or at is None:
                    changes.append(replace(change, why=why or "went with its neighbour"))
                    continue
                found, left = self._tried(now, before, change, contours, EDITED[kind](contours[c], at), most)
                changes.append(left)
                if found is not None:
                    contours[c], most = found, most - 1
        if all(left.why for left in changes):
            return now, changes
        return _edited(now, contours), changes

    def _tried(
        self,
        now: Masters,
        before: State,
        change: Change,
        contours: Sequence[Edited],
        tries: Iterator[Edited],
        most: int,
    ) -> tuple[Edited | None, Change]:
        """The contour nearest to what it was, of those that leave fewer findings than ``most`` and no new one."""
        c = change.contour
        old = self.masters.contours[c]
        near, why, needs = [], None, None
        for one in tries:
            was = old.reversed() if one.reversed else old
            bound = float(distances(was, one.contour, self.design, one.anchors(len(old))).max())
            if bound <= self.design.tolerance:
                near.append((bound, one))
            elif needs is None or bound < needs:
                why, needs = "is beyond the tolerance", bound
        for bound, one in sorted(near, key=lambda each: each[0]):
            others = [*contours[:c], one, *contours[c + 1 :]]
            after = State.of(_edited(now, others), self.thresholds, self.outer)
            new = _renumbered(after.found, others, True) - _renumbered(before.found, others, False)
            if not new and after.found.total() < most:
                return one, replace(change, distance=bound, gone=contours[c].num_points - one.num_points)
            names = [KINDS[what].name for what, *_ in new]
            why, needs = f"would bring a new finding: {names[0]}" if names else "is still found", None
        return None, replace(change, why=why or "is mended by no move", needs=needs)


def _edited(masters: Masters, contours: Sequence[Edited]) -> Masters:
    """A glyph with edited contours."""
    repeats = np.concatenate([np.zeros(0, dtype=np.int64), *(each.repeats for each in contours)])
    return replace(masters, contours=[each.contour for each in contours], repeats=repeats if repeats.any() else None)


def _renumbered(found: Counter[Key], contours: Sequence[Edited], are_new: bool) -> Counter[Key]:
    """Findings with the numbers that segments had before; those of segments that went are their successors'."""
    renumbered: Counter[Key] = Counter()
    for (what, c, segment, other), count in found.items():
        own = contours[c]
        if own.reversed:
            segment = -1
        elif segment >= 0 and are_new:
            segment = int(own.segments[segment])
        elif segment >= 0:
            behind = own.segments[own.segments >= segment]
            segment = int((behind if len(behind) else own.segments).min())
        renumbered[what, c, segment, other] += count
    return renumbered


@dataclass
class _Fault:
    """A finding, the moves that are left to try, and why others failed; ``old``: its contour before them."""

    change: Change
    old: MasterContour
    tries: list[Proposal]
    why: str | None
    needs: float | None = None

    @classmethod
    def of(
        cls, change: Change, origin: MasterContour, contour: MasterContour, design: Design, fixed: str | None
    ) -> _Fault:
        """Find the moves that are within the tolerance of the contour ``origin``; in masters nodes come last."""
        fault = cls(change, contour, [], fixed)
        if fixed is None:
            for numbers, places in shape_moves(change.kind, contour, change.segment, design.step):
                bound = float(distances(origin, moved(contour, numbers, places), design).max())
                fault.tries.append(Proposal(numbers, places, bound))
            if change.kind not in LIKED:
                fault.tries.sort(key=lambda each: each.distance)
        within = [each for each in fault.tries if each.distance <= design.tolerance]
        if fault.tries and not within:
            fault.why, fault.needs = "is beyond the tolerance", min(each.distance for each in fault.tries)
        fault.tries = within[:TRIES]
        return fault

    @property
    def is_moved(self) -> bool:
        """Whether there is a move to try."""
        return bool(self.tries)

    def touches(self, contour: int, segment: int) -> bool:
        """Whether a finding there may come of these moves: at its place, at a neighbour, or of the whole contour."""
        if contour != self.change.contour:
            return False
        return segment < 0 or (segment - self.change.segment + 2) % len(self.old) <= 4

    def next(self, why: str) -> None:
        """Give up the first move."""
        self.tries.pop(0)
        self.why = self.why or why

    def left(self) -> Change:
        """The finding as it was, with the reason."""
        return replace(self.change, why=self.why or "is mended by no move", needs=self.needs)

    def result(self) -> Change:
        """What became of the finding."""
        if not self.is_moved:
            return self.left()
        numbers, new, bound = self.tries[0]
        return with_result(self.change, numbers, self.old.points[:, numbers], new, bound)


def _advance(
    faults: Sequence[_Fault], before: State, after: State, beyond: Collection[tuple[int, int]], kind: str
) -> bool:
    """Give up moves that mend nothing, bring new findings or are too far together; returns whether there were any."""
    given_up = False
    moved = [fault for fault in faults if fault.is_moved]
    for fault in moved:
        place = fault.change.contour, fault.change.segment
        if place in after.values[kind]:
            fault.next("is still found")
            given_up = True
        elif place in beyond:
            fault.next("is beyond the tolerance together with its neighbour")
            given_up = True
    new = after.found - before.found
    for what, contour, segment, _ in new:
        why = f"would bring a new finding: {KINDS[what].name}"
        touched = [fault for fault in moved if fault.is_moved and fault.touches(contour, segment)]
        touched = touched or [fault for fault in moved if fault.is_moved]
        for fault in touched:
            fault.next(why)
            given_up = True
    return given_up


def _beyond(old: Masters, new: Masters, faults: Sequence[_Fault], design: Design) -> set[tuple[int, int]]:
    """Findings at a segment that is farther away than the tolerance: of those around it the one that moves most."""
    found = set()
    moved = [fault for fault in faults if fault.is_moved]
    for contour in sorted({fault.change.contour for fault in moved}):
        bounds = distances(old.contours[contour], new.contours[contour], design)
        for segment in np.flatnonzero(~(bounds <= design.tolerance)).tolist():
            ends = {(segment + k) % len(bounds) for k in (-1, 0, 1)}
            of_contour = [fault for fault in moved if fault.change.contour == contour]
            own = [fault for fault in of_contour if fault.change.segment in ends] or of_contour
            found.add((contour, max(own, key=lambda fault: fault.tries[0].distance).change.segment))
    return found
