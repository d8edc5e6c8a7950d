"""How far two drawn outlines are from each other, from below: some point of one is as far from the other as that.

It shares nothing with the package: outlines come from a font's tables through fontTools, and are sampled. Distances of
samples from samples are too large. So where they are larger than what is to be found, the nearest point of the curve is
sought near the nearest samples, by golden sections, and the farthest point among more samples between. What is returned
is measured once more, against all segments of the other outline.
"""

from __future__ import annotations

from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt
from fontTools.pens.basePen import BasePen
from fontTools.ttLib import TTFont
from scipy.spatial import cKDTree

Floats: TypeAlias = npt.NDArray[np.float64]

SPACING, FEWEST = 2e-3, 8
"""Of the em: distance of samples along a curve, at most. Parts of a segment, at least."""

NEAREST, GOLDEN, STEPS = 4, (np.sqrt(5) - 1) / 2, 40
"""Samples near which the nearest point is sought; the share that a golden section leaves; and the number of these."""

TOP, BETWEEN = 8, 16
"""Farthest samples around which there are more, and how many of these."""


class Cubics(BasePen):  # type: ignore[misc, unused-ignore]
    """The segments of a glyph as cubics, components decomposed, with the lines that close contours."""

    def __init__(self, glyphs: Any) -> None:
        super().__init__(glyphs)
        self.found: list[Floats] = []

    def _moveTo(self, point: Any) -> None:  # noqa: N802
        self.first = point

    def _lineTo(self, point: Any) -> None:  # noqa: N802
        a, b = (np.array(each, dtype=np.float64) for each in (self._getCurrentPoint(), point))
        self.found.append(np.array([a, a + (b - a) / 3, b + (a - b) / 3, b]))

    def _curveToOne(self, *points: Any) -> None:  # noqa: N802
        self.found.append(np.array([self._getCurrentPoint(), *points], dtype=np.float64))

    def _closePath(self) -> None:  # noqa: N802
        if self._getCurrentPoint() != self.first:
            self._lineTo(self.first)

    _endPath = _closePath  # noqa: N815


def cubics(font: TTFont, glyphs: Any, name: str) -> Floats:
    """(n, 4, 2) the segments of a glyph of a font and of its glyph set, where rasterisers draw them."""
    pen = Cubics(glyphs)
    glyphs[name].draw(pen)
    found = np.array(pen.found, dtype=np.float64).reshape(-1, 4, 2)
    if "glyf" in font and font["glyf"][name].isComposite():  # glyph sets place simple glyphs by their side bearings
        found[..., 0] += font["hmtx"][name][1] - font["glyf"][name].xMin
    return found


class Samples(NamedTuple):
    """Points of an outline.

    Attributes:
        points: (N, 2). segments: (N,) on which they are, at parameters (N,) which are ``steps`` (N,) apart.
    """

    points: Floats
    segments: npt.NDArray[np.int64]
    parameters: Floats
    steps: Floats


def at(segments: Floats, t: Floats) -> Floats:
    """(…, 2) points of cubics (…, 4, 2) at parameters (…)."""
    t = t[..., None]
    z = 1 - t
    a, b, c, d = np.moveaxis(segments, -2, 0)
    return np.asarray(z * z * z * a + 3 * z * z * t * b + 3 * z * t * t * c + t * t * t * d)


def sampled(outline: Floats, spacing: float) -> Samples:
    """Points of all segments, both ends included."""
    lengths = np.hypot(*np.moveaxis(np.diff(outline, axis=1), 2, 0)).sum(axis=1)
    counts = np.maximum(np.ceil(lengths / spacing), FEWEST).astype(np.int64)
    segments = np.repeat(np.arange(len(outline)), counts + 1)
    first = np.repeat(np.cumsum(counts + 1) - counts - 1, counts + 1)
    steps = 1 / counts[segments]
    t = (np.arange(len(segments)) - first) * steps
    return Samples(at(outline[segments], t), segments, t, steps)


def apart(p: Floats, outline: Floats, segments: Any, low: Floats, high: Floats) -> Floats:
    """(…) distances of points (…, 2) from stretches of segments, by golden sections: never too small."""
    own = outline[segments]

    def far(t: Floats) -> Floats:
        return np.asarray(np.hypot(*np.moveaxis(at(own, t) - p, -1, 0)))

    best = np.minimum(far(low), far(high))
    for _ in range(STEPS):
        one, other = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
        f, g = far(one), far(other)
        best = np.minimum(best, np.minimum(f, g))
        low, high = np.where(f < g, low, one), np.where(f < g, other, high)
    return best


def from_curve(p: Floats, outline: Floats, samples: Samples, tree: Any) -> Floats:
    """(n,) distances of points (n, 2) from an outline, sought near its nearest samples."""
    k = tree.query(p, k=min(NEAREST, len(samples.points)))[1].reshape(len(p), -1)
    t, step = samples.parameters[k], samples.steps[k]
    each = apart(p[:, None], outline, samples.segments[k], np.maximum(t - step, 0.0), np.minimum(t + step, 1.0))
    return np.asarray(each.min(axis=1))


def from_all(p: Floats, outline: Floats, parts: int = 64) -> float:
    """The distance of a point (2,) from an outline, sought on ``parts`` of every segment."""
    low = np.arange(parts) / parts
    every = np.repeat(np.arange(len(outline)), parts).reshape(-1, parts)
    shape = every.shape
    return float(apart(p, outline, every, np.broadcast_to(low, shape), np.broadcast_to(low + 1 / parts, shape)).min())


def farther_side(one: Floats, other: Floats, em: float, least: float) -> float:
    """How far a point of an outline is from another one; or ``least`` if none is seen that is farther."""
    a, b = (sampled(outline, SPACING * em) for outline in (one, other))
    tree = cKDTree(b.points)
    coarse = tree.query(a.points)[0]
    rest = np.flatnonzero(coarse > least)
    if not len(rest):
        return least
    coarse[rest] = from_curve(a.points[rest], other, b, tree)
    top = rest[np.argsort(-coarse[rest])[:TOP]]
    more = (np.arange(-BETWEEN, BETWEEN + 1) / BETWEEN) * a.steps[top, None] + a.parameters[top, None]
    points = at(one[a.segments[top]][:, None], np.clip(more, 0.0, 1.0)).reshape(-1, 2)
    far = from_curve(points, other, b, tree)
    return max(least, from_all(points[far.argmax()], other)) if far.max() > least else least


def farthest(one: Floats, other: Floats, em: float, least: float) -> float:
    """How far two outlines (n, 4, 2) are from each other, seen from below; ``least`` if no more than that is seen."""
    if not (len(one) and len(other)):
        return least if len(one) == len(other) else float("inf")
    return farther_side(other, one, em, farther_side(one, other, em, least))
