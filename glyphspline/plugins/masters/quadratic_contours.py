"""Contours in quadratics, in all masters at once: what follows curves, and the points of ``glyf`` and ``gvar``.

What is stored is certified, and compared with the source as ``check`` sees it: a contour that would turn where the
source does not, or need more points, stays as the font has it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from ...fitting.options import Options
from ...outlines.masters import MasterContour, Masters, quadratics
from ...outlines.outline import Contours
from ...types import BoolArray, FloatArray, IntArray
from ..fonts.tables.font_glyphs import FONTS, ROUNDING
from ..fonts.tables.master_deltas import as_drawn, rounded_deltas
from .redrawn import Redrawn
from .stretches import locations, settle, tally

StoredPoints: TypeAlias = tuple[IntArray, BoolArray]
"""(K, n, 2) the default and the deltas of the points of a contour, and (n,) which of them are on the curve."""


@dataclass(frozen=True, eq=False)
class Own:
    """A contour as the font has it.

    Attributes:
        steps: (K, n, 2) the default and the deltas of its points, those that the font infers rounded. on: (n,) which of
            them are on the curve. place: their numbers in the glyph.
        known: whether readers drop no segment. implied: (m,) whether a segment begins at an implied point, if so.
    """

    steps: IntArray
    on: BoolArray
    place: slice
    known: bool
    implied: BoolArray


def in_quadratics(
    new: Redrawn, owns: Mapping[int, Own], shift: FloatArray, tolerance: float, options: Options = FONTS
) -> Redrawn:
    """A glyph in quadratics as ``glyf`` stores them, within the tolerance of the source if whole units have them.

    Args:
        new: the contours that they follow. Where it has no bounds, what is certified is the distance from these.
        owns: the contours as the font has them, by their numbers in the masters. shift: (K,) from where a master is
            drawn to where it is stored, along x.
    """
    from ..fonts.fit.points import quadratic_contour  # compiles more than others need

    masters, offset = new.masters, shift[:, None, None] * np.array([1.0, 0.0])
    corners = np.unique(masters.weights_at(masters.grid()).round(12), axis=0)
    looks = masters.weights_at(np.vstack([masters.places(), locations(masters)]))
    em = masters.metrics.units_per_em
    numbers, count = new.numbers or (-1,) * len(new.contours), len(new.contours)
    before, wanted = [owns.get(number) for number in numbers], new.bounds or (0.0,) * count
    contours, inner = list(new.contours), list(new.inner)
    bounds, sizes, stays = [0.0] * count, [0] * count, [np.zeros(len(each), dtype=bool) for each in contours]
    # Where regions overlap at each other's peaks, not every master can have whole units.
    rest = ROUNDING if np.abs(masters.at_peaks % 1).any() else 0.0

    def is_stored(c: int) -> bool:
        own, contour = before[c], new.contours[c]
        return own is not None and own.known and np.array_equal(contour.points, masters.contours[numbers[c]].points)

    def fit(c: int) -> None:
        own, moved = before[c], MasterContour(new.contours[c].points + offset, new.contours[c].degrees)
        stored = None
        if own and is_stored(c):  # a control point cannot be the start
            turned = int(own.on[-1] and not own.on[0])
            stored = np.roll(as_drawn(masters, own.steps, 1), turned, axis=1), np.roll(own.on, turned)
        sources = [Contours([moved.mixed(weights)]).arrays for weights in np.eye(len(masters))]
        room = tolerance - wanted[c]
        room = max(room - rest, room / 2)
        points, on, far = quadratic_contour(sources, stored, corners, looks, options, room, em, stays[c])
        drawn = as_drawn(masters, rounded_deltas(masters, points, 1), 1)
        rounded = np.linalg.norm(np.tensordot(corners, drawn - points, axes=1), axis=2)
        bounds[c] = wanted[c] + far + float(rounded.max(initial=0.0))
        whole, degrees, inner[c] = quadratics(drawn - offset, on)
        contours[c], sizes[c] = MasterContour(whole, degrees), len(on)
        more = len(on) - len(own.on) if own else 0
        if bounds[c] > tolerance or (more > 0 and new.fewest) or (more == 0 and is_stored(c)):
            keep(c)

    def keep(c: int) -> bool:
        """Let a contour stay as the font has it; whether it can, and has not."""
        own, whole = before[c], masters.contours[numbers[c]]
        if own is None or contours[c] is whole:
            return False
        contours[c], inner[c], sizes[c], bounds[c] = whole, own.implied, len(own.on), 0.0
        return True

    def retreat(c: int, segments: Sequence[int]) -> bool:
        """Let what meets where segments begin stay as the font has it, or else the contour; whether it has not."""
        if contours[c] is not masters.contours[numbers[c]] and is_stored(c):
            there, here = masters.contours[numbers[c]].cubics()[:, :, 0], contours[c].cubics()[:, segments, 0]
            near = np.abs(there[:, :, None] - here[:, None]).max(axis=(0, 3)) <= 1.0
            more = near.any(axis=1) | np.roll(near.any(axis=1), -1)
            if near.any(axis=0).all() and (more & ~stays[c]).any():
                stays[c] |= more
                fit(c)
                return True
        return keep(c)

    for c in range(count):
        fit(c)
    turning = settle(masters, lambda: contours, retreat)
    many = sum(len(own.on) for own in before if own) or sum(len(c.points[0]) for c in masters.contours)
    return Redrawn(
        masters, tuple(contours), tuple(inner), tuple(bounds), numbers, new.fewest,
        tally((many, sum(sizes)), turning),
    )  # fmt: skip


def unchanged(masters: Masters, contours: Sequence[MasterContour] | None = None) -> Redrawn:
    """A glyph, or some of its contours, as it is."""
    some = tuple(masters.contours if contours is None else contours)
    return Redrawn(masters, some, tuple(np.zeros(len(contour), dtype=bool) for contour in some))


def stored_points(masters: Masters, contour: MasterContour, inner: BoolArray, shift: FloatArray) -> StoredPoints:
    """The points of a contour of :func:`in_quadratics`, rounded in all masters; see there for ``shift``."""
    starts = np.cumsum(contour.degrees) - contour.degrees
    left = np.delete(np.arange(contour.points.shape[1]), starts[inner])
    points = contour.points[:, left] + shift[:, None, None] * [1.0, 0.0]
    steps = np.linalg.solve(masters.at_peaks, points.reshape(len(points), -1)).reshape(points.shape)
    return np.rint(steps).astype(np.int64), np.isin(left, starts)
