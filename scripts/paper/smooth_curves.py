"""Smooth closed curves given by formulas, vertices on them, and the two-sided distance of a spline from them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.spatial import cKDTree

import glyphspline as gs
from glyphspline.types import FloatArray

Sampling = Literal["even", "graded", "alternating"]
SAMPLINGS: tuple[Sampling, ...] = ("even", "graded", "alternating")

PER_SPAN = 8
"""Points of each span for the distance."""

NEWTON_STEPS = 6


@dataclass(frozen=True)
class Waves:
    """The closed curve z(θ) = Σ a_k exp(i k θ), θ from 0 to 2π: an ellipse, or a polar curve r(θ) of cosines.

    Attributes:
        amplitudes: a_k by frequency k.
    """

    amplitudes: dict[int, complex]

    def __call__(self, angle: FloatArray, derivative: int = 0) -> FloatArray:
        """Points (..., 2), or a derivative by θ."""
        z = sum(a * (1j * k) ** derivative * np.exp(1j * k * angle) for k, a in self.amplitudes.items())
        return np.stack([np.real(z), np.imag(z)], axis=-1)

    def curvature(self, angle: FloatArray) -> FloatArray:
        """Signed curvature."""
        (x, y), (X, Y) = np.moveaxis(self(angle, 1), -1, 0), np.moveaxis(self(angle, 2), -1, 0)
        return np.asarray((x * Y - y * X) / np.hypot(x, y) ** 3)

    def lengths(self) -> tuple[FloatArray, FloatArray]:
        """Angles, close together, and the length of the curve up to each."""
        angle = np.linspace(0, 2 * np.pi, 40_001)
        speed = np.hypot(*self(angle, 1).T)
        return angle, np.concatenate([[0.0], np.cumsum((speed[1:] + speed[:-1]) / 2 * np.diff(angle))])

    def angles(self, steps: FloatArray) -> FloatArray:
        """Angles of vertices whose distances along the curve are in proportion to the steps."""
        angle, length = self.lengths()
        return np.interp(np.concatenate([[0.0], np.cumsum(steps)[:-1]]) / steps.sum(), length / length[-1], angle)


def polar(*terms: tuple[float, int, float]) -> Waves:
    """The polar curve r(θ) = Σ a cos(k θ + φ) of (a, k, φ)."""
    found: dict[int, complex] = {}
    for a, k, phase in terms:
        for sign in (1, -1):
            found[1 + sign * k] = found.get(1 + sign * k, 0) + a / 2 * np.exp(1j * sign * phase)
    return Waves(found)


ELLIPSE = Waves({1: 1.5, -1: 0.5})
"""Half axes 2 and 1."""

TREFOIL = polar((1.0, 0, 0.0), (0.2, 3, 0.0))
"""r = 1 + 0.2 cos 3θ, which has six inflections."""


def steps(n: int, sampling: Sampling) -> FloatArray:
    """(n,) distances of neighbouring vertices: equal, between 1/2 and 3/2 along a cosine, or 1, 2, 1, 2, …"""
    if sampling == "even":
        return np.ones(n)
    if sampling == "graded":
        return 1 + 0.5 * np.cos(2 * np.pi * (np.arange(n) + 0.5) / n)
    return np.tile([1.0, 2.0], n // 2)


def distance(curve: Waves, spline: gs.Spline) -> float:
    """The largest distance of a point of the closed spline from the curve, or of the curve from the spline."""
    u = spline.knots
    x = np.arange(PER_SPAN) / PER_SPAN
    t = (u[:-1, None] + np.diff(u)[:, None] * x).ravel()
    angle = np.linspace(0, 2 * np.pi, 2 * len(t), endpoint=False)
    there = nearest(curve, angle, spline(t))
    back = nearest(lambda t, k: spline(t, derivative=k), t, curve(angle))
    return float(max(there.max(), back.max()))


def nearest(curve: Callable[[FloatArray, int], FloatArray], samples: FloatArray, points: FloatArray) -> FloatArray:
    """Distance of each point from the curve, by Newton's method from the four nearest samples.

    Where the curve crosses itself the very nearest may belong to the other strand.
    """
    distances, found = cKDTree(curve(samples, 0)).query(points, k=4)
    best = distances[:, 0]
    for k in found.T:
        t = samples[k]
        for _ in range(NEWTON_STEPS):
            e, first = curve(t, 0) - points, curve(t, 1)
            slope, square = (e * first).sum(axis=1), (first**2).sum(axis=1)
            bend = square + (e * curve(t, 2)).sum(axis=1)
            t = t - slope / np.where(bend > 0.1 * square, bend, square)
        best = np.minimum(best, np.hypot(*(curve(t, 0) - points).T))
    return np.asarray(best)


def order(counts: Sequence[int], errors: Sequence[float], from_count: int) -> float:
    """The exponent q of error ≈ n^-q, by least squares over the logarithms from a number of vertices on."""
    n, e = np.log(counts), np.log(errors)
    late = np.asarray(counts) >= from_count
    return float(-np.polyfit(n[late], e[late], 1)[0])
