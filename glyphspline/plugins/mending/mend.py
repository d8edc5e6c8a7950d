"""Findings of a glyph mended, in one master or in all: no point comes, and nothing new is found.

Each finding has a list of moves, of joints that kink (:mod:`.kinks`) and of others (:mod:`.shapes`). Those that keep
the curves within the tolerance, everywhere between the masters, are tried: the first of every finding, then the next
ones of those that are still found, bring a new finding or change the ink (:mod:`.ink`). The kinds follow each other.
Last come those for which points go, or change their order (:mod:`.fewer`), one finding after the other.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from ...errors import OptionError, is_positive, require
from ...outlines.flaws.kinds import KINDS, MENDED, MENDED_UNASKED, THRESHOLDS, Thresholds
from ...outlines.masters import MasterContour, Masters
from ...outlines.outline import Outline
from .fewer import EDITED, Edited
from .ink import INK, keeps_ink
from .joints import starts_of
from .kinks import BEYOND, SMOOTHED, Group, proposals, settled
from .shapes import Proposal, moved, shape_moves
from .state import PER_EM, Change, Design, Into, Key, Tally, distances

TRIES = 24
"""Moves of a joint that are checked for new findings at most."""

LIKED = ("handles", "slanted", "extremum")
"""Kinds whose moves come in the order in which they are tried; of others the least comes first."""

ANYWHERE = Into()

Glyph = TypeVar("Glyph", Outline, Masters)


def mend(
    glyph: Glyph, kinds: Collection[str] = MENDED_UNASKED, tolerance: float | None = None, *,
    thresholds: Thresholds = THRESHOLDS, outer: int = 0,
) -> tuple[Glyph, list[Change]]:  # fmt: skip
    """Move handles, then nodes, as little as it takes so that joints meant to be smooth no longer kink.

    Points stay in their order, and on the grid of the source: whole units, or its decimals. Horizontal and vertical
    handles stay so. Joints that need more than the tolerance, or would bring a new finding of any kind, are left; and
    so is what would change the ink: by an area of more than the tolerance times the length of the outline, or by an
    island or a counter. In masters, no joint that is mended turns by the threshold or more along any axis.

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
    found, changes = mended(masters, Tally.of(masters, thresholds, outer), kinds, tolerance, thresholds, outer)
    if found is masters:
        return glyph, changes
    return (replace(glyph, contours=found.master(0).contours) if isinstance(glyph, Outline) else found), changes


def check_kinds(kinds: Collection[str]) -> None:
    """Raise an OptionError if one of the kinds cannot be mended."""
    for name in kinds:
        if name not in MENDED:
            raise OptionError(f"kinds has no {name!r}: what can be mended is {', '.join(MENDED)}")


def mended(
    masters: Masters, state: Tally, kinds: Collection[str], tolerance: float | None, thresholds: Thresholds, outer: int,
    into: Into = ANYWHERE,
) -> tuple[Masters, list[Change]]:  # fmt: skip
    """As :func:`mend`; ``state``: what is found in it. ``into``: what it goes back into."""
    tolerance = PER_EM * masters.metrics.units_per_em if tolerance is None else tolerance
    if not state.has(kinds):
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

    def checked(self, glyph: Masters) -> tuple[Masters, Tally]:
        """What the file makes of a glyph, and what is found in it."""
        stored = glyph if self.into.stored is None else self.into.stored(glyph)
        return stored, Tally.of(stored, self.thresholds, self.outer)

    def moved(self, now: Masters, before: Tally, kind: str) -> tuple[Masters, Tally, list[Change]]:
        """Mend the findings of a kind by moves: the glyph, what is found in it then, and what became of them."""
        changes = {place: self.change(kind, place, value) for place, value in before.values[kind].items()}
        ways = proposals if kind in SMOOTHED else shape_proposals
        return settled(self.masters, now, before, changes, kind, self.design, self.checked, self.into.fixed, ways)

    def edited(self, now: Masters, before: Tally, kinds: Sequence[str]) -> tuple[Masters, list[Change]]:
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
        before: Tally,
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
            trial = _edited(now, others)
            after = Tally.of(trial, self.thresholds, self.outer)
            new = _renumbered(after.found, others, True) - _renumbered(before.found, others, False)
            names, needs = [KINDS[what].name for what, *_ in new], None
            if names or after.found.total() >= most:
                why = f"would bring a new finding: {names[0]}" if names else "is still found"
            elif not keeps_ink(self.masters, trial, self.design):
                why = INK
            else:
                return one, replace(change, distance=bound, gone=contours[c].num_points - one.num_points)
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


def shape_proposals(group: Group, first: MasterContour, contour: MasterContour, design: Design) -> Iterator[Proposal]:
    """The moves of :mod:`.shapes` that are within the tolerance, as :func:`.kinks.proposals` has those of joints."""
    tries = []
    for numbers, places in shape_moves(group.kind, contour, group.joints[0], design.step):
        bound = float(distances(first, moved(contour, numbers, places), design).max())
        tries.append(Proposal(numbers, places, bound))
    if group.kind not in LIKED:
        tries.sort(key=lambda each: each.distance)
    within = [each for each in tries if each.distance <= design.tolerance]
    if tries and not within:
        group.why, group.needs = BEYOND, min(each.distance for each in tries)
    yield from within[:TRIES]
