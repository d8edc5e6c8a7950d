"""How uneven may knots be before a basis function's peak sinks to 1/2? An exhaustive, certified answer.

The paper leaves this open (its Section 5). The smallest peak over a whole box of knot intervals is bounded from below
by branch and bound: a box is settled when one value of the basis function, at a parameter fixed in proportion to the
intervals, stays above the target on all of it. Such a value is a sum of products of ratios L/(L + R) of interval
lengths, so that it and its gradient can be enclosed by interval arithmetic.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Literal, NamedTuple

import numpy as np
from scipy.optimize import brentq

from glyphspline.interpolation.intervals import basis_function, peaks
from glyphspline.types import BoolArray, FloatArray, IntArray

Constraint = Literal["box", "adjacent"]

SLACK = 1e-11
"""Rounding allowance on every bound: some 50 additions and products of numbers in [0, 1] err by less than 1e-13."""

AT_TARGET = 1e-9
"""How near a corner's peak has to be to the target for its box to be examined as the worst one."""

ISOLATED = 1e-12
"""Relative half width of the interval around a threshold: its rounding is some 1e-15."""


@dataclass(frozen=True, eq=False)
class Family:
    """Knot vectors ``h = exp(A y)`` with y in a box: the intervals of one basis function, up to a common factor.

    Attributes:
        A: (degree + 1, k) exponents, so that each interval is a product of powers of the free ratios.
        offset: (degree + 1,) added to ``A y``.
        low, high: (k,) the box.
    """

    A: FloatArray
    offset: FloatArray
    low: FloatArray
    high: FloatArray


def family(degree: int, ratio: float, constraint: Constraint) -> Family:
    """All knot vectors that matter when intervals are within ``ratio`` of each other.

    Moving the first knot to the left or the last to the right raises the basis function everywhere, so the two
    outer intervals are as short as allowed in the worst case: 1 in a box [1, ratio], and the neighbour divided
    by ``ratio`` where only adjacent intervals are bound. In that case the first inner interval is set to 1.
    """
    inner = degree - 1
    reach = np.log(ratio)
    if constraint == "box":
        A = np.zeros((degree + 1, inner))
        A[1:-1] = np.eye(inner)
        return Family(A, np.zeros(degree + 1), np.zeros(inner), np.full(inner, reach))
    A = np.zeros((degree + 1, inner - 1))
    A[1:-1] = np.tril(np.ones((inner, inner)), -1)[:, : inner - 1]
    A[-1] = A[-2]
    offset = np.zeros(degree + 1)
    offset[[0, -1]] = -reach
    return Family(A, offset, np.full(inner - 1, -reach), np.full(inner - 1, reach))


def windows_of(h: FloatArray) -> FloatArray:
    """(m, degree + 2) knots from (m, degree + 1) intervals."""
    return np.concatenate([np.zeros((len(h), 1)), np.cumsum(h, axis=1)], axis=1)


def peak_values(h: FloatArray) -> FloatArray:
    """(m,) the peak of the basis function on each row of intervals."""
    windows = windows_of(h)
    return basis_function(windows, peaks(windows))


def peak_positions(h: FloatArray) -> tuple[IntArray, FloatArray]:
    """The span each peak lies in, and its fraction of that span."""
    windows = windows_of(h)
    t = peaks(windows)[:, None]
    span = np.clip((windows <= t).sum(axis=1) - 1, 0, h.shape[1] - 1)
    rows = np.arange(len(h))
    return span, np.clip((t[:, 0] - windows[rows, span]) / h[rows, span], 0.0, 1.0)


class Enclosure(NamedTuple):
    """Interval enclosures [low, high] of a non-negative value and of its gradient by the intervals' logarithms."""

    low: FloatArray
    high: FloatArray
    slope_low: FloatArray
    slope_high: FloatArray


def _ratio(low: FloatArray, high: FloatArray, share: FloatArray, knots: slice) -> tuple[Enclosure, Enclosure]:
    """w = L/(L + R) and 1 - w for the spans ``knots``: ``share`` is 1 left of t, 0 right of it, x in its own span."""
    inside = np.zeros(low.shape[1])
    inside[knots] = 1.0
    left_low, left_high = ((a * share * inside).sum(axis=1) for a in (low, high))
    right_low, right_high = ((a * (1 - share) * inside).sum(axis=1) for a in (low, high))
    w_low = left_low / np.maximum(left_low + right_high, 1e-300)
    w_high = left_high / np.maximum(left_high + right_low, 1e-300)
    total_low, total_high = (low * inside).sum(axis=1)[:, None], (high * inside).sum(axis=1)[:, None]
    part_low = low * inside / np.where(inside > 0, low + total_high - high, 1.0)
    part_high = high * inside / np.where(inside > 0, high + total_low - low, 1.0)
    away_low, away_high = share - w_high[:, None], share - w_low[:, None]
    slope_low = np.minimum(part_low * away_low, part_high * away_low)
    slope_high = np.maximum(part_low * away_high, part_high * away_high)
    w = Enclosure(w_low, w_high, slope_low, slope_high)
    return w, Enclosure(1 - w_high, 1 - w_low, -slope_high, -slope_low)


def _product(a: Enclosure, b: Enclosure) -> Enclosure:
    """Enclosure of a b, by the product rule. Both factors are non-negative."""

    def times(low: FloatArray, high: FloatArray, c: Enclosure) -> tuple[FloatArray, FloatArray]:
        c_low, c_high = c.low[:, None], c.high[:, None]
        return np.minimum(low * c_low, low * c_high), np.maximum(high * c_low, high * c_high)

    first, second = times(a.slope_low, a.slope_high, b), times(b.slope_low, b.slope_high, a)
    return Enclosure(a.low * b.low, a.high * b.high, first[0] + second[0], first[1] + second[1])


def enclose(low: FloatArray, high: FloatArray, span: int, fraction: FloatArray) -> Enclosure:
    """Cox and de Boor in interval arithmetic: B at ``fraction`` of ``span``, for all intervals in [low, high].

    Args:
        low, high: (m, degree + 1) bounds of the intervals.
        span: the one that holds t.
        fraction: (m,) where in it.
    """
    m, spans = low.shape
    share = np.where(np.arange(spans) < span, 1.0, 0.0) * np.ones((m, 1))
    share[:, span] = fraction
    one = Enclosure(np.ones(m), np.ones(m), np.zeros_like(low), np.zeros_like(low))
    N: dict[int, Enclosure] = {span: one}
    for width in range(1, spans):
        raised: dict[int, Enclosure] = {}
        for i in range(max(0, span - width), min(span, spans - 1 - width) + 1):
            terms = []
            if i in N:
                terms.append(_product(_ratio(low, high, share, slice(i, i + width))[0], N[i]))
            if i + 1 in N:
                terms.append(_product(_ratio(low, high, share, slice(i + 1, i + 1 + width))[1], N[i + 1]))
            raised[i] = terms[0] if len(terms) == 1 else Enclosure(*(a + b for a, b in zip(*terms, strict=True)))
        N = raised
    return N[0]


def lower_bounds(f: Family, low: FloatArray, high: FloatArray) -> tuple[FloatArray, IntArray]:
    """A lower bound of the peak on each box (m, k), and (m,) the direction in which to halve the box.

    The value at the peak of the box's lowest-looking vertex is followed along every direction: exactly to the
    face where its slope has one sign, and from the middle by the mean value theorem where it has not.
    """
    middle = (low + high) / 2
    slope = _slopes(f, middle)
    span, fraction = peak_positions(np.exp(np.where(slope > 0, low, high) @ f.A.T + f.offset))
    bound, direction = np.empty(len(low)), np.empty(len(low), dtype=np.int64)
    for s in np.unique(span):
        rows = span == s
        bound[rows], direction[rows] = _bounds_at(f, low[rows], high[rows], int(s), fraction[rows])
    return bound, direction


def _bounds_at(
    f: Family, low: FloatArray, high: FloatArray, span: int, fraction: FloatArray
) -> tuple[FloatArray, IntArray]:
    box = _enclosed(f, low, high, span, fraction)
    slope_low, slope_high = _along_box(f, box)
    at = np.where(slope_low >= 0, low, np.where(slope_high <= 0, high, (low + high) / 2))
    mixed = (slope_low < 0) & (slope_high > 0)
    loss = np.where(mixed, np.maximum(-slope_low, slope_high), 0.0) * (high - low) / 2
    h = np.exp(at @ f.A.T + f.offset)
    value = enclose(h, h, span, fraction).low - loss.sum(axis=1)
    return np.maximum(value, box.low) - SLACK, np.argmax((slope_high - slope_low) * (high - low), axis=1)


def _enclosed(f: Family, low: FloatArray, high: FloatArray, span: int, fraction: FloatArray) -> Enclosure:
    """The value at ``fraction`` of ``span``, and its slopes, on each box."""
    positive, negative = np.maximum(f.A, 0), np.minimum(f.A, 0)
    h_low = np.exp(low @ positive.T + high @ negative.T + f.offset)
    h_high = np.exp(high @ positive.T + low @ negative.T + f.offset)
    return enclose(h_low, h_high, span, fraction)


def _along_box(f: Family, box: Enclosure) -> tuple[FloatArray, FloatArray]:
    """Bounds of the slopes along the directions of the family's box, from those by the intervals' logarithms."""
    positive, negative = np.maximum(f.A, 0), np.minimum(f.A, 0)
    return box.slope_low @ positive + box.slope_high @ negative, box.slope_high @ positive + box.slope_low @ negative


def _slopes(f: Family, y: FloatArray) -> FloatArray:
    """(m, k) slopes of the peak at points y (envelope theorem: those of B at the peak)."""
    h = np.exp(y @ f.A.T + f.offset)
    span, fraction = peak_positions(h)
    slopes = np.empty_like(y)
    for s in np.unique(span):
        rows = span == s
        point = enclose(h[rows], h[rows], int(s), fraction[rows])
        slopes[rows] = (point.slope_low + point.slope_high) / 2 @ f.A
    return slopes


def certify(
    degree: int, ratio: float, constraint: Constraint, target: float = 0.5, corners: bool = False, most: int = 4_000_000
) -> int | None:
    """Prove that every basis function allowed by the ratio peaks above ``target``.

    Args:
        corners: settle also the boxes at whose worst corner the peak is the target within ``AT_TARGET``, if the value
            of the basis function grows strictly from there along every direction. What is proven then: no peak is
            lower than that of such a corner, and a peak as low is found at the corner only.
        most: number of boxes after which it gives up.

    Returns:
        The number of boxes it took, or None if no proof was found with ``most``.
    """
    f = family(degree, ratio, constraint)
    low, high = f.low[None], f.high[None]
    count = 0
    while len(low):
        count += len(low)
        if count > most:
            return None
        bound, direction = lower_bounds(f, low, high)
        left = ~(bound > target)
        low, high, direction = low[left], high[left], direction[left]
        if corners and len(low):
            left = ~_grows_from_corner(f, low, high, target)
            low, high, direction = low[left], high[left], direction[left]
        rows = np.arange(len(low))
        cut = (low[rows, direction] + high[rows, direction]) / 2
        low2, high2 = low.copy(), high.copy()
        high2[rows, direction], low2[rows, direction] = cut, cut
        low, high = np.concatenate([low, low2]), np.concatenate([high2, high])
    return count


def _grows_from_corner(f: Family, low: FloatArray, high: FloatArray, target: float) -> BoolArray:
    """(m,) whether a box has a corner of the family whose peak is the target, and the value grows away from it.

    The value is that at the parameter of the corner's peak, in proportion to the intervals: its growth along every
    direction, over the whole box, leaves no lower peak in the box.
    """
    slope = _slopes(f, (low + high) / 2)
    y = np.where(slope > 0, low, high)
    outside = ((y == f.low) | (y == f.high)).all(axis=1)
    h = np.exp(y @ f.A.T + f.offset)
    candidates = np.flatnonzero(outside & (np.abs(peak_values(h) - target) < AT_TARGET))
    settled = np.zeros(len(low), dtype=np.bool_)
    span, fraction = peak_positions(h)
    for k in candidates:
        box = _enclosed(f, low[k : k + 1], high[k : k + 1], int(span[k]), fraction[k : k + 1])
        slope_low, slope_high = _along_box(f, box)
        upward = np.where(y[k] == low[k], slope_low[0], -slope_high[0])
        # Slopes beyond it have a sign whatever rounding does: to the slopes, by ``SLACK``, or to the place of the peak.
        settled[k] = (upward > 1e-6).all()
    return settled


def worst_corner(degree: int, ratio: float, constraint: Constraint) -> tuple[float, FloatArray]:
    """The smallest peak at the corners of the family's box, and the intervals there, the shortest being 1."""
    h, values = corners_of(degree, ratio, constraint)
    worst = h[np.argmin(values)]
    return float(values.min()), worst / worst.min()


def corners_of(degree: int, ratio: float, constraint: Constraint) -> tuple[FloatArray, FloatArray]:
    """(corners, degree + 1) intervals at the corners of the family's box, and (corners,) the peaks there."""
    f = family(degree, ratio, constraint)
    k = len(f.low)
    choice = (np.arange(2**k)[:, None] >> np.arange(k)) & 1
    h = np.exp(np.where(choice == 1, f.high, f.low) @ f.A.T + f.offset)
    return h, peak_values(h)


def crossing(degree: int, constraint: Constraint) -> float:
    """The ratio at which the smallest peak at a corner is 1/2, to double precision."""
    return float(brentq(lambda ratio: worst_corner(degree, ratio, constraint)[0] - 0.5, 1, 100, xtol=1e-15, rtol=1e-15))


POLYNOMIALS: dict[tuple[int, Constraint], tuple[int, ...]] = {
    (3, "box"): (1, -6, -39, -48),
    (3, "adjacent"): (1, -4, -12, -8),
    (4, "box"): (1, 0, -12, -8),
    (4, "adjacent"): (1, 2, -2, -8, -8, -4),
    (5, "box"): (1, 0, -3, -1),
    (6, "box"): (945, 1539, -492, -1920, -960, -128),
    (6, "adjacent"): (6, 43, 145, 304, 428, 390, 144, -208, -480, -544, -416, -224, -80, -16),
}
"""Factors, by descending powers, of 1/2 less the peak of the worst corner; docs/proofs.md says how they come about."""


def root(coefficients: tuple[int, ...], near: float) -> tuple[float, float]:
    """Two numbers between which a polynomial with integer coefficients changes its sign, which is decided exactly."""
    low, high = near * (1 - ISOLATED), near * (1 + ISOLATED)

    def value(x: float) -> Fraction:
        total = Fraction(0)
        for c in coefficients:
            total = total * Fraction(x) + c
        return total

    if value(low) * value(high) >= 0:
        raise ArithmeticError(f"no zero of {coefficients} between {low} and {high}")
    return low, high


@dataclass(frozen=True)
class Threshold:
    """Every peak exceeds 1/2 exactly if the ratio is less than ``ratio``, at which the worst corner has the peak 1/2.

    Attributes:
        ratio: to double precision.
        intervals: the worst corner.
        boxes: examined in the proof.
    """

    ratio: float
    intervals: tuple[float, ...]
    boxes: int


def threshold(degree: int, constraint: Constraint) -> Threshold | None:
    """Where the smallest peak reaches 1/2; None if corners never sink to it.

    The ratio is found at the corners. The whole box, a little enlarged, is then examined at that ratio: its boxes have
    peaks above 1/2, or values that grow from a corner of peak 1/2.
    """
    if worst_corner(degree, 100, constraint)[0] > 0.5:
        return None
    ratio = crossing(degree, constraint)
    boxes = certify(degree, ratio * (1 + ISOLATED), constraint, corners=True)
    if boxes is None:
        raise ArithmeticError(f"degree {degree}: no proof for intervals within {ratio}")
    intervals = worst_corner(degree, ratio, constraint)[1]
    h, peaks_there = corners_of(degree, ratio, constraint)
    for row in h[peaks_there < 0.5 + AT_TARGET]:
        row = row / row.min()
        if not (np.allclose(row, intervals) or np.allclose(row[::-1], intervals)):
            raise ArithmeticError(f"degree {degree}: another corner at the target, {row}")
    return Threshold(ratio, tuple(float(f"{x:.9g}") for x in intervals), boxes)
