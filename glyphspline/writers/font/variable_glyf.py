"""Glyphs of a variable font with quadratic outlines: ``glyf`` and ``gvar``, points and deltas in whole units."""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from fontTools.ttLib import TTFont
from fontTools.ttLib.tables._g_l_y_f import (
    Glyph,
    flagOverlapSimple,
)
from fontTools.ttLib.tables.DefaultTable import DefaultTable
from fontTools.ttLib.tables.TupleVariation import TupleVariation, compileTupleVariationStore
from fontTools.varLib.iup import iup_delta_optimize

from ...curves.cubics import turns
from ...errors import GlyphsplineError
from ...outlines.masters import MasterContour, Masters, quadratics
from ...types import BoolArray, FloatArray, IntArray
from .font_glyphs import parts_of, simple_glyph, users
from .implied_quadratics import Arc, fit
from .master_deltas import Redrawn, StoredGlyph, as_drawn, check_steps, region_key, rounded_deltas

LEVEL = np.radians(0.5)
"""Turn between a line and an arc up to which, if no master turns more, the arc begins along the line."""

BETWEEN = 16
"""Locations inside the design space, besides the corners of its grid, where the distance of quadratics is measured."""

PHANTOMS = 4
"""Points after those of the contours, which encode the advance and the bearings."""


class Quadratics:
    """The glyphs of a font, to be replaced one by one. Records of other glyphs keep their bytes, except those of
    composites with a new component, whose bounds change."""

    def __init__(self, font: TTFont) -> None:
        self._font, self._glyf = font, font["glyf"]
        self._gvar = Gvar(font)
        self._new: dict[str, Glyph] = {}
        self._counted = placed_by_points(font)

    def replace(self, name: str, redrawn: Redrawn, tolerance: float) -> StoredGlyph:
        """Replace a glyph.

        Raises:
            GlyphsplineError: a coordinate does not fit, or a region of its variations is not one of the masters'.
        """
        masters = redrawn.masters
        if name in self._counted:
            raise GlyphsplineError(f"{self._counted[name]} is composed by the numbers of its points", glyph=name)
        old = self._glyf[name]
        # Regions to the numbers of their masters; the default is 0.
        known: dict[Any, int] = {region_key(region): 1 + k for k, region in enumerate(masters.regions)}
        given = self._gvar.variations(name)
        keys = [region_key(self._gvar.region(variation)) for variation in given]
        for key, variation in zip(keys, given, strict=True):
            moves = any(delta not in (None, (0, 0)) for delta in variation.coordinates[:-PHANTOMS])
            if key and key not in known and moves:
                raise GlyphsplineError("its variations have a region that its masters have not", glyph=name)
        # Rasterisers move a glyph so that its left side bearing is the font's: masters drawn at 0 begin elsewhere.
        lefts = np.zeros(len(masters))
        lefts[0] = getattr(old, "xMin", 0) - self._font["hmtx"][name][1]
        for key, variation in zip(keys, given, strict=True):
            if key in known and variation.coordinates[-PHANTOMS] is not None:
                lefts[known[key]] += variation.coordinates[-PHANTOMS][0]
        shift = np.asarray(masters.scalars(masters.peaks) @ lefts)
        drawn = [
            drawn_contour(masters, contour, inner, shift, tolerance)
            for contour, inner in zip(redrawn.contours, redrawn.inner, strict=True)
        ]
        none = np.zeros((len(masters), 0, 2), dtype=np.int64)
        steps = np.concatenate([none, *[each.steps for each in drawn]], axis=1)
        check_steps(steps, 1, name)
        on = np.concatenate([np.zeros(0, dtype=bool), *[each.on for each in drawn]])
        ends = (np.cumsum([len(each.on) for each in drawn]) - 1).tolist()
        flags = getattr(old, "flags", b"")
        self._new[name] = simple_glyph(steps[0], on, ends, bool(len(flags) and flags[0] & flagOverlapSimple))
        tags = [axis.tag for axis in masters.axes]
        for key, region in zip(known, masters.regions.tolist(), strict=True):
            if key not in keys:
                axes = {tag: tuple(three) for tag, three in zip(tags, region, strict=True) if three[1]}
                given.append(TupleVariation(axes, [None] * PHANTOMS))
                keys.append(key)
        places, kept = [*map(tuple, steps[0].tolist()), *[(0, 0)] * PHANTOMS], []
        for key, variation in zip(keys, given, strict=True):
            # The phantom points stay. A second tuple of the same region moves no points.
            deltas = steps[known.pop(key)] if key in known else np.zeros_like(steps[0])
            phantoms = [delta or (0, 0) for delta in variation.coordinates[-PHANTOMS:]]
            moved = iup_delta_optimize([*map(tuple, deltas.tolist()), *phantoms], places, ends, tolerance=0.0)
            if any(delta is not None for delta in moved):
                kept.append(TupleVariation(variation.axes, moved))
        self._gvar.put(self._font.getGlyphID(name), kept)
        shortest = min((each.shortest for each in drawn), default=np.inf)
        return StoredGlyph(
            tuple(each.stored for each in drawn),
            tuple(each.implied for each in drawn),
            max((each.distance for each in drawn), default=0.0),
            shortest if np.isfinite(shortest) else None,
        )

    def finish(self) -> None:
        """Put the new glyphs into the font: bounds, side bearings, offsets and maxima follow."""
        font, glyf = self._font, self._glyf
        names = font.getGlyphOrder()
        before = {}
        for name in users(font, self._new):
            glyph = glyf[name]
            before[name] = (glyph.xMin, glyph.yMax) if glyph.numberOfContours else (0, 0)
        touched = list(before)
        for name, glyph in self._new.items():
            glyf[name] = glyph
        metrics, heights = font["hmtx"].metrics, font["vmtx"].metrics if "vmtx" in font else {}
        maxp = font["maxp"]
        for name in touched:
            glyph = glyf[name]
            glyph.recalcBounds(glyf)
            left, top = before[name]
            if glyph.numberOfContours:
                advance, bearing = metrics[name]
                metrics[name] = (advance, bearing + glyph.xMin - left)
                if name in heights:
                    height, bearing = heights[name]
                    heights[name] = (height, bearing + top - glyph.yMax)
            if glyph.isComposite():
                values = glyph.getCompositeMaxpValues(glyf)
                maxp.maxCompositePoints = min(max(maxp.maxCompositePoints, values.nPoints), 0xFFFF)
                maxp.maxCompositeContours = min(max(maxp.maxCompositeContours, values.nContours), 0xFFFF)
            elif glyph.numberOfContours:
                maxp.maxPoints = max(maxp.maxPoints, len(glyph.coordinates))
                maxp.maxContours = max(maxp.maxContours, glyph.numberOfContours)
        bounds = [box for box in (_bounds(glyf.glyphs[name]) for name in names) if box]
        if bounds:
            head = font["head"]
            low, high = np.min(bounds, axis=0), np.max(bounds, axis=0)
            head.xMin, head.yMin, head.xMax, head.yMax = (int(v) for v in (*low[:2], *high[2:]))
        raw = DefaultTable("gvar")
        raw.data = self._gvar.compiled()
        font["gvar"] = raw


def _bounds(glyph: Any) -> tuple[int, ...] | None:
    """The box in a glyph's record, read or not."""
    if hasattr(glyph, "data"):
        count, *box = struct.unpack_from(">5h", glyph.data) if glyph.data else (0,)
        return tuple(box) if count else None
    return (glyph.xMin, glyph.yMin, glyph.xMax, glyph.yMax) if glyph.numberOfContours else None


def placed_by_points(font: TTFont) -> dict[str, str]:
    """Glyphs whose points have numbers that matter, and the composite that counts them to place its components."""
    glyf = font["glyf"]
    found: dict[str, str] = {}
    for name in font.getGlyphOrder():
        glyph = glyf[name]
        if glyph.isComposite() and any(hasattr(part, "firstPt") for part in glyph.components):
            found |= dict.fromkeys(parts_of(font, name), name)
    return found


@dataclass(frozen=True, eq=False)
class Drawn:
    """A contour as it is stored.

    Attributes:
        steps: (K, N, 2) the default and the deltas of its points. on: (N,) which of them are on the curve.
        stored: what they draw in each master. implied: (m,) whether its segments begin at implied points.
        distance: the largest from the contour that was given.
        shortest: the shortest leg of a quadratic at an implied point; infinite if there is none.
    """

    steps: IntArray
    on: BoolArray
    stored: MasterContour
    implied: BoolArray
    distance: float
    shortest: float


def drawn_contour(
    masters: Masters, contour: MasterContour, inner: BoolArray, shift: FloatArray, tolerance: float
) -> Drawn:
    """A contour in quadratics, within ``tolerance`` if that can be had in whole units.

    Args:
        inner: (m,) whether segment j begins inside an arc: there are only implied points on the curve.
        shift: (K,) from where a master is drawn to where it is stored, along x.
    """
    offset = shift[:, None, None] * np.array([1.0, 0.0])

    def rounded(points: FloatArray, metric: FloatArray | None = None) -> FloatArray:
        return as_drawn(masters, rounded_deltas(masters, points + offset, 1, metric), 1) - offset

    weights = masters.weights_at(locations(masters))
    cubics, degrees = contour.cubics(), contour.degrees
    arcs = [Arc(cubics, True, cubics[:, :2, 0])] if inner.all() else cut(cubics, degrees, inner, rounded)
    parts, on, distances, legs = [], [], [0.0], [np.inf]
    for arc in arcs:
        if not arc.closed:
            parts.append(arc.ends[:, :1])
            on.append(True)
            moved = weights @ (arc.ends[:, 0] - arc.cubics[:, 0, 0])
            distances.append(float(np.hypot(*moved.T).max()))
        if not arc.straight:
            fitted = fit(arc, weights, tolerance, rounded)
            parts.append(fitted.controls)
            on += [False] * fitted.controls.shape[1]
            distances.append(fitted.distance)
            legs.append(fitted.shortest)
    points = np.concatenate(parts, axis=1)
    whole, kinds, implied = quadratics(points, np.array(on))
    steps = rounded_deltas(masters, points + offset, 1)
    return Drawn(steps, np.array(on), MasterContour(whole, kinds), implied, max(distances), min(legs))


def cut(
    cubics: FloatArray, degrees: IntArray, inner: BoolArray, rounded: Callable[[FloatArray], FloatArray]
) -> list[Arc]:
    """The lines and arcs of a contour with corners, from its first end on, and their ends rounded."""
    starts = np.flatnonzero(~inner)
    counts = np.diff([*starts, starts[0] + len(degrees)])
    spans = [np.arange(start, start + count) % len(degrees) for start, count in zip(starts, counts, strict=True)]
    ends = rounded(cubics[:, starts, 0])
    straight = [len(span) == 1 and degrees[span[0]] == 1 for span in spans]
    level = np.array([np.abs(turns(master, 1e-9)) for master in cubics]).max(axis=0)[starts] < LEVEL
    arcs = []
    for k, span in enumerate(spans):
        here, there, beyond = ends[:, k], ends[:, (k + 1) % len(ends[0])], ends[:, (k + 2) % len(ends[0])]
        following = (k + 1) % len(spans)
        leaving = here - ends[:, k - 1] if straight[k - 1] and level[k] else None
        arriving = there - beyond if straight[following] and level[following] else None
        arcs.append(Arc(cubics[:, span], False, np.stack([here, there], axis=1), straight[k], leaving, arriving))
    return arcs


def locations(masters: Masters) -> FloatArray:
    """(V, A) normalised locations: the corners of the grid, and some inside."""
    corners = masters.grid()
    low, high = corners.min(axis=0), corners.max(axis=0)
    return np.vstack([corners, np.random.default_rng(0).uniform(low, high, (BETWEEN, len(low)))])


class Gvar:
    """The variations of a font, glyph by glyph: records that nothing changes keep their bytes."""

    def __init__(self, font: TTFont) -> None:
        self._table = font["gvar"]
        self._axes = [axis.axisTag for axis in font["fvar"].axes]
        self._names = font.getGlyphOrder()
        data = self._data = font.reader["gvar"]
        shared_count, shared_at, count, flags, at = struct.unpack_from(">HIHHI", data, 6)
        size = 4 if flags & 1 else 2
        offsets = np.frombuffer(data, f">u{size}", count + 1, 20).astype(np.int64) * (4 // size if size == 2 else 1)
        self.records = [data[at + a : at + b] for a, b in pairwise(offsets.tolist())]
        length = 2 * len(self._axes)
        self._shared = [data[shared_at + k * length :][:length] for k in range(shared_count)]

    def variations(self, name: str) -> list[TupleVariation]:
        """The tuples of a glyph. The table would keep all that it was asked for, in lists of tuples."""
        found = self._table.variations.data.get(name, ())
        return list(found(name) if callable(found) else found)

    def region(self, variation: TupleVariation) -> FloatArray:
        """(A, 3) where a tuple counts."""
        return np.array([variation.axes.get(tag, (0.0, 0.0, 0.0)) for tag in self._axes])

    def put(self, gid: int, variations: list[TupleVariation]) -> None:
        """Replace the record of a glyph."""
        shared = {coordinates: k for k, coordinates in enumerate(self._shared)}
        count, tuples, data = compileTupleVariationStore(variations, 0, self._axes, shared)
        record = struct.pack(">HH", count, 4 + len(tuples)) + tuples + data if count else b""
        self.records[gid] = record + b"\0" * (len(record) % 2)

    def compiled(self) -> bytes:
        """The whole table."""
        ends = np.cumsum([0, *map(len, self.records)])
        short = ends[-1] <= 2 * 0xFFFF and not (ends % 2).any()
        offsets = (ends // 2).astype(">u2") if short else ends.astype(">u4")
        shared = b"".join(self._shared)
        at = 20 + offsets.nbytes
        head = struct.pack(
            ">HHIHHI", len(self._axes), len(self._shared), at, len(self.records), not short, at + len(shared)
        )
        return b"".join([self._data[:4], head, offsets.tobytes(), shared, *self.records])
