"""Sections of a run of quadratics: each as few as follow the outline, closer to it on each try."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ....types import BoolArray, IntArray
from .chains import Quads, joined, relax
from .grid import EXPLICIT
from .outlines import Given
from .starts import begin, ended


class SectionTry(NamedTuple):
    """What a section is to be on a try; see :data:`.grid.EXPLICIT` too.

    Attributes:
        near: of the tolerance: how near the source before it is rounded; 0 keeps what is stored.
        more: quadratics beyond the fewest.
    """

    near: float
    more: int = 0


STORED_TRIES = SectionTry(near=0.7), SectionTry(near=0.35), SectionTry(near=0.35), SectionTry(near=0.0)
"""Of a source of quadratics on the grid."""

OTHER_TRIES = (
    SectionTry(near=0.7),
    SectionTry(near=0.7, more=1),
    SectionTry(near=0.5),
    SectionTry(near=0.5, more=1),
    SectionTry(near=0.7),
    SectionTry(near=0.5, more=1),
    SectionTry(near=0.35, more=2),
    SectionTry(near=0.35, more=4),
    SectionTry(near=0.35, more=8),
)
"""Of other sources, which have nothing to keep."""

MOST = 4
"""Quadratics for a cubic, and twice as many for a section."""

HOPELESS = 3.0
"""Of what is near enough: how far quadratics may be after two steps before one more is tried."""


@dataclass(frozen=True)
class Sections:
    """The sections of a run, each from a joint to a joint.

    Attributes:
        made: those made before, by their joints and tries.
    """

    given: Given
    tolerance: float
    made: dict[tuple[int, int, int], Quads] = field(default_factory=dict)

    def assembled(self, ends: list[int], tries: IntArray) -> Quads:
        """The quadratics of the sections between the joints ``ends`` of a run, each as its tries say."""
        stored, parts = self.given.stored, list[Quads]()
        for (a, b), n in zip(pairwise(ends), tries.tolist(), strict=True):
            if (a, b, n) not in self.made:
                self.made[a, b, n] = self.section(a, b, n)
            parts.append(self.made[a, b, n])
        q = joined(parts)
        starts = q.owner[1:] > q.owner[:-1]
        q.implied[1:-1][starts] = (np.maximum(tries[1:], tries[:-1]) < EXPLICIT) | stored.implied[ends[1:-1]]
        return q

    def section(self, a: int, b: int, tries: int) -> Quads:
        """The quadratics from joint a to joint b: as few as are near enough, and some more, or what is stored."""
        given, known = self.given, self.given.stored.known
        share, more = (STORED_TRIES if known else OTHER_TRIES)[tries]
        near = share * self.tolerance
        if near == 0.0:
            return self.stored(a, b, True)
        most, level = b - a - 1 if known else MOST * (b - a + 1), False
        count, found = self.fewest(a, b, near, most, False)
        if tries < EXPLICIT and (given.level[a] or given.level[b]):
            own_count, own = self.fewest(a, b, near, min(count + 1, most), True)
            if own is not None:
                count, found, level = own_count, own, True
        if known:
            return self.stored(a, b, tries > 0) if found is None else found
        if found is not None and more == 0:
            return found
        count += 0 if found is None else more
        begun, q = self.begun(a, b, count, level)
        while not begun:
            count -= 1
            begun, q = self.begun(a, b, count, level)
        relax(q, given.joints.samples, near / 2, np.inf)
        return q

    def fewest(self, a: int, b: int, near: float, most: int, level: bool) -> tuple[int, Quads | None]:
        """The number of quadratics, at most ``most``, that follow joints a to b, and these if they are so near."""
        given, samples = self.given, self.given.joints.samples
        enough = max(near, 1.05 * float(max(given.off[a], given.off[b])))  # what is on the grid is no nearer
        for count in range(1, most + 1):
            begun, q = self.begun(a, b, count, level)
            if not begun:
                return count - 1, None
            if relax(q, samples, near / 2, HOPELESS * enough) <= enough:
                return count, q
        return most, None

    def begun(self, a: int, b: int, count: int, level: bool) -> tuple[bool, Quads]:
        """So many quadratics, and whether there are samples for them; ``level``: along lines at their ends."""
        given = self.given
        before, behind = level and bool(given.level[a]), level and bool(given.level[b])
        return begin(given.ends, given.joints.samples, a, b, count, before, behind)

    def stored(self, a: int, b: int, keep: bool) -> Quads:
        """The quadratics that are stored from joint a to joint b, which may move unless the section is to ``keep``
        them."""
        given, stored, n = self.given, self.given.stored, b - a
        q = ended(given.ends, a, b, n, False, False)._replace(
            c=stored.control[:, a:b].copy(), lo=given.joints.first[a : b + 1].copy(),
            fixed=np.full(n, keep), held=np.full(n, keep),
        )  # fmt: skip
        q.node[:, :n], q.node[:, n] = stored.node[:, a:b], stored.node[:, b % len(given.line)]
        q.T[:, 1:n] = given.joints.leaving[:, a + 1 : b]
        if keep:
            q.tied[:], q.implied[1:n] = False, stored.implied[a + 1 : b]
        return q


def next_tries(q: Quads, bad: BoolArray, stored: bool, tries: IntArray) -> bool:
    """Give sections with bad quadratics another try; whether there is one."""
    before, last = tries.copy(), len(STORED_TRIES if stored else OTHER_TRIES) - 1
    failed, moved = np.zeros((2, len(tries)), np.bool_)
    failed[q.owner[bad & ~q.held]], moved[q.owner[bad & q.held]] = True, True
    for f in np.flatnonzero(failed | moved).tolist():
        if failed[f]:
            tries[f] = min(tries[f] + 1, last)
        if moved[f] and tries[f] < EXPLICIT:
            tries[f] = EXPLICIT
        elif moved[f]:
            # What is implied in the source moves with the control point beyond: both stay.
            tries[max(f - 1, 0) : f + 2] = len(STORED_TRIES) - 1
    return not np.array_equal(tries, before)
