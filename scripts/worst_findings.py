"""The worst findings of each kind over many fonts as pictures, a sheet a kind, to be judged by eye.

    python scripts/worst_findings.py FOLDER FONT... [--glyphs 600] [--kinds kink,jump]

Of each face, glyphs spread evenly over those that have characters are checked, variable fonts at their default
location and without overlaps and crossings. Values are compared per em; each family has at most four findings on a
sheet, each of another glyph. A tile shows the outline around the place with its points and handles, the place in red,
and the glyph as a whole in the corner; where the kind is about curvature, its comb too.
"""

from __future__ import annotations

from argparse import ArgumentParser
from collections import Counter
from pathlib import Path
from typing import NamedTuple

import matplotlib
import numpy as np

import glyphspline as gs
from glyphspline.checks.check import check_many
from glyphspline.checks.finding import Finding, badness, with_unit
from glyphspline.checks.kinds import KINDS
from glyphspline.curves.curvature import comb
from glyphspline.outlines.outline import Outline
from glyphspline.types import FloatArray
from glyphspline.writers.figures.basics import outline_patch

matplotlib.use("agg")
from matplotlib import pyplot as plt
from matplotlib.axes import Axes

ROWS, COLUMNS = 4, 5
NEAREST, FARTHEST = 12.0, 130.0
"""Half the width of a tile, in thousandths of an em, at least and at most."""

SPACING = 0.02
"""Distance of the teeth of a comb, in half the width of a tile."""

WITH_COMB = {"jump", "lump", "inflection"}
ON_PURPOSE = frozenset({"overlap", "crossing"})
"""What variable fonts have on purpose, so that it is left out."""

POWERS = {"units": 1, "units²": 2, "/em": 1}
"""Powers of the em that findings are compared in, by their unit: jumps by how far they are seen."""


class Place(NamedTuple):
    """A finding, the outline that has it, and the font's family."""

    finding: Finding
    outline: Outline
    family: str


def found_in(font: Path, most: int) -> list[Place]:
    """What is found in the first face of a font file, in so many of its glyphs at most."""
    source = gs.open_font(font)
    names = list(dict.fromkeys(source.cmap[code] for code in sorted(source.cmap)))
    names = [names[k] for k in np.unique(np.linspace(0, len(names) - 1, most).astype(int))]
    outlines = [each for each in source.outlines(names, errors="return") if isinstance(each, Outline)]
    meant = ON_PURPOSE if source.axes else frozenset()
    found = [
        [finding for finding in each if finding.kind not in meant] for each in check_many(outlines, outer=source.outer)
    ]
    counts = Counter(finding.kind for each in found for finding in each)
    print(f"{source.family} {source.style}: {len(outlines)} glyphs", *[f"{k} {n}" for k, n in counts.items()], sep=", ")
    every = zip(outlines, found, strict=True)
    return [Place(finding, outline, source.family) for outline, each in every for finding in each]


def worst_of(places: list[Place], kind: str) -> list[Place]:
    """The worst findings of a kind, a few of each family and one of each glyph."""

    def per_em(place: Place) -> float:
        em = place.outline.metrics.units_per_em
        return badness(place.finding) / em ** POWERS.get(place.finding.unit, 0)

    chosen: list[Place] = []
    families: Counter[str] = Counter()
    glyphs = set()
    for place in sorted([each for each in places if each.finding.kind == kind], key=per_em, reverse=True):
        glyph = place.family, place.outline.name

        if len(chosen) < ROWS * COLUMNS and families[place.family] < 4 and glyph not in glyphs:
            chosen.append(place)
            families[place.family] += 1
            glyphs.add(glyph)
    return chosen


def window_of(place: Place) -> tuple[FloatArray, float]:
    """Middle and half the width of what a tile shows: both segments at the place, or all of a contour."""
    finding, outline = place.finding, place.outline
    cubics = outline.contours[finding.contour].cubics()
    unit = outline.metrics.units_per_em / 1000
    if finding.kind == "direction":
        points = cubics.reshape(-1, 2)
        low, high = points.min(axis=0), points.max(axis=0)
        return (low + high) / 2, 1.2 * (high - low).max() / 2
    if finding.kind in {"slanted", "straight", "handles", "inflection", "extremum", "retracted"}:
        points = cubics[finding.segment]
        low, high = points.min(axis=0), points.max(axis=0)
        return (low + high) / 2, max(0.65 * (high - low).max(), NEAREST * unit)
    sizes = np.ptp(cubics[[finding.segment - 1, finding.segment]], axis=1).max(axis=1)
    size = 3 * sizes[1] if finding.kind == "short" else 0.8 * sizes.max()
    return np.array(finding.point), float(np.clip(size, NEAREST * unit, FARTHEST * unit))


def draw_comb(axes: Axes, outline: Outline, middle: FloatArray, half: float) -> None:
    """Draw curvature as teeth, the longest that is seen but for one in ten a third of the tile."""
    combs = []
    for contour in outline.contours:
        teeth = comb(contour.cubics()[contour.degrees > 1], SPACING * half)
        combs.append((teeth.points, -teeth.curvature[:, None] * teeth.normals))
    points, vectors = (np.concatenate(each) for each in zip(*combs, strict=True))
    seen = np.abs(points - middle).max(axis=1) < half
    sizes = np.hypot(*vectors[seen].T)
    scale = half / 2.5 / np.quantile(sizes, 0.9) if len(sizes) and sizes.max() > 0 else 0.0
    for own, vector in combs:
        tips = own + scale * vector
        axes.plot(*tips.T, color="#7a5bd0", linewidth=0.5)
        axes.plot(*np.stack([own, tips, np.full_like(own, np.nan)], axis=1).reshape(-1, 2).T, "#b5a3e6", linewidth=0.3)


def draw(axes: Axes, place: Place) -> None:
    """Draw a tile."""
    finding, outline = place.finding, place.outline
    middle, half = window_of(place)
    curves = [contour.cubics() for contour in outline.contours]
    (patch,) = outline_patch(curves, facecolor="#e4e4ea", edgecolor="#222", linewidth=0.7)
    axes.add_patch(patch)
    if finding.kind in WITH_COMB:
        draw_comb(axes, outline, middle, half)
    for contour in outline.contours:
        for points in contour.segments():
            for handle in ((0, 1), (len(points) - 1, len(points) - 2)) if len(points) > 2 else ():
                axes.plot(*points[list(handle)].T, color="#3b82c4", linewidth=0.5)
            axes.plot(*points[1:-1].T, ".", color="#3b82c4", markersize=2.5)
            axes.plot(*points[:1].T, "s", color="#222", markersize=2.2)
    concerned = np.linspace(0, 1, 40) + finding.segment
    contour = outline.contours[finding.contour]
    if finding.kind == "direction":
        concerned = np.linspace(0, len(contour), 40 * len(contour))
    if finding.kind not in {"kink", "turn", "jump", "overlap", "crossing", "repeated", "leftover", "spike", "unlevel"}:
        axes.plot(*contour.at(concerned).T, color="#d33", linewidth=1.1)
    axes.plot(*finding.point, "o", color="#d33", markersize=9, fillstyle="none", markeredgewidth=0.9)
    axes.set(xlim=middle[0] + half * np.array([-1, 1]), ylim=middle[1] + half * np.array([-1, 1]), xticks=[], yticks=[])
    axes.set_aspect("equal")
    heading = f"{place.family} {outline.name}\n{with_unit(finding.value, finding.unit)}"
    axes.set_title(f"{heading}, {2 * half:.0f} units wide", fontsize=6.5, pad=2)
    whole = axes.inset_axes((0.0, 0.0, 0.27, 0.27))
    (patch,) = outline_patch(curves, facecolor="#444", edgecolor="none")
    whole.add_patch(patch)
    points = patch.get_path().vertices
    low, high = points.min(axis=0), points.max(axis=0)
    middle, half = (low + high) / 2, (high - low).max() / 2 * np.array([-1, 1])
    whole.set(xlim=middle[0] + half, ylim=middle[1] + half, xticks=[], yticks=[])
    whole.set_aspect("equal")
    whole.plot(*finding.point, "o", color="#d33", markersize=5, fillstyle="none")


def sheet(places: list[Place], path: Path) -> None:
    """Draw places on a sheet, the worst first, row by row."""
    rows = -(-len(places) // COLUMNS)
    figure, tiles = plt.subplots(rows, COLUMNS, figsize=(2.9 * COLUMNS, 3.1 * rows), squeeze=False)
    for axes in tiles.flat[len(places) :]:
        axes.set_axis_off()
    for number, (axes, place) in enumerate(zip(tiles.flat, places, strict=False)):
        draw(axes, place)
        axes.text(0.02, 0.98, str(number + 1), transform=axes.transAxes, va="top", fontsize=8, color="#d33")
    figure.tight_layout(pad=0.5)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def main() -> None:
    """Check the fonts and draw a sheet for each kind."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("fonts", type=Path, nargs="+")
    parser.add_argument("--glyphs", type=int, default=600, help="of each font, at most")
    parser.add_argument("--kinds", default=",".join(kind.name for kind in KINDS))
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    places = [place for font in given.fonts for place in found_in(font, given.glyphs)]
    for kind in given.kinds.split(","):
        if chosen := worst_of(places, kind):
            sheet(chosen, given.folder / f"{kind}.png")
            for number, (finding, outline, family) in enumerate(chosen):
                where = f"contour {finding.contour}, segment {finding.segment}"
                print(kind, number + 1, family, outline.name, where, with_unit(finding.value, finding.unit), sep="; ")


if __name__ == "__main__":
    main()
