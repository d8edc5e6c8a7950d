"""Findings mended by moves, and which of these stand together; of kinks and jumps which points move at all.

Joints near each other are one group. A group has a list of ways to move, the gentlest first; of each the least moves
are found (:mod:`.balance`), put on the grid and certified. All groups are tried together, and those that still kink or
bring a new finding take their next way. Of a group that has none left its joints are tried one by one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from typing import NamedTuple

import numpy as np

from ...fitting.first_good import first_good
from ...outlines.flaws.joints import rounding_turns
from ...outlines.flaws.kinds import KINDS
from ...outlines.flaws.turns import joint_controls, turns_of
from ...outlines.masters import MasterContour, Masters
from ...types import FloatArray
from .balance import Bounds, FreePoints, curvatures_at, jumps_at, turns_at
from .ink import INK, keeps_ink
from .joints import EXACT, ContourLayout
from .shapes import Proposal, with_moves, with_result
from .single import single_handles
from .state import Change, Design, Tally, distances

BETTER = 0.7
"""Share of its turn that a mended joint may keep, where handles are so short that the grid is coarse."""

LOOSE = 0.9
"""Share of what a joint may turn, and of what points may move, that is aimed at before rounding."""

TIGHTER = 0.6
"""Share of that again, where no place on the grid turns so little."""

BESIDE = 0.3
"""Degrees by which a smooth joint beside a mended one may turn, if it turned by no more."""

SMALL = 3.0
"""Moves of a point, in thousandths of an em, up to which the first way that does is taken."""

LARGE = 40.0
"""Moves of a point, in thousandths of an em, beyond which a finding is left: the handle was not meant to be there."""

HOPE = 1.5
"""Times what they may be that turns and moves of samples are at most where places on the grid are looked for."""

GRID, STILL, STILL_KINKS = "is mended by no move on the grid", "is still found", "still kinks"
BEYOND = "is beyond the tolerance"
FAR = f"is mended by no move of points below {LARGE:g}/1000 em"
WEAK = (None, GRID, STILL, STILL_KINKS)
"""Reasons why a joint is left that are only given if nothing else is in the way."""

TURNED = 3
"""Ways to turn single handles that are tried at most."""

REACH = 2
"""Segments from one joint of a group to the next at most."""

SMOOTHED = ("kink", "jump")
"""Kinds of joints, of which several are mended together."""


class Way(NamedTuple):
    """How a group moves.

    Attributes:
        far: 1 if handles at the other ends of the curves move, too, 2 if joints there do. node: whether nodes do.
        small: whether points move by no more than ``SMALL``. exact: whether joints turn by less than the threshold; or,
            where handles or segments are so short that a check does not count it, by more.
        meets: whether jumps of curvature that kinks hide are to vanish.
    """

    far: int
    node: bool
    small: bool
    exact: bool
    meets: bool


WAYS = [
    Way(far, node, small, exact, meets)
    for small in (True, False)
    for exact, meets in ((True, True), (True, False), (False, True), (False, False))
    for far, node in ((0, False), (0, True), (1, True), (2, True))
]
"""Ways that are tried in turn: small moves of much come before large ones of little."""


Place = tuple[int, int]
"""Contour and segment of a finding."""


@dataclass
class Group:
    """Joints of a contour that are mended together, and the proposals that are left to try.

    Findings of other kinds than ``SMOOTHED`` are a group each.

    Attributes:
        kind: of the finding. values: of each joint, as found. jumps: those whose curvature jumps, as found elsewhere in
            the design space.
    """

    kind: str
    contour: int
    joints: list[int]
    values: Mapping[int, float]
    jumps: set[int]
    ways: Iterator[Proposal]
    now: Proposal | None = None
    why: str | None = None
    needs: float | None = None

    def blame(self, why: str | None) -> None:
        """Say why it is left, unless something better is known."""
        if self.why in WEAK:
            self.why = why

    def next(self, why: str | None = None) -> None:
        """Give up the proposal for the next one."""
        if self.kind not in SMOOTHED:
            self.why = self.why or why  # the first proposals are the best ones
        elif why in WEAK:
            self.blame(why or self.why)
        else:
            self.why = why
        self.now = next(self.ways, None)

    def touches(self, contour: int, segment: int, segments: int) -> bool:
        """Whether a finding there may come of this group: at a joint, beside it, or of the whole contour."""
        if contour != self.contour or self.now is None:
            return False
        behind = 3 if self.kind in SMOOTHED else 2
        return segment < 0 or any((segment - joint + behind) % segments <= behind + 2 for joint in self.joints)


def settled(
    first: Masters, now: Masters, before: Tally, changes: Mapping[Place, Change], kind: str, design: Design,
    check: Callable[[Masters], tuple[Masters, Tally]], fixed: Mapping[int, str],
    ways: Callable[[Group, MasterContour, MasterContour, Design], Iterator[Proposal]],
) -> tuple[Masters, Tally, list[Change]]:  # fmt: skip
    """The glyph without findings of a kind, as far as that can be; what is found in it then; and what became of each.

    Args:
        first: the glyph as it was. now: as it is, in which ``before`` is found. changes: of the findings, by their
            contour and segment, as if all were left. kind: of the findings.
        check: says what the file makes of a glyph, and what is found in it. fixed: contours that may not change.
        ways: gives the proposals of a group, for its contour as it was first and as it is.
    """
    layouts = {c: ContourLayout(now.contours[c]) for c, _ in changes}
    left = dict(changes)
    for c, s in changes:
        obstacle = layouts[c].obstacle(s, kind, design.em) if kind in SMOOTHED else None
        left[c, s] = replace(left[c, s], why=fixed.get(c) or obstacle)
    mended, places = dict[Place, Change](), [place for place, change in left.items() if change.why is None]
    pending = [(c, [s]) for c, s in places]
    if kind in SMOOTHED:
        pending = groups_of(places, {c: len(layout.degrees) for c, layout in layouts.items()})
    while pending:
        groups = []
        for c, joints in pending:
            jumps = {s for s in joints if kind != "jump" and (c, s) in before.values["jump"]}
            groups.append(Group(kind, c, joints, {s: changes[c, s].before for s in joints}, jumps, iter(())))
        for group in groups:
            group.ways = ways(group, first.contours[group.contour], now.contours[group.contour], design)
            group.next()
        now, before = _settled(first, now, groups, before, design, check)
        pending = []
        for group in groups:
            own = {(group.contour, s) for s in group.joints}
            if group.now is not None and kind in SMOOTHED:
                mended.update({place: changes[place] for place in own})
                continue
            if group.now is not None:
                (place,), (numbers, to, distance) = own, group.now
                left[place] = with_result(left[place], numbers, layouts[place[0]].points[:, numbers], to, distance)
                continue
            needs = group.needs if group.why == BEYOND else None
            for place in own:
                left[place] = replace(left[place], why=group.why or "is mended by no move", needs=needs)
            if len(own) > 1:
                half = (len(own) + 1) // 2
                pending += [(group.contour, part) for part in (group.joints[:half], group.joints[half:])]
    for place, change in _results(mended, layouts, first, now, design):
        left[place] = change
    return now, before, [*left.values()]


def turns_allowed(layout: ContourLayout, joint: int, turn: float, exact: bool, design: Design) -> FloatArray:
    """(L,) radians by which a joint may turn at the places, so that a check finds no kink; it turned by ``turn``.

    Where handles or segments are short this is more than the threshold, see :func:`.joints.joint_findings`; but not
    if it is to be ``exact``.
    """
    limits = design.thresholds
    if exact:
        return np.full(len(design.places), np.radians(limits.kink))
    around = layout.around(joint)
    at = np.tensordot(design.places, layout.points[:, around], axes=1)
    before, behind = (np.hypot(*(at[:, k] - at[:, 2]).T) for k in (1, 3))
    found = np.full(len(at), np.radians(limits.kink))
    if design.step == 1.0:
        found = np.maximum(found, limits.rounding * rounding_turns(before, behind))
    controls = np.tensordot(design.places, joint_controls(layout.contour)[:, joint], axes=1)  # (L, 2, 4, 2)
    legs = np.linalg.norm(np.diff(controls, axis=2), axis=-1).sum(axis=-1)
    arms = (legs + np.linalg.norm(controls[:, :, 3] - controls[:, :, 0], axis=-1)).min(axis=1) / 2
    found = np.maximum(found, limits.kink_height * design.em / 1000 / np.maximum(arms, EXACT))
    return np.minimum(found, np.radians(max(limits.kink, min(BETTER * turn, 0.99 * limits.turn))))


def groups_of(places: Sequence[tuple[int, int]], counts: Mapping[int, int]) -> list[tuple[int, list[int]]]:
    """Joints, contour and segment, in groups of which one is near the next; ``counts``: segments of contours."""
    found = []
    for contour in sorted({c for c, _ in places}):
        joints = sorted(s for c, s in places if c == contour)
        runs: list[list[int]] = []
        for joint in joints:
            if runs and joint - runs[-1][-1] <= REACH:
                runs[-1].append(joint)
            else:
                runs.append([joint])
        if len(runs) > 1 and runs[0][0] + counts[contour] - runs[-1][-1] <= REACH:
            runs[0] = runs.pop() + runs[0]
        found += [(contour, run) for run in runs]
    return found


def proposals(group: Group, first: MasterContour, contour: MasterContour, design: Design) -> Iterator[Proposal]:
    """The moves of a group that are within the tolerance; if there are none the group knows why.

    Of one master those come first that turn single handles, so that curvatures meet best; each then with the least
    moves besides after which they meet, where they do not. Others follow: those after which joints turn least, then
    those that move points least.

    Args:
        first: the contour as it was. contour: as it is now.
    """  # fmt: skip
    layout = ContourLayout(contour)
    seen = set[bytes]()
    if len(layout.points) == 1:
        turned = single_handles(layout, group.joints, group.kind, design)
        for points in [each for each in turned if _is_mended(layout, group, each, False, design)][:TURNED]:
            seen.add(points.tobytes())
            if proposal := _proposal(group, first, contour, points, design):
                yield proposal
                if (contour.degrees == 3).any():
                    yield from _least(group, first, contour, points, design, [way for way in WAYS if way.meets], seen)
    yield from _least(group, first, contour, contour.points, design, WAYS, seen)


def _least(
    group: Group, first: MasterContour, contour: MasterContour, points: FloatArray, design: Design,
    ways: Sequence[Way], seen: set[bytes],
) -> Iterator[Proposal]:  # fmt: skip
    """The least moves from points (K, N, 2) on, way by way; ``seen``: those that are known, to which others are added.

    If all ways are tried and there are none, the group knows what it needs.
    """
    layout = ContourLayout(MasterContour(points, contour.degrees))
    stretches, bounded = dict[tuple[int, ...], FreePoints](), dict[tuple[object, ...], Bounds | None]()
    for exact, own in groupby(ways, key=lambda way: way.exact):
        later = []
        for way in own:
            free = tuple(sorted({point for joint in group.joints for point in layout.free(joint, way.far, way.node)}))
            if not free:
                continue
            if free not in stretches:
                stretches[free] = FreePoints(layout, free, design)
            stretch, what = stretches[free], (free, exact, way.meets)
            if what not in bounded:
                bounded[what] = bounds_of(stretch, group, way, design)
            bounds, most = bounded[what], SMALL * design.em / 1000 if way.small else np.inf
            if bounds is None:
                continue
            key = b"".join([points.tobytes(), repr((free, way.small)).encode(), bounds.most.tobytes()])
            if key in seen:
                continue
            seen.add(key)
            x = stretch.least(bounds, LOOSE * most)
            if stretch.excess(x, bounds) > HOPE:
                group.blame(BEYOND)
                continue
            for moved in _on_grid(stretch, bounds, x, most):
                if moved.tobytes() in seen or not _is_mended(layout, group, moved, exact, design):
                    continue
                seen.add(moved.tobytes())
                proposal = _proposal(group, first, contour, moved, design)
                if proposal is None:
                    continue
                change = float(np.hypot(*(moved - contour.points).reshape(-1, 2).T).max())
                if change <= SMALL * design.em / 1000:
                    yield proposal
                else:
                    later.append((change, proposal))
                break
        yield from [proposal for _, proposal in sorted(later, key=lambda each: each[0])]
    if ways is WAYS and group.needs is None and group.why in (*WEAK, BEYOND) and stretches:
        way = WAYS[-1]._replace(meets=group.kind == "jump")
        anything = design._replace(tolerance=np.inf)
        stretch = FreePoints(layout, [*stretches.values()][-1].free.tolist(), anything)
        bounds = bounds_of(stretch, group, way, design)
        for moved in _on_grid(stretch, bounds, stretch.least(bounds, np.inf), np.inf) if bounds else ():
            if _is_mended(layout, group, moved, way.exact, design):
                farthest = max(float(np.abs(stretch.moves(x)).max()), design.tolerance)
                _proposal(group, first, contour, moved, design, farthest)
                break


def _on_grid(stretch: FreePoints, bounds: Bounds, x: FloatArray, most: float) -> Iterator[FloatArray]:
    """Points on the grid near the least moves, and then near those that leave more room for rounding."""
    yield stretch.places_of(stretch.on_grid(x, bounds, most))
    tighter = bounds._replace(most=np.where(bounds.is_jump[:, None], 1.0, TIGHTER) * bounds.most)
    yield stretch.places_of(stretch.on_grid(stretch.least(tighter, LOOSE * most), tighter, most))


def _proposal(
    group: Group, first: MasterContour, contour: MasterContour, points: FloatArray, design: Design,
    near: float | None = None,
) -> Proposal | None:  # fmt: skip
    """A contour with moved points, if it is within the tolerance; ``near``: measure up to there."""
    new, old = MasterContour(points, contour.degrees), contour.points
    distance = float(distances(first, new, design._replace(tolerance=near or design.tolerance)).max())
    if distance > design.tolerance:
        group.needs = min(group.needs or np.inf, distance)
        group.blame(BEYOND)
        return None
    if np.hypot(*(points - old).T).max() > LARGE * design.em / 1000:
        group.blame(FAR)
        return None
    numbers = np.flatnonzero((points != old).any(axis=(0, 2)))
    return Proposal(numbers, points[:, numbers], distance)


def _is_mended(layout: ContourLayout, group: Group, points: FloatArray, exact: bool, design: Design) -> bool:
    """Whether the joints of a group turn by no more than they may, at the places; of a jump that is checked later."""
    if group.kind == "kink":
        controls = joint_controls(MasterContour(points, layout.degrees))[:, group.joints]
        turns = np.radians(turns_of(np.tensordot(design.places, controls, axes=1)))
        for joint, own in zip(group.joints, turns.T, strict=True):
            if not (np.abs(own) <= turns_allowed(layout, joint, group.values[joint], exact, design)).all():
                group.blame(GRID)
                return False
    return True


def bounds_of(stretch: FreePoints, group: Group, way: Way, design: Design) -> Bounds | None:
    """What the joints of a stretch may turn, and their curvature jump; None where handles have no length."""
    layout, limits, found = stretch.layout, design.thresholds, []
    for joint in stretch.joints.tolist():
        around = layout.around(joint)
        at = np.tensordot(design.places, layout.points[:, around], axes=1)
        if np.abs(np.diff(at[:, 1:4], axis=1)).max(axis=2).min() <= EXACT:
            continue
        turns, own = np.abs(turns_at(at)), joint in group.joints
        if own and group.kind == "kink":
            most = turns_allowed(layout, joint, group.values[joint], way.exact, design)
            most *= LOOSE if len(layout.points) > 1 else 0.0
        elif turns.max() < np.radians(limits.corner_angle):
            most = np.maximum(turns, np.radians(BESIDE))
        else:
            continue
        found.append((around, False, most, np.ones(len(at))))
        if (layout.degrees[[joint - 1, joint]] == 3).all() and np.abs(np.diff(at, axis=1)).max(axis=2).min() > EXACT:
            meets = own and way.meets and joint not in group.jumps
            ends = np.abs(curvatures_at(at))  # what the larger one becomes is not less than the smaller one
            per = np.maximum(ends.min(axis=0) if meets else ends.max(axis=0), limits.jump / design.em)
            most = LOOSE * np.maximum(limits.relative_jump, limits.jump / design.em / per)
            if not meets:
                most = np.maximum(most, np.abs(jumps_at(at)) / per)
            found.append((around, True, most, per))
    return Bounds(*map(np.array, zip(*found, strict=True))) if found else None


def _settled(
    first: Masters, now: Masters, groups: Sequence[Group], before: Tally, design: Design,
    check: Callable[[Masters], tuple[Masters, Tally]],
) -> tuple[Masters, Tally]:  # fmt: skip
    """The glyph with those proposals that stand together, and what is found in it."""

    def trials() -> Iterator[tuple[Masters, Tally, int]]:
        while any(group.now for group in groups):
            trial, after = with_moves(now, [(group.contour, group.now) for group in groups if group.now]), before
            given_up = _far(first, trial, groups, design)
            if not given_up:
                trial, after = check(trial)
                given_up = _far(first, trial, groups, design) or _found_new(trial, groups, before, after)
            if not given_up and not keeps_ink(first, trial, design):
                given_up = [(_spoiling(first, now, groups, design, check), INK)]
            yield trial, after, len(given_up)
            for group, why in given_up:
                group.next(why)
        yield now, before, 0

    mended, found, _ = first_good(trials(), lambda trial: trial[2:])
    return mended, found


def _far(old: Masters, new: Masters, groups: Sequence[Group], design: Design) -> list[tuple[Group, str]]:
    """Groups at a segment that moved by more than the tolerance, as another group or the file moved it too."""
    found = []
    for contour in sorted({group.contour for group in groups if group.now}):
        own = [group for group in groups if group.contour == contour and group.now]
        if len(own) < 2 and own[0].kind in SMOOTHED:
            continue
        bounds = distances(old.contours[contour], new.contours[contour], design)
        for segment in np.flatnonzero(~(bounds <= design.tolerance)).tolist():
            near = [group for group in own if group.touches(contour, segment, len(bounds))]
            if near:
                worst = max(near, key=lambda group: group.now.distance if group.now else 0.0)
                found.append((worst, f"{BEYOND} together with its neighbour"))
    return _once(found)


def _found_new(trial: Masters, groups: Sequence[Group], before: Tally, after: Tally) -> list[tuple[Group, str]]:
    """Groups in which there is still what was found, or that bring new findings."""
    found = []
    for group in groups:
        if group.now and any((group.contour, joint) in after.values[group.kind] for joint in group.joints):
            found.append((group, STILL_KINKS if group.kind == "kink" else STILL))
    for what, contour, segment, _ in after.found - before.found:
        count = len(trial.contours[contour])
        own = [group for group in groups if group.touches(contour, segment, count)]
        why = f"would bring a new finding: {KINDS[what].name}"
        found += [(group, why) for group in own or groups if group.now]
    return _once(found)


def _spoiling(
    first: Masters, now: Masters, groups: Sequence[Group], design: Design,
    check: Callable[[Masters], tuple[Masters, Tally]],
) -> Group:  # fmt: skip
    """A group whose move changes the ink by itself, or else the one that moves curves the most."""
    moving = [(group.now, group) for group in groups if group.now]
    moving.sort(key=lambda each: -each[0].distance)
    for proposal, group in moving if len(moving) > 1 else ():
        trial, _ = check(with_moves(now, [(group.contour, proposal)]))
        if not keeps_ink(first, trial, design):
            return group
    return moving[0][1]


def _once(found: Sequence[tuple[Group, str]]) -> list[tuple[Group, str]]:
    """Each group with the first reason."""
    return [*{id(group): (group, why) for group, why in reversed(found)}.values()]


def _results(
    mended: Mapping[Place, Change], layouts: Mapping[int, ContourLayout], first: Masters, now: Masters, design: Design
) -> Iterator[tuple[Place, Change]]:
    """What became of joints that are mended; of a point beside two of them the first one has the move."""
    taken = set[tuple[int, int]]()
    bounds = {c: distances(first.contours[c], now.contours[c], design) for c in {c for c, _ in mended}}
    for (c, s), change in mended.items():
        old, new, count = layouts[c].points, now.contours[c].points, layouts[c].points.shape[1]
        reach = [(int(layouts[c].starts[s]) + k) % count for k in (-1, 0, 1, -2, 2, -3, 3)]
        numbers = np.array(sorted({p for p in reach if (c, p) not in taken}), dtype=np.int64)
        taken.update((c, p) for p in numbers.tolist())
        turn = design.largest_turns(joint_controls(now.contours[c])[:, [s]])[0]
        change = replace(change, after=float(turn) if change.kind == "kink" else None)
        far = float(max(bounds[c][s - 1], bounds[c][s]))
        yield (c, s), with_result(change, numbers, old[:, numbers], new[:, numbers], far)
