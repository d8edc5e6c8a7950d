"""Faults planted in real outlines, and how many of them are found: ``python scripts/planted_faults.py``.

A thousand glyphs of five faces, of the Debian packages fonts-dejavu, fonts-cantarell, fonts-noto-cjk and
fonts-lxgw-wenkai, and of fonts_test/. One fault is planted in every second glyph, well above its threshold even after
its points are rounded to whole units. All glyphs are written to fonts, glyf or CFF as their face has it, with another
start point of each contour, and read again. A fault is found if there is a finding of its kind, on its contour, near
its place, and the untouched glyph has none there. Of the other half, a finding is false if the face as it is has none
of its kind there. The exit status is 1 if fewer than 99 % are found, or more than one glyph in 50 has a false finding.

The last line is the same of the other half in another em, 2048 units for 1000 and the other way, where every point is
rounded anew: findings near their thresholds come and go then.
"""

from __future__ import annotations

import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Sequence
from importlib.util import find_spec
from itertools import islice, pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from fontTools.fontBuilder import FontBuilder
from fontTools.pens.t2CharStringPen import T2CharStringPen
from fontTools.pens.ttGlyphPen import TTGlyphPen

import glyphspline as gs
from glyphspline.checks.check import check_many
from glyphspline.checks.finding import Finding
from glyphspline.curves.bezier import derivative_points, evaluate, signed_curvature, split
from glyphspline.types import FloatArray

sys.path.insert(0, str(Path(__file__).parents[1]))
from scripts.survey import faces, parser, table

FACES = (
    "kouzan-gyosho.otf", "DejaVuSans.ttf", "Cantarell-Regular.otf", "NotoSansCJK-Regular.ttc", "LXGWWenKai-Regular.ttf"
)  # fmt: skip
NEAR = 0.03
"""Of the em: distance from its place within which a fault is found."""

ROUNDING = 3 / np.sqrt(12)
"""Three standard deviations of the rounding of a coordinate to whole units."""

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
    return float(np.degrees(np.arctan2(a[0] * b[1] - a[1] * b[0], a @ b)))


def rotated(vector: FloatArray, degrees: float) -> FloatArray:
    """A vector turned to the left."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]])


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
    """Signed curvature at parameters."""
    points = np.broadcast_to(segment, (len(t), *segment.shape))
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


def kink(s: Segments, j: int, unit: float) -> Planted | None:
    """A handle turned at a smooth joint, to at least one and a half times the limit."""
    if len(s[j]) < 3 or abs(joint(s, j)) > 0.2:
        return None
    a, b = tangents(s[j - 1])[1], tangents(s[j])[0]
    if min(size(a), size(b)) < 25 * unit:
        return None
    new = with_handle(s, j, rotated(b, 2 * max(may_turn(a, b), 1.5)))
    turn = abs(joint(new, j))
    limit = may_turn(tangents(new[j - 1])[1], tangents(new[j])[0])
    return Planted(new, new[j][0], 0.0) if 1.5 * limit <= turn <= 11 else None


def jump(s: Segments, j: int, unit: float) -> Planted | None:
    """A handle made shorter at a smooth joint of cubics, until curvature jumps by twice the limit."""
    if len(s[j]) != 4 or len(s[j - 1]) != 4 or abs(joint(s, j)) > 0.2:
        return None
    new = with_handle(s, j, 0.6 * tangents(s[j])[0])
    a, b = tangents(new[j - 1])[1], tangents(new[j])[0]
    if min(size(a), size(b)) < 5 * unit or abs(joint(new, j)) > 0.9 * may_turn(a, b):
        return None
    before, after = curvature(new[j - 1], np.ones(1))[0], curvature(new[j], np.zeros(1))[0]
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
    cross = u[0] * v[1] - u[1] * v[0]
    if abs(angle(u, v)) < 20 or abs(angle(u, v)) > 150:
        return None
    reach = ((q - p)[0] * v[1] - (q - p)[1] * v[0]) / cross
    meet = p + reach * u
    if reach <= 0 or (q - meet) @ v <= 0:
        return None
    middle = (
        np.array([p, meet, q]) if len(before) == 3 else np.array([p, p + 0.6 * (meet - p), q + 0.6 * (meet - q), q])
    )
    middle = np.round(middle)
    path = evaluate(np.broadcast_to(middle, (65, *middle.shape)), np.linspace(0, 1, 65))[:, k]
    beyond = max(path.max() - max(path[0], path[-1]), min(path[0], path[-1]) - path.min())
    if beyond < 2 * unit:
        return None
    new = s.copy()
    new[j - 1], new[j] = first[0], last[1]
    at = j if j else len(new)
    return Planted(
        rounded([*new[:at], middle, *new[at:]]), evaluate(middle[None], np.array([0.5]))[0], chord(middle) / 2
    )


def short(s: Segments, j: int, unit: float) -> Planted | None:
    """A segment cut off near its end: 2.4/1000 em or less."""
    if chord(s[j]) < 30 * unit:
        return None
    parts = rounded(cut(s[j], 1 - 2 * unit / chord(s[j])))
    if (
        not 0 < chord(parts[1]) <= 2.4 * unit
        or chord(parts[0]) < 20 * unit
        or size(np.ptp(parts[1], axis=0)) > 2.4 * unit
    ):
        return None
    return Planted([*s[:j], *parts, *s[j + 1 :]], parts[1][0], 0.0)


def handles(s: Segments, j: int, unit: float) -> Planted | None:
    """A handle a quarter longer than to the place where both meet, and four units or more."""
    if len(s[j]) != 4:
        return None
    u, v, x = s[j][1] - s[j][0], s[j][2] - s[j][3], s[j][3] - s[j][0]
    cross = u[0] * v[1] - u[1] * v[0]
    if min(size(u), size(v)) < 10 * unit or abs(cross) < 0.35 * size(u) * size(v):
        return None
    reach, other = (x[0] * v[1] - x[1] * v[0]) / cross, (x[0] * u[1] - x[1] * u[0]) / cross
    if reach <= 0 or other <= 0 or 0.25 * reach * size(u) < max(4, 4 * unit):
        return None
    new = with_handle(s, j, 1.25 * reach * u)
    return Planted(new, (s[j][0] + s[j][3]) / 2, chord(s[j]) / 2)


def doubled(s: Segments, j: int, unit: float) -> Planted | None:
    """A line with a spur of 30/1000 em, out and back."""
    return detour(s, j, unit, [(0.5, 0), (0.5, 30), (0.5, 0)])


def crossing(s: Segments, j: int, unit: float) -> Planted | None:
    """A line with a loop of 30/1000 em."""
    return detour(s, j, unit, [(0.6, 0), (0.6, 30), (0.4, 30), (0.4, -30), (0.8, -30)])


def detour(s: Segments, j: int, unit: float, points: Sequence[tuple[float, float]]) -> Planted | None:
    """A line by way of points: parts of its length, and thousandths of an em to its left."""
    a, b = s[j][0], s[j][-1]
    if len(s[j]) != 2 or chord(s[j]) < 100 * unit:
        return None
    left = rotated((b - a) / chord(s[j]), 90) * unit
    way = np.round(np.array([a, *[a + x * (b - a) + y * left for x, y in points], b]))
    lines = [np.array(pair) for pair in pairwise(way)]
    return Planted([*s[:j], *lines, *s[j + 1 :]], (a + b) / 2, 30 * unit + chord(s[j]) / 10)


def direction(s: Segments, j: int, unit: float) -> Planted | None:
    """A contour that runs backwards."""
    return None if j else Planted([segment[::-1] for segment in s[::-1]], s[0][0], np.inf)


def overlap(s: Segments, j: int, unit: float) -> Planted | None:
    """A contour and a copy of it, moved by a hundredth of an em: of equal area, neither lies inside the other."""
    return None if j else Planted(s, np.round([6 * unit, 8 * unit]), np.inf)


PLANTERS: dict[str, Planter] = {
    each.__name__: each
    for each in (kink, jump, lump, inflection, straight, slanted, extremum, short, handles, overlap, direction, doubled,
                 crossing)
}  # fmt: skip
ENCLOSED = ("overlap", "direction", "doubled", "crossing")


class Fault(NamedTuple):
    """What was planted where."""

    kind: str
    contour: int
    point: FloatArray
    radius: float


def matches(found: Finding, kind: str, contour: int, point: FloatArray, radius: float) -> bool:
    """Whether a finding is of this kind and near this place."""
    return found.kind == kind and found.contour == contour and size(np.array(found.point) - point) <= radius


def planted(
    outline: gs.Outline, findings: Sequence[Finding], kinds: Sequence[str], rng: np.random.Generator
) -> tuple[list[Segments], Fault] | None:
    """The outline's contours with one fault, of the first of these kinds that can be planted; None if none can."""
    em = outline.metrics.units_per_em
    contours = [list(contour.segments()) for contour in outline.contours]
    for kind in kinds:
        places = [(c, j) for c, segments in enumerate(contours) for j in range(len(segments))]
        for index in rng.permutation(len(places))[:200]:
            c, j = places[index]
            made = PLANTERS[kind](contours[c], j, em / 1000)
            if made is None:
                continue
            radius = made.radius + NEAR * em
            if any(matches(each, kind, c, made.point, 1.5 * radius) for each in findings):
                continue
            new = [*contours[:c], made.segments, *contours[c + 1 :]]
            if kind == "overlap":
                new.append([segment + made.point for segment in made.segments])
            return new, Fault(kind, c, made.point, radius)
    return None


def moved_start(segments: Segments, rng: np.random.Generator) -> Segments:
    """The contour from another start, of those in whole units: a point between two control points is not stored."""
    k = int(rng.choice([j for j, segment in enumerate(segments) if (segment[0] % 1 == 0).all()] or [0]))
    return [*segments[k:], *segments[:k]]


def write(path: Path, glyphs: Sequence[list[Segments]], em: int, cubic: bool) -> None:
    """Write a font, in whole units."""
    names = [".notdef", *[f"g{k}" for k in range(len(glyphs))]]
    builder = FontBuilder(em, isTTF=not cubic)
    builder.setupGlyphOrder(names)
    builder.setupCharacterMap({0xE000 + k: name for k, name in enumerate(names[1:])})
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
    builder.setupHorizontalMetrics({name: (em, lefts.get(name, 0)) for name in names})
    builder.setupHorizontalHeader(ascent=em, descent=0)
    builder.setupNameTable({"familyName": "Planted", "styleName": "Regular"})
    builder.setupOS2()
    builder.setupPost()
    builder.save(path)


def read(path: Path, count: int) -> list[gs.Outline]:
    """The glyphs of such a font."""
    font = gs.open_font(path)
    return [font.outline(f"g{k}") for k in range(count)]


def new_findings(found: Sequence[Finding], before: Sequence[Finding], scale: float, em: float) -> list[Finding]:
    """Those that are not near one of the same kind in the face as it is."""
    return [
        each
        for each in found
        if not any(matches(old, each.kind, each.contour, np.array(each.point) / scale, NEAR * em) for old in before)
    ]


def main() -> int:
    """Plant, write, read, check and count."""
    options = parser(__doc__, jobs=False)
    options.add_argument("--glyphs", type=int, default=1000, help="of all faces together (1000)")
    options.add_argument("--seed", type=int, default=17)
    options.add_argument("--list", action="store_true", help="list what is not found, and what is false")
    given = options.parse_args()
    rng = np.random.default_rng(given.seed)
    kinds = [kind for kind in PLANTERS if kind not in ENCLOSED or find_spec("glyphspline.checks.enclosed")]
    count, found, false, again = (Counter[str]() for _ in range(4))
    untouched = spoiled = spoiled_again = total = 0
    for number, file in enumerate(FACES):
        if not (paths := faces(file)):
            raise SystemExit(f"{file} is not there: see the head of this file")
        font = gs.open_font(paths[0])
        every = (font.outline(font.glyph_names[k]) for k in rng.permutation(len(font.glyph_names)))
        wanted = (given.glyphs - total) // (len(FACES) - number)
        outlines = list(islice((outline for outline in every if outline.contours), wanted))
        total += len(outlines)
        before = check_many(outlines, outer=font.outer)
        em = outlines[0].metrics.units_per_em
        cubic = any((contour.degrees == 3).any() for outline in outlines for contour in outline.contours)
        faults: list[Fault | None] = []
        glyphs = []
        for outline, findings in zip(outlines, before, strict=True):
            made = None
            if 2 * sum(fault is not None for fault in faults) <= len(faults):
                made = planted(outline, findings, sorted(kinds, key=lambda kind: (count[kind], rng.random())), rng)
            faults.append(made[1] if made else None)
            contours = made[0] if made else [list(contour.segments()) for contour in outline.contours]
            glyphs.append([moved_start(segments, rng) for segments in contours])
            if made:
                count[made[1].kind] += 1
        other = 2048 if em < 1500 else 1000
        with tempfile.TemporaryDirectory() as folder:
            path, second = Path(folder) / "planted.font", Path(folder) / "other.font"
            write(path, glyphs, int(em), cubic)
            scaled = [[[part * (other / em) for part in contour] for contour in glyph] for glyph in glyphs]
            write(second, scaled, other, cubic)
            after, elsewhere = (check_many(read(file, len(glyphs)), outer=font.outer) for file in (path, second))
        for fault, old, new, far, outline in zip(faults, before, after, elsewhere, outlines, strict=True):
            if fault is not None:
                hit = any(matches(each, *fault) for each in new)
                found[fault.kind] += hit
                if given.list and not hit:
                    print("not found:", file, outline.name, fault)
                continue
            untouched += 1
            extra, extra_far = new_findings(new, old, 1.0, em), new_findings(far, old, other / em, em)
            false.update(each.kind for each in extra)
            again.update(each.kind for each in extra_far)
            spoiled, spoiled_again = spoiled + bool(extra), spoiled_again + bool(extra_far)
            if given.list:
                for each in extra:
                    print("false:", file, outline.name, each)
    share = found.total() / max(count.total(), 1)
    rows = [[kind, *(each[kind] for each in (count, found, false, again))] for kind in kinds]
    rows.append(["all", count.total(), f"{found.total()} ({share:.2%})", false.total(), again.total()])
    print(table(["kind", "planted", "found", "false", "false in another em"], rows))
    print(
        f"\n{total} glyphs; of {untouched} untouched ones {spoiled} have false findings, {spoiled_again} in another em."
    )
    return int(share < 0.99 or spoiled > untouched / 50)


if __name__ == "__main__":
    sys.exit(main())
