"""Curvatures that meet at single nodes of a run on the grid, where all its cubics together did not bring that about."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ....fitting.first_good import first_good
from ....fitting.sharp.corners import SMOOTH_KINK
from ....types import BoolArray, FloatArray, IntArray
from .gates import ALL, DISTANCE, TURNS, crosses_handles, joint_turn, on_grid
from .harmony import end_jump, end_jumps, harmonise
from .lattice import round_run
from .meeting_places import meet
from .run_nodes import CubicRun
from .run_source import Stretch
from .tries import KEPT

JUMPS = 0.1
"""Share of the larger curvature from which a difference is a jump."""


class MeetingWay(NamedTuple):
    """How curvatures are let meet at a node.

    Attributes:
        wide: how many cubics on either side of it are moved together; none: nearby places alone.
        held: whether other nodes are held to the jumps they have.
    """

    wide: int
    held: bool


WAYS = (
    MeetingWay(0, held=False),
    MeetingWay(1, held=False),
    MeetingWay(2, held=False),
    MeetingWay(1, held=True),
    MeetingWay(2, held=True),
)
"""One after the other. Without the last two, 69 of 1,074 jumps of EB Garamond are left instead of 60, and 129 of 1,122
of its Italic instead of 111."""

OTHERS = 0.03
"""Weight of other nodes at which curvatures jump, where they are not held to that: with 0, more joints jump by more
than the source's, and those of round letters stay."""

SLACK = 0.06
"""Jump of curvature that may stay at the node, where others are held to theirs: to this much less than they have, which
leaves room for rounding."""

HOPELESS = 1.7, 0.5
"""Distance, in tolerances, and jump of curvature beyond which cubics that are not rounded yet are given up."""


class Tried(NamedTuple):
    """Cubics of a run that are on the grid, of a single master.

    Attributes:
        P: (1, r, 4, 2). jumps: of curvature, where each begins; at an end of the run 0.
    """

    P: FloatArray
    jumps: list[float]

    @property
    def jumping(self) -> int:
        """The number of nodes at which curvatures jump."""
        return sum(jump > JUMPS for jump in self.jumps)


def let_meet(own: Stretch, P: FloatArray, places: IntArray, start: IntArray) -> FloatArray:
    """A run (1, r, 4, 2) with curvatures that meet where that is certified, if it is on the grid.

    Args:
        places: (r + 1,) its nodes, as numbers of segments. start: (n,) tries of these that were in vain.
    """
    first, best = places[:-1], tried(own, P)
    if best.jumping == 0 or len(first) == 1:
        return P
    line = (places[1:] - first == 1) & (own.degrees[first] == 1)
    if not on_grid(P, np.where(line, 1, 3), own.closed):
        return P
    # What a check found something in as often as KEPT may meet still, but where it is put on the grid for that.
    stays = line | (start[first] + (own.degrees[first] == 2) > KEPT)
    return Meeting(own, places, stays.tolist()).met(best).P


def tried(own: Stretch, P: FloatArray) -> Tried:
    """A run with its jumps."""
    jumps = end_jumps(P, own.limits.em)[0].tolist()
    return Tried(P, jumps if own.closed else [0.0, *jumps[1:]])


class Meeting:
    """The nodes of a run on the grid at which curvatures are let meet, one by one.

    Args:
        own: the stretch of a single master. places: (r + 1,) the nodes. stays: (r,) cubics that stay as they are.
    """

    def __init__(self, own: Stretch, places: IntArray, stays: list[bool]) -> None:
        self.own, self.places, self.stays, self.extrema = own, places, stays, own.extrema(places)

    @cached_property
    def room(self) -> FloatArray:
        """Of work for :func:`.meeting_places.meet`."""
        return np.empty((2, 2025, 8))

    def met(self, best: Tried) -> Tried:
        """The run with curvatures that meet where that is certified.

        Each node is tried in all :data:`WAYS`, and once more if cubics near it have changed. Fewer curvatures jump in
        the run then, and none by more than a try of it allows.
        """
        r, stays = len(self.stays), self.stays
        waiting = [True] * r
        for q in [*range(r)] * 2:
            if not waiting[q] or best.jumps[q] <= JUMPS or stays[q - 1] or stays[q]:
                continue
            if joint_turn(best.P[0, q - 1 : q or r], best.P[0, q : q + 1]) > SMOOTH_KINK:
                continue
            found = self.met_at(q, best)
            if found is not best:
                best = found
                # Cubics have changed as far as the widest way reaches, and as far beyond nodes depend on them.
                for away in range(-2 * WAYS[-1].wide, 2 * WAYS[-1].wide + 1):
                    waiting[(q + away) % r] = True
            waiting[q] = False
        return best

    def met_at(self, q: int, best: Tried) -> Tried:
        """The run with curvatures that meet at node q, or else the one at whose nodes the fewest jump."""
        return first_good(self.ways(best, q), lambda run: (run.jumping if run.jumps[q] > JUMPS else 0,))

    def ways(self, best: Tried, q: int) -> Iterator[Tried]:
        """The run, and better ones, each made of the last one by the next way to let curvatures meet at node q."""
        yield best
        for way in WAYS:
            found = self.better(best, q, way)
            if found is not None:
                best = found
                yield best

    def better(self, best: Tried, q: int, way: MeetingWay) -> Tried | None:
        """The run with cubics moved so that curvatures meet at node q; None if that is no better."""
        own, limits, r = self.own, self.own.limits, len(self.stays)
        loose = self.loose(q, max(way.wide, 1))
        settled = np.ones(r, np.bool_)
        settled[loose] = False
        run = own.run(best.P[0].copy(), settled, self.places, self.extrema[0], np.ones(r + 1))
        if way.wide and not self.moved_together(run, best.jumps, q, way.held):
            return None
        guide = own.guides[0]
        for s in loose:
            inside, jumped = (s - 1) % r in loose and (s > 0 or own.closed), s != q and best.jumps[s] > JUMPS
            if inside and not jumped and end_jump(run.P[s - 1], run.P[s], limits.em) > JUMPS:
                meet(run[:], s, guide.samples, guide.first, limits.tolerance, limits.em, self.room)
        new = tried(own, run.P[None])
        if new.jumping >= best.jumping:
            return None
        if any(crosses_handles(run.P[s]) and not crosses_handles(best.P[0, s]) for s in loose):
            return None
        return None if self.refused(run, 0.999, ALL if way.wide else TURNS)[loose].any() else new

    def refused(self, run: CubicRun, share: float, gates: int) -> BoolArray:
        """(r,) the cubics of a run that a gate refuses."""
        none = np.zeros(len(self.own.degrees), np.bool_)
        return self.own.refused(run.P[None], self.places, self.extrema, run.held, share, gates, none)

    def moved_together(self, run: CubicRun, jumps: list[float], q: int, held: bool) -> bool:
        """Move the cubics beside node q together and round them; False where that is given up. See :meth:`better`."""
        guide, limits, r = self.own.guides[0], self.own.limits, len(jumps)
        for s in range(0 if self.own.closed else 1, r):
            if held:
                run.slack[s] = SLACK if s == q else max(jumps[s] - SLACK, SLACK / 2)
            elif s != q and jumps[s] > JUMPS:
                run.ease[s] = OTHERS
        run.ease[r], run.slack[r] = run.ease[0], run.slack[0]
        harmonise(run[:], guide[:], limits.tolerance, limits.em)
        if end_jump(run.P[q - 1], run.P[q], limits.em) > HOPELESS[1] or self.refused(run, HOPELESS[0], DISTANCE).any():
            return False
        round_run(run[:], guide.samples, guide.first, limits.tolerance, limits.em)
        return True

    def loose(self, q: int, wide: int) -> list[int]:
        """The cubics that move for node q: not those more than so many away, or beyond one that stays."""
        r, found = len(self.stays), set[int]()
        for side in range(2):
            for away in range(wide):
                s = q + away if side else q - 1 - away
                if (not self.own.closed and not 0 <= s < r) or self.stays[s % r]:
                    break
                found.add(s % r)
        return sorted(found)
