"""The contours of a glyph in ``glyf``, with their deltas in ``gvar``: they change in whole units."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from fontTools.ttLib import TTFont
from fontTools.ttLib.tables._g_l_y_f import GlyphCoordinates, flagOnCurve
from fontTools.ttLib.tables.TupleVariation import TupleVariation
from fontTools.varLib.iup import iup_delta

from ...outlines.masters import MasterContour, Masters, quadratics
from ...types import BoolArray, FloatArray, IntArray
from ..font.master_deltas import region_key, rounded_deltas
from ..font.quadratic_contours import PHANTOMS
from ..font.variable_glyf import Gvar
from .stored import NEAR, REGIONS, Stored, matched

Deltas = list[tuple[int, int] | None]
"""Of the points of a glyph in one variation; None where they are left to be inferred."""


class GlyfContours(Stored):
    """The contours of a simple glyph.

    Args:
        name: the glyph's in the font. glyph: as it was read. gvar: None in a static font.
    """

    def __init__(self, font: TTFont, name: str, glyph: Masters, gvar: Gvar | None) -> None:
        glyf = font["glyf"]
        self._record, self._gid, self._gvar, self._glyph = glyf[name], font.getGlyphID(name), gvar, glyph
        self._coordinates, control = glyf._getCoordinatesAndControls(name, font["hmtx"].metrics)
        self._ends = control.endPts
        self._spans = list(pairwise([0, *(end + 1 for end in self._ends)]))
        self._on = np.array([bool(flag & flagOnCurve) for flag in control.flags])
        keys = {region_key(region): 1 + k for k, region in enumerate(glyph.regions)}
        self._given = gvar.variations(name) if gvar is not None else []
        self._numbers = [keys.get(region_key(gvar.region(each)), 0) for each in self._given] if gvar is not None else []
        self._scalars = glyph.scalars(glyph.peaks)
        drawn = self._drawn(self._coordinates, [each.coordinates for each in self._given])
        self._lefts = drawn[:, -PHANTOMS, 0].copy()
        self._points = self._outline(drawn)
        whole = [quadratics(self._points[:, a:b], self._on[a:b])[:2] for a, b in self._spans]
        self._singles = [singles(*each) for each in whole]
        owns, why = matched(glyph, [singled(*each, own) for each, own in zip(whole, self._singles, strict=True)])
        if 0 in self._numbers or len(set(self._numbers)) < len(self._numbers):
            why = dict.fromkeys(range(len(glyph.contours)), REGIONS)
        super().__init__(owns, why)

    def masters(self, new: Masters) -> Masters:
        """See :meth:`.Stored.masters`: coordinates and deltas are whole numbers."""
        default, deltas = self._moved(new)
        every = [*map(tuple, default.tolist()), *self._coordinates[-PHANTOMS:]]
        points = self._outline(self._drawn(every, deltas))
        contours = list(new.contours)
        for a, b, index, own in self._others(new):
            contours[index] = MasterContour(*singled(*quadratics(points[:, a:b], self._on[a:b])[:2], own))
        return replace(new, contours=contours)

    def put(self, new: Masters) -> None:
        """See :meth:`.Stored.put`."""
        default, deltas = self._moved(new)
        self._record.coordinates = GlyphCoordinates(default.tolist())
        if self._gvar is not None:
            changed = [TupleVariation(each.axes, own) for each, own in zip(self._given, deltas, strict=True)]
            self._gvar.put(self._gid, changed)

    def _others(self, new: Masters) -> Iterator[tuple[int, int, int, IntArray]]:
        """Of contours that are others in ``new`` the first and last point, the number in the outline, and singles."""
        for (a, b), index, own in zip(self._spans, self.owns, self._singles, strict=True):
            if index is not None and new.contours[index] is not self._glyph.contours[index]:
                yield a, b, index, own

    def _drawn(self, coordinates: Sequence[tuple[int, int]], deltas: Sequence[Deltas]) -> FloatArray:
        """(K, n, 2) points of all masters, phantoms too."""
        whole = np.zeros((len(self._glyph), len(coordinates), 2))
        for k, own in zip(self._numbers, deltas, strict=True):
            whole[k] = np.array(iup_delta(own, coordinates, self._ends))
        whole[0] = coordinates
        return np.einsum("kj,jnc->knc", self._scalars, whole)

    def _outline(self, drawn: FloatArray) -> FloatArray:
        """Points as readers see them: without phantoms, from the left side bearing on."""
        points = drawn[:, :-PHANTOMS].copy()
        points[:, :, 0] -= self._lefts[:, None]
        return points

    def _moved(self, new: Masters) -> tuple[IntArray, list[Deltas]]:
        """(n, 2) the default's coordinates, and of each variation the deltas."""
        whole, changed = self._points.copy(), np.zeros(len(self._on), dtype=bool)
        for a, b, index, own in self._others(new):
            whole[:, a:b] = as_points(new.contours[index].points[:, own], self._on[a:b])
            changed[a:b] = (np.abs(whole[:, a:b] - self._points[:, a:b]) > NEAR).any(axis=(0, 2))
        whole[:, :, 0] += self._lefts[:, None]
        wanted = np.einsum("kj,jnc->knc", np.linalg.inv(self._scalars), whole)
        steps = rounded_deltas(self._glyph, whole, 1)
        default = np.where(changed[:, None], steps[0], np.array(self._coordinates)[:-PHANTOMS]).astype(np.int64)
        found = []
        for k, variation in zip(self._numbers, self._given, strict=True):
            deltas = list(variation.coordinates)
            for a, b in self._spans:
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
