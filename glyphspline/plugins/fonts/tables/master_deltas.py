"""The glyphs of a variable font that are drawn anew, and their points as a font stores them: a default and deltas."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from math import inf
from typing import Any

import numpy as np

from ....curves.integrals import area
from ....errors import GlyphsplineError
from ....outlines.masters import MasterContour, Masters
from ....readers.pens import ContourPen
from ....types import BoolArray, FloatArray, IntArray, counted
from .font_glyphs import LIMIT, Flavour


@dataclass(frozen=True, eq=False)
class Redrawn:
    """A glyph's new contours in all its masters.

    Attributes:
        masters: the glyph as the font has it. Its K masters and their regions are those of ``contours``.
        contours: the new ones.
        inner: for each contour (m,) whether segment j begins inside an arc, where the curve is to stay smooth; False
            at the ends of arcs and lines.
        bounds: for each contour its certified distance from its source. If they are given, arcs are compared with the
            source, and stay as the font has them where the new ones would turn a joint that the source does not turn.
        numbers: with ``bounds``, for each contour that of its source in ``masters``.
        fewest: with ``bounds``, arcs also stay as they are where new ones would need more points.
        tally: see :class:`StoredGlyph`, of contours that are as ``glyf`` stores them: quadratics, those at ``inner``
            joints beginning midway between control points; or the source's own. Else None.

    Raises:
        ValueError: the numbers of masters, contours or segments do not agree.
    """

    masters: Masters
    contours: tuple[MasterContour, ...]
    inner: tuple[BoolArray, ...]
    bounds: tuple[float, ...] = ()
    numbers: tuple[int, ...] = ()
    fewest: bool = False
    tally: IntArray | None = None

    def __post_init__(self) -> None:
        if len(self.contours) != len(self.inner):
            raise ValueError(f"{counted(len(self.contours), 'contour')}, but joints of {len(self.inner)}")
        if self.bounds and not len(self.bounds) == len(self.numbers) == len(self.contours):
            raise ValueError(f"{counted(len(self.contours), 'contour')}, but bounds of {len(self.bounds)}")
        for contour, inner in zip(self.contours, self.inner, strict=True):
            points, degrees = contour.points, contour.degrees
            if points.shape != (len(self.masters), int(degrees.sum()), 2) or inner.shape != degrees.shape:
                raise ValueError(f"{counted(len(self.masters), 'master')}, but points {points.shape}")


@dataclass(frozen=True, eq=False)
class StoredGlyph:
    """A glyph as a font stores it.

    Attributes:
        inner: for each contour (m,) whether segment j begins inside an arc; in glyf, at an implied point.
        distance: certified bound of the largest distance from the contours that were given, in font units, at any
            location. bound: of that from the source; None if no bounds were given.
        tally: (3, 2) before and after: points, in glyf as stored, in CFF2 lines and curves; joints that ``check``
            reports along the axes and in masters; and those of them that turn more between masters than in them. None
            likewise.
    """

    inner: tuple[BoolArray, ...]
    distance: float
    bound: float | None = None
    tally: IntArray | None = None


def displaced(found: Masters, drawn: Masters) -> float:
    """How far the points of a glyph, as it was read, are at most from those that were to be drawn, at any location.

    Infinite where it has other segments; those of no length do not count.
    """
    pen, corners = ContourPen(masters=len(drawn)), drawn.grid()
    for contour in drawn.contours:
        pen.contour(contour.points, contour.degrees)
    far, weights = 0.0, (found.weights_at(corners), drawn.weights_at(corners))
    if [each.degrees.tolist() for each in pen.stacks] != [each.degrees.tolist() for each in found.contours]:
        return inf
    for both in zip(found.contours, pen.stacks, strict=True):
        # Between the corners of the grid points are convex combinations of those there, and so are their distances.
        here, there = (np.tensordot(w, contour.points, axes=1) for w, contour in zip(weights, both, strict=True))
        far = max(far, float(np.linalg.norm(here - there, axis=2).max()))
    return far


def bound_of(glyph: StoredGlyph, redrawn: Redrawn) -> float:
    """A bound of a stored glyph's distance from its source. Where its arcs were not compared with the source, what is
    certified and how far it is stored add up.
    """
    return max(redrawn.bounds, default=0.0) + glyph.distance if glyph.bound is None else glyph.bound


def rounded_deltas(masters: Masters, points: FloatArray, parts: int) -> IntArray:
    """(K, N, 2) the default's points and a delta for each region, in steps of 1/``parts`` unit.

    Masters are rounded one after the other, each delta from what the regions before it leave. If no two regions
    overlap at each other's peaks, every master is within half a step of ``points`` (K, N, 2), whatever their number.
    """
    scalars, wanted = masters.at_peaks, points * float(parts)
    # Of the masters still to come: as they are before rounding.
    steps = np.tensordot(np.linalg.inv(scalars), wanted, axes=1)
    others = np.abs(scalars) * (1 - np.eye(len(masters)))
    waiting = np.arange(len(masters))
    while len(waiting):
        first = int(others[np.ix_(waiting, waiting)].sum(axis=1).argmin())
        k, waiting = waiting[first], np.delete(waiting, first)
        acting = np.flatnonzero(others[k])
        left = wanted[k] - np.tensordot(scalars[k, acting], steps[acting], axes=1)
        steps[k] = np.floor(np.round(left, 6) + 0.5)  # what is equal but for rounding errors is rounded alike
    return np.rint(steps).astype(np.int64)


def as_drawn(masters: Masters, steps: IntArray, parts: int) -> FloatArray:
    """(K, N, 2) the points of the masters that :func:`rounded_deltas` in steps of 1/``parts`` give."""
    drawn: FloatArray = np.tensordot(masters.at_peaks, steps / float(parts), axes=1)
    return drawn


def check_steps(steps: IntArray, parts: int, name: str) -> None:
    """Refuse what a font cannot hold.

    Raises:
        GlyphsplineError: a coordinate or a delta is beyond 32767 units.
    """
    if steps.size and np.abs(steps).max() > LIMIT * parts:
        raise GlyphsplineError(f"coordinates beyond {LIMIT} do not fit into a font", glyph=name)


def region_key(region: FloatArray) -> tuple[tuple[int, ...], ...]:
    """The axes that count in a region (A, 3), in the steps in which fonts store them: 1/16384."""
    steps = np.rint(np.asarray(region) * 16384).astype(int).tolist()
    counting = [(axis, *three) for axis, three in enumerate(steps) if three[1]]
    return tuple(
        [(a, low, peak, high) for a, low, peak, high in counting if low <= peak <= high and not low < 0 < high]
    )


def numbers_of(masters: Masters) -> dict[Any, int]:
    """The keys of regions to the numbers of their masters; the default is 0."""
    return {region_key(region): 1 + k for k, region in enumerate(masters.regions)}


def order_of(regions: Sequence[FloatArray], masters: Masters) -> list[int] | None:
    """The numbers of the masters of regions; None if these are others than those of the glyph."""
    known, keys = numbers_of(masters), [region_key(region) for region in regions]
    return [known[key] for key in keys] if len(keys) == len(known) and set(keys) == known.keys() else None


def axes_of(tags: Iterable[str], region: Sequence[Sequence[float]]) -> dict[str, tuple[float, ...]]:
    """A region as fontTools has it: start, peak and end on the axes that count."""
    return {tag: tuple(three) for tag, three in zip(tags, region, strict=True) if three[1]}


def oriented(new: Redrawn, flavour: Flavour) -> Redrawn:
    """The glyph with ink to the right of its contours in the default, as TrueType has it, or to their left.

    Quadratics are not compared with the source's, which are others: their bounds are none.
    """
    if flavour == "ttf" and new.tally is None:
        new = Redrawn(new.masters, new.contours, new.inner)
    total = sum(area(contour.cubics()[0]) for contour in new.contours)
    if (total >= 0) == (flavour == "otf") or total == 0:
        return new
    masters = replace(new.masters, contours=[contour.reversed() for contour in new.masters.contours], repeats=None)
    inner = tuple(np.roll(joints[::-1], 1) for joints in new.inner)
    return replace(new, masters=masters, contours=tuple(c.reversed() for c in new.contours), inner=inner)
