"""Variable fonts converted in all masters at once, beside their masters one by one and their own instances.

    python -m scripts.check_masters FONT... [--text TEXT | --gids 5,10-20] [--effort best] [--corners smooth] [--seed 1]

For each glyph: segments, certified or not, and 40 random locations, at which the result's instance is sampled densely
and compared with the source's, both ways. Fonts with CFF2 outlines are written too, and turns at inner joints are those
that HarfBuzz draws.
"""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import uharfbuzz as hb

import glyphspline as gs
from glyphspline.curves.bezier import as_cubic, derivative_points, signed_curvature
from glyphspline.curves.cubics import turns
from glyphspline.curves.fairness import TURN, curvatures, extrema_of
from glyphspline.fitting.measures import CORNER, extrema_floor
from glyphspline.plugins.masters.convert_masters import MastersResult, convert_masters
from glyphspline.plugins.masters.job import redrawn_glyph
from glyphspline.plugins.masters.redrawn import Redrawn
from glyphspline.plugins.masters.variable_font import to_variable_font
from glyphspline.types import BoolArray, FloatArray

from .survey import SegmentPen, distances, parser, sampled

TEXT = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789&?!@"

LOCATIONS = 40
"""Random locations a glyph."""

STEP = 0.5
"""Distance of the samples along a curve, in thousandths of an em, at most."""


def main() -> None:
    """Check the fonts named on the command line."""
    options = parser(__doc__, text=TEXT, gids="", effort="fast", corners="sharp", seed=1)
    options.add_argument("fonts", nargs="+", type=Path)
    given = options.parse_args()
    for font in map(gs.open_font, given.fonts):
        names = font.select(gids=given.gids) if given.gids else font.select(text=given.text)
        check(font, names, gs.Options(corners=given.corners, effort=given.effort), np.random.default_rng(given.seed))


def check(font: gs.Font, names: tuple[str, ...], options: gs.Options, rng: np.random.Generator) -> None:
    """Convert glyphs of a font, and print what is counted."""
    results: list[MastersResult] = []
    compared: list[tuple[float, float, int]] = []
    together = apart = 0.0
    least = 0
    for name in names:
        masters = font.masters(name)
        if not masters.contours:
            continue
        if not results:  # what is compiled or loaded at the first use is not timed
            convert_masters(masters, options)
            gs.convert(masters.master(0), options)
        began = time.process_time()
        try:
            result = convert_masters(masters, options)
        except gs.GlyphsplineError as error:
            print(f"{font.path.name} {name}: {error}")
            continue
        together += time.process_time() - began
        began = time.process_time()
        singles = [gs.convert(masters.master(k), options) for k in range(len(masters))]
        apart += time.process_time() - began
        least += max(sum(len(contour.curve) for contour in single.contours) for single in singles)
        compared += compare(result, options.tolerance_for(font.metrics.units_per_em), rng)
        results.append(result)
    contours = [contour for result in results for contour in result.contours]
    uncertified = [r.masters.name for r in results if not all(contour.within_tolerance for contour in r.contours)]
    stopping = [r.masters.name for r in results if not all(contour.regular for contour in r.contours)]
    segments, source = sum(len(c.curve) for c in contours), sum(len(c.source) for c in contours)
    away, bends, extrema = np.array(compared).reshape(-1, 3).T
    print(f"{font.path.name}, {options.corners}, {options.effort}: {len(results)} glyphs, {len(contours)} contours")
    print(f"  not certified: {uncertified or 0}; not proven free of cusps: {stopping or 0}")
    ratios = f"{segments / least:.3f} of the worst single master's, {segments / source:.3f} of the source's"
    print(f"  segments {segments}: {ratios}")
    beyond, largest = (away > 1 + 1e-6).sum(), f"largest {away.max(initial=0.0):.3f} of the tolerance"
    print(f"  {len(away)} instances of contours compared, {beyond} beyond; {largest}")
    print(f"  turn at inner joints, exact: {bends.max(initial=0.0):.1e}°")
    print(f"  extrema of curvature beyond the floor: {extrema.mean():.3g} an instance of a contour")
    print(f"  CPU time, all at once against one by one: {together / apart:.2f} ({together:.1f} s)")
    if "CFF2" in font.tables():
        # Without the bounds of what is redrawn, no arc stays as the font has it.
        redrawn = [Redrawn(each.masters, each.contours, each.inner) for each in map(redrawn_glyph, results)]
        drawn(font, {each.masters.name: each for each in redrawn}, rng)


def compare(result: MastersResult, tolerance: float, rng: np.random.Generator) -> list[tuple[float, float, int]]:
    """Of contours at random locations: distance from the source in tolerances, turn at inner joints, extrema beyond."""
    masters, found = result.masters, []
    step, corners = STEP * masters.metrics.units_per_em / 1000, masters.grid()
    for at in rng.uniform(corners.min(axis=0), corners.max(axis=0), (LOCATIONS, corners.shape[1])):
        weights = masters.weights_at(at)
        for contour in result.contours:
            curve, source = contour.curve.mixed(weights).cubics(), contour.source.mixed(weights).cubics()
            a, b = sampled(curve, step), sampled(source, step)
            away, length = max(distances(a, b).max(), distances(b, a).max()), np.hypot(*np.diff(b, axis=0).T).sum()
            values, _, n = curvatures(curve, length, CORNER)
            extrema = extrema_of(values, n, TURN / length) - extrema_floor(source, length)[1]
            found.append((float(away / tolerance), largest_turn(curve, contour.inner, 1e-9), max(extrema, 0)))
    return found


def largest_turn(cubics: FloatArray, inner: BoolArray, shortest: float) -> float:
    """Degrees at most by which a contour turns at inner joints; handles from ``shortest`` on have a direction."""
    bends = np.abs(np.degrees(turns(np.ascontiguousarray(cubics), shortest)))
    return float(bends[inner].max(initial=0.0))


def drawn(font: gs.Font, redrawn: dict[str, Redrawn], rng: np.random.Generator) -> None:
    """Write the font, and measure what HarfBuzz draws: turns and jumps of curvature at inner joints."""
    data, summary = to_variable_font(font, redrawn, "otf")
    shaped = hb.Font(hb.Face(data))
    axes = font.masters(next(iter(redrawn))).axes
    worst, jumps, joints = 0.0, 0, 0
    for name, glyph in summary.glyphs.items():
        gid = font.glyph_names.index(name)
        for _ in range(LOCATIONS):
            shaped.set_variations({a.tag: float(rng.uniform(a.minimum, a.maximum)) for a in axes})
            pen = SegmentPen()
            shaped.draw_glyph_with_pen(gid, pen)
            for inner, segments in zip(glyph.inner, pen.contours, strict=True):
                cubics = np.array([as_cubic(segment) for segment in segments if np.ptp(segment, axis=0).any()])
                if len(cubics) != len(inner):
                    continue
                worst = max(worst, largest_turn(cubics, inner, 1e-6))
                d, dd = (derivative_points(cubics, order) for order in (1, 2))
                first, last = (signed_curvature(d[:, end], dd[:, end]) for end in (0, -1))
                before, after = np.roll(last, 1), first
                size = np.maximum(np.abs(before), np.abs(after))[inner]
                jumps += int((np.abs(before - after)[inner] > np.maximum(0.1 * size, 1e-4)).sum())
                joints += int(inner.sum())
    print(f"  as HarfBuzz draws: turn {worst:.4f}° at most; jumps over 10 % {jumps / max(joints, 1):.2%} of {joints}")
    if summary.left:
        print(f"  left as they were: {summary.left}")


if __name__ == "__main__":
    main()
