"""Faults planted in real outlines, and how many of them are found: ``python -m scripts.planted_faults``.

The seven faces are of the Debian packages fonts-ebgaramond, fonts-inter, fonts-noto-core and fonts-dejavu, and of
matplotlib. Of each fault twenty are planted in each face, each alone in a glyph that has no such finding there. Faults
of cubics are planted in TrueType faces after their curves are raised to cubics, in whole units. All glyphs are written
to fonts, glyf or CFF, with another start point of each contour, and read again. A fault is found if there is a finding
of its kind, on its contour, near its place.

The same number of glyphs is written untouched. A finding there is false if the face as it is has none of its kind at
that place. The last column is the same in another em, 2048 units for 1000 and the other way, where every point is
rounded anew: findings near their thresholds come and go then. The exit status is 1 if fewer than 95 % of a fault are
found, or more than one glyph in 50 has a false finding.

``--mend 4`` mends the faults that are found instead, within so many thousandths of an em, and counts which are gone,
which outlines are within 2 thousandths of what they were before the fault, and what came that was not there before.
Where a face has more findings of that kind in the same glyph, these are mended, too: what it was is then mended as
well. Left out are faults that hide another finding of what was there before, such as a jump of curvature where a joint
kinks: what would undo them brings it back.
``--faults spike`` plants those whose names have this in them; ``--list`` names what is not found.
"""

from __future__ import annotations

import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from fontTools.pens.t2CharStringPen import T2CharStringPen
from fontTools.pens.ttGlyphPen import TTGlyphPen
from matplotlib import get_data_path

import glyphspline as gs
from glyphspline.curves.bezier import cross, derivative_points, evaluate, signed_curvature, split
from glyphspline.outlines.flaws.kinds import KINDS, MENDED
from glyphspline.outlines.outline import Contour
from glyphspline.plugins.checks.check import check_many
from glyphspline.plugins.checks.finding import Finding
from glyphspline.types import FloatArray

from .drawn_fonts import begun, ended
from .survey import faces, parser, table

FACES = (
    "EBGaramond12-Regular.otf", "Inter-Regular.otf", "NotoSans-Regular.ttf", "NotoSerif-Regular.ttf",
    "DejaVuSans.ttf", "STIXGeneral.ttf", "cmr10.ttf",
)  # fmt: skip
NEAR = 0.03
"""Of the em: distance from its place within which a fault is found."""

ROUNDING = 3 / np.sqrt(12)
"""Three standard deviations of the rounding of a coordinate to whole units."""

ROUGHLY = 1e-6
"""Units by which certified distances are above what they are."""

Segments = list[FloatArray]


class Planted(NamedTuple):
    """A contour with a fault: its segments, and where the fault is within which distance."""

    segments: Segments
    point: FloatArray
    radius: float


Planter = Callable[[Segments, int, float], Planted | None]


def rounded(segments: Segments) -> Segments:
    """In whole units."""
    return [np.round(segment) for segment in segments]


def size(vector: FloatArray) -> float:
    """Length of a vector."""
    return float(np.hypot(*vector))


def angle(a: FloatArray, b: FloatArray) -> float:
    """Degrees from one vector to another."""
    return float(np.degrees(np.arctan2(cross(a, b), a @ b)))


def rotated(vector: FloatArray, degrees: float) -> FloatArray:
    """A vector turned to the left."""
    turned = complex(*vector) * np.exp(1j * np.radians(degrees))
    return np.array([turned.real, turned.imag])


def tangents(segment: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The first and the last handle."""
    return segment[1] - segment[0], segment[-1] - segment[-2]


def joint(segments: Segments, j: int) -> float:
    """Degrees by which the contour turns where segment j begins."""
    return angle(tangents(segments[j - 1])[1], tangents(segments[j])[0])


def may_turn(a: FloatArray, b: FloatArray) -> float:
    """Degrees that rounding may make of a smooth joint, or the threshold of kinks."""
    first, second = 1 / max(size(a), 1e-9), 1 / max(size(b), 1e-9)
    return max(0.5, float(np.degrees(ROUNDING * np.sqrt(first**2 + second**2 + (first + second) ** 2))))


def curvature(segment: FloatArray, t: FloatArray) -> FloatArray:
    """Signed curvature at (k,) parameters of a segment, or of k of them."""
    points = np.broadcast_to(segment, (len(t), *segment.shape[-2:]))
    return signed_curvature(*(evaluate(derivative_points(points, order), t) for order in (1, 2)))


def cut(segment: FloatArray, *at: float) -> Segments:
    """The parts between ascending parameters."""
    parts, done = [], 0.0
    for t in at:
        left, segment = split(segment, (t - done) / (1 - done))
        parts.append(left)
        done = t
    return [*parts, segment]


def chord(segment: FloatArray) -> float:
    """Distance of the ends."""
    return size(segment[-1] - segment[0])


def with_handle(s: Segments, j: int, handle: FloatArray) -> Segments:
    """The segments with another first handle of segment j, in whole units."""
    return rounded([*s[:j], np.concatenate([s[j][:1], [s[j][0] + handle], s[j][2:]]), *s[j + 1 :]])


def kink(s: Segments, j: int, unit: float, degrees: float, before: Sequence[int] = (2, 3, 4)) -> Planted | None:
    """A handle turned at a smooth joint, by one degree more at most after its points are rounded.

    ``before`` are the numbers of points that the segment before may have: 2 where a line has to run into the curve.
    """
    if len(s[j]) < 3 or len(s[j - 1]) not in before or abs(joint(s, j)) > 0.2:
        return None
    return turned(s, j, degrees) if min(map(size, joint_handles(s, j))) >= 25 * unit else None


def beside_short(s: Segments, j: int, unit: float, degrees: float) -> Planted | None:
    """A curve cut where 8 to 20 thousandths of an em are left of it, and the longer part's handle turned there."""
    if len(s[j]) < 3 or chord(s[j]) < 60 * unit:
        return None
    parts = rounded(cut(s[j], (8 + 12 * (chord(s[j]) % 1)) * unit / chord(s[j])))
    new = [*s[:j], *parts, *s[j + 1 :]]
    if abs(joint(new, j + 1)) > 1 or size(tangents(parts[1])[0]) < 15 * unit or chord(parts[0]) < 5 * unit:
        return None
    return turned(new, j + 1, degrees)


def joint_handles(s: Segments, j: int) -> tuple[FloatArray, FloatArray]:
    """The handles where segment j begins."""
    return tangents(s[j - 1])[1], tangents(s[j])[0]


def turned(s: Segments, j: int, degrees: float) -> Planted | None:
    """The first handle of segment j turned, so that its joint turns by these degrees or up to one more."""
    for more in np.arange(0.0, 3.0, 0.25):
        new = with_handle(s, j, rotated(tangents(s[j])[0], degrees + more))
        if degrees <= abs(joint(new, j)) <= min(degrees + 1, 11):
            return Planted(new, new[j][0], 0.0)
    return None


def jump(s: Segments, j: int, unit: float) -> Planted | None:
    """A handle made shorter at a smooth joint of cubics: curvature jumps by twice the limit, and beyond rounding."""
    if len(s[j]) != 4 or len(s[j - 1]) != 4 or abs(joint(s, j)) > 0.2:
        return None
    new = with_handle(s, j, 0.6 * tangents(s[j])[0])
    a, b = tangents(new[j - 1])[1], tangents(new[j])[0]
    if min(size(a), size(b)) < 5 * unit or abs(joint(new, j)) > 0.9 * may_turn(a, b):
        return None
    before, after = curvature(new[j - 1], np.ones(1))[0], curvature(new[j], np.zeros(1))[0]
    moves = np.random.default_rng(0).uniform(-0.5, 0.5, (200, 4, 2))
    ends = [curvature(part, np.zeros(200)) for part in (new[j - 1][::-1] + moves, new[j] + moves[::-1])]
    if abs(after - before) < 4.5 * np.hypot(*(each.std() for each in ends)):
        return None
    enough = abs(after - before) >= max(2 / (1000 * unit), 0.5 * max(abs(before), abs(after)))
    return Planted(new, new[j][0], 0.0) if enough else None


def lump(s: Segments, j: int, unit: float) -> Planted | None:
    """A cubic cut in three, with handles of half their length at both cuts: curvature swells there by half or more."""
    if len(s[j]) != 4 or chord(s[j]) < 80 * unit or not 40 < abs(angle(*tangents(s[j]))) < 110:
        return None
    old = curvature(s[j], np.linspace(0, 1, 33))
    if not ((old > 0).all() or (old < 0).all()):
        return None
    parts = cut(s[j], 1 / 3, 2 / 3)
    for left, right in ((0, 1), (1, 2)):
        parts[left][2] = (parts[left][3] + parts[left][2]) / 2
        parts[right][1] = (parts[right][0] + parts[right][1]) / 2
    parts = rounded(parts)
    values = np.sign(old[0]) * np.concatenate([curvature(part, np.linspace(0, 1, 33)) for part in parts])
    if values.min() <= 0:  # two bends, not a lump
        return None
    valleys = values[:33].min(), values[33:66].min(), values[66:].min()
    peaks = values[[32, 33]].min(), values[[65, 66]].min()
    beside = [max(valleys[k], valleys[k + 1]) for k in range(2)]
    rise = min(peak - most for peak, most in zip(peaks, beside, strict=True))
    turn = max(abs(joint(parts, k)) / may_turn(tangents(parts[k - 1])[1], tangents(parts[k])[0]) for k in (1, 2))
    strong = all(peak > 1.5 * most for peak, most in zip(peaks, beside, strict=True))
    if not strong or turn > 1 or rise * (chord(parts[1])) ** 2 / (8 * np.pi**2) < 0.45 * unit:
        return None
    return Planted([*s[:j], *parts, *s[j + 1 :]], (parts[1][0] + parts[1][3]) / 2, chord(s[j]) / 2)


def turns(segment: FloatArray) -> tuple[float, float]:
    """Degrees that a segment turns to the left and to the right."""
    t = np.linspace(0, 1, 65)
    along = evaluate(np.broadcast_to(derivative_points(segment[None], 1)[0], (65, len(segment) - 1, 2)), t)
    each = np.array([angle(a, b) for a, b in pairwise(along)])
    return float(each[each > 0].sum()), float(-each[each < 0].sum())


def inflection(s: Segments, j: int, unit: float) -> Planted | None:
    """The first handle of a cubic, at a corner, on the other side of the chord: it bends back by 2° or more."""
    if len(s[j]) != 4 or chord(s[j]) < 60 * unit or abs(joint(s, j)) < 20 or min(turns(s[j])) > 0:
        return None
    side = np.sign(angle(*tangents(s[j])))
    for more in (2.0, 5.0, 8.0):
        new = s[j].copy()
        new[1] = new[0] + rotated(0.3 * (new[3] - new[0]), more * side)
        new = np.round(new)
        back, on = sorted(turns(new))
        if back >= 2.5 and back <= 0.2 * on and abs(angle(tangents(s[j - 1])[1], tangents(new)[0])) > 20:
            corner = abs(angle(new[1] - new[0], new[2] - new[1]))
            if corner > 1.5 * may_turn(new[1] - new[0], new[2] - new[1]):
                return Planted([*s[:j], new, *s[j + 1 :]], (new[0] + new[3]) / 2, chord(new) / 2)
    return None


def straight(s: Segments, j: int, unit: float) -> Planted | None:
    """A line as a curve that leaves it by a third of a thousandth of an em at most."""
    if len(s[j]) != 2 or chord(s[j]) < 40 * unit:
        return None
    if min(abs(joint(s, j)), abs(joint(s, (j + 1) % len(s)))) < 20:
        return None
    a, b = s[j][0], s[j][1]
    degree = max(len(segment) for segment in s) - 1
    steps = np.linspace(0.0, 1.0, max(degree, 2) + 1)
    new = np.round(a + steps[:, None] * (b - a))
    along = (b - a) / chord(s[j])
    off = np.abs((new - a) @ np.array([-along[1], along[0]])).max()
    return Planted([*s[:j], new, *s[j + 1 :]], (a + b) / 2, 0.0) if off * 0.75 < 0.33 * unit else None


def slanted(s: Segments, j: int, unit: float) -> Planted | None:
    """The end of a horizontal or vertical line moved, by a unit or more, 0.06° to 0.42°."""
    a, b = s[j][0], s[j][-1]
    if len(s[j]) != 2 or chord(s[j]) < 140 * unit or len(s) < 3 or (a != b).all():
        return None
    k = 0 if a[0] == b[0] else 1
    off = max(1.0, np.ceil(0.5 * unit), float(np.round(chord(s[j]) * np.tan(np.radians(0.3)))))
    if np.degrees(np.arctan(off / chord(s[j]))) > 0.42:
        return None
    new, following = [segment.copy() for segment in s], (j + 1) % len(s)
    new[j][-1, k] += off
    new[following][0, k] += off
    if len(new[following]) > 2:
        new[following][1, k] += off
    return Planted(new, (new[j][0] + new[j][-1]) / 2, 0.0)


def extremum(s: Segments, j: int, unit: float) -> Planted | None:
    """The point at an extremum left out: one curve from the segment before to that behind, 2/1000 em or more higher."""
    before, behind = s[j - 1], s[j]
    if min(len(before), len(behind)) < 3 or len(s) < 3 or abs(joint(s, j)) > 1:
        return None
    along = tangents(behind)[0]
    if min(abs(along)) > 0.01 * max(abs(along)):
        return None
    k = int(abs(along[1]) < abs(along[0]))
    first, last = cut(before, 0.5), cut(behind, 0.5)
    p, q = first[1][0], last[0][-1]
    u, v = tangents(first[1])[0], tangents(last[0])[1]
    if abs(angle(u, v)) < 20 or abs(angle(u, v)) > 150:
        return None
    reach = cross(q - p, v) / cross(u, v)
    meet = p + reach * u
    if reach <= 0 or (q - meet) @ v <= 0:
        return None
    inner = [meet] if len(before) == 3 else [p + 0.6 * (meet - p), q + 0.6 * (meet - q)]
    middle = np.round(np.array([p, *inner, q]))
    path = evaluate(np.broadcast_to(middle, (65, *middle.shape)), np.linspace(0, 1, 65))[:, k]
    beyond = max(path.max() - max(path[0], path[-1]), min(path[0], path[-1]) - path.min())
    if beyond < 2 * unit:
        return None
    new = s.copy()
    new[j - 1], new[j] = first[0], last[1]
    at = j if j else len(new)
    top = evaluate(middle[None], np.array([0.5]))[0]
    return Planted(rounded([*new[:at], middle, *new[at:]]), top, chord(middle) / 2)


def short(s: Segments, j: int, unit: float) -> Planted | None:
    """A segment cut off near its end: 2.4/1000 em or less."""
    if chord(s[j]) < 30 * unit:
        return None
    parts = rounded(cut(s[j], 1 - 2 * unit / chord(s[j])))
    fits = chord(parts[1]) > 0 and size(np.ptp(parts[1], axis=0)) <= 2.4 * unit
    return Planted([*s[:j], *parts, *s[j + 1 :]], parts[1][0], 0.0) if fits and chord(parts[0]) >= 20 * unit else None


def handles(s: Segments, j: int, unit: float) -> Planted | None:
    """A handle a quarter longer than to the place where both meet, and four units or more.

    Not beside a curve that bends the other way: their bend then ends inside the segment.
    """
    if len(s[j]) != 4:
        return None
    u, v, x = s[j][1] - s[j][0], s[j][2] - s[j][3], s[j][3] - s[j][0]
    if min(size(u), size(v)) < 10 * unit or abs(cross(u, v)) < 0.35 * size(u) * size(v):
        return None
    reach, other = cross(x, v) / cross(u, v), cross(x, u) / cross(u, v)
    beside = [angle(*tangents(each)) for each in (s[j - 1], s[(j + 1) % len(s)]) if len(each) > 2]
    if any(turn * angle(*tangents(s[j])) < 0 for turn in beside):
        return None
    if reach <= 0 or other <= 0 or 0.25 * reach * size(u) < max(4, 4 * unit):
        return None
    new = with_handle(s, j, 1.25 * reach * u)
    return Planted(new, (s[j][0] + s[j][3]) / 2, chord(s[j]) / 2)


def detour(s: Segments, j: int, unit: float, points: Sequence[tuple[float, float]]) -> Planted | None:
    """A line by way of points: parts of its length, and thousandths of an em to its left."""
    a, b = s[j][0], s[j][-1]
    if len(s[j]) != 2 or chord(s[j]) < 100 * unit:
        return None
    left = rotated((b - a) / chord(s[j]), 90) * unit
    way = np.round(np.array([a, *[a + x * (b - a) + y * left for x, y in points], b]))
    lines = [np.array(pair) for pair in pairwise(way)]
    return Planted([*s[:j], *lines, *s[j + 1 :]], (a + b) / 2, 30 * unit + chord(s[j]) / 10)


def spike(s: Segments, j: int, unit: float) -> Planted | None:
    """A line with a spike of 2 units' width, 15 to 60 thousandths of an em long, to the left or to the right."""
    reach, half = 15 + chord(s[j]) % 45, 1 / max(chord(s[j]), 1)
    return detour(s, j, unit, [(0.5 - half, 0), (0.5, reach if j % 2 else -reach), (0.5 + half, 0)])


def loop(s: Segments, j: int, unit: float, height: float) -> Planted | None:
    """A line with a loop of so many thousandths of an em."""
    a, wide = height * unit / max(chord(s[j]), 1), height / 2
    way = [(0.5 + a, 0), (0.5 + a, wide), (0.5 - a, wide), (0.5 - a, -wide), (0.5 + 2 * a, -wide)]
    return detour(s, j, unit, way)


def swapped(s: Segments, j: int, unit: float) -> Planted | None:
    """Both ends of a line swapped, between lines: a bow."""
    if len(s) < 4 or any(len(s[(j + k) % len(s)]) != 2 for k in (-1, 0, 1)):
        return None
    a, b, c, d = s[j - 1][0], s[j][0], s[j][1], s[(j + 1) % len(s)][1]
    if min(size(b - a), size(c - b), size(d - c)) < 10 * unit or not cross_over(a, c, b, d):
        return None
    new = s.copy()
    new[j - 1], new[j], new[(j + 1) % len(s)] = np.array([a, c]), np.array([c, b]), np.array([b, d])
    return Planted(new, b, np.inf)


def beyond_corner(s: Segments, j: int, unit: float) -> Planted | None:
    """Two lines drawn on beyond their corner by 2 to 10 thousandths of an em, and joined there."""
    if len(s[j]) != 2 or len(s[j - 1]) != 2 or len(s) < 3 or not 30 < abs(joint(s, j)) < 150:
        return None
    a, b = (arm / size(arm) * (2 + chord(s[j]) % 8) * unit for arm in joint_handles(s, j))
    p, q = np.round(s[j][0] + a), np.round(s[j][0] - b)
    if min(chord(s[j]), chord(s[j - 1])) < 30 * unit or not cross_over(s[j - 1][0], p, q, s[j][1]):
        return None
    new = [*s[:j], np.array([p, q]), np.array([q, s[j][1]]), *s[j + 1 :]]
    new[j - 1 if j else -1] = np.array([s[j - 1][0], p])
    return Planted(new, s[j][0], np.inf)


def cross_over(a: FloatArray, b: FloatArray, c: FloatArray, d: FloatArray) -> bool:
    """Whether two lines, a to b and c to d, cross."""
    one, other = b - a, d - c
    return bool(cross(one, c - a) * cross(one, d - a) < 0 and cross(other, a - c) * cross(other, b - c) < 0)


def direction(s: Segments, j: int, unit: float) -> Planted | None:
    """A contour that runs backwards."""
    return None if j else Planted([segment[::-1] for segment in s[::-1]], s[0][0], np.inf)


def overlap(s: Segments, j: int, unit: float) -> Planted | None:
    """A contour and a copy of it, moved by a hundredth of an em: of equal area, neither lies inside the other."""
    return None if j else Planted(s, np.round([6 * unit, 8 * unit]), np.inf)


def copied(s: Segments, j: int, unit: float) -> Planted | None:
    """A contour and a copy of it in its place."""
    return None if j else Planted(s, np.zeros(2), np.inf)


def almost_closed(s: Segments, j: int, unit: float) -> Planted | None:
    """A contour whose end is a unit or two from its start."""
    if j or len(s[0]) > 2 or len(s[-1]) > 2:
        return None
    gap = np.array([1.0, chord(s[0]) % 2 > 1])
    new = [*s[:-1], np.array([s[-1][0], s[-1][-1] + gap]), np.array([s[-1][-1] + gap, s[0][0]])]
    return Planted(new, s[0][0], 0.0)


def crossed_handles(s: Segments, j: int, unit: float) -> Planted | None:
    """Both handles half longer than to the place where they meet."""
    one = handles(s, j, unit)
    if one is None:
        return None
    back = [segment[::-1] for segment in one.segments[::-1]]
    k = len(s) - 1 - j
    u, v, x = back[k][1] - back[k][0], s[j][1] - s[j][0], back[k][3] - back[k][0]
    new = with_handle(back, k, 1.5 * cross(x, v) / cross(u, v) * u)
    return one._replace(segments=[segment[::-1] for segment in new[::-1]])


def retracted(s: Segments, j: int, unit: float) -> Planted | None:
    """A handle of no length, of a curve that turns by 15 degrees or more."""
    if len(s[j]) != 4 or abs(angle(*tangents(s[j]))) < 15 or size(tangents(s[j])[0]) < 5 * unit:
        return None
    return Planted(with_handle(s, j, np.zeros(2)), (s[j][0] + s[j][3]) / 2, chord(s[j]) / 2)


def unlevel(s: Segments, j: int, unit: float, units: float) -> Planted | None:
    """The handles of an extreme point turned, until the longer one's end is so many units off level."""
    if min(len(s[j]), len(s[j - 1])) < 3 or abs(joint(s, j)) > 0.01:
        return None
    a, b = joint_handles(s, j)
    k = 0 if b[0] == 0 else 1
    before, behind = s[j - 1][0] - s[j][0], s[j][-1] - s[j][0]
    if b[k] != 0 or min(size(a), size(b)) < 20 * unit or before[k] * behind[k] <= 0:
        return None
    if min(abs(before[k]), abs(behind[k])) < 3 * units:
        return None
    new = [segment.copy() for segment in s]
    longer = max(size(a), size(b))
    new[j - 1][-2, k] -= units * size(a) / longer
    new[j][1, k] += units * size(b) / longer
    return Planted(rounded(new), s[j][0], 0.0)


def repeated(s: Segments, j: int, unit: float) -> Planted | None:
    """A point that is there twice."""
    return Planted([*s[:j], s[j][[0, 0]], *s[j:]], s[j][0], 0.0)


def leftover(s: Segments, j: int, unit: float) -> Planted | None:
    """A point on a line."""
    if len(s[j]) != 2 or chord(s[j]) < 60 * unit:
        return None
    parts = rounded(cut(s[j], 0.3 + chord(s[j]) % 0.4))
    return Planted([*s[:j], *parts, *s[j + 1 :]], parts[1][0], 0.0)


SMALL = frozenset({"extreme point 1 units off level"})
"""Faults below the threshold in an em of 2048 units."""

CUBIC = frozenset({"jump", "lump", "inflection", "handle too long", "crossed handles", "handle of no length"})
"""Faults of cubics."""

TABLE: tuple[tuple[str, Planter, str], ...] = (
    *((f"kink of {n}°", partial(kink, degrees=n), "kink turn") for n in (2, 3, 5, 8, 10)),
    *((f"kink of {n}° beside a short segment", partial(beside_short, degrees=n), "kink turn") for n in (3, 5, 8)),
    *((f"line into curve, {n}°", partial(kink, degrees=n, before=[2]), "kink turn") for n in (2, 3, 5)),
    ("jump", jump, "jump"),
    ("lump", lump, "lump"),
    ("inflection", inflection, "inflection"),
    ("straight", straight, "straight"),
    ("slanted", slanted, "slanted"),
    ("extremum left out", extremum, "extremum"),
    *((f"extreme point {units} units off level", partial(unlevel, units=units), "unlevel kink") for units in (1, 2, 3)),
    ("short segment", short, "short"),
    ("almost closed", almost_closed, "short"),
    ("handle too long", handles, "handles"),
    ("crossed handles", crossed_handles, "handles"),
    ("handle of no length", retracted, "retracted"),
    ("doubled point", repeated, "repeated"),
    ("leftover point on a line", leftover, "leftover"),
    ("spur", partial(detour, points=[(0.5, 0), (0.5, 30), (0.5, 0)]), "doubled"),
    ("spike of 2 units' width", spike, "spike"),
    *((f"loop of {height} thousandths", partial(loop, height=height), "crossing") for height in (30, 10, 4)),
    ("ends of a line swapped", swapped, "crossing"),
    ("lines beyond their corner", beyond_corner, "crossing"),
    ("doubled contour", copied, "doubled"),
    ("overlap", overlap, "overlap"),
    ("direction", direction, "direction covered"),
)
FAULTS = {name: (planter, frozenset(kinds.split())) for name, planter, kinds in TABLE}


class Fault(NamedTuple):
    """What was planted where, and which kinds of findings say so."""

    name: str
    kinds: frozenset[str]
    contour: int
    point: FloatArray
    radius: float


def matches(found: Finding, kinds: frozenset[str], contour: int, point: FloatArray, radius: float) -> bool:
    """Whether a finding is of such a kind and near this place."""
    return found.kind in kinds and found.contour == contour and size(np.array(found.point) - point) <= radius


def planted(
    contours: Sequence[Segments], em: float, findings: Sequence[Finding], name: str, rng: np.random.Generator
) -> tuple[list[Segments], Fault] | None:
    """Contours with one fault; None if it cannot be planted."""
    planter, kinds = FAULTS[name]
    places = [(c, j) for c, segments in enumerate(contours) for j in range(len(segments))]
    for index in rng.permutation(len(places))[:200]:
        c, j = places[index]
        made = planter(contours[c], j, em / 1000)
        if made is None:
            continue
        radius = made.radius + NEAR * em
        if any(matches(each, kinds, c, made.point, 1.5 * radius) for each in findings):
            continue
        new = [*contours[:c], made.segments, *contours[c + 1 :]]
        if name in ("overlap", "doubled contour"):
            new.append([segment + made.point for segment in made.segments])
        return new, Fault(name, kinds, c, made.point, radius)
    return None


def cubics_of(outline: gs.Outline) -> gs.Outline:
    """The outline with its curves as cubics in whole units."""
    contours = []
    for contour in outline.contours:
        pairs = zip(contour.segments(), np.round(contour.cubics()), strict=True)
        contours.append(Contour.from_segments([np.round(old) if len(old) == 2 else new for old, new in pairs]))
    return replace(outline, contours=contours)


def faults_in(
    outlines: Sequence[gs.Outline], outer: int, names: Sequence[str], wanted: int, rng: np.random.Generator
) -> tuple[list[list[Segments]], list[Fault], list[gs.Outline]]:
    """So many glyphs with each of these faults, and what each was before."""
    em, before = outlines[0].metrics.units_per_em, check_many(outlines, outer=outer)
    glyphs, faults, clean = [], [], []
    for name in names:
        left = wanted
        for k in [*rng.permutation(len(outlines)), *rng.permutation(len(outlines))]:
            contours = [list(contour.segments()) for contour in outlines[k].contours]
            if left and (made := planted(contours, em, before[k], name, rng)):
                glyphs.append([moved_start(segments, rng) for segments in made[0]])
                faults.append(made[1])
                clean.append(outlines[k])
                left -= 1
    return glyphs, faults, clean


def moved_start(segments: Segments, rng: np.random.Generator) -> Segments:
    """The contour from another start, of those in whole units: a point between two control points is not stored."""
    k = int(rng.choice([j for j, segment in enumerate(segments) if (segment[0] % 1 == 0).all()] or [0]))
    return [*segments[k:], *segments[:k]]


def write(path: Path, glyphs: Sequence[list[Segments]], em: int, cubic: bool) -> None:
    """Write a font, in whole units."""
    names = [".notdef", *[f"g{k}" for k in range(len(glyphs))]]
    builder = begun(names, {0xE000 + k: name for k, name in enumerate(names[1:])}, cubic=cubic, em=em)
    drawn: dict[str, Any] = {}
    for name, contours in zip(names, [[], *glyphs], strict=True):
        pen = T2CharStringPen(em, None) if cubic else TTGlyphPen(None)
        for segments in contours:
            pen.moveTo(tuple(segments[0][0]))
            for segment in segments:
                points = [tuple(point) for point in segment[1:].tolist()]
                {2: pen.lineTo, 3: pen.qCurveTo, 4: pen.curveTo}[len(segment)](*points)
            pen.closePath()
        drawn[name] = pen.getCharString(optimize=False) if cubic else pen.glyph(dropImpliedOnCurves=True)
    if cubic:
        builder.setupCFF("Planted", {"FullName": "Planted"}, drawn, {})
    else:
        builder.setupGlyf(drawn)
    # A reader moves a glyph of a TrueType font to its left side bearing.
    lefts = {} if cubic else {name: getattr(builder.font["glyf"][name], "xMin", 0) for name in names}
    ended(builder, {name: (em, lefts.get(name, 0)) for name in names}, "Planted").save(path)


def stored(glyphs: Sequence[list[Segments]], em: float, cubic: bool) -> tuple[list[gs.Outline], int]:
    """Glyphs written to a font and read again, and the direction of its outer contours."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "planted.font"
        write(path, glyphs, int(em), cubic)
        font = gs.open_font(path)
        return [font.outline(f"g{k}") for k in range(len(glyphs))], font.outer


def checked(glyphs: Sequence[list[Segments]], em: float, cubic: bool) -> list[list[Finding]]:
    """The findings of glyphs that are written to a font and read again."""
    outlines, outer = stored(glyphs, em, cubic)
    return check_many(outlines, outer=outer)


class Mended(NamedTuple):
    """What became of a fault: whether it is gone, with less than 2/1000 em left of it, and what came with that."""

    gone: bool
    near: bool
    new: bool
    points: bool
    why: str


def mended(outline: gs.Outline, clean: gs.Outline, fault: Fault, outer: int, tolerance: float) -> Mended | None:
    """Mend a fault; None if it is not found, or hides a finding. ``tolerance`` in thousandths of an em."""
    unit = outline.metrics.units_per_em / 1000
    found, of_clean = gs.check(outline, outer=outer), gs.check(clean, outer=outer)
    own = [each for each in found if matches(each, *fault[1:]) and each.kind in MENDED]
    if not own or Counter((each.kind, each.contour) for each in of_clean) - Counter((e.kind, e.contour) for e in found):
        return None
    kinds = {each.kind for each in own}
    new, changes = gs.mend(outline, kinds, tolerance * unit, outer=outer)
    after = gs.check(new, outer=outer)
    places = {(each.kind, each.contour, each.segment) for each in own}
    whys = [each.why for each in changes if each.why and (each.kind, each.contour, each.segment) in places]
    came = Counter((each.kind, each.contour) for each in after) - Counter((each.kind, each.contour) for each in found)
    more = len(new.arrays.points) > len(outline.arrays.points)
    wanted = clean, gs.mend(clean, kinds, tolerance * unit, outer=outer)[0]
    near = not whys and any(gs.compare(each, new).bound <= 2 * unit + ROUGHLY for each in wanted)
    return Mended(not whys, near, bool(came), more, whys[0] if whys else "")


def new_findings(found: Sequence[Finding], before: Sequence[Finding], scale: float, em: float) -> list[Finding]:
    """Those that are not near one of the same kind in the face as it is."""

    def known(each: Finding) -> bool:
        place = frozenset({each.kind}), each.contour, np.array(each.point) / scale, NEAR * em
        return any(matches(old, *place) for old in before)

    return [each for each in found if not known(each)]


def mending_table(became: Mapping[str, Sequence[Mended]]) -> str:
    """How many faults are mended."""
    rows: list[list[object]] = []
    for name, each in became.items():
        if each:
            whys = Counter(one.why for one in each if one.why).most_common(1)
            share = sum(one.near for one in each) / len(each)
            gone, near, *rest = (sum(getattr(one, what) for one in each) for what in ("gone", "near", "new", "points"))
            rows.append([name, len(each), gone, f"{near} ({share:.0%})", *rest, *(whys[0] if whys else ("", ""))])
    return table(["planted", "", "mended", "within 2", "new findings", "points added", "left, mostly as it", ""], rows)


def main() -> int:
    """Plant, write, read, check and count."""
    given = parser(__doc__, each=20, glyphs=200, faults="", seed=17, list=False, mend=0.0).parse_args()
    rng = np.random.default_rng(given.seed)
    names = [name for name in FAULTS if given.faults in name]
    count, found, false, again = (Counter[str]() for _ in range(4))
    untouched = spoiled = spoiled_again = 0
    became: dict[str, list[Mended]] = {name: [] for name in names}
    for file in FACES:
        if not (paths := [*faces(file), *Path(get_data_path(), "fonts", "ttf").glob(file)]):
            raise SystemExit(f"{file} is not there: see the head of this file")
        font = gs.open_font(paths[0])
        outlines = [outline for outline in font.outlines(font.glyph_names) if outline.contours]
        outlines = [outlines[k] for k in rng.permutation(len(outlines))]
        em = outlines[0].metrics.units_per_em
        truetype = font.outer < 0
        for cubic in (False, True) if truetype else (True,):
            own = [name for name in names if not truetype or cubic == (name in CUBIC)]
            bases = [cubics_of(outline) for outline in outlines] if cubic and truetype else outlines
            outer = 1 if cubic and not truetype else font.outer
            glyphs, faults, clean = faults_in(bases, outer, own, given.each, rng)
            if given.mend:
                read_again, outer = stored(glyphs, em, cubic)
                for fault, outline, before_it in zip(faults, read_again, clean, strict=True):
                    if one := mended(outline, before_it, fault, outer, given.mend):
                        became[fault.name].append(one)
                        if given.list and not one.near:
                            print(file, fault.name, outline.name, one)
                continue
            for fault, new in zip(faults, checked(glyphs, em, cubic), strict=True):
                hit = any(matches(each, *fault[1:]) for each in new)
                count[fault.name] += 1
                found[fault.name] += hit
                if given.list and not hit:
                    print("not found:", file, fault, sorted({each.kind for each in new}))
        if given.mend:
            continue
        outlines = outlines[: given.glyphs]
        before, other = check_many(outlines, outer=font.outer), 2048 if em < 1500 else 1000
        glyphs = [[moved_start(list(c.segments()), rng) for c in outline.contours] for outline in outlines]
        scaled = [[[part * (other / em) for part in contour] for contour in glyph] for glyph in glyphs]
        for new, far, old in zip(
            checked(glyphs, em, not truetype), checked(scaled, other, not truetype), before, strict=True
        ):
            untouched += 1
            extra, extra_far = new_findings(new, old, 1.0, em), new_findings(far, old, other / em, em)
            false.update(each.kind for each in extra)
            again.update(each.kind for each in extra_far)
            spoiled, spoiled_again = spoiled + bool(extra), spoiled_again + bool(extra_far)
            for each in extra if given.list else ():
                print("false:", file, each)
    if given.mend:
        print(mending_table(became))
        return 0
    counts = [*((name, count[name], found[name]) for name in names), ("all", count.total(), found.total())]
    rows = [[name, tried, f"{hits} ({hits / max(tried, 1):.1%})"] for name, tried, hits in counts]
    print(table(["planted", "", "found"], rows), end="\n\n")
    falsely = [[kind.name, false[kind.name], again[kind.name]] for kind in KINDS]
    print(table(["kind", "false", "false in another em"], falsely))
    print(f"\nOf {untouched} untouched glyphs {spoiled} have false findings, {spoiled_again} in another em.")
    missed = any(found[name] < 0.95 * count[name] for name in names if name not in SMALL)
    return int(missed or spoiled > untouched / 50)


if __name__ == "__main__":
    sys.exit(main())
