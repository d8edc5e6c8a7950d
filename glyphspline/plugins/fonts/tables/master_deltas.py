"""The points of glyphs in several masters as fonts store them: a default, and a delta for each region."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from fontTools.ttLib import TTFont

from ....errors import GlyphsplineError
from ....outlines.masters import Masters
from ....types import FloatArray, IntArray
from .font_glyphs import LIMIT

PARTS = 1 << 16
"""Parts of a unit to which CFF2 has coordinates. The format's numbers are 16.16, so that such fractions, and sums of
them, are exact. Any fraction takes five bytes."""


def rounded_deltas(masters: Masters, points: FloatArray, parts: int) -> IntArray:
    """(K, N, 2) the default's points and a delta for each region, in steps of 1/``parts`` unit.

    Masters are rounded one after the other, each delta from what the regions before it leave. If no two regions
    overlap at each other's peaks, every master is within half a step of ``points`` (K, N, 2), whatever their number.
    """
    scalars, wanted = masters.at_peaks, points * float(parts)
    # Of the masters still to come: as they are before rounding.
    steps = np.tensordot(np.linalg.inv(scalars), wanted, axes=1)
    others = np.abs(scalars) * (1 - np.eye(len(masters)))
    waiting = np.arange(len(masters))
    while len(waiting):
        first = int(others[np.ix_(waiting, waiting)].sum(axis=1).argmin())
        k, waiting = waiting[first], np.delete(waiting, first)
        acting = np.flatnonzero(others[k])
        left = wanted[k] - np.tensordot(scalars[k, acting], steps[acting], axes=1)
        steps[k] = np.floor(np.round(left, 6) + 0.5)  # what is equal but for rounding errors is rounded alike
    return np.rint(steps).astype(np.int64)


def as_drawn(masters: Masters, steps: IntArray, parts: int) -> FloatArray:
    """(K, N, 2) the points of the masters that :func:`rounded_deltas` in steps of 1/``parts`` give."""
    drawn: FloatArray = np.tensordot(masters.at_peaks, steps / float(parts), axes=1)
    return drawn


def check_steps(steps: IntArray, parts: int, name: str) -> None:
    """Refuse what a font cannot hold.

    Raises:
        GlyphsplineError: a coordinate or a delta is beyond 32767 units.
    """
    if steps.size and np.abs(steps).max() > LIMIT * parts:
        raise GlyphsplineError(f"coordinates beyond {LIMIT} do not fit into a font", glyph=name)


def region_key(region: FloatArray) -> tuple[tuple[int, ...], ...]:
    """The axes that count in a region (A, 3), in the steps in which fonts store them: 1/16384."""
    steps = np.rint(np.asarray(region) * 16384).astype(int).tolist()
    counting = [(axis, *three) for axis, three in enumerate(steps) if three[1]]
    return tuple(
        [(a, low, peak, high) for a, low, peak, high in counting if low <= peak <= high and not low < 0 < high]
    )


def numbers_of(masters: Masters) -> dict[Any, int]:
    """The keys of regions to the numbers of their masters; the default is 0."""
    return {region_key(region): 1 + k for k, region in enumerate(masters.regions)}


def order_of(regions: Sequence[FloatArray], masters: Masters) -> list[int] | None:
    """The numbers of the masters of regions; None if these are others than those of the glyph."""
    known, keys = numbers_of(masters), [region_key(region) for region in regions]
    return [known[key] for key in keys] if len(keys) == len(known) and set(keys) == known.keys() else None


def axes_of(tags: Iterable[str], region: Sequence[Sequence[float]]) -> dict[str, tuple[float, ...]]:
    """A region as fontTools has it: start, peak and end on the axes that count."""
    return {tag: tuple(three) for tag, three in zip(tags, region, strict=True) if three[1]}


def regions_of(font: TTFont) -> list[list[FloatArray]]:
    """The regions (A, 3) of every item of the variation store of ``CFF2``."""
    top = font["CFF2"].cff.topDictIndex[0]
    if "VarStore" not in top.rawDict:
        return []
    store, axes = top.VarStore.otVarStore, font["fvar"].axes
    supports = [region.get_support(axes) for region in store.VarRegionList.Region]
    regions = [np.array([support.get(axis.axisTag, (0, 0, 0)) for axis in axes]) for support in supports]
    return [[regions[index] for index in data.VarRegionIndex] for data in store.VarData]


def blend(column: list[float]) -> Any:
    """A number, or a list of a default, deltas and 1, which the specialiser takes for a blend; in parts of a unit."""
    values = [round(value) if abs(value - round(value)) < 1e-5 else round(value * PARTS) / PARTS for value in column]
    return [*values, 1] if any(values[1:]) else values[0]
