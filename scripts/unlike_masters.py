"""How often outlines of one glyph, whose points do not correspond, are matched as their designer meant them.

``python -m scripts.unlike_masters FOLDER [--seeds 1] [--masters 2] [--text 'AB…'] [--jobs 2]``

FOLDER has variable fonts with a weight axis. Static instances at the ends of that axis (with ``--masters 3`` and a
default inside it also there) correspond point by point, so every point's true partner is known. Then each instance is
changed by itself, at random: joints that are no corners move along the curve where that changes it by less than half a
unit; joints are inserted, and removed where that is exact; contours are put in another order, start elsewhere, all run
the other way round; quadratics become cubics in one instance; and every point moves by up to half a unit in x and in y.

A glyph is *rightly matched* if

- its instances a quarter, half and three quarters of the way between the masters lie within 1 % of the em of the true
  instances, from each to the other; 0.5 % and 0.2 % are counted too, and noise alone makes up to 0.07 % of 1000 units;
- every joint that is a corner in both masters is a joint of the result, within 0.2 % of the em in both.

That is what a reader sees. Where partners *slide along* the outline, as two points in one straight stem do, no instance
changes. How far partners are from the true ones, sliding included, is counted beside it (0.5 %, 1 % and 2 % of the em):
this cannot be small, because the changes take away what it could be known from. A designer's joint in the middle of a
stem is, without the other joints in their places, one of several joints on a straight line.

66 Latin characters of each font that has them, and up to 50 ideographs of each font that has any. Failures are listed.
"""

from __future__ import annotations

import sys
import zlib
from collections.abc import Iterator, Sequence
from functools import cache
from itertools import combinations
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from fontTools.ttLib import TTFont
from scipy.spatial import cKDTree

import glyphspline as gs
from glyphspline.curves.bezier import as_cubic, evaluate, split
from glyphspline.outlines.joins import joins
from glyphspline.outlines.masters import DesignAxis, Masters
from glyphspline.outlines.sampling import CORNER_ANGLE
from glyphspline.plugins.masters.matching.match import match_masters
from glyphspline.types import FloatArray

from .survey import SegmentPen, distances, parser, surveyed, table

LATIN = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789&@?!"
IDEOGRAPHS = 50
SHAPES = (0.002, 0.005, 0.01)
"""Of the em: how far instances may be from the true ones."""

SHARES = (0.005, 0.01, 0.02)
"""Of the em: how far partners may be from the true ones."""

AT_CORNER = 0.002
"""Of the em: from a corner to its joint in the result, at most; noise moves it by up to 0.7 units."""

NOISE = 0.5
MIXTURES = (0.25, 0.5, 0.75)
SPACING = 2.0
"""Units between points compared, at most."""


class Task(NamedTuple):
    """A glyph of a font, and the seed of its changes."""

    path: Path
    name: str
    seed: int
    masters: int


class Found(NamedTuple):
    """How a glyph was matched, lengths in parts of the em, or why it was not.

    Attributes:
        shape: largest distance of instances from true ones. corner: of corners from joints. slip: of partners from
            true ones, sliding included.
        refused: the message of the error, or nothing.
    """

    task: Task
    shape: float
    corner: float
    slip: float
    refused: str

    def right(self, share: float = SHAPES[-1]) -> bool:
        """Whether it is rightly matched, to so large a share of the em."""
        return not self.refused and self.shape <= share and self.corner <= AT_CORNER

    def true(self, share: float) -> bool:
        """Whether all partners are the true ones, to so large a share of the em."""
        return not self.refused and self.slip <= share and self.corner <= AT_CORNER


@cache
def opened(path: Path, masters: int) -> tuple[DesignAxis, list[float], list[Any], float, dict[int, str]]:
    """The weight axis of a font, the masters' values, their glyph sets, the units per em and the character map."""
    font = TTFont(path)
    axis = next(axis for axis in font["fvar"].axes if axis.axisTag == "wght")
    values = sorted({axis.minValue, axis.maxValue} | ({axis.defaultValue} if masters > 2 else set()))
    design = DesignAxis("wght", "Weight", values[0], values[0], values[-1])
    glyphs = [font.getGlyphSet(location={"wght": value}) for value in values]
    return design, values, glyphs, font["head"].unitsPerEm, font.getBestCmap()


def instances(task: Task) -> list[list[gs.Contour]]:
    """The glyph in all masters, the same segments in each."""
    every = []
    for glyphs in opened(task.path, task.masters)[2]:
        pen = SegmentPen(glyphs)
        glyphs[task.name].draw(pen)
        every.append(pen.contours)
    outlines: list[list[gs.Contour]] = [[] for _ in every]
    for contour in zip(*every, strict=True):
        kept = [j for j, parts in enumerate(zip(*contour, strict=True)) if any(np.ptp(p, axis=0).any() for p in parts)]
        if kept:
            for own, segments in zip(outlines, contour, strict=True):
                own.append(gs.Contour.from_segments([segments[j] for j in kept]))
    return outlines


def changed(
    contours: Sequence[gs.Contour], rng: np.random.Generator, cubic: bool
) -> tuple[list[gs.Contour], list[int]]:
    """Contours that draw the same to half a unit, by other points, and of which given contour each is."""
    order = rng.permutation(len(contours)).tolist()
    around = bool(rng.integers(2))
    found = []
    for k in order:
        segments = [np.array(s) for s in contours[k].segments() if np.ptp(s, axis=0).any()]
        if cubic:
            segments = [as_cubic(s) if len(s) == 3 else s for s in segments]
        segments = inserted(moved(merged(segments, rng), rng), rng)
        turn = int(rng.integers(len(segments)))
        contour = gs.Contour.from_segments(segments[turn:] + segments[:turn])
        contour = gs.Contour(contour.points + rng.uniform(-NOISE, NOISE, contour.points.shape), contour.degrees)
        found.append(contour.reversed() if around else contour)
    return found, order


def merged(segments: list[FloatArray], rng: np.random.Generator) -> list[FloatArray]:
    """Half of the joints between lines on one line are removed."""
    found = [segments[0]]
    for segment in segments[1:]:
        before = found[-1]
        if len(before) == len(segment) == 2 and rng.random() < 0.5:
            one, two = before[1] - before[0], segment[1] - segment[0]
            if abs(one[0] * two[1] - one[1] * two[0]) < 1e-6 * np.hypot(*one) * np.hypot(*two) and one @ two > 0:
                found[-1] = np.array([before[0], segment[1]])
                continue
        found.append(segment)
    return found


def moved(segments: list[FloatArray], rng: np.random.Generator) -> list[FloatArray]:
    """Some joints of two cubics that are no corners move along the curve, into the one after it."""
    for j in range(len(segments)):
        k = (j + 1) % len(segments)
        one, two = segments[j], segments[k]
        if len(one) == len(two) == 4 and k != j and rng.random() < 0.4:
            share = rng.uniform(0.1, 0.35)
            if turned(one, two) >= CORNER_ANGLE:
                continue
            head, tail = (part for part in split(two, share))
            curve = fitted(np.concatenate([evaluate(np.tile(part, (21, 1, 1)), np.linspace(0, 1, 21))[first:]
                                           for first, part in ((0, one), (1, head))]), one, head)  # fmt: skip
            if curve is not None:
                segments[j], segments[k] = curve, tail
    return segments


def turned(one: FloatArray, two: FloatArray) -> float:
    """Degrees by which a cubic turns into the next."""
    (a, b), (c, d) = one[3] - one[2], two[1] - two[0]
    return float(np.degrees(abs(np.arctan2(a * d - b * c, a * c + b * d))))


def fitted(points: FloatArray, first: FloatArray, last: FloatArray) -> FloatArray | None:
    """A cubic through points (n, 2) that begins as one cubic and ends as another; None if it strays by half a unit."""
    a, b = first[1] - first[0], last[2] - last[3]
    if not a.any() or not b.any():
        return None
    a, b = a / np.hypot(*a), b / np.hypot(*b)
    t = np.append(0, np.hypot(*np.diff(points, axis=0).T).cumsum())
    t /= t[-1]
    curve = first
    for _ in range(12):
        B = np.array([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t**3]).T
        rest = points - np.outer(B[:, 0] + B[:, 1], points[0]) - np.outer(B[:, 2] + B[:, 3], points[-1])
        design = np.stack([np.outer(B[:, 1], a).ravel(), np.outer(B[:, 2], b).ravel()], axis=1)
        x, y = np.linalg.lstsq(design, rest.ravel(), rcond=None)[0]
        if x <= 0 or y <= 0:
            return None
        curve = np.array([points[0], points[0] + x * a, points[-1] + y * b, points[-1]])
        dense = np.linspace(0, 1, 400)
        away = np.hypot(*np.moveaxis(evaluate(np.tile(curve, (400, 1, 1)), dense)[:, None] - points, 2, 0))
        t = dense[away.argmin(axis=0)]
    return curve if away.min(axis=0).max() < 0.5 else None


def inserted(segments: list[FloatArray], rng: np.random.Generator) -> list[FloatArray]:
    """Joints inside some segments."""
    found: list[FloatArray] = []
    for segment in segments:
        found += split(segment, rng.uniform(0.2, 0.8)) if rng.random() < 0.3 else [segment]
    return found


def measured(task: Task) -> Found:
    """Change a glyph's masters, match them, and compare with the truth."""
    axis, values, _, em, _ = opened(task.path, task.masters)
    originals = instances(task)
    rng = np.random.default_rng([zlib.crc32(f"{task.path.name} {task.name}".encode()), task.seed])
    unlike = [changed(contours, rng, k == 0) for k, contours in enumerate(originals)]
    metrics = gs.FontMetrics(em, 0.8 * em, -0.2 * em)
    outlines = [gs.Outline(task.name, 0, (), 0.0, contours, metrics) for contours, _ in unlike]
    try:
        masters = match_masters(outlines, values, axis)
        shape, corner, slip = compared(originals, unlike[0][1], masters)
        return Found(task, shape / em, corner / em, slip / em, "")
    except gs.GlyphsplineError as failure:
        return Found(task, np.nan, np.nan, np.nan, failure.message)


def compared(originals: list[list[gs.Contour]], order: Sequence[int], masters: Masters) -> tuple[float, float, float]:
    """Largest distances of instances, corners and partners from the true ones, in units."""
    shape = corner = slip = 0.0
    for contour, which in zip(masters.contours, order, strict=True):
        true = [own[which] for own in originals]
        here, there = dense([gs.Contour(points, contour.degrees) for points in contour.points]), dense(true)
        trees = [cKDTree(points) for points in here]
        for k, tree in enumerate(trees):
            nearest = tree.query(there[k])[0]
            for i, ball in enumerate(tree.query_ball_point(there[k], nearest + 0.25)):
                for other in range(len(trees)):
                    if other != k:
                        slip = max(slip, np.hypot(*(here[other][ball] - there[other][i]).T).min())
        for one, two in combinations(range(len(true)), 2):
            for weight in MIXTURES:
                mine, its = ((1 - weight) * points[one] + weight * points[two] for points in (here, there))
                shape = max(shape, distances(mine, its).max(), distances(its, mine).max())
        turns = [np.degrees(np.abs(joins(own).turns)) >= 12 for own in true]
        both = np.all(turns, axis=0)
        marks = np.stack([points[np.cumsum(contour.degrees) - contour.degrees] for points in contour.points])
        corners = np.stack([own.points[own.offsets] for own in true])[:, both]
        for j in range(corners.shape[1]):
            corner = max(corner, np.hypot(*np.moveaxis(marks - corners[:, j, None], 2, 0)).max(axis=0).min())
    return float(shape), float(corner), float(slip)


def dense(contours: Sequence[gs.Contour]) -> FloatArray:
    """(K, n, 2) points at the same places of contours of the same segments, at most SPACING apart in each."""
    cubics = np.stack([contour.cubics() for contour in contours])
    spans = np.hypot(*np.moveaxis(np.diff(cubics, axis=2), 3, 0)).sum(axis=2).max(axis=0)
    steps = np.ceil(spans / SPACING).astype(int) + 1
    places = [np.full(n, j) + np.arange(n) / n for j, n in enumerate(steps.tolist())]
    at = np.concatenate(places)
    segments = at.astype(int)
    return np.stack([evaluate(own[segments], at - segments) for own in cubics])


def tasks(folder: Path, seeds: int, masters: int, text: str | None) -> Iterator[Task]:
    """Glyphs of all fonts of a folder; one file of each family."""
    for path in sorted(folder.iterdir()):
        if path.suffix not in (".otf", ".ttf", ".woff2"):
            continue
        cmap = opened(path, masters)[4]
        codes = [code for code in sorted(cmap) if 0x4E00 <= code <= 0x9FFF]
        wanted = [ord(c) for c in text or LATIN] if not codes or text else codes[:: max(len(codes) // IDEOGRAPHS, 1)]
        for code in wanted[: None if text or not codes else IDEOGRAPHS]:
            if code in cmap and cmap[code] in opened(path, masters)[2][0]:
                yield from (Task(path, cmap[code], seed, masters) for seed in range(seeds))


def main() -> int:
    """Match all, list the failures and print a table."""
    options = parser(__doc__, jobs=2, seeds=1, first_seed=0, every=1, masters=2, text="")
    options.add_argument("folder", type=Path, metavar="FOLDER")
    arguments = options.parse_args()
    todo = list(tasks(arguments.folder, arguments.seeds, arguments.masters, arguments.text))[:: arguments.every]
    todo = [task._replace(seed=task.seed + arguments.first_seed) for task in todo]
    found = list(surveyed(measured, todo, jobs=arguments.jobs, chunk=16))
    for one in found:
        if not one.right():
            off = f"instances {one.shape:.2%}, corners {one.corner:.2%}, partners {one.slip:.2%} of the em"
            print(f"{one.task.path.name} {one.task.name} seed {one.task.seed}: {one.refused or off}")
    heads = [*(f"right at {100 * share:g} %" for share in SHAPES), *(f"partners {100 * share:g} %" for share in SHARES)]
    rows = []
    paths = list(dict.fromkeys(one.task.path for one in found))
    for label, those in [*((p.name, [o for o in found if o.task.path == p]) for p in paths), ("all", found)]:
        shares = [[o.right(share) for o in those] for share in SHAPES]
        shares += [[o.true(share) for o in those] for share in SHARES]
        cells = [f"{100 * np.mean(share):.1f} %" for share in shares]
        rows.append([label, len(those), *cells, sum(bool(o.refused) for o in those)])
    print(table(["font", "glyphs", *heads, "refused"], rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
