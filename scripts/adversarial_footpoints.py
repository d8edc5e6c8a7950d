"""A search for footpoints that are not the nearest: seeded cases, evolved where answers are off, checked in 60 digits.

Two searches are attacked: ``search_piece`` on one piece of degree 2 to 6 (``pieces``), and the pass of variants 1 to 4
with the second look at what it leaves, on the two spans beside a knot with free control points (``passes``).
Cases are drawn where the nearest point is hard to find: the vertex near the evolute, at a cusp, near the curve, or as
far from one point as from another; control points on a lattice, on a line, or twice the same. In rounds, those with the
largest misses are kept and changed a little.

A *miss* is the distance of the answer less that of the nearest point, as a share of the size: the largest distance of a
Bézier point of the pieces from the vertex, or 1, the extent of a polygon in the units of the compiled passes. Every
case is compared with 128 samples a piece, the least of them refined. Those that look worst, and a sample of the others,
are then compared with the minimum by halving in 60-digit decimals, which encloses it. A miss beyond ``BOUND`` fails.
Answers that say they are not certified are counted.

Of 4 million cases (``make check-reference``) the largest miss is 5.0e-13, and 2 are not certified, of degree 6. The
depth-first search that gave up silently after 4000 parts missed by up to 5.8e-6 in the first 160,000 cases of
``passes``.
"""

from __future__ import annotations

import heapq
import sys
from decimal import Decimal, localcontext
from itertools import pairwise
from math import comb
from typing import Any, NamedTuple

import numpy as np

from glyphspline.code_files import kept
from glyphspline.compiled import compiled
from glyphspline.interpolation.kernels.driver import PAD
from glyphspline.interpolation.kernels.footpoint import WORK, search_piece
from glyphspline.interpolation.kernels.passes import (
    AXIS,
    BLOCK,
    HIGH,
    LOW,
    SCRATCH,
    WHOLE,
    X,
    one_pass,
    set_weights,
)  # fmt: skip
from glyphspline.interpolation.kernels.search import SearchedCurve, SearchRoom, settle
from glyphspline.interpolation.method import TIE_DISTANCE
from glyphspline.types import FloatArray, IntArray

from .survey import parser, surveyed

BOUND = 1e-12
"""The miss that ``footpoint.py`` states as its bound."""

SAMPLES = 128
DIGITS = 60
TIED = TIE_DISTANCE**2
ROUND = 20_000
"""Number of cases in a round."""

KEPT = 500
"""Number of cases, those with the largest misses, that others are made from; forgotten after ``RESTART`` rounds."""

RESTART = 20
Generator = np.random.Generator


@compiled
def distance_at(c: FloatArray, y: float) -> float:
    """|q(y)|, where c is (2, d + 1)."""
    d = c.shape[1] - 1
    u, v = c[0, d], c[1, d]
    for k in range(d - 1, -1, -1):
        u, v = u * y + c[0, k], v * y + c[1, k]
    return np.sqrt(u * u + v * v)


@compiled
def sampled_distance(c: FloatArray, low: float, high: float) -> float:
    """The smallest distance among samples and, between the neighbours of each that is least, by golden section."""
    step, best = (high - low) / SAMPLES, np.inf
    before, here = np.inf, distance_at(c, low)
    for k in range(SAMPLES + 1):
        after = distance_at(c, min(low + (k + 1) * step, high)) if k < SAMPLES else np.inf
        best = min(best, here)
        if here <= before and here <= after and step > 0.0:
            a, b = max(low + (k - 1) * step, low), min(low + (k + 1) * step, high)
            x, y = a + 0.381966 * (b - a), a + 0.618034 * (b - a)
            u, v = distance_at(c, x), distance_at(c, y)
            for _ in range(48):
                if u <= v:
                    b, y, v = y, x, u
                    x = a + 0.381966 * (b - a)
                    u = distance_at(c, x)
                else:
                    a, x, u = x, y, v
                    y = a + 0.618034 * (b - a)
                    v = distance_at(c, y)
            best = min(best, u, v)
        before, here = here, after
    return best


@compiled
def answer_pieces(c: FloatArray, reach: FloatArray, found: FloatArray) -> None:
    """Answers of ``search_piece``, whether they are certified, and misses by samples.

    Args:
        c: (n, 2, d + 1); reach: (n, 4) interval, first parameter, centre.
        found: (n, 3) parameter, 1 if certified, and the distance less that of the samples.
    """
    work = np.empty(WORK)
    for k in range(c.shape[0]):
        low, high, start, centre = reach[k, 0], reach[k, 1], reach[k, 2], reach[k, 3]
        x, _, certified = search_piece(c[k], c.shape[2] - 1, low, high, centre, start, np.inf, TIED, work)
        found[k, 0], found[k, 1] = x, certified
        found[k, 2] = distance_at(c[k], x) - sampled_distance(c[k], low, high)


@compiled
def answer_passes(
    P: FloatArray, h: FloatArray, p: FloatArray, reach: FloatArray, c: FloatArray, found: FloatArray
) -> None:
    """Answers of the pass over the vertices; as :func:`answer_pieces`.

    Args:
        P: (n, 5, 2) control points; h: (n, 6) knot intervals, the middle knot between the third and the fourth.
        p: (n, 2) vertices; reach: (n, 4) interval about the middle knot, first parameter, not used.
        c: (n, 2, 2, 4) coefficients of the pieces to the left and to the right, about the knot, p as the origin.
    """
    size = 2 * PAD + WHOLE
    steps, controls, following, vertices = np.ones(size), np.zeros((2, size)), np.zeros((2, size)), np.zeros((2, size))
    blocks, S, T, curve = (
        np.zeros(BLOCK),
        np.zeros(SCRATCH),
        np.zeros(2 * AXIS),
        SearchedCurve(controls, vertices, steps),
    )
    room = SearchRoom(np.zeros((4, 2)), np.zeros((2, 4)), np.zeros(2), np.zeros(WORK))
    for k in range(P.shape[0]):
        for i in range(6):
            steps[PAD - 3 + i] = h[k, i]
        for axis in range(2):
            for i in range(5):
                controls[axis, PAD - 2 + i] = P[k, i, axis]
            vertices[axis, PAD] = p[k, axis]
        set_weights(steps, PAD, PAD + 1, blocks)
        blocks[LOW], blocks[HIGH], blocks[X] = reach[k, 0], reach[k, 1], reach[k, 2]
        lost = 0
        if one_pass(controls, following, vertices, blocks, S, T, PAD, PAD + 1)[1] > 0:
            lost = settle(curve, following, blocks, PAD, PAD + 1, False, room)[2]
        x, nearest = blocks[X], np.inf
        found[k, 0], found[k, 1] = x, 1.0 if lost == 0 else 0.0
        if reach[k, 0] <= min(0.0, reach[k, 1]):
            nearest = sampled_distance(c[k, 0], reach[k, 0], min(0.0, reach[k, 1]))
        if reach[k, 1] >= max(0.0, reach[k, 0]):
            nearest = min(nearest, sampled_distance(c[k, 1], max(0.0, reach[k, 0]), reach[k, 1]))
        found[k, 2] = distance_at(c[k, 0 if x < 0.0 else 1], x) - nearest


def enclosed_distance(c: list[list[Decimal]], low: Decimal, high: Decimal) -> Decimal:
    """The smallest |q| on [low, high], by halving, from Bernstein coefficients of |q|², to 1e-15 of the size."""
    d = len(c[0]) - 1
    points = []
    for row in c:
        shifted = list(row)
        for k in range(d):
            for i in range(d - 1, k - 1, -1):
                shifted[i] += low * shifted[i + 1]
        scaled, power = [], Decimal(1)
        for value in shifted:
            scaled.append(value * power)
            power *= high - low
        points.append([sum(Decimal(comb(j, k)) / comb(d, k) * scaled[k] for k in range(j + 1)) for j in range(d + 1)])
    products = [Decimal(0)] * (2 * d + 1)
    for i in range(d + 1):
        for j in range(d + 1):
            weight = Decimal(comb(d, i) * comb(d, j)) / comb(2 * d, i + j)
            products[i + j] += weight * (points[0][i] * points[0][j] + points[1][i] * points[1][j])
    gap = max(map(abs, products)) * Decimal("1e-30")
    best = min(products[0], products[-1])
    parts = [(min(products), 0, products)]
    count = 1
    while parts and parts[0][0] < best - gap:
        row = heapq.heappop(parts)[2]
        left, right = [row[0]], [row[-1]]
        while len(row) > 1:
            row = [(a + b) / 2 for a, b in pairwise(row)]
            left.append(row[0])
            right.append(row[-1])
        best = min(best, row[0])
        for half in (left, right[::-1]):
            heapq.heappush(parts, (min(half), count, half))
            count += 1
    return max(best, Decimal(0)).sqrt()


def small(rng: Generator, n: int, most: float = 17.0) -> FloatArray:
    """(n,) numbers of either sign and of any order of magnitude down to 1e-17; a tenth are 0."""
    return rng.choice([-1.0, 1.0], n) * 10.0 ** -rng.uniform(0, most, n) * (rng.random(n) > 0.1)


def degenerate(rng: Generator, points: FloatArray) -> FloatArray:
    """Points (n, m, 2), of which some are on a lattice, on a line, one twice, or a mirror image of the others."""
    n, m = points.shape[:2]
    kind, rows = np.asarray(rng.integers(0, 10, n)), np.arange(n)
    points = np.where((kind == 0).reshape(-1, 1, 1), np.round(3 * points), points)
    points[..., 1] *= np.where(kind == 1, small(rng, n), 1.0)[:, None]
    at = rng.integers(1, m, n)
    near = points[rows, at - 1] + small(rng, n)[:, None] * rng.standard_normal((n, 2))
    points[rows, at] = np.where((kind == 2)[:, None], near, points[rows, at])
    mirrored = (points + points[:, ::-1] * [-1, 1]) / 2
    return np.where((kind >= 7)[:, None, None], mirrored, points)


def vertices(rng: Generator, q: FloatArray, velocity: FloatArray, bend: FloatArray) -> FloatArray:
    """Vertices near the evolute of a curve, near the curve, or anywhere.

    Args:
        q, velocity, bend: (n, 2) the curve's point, first and second derivative.
    """
    n = len(q)
    speed = np.hypot(*velocity.T)
    cross = velocity[:, 0] * bend[:, 1] - velocity[:, 1] * bend[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        normal = velocity[:, ::-1] * [-1, 1] / speed[:, None]
        radius = speed**3 / cross
    usable = np.isfinite(radius) & (np.abs(radius) < 10)
    radius = np.where(usable, radius, 1.0) * (1 + small(rng, n))
    kind = rng.integers(0, 8, n)
    away = np.where(kind < 5, radius, np.where(kind < 7, small(rng, n), rng.standard_normal(n)))
    aside = 0.1 * small(rng, n) * (kind == 4)
    return q + np.where(np.isfinite(normal), normal, 0.0) * away[:, None] + aside[:, None]


def intervals(rng: Generator, low: FloatArray, high: FloatArray) -> FloatArray:
    """(n, 4) intervals within [low, high], half of them all of it, first parameters and centres in them."""
    n = len(low)
    a, b = np.sort(rng.random((2, n)), axis=0)
    some = rng.random(n) < 0.5
    ends = np.stack([np.where(some, low + a * (high - low), low), np.where(some, low + b * (high - low), high)])
    inside = ends[0] + rng.choice([0.0, 0.5, 1.0, np.nan], (2, n)) * (ends[1] - ends[0])
    inside = np.where(np.isnan(inside), ends[0] + rng.random((2, n)) * (ends[1] - ends[0]), inside)
    return np.stack([*ends, *inside], axis=1)


def taken(cases: Any, which: IntArray) -> Any:
    """Some of the cases: named tuples of arrays of one length."""
    return type(cases)(*(array[which] for array in cases))


def joined(cases: Any, others: Any) -> Any:
    """Cases and others of their kind."""
    return type(cases)(*map(np.concatenate, zip(cases, others, strict=True)))


class Pieces(NamedTuple):
    """Cases of ``search_piece``; ``c`` and ``reach`` as in :func:`answer_pieces`."""

    c: FloatArray
    reach: FloatArray

    @classmethod
    def draw(cls, rng: Generator, n: int, degree: int) -> Pieces:
        """Cases of every kind."""
        points = degenerate(rng, rng.standard_normal((n, degree + 1, 2)))
        to_powers = np.array(
            [[comb(degree, k) * comb(k, j) * (-1) ** (k - j) for j in range(degree + 1)] for k in range(degree + 1)]
        )
        c = np.swapaxes(to_powers @ points, 1, 2)
        y = rng.choice([0.0, 0.5, 1.0, np.nan, np.nan, np.nan], n)
        y = np.where(np.isnan(y), rng.random(n), y)
        powers = y[:, None] ** np.arange(degree + 1)
        k = np.arange(degree + 1)
        cusp = rng.random(n) < 0.2
        velocity = (c[..., 1:] * k[1:] * powers[:, None, :-1]).sum(axis=-1)
        c[..., 1] -= np.where(cusp, 1 - small(rng, n), 0.0)[:, None] * velocity
        velocity = (c[..., 1:] * k[1:] * powers[:, None, :-1]).sum(axis=-1)
        bend = (c[..., 2:] * (k * (k - 1))[2:] * powers[:, None, :-2]).sum(axis=-1)
        c[..., 0] -= vertices(rng, (c * powers[:, None]).sum(axis=-1), velocity, bend)
        return cls(c, intervals(rng, np.zeros(n), np.ones(n)))

    def changed(self, rng: Generator, n: int) -> Pieces:
        """n cases, each a little different from one of these."""
        which = rng.integers(0, len(self.c), n)
        c, reach = self.c[which], self.reach[which]
        c = c * (1 + small(rng, n)[:, None, None] * rng.standard_normal(c.shape) * (rng.random(c.shape) < 0.4))
        other = intervals(rng, np.zeros(n), np.ones(n))
        return Pieces(c, np.where((rng.random(n) < 0.2)[:, None], other, reach))

    def answers(self) -> FloatArray:
        """As :func:`answer_pieces` has them."""
        found = np.empty((len(self.c), 3))
        answer_pieces(self.c, self.reach, found)
        return found

    def sizes(self) -> FloatArray:
        """(n,) largest distance of a Bézier point, at least 1."""
        zero = np.zeros(len(self.c))
        return np.maximum(bezier_size(self.c, zero, zero + 1), 1.0)

    def miss(self, k: int, x: float) -> float:
        """The distance at x less the smallest one, in 60 digits."""
        with localcontext() as context:
            context.prec = DIGITS
            c = [[Decimal(value) for value in row] for row in self.c[k].tolist()]
            low, high = (Decimal(value) for value in self.reach[k, :2].tolist())
            return float(exact_distance(c, Decimal(x)) - enclosed_distance(c, low, high))


class Passes(NamedTuple):
    """Cases of the passes; ``P``, ``h``, ``p`` and ``reach`` as in :func:`answer_passes`."""

    P: FloatArray
    h: FloatArray
    p: FloatArray
    reach: FloatArray

    @classmethod
    def draw(cls, rng: Generator, n: int) -> Passes:
        """Cases of every kind."""
        P = degenerate(rng, rng.standard_normal((n, 5, 2)))
        h = np.exp(rng.choice([0.0, 0.5, 1.5], n)[:, None] * rng.standard_normal((n, 6)))
        h = np.where((rng.random(n) < 0.5)[:, None], (h + h[:, ::-1]) / 2, h)
        y = rng.uniform(-1, 1, n) * (rng.random(n) > 0.3)
        y *= np.where(y < 0, h[:, 2], h[:, 3])
        origin = np.zeros((n, 2))
        cusp = rng.random(n) < 0.2
        q, velocity, bend = _at(coefficients(P, h, origin), y)
        unit = P.copy()
        unit[:, 2] += 1.0
        change = _at(coefficients(unit, h, origin), y)[1] - velocity
        usable = cusp & (np.abs(change[:, 0]) > 1e-2)
        with np.errstate(divide="ignore", invalid="ignore"):
            move = np.where(usable[:, None], velocity / change * (1 - small(rng, n))[:, None], 0.0)
        P[:, 2] -= move
        q, velocity, bend = _at(coefficients(P, h, origin), y)
        return cls(P, h, vertices(rng, q, velocity, bend), intervals(rng, -h[:, 2], h[:, 3]))

    def changed(self, rng: Generator, n: int) -> Passes:
        """n cases, each a little different from one of these."""
        which = rng.integers(0, len(self.P), n)
        P, p, reach = self.P[which], self.p[which], self.reach[which]
        P = P * (1 + small(rng, n)[:, None, None] * rng.standard_normal(P.shape) * (rng.random(P.shape) < 0.3))
        p = p + small(rng, n)[:, None] * rng.standard_normal(p.shape) * (rng.random(n) < 0.7)[:, None]
        other = intervals(rng, -self.h[which, 2], self.h[which, 3])
        return Passes(P, self.h[which], p, np.where((rng.random(n) < 0.2)[:, None], other, reach))

    def answers(self) -> FloatArray:
        """As :func:`answer_passes` has them."""
        found = np.empty((len(self.P), 3))
        answer_passes(self.P, self.h, self.p, self.reach, coefficients(self.P, self.h, self.p), found)
        return found

    def sizes(self) -> FloatArray:
        """(n,) largest distance of a Bézier point, at least 1."""
        c, zero = coefficients(self.P, self.h, self.p), np.zeros(len(self.P))
        sides = bezier_size(c[:, 0], -self.h[:, 2], zero), bezier_size(c[:, 1], zero, self.h[:, 3])
        return np.maximum(np.maximum(*sides), 1.0)

    def miss(self, k: int, x: float) -> float:
        """The distance at x less the smallest one, in 60 digits."""
        with localcontext() as context:
            context.prec = DIGITS
            exact = [np.vectorize(Decimal, otypes=[object])(a[k : k + 1]) for a in (self.P, self.h, self.p)]
            left, right = coefficients(*exact)[0].tolist()
            low, high = (Decimal(value) for value in self.reach[k, :2].tolist())
            zero, sides = Decimal(0), []
            if low <= min(high, zero):
                sides.append(enclosed_distance(left, low, min(high, zero)))
            if high >= max(low, zero):
                sides.append(enclosed_distance(right, max(low, zero), high))
            return float(exact_distance(left if x < 0 else right, Decimal(x)) - min(sides))


def coefficients(P: FloatArray, h: FloatArray, p: FloatArray) -> FloatArray:
    """(n, 2, 2, 4) coefficients of the pieces left and right of the middle knot, by the formulas of ``kernels.passes``.

    The arguments, as in :func:`answer_passes`, may be arrays of decimals.
    """
    d = 3 * (P[:, 1:] - P[:, :-1]) / (h[:, :4] + h[:, 1:5] + h[:, 2:6])[..., None]
    w = (d[:, 1:] - d[:, :-1]) / (h[:, 1:4] + h[:, 2:5])[..., None]
    a, b = h[:, 2:3], h[:, 3:4]
    share = a / (a + b)
    start = P[:, 2] - p + (share * a * d[:, 2] - (1 - share) * b * d[:, 1]) / 3
    velocity = (1 - share) * d[:, 1] + share * d[:, 2]
    left, right = (w[:, 1] - w[:, 0]) / (3 * a), (w[:, 2] - w[:, 1]) / (3 * b)
    return np.stack([np.stack([start, velocity, w[:, 1], z], axis=-1) for z in (left, right)], axis=1)


def _at(c: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Point and two derivatives at y of the pieces of :func:`coefficients`."""
    e, v, w, z = np.moveaxis(np.where((y < 0)[:, None, None], c[:, 0], c[:, 1]), -1, 0)
    y = y[:, None]
    return ((z * y + w) * y + v) * y + e, (3 * z * y + 2 * w) * y + v, 6 * z * y + 2 * w


def exact_distance(c: list[list[Decimal]], y: Decimal) -> Decimal:
    """|q(y)|"""
    squares = Decimal(0)
    for row in c:
        value = Decimal(0)
        for coefficient in reversed(row):
            value = value * y + coefficient
        squares += value * value
    return squares.sqrt()


def bezier_size(c: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    """(n,) the largest distance from the origin of a Bézier point of pieces (n, 2, d + 1) on [low, high]."""
    d = c.shape[-1] - 1
    k = np.arange(d + 1)
    binomial = np.array([[comb(i, j) for i in k] for j in k], dtype=np.float64)
    exponents = np.maximum(k[None] - k[:, None], 0)
    shifted = np.einsum("nai,ji,nji->naj", c, binomial, low[:, None, None] ** exponents)
    scaled = shifted * ((high - low)[:, None] ** k)[:, None]
    weights = np.array([[comb(j, i) / comb(d, i) for i in k] for j in k])
    return np.asarray(np.hypot(*np.moveaxis(scaled @ weights.T, 1, 0)).max(axis=-1))


class Found(NamedTuple):
    """What a search came to.

    Attributes:
        name: of the search.
        cases: their number; checked: of those compared in 60 digits.
        uncertified: answers that say so.
        miss: the largest one in the size, in 60 digits; sampled: against samples, which round themselves.
    """

    name: str
    cases: int
    checked: int
    uncertified: int
    miss: float
    sampled: float

    @property
    def good(self) -> bool:
        """Whether no miss is beyond the bound."""
        return self.miss <= BOUND and self.sampled <= BOUND

    def __str__(self) -> str:
        return (
            f"{self.name:9} {self.cases:9} cases, {self.checked:5} of them in {DIGITS} digits: largest miss "
            f"{self.miss:.1e} of the size, {self.sampled:.1e} against samples; {self.uncertified} not certified"
        )


def attack(name: str, degree: int, cases: int, checks: int, seed: int) -> Found:
    """Half of the cases are drawn, the other half evolved from those with the largest misses.

    Args:
        name: "pieces" or "passes".
        degree: of the pieces; passes are cubic.
        cases: their number, rounded up to a multiple of ``ROUND``.
        checks: number of cases compared in 60 digits: half the worst by samples, half any.
    """
    rng = np.random.default_rng([seed, degree, len(name)])
    rounds, uncertified, sampled, exact, checked = -(-cases // ROUND), 0, 0.0, 0.0, 0
    share = max(checks // (2 * rounds), 1)
    best: Any = None
    best_misses = np.empty(0)
    for turn in range(rounds):
        if turn % RESTART == 0 or turn % 2 == 0:
            now: Any = Passes.draw(rng, ROUND) if name == "passes" else Pieces.draw(rng, ROUND, degree)
        else:
            now = best.changed(rng, ROUND)
        with kept.compiling():  # as plain Python it takes hours
            found = now.answers()
        sizes = now.sizes()
        misses = found[:, 2] / sizes
        uncertified += int((found[:, 1] == 0).sum())
        sampled = max(sampled, float(misses.max()))
        order = np.argsort(-misses)
        for k in {*order[:share].tolist(), *rng.integers(0, ROUND, share).tolist()}:
            exact = max(exact, now.miss(k, float(found[k, 0])) / float(sizes[k]))
            checked += 1
        if turn % RESTART:
            now, misses = joined(best, now), np.append(best_misses, misses)
            order = np.argsort(-misses)
        best, best_misses = taken(now, order[:KEPT]), misses[order[:KEPT]]
    return Found(f"{name} {degree}", rounds * ROUND, checked, uncertified, exact, sampled)


def attacks(cases: int, checks: int, seed: int) -> list[tuple[str, int, int, int, int]]:
    """The arguments of :func:`attack` for both searches: most of the cases are cubic."""
    shares = [("passes", 3, 0.4), ("pieces", 3, 0.4), *(("pieces", degree, 0.05) for degree in (2, 4, 5, 6))]
    return [(name, degree, int(share * cases), int(share * checks), seed) for name, degree, share in shares]


def main() -> int:
    """Attack both searches; exit status 1 if there is a miss beyond the bound."""
    arguments = parser(__doc__, jobs=2, cases=4_000_000, checks=8_000, seed=2012).parse_args()
    tasks, bad = attacks(arguments.cases, arguments.checks, arguments.seed), 0
    for found in surveyed(attack, *zip(*tasks, strict=True), jobs=arguments.jobs):
        print(found, flush=True)
        bad += not found.good
    return min(bad, 1)


if __name__ == "__main__":
    sys.exit(main())
