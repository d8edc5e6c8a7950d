"""The contours of a glyph in ``glyf``, with their deltas in ``gvar``: they change in whole units."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from fontTools.ttLib import TTFont
from fontTools.ttLib.tables._g_l_y_f import GlyphCoordinates
from fontTools.ttLib.tables.TupleVariation import TupleVariation

from ....outlines.masters import MasterContour, Masters, quadratics
from ....types import BoolArray, FloatArray, IntArray
from ..tables.master_deltas import rounded_deltas
from ..tables.variable_glyf import PHANTOMS, GlyphRecord, Gvar
from .stored import NEAR, REGIONS, StoredContours, matched

Deltas = list[tuple[int, int] | None]
"""Of the points of a glyph in one variation; None where they are left to be inferred."""


class GlyfContours(StoredContours):
    """The contours of a simple glyph.

    Args:
        name: the glyph's in the font. glyph: as it was read. gvar: None in a static font.
    """

    def __init__(self, font: TTFont, name: str, glyph: Masters, gvar: Gvar | None) -> None:
        self._simple, self._gid, self._gvar, self._glyph = font["glyf"][name], font.getGlyphID(name), gvar, glyph
        self._record = record = GlyphRecord.of(font, name, glyph, gvar)
        self._points = record.outline(record.drawn)
        whole = [quadratics(self._points[:, a:b], record.on[a:b])[:2] for a, b in record.spans]
        self._singles = [singles(*each) for each in whole]
        owns, why = matched(glyph, [singled(*each, own) for each, own in zip(whole, self._singles, strict=True)])
        if 0 in record.numbers or len(set(record.numbers)) < len(record.numbers):
            why = dict.fromkeys(range(len(glyph.contours)), REGIONS)
        super().__init__(owns, why)

    def masters(self, new: Masters) -> Masters:
        """See :meth:`.StoredContours.masters`: coordinates and deltas are whole numbers."""
        (default, deltas), record = self._moved(new), self._record
        every = [*map(tuple, default.tolist()), *record.coordinates[-PHANTOMS:]]
        points = record.outline(record.in_masters(every, deltas))
        contours = list(new.contours)
        for a, b, index, own in self._others(new):
            contours[index] = MasterContour(*singled(*quadratics(points[:, a:b], record.on[a:b])[:2], own))
        return replace(new, contours=contours)

    def put(self, new: Masters) -> None:
        """See :meth:`.StoredContours.put`."""
        default, deltas = self._moved(new)
        self._simple.coordinates = GlyphCoordinates(default.tolist())
        if self._gvar is not None:
            changed = [TupleVariation(each.axes, own) for each, own in zip(self._record.given, deltas, strict=True)]
            self._gvar.put(self._gid, changed)

    def _others(self, new: Masters) -> Iterator[tuple[int, int, int, IntArray]]:
        """Of contours that are others in ``new`` the first and last point, the number in the outline, and singles."""
        for (a, b), index, own in zip(self._record.spans, self.owns, self._singles, strict=True):
            if index is not None and new.contours[index] is not self._glyph.contours[index]:
                yield a, b, index, own

    def _moved(self, new: Masters) -> tuple[IntArray, list[Deltas]]:
        """(n, 2) the default's coordinates, and of each variation the deltas."""
        record = self._record
        whole, changed = self._points.copy(), np.zeros(len(record.on), dtype=bool)
        for a, b, index, own in self._others(new):
            whole[:, a:b] = as_points(new.contours[index].points[:, own], record.on[a:b])
            changed[a:b] = (np.abs(whole[:, a:b] - self._points[:, a:b]) > NEAR).any(axis=(0, 2))
        whole[:, :, 0] += record.lefts[:, None]
        wanted = np.einsum("kj,jnc->knc", np.linalg.inv(self._glyph.at_peaks), whole)
        steps = rounded_deltas(self._glyph, whole, 1)
        default = np.where(changed[:, None], steps[0], np.array(record.coordinates)[:-PHANTOMS]).astype(np.int64)
        found = []
        for k, variation in zip(record.numbers, record.given, strict=True):
            deltas = list(variation.coordinates)
            for a, b in record.spans:
                if changed[a:b].any():
                    deltas[a:b] = given_deltas(deltas[a:b], changed[a:b], steps[k, a:b], wanted[k, a:b], default[a:b])
            found.append(deltas)
        return default, found


def singles(points: FloatArray, degrees: IntArray) -> IntArray:
    """(N,) which point of a contour (K, N, 2) each one is if those that are there more than once count once."""
    starts = np.cumsum(degrees) - degrees
    behind = points[:, (starts + 1) % points.shape[1]]
    again = (degrees == 1) & (np.abs(behind - points[:, starts]).max(axis=(0, 2)) <= NEAR)
    kept = np.ones(points.shape[1], dtype=np.int64)
    kept[starts[again]] = 0
    numbers: IntArray = (np.cumsum(kept) - kept) % max(kept.sum(), 1)
    return numbers


def singled(points: FloatArray, degrees: IntArray, numbers: IntArray) -> tuple[FloatArray, IntArray]:
    """The points and degrees of a contour without those that are there again; see :func:`singles`."""
    last = np.roll(numbers, -1) != numbers
    starts = np.cumsum(degrees) - degrees
    return points[:, last], degrees[last[starts] | (degrees > 1)]


def as_points(whole: FloatArray, on: BoolArray) -> FloatArray:
    """(K, n, 2) the points of a contour of ``glyf`` from those of :func:`.masters.quadratics`."""
    turned = on[-1] and not on[0]
    kinds = np.roll(on, 1) if turned else on
    places = np.arange(len(on)) + np.cumsum(~kinds & ~np.roll(kinds, 1))
    found: FloatArray = whole[:, places]
    return np.roll(found, -1, axis=1) if turned else found


def given_deltas(old: Deltas, changed: BoolArray, steps: IntArray, wanted: FloatArray, points: IntArray) -> Deltas:
    """The deltas of a contour in a variation; None where they are inferred, as they were, and are still near enough.

    Args:
        old: as they were. changed: (n,) points that moved. steps, wanted: (n, 2) deltas, rounded and not.
        points: (n, 2) of the default.
    """
    from fontTools.varLib.iup import iup_delta  # here and not above: with it comes all of varLib

    whole = [(int(x), int(y)) for x, y in steps.tolist()]
    found: Deltas = [new if moved else was for was, new, moved in zip(old, whole, changed.tolist(), strict=True)]
    every = [*map(tuple, points.tolist()), *[(0, 0)] * PHANTOMS]
    while None in found:
        inferred = np.array(iup_delta([*found, *[(0, 0)] * PHANTOMS], every, [len(found) - 1]))[:-PHANTOMS]
        # Units by which a point whose delta a font leaves to be inferred may be off: what rounding may make of one
        # given.
        far = np.abs(inferred - wanted).max(axis=1) > 0.5
        more = [k for k, delta in enumerate(found) if delta is None and far[k]]
        if not more:
            break
        for k in more:
            found[k] = whole[k]
    return found
