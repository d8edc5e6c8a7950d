"""Polygons and contours that several tests share; seeded polygons of every kind the compiled core has to get right."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from glyphspline.curves.crossings import crossings
from glyphspline.curves.overshoot import overshoot as farthest_overshoot
from glyphspline.outlines.outline import Contour
from glyphspline.types import FloatArray

Generator = np.random.Generator


def random_polygon(n: int, seed: int) -> FloatArray:
    """Vertices uniform in the square [0, 5]², as in the paper's Section 4."""
    return np.random.default_rng([n, seed]).uniform(0, 5, (n, 2))


def ellipse(n: int, a: float = 2.0, b: float = 1.0, power: float = 1.0) -> FloatArray:
    """n vertices on an ellipse, evenly in the angle, or graded by a power of it."""
    angle = 2 * np.pi * (np.arange(n) / n) ** power
    return np.stack([a * np.cos(angle), b * np.sin(angle)], axis=1)


def circle_contour(radius: float = 100.0) -> Contour:
    """A circle of four cubics with the usual handles, counter-clockwise: off by 0.027 % of the radius."""
    k = 4 / 3 * np.tan(np.pi / 8)
    quarter = np.array([[1, 0], [1, k], [k, 1], [0, 1]]) * radius
    turn = np.array([[0, -1], [1, 0]])
    segments = []
    for _ in range(4):
        segments.append(quarter)
        quarter = quarter @ turn.T
    return Contour.from_segments(segments)


def square_contour(side: float = 100.0) -> Contour:
    """Four lines, counter-clockwise from the origin."""
    corners = np.array([[0, 0], [side, 0], [side, side], [0, side]])
    return Contour(corners, np.ones(4, dtype=np.int64))


def uniform(rng: Generator, n: int) -> FloatArray:
    """The paper's: vertices uniform in [0, 5]²."""
    return 5 * rng.random((n, 2))


def smooth(rng: Generator, n: int) -> FloatArray:
    """A wavy round, evenly sampled."""
    a = 2 * np.pi * np.arange(n) / n
    r = 1 + 0.2 * np.cos(3 * a + rng.random()) + 0.05 * np.sin(7 * a + rng.random())
    return np.stack([r * np.cos(a), r * np.sin(a)], axis=1)


def glyph_like(rng: Generator, n: int) -> FloatArray:
    """Straight stems, corners and bows in whole font units."""
    corners = 1000 * rng.random((max(n // 6, 3), 2))
    ends = np.roll(corners, -1, axis=0)
    bow = 80 * rng.standard_normal(len(corners))
    x = np.arange(6) / 6
    normal = (ends - corners)[:, ::-1] * [1, -1] / np.hypot(*(ends - corners).T)[:, None]
    points = (
        corners[:, None]
        + x[:, None] * (ends - corners)[:, None]
        + (bow[:, None] * 4 * x * (1 - x))[..., None] * normal[:, None]
    )
    return np.round(points.reshape(-1, 2))


def lognormal_chords(rng: Generator, n: int) -> FloatArray:
    """A walk whose steps differ by orders of magnitude, closed."""
    steps = np.exp(2 * rng.standard_normal(n))[:, None] * rng.standard_normal((n, 2))
    return np.cumsum(steps - steps.mean(axis=0), axis=0)


def near_cusps(rng: Generator, n: int) -> FloatArray:
    """Spikes: every third vertex far out, its neighbours close together."""
    p = smooth(rng, n)
    p[::3] *= 3
    p[2::3] = p[1::3][: len(p[2::3])] + 1e-3 * rng.standard_normal((len(p[2::3]), 2))
    return p


def near_duplicates(rng: Generator, n: int) -> FloatArray:
    """Every fourth vertex nearly on the one before it."""
    p = uniform(rng, n)
    twins = p[1::4]
    twins[:] = p[0::4][: len(twins)] + 10.0 ** rng.uniform(-9, -3, len(twins))[:, None] * rng.standard_normal(
        twins.shape
    )
    return p


def tiny(rng: Generator, n: int) -> FloatArray:
    """In units of a millionth."""
    return 1e-6 * uniform(rng, n)


def huge_and_far(rng: Generator, n: int) -> FloatArray:
    """A million times as large, away from the origin."""
    return 1e6 * (uniform(rng, n) + 3)


def collinear(rng: Generator, n: int) -> FloatArray:
    """On a line, to and fro."""
    return np.stack([5 * rng.random(n), np.zeros(n)], axis=1) @ np.array([[0.8, 0.6], [-0.6, 0.8]])


def smallest(rng: Generator, n: int) -> FloatArray:
    """Triangles and quadrangles."""
    return uniform(rng, 3 + n % 2)


KINDS: dict[str, tuple[Callable[[Generator, int], FloatArray], tuple[int, int]]] = {
    "uniform": (uniform, (5, 16)),
    "smooth": (smooth, (8, 20)),
    "glyph": (glyph_like, (18, 30)),
    "lognormal": (lognormal_chords, (5, 14)),
    "cusps": (near_cusps, (6, 14)),
    "duplicates": (near_duplicates, (6, 14)),
    "tiny": (tiny, (5, 14)),
    "huge": (huge_and_far, (5, 14)),
    "collinear": (collinear, (5, 12)),
    "smallest": (smallest, (3, 5)),
}


def polygon(number: int, seed: int = 2012, scale: int = 1) -> tuple[str, FloatArray]:
    """Polygon ``number`` of an endless seeded list that takes the kinds in turn: (kind, vertices).

    ``scale`` multiplies the number of vertices.
    """
    kind = list(KINDS)[number % len(KINDS)]
    make, (least, most) = KINDS[kind]
    rng = np.random.default_rng([seed, number])
    return kind, make(rng, scale * int(rng.integers(least, most)))


def self_crossings(cubics: FloatArray) -> int:
    """Number of self-crossings of a closed chain of cubics (m, 4, 2)."""
    found, complete = crossings(cubics, np.array([0, len(cubics)]), np.array([0, 1]))
    assert complete.all()
    return len(found)


def overshoot(cubics: FloatArray, polygon: FloatArray) -> float:
    """Largest distance of a closed chain of cubics (m, 4, 2) outside the convex hull of a polygon (n, 2)."""
    return float(farthest_overshoot(cubics, polygon))
