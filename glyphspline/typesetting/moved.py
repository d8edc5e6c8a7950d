"""Contours of glyphs, each as often as it stands in a text, moved into place."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from ..curves.bspline import Spline
from ..fitting.results import ConvertedContours
from ..interpolation.result import Interpolation
from ..outlines.contour_arrays import ContourArrays, Polylines, offsets_of
from ..types import BoolArray, FloatArray, IntArray, Views


def ranges(starts: IntArray, lengths: IntArray) -> IntArray:
    """The integers of k ranges, one range after the other."""
    ends = np.cumsum(lengths)
    return np.arange(int(lengths.sum())) + np.repeat(starts - ends + lengths, lengths)


class Motion:
    """A rigid motion for each of k contours.

    Args:
        origin: (k, 2) where the origin of each goes. angle: (k,) by which it turns about its origin.
    """

    def __init__(self, origin: FloatArray, angle: FloatArray) -> None:
        self._origin, self._turning = origin, bool(angle.any())
        # Exact for quarter turns, whose sines and cosines are not.
        self._cos, self._sin = _exact(np.cos(angle)), _exact(np.sin(angle))

    def of(self, points: FloatArray, lengths: IntArray) -> FloatArray:
        """The points (N, 2) of the contours end to end, moved; ``lengths`` (k,) of each."""
        origin = np.repeat(self._origin, lengths, axis=0)
        if not self._turning:
            return points + origin
        cos, sin = np.repeat(self._cos, lengths), np.repeat(self._sin, lengths)
        x, y = points.T
        return np.stack([cos * x - sin * y, sin * x + cos * y], axis=1) + origin

    def repeated(self, counts: IntArray) -> Motion:
        """The motions, each so often."""
        motion = Motion.__new__(Motion)
        motion._turning = self._turning
        motion._origin = np.repeat(self._origin, counts, axis=0)
        motion._cos, motion._sin = np.repeat(self._cos, counts), np.repeat(self._sin, counts)
        return motion


def _exact(values: FloatArray) -> FloatArray:
    near = np.round(values)
    return np.where(np.abs(values - near) < 1e-15, near, values)


def moved_contours(contours: ContourArrays, which: IntArray, motion: Motion) -> ContourArrays:
    """The chosen contours, moved."""
    segments, points = np.diff(contours.offsets)[which], np.diff(contours.starts)[which]
    return ContourArrays(
        motion.of(contours.points[ranges(contours.starts[which], points)], points),
        contours.degrees[ranges(contours.offsets[which], segments)],
        offsets_of(segments),
        offsets_of(points),
    )


def _moved_polylines(lines: Polylines, which: IntArray, motion: Motion) -> Polylines:
    points = np.diff(lines.offsets)[which]
    closed: BoolArray = lines.closed[which]
    return Polylines(motion.of(lines.points[ranges(lines.offsets[which], points)], points), offsets_of(points), closed)


def moved_results(found: ConvertedContours, which: IntArray, motion: Motion) -> ConvertedContours:
    """The chosen contours' results, moved: knots, parameters and measures stay as they are."""
    counts = np.diff(found.arc_offsets)[which]
    arcs = ranges(found.arc_offsets[which], counts)
    controls = _moved_polylines(found.controls, arcs, motion.repeated(counts))
    chosen = which.tolist()
    return ConvertedContours(
        moved_contours(found.source, which, motion),
        moved_contours(found.curves, which, motion),
        _moved_polylines(found.polygons, which, motion),
        Views(len(arcs), partial(_moved_arcs, found.arcs, arcs, controls)),
        controls,
        offsets_of(counts),
        {name: [column[c] for c in chosen] for name, column in found.measures.items()},
    )


def _moved_arcs(found: Sequence[Interpolation], which: IntArray, controls: Polylines) -> list[Interpolation]:
    splines = (
        Spline.trusted(controls.points[a:b], found[k].spline.knots, found[k].spline.degree, found[k].spline.closed)
        for k, a, b in zip(which.tolist(), controls.offsets[:-1].tolist(), controls.offsets[1:].tolist(), strict=True)
    )
    return [replace(found[k], spline=spline) for k, spline in zip(which.tolist(), splines, strict=True)]
