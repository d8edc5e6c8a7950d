"""Fairness in numbers, which the paper shows in pictures: on its polygons and on contours, beside SciPy's cubics."""

from __future__ import annotations

import json
from pathlib import Path

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.spatial import ConvexHull

import glyphspline as gs
from glyphspline.curves.bezier import cross
from glyphspline.interpolation.method import Parametrisation
from glyphspline.plugins.experiments.measures import bulge, curvature_variation, span_points
from glyphspline.plugins.experiments.methods import places_of, scipy_pieces
from glyphspline.plugins.experiments.style import COLOURS, GREY, INK
from glyphspline.readers.opentype.font import open_font
from glyphspline.types import FloatArray

from .common import Run, verdict
from .faces import CHARACTERS, DATA, FONTS
from .measures import shape

METHODS = ("variant 1", "variant 2", "variant 3", "SciPy chord", "SciPy centripetal", "SciPy uniform")
MEASURES = ("∫κ² ds", "∫(dκ/ds)² ds", "max |κ|", "bulge", "overshoot", "self-crossings")
Quality = dict[str, float]


def curves_of(polygon: FloatArray, tolerance: float) -> dict[str, tuple[FloatArray, FloatArray]]:
    """For each method its Bézier pieces, and the parameters of the vertices counted in pieces."""
    places = np.arange(len(polygon), dtype=np.float64)
    curves: dict[str, tuple[FloatArray, FloatArray]] = {}
    for v in (1, 2, 3):
        curves[f"variant {v}"] = curve_of(gs.interpolate(polygon, v, residual_tolerance=tolerance))
    ways: tuple[Parametrisation, ...] = ("chord", "centripetal", "uniform")
    for knots in ways:
        curves[f"SciPy {knots}"] = scipy_pieces(polygon, knots), places
    return curves


def curve_of(result: gs.Interpolation) -> tuple[FloatArray, FloatArray]:
    """The Bézier pieces of an interpolation, and the parameters of the vertices counted in pieces."""
    return result.spline.to_bezier(), places_of(result.spline, result.parameters)


def overshoot(points: FloatArray, polygon: FloatArray) -> float:
    """How far the curve leaves the polygon's convex hull."""
    planes = ConvexHull(polygon).equations
    return float(max((points @ planes[:, :2].T + planes[:, 2]).max(), 0.0))


def self_crossings(line: FloatArray) -> int:
    """Pairs of edges of a closed polyline that cross each other."""
    a, b = line, np.roll(line, -1, axis=0)
    low, high = np.minimum(a, b), np.maximum(a, b)
    count = 0
    for i in range(len(line) - 2):
        near = np.arange(i + 2, len(line) - (i == 0))
        near = near[((low[near] <= high[i]) & (high[near] >= low[i])).all(axis=1)]
        edge = b[i] - a[i]
        sides = cross(edge, a[near] - a[i]) * cross(edge, b[near] - a[i])
        other = b[near] - a[near]
        count += int(((sides < 0) & (cross(other, a[i] - a[near]) * cross(other, b[i] - a[near]) < 0)).sum())
    return count


def quality(pieces: FloatArray, places: FloatArray, polygon: FloatArray) -> Quality:
    """All measures of one curve."""
    line = span_points(pieces, places)[:, :-1].reshape(-1, 2)
    measured = shape(pieces)
    return {
        "∫κ² ds": measured.bending_energy,
        "∫(dκ/ds)² ds": curvature_variation(pieces),
        "max |κ|": measured.max_curvature,
        "bulge": bulge(pieces, places, polygon),
        "overshoot": overshoot(line, polygon),
        "self-crossings": float(self_crossings(line)),
    }


def all_qualities(polygon: FloatArray, tolerance: float) -> dict[str, Quality]:
    """All measures for all methods."""
    return {m: quality(*curve, polygon) for m, curve in curves_of(polygon, tolerance).items()}


def relative_to(values: dict[str, Quality], reference: str) -> dict[str, Quality]:
    """Each measure divided by that of the reference; measures that are 0 there are left out."""
    base = values[reference]
    return {m: {k: q[k] / base[k] for k in q if base[k] > 0} for m, q in values.items()}


def glyph_polygons(run: Run) -> dict[str, list[FloatArray]]:
    """Contours of brush and Latin faces, sampled by step with corners kept, scaled to 1000 units an em."""
    latin = Path(matplotlib.get_data_path()) / "fonts" / "ttf"
    text = "ABCDEFGHJKMNOPQRSTUVWXYZabcdefghkmnopqrstuvwxyz0123456789&@$"
    faces: dict[str, list[tuple[Path, str | None]]] = {
        "brush": [(FONTS / "kouzan-gyosho.ttf", None), (FONTS / "kouzan-kaisho.ttf", None)],
        "Latin": [(latin / "DejaVuSans.ttf", text), (latin / "DejaVuSerif.ttf", text)],
    }
    found: dict[str, list[FloatArray]] = {}
    for kind, files in faces.items():
        found[kind] = []
        for file, chosen in files:
            font = open_font(file)
            names = sorted(font.select(text=chosen), key=font.glyph_names.index) if chosen else list(font.glyph_names)
            for outline in map(font.outline, names[: run.size(1000, 2)]):
                em = outline.metrics.units_per_em
                found[kind] += [gs.sample(c, step=0.03 * em) * (1000 / em) for c in outline.contours]
    return found


def figure_polygons() -> dict[str, list[FloatArray]]:
    """The polygons of Figs. 6 to 9, by figure."""
    drawn = {
        name: [np.array(json.loads((DATA / f"{stem}.json").read_text(encoding="utf-8"))["polygon"])]
        for name, stem in (("Fig. 6", "fig-6"), ("Fig. 7", "fig-7"))
    }
    return drawn | {each.source: each.polygons() for each in CHARACTERS}


def summary(values: list[dict[str, Quality]]) -> dict[str, dict[str, float]]:
    """Medians over polygons of each measure divided by variant 2's; sums of self-crossings."""
    table: dict[str, dict[str, float]] = {}
    for method in METHODS:
        ratios = [relative_to(v, "variant 2")[method] for v in values]
        table[method] = {
            f"{k}, median ratio to variant 2": float(np.median([r[k] for r in ratios if k in r])) for k in MEASURES[:4]
        }
        table[method]["overshoot, mean"] = float(np.mean([v[method]["overshoot"] for v in values]))
        table[method]["self-crossings, sum"] = sum(v[method]["self-crossings"] for v in values)
    return table


def wins(values: list[dict[str, Quality]], method: str) -> Quality:
    """In how many percent of the polygons variant 2 has less of each measure than another method."""
    return {k: 100 * float(np.mean([v["variant 2"][k] < v[method][k] for v in values])) for k in MEASURES[:4]}


def quality_study(run: Run) -> None:
    """Claims on the polygons of Figs. 6 to 9, on glyph contours, and on corners with graded chords."""
    for name, polygons in list(figure_polygons().items())[: run.size(4, 2)]:
        extent = max(float(np.ptp(p, axis=0).max()) for p in polygons)
        values = [all_qualities(p, extent * 1e-7) for p in polygons]
        summed = {"∫κ² ds", "∫(dκ/ds)² ds", "self-crossings"}
        total = {m: {k: (sum if k in summed else max)(v[m][k] for v in values) for k in MEASURES} for m in METHODS}
        run.claim(f"quality-{name.lower().replace('. ', '-')}", total, "measured", words="quality-figures", source=name)
    by_kind = {}
    for kind, polygons in glyph_polygons(run).items():
        by_kind[kind] = [all_qualities(p, 1e-4) for p in polygons]
        measured = {"contours": len(polygons), **summary(by_kind[kind])}
        run.claim(
            f"quality-{kind.lower()}-contours",
            measured,
            "measured",
            words="quality-contours",
            kind=kind,
            more=_judgement(by_kind[kind]),
        )
        won = {m: wins(by_kind[kind], m) for m in ("variant 3", "SciPy centripetal", "SciPy uniform")}
        agrees = verdict(min(won["variant 3"].values()) > 50)
        run.claim(f"quality-{kind.lower()}-wins", won, agrees, words="quality-wins", kind=kind)
    graded_corners(run)
    run.save(_boxes(by_kind), "quality", svg=False)


def _judgement(values: list[dict[str, Quality]]) -> str:
    """Where variant 2 is fairer than variant 3 and where not, in a sentence made of the numbers."""
    three = summary(values)["variant 3"]
    words = []
    for k in MEASURES[:4]:
        ratio = three[f"{k}, median ratio to variant 2"]
        words.append(f"{k} {100 * abs(ratio - 1):.2g} % {'higher' if ratio > 1 else 'lower'}")
    return f"Variant 3 against variant 2, in the median: {', '.join(words)}."


def graded_corners(run: Run) -> None:
    """Deviation at a right angle whose chords grow by a factor away from it, over the chord next to it."""
    measured: dict[str, dict[str, float]] = {m: {} for m in METHODS}
    for factor in (1, 1.5, 2, 3, 4, 6):
        polygon = _square(factor)
        short = float(np.hypot(*(polygon[1] - polygon[0])))
        for method, curve in curves_of(polygon, 1e-9).items():
            measured[method][str(factor)] = bulge(*curve, polygon) / short
    agrees = measured["variant 3"]["4"] > 2 * measured["variant 2"]["4"]
    run.claim("quality-graded-corner", measured, verdict(agrees))


def _square(factor: float, steps: int = 3) -> FloatArray:
    """A square with chords 1, f, f² … from every corner to the middle of its sides."""
    lengths = float(factor) ** np.arange(steps)
    half = np.concatenate([[0.0], np.cumsum(lengths)])
    side = np.concatenate([half, 2 * half[-1] - half[-2::-1]])[:-1]
    turns = [(1, 0), (0, 1), (-1, 0), (0, -1)]
    corner = np.zeros(2)
    points = []
    for direction in turns:
        points.append(corner + side[:, None] * np.array(direction))
        corner = corner + 2 * half[-1] * np.array(direction)
    return np.concatenate(points)


def _box(axes: Axes, place: int, values: FloatArray, shade: str) -> None:
    """A bar over the middle half of the values, its median, and a line from the 5th to the 95th percentile."""
    p5, q1, median, q3, p95 = np.percentile(values, [5, 25, 50, 75, 95])
    axes.plot([p5, p95], [place, place], color=INK, lw=0.6)
    axes.barh(place, q3 - q1, left=q1, height=0.55, color=shade, alpha=0.85, zorder=2)
    axes.plot([median, median], [place - 0.27, place + 0.27], color=INK, lw=1.2, zorder=3)


def _boxes(by_kind: dict[str, list[dict[str, Quality]]]) -> Figure:
    figure, axes = plt.subplots(len(by_kind), 4, figsize=(9, 2.1 * len(by_kind)), layout="constrained", squeeze=False)
    compared = ("variant 1", "variant 3", "SciPy centripetal", "SciPy uniform")
    shades = (COLOURS["variant 1"], COLOURS["variant 3"], GREY, "#616e7c")
    for row, (kind, values) in zip(axes, by_kind.items(), strict=True):
        ratios = [relative_to(v, "variant 2") for v in values]
        for ax, measure in zip(row, MEASURES[:4], strict=True):
            for place, (method, shade) in enumerate(zip(compared, shades, strict=True), 1):
                _box(ax, place, np.log2([r[method][measure] for r in ratios if measure in r[method]]), shade)
            ax.axvline(0, color=INK, lw=0.6)
            ax.use_sticky_edges = False
            ax.margins(x=0.06)
            ax.set_yticks(range(1, len(compared) + 1), compared if ax is row[0] else [""] * len(compared))
            ax.xaxis.set_major_formatter(lambda x, _: f"{2**x:.3g}")
            ax.set_title(f"{measure}, {kind}")
            ax.invert_yaxis()
    figure.supxlabel("ratio to variant 2 (above 1: variant 2 is fairer)", fontsize=8.5)
    return figure
