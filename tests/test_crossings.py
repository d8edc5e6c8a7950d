"""Crossings and overshoot against plain NumPy and SciPy, which look at every pair of chords."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import ConvexHull

import glyphspline as gs
from glyphspline.curves.crossings import chords
from glyphspline.types import FloatArray

from .polygons import overshoot, self_crossings

FONT = Path(__file__).parents[1] / "fonts_test" / "kouzan-gyosho.ttf"


def chains_at_random() -> list[FloatArray]:
    rng = np.random.default_rng(11)
    found = []
    for n in [2, 3, 4, 6, 9, 15] * 8:
        joints, handles = rng.normal(0, 100, (n, 2)), rng.normal(0, 100 / n, (n, 2, 2))
        ends = np.roll(joints, -1, axis=0)
        found.append(np.stack([joints, joints + handles[:, 0], ends - handles[:, 1], ends], axis=1))
    return found


def cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def crossings_of_all_pairs(p: FloatArray) -> int:
    """Chords of a closed polyline that cross properly, neighbours apart."""
    n, q = len(p), np.roll(p, -1, axis=0)
    after = cross((q - p)[:, None], p[None] - p[:, None]) >= 0  # [i, j]: whether point j is left of chord i
    apart = after != np.roll(after, -1, axis=1)
    i, j = np.triu_indices(n, 2)
    return int((apart & apart.T)[i, j][(i > 0) | (j < n - 1)].sum())


def farthest_from_hull(points: FloatArray, polygon: FloatArray) -> float:
    """Largest distance of points from the convex hull of a polygon."""
    a = polygon[ConvexHull(polygon).vertices]
    side = np.roll(a, -1, axis=0) - a
    away = points[:, None] - a
    along = np.clip((away * side).sum(-1) / (side**2).sum(-1), 0, 1)
    inside = (cross(side, away) >= 0).all(axis=1)
    return float(np.where(inside, 0, np.hypot(*(away - along[..., None] * side).T).min(axis=0)).max())


def test_crossings_and_overshoot_are_those_that_every_chord_gives() -> None:
    font = gs.open_font(FONT)
    outlines = [font.outline(name) for name in font.select(text="龍好g")]
    counted = 0
    for cubics in [*chains_at_random(), *(c.cubics() for o in outlines for c in o.contours)]:
        points, _ = chords(cubics)
        assert self_crossings(cubics) == crossings_of_all_pairs(points)
        counted += self_crossings(cubics) > 0
        polygon = np.ascontiguousarray(cubics[::2, 0])
        if len(polygon) >= 3:
            assert overshoot(cubics, polygon) == pytest.approx(farthest_from_hull(points, polygon), abs=1e-9)
    assert counted > 20


def test_a_point_in_line_with_a_far_side_of_the_hull_is_not_outside() -> None:
    """Vertices on straight sides lie outside of the lines of others by rounding alone."""
    rng = np.random.default_rng(5)
    for _ in range(50):
        corners = rng.normal(0, 300, (3, 2))
        share = np.linspace(0, 1, 60, endpoint=False)[:, None]
        polygon = np.concatenate([(1 - share) * corners[k] + share * corners[(k + 1) % 3] for k in range(3)])
        lines = np.stack([polygon + w / 3 * (np.roll(polygon, -1, axis=0) - polygon) for w in range(4)], axis=1)
        assert overshoot(lines, polygon) < 1e-9
