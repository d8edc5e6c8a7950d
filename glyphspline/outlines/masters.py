"""The masters of a variable glyph: outlines of one structure, and how they are mixed at a location.

A glyph's outline at a location is its default outline plus, for each *region* of the design space, a delta times the
region's scalar, which is 1 at the region's peak and falls to 0 towards its ends. The *masters* are the outlines at the
default and at all peaks; they say the same as the deltas. At every location the outline is a linear combination of
them, with weights that sum to 1. Locations here are *normalised*: 0 at an axis's default, -1 and 1 at its ends.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import product
from typing import TypeAlias

import numpy as np

from ..errors import GlyphsplineError
from ..types import BoolArray, FloatArray, IntArray, counted
from .outline import Contour, Contours, FontMetrics, Outline

Region: TypeAlias = tuple[tuple[float, float, float], ...]
"""Start, peak and end on each axis; zeros where the axis does not count."""

MOST_CORNERS = 1024
"""Corners of the grid of a design space, beyond which :meth:`Masters.grid` gives up."""


STEPS = 8
"""Places between two ticks of an axis at which a glyph is looked at. A turn changes by little from one to the next."""


@dataclass(frozen=True)
class DesignAxis:
    """An axis of a design space, in user space.

    Attributes:
        mapping: pairs of normalised values before and after the font's own mapping (``avar``), ascending.
    """

    tag: str
    name: str
    minimum: float
    default: float
    maximum: float
    mapping: tuple[tuple[float, float], ...] = ()

    def normalised(self, value: float) -> float:
        """A value of the axis as the regions count: -1 to 1. Values beyond the axis's limits are clamped."""
        value = min(max(value, self.minimum), self.maximum)
        side = self.default - self.minimum if value < self.default else self.maximum - self.default
        x = (value - self.default) / side if side > 0 else 0.0
        return float(np.interp(x, *np.array(self.mapping).T)) if self.mapping else x

    def user(self, x: float) -> float:
        """The value of the axis at a normalised one."""
        return float(self.users(np.array(x)))

    def users(self, x: FloatArray) -> FloatArray:
        """The values of the axis at normalised ones."""
        if self.mapping:
            x = np.interp(x, *np.array(self.mapping).T[::-1])
        return self.default + x * np.where(x < 0, self.default - self.minimum, self.maximum - self.default)


@dataclass(frozen=True, eq=False)
class MasterContour:
    """One contour in all masters: the same segments, with other points.

    Attributes:
        points: (K, N, 2) its points in each of the K masters; degrees: (m,) of the segments, as in
            :class:`.outline.Contour`.
    """

    points: FloatArray
    degrees: IntArray

    def cubics(self) -> FloatArray:
        """(K, m, 4, 2) all segments as cubic Béziers."""
        n, degrees, starts = self.points.shape[1], self.degrees[:, None], np.cumsum(self.degrees) - self.degrees
        a, p, q, b = (self.points[:, each % n] for each in (starts, starts + 1, starts + 2, starts + self.degrees))
        first = np.where(degrees == 3, p, np.where(degrees == 2, a + (p - a) * (2 / 3), a + (b - a) / 3))
        last = np.where(degrees == 3, q, np.where(degrees == 2, b + (p - b) * (2 / 3), b + (a - b) / 3))
        return np.stack([a, first, last, b], axis=2)

    def mixed(self, weights: FloatArray) -> Contour:
        """The contour with (K,) weights of the masters."""
        return Contour(np.einsum("k,knc->nc", weights, self.points), self.degrees)

    def reversed(self) -> MasterContour:
        """The contour in the opposite direction from the same start point."""
        return MasterContour(np.roll(self.points[:, ::-1], 1, axis=1), self.degrees[::-1])

    def __len__(self) -> int:
        return len(self.degrees)

    def __repr__(self) -> str:
        return f"<MasterContour: {counted(len(self.points), 'master')}, {counted(len(self), 'segment')}>"


@dataclass(frozen=True, eq=False)
class Masters:
    """A glyph in all masters of a variable font.

    Attributes:
        name, gid, unicodes, metrics: as :class:`.outline.Outline` has them.
        axes: A axes of the font.
        regions: (R, A, 3) start, peak and end of each region on each axis, normalised; an axis on which the peak is 0
            does not count. R = K - 1.
        contours: of the glyph, components decomposed, each in K masters: the default one first, then those at the peaks
            of the regions.
        advances: (K,) advances of the masters.
        notes: one sentence for each part that the reader left out. unread: as :class:`.outline.Outline` has it.
        repeats: of points that all masters have more than once; see :class:`.Contours`. None if there are none.
    """

    name: str
    gid: int = 0
    unicodes: tuple[int, ...] = ()
    axes: tuple[DesignAxis, ...] = ()
    regions: FloatArray = field(default_factory=lambda: np.empty((0, 0, 3)))
    contours: Sequence[MasterContour] = ()
    advances: FloatArray = field(default_factory=lambda: np.zeros(1))
    metrics: FontMetrics = field(default_factory=FontMetrics)
    notes: tuple[str, ...] = ()
    repeats: IntArray | None = None
    unread: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "contours", tuple(self.contours))
        if self.repeats is not None and not self.repeats.any():
            object.__setattr__(self, "repeats", None)

    @classmethod
    def of(cls, outline: Outline) -> Masters:
        """A glyph of a font that is not variable: one master, no axes."""
        contours = [MasterContour(contour.points[None], contour.degrees) for contour in outline.contours]
        return cls(
            outline.name, outline.gid, outline.unicodes, contours=contours, advances=np.array([outline.advance]),
            metrics=outline.metrics, notes=outline.notes, repeats=outline.repeats, unread=outline.unread,
        )  # fmt: skip

    def __repr__(self) -> str:
        tags = " ".join([axis.tag for axis in self.axes])
        counts = f"{counted(len(self), 'master')}, {counted(len(self.contours), 'contour')}"
        return f"<Masters {self.name!r} along {tags}: {counts}>"

    def __len__(self) -> int:
        return len(self.regions) + 1

    @property
    def repeats_of(self) -> list[IntArray]:
        """The repeats of each contour."""
        counts = [len(contour.degrees) for contour in self.contours]
        repeats = np.zeros(sum(counts), dtype=np.int64) if self.repeats is None else self.repeats
        return np.split(repeats, np.cumsum(counts)[:-1])

    @property
    def peaks(self) -> FloatArray:
        """(K, A) normalised locations of the masters."""
        peaks: FloatArray = np.vstack([np.zeros((1, len(self.axes))), self.regions[:, :, 1]])
        return peaks

    @property
    def stored_peaks(self) -> list[tuple[float, ...]]:
        """The locations of the masters, rounded as fonts store them."""
        return [tuple(float(x) for x in peak) for peak in np.round(self.peaks * 16384) / 16384 + 0.0]

    def normalised(self, location: Mapping[str, float]) -> FloatArray:
        """(A,) the normalised location of user-space values; axes that are not given are at their default.

        Raises:
            GlyphsplineError: there is no such axis.
        """
        tags = [axis.tag for axis in self.axes]
        for tag in location:
            if tag not in tags:
                raise GlyphsplineError(f"no axis {tag!r}: it has {', '.join(tags)}", glyph=self.name)
        return np.array([axis.normalised(location.get(axis.tag, axis.default)) for axis in self.axes])

    def user(self, at: FloatArray) -> dict[str, float]:
        """The user-space values of a normalised location (A,)."""
        return {axis.tag: axis.user(float(x)) for axis, x in zip(self.axes, at, strict=True)}

    def scalars(self, at: FloatArray) -> FloatArray:
        """(…, K) the scalar of the default, which is 1, and of each region at normalised locations (…, A)."""
        return region_scalars(self.regions, at)

    @cached_property
    def at_peaks(self) -> FloatArray:
        """(K, K) the scalars at the masters."""
        return self.scalars(self.peaks)

    @cached_property
    def _inverse(self) -> FloatArray:
        """(K, K) from scalars to weights."""
        matrix = self.at_peaks
        if np.linalg.matrix_rank(matrix) < len(self):
            raise GlyphsplineError("two regions have one peak, so that masters cannot be told apart", glyph=self.name)
        return np.asarray(np.linalg.inv(matrix), dtype=np.float64)

    def weights_at(self, at: FloatArray) -> FloatArray:
        """(…, K) weights of the masters at normalised locations (…, A)."""
        weights: FloatArray = self.scalars(at) @ self._inverse
        return weights

    def weights(self, location: Mapping[str, float]) -> FloatArray:
        """(K,) weights of the masters at a location, axis tag to user-space value; they sum to 1."""
        return self.weights_at(self.normalised(location))

    def instance(self, location: Mapping[str, float]) -> Outline:
        """The glyph at a location."""
        weights = self.weights(location)
        return self._outline([contour.mixed(weights) for contour in self.contours], float(self.advances @ weights))

    def master(self, k: int) -> Outline:
        """The glyph in master k."""
        return self._outline([Contour(each.points[k], each.degrees) for each in self.contours], float(self.advances[k]))

    def _outline(self, contours: Sequence[Contour], advance: float) -> Outline:
        of_font = Contours(contours, self.repeats)
        head = self.name, self.gid, self.unicodes, advance
        return Outline(*head, of_font, self.metrics, self.notes, unread=self.unread)

    def ticks(self, a: int) -> FloatArray:
        """Ascending normalised values of an axis between which every weight is linear: of regions, and its ends."""
        axis, regions = self.axes[a], self.regions[self.regions[:, a, 1] != 0, a]
        ends = [-1.0 * (axis.minimum < axis.default), 0.0, 1.0 * (axis.maximum > axis.default)]
        return np.unique([*ends, *np.clip(regions.ravel(), ends[0], ends[2])])

    def places(self) -> FloatArray:
        """(M, A) normalised locations to look at: the corners of the grid, and a number along each axis."""
        found = [self.grid()]
        for a in range(len(self.axes)):
            ticks = self.ticks(a)
            between = np.interp(np.arange(STEPS * (len(ticks) - 1)) / STEPS, np.arange(len(ticks)), ticks)
            along = np.zeros((len(between), len(self.axes)))
            along[:, a] = between
            found.append(along)
        return np.unique(np.concatenate(found), axis=0)

    def grid(self) -> FloatArray:
        """(V, A) normalised corners of boxes inside which every weight is a product of linear functions.

        On each axis they lie at the starts, peaks and ends of the regions and at the axis's ends. Inside a box an
        instance is a convex combination of those at its corners: what holds at all corners, and is convex, holds
        everywhere.

        Raises:
            GlyphsplineError: there are more than ``MOST_CORNERS``.
        """
        moves = (self.regions[:, :, 1] != 0).any(axis=0).tolist()  # the glyph does not change along the other axes
        ticks = [self.ticks(a) if moves[a] else np.zeros(1) for a in range(len(self.axes))]
        count = int(np.prod([len(values) for values in ticks]))
        if count > MOST_CORNERS:
            raise GlyphsplineError(
                f"its design space has {count} grid corners, more than {MOST_CORNERS}", glyph=self.name
            )
        return np.array(list(product(*ticks))).reshape(count, len(self.axes))


def region_scalars(regions: FloatArray, at: FloatArray) -> FloatArray:
    """(…, R + 1) the scalar of the default, which is 1, and of each region (R, A, 3) at locations (…, A)."""
    at = np.asarray(at, dtype=np.float64)[..., None, :]
    low, peak, high = np.moveaxis(regions, 2, 0)
    with np.errstate(divide="ignore", invalid="ignore"):
        side = np.where(at < peak, (at - low) / (peak - low), (high - at) / (high - peak))
    each = np.where((peak == 0) | (at == peak), 1.0, np.clip(side, 0.0, 1.0))
    whole: FloatArray = each.prod(axis=-1)
    return np.concatenate([np.ones((*whole.shape[:-1], 1)), whole], axis=-1)


def stacked(regions: Iterable[Region], axes: int) -> FloatArray:
    """(R, A, 3) regions as an array."""
    return np.array([*regions], dtype=np.float64).reshape(-1, axes, 3)


def distinct_regions(regions: Iterable[Region]) -> list[Region]:
    """Regions of distinct peaks, whose scalars combine linearly to those of the given regions.

    Where components of a glyph have unlike intermediate masters, regions of one peak differ in their extents: from 0
    to 1 peaking at 1, and from 0.6 to 1. Such are cut at the ticks of all regions on an axis: into one from 0 to 1
    peaking at 0.6, and one from 0.6 to 1. A region of no peak, whose scalar is 1, is the default's and left out.

    Raises:
        GlyphsplineError: a region ends abruptly at its peak, where another one goes on.
    """
    found = dict.fromkeys(region for region in regions if any(peak for _, peak, _ in region))
    while True:
        owners: dict[tuple[float, ...], list[Region]] = {}
        for region in found:
            owners.setdefault(tuple(peak for _, peak, _ in region), []).append(region)
        shared = {region for group in owners.values() if len(group) > 1 for region in group}
        if not shared:
            return list(found)
        ticks = [
            sorted({0.0, *(value for region in found for value in region[a])}) for a in range(len(next(iter(found))))
        ]
        cut = [_cut(region, ticks) if region in shared else [region] for region in found]
        pieces = dict.fromkeys(piece for of_region in cut for piece in of_region)
        if pieces.keys() == found.keys():
            raise GlyphsplineError("two regions of one peak, where one ends: masters cannot be told apart")
        found = pieces


def _cut(region: Region, ticks: Sequence[Sequence[float]]) -> list[Region]:
    """The regions between neighbouring ticks inside a region."""
    pieces = []
    for (low, peak, high), values in zip(region, ticks, strict=True):
        inside = [value for value in values if low <= value <= high]
        middle = [value for value in inside if low < value < high or value == peak]
        tents = [
            (max([low, *(v for v in inside if v < at)]), at, min([v for v in inside if v > at] or [at]))
            for at in middle
        ]
        pieces.append(tents if peak else [(0.0, 0.0, 0.0)])
    return [tuple(piece) for piece in product(*pieces)]


def quadratics(points: FloatArray, on: BoolArray) -> tuple[FloatArray, IntArray, BoolArray]:
    """A TrueType contour in K masters as quadratics and lines: points on the curve that are implied are made explicit.

    As rasterisers draw it, it begins at its first point; if this is a control point, at the last or midway to it.

    Args:
        points: (K, n, 2). on: (n,) which of them are on the curve; one between two control points is implied.

    Returns:
        Points and degrees, as in :class:`MasterContour`; (m,) whether a segment begins at an implied point.
    """
    if on[-1] and not on[0]:
        points, on = np.roll(points, 1, axis=1), np.roll(on, 1)
    before = np.arange(len(on)) - 1
    implied = ~(on | on[before])
    places = np.arange(len(on)) + np.cumsum(implied)
    midway = places[implied] - 1
    kinds = np.zeros(len(on) + len(midway))
    kinds[places], kinds[midway] = on, -1
    whole = np.empty((len(points), len(kinds), 2))
    whole[:, places] = points
    whole[:, midway] = (points[:, implied] + points[:, before[implied]]) / 2
    starts = np.flatnonzero(kinds)
    return whole, np.diff(np.append(starts, len(kinds))), kinds[starts] < 0
