"""Stretches of outline for which splines are wanted: their samples, and how far apart vertices are wanted there."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...types import FloatArray, IntArray
from .corners import Joints
from .feet import Samples
from .spline_curve import FREE, HELD, TIED, chord

GROWTH = 1.35
"""How fast the wanted distance of vertices grows along the outline: by exp(1.35) < 4 from one to the next."""


class Stretches(NamedTuple):
    """Stretches of outline for which a spline is wanted, end to end.

    Attributes:
        piece: (S,) the piece whose place the spline takes.
        starts: (S + 1,) first sample of each.
        points: (K, N, 2) samples in each master, and (N,) places: where on the contour; at the end of a closed one the
            first again, a lap later.
        spacing: (N,) wanted distance of vertices after each sample.
        directions: (K, S, 2, 2) unit tangents at the ends. free: (S, 2) whether these may turn (FREE), or
            keep their directions (HELD) and, besides, the ratio of their lengths in the masters (TIED).
    """

    piece: IntArray
    starts: IntArray
    points: FloatArray
    places: FloatArray
    spacing: FloatArray
    directions: FloatArray
    free: IntArray


@compiled
def empty_stretches(masters: int, count: int, samples: int) -> Stretches:
    """Room for so many stretches, with so many samples together."""
    stretches = Stretches(
        np.empty(count, dtype=np.int64), np.empty(count + 1, dtype=np.int64), np.empty((masters, samples, 2)),
        np.empty(samples), np.empty(samples), np.empty((masters, count, 2, 2)), np.empty((count, 2), dtype=np.int64),
    )  # fmt: skip
    stretches.starts[0] = 0
    return stretches


@compiled
def add_stretch(stretches: Stretches, count: int, joints: Joints, i: int, j: int, piece: int) -> Stretches:
    """Add the samples between two joints after ``count`` other stretches; in larger arrays if need be."""
    a, b, at = joints.first[i], joints.first[j], stretches.starts[count]
    masters, room = len(stretches.points), 2 * (at + b - a + 1)
    if at + b - a + 1 > len(stretches.places):
        points, places, spacing = np.empty((masters, room, 2)), np.empty(room), np.empty(room)
        for r in range(at):
            places[r], spacing[r] = stretches.places[r], stretches.spacing[r]
            for v in range(masters):
                points[v, r, 0], points[v, r, 1] = stretches.points[v, r, 0], stretches.points[v, r, 1]
        stretches = Stretches(
            stretches.piece, stretches.starts, points, places, spacing, stretches.directions, stretches.free
        )
    for r in range(b - a + 1):
        stretches.places[at + r] = joints.places[a + r]
        stretches.spacing[at + r] = joints.spacing[min(a + r, len(joints.spacing) - 1)]
    for v in range(masters):
        for axis in range(2):
            for r in range(b - a + 1):
                stretches.points[v, at + r, axis] = joints.samples[v, a + r, axis]
            stretches.directions[v, count, 0, axis] = joints.leaving[v, i, axis]
            stretches.directions[v, count, 1, axis] = joints.arriving[v, j, axis]
    for end, joint in ((0, i), (1, j)):
        stretches.free[count, end] = FREE if joints.corner[joint] else (TIED if joints.tied[joint] else HELD)
    stretches.piece[count], stretches.starts[count + 1] = piece, at + b - a + 1
    return stretches


@compiled
def stretches_used(stretches: Stretches, count: int) -> Stretches:
    """The first ``count`` stretches."""
    end = stretches.starts[count]
    return Stretches(
        stretches.piece[:count], stretches.starts[: count + 1], stretches.points[:, :end].copy(),
        stretches.places[:end], stretches.spacing[:end], stretches.directions[:, :count].copy(),
        stretches.free[:count],
    )  # fmt: skip


@compiled
def integrate_density(D: FloatArray, h: FloatArray, step: FloatArray, closed: int) -> None:
    """The integral D: (n + 1,) of the density of vertices, from wanted distances h and steps: (n,).

    Wanted distances grow no faster than chords may; around a closed contour from the last to the first, too.
    """
    n = len(h)
    for _ in range(2):
        for r in range(n):
            if r > 0 or closed:
                h[r] = min(h[r], h[r - 1] + GROWTH * (step[r] + step[r - 1]) / 2)
        for r in range(n - 1, -1, -1):
            if r + 1 < n or closed:
                e = (r + 1) % n
                h[r] = min(h[r], h[e] + GROWTH * (step[r] + step[e]) / 2)
    D[0] = 0.0
    for r in range(n):
        D[r + 1] = D[r] + step[r] / h[r]


@compiled
def samples_of(stretches: Stretches, s: int, closed: int) -> Samples:
    """The samples of a stretch, with the integral of the density of vertices."""
    first, n = stretches.starts[s], stretches.starts[s + 1] - stretches.starts[s] - 1
    Q, places = stretches.points[:, first : first + n + 1].copy(), stretches.places[first : first + n + 1]
    D, h, step = np.empty(n + 1), np.empty(n), np.empty(n)
    for r in range(n):
        h[r], step[r] = stretches.spacing[first + r], chord(Q, r, r + 1)
    integrate_density(D, h, step, closed)
    return Samples(
        Q[:, : n + 1 - closed].copy(),
        places[: n + 1 - closed],
        D,
        stretches.directions[:, s].copy(),
        stretches.free[s],
        places[n],
    )
