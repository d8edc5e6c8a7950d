"""Tries of a run to be fewer cubics: where one fails, the next is closer to the source, and in the end the source."""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np

from ....compiled import compiled
from ....types import BoolArray, FloatArray, IntArray
from .gates import ALL
from .harmony import harmonise
from .lattice import round_run
from .nodes import SEEN, chosen_nodes
from .run_source import Stretch


class Try(NamedTuple):
    """What a cubic is to be on a try of its stretch.

    Attributes:
        share: of the tolerance: how near before it is moved and rounded. With 0 it is of one segment.
        ease: weight of the curvatures at its ends.
    """

    share: float
    ease: float


TRIES = (
    Try(share=0.95, ease=1.0),
    Try(share=0.8, ease=0.2),
    Try(share=0.5, ease=0.1),
    Try(share=0.2, ease=0.03),
    Try(share=0.2, ease=0.0),
    Try(share=0.0, ease=0.0),
    Try(share=0.0, ease=0.0),
)

SHARES, EASE = tuple(each.share for each in TRIES), tuple(each.ease for each in TRIES)

KEPT = len(TRIES) - 2
"""Tries after which a stretch stays as the source has it; one of quadratics, which as cubics are not on the grid, is
tried there once more."""

REACH = 1
"""How many cubics on either side of those that are tried again move with them."""

ALL_SHARES, ALL_EASE = np.array(SHARES), np.array(EASE)

State: TypeAlias = tuple[IntArray, FloatArray, FloatArray, FloatArray, IntArray]
"""Of the n segments of a run: (n,) tries that were in vain; (n,) shares of the tolerance; (n + 1,) weights of joints'
curvatures; (K, n, 4, 2) cubics that are good, by the joint at which they begin, and (n,) where they end, or 0."""


class Tries:
    """The tries of a run.

    Args:
        own: the stretch. start: (n,) tries of each segment that were in vain. most: tries of a segment.
    """

    def __init__(self, own: Stretch, start: IntArray, most: int) -> None:
        n, masters, limits, weights = len(start), len(own.cubics), own.limits, ALL_EASE[start]
        ease = np.minimum(np.concatenate((weights[:1], weights)), np.concatenate((weights, weights[-1:])))
        done, until = np.empty((masters, n, 4, 2)), np.zeros(n, np.int64)
        self.own, self.most, self.limits = own, most, (limits.tolerance, limits.em, limits.rounds)
        self.state: State = (start.copy(), ALL_SHARES[start], ease, done, until)
        self.seen = np.zeros((n, SEEN, 2)), np.empty((n, SEEN, masters, 4, 2))

    def chosen(self) -> tuple[FloatArray, IntArray]:
        """The fewest cubics (K, r, 4, 2) by themselves, and their nodes (r + 1,)."""
        source, share = self.own.source, self.state[1]
        places, P = np.empty(len(share) + 1, np.int64), np.empty_like(self.own.cubics)
        r = chosen_nodes(
            source.cubics, source.degrees, source.joints[:], self.own.i, share, self.limits, self.seen, places, P
        )
        return np.ascontiguousarray(P[:, :r]), places[: r + 1]

    def passes(self, P: FloatArray, places: IntArray) -> bool:
        """Move and round cubics together; whether they are good. If not, the next try is closer where they are not."""
        own, limits, tries, ease = self.own, self.own.limits, self.state[0], self.state[2]
        held = take_settled(P, places, own.closed, own.degrees, self.most, self.state)
        extrema, single = own.extrema(places), (tries >= KEPT) & (self.most > KEPT)
        for v, guide in enumerate(own.guides):
            run = own.run(P[v], held, places, extrema[v], ease[places])
            harmonise(run[:], guide[:], limits.tolerance, limits.em)
            round_run(run[:], guide.samples, guide.first, limits.tolerance, limits.em)
        bad = own.refused(P, places, extrema, held, 0.98, ALL, single)
        return noted(bad, held, P, places, own.closed, self.most, self.state)


@compiled
def take_settled(
    P: FloatArray, places: IntArray, closed: bool, degrees: IntArray, most: int, state: State
) -> BoolArray:  # fmt: skip
    """(r,) the cubics of a run that do not move: those of a segment that stays; and those that the last try left good,
    away from all that is fitted again. P (K, r, 4, 2) receives these."""
    r, (tries, _, _, done, until) = P.shape[1], state
    settled = np.ones(r, dtype=np.bool_)
    for s in range(r):
        if until[places[s]] != places[s + 1]:
            for away in range(-REACH, REACH + 1):
                if closed or 0 <= s + away < r:
                    settled[(s + away) % r] = False
    for s in range(r):
        for v in range(len(P) if settled[s] else 0):
            for k in range(4):
                for axis in range(2):
                    P[v, s, k, axis] = done[v, places[s], k, axis]
    for s in range(r):
        q = (s + 1) % r
        if settled[s] == settled[q] or (q == 0 and not closed):
            continue
        for v in range(len(P)):
            for axis in range(2):
                move = P[v, s, 3, axis] - P[v, q, 0, axis]
                for k in range(2):
                    if settled[s]:
                        P[v, q, k, axis] += move
                    else:
                        P[v, s, 3 - k, axis] -= move
    for s in range(r):
        a = places[s]
        if places[s + 1] - a == 1 and (tries[a] >= most or degrees[a] == 1):
            settled[s] = True
    return settled


@compiled
def noted(
    bad: BoolArray, held: BoolArray, P: FloatArray, places: IntArray, closed: bool, most: int, state: State
) -> bool:  # fmt: skip
    """Note which cubics (K, r, 4, 2) of a try are good, and let the next try be closer where they are not; whether all
    are good."""
    good, (tries, share, ease, done, until) = True, state
    until[:] = 0
    for s in range(len(bad)):
        a, b = places[s], places[s + 1]
        if not bad[s]:
            until[a] = b
            for v in range(len(P)):
                for k in range(4):
                    for axis in range(2):
                        done[v, a, k, axis] = P[v, s, k, axis]
        elif not held[s]:
            good = False
            for k in range(a, b):
                tries[k] = min(tries[k] + 1, most)
                share[k] = SHARES[tries[k]]
            ease[a] = ease[b] = EASE[tries[a]]
    if closed:
        ease[0] = ease[-1] = min(ease[0], ease[-1])
    return good
