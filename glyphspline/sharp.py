"""The sharp mode: a contour cut at its corners and straight lines, with clamped splines of few vertices in between."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from .arcs import arc_segments
from .arrays import FloatArray, IntArray
from .bezier import split
from .distance import Distance, certified_distance
from .frugal import MOST_SPANS, cut, fit_between
from .glyph import Options
from .interpolation import interpolate_many
from .joints import Joints, find_joints
from .orientation import farthest_joint, flip, runs_backwards
from .outline import Contour
from .result import Interpolation

LONG_LINE = 0.02
"""Share of the em from which straight lines stay lines."""

SHARE = 0.97
"""Share of the tolerance that the fit may use. The rest is for what its samples miss; the certificate decides."""

SHARPNESS = 0.02
"""The certified bound may exceed the distances seen by this share of the tolerance."""

STRIDE = {"fast": 2, "best": 1}
"""Arcs end at every so many smooth joints of the source."""

ROUNDS = {"fast": 4, "best": 6}
"""Most Gauss-Newton steps an arc."""


@dataclass(frozen=True, eq=False)
class Piece:
    """An arc (an interpolation with its end tangents) or a straight line (no interpolation) of a result.

    Attributes:
        first, last: joints of the source between which it runs.
        vertices: (k + 1, 2) for k spans, both ends among them.
        arc: the curve; None for a line.
    """

    first: int
    last: int
    vertices: FloatArray
    arc: Interpolation | None

    @cached_property
    def segments(self) -> FloatArray:
        """(spans, degree + 1, 2) Bézier segments, degree 1 for a line."""
        return self.vertices[None] if self.arc is None else arc_segments(self.arc.spline)

    @property
    def numbers(self) -> int:
        """Numbers to store: two a vertex, counting one of the ends, and four for the end tangents of an arc."""
        return 2 if self.arc is None else 2 * (len(self.vertices) - 1) + 4


@dataclass(frozen=True, eq=False)
class SharpFit:
    """A contour as lines and arcs, in order; their curve; and its certified distance from the source."""

    pieces: tuple[Piece, ...]
    curve: Contour
    distance: Distance

    @property
    def polygon(self) -> FloatArray:
        """(n, 2) vertices of all pieces in order, where two pieces meet only once."""
        return np.concatenate([piece.vertices[:-1] for piece in self.pieces])

    @property
    def numbers(self) -> int:
        """Numbers to store for the contour."""
        return sum(piece.numbers for piece in self.pieces)


def join(pieces: tuple[Piece, ...] | list[Piece]) -> Contour:
    """The Bézier segments of all pieces as one contour."""
    starts = [p.vertices[:1] if p.arc is None else p.segments[:, :3].reshape(-1, 2) for p in pieces]
    degrees = [1 if p.arc is None else 3 for p in pieces for _ in range(len(p.vertices) - 1)]
    return Contour(np.concatenate(starts), np.array(degrees))


def fit_sharp(contour: Contour, options: Options, tolerance: float, em: float) -> SharpFit:
    """Lines and arcs within ``tolerance`` of a contour, certified after rounding to ``options.precision``.

    Arcs that miss it although their samples were near enough get more spans, and in the end the source's own
    segments, of which each is an arc of one span.
    """
    source = _Source(contour, options, tolerance, em)
    pieces = source.cut()
    distance = source.distance(pieces)
    for attempt in range(1, ATTEMPTS + 1):
        poor = distance.bounds > tolerance
        if not poor.any():
            break
        pieces = [
            new
            for old, bad in zip(pieces, poor, strict=True)
            for new in (source.better(old, attempt) if bad else [old])
        ]
        distance = source.distance(pieces)
    return SharpFit(tuple(pieces), join(pieces), distance)


ATTEMPTS = 3
"""Refinements of arcs that fail the certificate; the last one takes the source's own segments."""


class _Plan(NamedTuple):
    """A piece before its curve is there: joints, vertices and, for an arc, (2, 2) end tangents."""

    first: int
    last: int
    vertices: FloatArray
    tangents: FloatArray | None = None


class _Source:
    """A contour made ready to be cut: segments of no length dropped, the first joint a hard one."""

    def __init__(self, contour: Contour, options: Options, tolerance: float, em: float) -> None:
        self.options, self.tolerance = options, tolerance
        self.near = max(SHARE * tolerance - 10.0**-options.precision, tolerance / 4)
        cubics, degrees = contour.cubics(), contour.degrees
        kept = np.abs(np.diff(cubics, axis=1)).sum(axis=(1, 2)) > 0
        cubics, degrees = open_loops(cubics[kept], degrees[kept])
        self.flipped = runs_backwards(cubics)
        if self.flipped:
            cubics, degrees = flip(cubics), degrees[::-1].copy()
        angle, line = np.radians(options.corner_angle), LONG_LINE * em
        self.joints = find_joints(cubics, degrees, self.near, angle, line)
        start = first_joint(self.joints)
        if start:
            cubics, degrees = np.roll(cubics, -start, axis=0), np.roll(degrees, -start)
            self.joints = find_joints(cubics, degrees, self.near, angle, line)
        self.cubics, self.degrees = cubics, degrees
        self.source = flip(cubics) if self.flipped else cubics

    def _turned(self, plan: _Plan) -> _Plan:
        """A piece of the flipped contour as one of the contour itself, or the other way round."""
        if not self.flipped:
            return plan
        m = len(self.cubics)
        tangents = None if plan.tangents is None else -plan.tangents[::-1]
        return _Plan(m - plan.last, m - plan.first, plan.vertices[::-1].copy(), tangents)

    def cut(self) -> list[Piece]:
        """All pieces, as the dynamic programme chooses them."""
        o = self.options
        found = cut(
            self.joints, self.near, o.margin, o.residual_tolerance, ROUNDS[o.effort], MOST_SPANS[o.effort],
            STRIDE[o.effort],
        )  # fmt: skip
        pieces: list[_Plan] = []
        for r, (i, j, k) in enumerate(found.rows.tolist()):
            if k == 0:
                pieces.append(_Plan(i, j, np.array([self.cubics[i, 0], self.cubics[j - 1, 3]])))
            elif found.errors[r] <= self.near:
                pieces.append(_Plan(i, j, found.vertices[r, : k + 1], found.tangents[r]))
            else:
                pieces += self._exact(i, j)
        return self._interpolated(pieces)

    def better(self, piece: Piece, attempt: int) -> list[Piece]:
        """What takes the place of a piece that failed: more spans, at last the source's segments."""
        o, near = self.options, 0.9 * self.near
        plan = self._turned(_Plan(piece.first, piece.last, piece.vertices))
        k = len(piece.vertices) - 1 + attempt
        if attempt < ATTEMPTS and k <= MOST_SPANS["best"]:
            p, tangents = np.empty((k + 1, 2)), np.empty((2, 2))
            error = fit_between(
                self.joints, plan.first, plan.last, k, near, o.margin, o.residual_tolerance, ROUNDS["best"],
                p, tangents[0], tangents[1],
            )  # fmt: skip
            if error <= near:
                return self._interpolated([_Plan(plan.first, plan.last, p, tangents)])
        return self._interpolated(self._exact(plan.first, plan.last))

    def _exact(self, i: int, j: int) -> list[_Plan]:
        """The source's segments i to j - 1, as lines and arcs of one span."""
        plans = []
        for s in range(i, j):
            a, b, c, d = self.cubics[s]
            tangents = None if self.degrees[s] == 1 else np.array([b - a, d - c]) * 3 / np.hypot(*(d - a))
            plans.append(_Plan(s, s + 1, np.array([a, d]), tangents))
        return plans

    def _interpolated(self, plans: list[_Plan]) -> list[Piece]:
        """The pieces planned, with curves put through the arcs."""
        o = self.options
        plans = [self._turned(plan) for plan in (reversed(plans) if self.flipped else plans)]
        arcs: dict[int, Interpolation] = {}
        for fallback in ("knot", "peak"):
            # The one free vertex of two spans peaks at 1/2, for which Lemma 2 has no interval: see arcs.PEAK_SHARE.
            chosen = [
                k for k, plan in enumerate(plans)
                if plan.tangents is not None and (len(plan.vertices) == 3) == (fallback == "peak")
            ]  # fmt: skip
            if not chosen:
                continue
            results = interpolate_many(
                [plans[k].vertices for k in chosen], o.variant,
                end_tangents=[(t[0], t[1]) for k in chosen if (t := plans[k].tangents) is not None],
                threads=1, margin=o.margin, fallback=fallback, residual_tolerance=o.residual_tolerance,
                max_iterations=o.max_iterations, closed=False,
            )  # fmt: skip
            arcs |= dict(zip(chosen, results, strict=True))
        return [Piece(plan.first, plan.last, plan.vertices, arcs.get(k)) for k, plan in enumerate(plans)]

    def distance(self, pieces: list[Piece]) -> Distance:
        """Certified distance of the pieces, rounded, from the source."""
        written = join(pieces).rounded(self.options.precision)
        ends = np.concatenate([[0], np.cumsum([len(p.vertices) - 1 for p in pieces])])
        joints = [*(p.first for p in pieces), pieces[0].first + len(self.cubics)]
        anchors = np.stack([ends, joints], axis=1).astype(np.float64)
        return certified_distance(written.cubics(), self.source, anchors, SHARPNESS * self.tolerance, self.tolerance)


def first_joint(joints: Joints) -> int:
    """A hard joint to begin at, or else that farthest from the middle: the same whatever the contour's first point."""
    hard = np.flatnonzero(joints.hard[:-1])
    if len(hard):
        return int(hard[0])
    return farthest_joint(joints.samples[joints.first[:-1]])


def open_loops(cubics: FloatArray, degrees: IntArray) -> tuple[FloatArray, IntArray]:
    """The segments with those that end where they begin cut in two: an arc needs two ends."""
    loops = np.flatnonzero((cubics[:, 0] == cubics[:, 3]).all(axis=1))
    if len(loops) == 0:
        return cubics, degrees
    left, right = split(cubics[loops])
    cubics = np.insert(cubics, loops + 1, right, axis=0)
    cubics[loops + np.arange(len(loops))] = left
    return cubics, np.insert(degrees, loops + 1, degrees[loops])
