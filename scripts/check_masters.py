"""Variable fonts converted in all masters at once, beside their masters one by one and their own instances.

    python scripts/check_masters.py FONT... [--text TEXT] [--effort best] [--corners smooth] [--seed 1]

For each glyph: segments, certified or not, and 40 random locations, at which the result's instance is sampled densely
and compared with the source's, both ways. Fonts with CFF2 outlines are written too, and turns at inner joints are those
that HarfBuzz draws.
"""

from __future__ import annotations

import time
from argparse import ArgumentParser
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import uharfbuzz as hb
from scipy.spatial import cKDTree

import glyphspline as gs
from glyphspline.curves.cubics import turns
from glyphspline.fitting.convert_masters import MastersResult, convert_masters
from glyphspline.runs.jobs.masters import redrawn_glyph
from glyphspline.types import FloatArray
from glyphspline.writers.font.master_deltas import Redrawn
from glyphspline.writers.font.variable_font import to_variable_font

TEXT = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789&?!@"

LOCATIONS = 40
"""Random locations a glyph."""

STEP = 0.5
"""Distance of the samples along a curve, in thousandths of an em, at most."""


@dataclass
class Table:
    """What is counted over the glyphs of a font."""

    glyphs: int = 0
    contours: int = 0
    uncertified: list[str] = field(default_factory=list)
    stopping: list[str] = field(default_factory=list)
    kept: int = 0
    segments: int = 0
    worst_single: int = 0
    source: int = 0
    beyond: int = 0
    compared: int = 0
    largest: float = 0.0
    turn: float = 0.0
    jump: float = 0.0
    jumps: int = 0
    joints: int = 0
    together: float = 0.0
    apart: float = 0.0


def main() -> None:
    """Check the fonts named on the command line."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument("fonts", nargs="+", type=Path)
    parser.add_argument("--text", default=TEXT)
    parser.add_argument("--gids", help="instead of a text, as 5,10-20")
    parser.add_argument("--effort", default="fast", choices=("fast", "best"))
    parser.add_argument("--corners", default="sharp", choices=("smooth", "sharp"))
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    options = gs.Options(corners=given.corners, effort=given.effort)
    for path in given.fonts:
        font = gs.open_font(path)
        names = font.select(gids=given.gids) if given.gids else font.select(text=given.text)
        check(font, names, options, given.seed)


def check(font: gs.Font, names: tuple[str, ...], options: gs.Options, seed: int) -> None:
    """Convert glyphs of a font, and print the table."""
    table, rng, done = Table(), np.random.default_rng(seed), {}
    for name in names:
        masters = font.masters(name)
        if not masters.contours:
            continue
        if table.glyphs == 0:  # what is compiled or loaded at the first use is not timed
            convert_masters(masters, options)
            gs.convert(masters.master(0), options)
        began = time.process_time()
        try:
            result = convert_masters(masters, options)
        except gs.GlyphsplineError as error:
            print(f"{path_of(font)} {name}: {error}")
            continue
        table.together += time.process_time() - began
        began = time.process_time()
        singles = [gs.convert(masters.master(k), options) for k in range(len(masters))]
        table.apart += time.process_time() - began
        table.glyphs += 1
        table.contours += len(result.contours)
        table.segments += sum(len(contour.curve) for contour in result.contours)
        table.source += sum(len(contour.source) for contour in result.contours)
        table.worst_single += max(sum(len(contour.curve) for contour in single.contours) for single in singles)
        if not all(contour.within_tolerance for contour in result.contours):
            table.uncertified.append(name)
        table.kept += sum(contour.kept for contour in result.contours)
        if not all(contour.regular for contour in result.contours):
            table.stopping.append(name)
        compare(result, options.tolerance_for(font.metrics.units_per_em), rng, table)
        done[name] = redrawn_glyph(result)
    say(font, options, table)
    if "CFF2" in font.tables():
        drawn(font, done, rng)


def compare(result: MastersResult, tolerance: float, rng: np.random.Generator, table: Table) -> None:
    """Compare the result with its source at random locations."""
    masters = result.masters
    step = STEP * masters.metrics.units_per_em / 1000
    corners = masters.grid()
    low, high = corners.min(axis=0), corners.max(axis=0)
    for at in rng.uniform(low, high, (LOCATIONS, len(low))):
        weights = masters.weights_at(at)
        for contour in result.contours:
            curve = contour.curve.mixed(weights).cubics()
            source = contour.source.mixed(weights).cubics()
            a, b = sampled(curve, step), sampled(source, step)
            # A sample's nearest sample is at most half a step beside its nearest point.
            away = max(distance(a, b, source, step), distance(b, a, curve, step))
            table.compared += 1
            table.largest = max(table.largest, away / tolerance)
            table.beyond += away > tolerance * (1 + 1e-6)
            bends = np.abs(np.degrees(turns(curve, 1e-9)))[contour.inner]
            table.turn = max(table.turn, float(bends.max(initial=0.0)))


def sampled(cubics: FloatArray, step: float) -> FloatArray:
    """(n, 2) points along a chain of cubics, ``step`` apart or less."""
    parts = []
    for cubic in cubics:
        count = max(int(np.hypot(*np.diff(cubic, axis=0).T).sum() / step) + 1, 2)
        x = np.arange(count)[:, None] / count
        y = 1 - x
        parts.append(y**3 * cubic[0] + 3 * y * y * x * cubic[1] + 3 * y * x * x * cubic[2] + x**3 * cubic[3])
    return np.concatenate(parts)


def distance(points: FloatArray, samples: FloatArray, cubics: FloatArray, step: float) -> float:
    """The largest distance of points from a closed chain: to the chords of its samples."""
    after = np.roll(samples, -1, axis=0)
    _, near = cKDTree(samples).query(points, k=min(3, len(samples)))
    near = near.reshape(len(points), -1)
    found = np.full(len(points), np.inf)
    for k in range(near.shape[1]):
        for j in (near[:, k], near[:, k] - 1):
            a, d = samples[j], after[j] - samples[j]
            share = np.clip(((points - a) * d).sum(1) / np.maximum((d * d).sum(1), 1e-300), 0, 1)
            found = np.minimum(found, np.hypot(*(points - a - share[:, None] * d).T))
    return float(found.max())


def drawn(font: gs.Font, redrawn: dict[str, Redrawn], rng: np.random.Generator) -> None:
    """Write the font, and measure what HarfBuzz draws: turns and jumps of curvature at inner joints."""
    data, summary = to_variable_font(font, redrawn, "otf")
    face = hb.Face(data)
    shaped = hb.Font(face)
    axes = font.masters(next(iter(redrawn))).axes
    worst, jumps, joints = 0.0, 0, 0
    for name, glyph in summary.glyphs.items():
        gid = font.glyph_names.index(name)
        for _ in range(LOCATIONS):
            shaped.set_variations({a.tag: float(rng.uniform(a.minimum, a.maximum)) for a in axes})
            for inner, cubics in zip(glyph.inner, contours_of(shaped, gid), strict=True):
                if len(cubics) != len(inner):
                    continue
                bends = np.abs(np.degrees(turns(np.ascontiguousarray(cubics), 1e-6)))[inner]
                worst = max(worst, float(bends.max(initial=0.0)))
                before, after = np.roll(end_curvature(cubics[:, ::-1]), 1), -end_curvature(cubics)
                size = np.maximum(np.abs(before), np.abs(after))[inner]
                jumps += int((np.abs(before - after)[inner] > np.maximum(0.1 * size, 1e-4)).sum())
                joints += int(inner.sum())
    share = jumps / max(joints, 1)
    print(f"  as HarfBuzz draws it: turn {worst:.4f}° at most, jumps over 10 % {share:.2%} of {joints}")
    if summary.left:
        print(f"  left as they were: {summary.left}")


def end_curvature(cubics: FloatArray) -> FloatArray:
    """(m,) signed curvature at the first point of each cubic."""
    d, e = cubics[:, 1] - cubics[:, 0], cubics[:, 2] - cubics[:, 1]
    speed = np.maximum(np.hypot(*d.T), 1e-12)
    found: FloatArray = 2 / 3 * (d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0]) / speed**3
    return -found


def contours_of(font: hb.Font, gid: int) -> list[FloatArray]:
    """The contours that HarfBuzz draws, (m, 4, 2) each; lines raised to cubics."""
    found: list[list[list[tuple[float, float]]]] = []

    def move(x: float, y: float, _: object) -> None:
        found.append([])
        found_at[0] = (x, y)

    def line(x: float, y: float, _: object) -> None:
        a, b = np.array(found_at[0]), np.array((x, y))
        found[-1].append([tuple(a), tuple(a + (b - a) / 3), tuple(b + (a - b) / 3), (x, y)])
        found_at[0] = (x, y)

    def cubic(x1: float, y1: float, x2: float, y2: float, x: float, y: float, _: object) -> None:
        found[-1].append([found_at[0], (x1, y1), (x2, y2), (x, y)])
        found_at[0] = (x, y)

    found_at = [(0.0, 0.0)]
    pen = hb.DrawFuncs()
    pen.set_move_to_func(move)
    pen.set_line_to_func(line)
    pen.set_cubic_to_func(cubic)
    pen.set_close_path_func(lambda _: None)
    font.draw_glyph(gid, pen)
    return [np.array(contour) for contour in found]


def path_of(font: gs.Font) -> str:
    """The font's file name."""
    return font.path.name


def say(font: gs.Font, options: gs.Options, t: Table) -> None:
    """Print the table of a font."""
    print(f"{path_of(font)}, {options.corners}, {options.effort}: {t.glyphs} glyphs, {t.contours} contours")
    print(f"  not certified: {t.uncertified or 0}; not proven free of cusps: {t.stopping or 0}")
    ratios = (
        f"{t.segments / t.worst_single:.3f} of the worst single master's, {t.segments / t.source:.3f} of the source's"
    )
    print(f"  segments {t.segments}: {ratios}")
    print(f"  {t.compared} instances of contours compared, {t.beyond} beyond; largest {t.largest:.3f} of the tolerance")
    print(f"  turn at inner joints, exact: {t.turn:.1e}°")
    print(f"  CPU time, all at once against one by one: {t.together / t.apart:.2f} ({t.together:.1f} s)")


if __name__ == "__main__":
    main()
