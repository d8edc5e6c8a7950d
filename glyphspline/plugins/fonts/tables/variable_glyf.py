"""Glyphs of a variable font with quadratic outlines: ``glyf`` and ``gvar``, points and deltas in whole units."""

from __future__ import annotations

import struct
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from fontTools.ttLib import TTFont
from fontTools.ttLib.tables._g_l_y_f import Glyph, flagOnCurve
from fontTools.ttLib.tables.DefaultTable import DefaultTable
from fontTools.ttLib.tables.TupleVariation import (
    TupleVariation,
    compileTupleVariationStore,
    decompileSharedTuples,
    decompileTupleVariationStore,
)

from ....outlines.masters import Masters
from ....types import FloatArray
from .font_glyphs import parts_of, users
from .master_deltas import (
    numbers_of,
    region_key,
)

PHANTOMS = 4
"""Points after those of the contours, which encode the advance and the bearings."""


class GlyphRecord:
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
    def of(cls, font: TTFont, name: str, masters: Masters, gvar: Gvar | None) -> GlyphRecord:
        """A glyph of a font; ``gvar``: None in a static one."""
        coordinates, control = font["glyf"]._getCoordinatesAndControls(name, font["hmtx"].metrics)
        given = gvar.variations(name) if gvar is not None else []
        return cls(masters, coordinates, control.endPts, control.flags or (), given, gvar)

    def in_masters(self, coordinates: Sequence[Any], deltas: Sequence[Sequence[Any]]) -> FloatArray:
        """(K, n, 2) points of all masters, phantoms too, with other coordinates and deltas; None: to be inferred."""
        from fontTools.varLib.iup import iup_delta  # here and not above: with it comes all of varLib

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
