"""What of a text is fitted by itself: its distinct glyphs, or, to unite overlaps, groups of glyphs that may touch."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ..outlines.contour_arrays import joined
from ..outlines.outline import Contours, Outline
from ..types import FloatArray, IntArray
from .moved import Motion, moved_contours


class Parts(NamedTuple):
    """Outlines, and n places where they stand.

    Attributes:
        outlines: each once. which: (n,) of the outlines. origin: (n, 2), angle: (n,) how it is moved.
    """

    outlines: Sequence[Outline]
    which: IntArray
    origin: FloatArray
    angle: FloatArray


def joined_where_touching(parts: Parts) -> Parts:
    """The same text in parts whose boxes do not touch those of others.

    A glyph by itself stays as it is. A group of several becomes one outline, and equal groups are the same outline.
    """
    found: dict[object, Outline] = {}
    number: dict[object, int] = {}
    which, first, turned = [], [], []
    for group in _groups(_boxes(parts)):
        places = np.array(group)
        alone, origin = len(group) == 1, parts.origin[group[0]]
        offsets, angles = parts.origin[places] - origin, parts.angle[places]
        members = parts.which[places].tolist()
        # Sums of advances differ in the last bits.
        key = members[0] if alone else (*members, *np.round(offsets, 6).ravel().tolist(), *angles.tolist())
        if key not in found:
            number[key] = len(found)
            found[key] = (
                parts.outlines[members[0]] if alone else _one([parts.outlines[k] for k in members], offsets, angles)
            )
        which.append(number[key])
        first.append(group[0])
        turned.append(alone)
    angle = parts.angle[first] * np.array(turned)
    return Parts(list(found.values()), np.array(which, dtype=np.int64), parts.origin[first], angle)


def _one(outlines: Sequence[Outline], offsets: FloatArray, angles: FloatArray) -> Outline:
    """Several outlines as one, moved by their offsets."""
    arrays = joined([outline.arrays for outline in outlines])
    counts = np.array([len(outline.contours) for outline in outlines])
    moved = moved_contours(arrays, np.arange(arrays.num_contours), Motion(offsets, angles).repeated(counts))
    name, notes = " ".join(outline.name for outline in outlines), [note for o in outlines for note in o.notes]
    snapped = max(outline.snapped for outline in outlines)
    return Outline(name, contours=Contours(moved), metrics=outlines[0].metrics, notes=tuple(notes), snapped=snapped)


def _boxes(parts: Parts) -> FloatArray:
    """(n, 4) left, bottom, right and top of the control points of what stands in each place; NaN if there are none."""
    corners = np.full((len(parts.outlines), 4, 2), np.nan)
    for corner, outline in zip(corners, parts.outlines, strict=True):
        points = outline.arrays.points
        if len(points):
            (left, bottom), (right, top) = points.min(axis=0), points.max(axis=0)
            corner[:] = [(left, bottom), (right, bottom), (right, top), (left, top)]
    n = len(parts.which)
    placed = Motion(parts.origin, parts.angle).of(corners[parts.which].reshape(-1, 2), np.full(n, 4)).reshape(n, 4, 2)
    return np.concatenate([placed.min(axis=1), placed.max(axis=1)], axis=1)


def _groups(boxes: FloatArray) -> list[list[int]]:
    """The numbers of boxes that touch each other, directly or by others; in ascending order."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    n = len(boxes)
    order = np.argsort(boxes[:, 0], kind="stable")  # NaN last
    left, bottom, right, top = boxes[order].T
    ends = np.searchsorted(left, right, side="right")
    pairs = [np.empty((0, 2), dtype=np.int64)]
    for i, end in enumerate(ends.tolist()):
        if end > i + 1 and left[i] <= right[i]:
            near = slice(i + 1, end)
            those = np.flatnonzero((bottom[near] <= top[i]) & (top[near] >= bottom[i])) + i + 1
            pairs.append(np.stack([np.full(len(those), i), those], axis=1))
    a, b = order[np.concatenate(pairs)].T
    count, label = connected_components(coo_array((np.ones(len(a)), (a, b)), shape=(n, n)), directed=False)
    by_label = np.argsort(label, kind="stable")
    starts = np.searchsorted(label[by_label], np.arange(count + 1)).tolist()
    return sorted(by_label[i:j].tolist() for i, j in pairwise(starts))
