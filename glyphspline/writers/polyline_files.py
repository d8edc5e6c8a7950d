"""Results as polygons within a certified distance of their curves: JSON, CSV and OpenSCAD."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from json.encoder import encode_basestring_ascii as quoted

import numpy as np

from ..fitting.results import GlyphResult
from ..outlines.outline import Outline
from ..outlines.polygons import flattened, polygons_of, uncrossed
from ..types import FloatArray, counted, rounded_up
from .json_file import as_text, head
from .settings import RELATIVE_FLATNESS, Settings

RESERVE = 1e-3
"""Share of the flatness that rounding to decimals may use."""

_NOT_NAME = re.compile(r"[^A-Za-z0-9_]")


@dataclass(frozen=True, eq=False)
class Flattened:
    """A glyph as polygons.

    Attributes:
        polygons: (n, 2) corners of each contour, on the curve, in its direction; the first is not repeated at the end.
            The ink is where they wind around a point a number of times other than zero.
        bound: certified two-sided distance of the polygons from the curves, in font units, at most the flatness.
    """

    polygons: tuple[FloatArray, ...]
    bound: float

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
    lines, bound = flattened(curves, em * RELATIVE_FLATNESS if flatness is None else flatness)
    return Flattened(tuple(polygons_of(lines)), bound)


def polyline_json(glyph: GlyphResult, settings: Settings) -> str:
    """The polygons as JSON, by the schema ``glyphspline/writers/polyline.schema.json``."""
    polygons, bound = _written(glyph, settings)
    # Of ``polyline.schema.json``.
    data = {"format": "glyphspline-polyline", "version": 1, **head(glyph, settings), "fill_rule": "nonzero"}
    flatness = settings.flatness_for(glyph.outline.metrics.units_per_em) * settings.scale
    contours = [polygon.tolist() for polygon in polygons]
    return as_text({**data, "flatness": flatness, "bound": bound, "contours": contours})


def polyline_csv(glyph: GlyphResult, settings: Settings) -> str:
    """The polygons as CSV: number of the contour, of the point in it, x and y."""
    lines = ["contour,index,x,y"]
    for c, polygon in enumerate(_written(glyph, settings)[0]):
        lines += [f"{c},{i},{x!r},{y!r}" for i, (x, y) in enumerate(polygon.tolist())]
    return "\n".join(lines) + "\n"


def polyline_scad(glyph: GlyphResult, settings: Settings) -> str:
    """The polygons as a module of OpenSCAD, which the file also calls; ``use <file>`` only defines it.

    OpenSCAD fills the paths of one ``polygon()`` by the even-odd rule, which would make holes where contours overlap.
    So contours are cut where they cross, and joined to loops that do not; each outer loop is a ``polygon()`` with its
    own holes as further paths, and the ink is their union: that of the nonzero rule.
    """
    polygons, bound = _written(glyph, settings)
    polygons = uncrossed(polygons)
    name = f"glyph_{_NOT_NAME.sub('_', glyph.outline.name)}"
    unit = settings.unit or "font units"
    codes = "".join(f" U+{code:04X}" for code in glyph.outline.unicodes)
    lines = [
        f"// Glyph {quoted(glyph.outline.name)}{codes}, in {unit}: {settings.scale:.9g} a font unit.",
        f"// Polygons within {bound:g} of the curves.",
        f"function {name}_advance() = {glyph.outline.advance * settings.scale!r};",
        f"module {name}() {{",
        "  union() {",
    ]
    for outer, holes in outers_and_holes(polygons):
        own = [polygons[c] for c in (outer, *holes)]
        points = ",".join(f"[{x!r},{y!r}]" for x, y in np.concatenate(own).tolist())
        ends = np.cumsum([len(polygon) for polygon in own]).tolist()
        ranges = zip([0, *ends], ends, strict=False)
        paths = ",".join(f"[for (i = [{first}:{end - 1}]) i]" for first, end in ranges)
        lines.append(f"    polygon(points = [{points}], paths = [{paths}]);")
    return "\n".join([*lines, "  }", "}", f"{name}();"]) + "\n"


def outers_and_holes(polygons: Sequence[FloatArray]) -> list[tuple[int, list[int]]]:
    """Indices of the outer polygons, each with those of its holes, of the ink of the nonzero rule.

    Polygons are :func:`.uncrossed`. One bounds ink if winding numbers are zero on one of its sides only; it is a hole
    if that is the inside, and belongs to the smallest outer one around it. The others are left out.
    """
    from ..outlines.ink import winding  # here and not above: the package opens without a compiler

    areas = np.array([_area(polygon) for polygon in polygons])
    boxes = np.array([[*polygon.min(axis=0), *polygon.max(axis=0)] for polygon in polygons]).reshape(-1, 4)
    holes: dict[int, list[int]] = {}
    around: dict[int, list[int]] = {}
    for c in np.flatnonzero(areas).tolist():
        x, y = _middle(polygons[c])
        near = (boxes[:, 0] <= x) & (boxes[:, 1] <= y) & (boxes[:, 2] >= x) & (boxes[:, 3] >= y) & (areas != 0)
        near[c] = False
        turns = {k: winding(polygons[k], x, y) for k in np.flatnonzero(near).tolist()}
        outside = sum(turns.values())
        if outside == 0:
            holes[c] = []
        elif outside + np.sign(areas[c]) == 0:
            around[c] = [k for k, times in turns.items() if times]
    for c, those in around.items():
        outer = min((k for k in those if k in holes), key=lambda k: abs(areas[k]), default=None)
        if outer is not None:
            holes[outer].append(c)
    return list(holes.items())


def _written(glyph: GlyphResult, settings: Settings) -> tuple[list[FloatArray], float]:
    """The polygons as they are written, scaled and rounded to decimals, and the bound with that, in the same unit."""
    flatness = settings.flatness_for(glyph.outline.metrics.units_per_em)
    found = to_polylines(glyph, flatness * (1 - RESERVE))
    decimals = max(0, math.ceil(-math.log10(flatness * RESERVE * settings.scale * math.sqrt(2))))
    rounding = 0.5 * 10.0**-decimals * math.sqrt(2)
    polygons = [np.round(polygon * settings.scale, decimals) + 0.0 for polygon in found.polygons]
    # Significant digits of a bound, which is rounded up.
    return polygons, rounded_up(found.bound * settings.scale + rounding, 4)


def _area(polygon: FloatArray) -> float:
    x, y = (polygon - polygon[:1]).T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2


def _middle(polygon: FloatArray) -> tuple[float, float]:
    """The middle of the longest side: contours may share corners."""
    ends = np.roll(polygon, -1, axis=0)
    longest = int(np.hypot(*(ends - polygon).T).argmax())
    x, y = ((polygon[longest] + ends[longest]) / 2).tolist()
    return x, y
