"""Display of outlines, splines and results in notebooks, and on matplotlib axes.

The classes do not depend on drawing; :func:`install` adds their display methods. Drawing modules are imported on use.
"""

from __future__ import annotations

import re
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from ...curves.bezier import as_cubic, cubic_approximation, normal_part
from ...curves.bspline import Spline
from ...curves.curvature import comb as curvature_comb
from ...curves.curvature import robust_scale
from ...fitting.results import BOUNDS, QUANTITIES, GlyphResult, Measures, as_glyph, shown
from ...interpolation.result import Interpolation
from ...outlines.contour_arrays import polylines
from ...outlines.open_paths import are_open, paths
from ...outlines.outline import Contour, Contours, Outline
from ...types import FloatArray, rounded_up

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ...writers.svg.comb import Teeth

SHOWN = (
    "vertices", "segments", "iterations", "residual", "converged", "deviation", "bending_energy", "max_curvature",
    "curvature_extrema",
)  # fmt: skip
"""Measures shown in a table."""

MARKS = {"vertices": ("#e80", 0.022), "knots": ("#0a7", 0.014), "footpoints": ("currentColor", 0.007)}
"""Colours of points on a curve, and their diameter as a share of its extent."""

REACH = 0.12
"""Length of a comb's tooth at the scale, as a share of the extent of a curve alone: there is room around it."""


def install() -> None:
    """Add the methods that notebooks call to the classes."""
    GlyphResult._repr_svg_ = glyph_svg  # type: ignore[attr-defined]
    GlyphResult._repr_html_ = glyph_html  # type: ignore[attr-defined]
    Outline._repr_svg_ = outline_svg  # type: ignore[attr-defined]
    Spline._repr_svg_ = Interpolation._repr_svg_ = curve_svg  # type: ignore[attr-defined]
    Interpolation._repr_html_ = interpolation_html  # type: ignore[attr-defined]


def glyph_svg(glyph: GlyphResult) -> str:
    """The result with its curvature comb."""
    from ...writers.svg.curvature_map import to_curvature_svg

    return _sized(to_curvature_svg(glyph))


def glyph_html(glyph: GlyphResult) -> str:
    """The result with its comb, above a table of its contours' measures, its options and its notes."""
    em = glyph.outline.metrics.units_per_em
    head = "".join(
        f'<th title="{escape(about)}">{label}{f", {unit}" if unit else ""}</th>'
        for label, unit, about in (QUANTITIES[name] for name in SHOWN)
    )
    rows = "".join(f"<tr><th>{c}</th>{_cells(each.measures, em)}</tr>" for c, each in enumerate(glyph.contours))
    notes = "".join(f"<p>{escape(note)}</p>" for note in (glyph.options.words, *glyph.notes))
    return f"{glyph_svg(glyph)}<table><tr><th>contour</th>{head}</tr>{rows}</table>{notes}"


def _cells(measures: Measures, em: float) -> str:
    values = [shown(name, getattr(measures, name), em) for name in SHOWN]
    values = [rounded_up(v, 3) if n in BOUNDS and v is not None else v for n, v in zip(SHOWN, values, strict=True)]
    return "".join(f"<td>{f'{v:.3g}' if isinstance(v, float) else '–' if v is None else v}</td>" for v in values)


def outline_svg(outline: Outline) -> str:
    """The outline, filled, in its em box."""
    from ...writers.svg.document import to_svg

    return _sized(to_svg(as_glyph(outline)))


def curve_svg(curve: Spline | Interpolation) -> str:
    """The curve with its comb, its control polygon and its knots; of an interpolation vertices and footpoints too.

    A curve in space is drawn by matplotlib, beside its curvature and torsion.
    """
    from ...writers.svg.document import head, number, view_box_value
    from ...writers.svg.path_data import dots_data, polyline_data, polylines_data

    spline = _spline_of(curve)
    if spline.control_points.shape[1] > 2:
        return _space_svg(curve)
    control, marks, comb = spline.control_points, _marks(curve), _comb_of(_cubics(spline))
    strokes = [(colour, polylines([*teeth], [False] * len(teeth))) for colour, teeth in comb.items()]
    every = np.concatenate([control, *marks.values(), *(lines.points for _, lines in strokes)])
    (left, bottom), (right, top) = every.min(axis=0), every.max(axis=0)
    extent = max(float(right - left), float(top - bottom)) or 1.0
    margin, width = 0.04 * extent, number(0.005 * extent, 9)
    digits = max(0, 4 - int(np.floor(np.log10(extent))))
    box = view_box_value((left - margin, bottom - margin, right + margin, top + margin), digits)
    pen = f' fill="none" stroke="currentColor" stroke-width="{width}" stroke-linejoin="round" stroke-linecap="round"'
    layers = [f'<g class="comb" stroke-width="{number(0.0015 * extent, 9)}">']
    layers += [f'<path stroke="{c}" d="{polylines_data(lines, digits)[0].text}"/>' for c, lines in strokes]
    net = polyline_data(control, digits, closed=spline.closed)
    layers.append(f'</g><path stroke="#75c" stroke-opacity=".7" d="{net}"/><path d="{_cubic_data(spline, digits)}"/>')
    for name, points in marks.items():
        colour, share = MARKS[name]
        dots = dots_data(points, digits)
        layers.append(f'<path class="{name}" stroke="{colour}" stroke-width="{number(share * extent, 9)}" d="{dots}"/>')
    title = f"Spline of degree {spline.degree}, {len(control)} control points"
    return _sized(head(box, title, pen) + "".join(layers) + "</svg>")


def interpolation_html(found: Interpolation) -> str:
    """The curve with its comb, vertices, knots and footpoints, and what became of the interpolation."""
    legend = " · ".join(f'<span style="color:{MARKS[name][0]}">●</span> {name}' for name in _marks(found))
    return f"{curve_svg(found)}<p>{escape(repr(found))}<br>{legend}</p>"


def _spline_of(curve: Spline | Interpolation) -> Spline:
    return curve if isinstance(curve, Spline) else curve.spline


def _marks(curve: Spline | Interpolation) -> dict[str, FloatArray]:
    """Points to be marked, those in front last."""
    if isinstance(curve, Spline):
        return {"knots": curve(curve.knots)}
    spline, vertices = curve.spline, {} if curve.points is None else {"vertices": curve.points}
    return {**vertices, "knots": spline(spline.knots), "footpoints": spline(curve.parameters)}


def _comb_of(cubics: FloatArray) -> dict[str, FloatArray]:
    """Teeth (k, 2, 2) of a curve in the plane by colour; its own extent is the em."""
    from ...writers.svg.comb import SIDES, TOOTH, colour_classes, palette

    extent = float(np.ptp(cubics, axis=(0, 1)).max())
    (drawn,) = _teeth([cubics], np.ones(1), extent, None, REACH / TOOTH)
    teeth, classes = np.stack([drawn.feet, drawn.tips], axis=1), colour_classes(drawn.relative)
    return {colour: teeth[classes == k] for k, colour in enumerate(palette(), -SIDES) if (classes == k).any()}


def _teeth(
    curves: list[FloatArray], sides: FloatArray, em: float, scale: float | None, longer: float = 1.0
) -> list[Teeth]:
    """Combs of curves at a scale, or at one of their own; ``longer``: than teeth of a glyph are."""
    from ...writers.svg.comb import SPACING, teeth_of

    drawn = [(curvature_comb(cubics, SPACING * em), s) for cubics, s in zip(curves, sides, strict=True) if len(cubics)]
    unit = robust_scale([item for item, _ in drawn]) if scale is None else scale
    return [teeth_of(item, em * longer, unit, side) for item, side in drawn]


def _space_svg(curve: Spline | Interpolation) -> str:
    from ...writers.figures.basics import blank, saved

    spline = _spline_of(curve)
    torsion = spline.control_points.shape[1] == 3
    figure = blank(9.0, 3.6, layout="constrained")
    grid = figure.add_gridspec(1 + torsion, 2)
    _in_space(curve, figure.add_subplot(grid[:, 0], projection="3d"), None, comb=True)
    t = _between_knots(spline)
    inner, last = t[:, :-1], t[:, -1:]  # from both sides of a knot, where derivatives may jump
    bends = np.concatenate([spline.curvature(inner), spline.curvature(last, side="left")], axis=1)
    drawn = [("|κ|", "tab:purple", bends)]
    if torsion:
        twists = np.concatenate([spline.torsion(inner), spline.torsion(last, side="left")], axis=1)
        # Share of the largest curvature below which torsion is not drawn: where a curve does not bend it is none.
        drawn.append(("torsion", "tab:blue", np.where(bends > 0.02 * bends.max(), twists, np.nan)))
    for row, (name, colour, values) in enumerate(drawn):
        axes = figure.add_subplot(grid[row, 1])
        axes.plot(t.T, values.T, color=colour, linewidth=1)
        axes.plot(spline.knots, np.zeros(len(spline.knots)), "|", color=MARKS["knots"][0])
        axes.set_ylabel(f"{name}, 1/unit")
    axes.set_xlabel("parameter t")
    # matplotlib's style would hold for everything on the page; what it says of lines is the default, but for joins.
    drawing = re.sub("<style.*?</style>", "", saved(figure, "svg").decode(), flags=re.DOTALL)
    return drawing[drawing.index("<svg") :].replace("<svg ", '<svg stroke-linejoin="round" style="max-width:100%" ', 1)


def _between_knots(spline: Spline) -> FloatArray:
    """(pieces, 24) parameters of each span, both its ends included."""
    return np.linspace(spline.knots[spline.spans], spline.knots[spline.spans + 1], 24, axis=1)


def _in_space(curve: Spline | Interpolation, axes: Any, scale: float | None, *, comb: bool) -> None:
    """Draw onto axes with three dimensions; a curve in more by its principal directions."""
    spline = _spline_of(curve)
    centre = spline.control_points.mean(axis=0)
    _, _, directions = np.linalg.svd(spline.control_points - centre)
    flat = np.eye(3) if len(centre) == 3 else directions[:3].T
    t = np.unique(_between_knots(spline))
    points = spline(t)
    if comb:
        normals, extent = normal_part(spline(t, 1), spline(t, 2)), float(np.ptp(points, axis=0).max())
        bends = np.linalg.norm(normals, axis=1)
        unit = (np.nanpercentile(bends, 80) or 1.0) if scale is None else scale
        length = np.minimum(1.0, 1.25 * unit / np.maximum(bends, 1e-300))[:, None]
        tips = points - REACH * extent * normals / unit * length
        teeth = np.stack([points, tips, np.full_like(tips, np.nan)], axis=1).reshape(-1, len(centre)) @ flat
        axes.plot(*teeth.T, color="tab:purple", linewidth=0.4)
    axes.plot(*(points @ flat).T, color="black", linewidth=1.2)
    _draw_marks(axes, {name: marked @ flat for name, marked in _marks(curve).items()})
    axes.set_aspect("equal")


def _draw_marks(axes: Any, marks: dict[str, FloatArray]) -> None:
    for name, points in marks.items():
        colour, share = MARKS[name]
        axes.plot(*points.T, "o", color="black" if colour == "currentColor" else colour, markersize=250 * share)


def _cubic_data(spline: Spline, digits: int) -> str:
    from fontTools.pens.svgPathPen import SVGPathPen
    from fontTools.pens.transformPen import TransformPen

    pen = SVGPathPen(None, ntos=lambda value: f"{round(value, digits):.15g}")
    spline.draw(TransformPen(pen, (1, 0, 0, -1, 0, 0)))
    return str(pen.getCommands())


def _sized(svg: str) -> str:
    return svg.replace("<svg ", '<svg height="320" style="max-width:100%" ', 1)


def plot(
    thing: GlyphResult | Outline | Contour | Spline | Interpolation,
    axes: Axes | None = None,
    *,
    comb: bool = False,
    scale: float | None = None,
    polygon: bool = False,
    control_polygon: bool = False,
    source: bool = False,
    **style: Any,
) -> Axes:
    """Draw an outline, a contour, a spline, an interpolation or a glyph's result onto matplotlib axes, y up.

    An interpolation has its vertices, knots and footpoints marked. A curve in space is drawn with three dimensions, one
    in R^4 and beyond by its three principal directions; only ``comb`` and ``scale`` apply to it, and no sign.

    Args:
        thing: what to draw. axes: where; None is pyplot's current axes, or new ones with three dimensions.
        comb: draw the curvature comb. scale: curvature in 1/unit of a full tooth; None is computed from ``thing``.
        polygon: of a result or an interpolation. control_polygon: of a spline or of a result's splines. source: draw
            the outline of a result.
        style: of the curve, as for a ``PathPatch``: ``edgecolor``, ``linewidth``, ``facecolor``, …

    Returns:
        The axes.
    """
    from ...writers.figures.basics import comb_patches, outline_patch, ring

    curve = thing if isinstance(thing, Spline | Interpolation) else None
    space = curve is not None and _spline_of(curve).control_points.shape[1] > 2
    if axes is None:
        from matplotlib import pyplot

        axes = pyplot.figure().add_subplot(projection="3d") if space else pyplot.gca()
    if curve is not None and space:
        _in_space(curve, axes, scale, comb=comb)
        return axes
    marks = _marks(thing) if isinstance(thing, Interpolation) else {}
    closed, sources = True, list[FloatArray]()
    if isinstance(thing, Spline | Interpolation):
        spline = _spline_of(thing)
        closed, curves, splines = spline.closed, [_cubics(spline)], [spline]
        polygons = [marks["vertices"]] if "vertices" in marks else []
        em = float(np.ptp(spline.control_points, axis=0).max())
    else:
        glyph = as_glyph(thing)
        curves = [contour.curve.cubics() for contour in glyph.contours]
        splines = [arc.spline for contour in glyph.contours for arc in contour.interpolations]
        polygons = [contour.polygon for contour in glyph.contours]
        sources = [contour.cubics() for contour in glyph.outline.contours]
        em = glyph.outline.metrics.units_per_em
    patches = []
    if source:
        patches += outline_patch(sources, facecolor="none", edgecolor="tab:orange", linewidth=0.8)
    if comb:
        from ...outlines.ink import ink_sides

        # A curve alone has no ink: it turns left or right.
        if curve is not None:
            combs = _teeth(curves, np.ones(1), em, scale)
        else:
            opened = are_open(glyph.arrays.curves)
            sides, ways = np.where(opened, 1.0, ink_sides(glyph.arrays.curves)), paths(glyph.arrays.curves, opened)
            cut = [c.cubics()[: -1 if o else None] for c, o in zip(Contours(ways), opened.tolist(), strict=True)]
            drawn = zip(_teeth(cut, sides, em, scale), opened.tolist(), strict=True)
            combs = [each.there_and_back() if o else each for each, o in drawn]
        patches += comb_patches(combs, closed=closed, width=0.6)
    patches += outline_patch(curves, **{"facecolor": "none", "edgecolor": "black", "linewidth": 1.2} | style)
    for patch in patches:
        axes.add_patch(patch)
    for corners in polygons if polygon else ():
        axes.plot(*ring(corners).T, ".-", color="tab:green", linewidth=0.7, markersize=3)
    for spline in splines if control_polygon else ():
        points = ring(spline.control_points) if spline.closed else spline.control_points
        axes.plot(*points.T, ".--", color="tab:purple", linewidth=0.7, markersize=3)
    _draw_marks(axes, marks)
    axes.set_aspect("equal")
    axes.autoscale_view()
    return axes


def _cubics(spline: Spline) -> FloatArray:
    """(m, 4, 2) the curve's pieces; for degrees above 3 within 1e-5 of its extent."""
    if spline.degree <= 3:
        return np.array([as_cubic(piece) for piece in spline.to_bezier()])
    extent = float(np.ptp(spline.control_points, axis=0).max())
    return cubic_approximation(spline.to_bezier(), 1e-5 * extent)
