"""Fairing within the tolerance: vertices leave the outline so that curvature rises and falls less often.

Control points move along the curve's normals at their footpoints, which is how variant 2 moves them: from the places
that the footpoints move to, it finds the same curve again but for small terms of second order. What is minimized is the
total variation of curvature, each change as a share of the curvature there, by Newton steps of reweighted least
squares; a logarithmic barrier keeps samples of the curve near the outline. Each of several masters is faired alone.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...curves.fairness import SHARE, TURN, curvatures, extrema_of, swings
from ...types import BoolArray, FloatArray, IntArray
from ..measures import CORNER, extrema_floor
from .canonical_contours import CanonicalContours, in_master
from .fair_steps import Beside, move_controls, on_spline
from .spacing import spans_after
from .steps import Trial

LIMIT, CUT = 0.85, 0.7
"""Share of the distance allowed that samples keep to at first, as they are few: with 0.9, a quarter of the contours is
faired again instead of a sixth. Share of what a span that then fails should have had."""

TRIES = 5
"""How often contours are faired before they stay as they were: each time nearer to the outline where they failed."""

PEAK = 1.2
"""Largest factor by which the largest curvature may grow."""


class Splines(NamedTuple):
    """The curves of a trial, ragged.

    Attributes:
        controls: (n, 2 K). knots, parameters: of the splines, and of footpoints.
        held: (n,) vertices whose control points are held.
    """

    controls: FloatArray
    knots: FloatArray
    parameters: FloatArray
    held: BoolArray


@compiled
def bends(
    contours: CanonicalContours, trial: Trial, pieces: FloatArray, keep: BoolArray, mark: bool
) -> tuple[IntArray, IntArray, FloatArray, BoolArray]:
    """How often the curves of a trial bend, and where more often than they have to.

    Args:
        pieces: (n, K, 4, 2). keep: (k,) the contours that count. mark: whether to look for the spans.

    Returns:
        (k, K) extrema of curvature, and how many of them need not be (see :class:`..results.Measures`); (n, K) the
        largest curvature of each span; and (n, K) the spans to be faired: those that bend, between corners where they
        need not so often, of contours with more extrema than needed.
    """
    offsets, K = trial.offsets, pieces.shape[1]
    extrema, surplus = np.zeros((2, len(keep), K), dtype=np.int64)
    peaks, uneven = np.zeros((len(pieces), K)), np.zeros((len(pieces), K), dtype=np.bool_)
    for i in np.flatnonzero(keep):
        a, b = offsets[i], offsets[i + 1]
        for v in range(K):
            outline, length = in_master(contours, trial.which[i], v)
            values, where, n = curvatures(pieces[a:b, v].copy(), length, CORNER)
            extrema[i, v] = extrema_of(values, n, TURN / length)
            for j in range(n):
                span = a + min(int(where[j]), b - a - 1)
                peaks[span, v] = max(peaks[span, v], abs(values[j]))
            if mark:
                _, fewest, given, corners = extrema_floor(outline, length)
                surplus[i, v] = max(extrema[i, v] - fewest, 0)
                if surplus[i, v] > 0:
                    _mark(given, corners, values[:n], where[:n], trial.places[a:b], TURN / length, uneven[a:b, v])
                for j in range(a, b):  # up to this curvature a span is straight
                    uneven[j, v] = uneven[j, v] and peaks[j, v] > 0.1 * TURN / length
    return extrema, surplus, peaks, uneven


@compiled
def _mark(
    given: FloatArray, corners: FloatArray, values: FloatArray, where: FloatArray, places: FloatArray, least: float,
    uneven: BoolArray,
) -> None:  # fmt: skip
    """Mark the spans between two corners where the curve bends more often than it has to; all if there are none.

    Args:
        given: curvatures of the outline, infinite at corners; corners: the places of all. values, where: the same of
            the curve. places: (n,) of its vertices. least: see :func:`..curves.fairness.extrema_of`.
    """
    n, at = len(values), np.flatnonzero(np.isinf(given))
    count = len(at)
    vertices, tops = np.empty(count, dtype=np.int64), np.empty(count, dtype=np.int64)
    found = np.empty(n + 2, dtype=np.int64)
    for k in range(count):
        j = np.searchsorted(places, corners[at[k]]) % len(places)
        first = np.searchsorted(where, j - 0.5) if j > 0 else np.searchsorted(where, len(places) - 0.5) - n
        vertices[k], tops[k] = j, first
        for i in range(first, np.searchsorted(where, j + 0.5, side="right")):
            if values[i % n] * given[at[k]] > values[tops[k] % n] * given[at[k]]:
                tops[k] = i
    for k in range(count):
        after, lap = (k + 1) % count, k + 1 == count
        need = 2 if given[at[k]] == given[at[after]] else 1
        if swings(values, n, tops[k], tops[after] + lap * n + 1, 1.0, SHARE, least, found) > need:
            for j in range(-1, spans_after(vertices, k, len(places)) + 1):
                uneven[(vertices[k] + j) % len(places)] = True
    if not uneven.any():
        uneven[:] = True


@compiled
def lowered(
    limits: FloatArray, offsets: IntArray, bounds: FloatArray, near: float, peaks: FloatArray, most: FloatArray
) -> BoolArray:
    """Lower ragged limits (n, K) in the spans whose bounds are too large, and in those beside them.

    They are 0, and nothing moves, where a span misses again, or its peak is above that allowed for its contour.

    Args:
        limits: they change. bounds: (n,). peaks: (n, K). most: (k, K) those allowed.

    Returns:
        (n, K) the spans to be faired again: those from which and up to which nothing moves, around one that is lower.
    """
    before, again = limits.copy(), np.zeros(limits.shape, dtype=np.bool_)
    for i in range(len(offsets) - 1):
        a, n = offsets[i], offsets[i + 1] - offsets[i]
        for v in range(limits.shape[1]):
            for j in range(n):
                reach = 1 if before[a + j, v] > 0 else 4  # what does not move itself is moved from farther away
                for c in range(-reach, reach + 1):
                    at, share = a + (j + c) % n, 1.0
                    if peaks[a + j, v] > most[i, v] or (bounds[a + j] > near and before[at, v] < LIMIT * near):
                        share = 0.0
                    elif bounds[a + j] > near:
                        share = CUT * near / bounds[a + j]
                    limits[at, v] = min(limits[at, v], share * before[at, v])
            for j in range(n):
                again[a + j, v] = limits[a + j, v] < before[a + j, v]
            for j in range(2 * n if again[a : a + n, v].any() else 0):  # round in both directions
                for at, beside in ((j % n, (j - 1) % n), (-j % n, (1 - j) % n)):
                    again[a + at, v] |= before[a + at, v] > 0 and again[a + beside, v]
    return again


@compiled
def fair(
    contours: CanonicalContours, trial: Trial, splines: Splines, surplus: IntArray, limits: FloatArray,
    again: BoolArray, near: float, moved: FloatArray,
) -> None:  # fmt: skip
    """Write the new vertices of the curves of a trial; those of held control points stay.

    Args:
        surplus: (k, K) extrema beyond those that a contour has to have.
        limits: (n, K) largest distance of samples of each span from the outline; 0 where nothing moves.
        again: (n, K) the spans to be faired. near: the distance allowed, in font units.
        moved: (n, 2 K), which change beside these spans.
    """
    offsets, K, (controls, knots, parameters, held) = trial.offsets, limits.shape[1], splines
    for i in range(len(trial.which)):
        a, b = offsets[i], offsets[i + 1]
        n, own, ends = b - a, knots[a + i : b + i + 1], trial.ends[a + i : b + i + 1]
        intervals = np.empty(n + 4)
        for c in range(n + 4):
            intervals[c] = own[(c - 2) % n + 1] - own[(c - 2) % n]
        for v in range(K):
            if not again[a:b, v].any():
                continue
            outline, _ = in_master(contours, trial.which[i], v)
            P, normals = controls[a:b, 2 * v : 2 * v + 2].copy(), np.zeros((n, 2))
            points, moving = moved[a:b, 2 * v : 2 * v + 2].copy(), np.zeros(n, dtype=np.bool_)
            least = np.zeros(n)
            for j in range(n):
                if again[a + j, v]:
                    least[j] = limits[a + j, v]
            for j in range(n):
                if again[a + j, v] or again[a + (j - 1) % n, v]:
                    points[j, 0], points[j, 1] = trial.points[a + j, 2 * v], trial.points[a + j, 2 * v + 1]
                if least[j] > 0 and least[j - 1] > 0 and not held[a + j]:
                    _, _, _, dx, dy = on_spline(P, own, intervals, parameters[a + j])
                    speed = np.sqrt(dx * dx + dy * dy)
                    normals[j, 0], normals[j, 1] = -dy / speed, dx / speed
                    for c in range(-2, 2):
                        moving[(j + c) % n] = True
            if moving.any():
                # A difference of curvature is significant that turns the contour by ``TURN``.
                significant = TURN * np.sqrt(K) / (own[n] - own[0])
                beside = Beside(outline, ends, least, near)
                move_controls(beside, intervals, significant, normals, moving, surplus[i, v], P)
            for j in range(n):
                if not held[a + j] and (moving[j] or moving[j - 1]):
                    span, x, y, _, _ = on_spline(P, own, intervals, parameters[a + j])
                    if moving[span]:
                        points[j, 0], points[j, 1] = x, y
            total = 0.0
            for j in range(n):
                total += points[j, 0] + points[j, 1]
            if np.isfinite(total):  # or else the curve has no speed somewhere, as where a contour collapses
                for j in range(n):
                    moved[a + j, 2 * v], moved[a + j, 2 * v + 1] = points[j, 0], points[j, 1]
