"""Glyphs of a variable font with quadratic outlines: ``glyf`` and ``gvar``, points and deltas in whole units."""

from __future__ import annotations

import struct
from collections.abc import Mapping
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
from fontTools.varLib.iup import iup_contour_optimize

from ...errors import GlyphsplineError
from ...outlines.masters import Masters
from ...types import FloatArray
from .font_glyphs import parts_of, simple_glyph, users
from .master_deltas import Redrawn, StoredGlyph, check_steps, region_key
from .quadratic_contours import PHANTOMS, Final, Own, in_quadratics, own_contours
from .stretches import NOTHING_NEW


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
        known = numbers_of(masters)
        given = self._gvar.variations(name)
        keys = [region_key(self._gvar.region(variation)) for variation in given]
        for key, variation in zip(keys, given, strict=True):
            moves = any(delta not in (None, (0, 0)) for delta in variation.coordinates[:-PHANTOMS])
            if key and key not in known and moves:
                raise GlyphsplineError("its variations have a region that its masters have not", glyph=name)
        owns, shift = self.own(name, masters)
        compared, wanted = bool(redrawn.bounds), redrawn.bounds or (0.0,) * len(redrawn.contours)
        if redrawn.tally is None:
            redrawn = in_quadratics(redrawn, owns if compared else {}, shift, tolerance)
        plans = [Final(redrawn, c, owns if compared else {}, shift) for c in range(len(redrawn.contours))]
        if compared and plans and all(plan.is_own for plan in plans):
            raise GlyphsplineError(NOTHING_NEW, glyph=name)
        drawn = [plan.points() for plan in plans]
        none = np.zeros((len(masters), 0, 2), dtype=np.int64)
        steps = np.concatenate([none, *[points for points, _ in drawn]], axis=1)
        check_steps(steps, 1, name)
        on = np.concatenate([np.zeros(0, dtype=bool), *[flags for _, flags in drawn]])
        ends = (np.cumsum([len(flags) for _, flags in drawn]) - 1).tolist()
        flags = getattr(old, "flags", b"")
        self._new[name] = simple_glyph(steps[0], on, ends, bool(len(flags) and flags[0] & flagOverlapSimple))
        tags = [axis.tag for axis in masters.axes]
        for key, region in zip(known, masters.regions.tolist(), strict=True):
            if key not in keys:
                axes = {tag: tuple(three) for tag, three in zip(tags, region, strict=True) if three[1]}
                given.append(TupleVariation(axes, [None] * PHANTOMS))
                keys.append(key)
        kept = []
        for key, variation in zip(keys, given, strict=True):
            # The phantom points stay. A second tuple of the same region moves no new points.
            k = known.pop(key, None)
            moved: list[tuple[int, int] | None] = []
            for plan, (points, _) in zip(plans, drawn, strict=True):
                if plan.is_own:  # points that the font leaves to be inferred stay so
                    own = list(variation.coordinates[:-PHANTOMS][plan.own.place])
                    moved += own or [None] * points.shape[1]
                else:
                    deltas = points[k] if k is not None else np.zeros_like(points[0])
                    pairs = [[(x, y) for x, y in each.tolist()] for each in (deltas, points[0])]
                    moved += iup_contour_optimize(*pairs, tolerance=0.0)
            phantoms = [delta or (0, 0) for delta in variation.coordinates[-PHANTOMS:]]
            moved += [None if delta == (0, 0) else delta for delta in phantoms]
            if any(delta is not None for delta in moved):
                kept.append(TupleVariation(variation.axes, moved))
        self._gvar.put(self._font.getGlyphID(name), kept)
        far = max((now - before for now, before in zip(redrawn.bounds, wanted, strict=True)), default=0.0)
        bound = max(redrawn.bounds, default=0.0)
        return StoredGlyph(
            redrawn.contours, redrawn.inner, far, *((bound, redrawn.tally) if compared else (None, None))
        )  # fmt: skip

    def own(self, name: str, masters: Masters) -> tuple[dict[int, Own], FloatArray]:
        """The contours that a glyph has, as in :func:`own_contours`, and the (K,) shift of :func:`in_quadratics`."""
        old, known = self._glyf[name], numbers_of(masters)
        keyed = [(region_key(self._gvar.region(each)), each) for each in self._gvar.variations(name)]
        tuples = [(known[key], variation) for key, variation in keyed if key in known]
        # Rasterisers move a glyph so that its left side bearing is the font's: masters drawn at 0 begin elsewhere.
        lefts = np.zeros(len(masters))
        lefts[0] = getattr(old, "xMin", 0) - self._font["hmtx"][name][1]
        for k, variation in tuples:
            if variation.coordinates[-PHANTOMS] is not None:
                lefts[k] += variation.coordinates[-PHANTOMS][0]
        shift = np.asarray(masters.at_peaks @ lefts)
        return own_contours(masters, old, tuples, shift), shift

    def finish(self) -> None:
        """Put the new glyphs into the font: bounds, side bearings, offsets and maxima follow."""
        put_glyphs(self._font, self._new)
        self._gvar.store(self._font)


def numbers_of(masters: Masters) -> dict[Any, int]:
    """Regions to the numbers of their masters; the default is 0."""
    return {region_key(region): 1 + k for k, region in enumerate(masters.regions)}


def put_glyphs(font: TTFont, new: Mapping[str, Glyph]) -> bool:
    """Put glyphs into ``glyf``: bounds, side bearings and maxima follow. Returns whether any bounds are others."""
    glyf = font["glyf"]
    names = font.getGlyphOrder()
    before = {}
    for name in users(font, new):
        glyph = glyf[name]
        before[name] = _bounds(glyph) or (0, 0, 0, 0)
    touched = list(before)
    for name, glyph in new.items():
        glyf[name] = glyph
    metrics, heights = font["hmtx"].metrics, font["vmtx"].metrics if "vmtx" in font else {}
    maxp = font["maxp"]
    follows = False
    for name in touched:
        glyph = glyf[name]
        glyph.recalcBounds(glyf)
        left, _, _, top = before[name]
        if glyph.numberOfContours:
            follows |= _bounds(glyph) != before[name]
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
    if bounds and follows:
        head = font["head"]
        low, high = np.min(bounds, axis=0), np.max(bounds, axis=0)
        head.xMin, head.yMin, head.xMax, head.yMax = (int(v) for v in (*low[:2], *high[2:]))
    return follows


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

    def store(self, font: TTFont) -> None:
        """Put the whole table into a font."""
        ends = np.cumsum([0, *map(len, self.records)])
        short = ends[-1] <= 2 * 0xFFFF and not (ends % 2).any()
        offsets = (ends // 2).astype(">u2") if short else ends.astype(">u4")
        shared = b"".join(self._shared)
        at = 20 + offsets.nbytes
        head = struct.pack(
            ">HHIHHI", len(self._axes), len(self._shared), at, len(self.records), not short, at + len(shared)
        )
        raw = font["gvar"] = DefaultTable("gvar")
        raw.data = b"".join([self._data[:4], head, offsets.tobytes(), shared, *self.records])
