"""Results as polygons within a certified distance of their curves: JSON and CSV."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...fitting.results import GlyphResult
from ...outlines.open_paths import are_open, paths
from ...outlines.outline import Outline
from ...outlines.polygons import flattened, polygons_of
from ...types import FloatArray, counted, rounded_up
from ...writers.json_file import as_text, head
from ...writers.settings import RELATIVE_FLATNESS, Settings

RESERVE = 1e-3
"""Share of the flatness that rounding to decimals may use."""


@dataclass(frozen=True, eq=False)
class Flattened:
    """A glyph as polygons.

    Attributes:
        polygons: (n, 2) corners of each contour, on the curve, in its direction; the first is not repeated at the end.
            The ink is where they wind around a point a number of times other than zero; open paths have none.
        opened: (P,) whether each is an open path, whose last point is not joined to its first.
        bound: certified two-sided distance of the polygons from the curves, in font units, at most the flatness.
    """

    polygons: tuple[FloatArray, ...]
    bound: float
    opened: tuple[bool, ...] = ()

    def __repr__(self) -> str:
        points = counted(sum(map(len, self.polygons)), "point")
        return f"<Flattened: {counted(len(self.polygons), 'polygon')}, {points}, within {self.bound:.3g} units>"


def to_polylines(glyph: GlyphResult | Outline, flatness: float | None = None) -> Flattened:
    """The curves of a glyph as polygons, no farther from them than ``flatness``.

    Args:
        glyph: a result of :func:`convert`, or an outline as a font has it.
        flatness: largest distance in font units; None: 1/2000 em.

    Raises:
        OptionError: flatness is not positive, or so small that rounding errors or millions of points would result.

    Example:
        >>> import glyphspline as gs
        >>> glyph = gs.convert(gs.open_font("fonts_test/kouzan-gyosho.ttf").outline("O"))
        >>> found = gs.to_polylines(glyph, flatness=0.5)
        >>> len(found.polygons), found.bound <= 0.5
        (2, True)
    """
    curves = glyph.arrays.curves if isinstance(glyph, GlyphResult) else glyph.arrays
    em = (glyph.outline if isinstance(glyph, GlyphResult) else glyph).metrics.units_per_em
    opened = are_open(curves)
    lines, bound = flattened(paths(curves, opened), em * RELATIVE_FLATNESS if flatness is None else flatness)
    return Flattened(tuple(polygons_of(lines)), bound, tuple(opened.tolist()))


def polyline_json(glyph: GlyphResult, settings: Settings) -> str:
    """The polygons as JSON, by the schema ``glyphspline/writers/polyline.schema.json``."""
    polygons, bound, opened = _written(glyph, settings)
    # Of ``polyline.schema.json``.
    data = {"format": "glyphspline-polyline", "version": 1, **head(glyph, settings), "fill_rule": "nonzero"}
    flatness = settings.flatness_for(glyph.outline.metrics.units_per_em) * settings.scale
    contours = [polygon.tolist() for polygon in polygons]
    strokes = [number for number, cut in enumerate(opened) if cut]
    return as_text({**data, "flatness": flatness, "bound": bound, "contours": contours, "open": strokes})


def polyline_csv(glyph: GlyphResult, settings: Settings) -> str:
    """The polygons as CSV: number of the contour, of the point in it, x and y; the first point of a polygon is not
    repeated, and nothing says which are open paths.
    """
    lines = ["contour,index,x,y"]
    for c, polygon in enumerate(_written(glyph, settings)[0]):
        lines += [f"{c},{i},{x!r},{y!r}" for i, (x, y) in enumerate(polygon.tolist())]
    return "\n".join(lines) + "\n"


def _written(glyph: GlyphResult, settings: Settings) -> tuple[list[FloatArray], float, tuple[bool, ...]]:
    """The polygons as written, scaled and rounded; their bound with that, in the same unit; and which are open."""
    flatness = settings.flatness_for(glyph.outline.metrics.units_per_em)
    found = to_polylines(glyph, flatness * (1 - RESERVE))
    decimals = max(0, math.ceil(-math.log10(flatness * RESERVE * settings.scale * math.sqrt(2))))
    rounding = 0.5 * 10.0**-decimals * math.sqrt(2)
    polygons = [np.round(polygon * settings.scale, decimals) + 0.0 for polygon in found.polygons]
    # Significant digits of a bound, which is rounded up.
    return polygons, rounded_up(found.bound * settings.scale + rounding, 4), found.opened
