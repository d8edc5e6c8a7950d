"""The steps of :mod:`.kernels.driver` in NumPy, all vertices of all polygons at once: the same bits, nothing compiled.

Polygons lie end to end in a *strip*, with ``PAD`` places before and behind the vertices of each. A pass has the stages
of :mod:`.kernels.passes`, from the same formulas in the same order. What is special is done one by one, by the
functions that are compiled elsewhere: merging vertices, the intervals beside the ends of arcs, what a pass leaves, and
variants 0 and 4. What is computed in places between the polygons is not used, and may be no number.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..compiled import in_numpy
from ..types import BoolArray, FloatArray, IntArray
from .found import Found, Rule, laid_out, rule_of
from .kernels import driver
from .kernels.driver import (
    BAD_KNOTS,
    BAD_POLYGON,
    FALLBACKS,
    ITERATIONS,
    KEPT,
    OK,
    PAD,
    SEARCHES,
    STATUS,
    UNCERTIFIED,
    set_ends,
    set_natural,
    unit_of,
)  # fmt: skip
from .kernels.footpoint import WORK
from .kernels.lemma2 import STEPS, arc_interval, begin, coefficients, finish, halley, simple
from .kernels.passes import (
    ELSE,
    LEFT,
    MAIN,
    NEWTON_STEPS,
    SETTLED_STEP,
    WILD,
    along,
    at_knot,
    guard_for,
    holds,
    rises,
)  # fmt: skip
from .kernels.search import FINE, GIVEN_UP, SearchedCurve, SearchRoom, look_again
from .method import RELATIVE_TOLERANCE
from .polygon import LARGEST, SAME_VERTEX, SMALLEST, Polygons

where: Any = np.where  # its types have another result for what may be None


@in_numpy(driver.interpolate)
def interpolate(
    k0: int, k1: int, points: FloatArray, offsets: IntArray, knots: FloatArray, tangents: FloatArray, held: BoolArray,
    by_knot: BoolArray, rule_in_numbers: FloatArray, numbers: FloatArray, whole: IntArray,
) -> FloatArray:  # fmt: skip
    """As :func:`.kernels.driver.interpolate`."""
    polygons, rule = Polygons(points, offsets, knots, tangents, held, by_knot), rule_of(rule_in_numbers)
    found = laid_out(numbers, whole, len(points), len(offsets) - 1, rule.closed, points.shape[1])
    _prepare(k0, k1, polygons, rule, found)
    return (driver.iterate if rule.variant in (0, 4) else _iterate)(k0, k1, polygons, rule, found)


def _prepare(k0: int, k1: int, polygons: Polygons, rule: Rule, found: Found) -> None:
    """As :func:`.kernels.driver.prepare`."""
    offsets, kept, closed = polygons.offsets, found.kept, rule.closed
    good: list[int] = []
    for k in range(k0, k1):
        first, last, shift = int(offsets[k]), int(offsets[k + 1]), k if closed else 0
        ends = slice(first + shift, last + shift + closed)
        points, u, given = polygons.points[first:last], found.knots[ends], polygons.knots[ends]
        n, extent = _merge(points, closed, kept[first:last])
        found.whole[k] = (BAD_POLYGON, n, -1, 0, 0, 0)
        if n < 0:
            continue
        found.tolerances[k] = RELATIVE_TOLERANCE * extent if np.isnan(rule.tolerance) else rule.tolerance
        own = kept[first : first + n]
        fine = _set_knots(points[own], own, rule.exponent, given, u[: n + closed])
        found.whole[k, STATUS] = OK if fine else BAD_KNOTS
        good += [k] if fine else []
    if good:
        strip = Strip(np.array(good), found.whole[good, KEPT], closed)
        _set_intervals(strip, strip.knot_steps(offsets, found.knots, np.ones(len(good))), polygons, rule, found)


def _distances(a: FloatArray, b: FloatArray) -> FloatArray:
    """(n,) distances of the rows of two arrays, as :func:`.kernels.driver.distance` computes them."""
    across = (a - b).T
    return np.asarray(np.sqrt(dot(across, across)))


def dot(a: FloatArray, b: FloatArray) -> FloatArray:
    """(n,) inner products of the columns of two arrays (d, n)."""
    return sums(a * b)


def sums(rows: FloatArray) -> FloatArray:
    """(n,) the sums of the columns of (d, n), in order: those of NumPy are in another one."""
    total = rows[0]
    for row in rows[1:]:
        total = total + row
    return total


def pair_first(rows: FloatArray) -> FloatArray:
    """(n,) sums as :mod:`.kernels.passes` adds: two rows of (d, n), and to that the sum of the rest."""
    rest = np.zeros(rows.shape[1])
    for row in rows[2:]:
        rest = rest + row
    return rows[0] + rows[1] + rest


def inner(a: FloatArray, b: FloatArray) -> FloatArray:
    """(n,) inner products of columns, added in this way."""
    return pair_first(a * b)


def _merge(q: FloatArray, closed: bool, kept: IntArray) -> tuple[int, float]:
    """As :func:`.kernels.driver.merge`, which does it where there is anything to merge."""
    n = len(q)
    if n >= (3 if closed else 2):
        extent = max(0.0, float((q.max(axis=0) - q.min(axis=0)).max()))
        steps = _distances(q, np.roll(q, -1, axis=0))[: n if closed else n - 1]
        if SMALLEST <= extent <= LARGEST and (steps > SAME_VERTEX * extent).all():
            away = not closed or (_distances(q[2:], q[0]) > 0.0) & (_distances(q[2:], q[1]) > 0.0)
            if np.any(away):
                kept[:] = np.arange(n)
                return n, extent
    return driver.merge(q, closed, kept)


def _set_knots(q: FloatArray, kept: IntArray, exponent: float, given: FloatArray, u: FloatArray) -> bool:
    """As :func:`.kernels.driver.set_knots`, for vertices (n, d) and n (closed: n + 1) knots ``u``."""
    n, m = len(q), len(u)
    if exponent < 0.0:
        u[:n] = given[kept] - given[kept[0]]
        u[n:] = given[-1] - given[kept[0]]
        u[0] = 0.0
    else:
        chords = _distances(q, np.roll(q, -1, axis=0))[: m - 1]
        u[0] = 0.0
        u[1:] = np.ones(m - 1) if exponent == 0.0 else (np.sqrt(chords) if exponent == 0.5 else chords)
        np.cumsum(u, out=u)
    return bool((u < np.inf).all() and (u[1:] > u[:-1]).all())


class Strip:
    """Polygons end to end.

    Attributes:
        which, counts, origins: (K,) their indices, numbers of vertices, and the places of their first vertices.
        owners, numbers, lanes: (N,) of the vertices that move: which of the polygons, number in it, and place.
        beside, like: places beside closed polygons, and those around them that have the same.
    """

    def __init__(self, which: IntArray, counts: IntArray, closed: bool) -> None:
        ends, inner, shift = np.cumsum(counts + 2 * PAD), counts - (0 if closed else 2), 0 if closed else 1
        self.which, self.counts, self.closed, self.size = which, counts, closed, int(ends[-1])
        self.origins = ends - counts - PAD
        self.owners = np.repeat(np.arange(len(which)), inner)
        self.numbers = np.arange(len(self.owners)) - np.repeat(np.cumsum(inner) - inner, inner) + shift
        self.lanes = self.origins[self.owners] + self.numbers
        away = where(np.arange(2 * PAD) < PAD, np.arange(-PAD, PAD), counts[:, None] + np.arange(-PAD, PAD))
        self.beside, self.like = self.origins[:, None] + away, self.origins[:, None] + away % counts[:, None]

    def knot_steps(self, offsets: IntArray, knots: FloatArray, units: FloatArray) -> FloatArray:
        """(M,) knot intervals, in units of the polygons (K,), by the place of the knot before them."""
        h = np.zeros(self.size)
        for k, n, origin, unit in zip(self.which, self.counts, self.origins, units, strict=True):
            u = knots[offsets[k] + (k if self.closed else 0) :][: n + self.closed]
            h[origin : origin + len(u) - 1] = (u[1:] - u[:-1]) * unit
        if self.closed:
            h[self.beside] = h[self.like]
        return h


def _set_intervals(strip: Strip, h: FloatArray, polygons: Polygons, rule: Rule, found: Found) -> None:
    """Search intervals of all polygons of a strip, with their fallbacks and rate bounds."""
    offsets, held, bounds = polygons.offsets, polygons.held, found.bounds
    peak_shares = where(np.resize(polygons.by_knot, len(offsets) - 1), 0.0, rule.peak_share)
    rows = offsets[strip.which][strip.owners] + strip.numbers
    low, high, least, missing = _intervals(h, strip.lanes, rule, peak_shares[strip.which][strip.owners])
    if not strip.closed and rule.variant > 1:
        for j in np.flatnonzero((strip.numbers < 3) | (strip.numbers > strip.counts[strip.owners] - 4)).tolist():
            q, k = strip.owners[j], strip.which[strip.owners[j]]
            n, origin, natural = int(strip.counts[q]), strip.origins[q], np.zeros(2)
            set_natural(polygons.tangents[k], n, h[origin - PAD :], natural)
            *own, stands = arc_interval(
                h, strip.lanes[j], strip.numbers[j], n, rule, peak_shares[k], natural, np.empty((2, 4))
            )
            if stands:
                low[j], high[j], least[j], missing[j] = *own, False
    if len(held):
        still = held[offsets[strip.which][strip.owners] + found.kept[rows]]
        low[still], high[still], least[still], missing[still] = 0.0, 0.0, 1.0, False
    for k, n in zip(strip.which, strip.counts, strict=True):
        bounds[offsets[k] : offsets[k] + n] = 0.0
    bounds[rows, 0], bounds[rows, 1] = low, high
    smallest = np.ones(len(strip.which))
    np.minimum.at(smallest, strip.owners, least)
    found.whole[strip.which, FALLBACKS] = np.bincount(strip.owners[missing], minlength=len(strip.which))
    found.rates[strip.which] = 2.0 * (1.0 - smallest)


def _intervals(
    h: FloatArray, lanes: IntArray, rule: Rule, peak_shares: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, BoolArray]:
    """As :func:`.kernels.lemma2.set_intervals` has them."""
    a, b, c, d = h[lanes - 2], h[lanes - 1], h[lanes], h[lanes + 1]
    if rule.variant in (0, 1, 3):
        return *simple(a, b, c, d, rule.variant), np.zeros(len(lanes), dtype=np.bool_)
    first, second, (behind, sign, least, missing, _) = begin(coefficients(a, b, c, d), rule.margin, peak_shares)
    low, high = finish(_crossed(*first), _crossed(*second), behind, sign, (missing > 0.0) & (peak_shares == 0.0), b, c)
    return low, high, least, missing > 0.0


def _crossed(
    k0: FloatArray, k1: FloatArray, k2: FloatArray, k3: FloatArray, inside: FloatArray, outside: FloatArray,
    x: FloatArray, final: FloatArray,
) -> FloatArray:  # fmt: skip
    """Where crossings are: as in :mod:`.kernels.lemma2`."""
    done = final > 0.0
    for _ in range(STEPS):
        new, inside, outside, last = halley(k0, k1, k2, k3, inside, outside, x)
        x, done = where(done, x, new), done | last
        if done.all():
            break
    return x


def _iterate(k0: int, k1: int, polygons: Polygons, rule: Rule, found: Found) -> FloatArray:
    """As :func:`.kernels.driver.iterate`."""
    whole = found.whole
    good = np.arange(k0, k1)[whole[k0:k1, STATUS] == OK]
    residuals: list[list[float]] = [[] for _ in range(k1 - k0)]
    state = State(good, polygons, rule.closed, found) if len(good) else None
    whole[good, ITERATIONS] = -1
    while state:
        squared, searched, uncertified = state.one_pass()
        errors, which = np.sqrt(squared), state.strip.which
        for k, error, unit in zip(which.tolist(), errors.tolist(), state.units.tolist(), strict=True):
            residuals[k - k0].append(error / unit)
        whole[which, SEARCHES] += searched
        whole[which, UNCERTIFIED] += uncertified
        whole[which, ITERATIONS] += 1
        over = (errors < found.tolerances[which] * state.units) | ~(np.inf > errors)
        over |= whole[which, ITERATIONS] >= rule.max_iterations
        for q in np.flatnonzero(over).tolist():
            state.store(q, polygons, found)
        if over.all():
            break
        state.go_on(~over)
    return np.array([error for each in residuals for error in each])


class State:
    """What :func:`.kernels.driver.iterate` keeps of a polygon, of all polygons of a strip, in units near 1.

    Attributes:
        P, p: (d, M) control points and vertices by place. h: (M,) knot intervals.
        weights: (6, M) as rows of a block have them, by the knot.
        own: (d, N) vertices. low, high, x: (N,) intervals and footpoints about the knots.
        free: (N,) 0 where the control point is held, else 1. moved: (d, N) control points of the next pass.
        units, knot_units: (K,) of lengths and of parameters. ends, natural: (K, 4, d), (K, 2) of arcs.
    """

    def __init__(self, which: IntArray, polygons: Polygons, closed: bool, found: Found) -> None:
        points, offsets, tangents, held = polygons.points, polygons.offsets, polygons.tangents, polygons.held
        knots, bounds, kept = found.knots, found.bounds, found.kept
        strip, d, count = Strip(which, found.whole[which, KEPT], closed), points.shape[1], len(which)
        self.strip, self.guard, self.units, self.knot_units = strip, guard_for(d), np.ones(count), np.ones(count)
        self.p, self.ends, self.natural = np.zeros((d, strip.size)), np.zeros((count, 4, d)), np.zeros((count, 2))
        for j, (k, n, origin) in enumerate(zip(which, strip.counts, strip.origins, strict=True)):
            q, u = points[offsets[k] :][kept[offsets[k] :][:n]], knots[offsets[k] + (k if closed else 0) :]
            self.units[j] = unit_of(float((q.max(axis=0) - q.min(axis=0)).max()))
            self.knot_units[j] = unit_of(float(u[n if closed else n - 1] / n))
            self.p[:, origin : origin + n] = (q - q[0]).T * self.units[j]
        self.h = h = strip.knot_steps(offsets, knots, self.knot_units)
        for j, (k, n, origin) in enumerate(zip(which, strip.counts, strip.origins, strict=True)):
            if not closed:
                set_natural(tangents[k], n, h[origin - PAD :], self.natural[j])
                scale, p = self.units[j] / self.knot_units[j], self.p[:, origin - PAD :]
                set_ends(tangents[k], scale, n, h[origin - PAD :], p, self.natural[j], self.ends[j])
        rows, lanes, unit = offsets[which][strip.owners] + strip.numbers, strip.lanes, self.knot_units[strip.owners]
        self.P, self.own, self.x, self.free = self.p.copy(), self.p[:, lanes], np.zeros(len(lanes)), np.ones(len(lanes))
        self.low = np.maximum(bounds[rows, 0] * unit, -h[lanes - 1])
        self.high = np.minimum(bounds[rows, 1] * unit, h[lanes])
        if len(held):
            self.free[held[offsets[which][strip.owners] + kept[rows]]] = 0.0
        self.weights = _weights(h)
        self.moved = self.own
        self.fill_edges()

    def fill_edges(self) -> None:
        """As :func:`.kernels.driver.fill_edges`."""
        P, strip = self.P, self.strip
        if strip.closed:
            P[:, strip.beside] = P[:, strip.like]
            return
        first, last, ends, natural = strip.origins, strip.origins + strip.counts - 1, self.ends.T, self.natural.T
        P[:, first] = ends[:, 0] + natural[0] * P[:, first + 1]
        P[:, last] = ends[:, 1] + natural[1] * P[:, last - 1]
        P[:, first - 1], P[:, last + 1] = ends[:, 2], ends[:, 3]

    def one_pass(self) -> tuple[FloatArray, IntArray, IntArray]:
        """The largest squared error of each polygon, footpoints that took a full search, and those not certified."""
        at, P, (rate, half, third, share, ahead, behind) = self.strip.lanes, self.P, self.weights
        x, d, c = P[:, at], np.zeros(P.shape), np.zeros(P.shape)
        d[:, 1:] = rate[1:] * (P[:, 1:] - P[:, :-1])
        c[:, :-1] = half[:-1] * (d[:, 1:] - d[:, :-1])
        w = c[:, at]
        e, v = at_knot(x - self.own, d[:, at], d[:, at + 1], share[at], ahead[at], behind[at])
        right, left = third[at] * (c[:, at + 1] - w), third[at - 1] * (c[:, at - 1] - w)
        ev, low, high = dot(e, v), self.low, self.high
        forward = (low >= 0.0) | ((high > 0.0) & (ev <= 0.0))
        side, near, far = where(forward, 1.0, -1.0), where(forward, low, -high), where(forward, high, -low)
        other, near = where(near < 0.0, -near, 0.0), where(near > 0.0, near, 0.0)
        y = side * self.x
        y = where(y > near, y, near)
        y = where(y < far, y, far)
        v, z, o = v * side, where(forward, right, left), where(forward, left, right)
        y, done = _newton(e, v, w, z, y, near, far)
        q, main = _main_side(e, v, w, z, y, near, far, self.guard)
        squared = inner(q, q)
        beyond = _other_side(e, v, w, o, other, -2.0 * side * ev, self.guard)
        fails = where(done & (main | (far - near <= 0.0)), 0.0, MAIN) + where(np.inf > squared, 0.0, WILD)
        fails += where(beyond | (other <= 0.0), 0.0, ELSE)
        move, self.x = where(fails == 0.0, self.free, 0.0), side * y
        self.moved = x - move * q
        largest = np.zeros(len(self.strip.which))
        np.maximum.at(largest, self.strip.owners, where(fails == 0.0, move * squared, 0.0))
        counts = np.zeros((2, len(largest)), dtype=np.int64)
        for j in np.flatnonzero(fails).tolist():
            self._settle(j, float(fails[j]), float(side[j]), largest, counts)
        return largest, counts[0], counts[1]

    def _settle(self, j: int, fails: float, side: float, largest: FloatArray, counts: IntArray) -> None:
        """As :func:`.kernels.search.settle`, for one vertex."""
        i, q, d = int(self.strip.lanes[j]), self.strip.owners[j], len(self.P)
        if fails >= WILD:
            largest[q], counts[1, q] = np.inf, counts[1, q] + 1
            return
        curve = SearchedCurve(self.P, self.p, self.h)
        room = SearchRoom(np.empty((4, d)), np.empty((min(d, 4), 4)), np.empty(d), np.empty(WORK))
        self.x[j], squared, outcome = look_again(curve, i, side, self.x[j], self.low[j], self.high[j], fails, room)
        largest[q] = max(largest[q], self.free[j] * squared)
        counts[:, q] += [outcome != FINE, outcome == GIVEN_UP]
        self.moved[:, j] = self.P[:, i] - self.free[j] * room.e

    def store(self, q: int, polygons: Polygons, found: Found) -> None:
        """The results of a polygon that is done: see :func:`.kernels.driver.store`."""
        strip, k, n, origin = self.strip, int(self.strip.which[q]), int(self.strip.counts[q]), self.strip.origins[q]
        first, shift = int(polygons.offsets[k]), 0 if strip.closed else 1
        own, out = polygons.points[first:][found.kept[first:][:n]], found.controls[first + 2 * k * shift :]
        out[shift : n + shift] = self.P[:, origin : origin + n].T * (1.0 / self.units[q]) + own[0]
        if shift:
            out[0], out[n + 1] = own[0], own[-1]
        u, x = found.knots[first + (k if strip.closed else 0) :][:n], np.zeros(n)
        x[shift : n - shift] = self.x[strip.owners == q]
        found.parameters[first : first + n] = u + x * (1.0 / self.knot_units[q])
        found.bounds[first : first + n] += u[:, None]

    def go_on(self, stay: BoolArray) -> None:
        """Move the control points, and leave out all polygons but those (K,) that stay."""
        self.P[:, self.strip.lanes] = self.moved
        if not stay.all():
            places, lanes = np.repeat(stay, self.strip.counts + 2 * PAD), stay[self.strip.owners]
            self.P, self.p, self.h = self.P[:, places], self.p[:, places], self.h[places]
            self.own, self.weights = self.own[:, lanes], self.weights[:, places]
            self.low, self.high, self.x, self.free = (a[lanes] for a in (self.low, self.high, self.x, self.free))
            self.units, self.knot_units, self.ends, self.natural = (
                a[stay] for a in (self.units, self.knot_units, self.ends, self.natural)
            )
            self.strip = Strip(self.strip.which[stay], self.strip.counts[stay], self.strip.closed)
        self.fill_edges()


def _weights(h: FloatArray) -> FloatArray:
    """(6, M) as :func:`.kernels.passes.set_weights` has them, for the knots that the intervals (M,) follow."""
    rate, half, before = np.zeros(len(h)), np.zeros(len(h)), np.zeros(len(h))
    before[1:] = h[:-1]
    rate[2:] = 3.0 / (h[:-2] + h[1:-1] + h[2:])
    half[1:] = 1.0 / (h[:-1] + h[1:])
    share = before * half
    return np.array([rate, half, 1.0 / (3.0 * h), share, share * before / 3.0, (1.0 - share) * h / 3.0])


def _newton(
    e: FloatArray, v: FloatArray, w: FloatArray, z: FloatArray, y: FloatArray, near: FloatArray, far: FloatArray
) -> tuple[FloatArray, BoolArray]:
    """Steps until all vertices have converged, and which have: as in :mod:`.kernels.passes`."""
    length, done = far - near, far <= near
    for _ in range(NEWTON_STEPS):
        q, p, a = along(e, v, w, z, y)
        speed = inner(p, p)
        bend = speed + 2.0 * inner(q, a)
        convex = bend > 0.05 * speed
        steep = where(convex, bend, speed)
        inverse = 1.0 / where(steep > 0.0, steep, 1.0)
        plain = inner(q, p) * inverse
        correction = 3.0 * pair_first(p * a + q * z) * inverse * plain
        correction = where(correction < 0.5, correction, 0.5)
        correction = where(correction > -0.5, correction, -0.5)
        left = where(convex, correction * correction, 1.0)
        new = y - (plain + plain * where(convex, correction, 0.0))
        new = where(new > near, new, near)
        new = where(new < far, new, far)
        moved = abs(new - y)
        y = where(done, y, new)
        done = done | ((moved <= SETTLED_STEP * length) & (left * moved <= LEFT * length))
        if done.all():
            break
    return y, done


def _main_side(
    e: FloatArray, v: FloatArray, w: FloatArray, z: FloatArray, y: FloatArray, near: FloatArray, far: FloatArray,
    guard: float,
) -> tuple[FloatArray, BoolArray]:  # fmt: skip
    """The curve's points less the vertices (d, N), and whether the certificate holds about y."""
    q, p, a = along(e, v, w, z, y)
    pp, aa, c4, length = inner(p, p), inner(a, a), inner(z, z), far - near
    c0, c1 = 2.0 * inner(q, a) + pp, 2.0 * pair_first(p * a + q * z)
    c2, c3, squared = 2.0 * inner(p, z) + aa, 2.0 * inner(a, z), length * length
    least = guard * (pp + squared * (aa + squared * c4))
    return q, holds(c0, c1, c2, c3, c4, far - y, least) & holds(c0, c1, c2, c3, c4, near - y, least)


def _other_side(
    e: FloatArray, v: FloatArray, w: FloatArray, o: FloatArray, L: FloatArray, slope: FloatArray, guard: float
) -> Any:
    """Whether the certificate holds about the knot, over the length of the other side."""
    vv, ww, c4, squared = inner(v, v), inner(w, w), inner(o, o), L * L
    c0, c1, c2, c3 = 2.0 * inner(e, w) + vv, 2.0 * pair_first(e * o - v * w), ww - 2.0 * inner(v, o), 2.0 * inner(w, o)
    least = L * (guard * (vv + squared * (ww + squared * c4)))
    return rises(slope, c0, c1, c2, c3, c4, L, least)
