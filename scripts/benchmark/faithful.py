"""How few segments and numbers keep a glyph within 1/1000 em, against the source itself, FontForge and variant 3.

FontForge is given the benefit of the doubt: of 30 settings of its ``simplify`` the one with the fewest numbers counts
whose result, by dense sampling, truly stays within the tolerance; where none does, the source does. So is kurbo's fit,
with its accuracies in the place of settings.

The last rows say how fair the results are beside their sources: :func:`fairness_rows`.
"""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

import glyphspline as gs
from glyphspline.curves.bezier import as_cubic
from glyphspline.plugins.experiments.measures import curvature_variation
from glyphspline.plugins.fonts.extrema import hidden_extrema
from glyphspline.types import FloatArray

from ..survey import distances, faces, sampled
from .kurbo_fit import kurbo_results
from .measure import Row

GLYPHS = int(os.environ.get("GLYPHSPLINE_BENCH_GLYPHS", "200"))
EM = 1000.0
SPACING = 2.0
"""Font units between the points at which a peer is measured, each to the polyline through the other side's points."""

FORGE = ("/usr/bin/python3", str(Path(__file__).with_name("fontforge_simplify.py")))


@dataclass(frozen=True)
class Face:
    """A face to measure, and what has to be reached on it (must, aim)."""

    name: str
    pattern: str
    latin: bool
    segments: tuple[float, float] = (1.0, 1.0)
    numbers: tuple[float, float] = (1.0, 1.0)


FACES = (
    Face("Ma Shan Zheng", "ma-shan-zheng-*-400-normal.woff2", False, (1.10, 1.00), (0.90, 0.80)),
    Face("Kouzan gyosho", "kouzan-mouhitsu-gyosho.ttf", False, (0.83, 0.75), (0.92, 0.85)),
    Face("Noto Sans CJK", "NotoSansCJK-Regular.ttc", False, (1.08, 1.00), (1.00, 0.95)),
    Face("Noto Serif CJK", "NotoSerifCJK-Regular.ttc", False, (1.17, 1.05), (1.10, 1.00)),
    Face("DejaVu Sans", "DejaVuSans.ttf", True, (1.01, 0.85), (1.00, 0.90)),
)


def rows() -> list[Row]:
    """All faces that are installed, or lie in a folder of GLYPHSPLINE_FACES."""
    return [row for measured in (face_rows, fairness_rows) for row in of_faces(FACES, measured)]


def of_faces(faces: Sequence[Face], measured: Callable[[Face, list[gs.Outline]], list[Row]]) -> list[Row]:
    """The rows of the faces that are installed."""
    return [row for face in faces if (glyphs := outlines(face)) for row in measured(face, glyphs)]


def outlines(face: Face) -> list[gs.Outline]:
    """Glyphs spread evenly over the face's ideographs, or its Latin letters, scaled to 1000 units an em."""
    low, high = (0x21, 0x24F) if face.latin else (0x4E00, 0x9FFF)
    found: dict[int, tuple[Any, str]] = {}
    for path in faces(face.pattern):
        font = gs.open_font(path)
        for code, name in font.cmap.items():
            if low <= code <= high:
                found.setdefault(code, (font, name))
    codes = sorted(found)
    result: list[gs.Outline] = []
    for k in range(min(2 * GLYPHS, len(codes))):
        font, name = found[codes[k * len(codes) // min(2 * GLYPHS, len(codes))]]
        outline = font.outline(name)
        if outline.contours:
            result.append(to_em(outline))
    return result[:: max(1, len(result) // GLYPHS)][:GLYPHS]


def to_em(outline: gs.Outline) -> gs.Outline:
    """The outline scaled to 1000 units an em."""
    scale = EM / outline.metrics.units_per_em
    contours = tuple(gs.Contour(c.points * scale, c.degrees) for c in outline.contours)
    return replace(outline, contours=contours, metrics=gs.FontMetrics(EM))


def numbers(contour: gs.Contour) -> int:
    """Two for every point."""
    return int(2 * contour.degrees.sum())


def face_rows(face: Face, glyphs: list[gs.Outline]) -> list[Row]:
    """Means over all glyphs of a face."""
    source = np.array([[sum(map(len, g.contours)), sum(map(numbers, g.contours))] for g in glyphs])
    forge = np.array([fewest(g, results)[:2] for g, results in zip(glyphs, forge_results(glyphs), strict=True)])
    best, best_time = converted(glyphs, gs.Options(corners="sharp", effort="best", tolerance=1.0))
    fast, fast_time = converted(glyphs, gs.Options(corners="sharp", effort="fast", tolerance=1.0))
    every = max(1, len(glyphs) // 25)
    few = glyphs[::every]
    kurbo = np.array([fewest(glyph, kurbo_results(glyph))[:2] for glyph in few])
    smooth, smooth_time = converted(few, gs.Options(corners="smooth", tolerance=1.0, effort="best"))
    third, _ = converted(few, gs.Options(corners="smooth", tolerance=1.0, effort="best", variant=3))
    missed, contours = best[:, 2].sum() + fast[:, 2].sum(), 2 * sum(len(g.contours) for g in glyphs)
    note = (
        f"{len(glyphs)} glyphs; a glyph: source {source.mean(0)}, FontForge {forge.mean(0)}, sharp {best.mean(0)[:2]}"
    )
    share = best.mean(0) / source.mean(0).repeat(2)[[0, 2, 0, 0]]
    return [
        Row(f"{face.name}: segments / source's", share[0], "x", *face.segments, False, note),
        Row(f"{face.name}: numbers / FontForge's", best.mean(0)[1] / forge.mean(0)[1], "x", *face.numbers, False),
        Row(f"{face.name}: segments / FontForge's", best.mean(0)[0] / forge.mean(0)[0], "x", None, None, False),
        Row(
            f"{face.name}: segments / kurbo's", best[::every].mean(0)[0] / kurbo.mean(0)[0], "x", None, None, False,
            f"{len(few)} glyphs; a glyph: kurbo {kurbo.mean(0)}, sharp {best[::every].mean(0)[:2]}",
        ),
        Row(f"{face.name}: share of contours not certified", missed / contours, "", 1e-4, None, False),
        Row(f"{face.name}: best, a glyph", best_time * 1e3, "ms", 25, None, False),
        Row(f"{face.name}: fast, a glyph", fast_time * 1e3, "ms", 2, None, False),
        Row(f"{face.name}: fast / best, segments", fast.mean(0)[0] / best.mean(0)[0], "x", 1.3, None, False),
        Row(
            f"{face.name}: smooth, vertices / variant 3's", smooth.mean(0)[3] / third.mean(0)[3], "x", 0.9, None, False,
            f"{smooth.mean(0)[3]:.0f} and {third.mean(0)[3]:.0f} vertices; not certified {smooth[:, 2].sum():.0f} and "
            f"{third[:, 2].sum():.0f}; {smooth_time * 1e3:.1f} ms a glyph",
        ),
    ]  # fmt: skip


def converted(glyphs: list[gs.Outline], options: gs.Options) -> tuple[FloatArray, float]:
    """(glyphs, 4) segments, numbers, contours not certified, vertices; and median processor seconds a glyph."""
    gs.convert(glyphs[0], options)
    figures, seconds = [], []
    for glyph in glyphs:
        start = process_time()
        result = gs.convert(glyph, options)
        seconds.append(process_time() - start)
        measures = [contour.measures for contour in result.contours]
        missed = sum(not m.within_tolerance for m in measures)
        figures.append([sum(m.segments for m in measures), sum(m.numbers for m in measures), missed,
                        sum(m.vertices for m in measures)])  # fmt: skip
    return np.array(figures, dtype=np.float64), float(np.mean(seconds))


WAYS = {
    "smooth fast": gs.Options(tolerance=1.0, corners="smooth"),
    "smooth best": gs.Options(tolerance=1.0, corners="smooth", effort="best"),
    "sharp fast": gs.Options(tolerance=1.0, corners="sharp"),
    "sharp best": gs.Options(tolerance=1.0, corners="sharp", effort="best"),
    "sharp best g2": gs.Options(tolerance=1.0, corners="sharp", effort="best", continuity="g2"),
}
"""Whose fairness is measured."""


def fairness_rows(face: Face, glyphs: list[gs.Outline]) -> list[Row]:
    """Significant extrema of curvature a glyph, and those beyond each contour's source; how much C2 arcs vary."""
    found = {way: np.array([fairness(gs.convert(g, options)) for g in glyphs]) for way, options in WAYS.items()}
    source, (c2, g2) = found["sharp best"][:, 0], (found[way][:, 3] for way in ("sharp best", "sharp best g2"))
    ratio = np.median(c2[g2 > 0] / g2[g2 > 0])
    return [
        Row(f"{face.name}: extrema of curvature, source", source.mean(), "", None, None, False),
        *(
            Row(
                f"{face.name}: extrema of curvature, {way}", each[:, 1].mean(), "", None, None, False,
                f"{each[:, 2].mean():.3g} beyond the source's own",
            )
            for way, each in found.items()
        ),
        Row(f"{face.name}: ∫(dκ/ds)² ds, sharp best / g2", ratio, "x", None, None, False, "median of the glyphs"),
    ]  # fmt: skip


def fairness(result: gs.GlyphResult) -> tuple[int, int, int, float]:
    """Extrema of the source and of the result, those of contours beyond their source's, and ∫(dκ/ds)² ds."""
    pairs = [(c.measures.source_curvature_extrema or 0, c.measures.curvature_extrema or 0) for c in result.contours]
    beyond = sum(max(own - given, 0) for given, own in pairs)
    variation = sum(curvature_variation(contour.curve.cubics()) for contour in result.contours)
    return sum(given for given, _ in pairs), sum(own for _, own in pairs), beyond, variation


def forge_results(glyphs: list[gs.Outline]) -> Iterator[list[list[list[Any]]]]:
    """What FontForge makes of each glyph with each setting."""
    with subprocess.Popen(
        FORGE, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    ) as p:
        assert p.stdin
        assert p.stdout
        for glyph in glyphs:
            contours = [[(as_cubic(s) if len(s) == 3 else s).tolist() for s in c.segments()] for c in glyph.contours]
            print(json.dumps(contours), file=p.stdin, flush=True)
            yield json.loads(p.stdout.readline())


def inside(contours: Iterable[Iterable[Any]]) -> int:
    """Horizontal and vertical extrema inside the cubics of contours, each a list of segments."""
    return sum(hidden_extrema(np.asarray(s, dtype=np.float64)) for c in contours for s in c if len(s) == 4)


def fewest(glyph: gs.Outline, results: list[list[list[Any]]]) -> tuple[int, int, list[list[Any]]]:
    """Segments and numbers of the result with the fewest numbers that stays within one unit, or the source; and it."""
    source = sampled((s for c in glyph.contours for s in c.segments()), SPACING)
    sizes = [(sum(2 * (len(s) - 1) for c in r for s in c), sum(map(len, r)), k) for k, r in enumerate(results)]
    for size, segments, k in sorted(sizes):
        curve = sampled((np.array(s) for c in results[k] for s in c), SPACING)
        pairs = (curve, source), (source, curve)
        if len(curve) and all(distances(*pair, closed=False).max() <= 1.0 for pair in pairs):
            return segments, size, results[k]
    return sum(map(len, glyph.contours)), sum(map(numbers, glyph.contours)), [[*c.segments()] for c in glyph.contours]
