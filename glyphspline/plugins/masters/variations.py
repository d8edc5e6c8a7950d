"""The masters of a variable font's glyphs: from ``gvar``, or from the blends of ``CFF2``.

Outlines are linear in the deltas, so nothing is drawn once a location: a TrueType glyph is its default points and one
array of deltas for each region, through components too; the numbers of a CFF2 char string are arrays over its masters.
HarfBuzz would drop and close segments that have no length at one location, and so give masters of unlike structure.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from fontTools.misc.psCharStrings import SimpleT2Decompiler
from fontTools.ttLib import TTFont
from fontTools.ttLib.tables._g_l_y_f import SCALED_COMPONENT_OFFSET, USE_MY_METRICS, flagCubic, flagOnCurve
from fontTools.varLib.iup import iup_delta

from ...errors import GlyphsplineError
from ...outlines.masters import DesignAxis, Masters, Region, distinct_regions, quadratics, region_scalars, stacked
from ...outlines.outline import FontMetrics
from ...readers.opentype.routes import check_variations
from ...readers.pens import MAX_COMPONENTS, MAX_SEGMENTS, ContourPen, enter_component
from ...types import BoolArray, FloatArray, Head

MOST_MASTERS = 500
"""Masters of a glyph beyond which it is refused: fonts of a dozen axes have some 80, and weights take a matrix of their
square."""


class Variations:
    """The masters of all glyphs of a variable font.

    Args:
        tables: of the font; nothing else reads them. axes: of the font, without their mappings.

    Raises:
        GlyphsplineError: the font's axes are mapped by an ``avar`` table of version 2.
    """

    def __init__(self, tables: TTFont, axes: Sequence[DesignAxis], metrics: FontMetrics) -> None:
        self._tables, self._metrics = tables, metrics
        segments = {}
        if "avar" in tables:
            if tables["avar"].majorVersion != 1:
                raise GlyphsplineError(
                    "its axes depend on each other (avar version 2): locations cannot be told axis by axis"
                )
            segments = tables["avar"].segments
        self.axes = tuple(replace(axis, mapping=tuple(sorted(segments.get(axis.tag, {}).items()))) for axis in axes)
        self._tags = [axis.tag for axis in self.axes]
        self._parts: dict[str, _Parts] = {}
        self._composed = set(tables["VARC"].table.Coverage.glyphs) if "VARC" in tables else set()

    def masters(self, head: Head) -> Masters:
        """A glyph in its masters.

        Raises:
            GlyphsplineError: the glyph is made of variable components (``VARC``), its components are in a loop, or it
                has too many parts or masters.
            Exception: the glyph is broken; fontTools' exceptions pass through.
        """
        if head.name in self._composed:
            raise GlyphsplineError("made of variable components (VARC), which have no masters of one structure")
        return self._from_cff2(head) if "CFF2" in self._tables else self._from_glyf(head)

    def _empty(self, head: Head, stored: Sequence[Region]) -> tuple[Masters, FloatArray]:
        """Masters without contours; also (K, S + 1) the scalars of the default and of the S stored regions in each."""
        regions = distinct_regions(stored)
        if len(regions) >= MOST_MASTERS:
            raise GlyphsplineError(f"{len(regions) + 1} masters, more than {MOST_MASTERS}")
        masters = Masters(*head, self.axes, stacked(regions, len(self.axes)), metrics=self._metrics)
        return masters, region_scalars(stacked(stored, len(self.axes)), masters.peaks)

    def _region(self, support: dict[str, tuple[float, float, float]]) -> Region:
        """A region of tuples by tag; on axes where the format says that it counts nothing, zeros."""
        region = []
        for tag in self._tags:
            low, peak, high = support.get(tag, (0.0, 0.0, 0.0))
            counts = peak != 0 and low <= peak <= high and not low < 0 < high
            region.append((float(low), float(peak), float(high)) if counts else (0.0, 0.0, 0.0))
        return tuple(region)

    def _from_glyf(self, head: Head) -> Masters:
        parts = self._parts_of(head.name, [])
        masters, scalars = self._empty(head, list(parts.deltas))
        stacks: FloatArray = np.tensordot(scalars, np.array([parts.points, *parts.deltas.values()]), axes=1)
        left, right = stacks[:, -2, 0], stacks[:, -1, 0]
        stacks[:, :, 0] -= left[:, None]  # where rasterisers draw it: with the left side bearing as the font has it
        pen, first = ContourPen(masters=len(masters)), 0
        for end in parts.ends:
            points, degrees, _ = quadratics(stacks[:, first:end], parts.on[first:end])
            pen.contour(points, degrees)
            first = end
        contours, advances = tuple(pen.stacks), right - left
        return replace(masters, contours=contours, advances=advances, notes=pen.notes, repeats=pen.repeated)

    def _parts_of(self, name: str, above: Sequence[str | None]) -> _Parts:
        """The points and deltas of a glyph of ``glyf``, components decomposed."""
        nesting = enter_component(above, name)
        if name not in self._parts:
            parts = self._read_parts(name, nesting)
            if not above:
                return parts
            self._parts[name] = parts  # components are asked for again
        return self._parts[name]

    def _read_parts(self, name: str, nesting: Sequence[str | None]) -> _Parts:
        glyf = self._tables["glyf"]
        check_variations(self._tables, name)
        coordinates, control = glyf._getCoordinatesAndControls(name, self._tables["hmtx"].metrics)
        points = np.array(coordinates[:-2], dtype=np.float64)  # without the phantom points of vertical metrics
        deltas: dict[Region, FloatArray] = {}
        for variation in self._tables["gvar"].variations.get(name, ()) if "gvar" in self._tables else ():
            given = variation.coordinates
            if None in given:
                given = iup_delta(given, coordinates, control.endPts)
            delta = np.array(given, dtype=np.float64)[: len(points)]
            region = self._region(variation.axes)
            deltas[region] = deltas[region] + delta if region in deltas else delta
        if glyf[name].isComposite():
            return self._composite(_Parts(points, deltas), glyf[name].components, nesting)
        if any(flag & flagCubic for flag in control.flags):
            raise GlyphsplineError("cubic curves in a glyf table, which are not supported")
        on = np.array([bool(flag & flagOnCurve) for flag in control.flags], dtype=bool)
        return _Parts(points, deltas, on, tuple(end + 1 for end in control.endPts))

    def _composite(self, own: _Parts, components: Sequence[Any], nesting: Sequence[str | None]) -> _Parts:
        """The components of a glyph in place; the points of ``own`` are their offsets, and the glyph's metrics."""
        children = [self._parts_of(component.glyphName, nesting) for component in components]
        count = len(components) + sum(child.components for child in children)
        if count > MAX_COMPONENTS:
            raise GlyphsplineError(f"more than {MAX_COMPONENTS} components")
        if sum(len(child.on) for child in children) > MAX_SEGMENTS:
            raise GlyphsplineError(f"more than {MAX_SEGMENTS} points")
        keys = dict.fromkeys(region for part in (own, *children) for region in part.deltas)
        layers: list[FloatArray] = []
        for region in (None, *keys):
            offsets, placed = own.layer(region), np.zeros((0, 2))
            metrics = offsets[-2:]
            for k, (component, child) in enumerate(zip(components, children, strict=True)):
                points, offset = child.layer(region), offsets[k]
                if component.flags & USE_MY_METRICS:
                    metrics = points[-2:]
                matrix = np.array(getattr(component, "transform", [[1, 0], [0, 1]]), dtype=np.float64)
                points = points[:-2] @ matrix
                if hasattr(component, "firstPt"):
                    offset = placed[component.firstPt] - points[component.secondPt]
                elif component.flags & SCALED_COMPONENT_OFFSET:
                    offset = offset @ matrix
                placed = np.vstack([placed, points + offset])
            layers.append(np.vstack([placed, metrics]))
        starts = np.cumsum([0, *(len(child.on) for child in children)])
        ends = [int(start) + end for start, child in zip(starts, children, strict=False) for end in child.ends]
        on = np.concatenate([child.on for child in children])
        return _Parts(layers[0], dict(zip(keys, layers[1:], strict=True)), on, tuple(ends), count)

    def _from_cff2(self, head: Head) -> Masters:
        top = self._tables["CFF2"].cff.topDictIndex[0]
        string = top.CharStrings[head.name]
        store = getattr(top.CharStrings, "varStore", None)
        reader = executed(string)
        regions, changes = self._advance_changes(head)
        if store is None or reader.numRegions is None:  # it blends nothing
            stored = [region for region, change in zip(regions, changes.tolist(), strict=True) if change]
        else:
            stored = self._regions_of(store.otVarStore, reader.vsIndex)
        masters, scalars = self._empty(head, stored)
        pen = ContourPen(masters=len(masters))
        string.draw(pen, lambda _, deltas: scalars[:, 1:] @ np.array(deltas, dtype=np.float64))
        pen.finish()
        changed = region_scalars(stacked(regions, len(self.axes)), masters.peaks)[:, 1:] @ changes
        advances = float(self._tables["hmtx"].metrics[head.name][0]) + changed
        contours = tuple(pen.stacks)
        return replace(masters, contours=contours, advances=advances, notes=pen.notes, repeats=pen.repeated)

    def _regions_of(self, store: Any, index: int) -> list[Region]:
        """The regions of one of the lists of a store, in order, as often as they occur."""
        fvar = self._tables["fvar"].axes
        regions = store.VarRegionList.Region
        return [self._region(regions[k].get_support(fvar)) for k in store.VarData[index].VarRegionIndex]

    def _advance_changes(self, head: Head) -> tuple[list[Region], FloatArray]:
        """How the advance of a glyph varies by ``HVAR``, whose regions may be others: R regions, and (R,) deltas."""
        if "HVAR" in self._tables:
            table = self._tables["HVAR"].table
            index = head.gid if table.AdvWidthMap is None else int(table.AdvWidthMap.mapping[head.name])
            outer, inner, data = index >> 16, index & 0xFFFF, table.VarStore.VarData
            if outer < len(data) and inner < len(data[outer].Item):
                return self._regions_of(table.VarStore, outer), np.array(data[outer].Item[inner], dtype=np.float64)
        return [], np.zeros(0)


@dataclass(frozen=True, eq=False)
class _Parts:
    """A glyph of ``glyf`` in design space.

    Attributes:
        points: (N + 2, 2) at the default, the ends of the advance after the N of the contours.
        deltas: (N + 2, 2) by region.
        on: (N,) which points are on the curve. ends: after the last point of each contour.
        components: their number, through all levels.
    """

    points: FloatArray
    deltas: dict[Region, FloatArray]
    on: BoolArray = field(default_factory=lambda: np.zeros(0, dtype=bool))
    ends: tuple[int, ...] = ()
    components: int = 0

    def layer(self, region: Region | None) -> FloatArray:
        """The points, or the deltas of a region."""
        return self.points if region is None else self.deltas.get(region, np.zeros_like(self.points))


def executed(string: Any) -> SimpleT2Decompiler:
    """What a char string of CFF2 does beyond drawing: the regions that it blends."""
    reader = SimpleT2Decompiler(getattr(string.private, "Subrs", []), string.globalSubrs, string.private)
    reader.execute(string)
    return reader
