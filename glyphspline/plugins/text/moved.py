"""Contours of glyphs, each as often as it occurs in a text, moved into place; glyphs that touch as one outline."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ...curves.bspline import Spline
from ...fitting.results import ConvertedContours
from ...interpolation.result import Interpolation
from ...outlines.contour_arrays import ContourArrays, Polylines, joined, members_of
from ...outlines.outline import Contours, Outline
from ...types import FloatArray, IntArray, Views


class Motion(NamedTuple):
    """A rigid motion for each of k contours: (k, 2) where its origin goes, cosine and sine of the angle it turns by."""

    origin: FloatArray
    cos: FloatArray
    sin: FloatArray

    @classmethod
    def by(cls, origin: FloatArray, angle: FloatArray) -> Motion:
        """Motions of contours whose origins go to (k, 2), and which turn about them by angles (k,)."""
        ways = (np.cos(angle), np.sin(angle))
        # Exact for quarter turns, whose sines and cosines are not.
        return cls(origin, *(np.where(np.abs(v - np.round(v)) < 1e-15, np.round(v), v) for v in ways))

    def repeated(self, counts: IntArray) -> Motion:
        """The motions, each so often."""
        return Motion(*(np.repeat(column, counts, axis=0) for column in self))

    def of(self, points: FloatArray, lengths: IntArray) -> FloatArray:
        """The points (N, 2) of the contours end to end, moved; ``lengths`` (k,) of each."""
        if (self.cos == 1).all():
            return points + np.repeat(self.origin, lengths, axis=0)
        origin, cos, sin = self.repeated(lengths)
        x, y = points.T
        return np.stack([cos * x - sin * y, sin * x + cos * y], axis=1) + origin


class Parts(NamedTuple):
    """What of a text is fitted by itself: outlines, and n places where they stand.

    Attributes:
        outlines: each once. which: (n,) of the outlines. origin: (n, 2), angle: (n,) how it is moved.
    """

    outlines: Sequence[Outline]
    which: IntArray
    origin: FloatArray
    angle: FloatArray


def moved_contours(contours: ContourArrays, which: IntArray, motion: Motion) -> ContourArrays:
    """The chosen contours, moved."""
    found = contours.chosen(which)
    return found._replace(points=motion.of(found.points, np.diff(found.starts)))


def _moved_polylines(lines: Polylines, which: IntArray, motion: Motion) -> Polylines:
    points, offsets = members_of(lines.offsets, which)
    return Polylines(motion.of(lines.points[points], np.diff(offsets)), offsets, lines.closed[which])


def moved_results(found: ConvertedContours, which: IntArray, motion: Motion) -> ConvertedContours:
    """The chosen contours' results, moved: knots, parameters and measures stay as they are."""
    arcs, offsets = members_of(found.arc_offsets, which)
    controls = _moved_polylines(found.controls, arcs, motion.repeated(np.diff(offsets)))
    chosen = which.tolist()
    return ConvertedContours(
        moved_contours(found.source, which, motion),
        moved_contours(found.curves, which, motion),
        _moved_polylines(found.polygons, which, motion),
        Views(len(arcs), partial(_moved_arcs, found.arcs, arcs, controls)),
        controls,
        offsets,
        {name: [column[c] for c in chosen] for name, column in found.measures.items()},
    )


def _moved_arcs(found: Sequence[Interpolation], which: IntArray, controls: Polylines) -> list[Interpolation]:
    splines = (
        Spline.trusted(controls.points[a:b], found[k].spline.knots, found[k].spline.degree, found[k].spline.closed)
        for k, a, b in zip(which.tolist(), controls.offsets[:-1].tolist(), controls.offsets[1:].tolist(), strict=True)
    )
    return [replace(found[k], spline=spline) for k, spline in zip(which.tolist(), splines, strict=True)]


def joined_where_touching(parts: Parts) -> Parts:
    """The same text in parts whose boxes do not touch those of others.

    A glyph by itself stays as it is. A group of several becomes one outline, and equal groups are the same outline.
    """
    found: dict[object, tuple[int, Outline]] = {}
    which, first, angle = [], [], []
    for group in _groups(_boxes(parts)):
        offsets, angles = parts.origin[group] - parts.origin[group[0]], parts.angle[group]
        members = parts.which[group].tolist()
        # Sums of advances differ in the last bits.
        alone = len(group) == 1
        key = members[0] if alone else (*members, *np.round(offsets, 6).ravel().tolist(), *angles.tolist())
        if key not in found:
            outlines = [parts.outlines[k] for k in members]
            found[key] = len(found), outlines[0] if alone else _one(outlines, Motion.by(offsets, angles))
        which.append(found[key][0])
        first.append(group[0])
        angle.append(angles[0] if alone else 0.0)
    places = np.array(which, dtype=np.int64), parts.origin[first], np.array(angle)
    return Parts([outline for _, outline in found.values()], *places)


def _one(outlines: Sequence[Outline], motion: Motion) -> Outline:
    """Several outlines as one, moved."""
    arrays = joined([outline.arrays for outline in outlines])
    counts = np.array([len(outline.contours) for outline in outlines])
    moved = moved_contours(arrays, np.arange(arrays.num_contours), motion.repeated(counts))
    name, notes = " ".join(outline.name for outline in outlines), [note for o in outlines for note in o.notes]
    snapped = max(outline.snapped for outline in outlines)
    return Outline(
        name, contours=Contours(moved), metrics=outlines[0].metrics, notes=tuple(notes), snapped=snapped,
        unread=tuple(dict.fromkeys(part for outline in outlines for part in outline.unread)),
    )  # fmt: skip


def _boxes(parts: Parts) -> FloatArray:
    """(n, 4) left, bottom, right and top of the control points at each place; NaN if there are none."""
    corners = np.full((len(parts.outlines), 4, 2), np.nan)
    for corner, outline in zip(corners, parts.outlines, strict=True):
        points = outline.arrays.points
        if len(points):
            (left, bottom), (right, top) = points.min(axis=0), points.max(axis=0)
            corner[:] = [(left, bottom), (right, bottom), (right, top), (left, top)]
    motion, placed = Motion.by(parts.origin, parts.angle), corners[parts.which]
    placed = motion.of(placed.reshape(-1, 2), np.full(len(placed), 4)).reshape(placed.shape)
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
