"""Display of outlines, splines and results in notebooks, and on matplotlib axes.

The classes do not depend on drawing; :func:`install` adds their display methods. Drawing modules are imported on use.
"""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from .curves.bezier import as_cubic, cubic_approximation
from .curves.bspline import Spline
from .curves.curvature import comb as curvature_comb
from .curves.curvature import robust_scale
from .fitting.results import BOUNDS, QUANTITIES, GlyphResult, Measures, as_glyph, shown
from .outlines.outline import Contour, Outline
from .types import FloatArray, rounded_up

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SHOWN = (
    "vertices", "segments", "iterations", "residual", "converged", "deviation", "bending_energy", "max_curvature",
    "curvature_extrema",
)  # fmt: skip
"""Measures shown in a table."""


def install() -> None:
    """Add the methods that notebooks call to the classes."""
    GlyphResult._repr_svg_ = glyph_svg  # type: ignore[attr-defined]
    GlyphResult._repr_html_ = glyph_html  # type: ignore[attr-defined]
    Outline._repr_svg_ = outline_svg  # type: ignore[attr-defined]
    Spline._repr_svg_ = spline_svg  # type: ignore[attr-defined]


def glyph_svg(glyph: GlyphResult) -> str:
    """The result with its curvature comb."""
    from .writers.svg.curvature_map import to_curvature_svg

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
    from .writers.svg.document import to_svg

    return _sized(to_svg(as_glyph(outline)))


def spline_svg(spline: Spline) -> str:
    """The curve, its control polygon, and its knots on the curve."""
    from .writers.svg.document import head, number, view_box_value
    from .writers.svg.path_data import dots_data, polyline_data

    control, knots = spline.control_points, spline(spline.knots)
    every = np.concatenate([control, knots])
    (left, bottom), (right, top) = every.min(axis=0), every.max(axis=0)
    extent = max(float(right - left), float(top - bottom)) or 1.0
    margin, width = 0.04 * extent, number(0.005 * extent, 9)
    digits = max(0, 4 - int(np.floor(np.log10(extent))))
    box = view_box_value((left - margin, bottom - margin, right + margin, top + margin), digits)
    curve = _cubic_data(spline, digits)
    pen = f' fill="none" stroke="currentColor" stroke-width="{width}" stroke-linejoin="round" stroke-linecap="round"'
    return _sized(
        head(box, "spline-title", f"Spline of degree {spline.degree}, {len(control)} control points", pen)
        + f'<path stroke="#75c" stroke-opacity=".7" d="{polyline_data(control, digits, closed=spline.closed)}"/>'
        f'<path d="{curve}"/><path stroke="#0a7" stroke-width="{number(0.016 * extent, 9)}"'
        f' d="{dots_data(knots, digits)}"/></svg>'
    )


def _cubic_data(spline: Spline, digits: int) -> str:
    from fontTools.pens.svgPathPen import SVGPathPen
    from fontTools.pens.transformPen import TransformPen

    pen = SVGPathPen(None, ntos=lambda value: f"{round(value, digits):.15g}")
    spline.draw(TransformPen(pen, (1, 0, 0, -1, 0, 0)))
    return str(pen.getCommands())


def _sized(svg: str) -> str:
    return svg.replace("<svg ", '<svg height="320" style="max-width:100%" ', 1)


def plot(
    thing: GlyphResult | Outline | Contour | Spline,
    axes: Axes | None = None,
    *,
    comb: bool = False,
    scale: float | None = None,
    polygon: bool = False,
    control_polygon: bool = False,
    source: bool = False,
    **style: Any,
) -> Axes:
    """Draw an outline, a contour, a spline or a glyph's result onto matplotlib axes, y up, in font units.

    Args:
        thing: what to draw. axes: where; None is pyplot's current axes.
        comb: draw the curvature comb. scale: curvature in 1/unit of a full tooth; None is computed from ``thing``.
        polygon: draw a result's polygon. control_polygon: of a spline or of a result's splines. source: of a result.
        style: of the curve, as for a ``PathPatch``: ``edgecolor``, ``linewidth``, ``facecolor``, …

    Returns:
        The axes.
    """
    from .writers.figures.basics import outline_patch

    if axes is None:
        from matplotlib import pyplot

        axes = pyplot.gca()
    closed, sources, polygons = True, [], []
    if isinstance(thing, Spline):
        closed, curves, splines = thing.closed, [_cubics(thing)], [thing]
        em = float(np.ptp(thing.control_points, axis=0).max())
    else:
        glyph = as_glyph(thing)
        curves = [contour.curve.cubics() for contour in glyph.contours]
        splines = [arc.spline for contour in glyph.contours for arc in contour.interpolations]
        polygons = [contour.polygon for contour in glyph.contours]
        sources = [contour.cubics() for contour in glyph.outline.contours]
        em = glyph.outline.metrics.units_per_em
    sides = np.ones(1) if isinstance(thing, Spline) else None  # a curve alone has no ink: it turns left or right
    patches = []
    if source:
        patches += outline_patch(sources, facecolor="none", edgecolor="tab:orange", linewidth=0.8)
    if comb:
        if sides is None:
            from .outlines.ink import ink_sides

            sides = ink_sides(as_glyph(thing).arrays.curves)  # type: ignore[arg-type]
        patches += _comb_patches(curves, sides, em, scale, closed=closed)
    patches += outline_patch(curves, **{"facecolor": "none", "edgecolor": "black", "linewidth": 1.2} | style)
    for patch in patches:
        axes.add_patch(patch)
    for corners in polygons if polygon else ():
        axes.plot(*_closed(corners).T, ".-", color="tab:green", linewidth=0.7, markersize=3)
    for spline in splines if control_polygon else ():
        points = _closed(spline.control_points) if spline.closed else spline.control_points
        axes.plot(*points.T, ".--", color="tab:purple", linewidth=0.7, markersize=3)
    axes.set_aspect("equal")
    axes.autoscale_view()
    return axes


def _cubics(spline: Spline) -> FloatArray:
    """(m, 4, 2) the curve's pieces; for degrees above 3 within 1e-5 of its extent."""
    if spline.degree <= 3:
        return np.array([as_cubic(piece) for piece in spline.to_bezier()])
    extent = float(np.ptp(spline.control_points, axis=0).max())
    return cubic_approximation(spline.to_bezier(), 1e-5 * extent)


def _comb_patches(
    curves: list[FloatArray], sides: FloatArray, em: float, scale: float | None, *, closed: bool
) -> list[Any]:
    from .writers.figures.basics import comb_patches
    from .writers.svg.comb import SPACING, teeth_of

    drawn = [(curvature_comb(cubics, SPACING * em), s) for cubics, s in zip(curves, sides, strict=True) if len(cubics)]
    found = [item for item, _ in drawn]
    unit = robust_scale(found) if scale is None else scale
    return comb_patches([teeth_of(item, em, unit, side) for item, side in drawn], closed=closed, width=0.6)


def _closed(points: FloatArray) -> FloatArray:
    return np.concatenate([points, points[:1]])
