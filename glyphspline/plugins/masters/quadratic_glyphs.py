"""Glyphs of a variable font with quadratic outlines drawn anew: points and deltas in whole units."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from fontTools.ttLib import TTFont
from fontTools.ttLib.tables._g_l_y_f import Glyph, flagOverlapSimple
from fontTools.ttLib.tables.TupleVariation import TupleVariation
from fontTools.varLib.iup import iup_contour_optimize

from ...errors import GlyphsplineError
from ...outlines.masters import Masters, quadratics
from ...readers.pens import ContourPen
from ...types import FloatArray
from ..fonts.tables.font_glyphs import enlarged, simple_glyph
from ..fonts.tables.master_deltas import axes_of, check_steps, numbers_of, region_key, rounded_deltas
from ..fonts.tables.variable_glyf import PHANTOMS, GlyphRecord, Gvar, placed_by_points, put_glyphs
from .quadratic_contours import Own, in_quadratics, stored_points
from .redrawn import Redrawn, StoredGlyph, displaced
from .stretches import NEAR, NOTHING_NEW


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
        record = GlyphRecord.of(self._font, name, masters, self._gvar)
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

    def _read(self, name: str, before: GlyphRecord) -> Masters:
        """A glyph that was replaced, as its new records have it."""
        glyph, phantoms = self._new[name], before.coordinates[-PHANTOMS:]
        if not glyph.numberOfContours:
            return replace(before.masters, contours=(), repeats=None)
        coordinates, flags = [*glyph.coordinates, *phantoms], np.frombuffer(bytes(glyph.flags), dtype=np.uint8)
        given = self._gvar.stored(self._font.getGlyphID(name), len(coordinates))
        record = GlyphRecord(before.masters, coordinates, glyph.endPtsOfContours, flags, given, self._gvar)
        points, pen = record.outline(record.drawn), ContourPen(masters=len(before.masters))
        for a, b in record.spans:
            pen.contour(*quadratics(points[:, a:b], record.on[a:b])[:2])
        return replace(before.masters, contours=pen.stacks, repeats=None)

    def own(self, name: str, masters: Masters) -> tuple[dict[int, Own], FloatArray]:
        """The contours that a glyph has, as in :func:`own_contours`, and the (K,) shift of :func:`in_quadratics`."""
        record = GlyphRecord.of(self._font, name, masters, self._gvar)
        return own_contours(record), record.lefts

    def finish(self) -> None:
        """Put the new glyphs into the font: bounds, side bearings, offsets and maxima follow."""
        put_glyphs(self._font, self._new)
        self._gvar.store(self._font)


def own_contours(record: GlyphRecord) -> dict[int, Own]:
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
