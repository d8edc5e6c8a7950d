"""What mending measures of a glyph: what is found in it, how far curves moved, and its axes and grid."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from ...curves.nearest import near_places
from ...curves.pairing import SHARPNESS, pair_instances
from ...outlines.contour_arrays import offsets_of
from ...outlines.flaws.kinds import KINDS, Thresholds
from ...outlines.flaws.turns import joint_controls, largest_turns, turns_of
from ...outlines.masters import MasterContour, Masters
from ...types import FloatArray, IntArray
from ..checks.check import measured
from ..checks.finding import Measured
from ..masters.on_axes import OF_CONTOURS, on_axes
from .joints import SMOOTH, ContourLayout, starts_of

PER_EM = 1e-3
"""The tolerance as a share of the em, unless another is given."""

STEPS = 8
"""Steps of each axis, at whose ends findings other than kinks are looked for besides the masters."""

DIGITS = 3
"""Decimals of coordinates at most."""

INSIDE = 6
"""Parts of an interval of an axis between two ticks, at whose ends turns are bounded."""

HALVINGS = 8
"""How often parts of the design space are halved in which curves are near, but not certified to be."""


Key = tuple[int, int, int, int]
"""Kind, contour, segment and other contour of a finding; those of whole contours have no segment, -1."""


@dataclass(frozen=True)
class Change:
    """What became of a finding.

    Attributes:
        glyph, gid: which glyph. kind: of the finding. contour, segment: as ``check`` numbers them.
        point: where the segment begins in the default master, as it was.
        before: the finding's largest value at any location, in its unit. after: of a kink, the largest turn when it is
            mended; None of other kinds, of which nothing is left, and if it is left.
        moved: the largest move of a point in any master; 0.0 if it is left, or if points only went.
        moves: master, number of the point in the contour, old and new place of every point that moved.
        gone: number of points that went.
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
    gone: int = 0
    distance: float | None = None
    why: str | None = None
    needs: float | None = None

    @property
    def is_mended(self) -> bool:
        """Whether points moved, so that it is no longer found."""
        return self.why is None


class Tally:
    """What is found in a glyph: the number of findings by what they are, and their values by kind and place."""

    def __init__(self, rows: Measured) -> None:
        self.found = Counter(_keys(rows))
        self.values: dict[str, dict[tuple[int, int], float]] = {kind.name: {} for kind in KINDS}
        columns = rows.kinds, rows.contours, rows.segments, rows.numbers[:, 1]
        for what, c, s, value in zip(*(column.tolist() for column in columns), strict=True):
            self.values[KINDS[what].name].setdefault((c, s), value)

    def has(self, kinds: Collection[str]) -> bool:
        """Whether there is a finding of one of these kinds."""
        return any(self.values[kind] for kind in kinds)

    @classmethod
    def of(cls, masters: Masters, thresholds: Thresholds, outer: int) -> Tally:
        """Check a glyph: where it is, or in its masters and along all its axes."""
        (found,) = cls.of_many([masters], thresholds, outer)
        return found

    @classmethod
    def of_many(cls, glyphs: Sequence[Masters], thresholds: Thresholds, outer: int) -> list[Tally]:
        """The same for glyphs of one source, which takes less time for each."""
        axes, em = glyphs[0].axes, glyphs[0].metrics.units_per_em
        if axes:
            rows, _ = on_axes(glyphs, {}, [axis.tag for axis in axes], STEPS, thresholds, outer, True)
        else:
            rows = measured([each.master(0).contours for each in glyphs], thresholds, em, outer)
        return [cls(rows.chosen(np.flatnonzero(rows.glyphs == number))) for number in range(len(glyphs))]


def _keys(rows: Measured) -> list[Key]:
    """What each row is."""
    segments = np.where(np.isin(rows.kinds, OF_CONTOURS), -1, rows.segments)
    return [*zip(*(x.tolist() for x in (rows.kinds, rows.contours, segments, rows.numbers[:, 3])), strict=True)]


@dataclass(frozen=True)
class Into:
    """What the file that a glyph goes back into allows.

    Attributes:
        fixed: contours that may not change, and why. points_stay: why no points may go or change their order.
        stored: what the file makes of a glyph: it rounds coordinates. step: to which multiple of a unit; None if that
            is to be seen from the points.
    """

    fixed: Mapping[int, str] = field(default_factory=dict)
    points_stay: str | None = None
    stored: Callable[[Masters], Masters] | None = None
    step: float | None = None


class Design(NamedTuple):
    """What holds for all joints of a glyph.

    Attributes:
        grid: (…, K) weights of the masters at the corners of the design space's grid, of a dimension for each axis,
            between which every location lies. ticks: of each axis (T, K), between which weights are linear along it.
        places: (L, K) the masters and places on the axes and on pairs of them.
        step: of the grid of points, whole units or the source's decimals. tolerance: in font units.
        em: font units in an em. thresholds: of findings.
    """

    grid: FloatArray
    ticks: list[FloatArray]
    places: FloatArray
    step: float
    tolerance: float
    em: float
    thresholds: Thresholds

    @classmethod
    def of(cls, masters: Masters, tolerance: float, thresholds: Thresholds, step: float | None) -> Design:
        """Look at a glyph's axes, and at its points where ``step`` is not known."""
        axes = [a for a in range(len(masters.axes)) if (masters.regions[:, a, 1] != 0).any()]
        along, places, unit = [], [masters.peaks], np.eye(len(masters.axes))
        for a in axes:
            along.append(masters.weights_at(masters.ticks(a)[:, None] * unit[a]))
            places.append(_refined(masters.ticks(a), INSIDE)[:, None] * unit[a])
        grid, weights = np.ones(1), np.ones((1, 1))
        if axes:
            weights = masters.weights_at(np.unique(np.concatenate(places), axis=0))
            grid = masters.weights_at(masters.grid()).reshape(*(len(masters.ticks(a)) for a in axes), -1)
        drawn = [contour.points[:, ~ContourLayout(contour).implied].ravel() for contour in masters.contours]
        every = np.concatenate([np.zeros(1), *drawn])
        digits = (d for d in range(DIGITS) if np.abs(every - np.round(every, d)).max() < 1e-6)
        step, em = step or float(10.0 ** -next(digits, DIGITS)), float(masters.metrics.units_per_em)
        return cls(grid, along, weights, step, tolerance, em, thresholds)

    @property
    def corners(self) -> FloatArray:
        """(V, K) the grid's corners."""
        return self.grid.reshape(-1, self.grid.shape[-1])

    def largest_turns(self, controls: FloatArray) -> FloatArray:
        """(n,) degrees by which joints (K, n, 2, 4, 2) turn at most, in the masters and along each axis: exact."""
        found = np.abs(turns_of(controls)).max(axis=0)
        for weights in self.ticks:
            at = np.tensordot(weights, controls, axes=1)  # (T, n, 2, 4, 2)
            turns, _ = largest_turns(*(each.reshape(-1, 2, 4, 2) for each in (at[:-1], at[1:])))
            found = np.maximum(found, turns.reshape(len(at) - 1, -1).max(axis=0, initial=0.0))
        return found


def _refined(ticks: FloatArray, parts: int) -> FloatArray:
    """Ascending values with others evenly between them."""
    return np.interp(np.arange((len(ticks) - 1) * parts + 1) / parts, np.arange(len(ticks)), ticks)


def distances(old: MasterContour, new: MasterContour, design: Design, anchors: FloatArray | None = None) -> FloatArray:
    """(m,) certified bounds of how far each segment of the new contour is from the old one, at any location.

    Args:
        anchors: (m + 1, 2) where the new segments begin on the new and on the old contour; by default the two have the
            same segments, and a joint is paired with the place that it slid to.
    """
    one, other, none = old.cubics(), new.cubics(), np.empty((0, 4))
    if anchors is not None:
        return _measured(design.corners, one, other, np.arange(len(new)), none, design.tolerance, anchors)
    bounds = np.zeros(len(new))
    arcs = arcs_of(old, new)
    moved = np.flatnonzero((one != other).any(axis=(0, 2, 3)))
    boxes = [(design.grid, moved, 0)]
    while boxes:
        grid, own, halvings = boxes.pop()
        corners = grid.reshape(-1, grid.shape[-1])
        found = _measured(corners, one, other, own, arcs if len(corners) > 1 else none, design.tolerance)
        far = np.flatnonzero(~(found <= design.tolerance))
        if len(far) and len(corners) > 1 and halvings < HALVINGS:
            single = [_measured(each[None], one, other, own[far], none, design.tolerance) for each in corners]
            again = far[np.max(single, axis=0) <= design.tolerance]
            if len(again):
                found[again] = 0.0
                boxes += [(half, own[again], halvings + 1) for half in _halves(grid, new.points - old.points)]
        bounds[own] = np.maximum(bounds[own], found)
    return bounds


def _halves(grid: FloatArray, moves: FloatArray) -> list[FloatArray]:
    """The two parts of a grid of the design space, cut across the axis along which moves (K, N, 2) differ most."""
    axes = range(grid.ndim - 1)
    axis = max(axes, key=lambda a: np.abs(np.diff(grid, axis=a) @ moves.reshape(len(moves), -1)).max(initial=-1.0))
    at = np.moveaxis(grid, axis, 0)
    if len(at) == 2:
        at = np.stack([at[0], at.mean(axis=0), at[1]])
    half = len(at) // 2
    return [np.moveaxis(part, 0, axis) for part in (at[: half + 1], at[half:])]


def _measured(
    corners: FloatArray, old: FloatArray, new: FloatArray, own: IntArray, arcs: FloatArray,
    tolerance: float, anchors: FloatArray | None = None,
) -> FloatArray:  # fmt: skip
    """(s,) certified bounds of some segments of (K, m, 4, 2) at every location between some (V, K).

    Args:
        arcs, anchors: see :func:`.pair_instances`; without anchors a joint is paired with the nearest place of the old
            contour, at all locations, unless it stays.
    """
    V, m = len(corners), new.shape[1]
    sources, results = (
        np.ascontiguousarray(np.swapaxes(np.tensordot(corners, cubics, axes=1), 0, 1).reshape(-1, 4, 2))
        for cubics in (old, new)
    )
    if anchors is None:
        places = np.arange(float(m))
        same = (old[:, :, 0] == new[:, :, 0]).all(axis=(0, 2))
        near_places(V, sources, places, results, same, True, 0.0, 0.0, places)
        anchors = np.column_stack([np.arange(m + 1.0), np.append(places, places[0] + m)])
    found = np.zeros(m)
    # Of arcs one by one: together none would be refined once another one of its arc is beyond the tolerance.
    for some in own[:, None] if len(arcs) else own[None]:
        bounds = np.zeros(m)
        bounds[some] = np.nan
        pair_instances(
            V, (results, offsets_of([m])), (sources, offsets_of([old.shape[1]])), (anchors, offsets_of([m + 1])), arcs,
            SHARPNESS * tolerance, tolerance, bounds, np.zeros(m),
        )  # fmt: skip
        found += bounds
    return found[own]


def arcs_of(contour: MasterContour, other: MasterContour) -> FloatArray:
    """(m, 4) the arc between corners that each segment belongs to, as :func:`.pair_instances` takes it.

    It is (0, 4) where a corner is elsewhere in the other contour: arcs have their ends in common.
    """
    m, starts = len(contour), starts_of(contour)
    with np.errstate(invalid="ignore"):
        smooth = (np.abs(turns_of(joint_controls(contour))) < SMOOTH).all(axis=0)
    corners = np.flatnonzero(~smooth)
    if not len(corners):
        return np.tile([-np.inf, np.inf, -np.inf, np.inf], (m, 1))
    if (contour.points[:, starts[corners]] != other.points[:, starts[corners]]).any():
        return np.empty((0, 4))
    segments = np.arange(m)
    at = np.searchsorted(corners, segments, side="right")
    first = np.where(at > 0, corners[at - 1], corners[-1] - m)
    last = np.where(at < len(corners), corners[at % len(corners)], corners[0] + m)
    return np.column_stack([first, last, first, last]).astype(np.float64)
