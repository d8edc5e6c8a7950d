"""Glyphs of a variable font with quadratic outlines: ``glyf`` and ``gvar``, points and deltas in whole units."""

from __future__ import annotations

import struct
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
from fontTools.ttLib import TTFont
from fontTools.ttLib.tables._g_l_y_f import Glyph, flagOnCurve, flagOverlapSimple
from fontTools.ttLib.tables.DefaultTable import DefaultTable
from fontTools.ttLib.tables.TupleVariation import (
    TupleVariation,
    compileTupleVariationStore,
    decompileSharedTuples,
    decompileTupleVariationStore,
)
from fontTools.varLib.iup import iup_contour_optimize, iup_delta

from ....errors import GlyphsplineError
from ....outlines.masters import Masters, quadratics
from ....readers.pens import ContourPen
from ....types import FloatArray
from .font_glyphs import enlarged, parts_of, simple_glyph, users
from .master_deltas import (
    Redrawn,
    StoredGlyph,
    axes_of,
    check_steps,
    displaced,
    numbers_of,
    region_key,
    rounded_deltas,
)
from .quadratic_contours import Own, in_quadratics, stored_points
from .stretches import NEAR, NOTHING_NEW

PHANTOMS = 4
"""Points after those of the contours, which encode the advance and the bearings."""


class Quadratics:
    """The glyphs of a font, to be replaced one by one. Records of other glyphs keep their bytes, except those of
    composites with a new component, whose bounds change."""

    def __init__(self, font: TTFont) -> None:
        self._font, self._glyf = font, font["glyf"]
        self._gvar = Gvar(font)
        self._new: dict[str, Glyph] = {}
        self._counted, self._enlarged = placed_by_points(font), enlarged(font)

    def share(self, name: str) -> float:
        """The share of the tolerance that a glyph has, so that composites have no more than all of it."""
        return 1 / self._enlarged.get(name, 1.0)

    def replace(self, name: str, redrawn: Redrawn, tolerance: float) -> StoredGlyph:
        """Replace a glyph, within its share of the tolerance.

        Raises:
            GlyphsplineError: a coordinate does not fit, or a region of its variations is not one of the masters'.
        """
        masters = redrawn.masters
        if name in self._counted:
            raise GlyphsplineError(f"{self._counted[name]} is composed by the numbers of its points", glyph=name)
        record = Record.of(self._font, name, masters, self._gvar)
        known, given, shift = numbers_of(masters), record.given, record.lefts
        keys = [region_key(self._gvar.region(variation)) for variation in given]
        for key, variation in zip(keys, given, strict=True):
            moves = any(delta not in (None, (0, 0)) for delta in variation.coordinates[:-PHANTOMS])
            if key and key not in known and moves:
                raise GlyphsplineError("its variations have a region that its masters have not", glyph=name)
        compared, wanted = bool(redrawn.bounds), redrawn.bounds or (0.0,) * len(redrawn.contours)
        owns = own_contours(record) if compared else {}
        if redrawn.tally is None:
            redrawn = in_quadratics(redrawn, owns, shift, self.share(name) * tolerance)
        kept = {
            c: owns[number]
            for c, (number, contour) in enumerate(zip(redrawn.numbers, redrawn.contours, strict=True))
            if number in owns and np.array_equal(masters.contours[number].points, contour.points)
        }
        if kept and len(kept) == len(redrawn.contours):
            raise GlyphsplineError(NOTHING_NEW, glyph=name)
        drawn = [
            (kept[c].steps, kept[c].on) if c in kept else stored_points(masters, contour, inner, shift)
            for c, (contour, inner) in enumerate(zip(redrawn.contours, redrawn.inner, strict=True))
        ]
        none = np.zeros((len(masters), 0, 2), dtype=np.int64)
        steps = np.concatenate([none, *[points for points, _ in drawn]], axis=1)
        check_steps(steps, 1, name)
        on = np.concatenate([np.zeros(0, dtype=bool), *[flags for _, flags in drawn]])
        ends = (np.cumsum([len(flags) for _, flags in drawn]) - 1).tolist()
        flags = getattr(self._glyf[name], "flags", b"")
        self._new[name] = simple_glyph(steps[0], on, ends, bool(len(flags) and flags[0] & flagOverlapSimple))
        tags = [axis.tag for axis in masters.axes]
        for key, region in zip(known, masters.regions.tolist(), strict=True):
            if key not in keys:
                given.append(TupleVariation(axes_of(tags, region), [None] * PHANTOMS))
                keys.append(key)
        tuples = []
        for key, variation in zip(keys, given, strict=True):
            # The phantom points stay. A second tuple of the same region moves no new points.
            k = known.pop(key, None)
            moved: list[tuple[int, int] | None] = []
            for c, (points, _) in enumerate(drawn):
                if c in kept:  # points that the font leaves to be inferred stay so
                    moved += variation.coordinates[:-PHANTOMS][kept[c].place] or [None] * points.shape[1]
                else:
                    deltas = points[k] if k is not None else np.zeros_like(points[0])
                    pairs = [[(x, y) for x, y in each.tolist()] for each in (deltas, points[0])]
                    moved += iup_contour_optimize(*pairs, tolerance=0.0)
            phantoms = [delta or (0, 0) for delta in variation.coordinates[-PHANTOMS:]]
            moved += [None if delta == (0, 0) else delta for delta in phantoms]
            if any(delta is not None for delta in moved):
                tuples.append(TupleVariation(variation.axes, moved))
        self._gvar.put(self._font.getGlyphID(name), tuples)
        far = max((now - before for now, before in zip(redrawn.bounds, wanted, strict=True)), default=0.0)
        bound = max(redrawn.bounds, default=0.0)
        off = displaced(self._read(name, record), replace(masters, contours=redrawn.contours))
        return StoredGlyph(redrawn.inner, far + off, *((bound + off, redrawn.tally) if compared else (None, None)))

    def _read(self, name: str, before: Record) -> Masters:
        """A glyph that was replaced, as its new records have it."""
        glyph, phantoms = self._new[name], before.coordinates[-PHANTOMS:]
        if not glyph.numberOfContours:
            return replace(before.masters, contours=(), repeats=None)
        coordinates, flags = [*glyph.coordinates, *phantoms], np.frombuffer(bytes(glyph.flags), dtype=np.uint8)
        given = self._gvar.stored(self._font.getGlyphID(name), len(coordinates))
        record = Record(before.masters, coordinates, glyph.endPtsOfContours, flags, given, self._gvar)
        points, pen = record.outline(record.drawn), ContourPen(masters=len(before.masters))
        for a, b in record.spans:
            pen.contour(*quadratics(points[:, a:b], record.on[a:b])[:2])
        return replace(before.masters, contours=pen.stacks, repeats=None)

    def own(self, name: str, masters: Masters) -> tuple[dict[int, Own], FloatArray]:
        """The contours that a glyph has, as in :func:`own_contours`, and the (K,) shift of :func:`in_quadratics`."""
        record = Record.of(self._font, name, masters, self._gvar)
        return own_contours(record), record.lefts

    def finish(self) -> None:
        """Put the new glyphs into the font: bounds, side bearings, offsets and maxima follow."""
        put_glyphs(self._font, self._new)
        self._gvar.store(self._font)


class Record:
    """A glyph of ``glyf`` in all masters, as it is stored.

    Attributes:
        coordinates: of the default, phantoms too. on: (n,) which of them are on the curve. spans: the first point of
            each contour and the one behind its last.
        given: its variations. numbers: those of their masters; 0 of a region that the masters have not.
        drawn: (K, n, 2) its points in all masters, phantoms too.
        lefts: (K,) from where a master is drawn to where it is stored, along x: rasterisers move a glyph so that its
            left side bearing is the font's.
    """

    def __init__(
        self, masters: Masters, coordinates: Sequence[Any], ends: Sequence[int], flags: Any,
        given: list[TupleVariation], gvar: Gvar | None,
    ) -> None:  # fmt: skip
        self.masters, self.coordinates, self.given, self._ends = masters, coordinates, given, ends
        self.on = np.array([bool(flag & flagOnCurve) for flag in flags], dtype=np.bool_)
        self.spans = list(pairwise([0, *(end + 1 for end in ends)])) if len(self.on) else []
        known = numbers_of(masters)
        self.numbers = [known.get(region_key(gvar.region(each)), 0) for each in given] if gvar is not None else []
        self.drawn = self.in_masters(coordinates, [each.coordinates for each in given])
        self.lefts = self.drawn[:, -PHANTOMS, 0].copy()

    @classmethod
    def of(cls, font: TTFont, name: str, masters: Masters, gvar: Gvar | None) -> Record:
        """A glyph of a font; ``gvar``: None in a static one."""
        coordinates, control = font["glyf"]._getCoordinatesAndControls(name, font["hmtx"].metrics)
        given = gvar.variations(name) if gvar is not None else []
        return cls(masters, coordinates, control.endPts, control.flags or (), given, gvar)

    def in_masters(self, coordinates: Sequence[Any], deltas: Sequence[Sequence[Any]]) -> FloatArray:
        """(K, n, 2) points of all masters, phantoms too, with other coordinates and deltas; None: to be inferred."""
        steps = np.zeros((len(self.masters), len(coordinates), 2))
        steps[0] = coordinates
        for k, own in zip(self.numbers, deltas, strict=True):
            if k:
                steps[k] += iup_delta(own, coordinates, self._ends)
        return np.einsum("kj,jnc->knc", self.masters.at_peaks, steps)

    def outline(self, drawn: FloatArray) -> FloatArray:
        """Points as readers see them: without phantoms, from the left side bearing on."""
        points = drawn[:, :-PHANTOMS].copy()
        points[:, :, 0] -= self.lefts[:, None]
        return points


def own_contours(record: Record) -> dict[int, Own]:
    """The contours of a glyph, by their numbers in the masters; none that these do not have so."""
    masters, every, points = record.masters, record.on, record.outline(record.drawn)
    steps = rounded_deltas(masters, record.drawn[:, :-PHANTOMS], 1)
    found, pen = dict[int, Own](), ContourPen(masters=len(masters))
    for a, b in record.spans:
        whole, degrees, implied = quadratics(points[:, a:b], every[a:b])
        number = len(pen.stacks)
        pen.contour(whole, degrees)
        if len(pen.stacks) == number:
            continue
        read, wanted = pen.stacks[number].points, [each.points for each in masters.contours[number : number + 1]]
        if not any(read.shape == each.shape and np.abs(read - each).max() <= NEAR for each in wanted):
            return {}
        known = len(pen.stacks[number]) == len(degrees)
        implied = implied if known else np.zeros(len(pen.stacks[number]), dtype=bool)
        found[number] = Own(steps[:, a:b], every[a:b], slice(a, b), known, implied)
    return found


def put_glyphs(font: TTFont, new: Mapping[str, Glyph]) -> bool:
    """Put glyphs into ``glyf``: bounds, side bearings and maxima follow. Returns whether any bounds are others."""
    glyf = font["glyf"]
    before = {name: _bounds(glyf[name]) or (0, 0, 0, 0) for name in users(font, new)}
    for name, glyph in new.items():
        glyf[name] = glyph
    metrics, heights = font["hmtx"].metrics, font["vmtx"].metrics if "vmtx" in font else {}
    maxp, follows = font["maxp"], False
    for name, (left, _, _, top) in before.items():
        glyph = glyf[name]
        glyph.recalcBounds(glyf)
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
    bounds = [box for box in map(_bounds, glyf.glyphs.values()) if box]
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
        # Only composites are read.
        if glyf.glyphs[name].isComposite() and any(hasattr(part, "firstPt") for part in glyf[name].components):
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

    def stored(self, gid: int, points: int) -> list[TupleVariation]:
        """The tuples of a glyph of so many points, phantoms too, as its record has them now."""
        record = self.records[gid]
        if not record:
            return []
        shared = decompileSharedTuples(self._axes, len(self._shared), b"".join(self._shared), 0)
        count, at = struct.unpack_from(">HH", record)
        found: list[TupleVariation] = decompileTupleVariationStore(
            "gvar", self._axes, count, points, shared, record, 4, at
        )
        return found

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
