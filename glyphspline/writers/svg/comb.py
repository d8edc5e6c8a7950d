"""Curvature combs as they are drawn: their teeth, the scale that drawings share, and a colour for each curvature."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import astuple, dataclass
from math import isfinite

import numpy as np

from ...curves.curvature import ANGLE, Comb, relative, shared_scale
from ...errors import require_choice
from ...fitting.options import Options
from ...fitting.results import GlyphResult
from ...outlines.contour_arrays import ContourArrays
from ...outlines.open_paths import are_open, paths
from ...outlines.sampling import CORNER_ANGLE
from ...types import BoolArray, FloatArray, IntArray, counted
from ..settings import WHOSE, Combs, Whose

SPACING = 1 / 140
"""Maximum spacing of teeth in em. At half of it teeth run together in print; at twice, the tips cut corners."""

MOST_TEETH = 8000
"""Maximum number of teeth; beyond it spacing grows. A CJK glyph has some 2000, a hostile one could have millions."""

TOOTH, LONGEST = 0.03, 2.5
"""Length in em of a tooth at the shared scale. Maximum length of a tooth in units of the scale; shortened teeth have a
mark. Bowls of a source reach 2 (see :func:`glyphspline.curves.curvature.shared_scale`), of a result a little more;
without a limit a single tooth may cross the page."""

NEAR = 1 / 40
"""Distance in em within which a smooth result turns about a corner of the source, and swings out on both sides."""

SOURCE = "#e8590c"
"""Colour of the line through the tips of the source's comb in a map of both."""

COLOURS = (
    "#f44f5d #ec5d4e #e26945 #d77342 #ca7c45 #be844e #b18a5a #929292 "
    "#599cb8 #539ac9 #5796d9 #658fe7 #7986f2 #8f7bf8 #a76ef8"
)
"""Of the classes, in their order; see :func:`palette`."""

SIDES = 7
"""Colour classes on each side of zero. More cannot be distinguished on thin teeth, and each adds a path."""


@dataclass(frozen=True, eq=False)
class Teeth:
    """One contour's comb as drawn, in font units: all arrays in curve order.

    Attributes:
        feet, tips: (k, 2). relative: (k,) curvature in units of the scale, positive where the ink is convex.
        cut: (k,) whether the tooth was shortened.
    """

    feet: FloatArray
    tips: FloatArray
    relative: FloatArray
    cut: BoolArray

    def there_and_back(self) -> Teeth:
        """Those of an open path, twice, so that a line through their tips is closed."""
        return Teeth(*(np.concatenate([each, each[::-1]]) for each in astuple(self)))

    def placed(self, place: Callable[[FloatArray], FloatArray]) -> Teeth:
        """The teeth, moved by a map of points."""
        return Teeth(place(self.feet), place(self.tips), self.relative, self.cut)


def curvature_scale(glyphs: Iterable[GlyphResult]) -> float:
    """The scale, in 1/unit, that maps of these glyphs share: see :func:`glyphspline.curves.curvature.shared_scale`.

    It is that of the sources, so that combs of sources and of all their results compare; a smooth result's turns about
    corners would make it larger. Where all sources are straight it is that of the results.
    """
    every = list(glyphs)
    order: tuple[Whose, ...] = ("source", "result")
    em = every[0].outline.metrics.units_per_em if every else 1.0
    found = (shared_scale((item for glyph in every for item in combs(glyph, whose=whose)), em) for whose in order)
    return next(filter(None, found), 0.0)


def combs(glyph: GlyphResult, density: float = 2.0, whose: Whose = "result") -> list[Comb]:
    """One comb a contour. By default it is twice as dense as in maps, from which the scale can be 15% too large."""
    from ...curves.comb import control_length, sampled  # here and not above: the package opens without a compiler
    from ...outlines.segments import all_cubics

    opened = are_open(curves_of(glyph, whose))
    curves = paths(curves_of(glyph, whose), opened)
    cubics = all_cubics(curves)
    spacing = max(SPACING * glyph.outline.metrics.units_per_em, control_length(cubics) / MOST_TEETH) / density
    samples, starts = sampled(cubics, spacing, ANGLE, 0.0)
    found = []
    for c in np.flatnonzero(np.diff(curves.offsets)).tolist():
        at = starts[curves.offsets[c] : curves.offsets[c + 1] + 1 - int(opened[c])]  # without the line back
        own = samples[at[0] : at[-1]]
        found.append(Comb(own[:, :2], own[:, 2:4], own[:, 4], own[:, 5], at - at[0]))
    return found


def shown_by(combs: Combs) -> Whose:
    """Whose outline and teeth a map shows."""
    require_choice("comb", combs, (*WHOSE, "both"))
    return "source" if combs == "source" else "result"


def legend(combs: Combs, number: int, reach: float, corners: int = 0, largest: float | None = None) -> str:
    """What a map says of its curvature, and of what it does not show of it.

    Args:
        number: of cut teeth. reach: the scale in 1/em. corners: those in whose turn teeth are left out.
        largest: absolute curvature in 1/em, corners included.
    """
    words = f"{' of the source' * (combs == 'source')} in 1/em, convex +{'; dashed: of the source' * (combs == 'both')}"
    words += f"; dots: {number} {'tooth' if number == 1 else 'teeth'} cut at {LONGEST * reach:.3g}" * bool(number)
    words += f"; left out: the teeth in {counted(corners, 'corner')}" * bool(corners)
    if largest is None:
        return words
    return words + (f"; at most {largest:{'.0f' if largest >= 100 else '.3g'}}" if isfinite(largest) else "; unbounded")


def curves_of(glyph: GlyphResult, whose: Whose) -> ContourArrays:
    """The contours whose curvature is shown."""
    require_choice("comb", whose, WHOSE)
    return glyph.arrays.curves if whose == "result" else glyph.arrays.source


def corners_left_out(
    source: ContourArrays, options: Options, whose: Whose, in_corners: bool
) -> tuple[FloatArray, IntArray]:
    """(k, 2) corners in whose turn teeth have no length, (C + 1,) where each contour's begin.

    Only a smooth result turns about a corner. In the source, and in a result with corners, it is a point between two
    curvatures.
    """
    from ...outlines.ink import corner_points  # here and not above: the package opens without a compiler

    turned = whose == "result" and options.corners == "smooth" and not in_corners
    corners: tuple[FloatArray, IntArray] = corner_points(source, float(np.radians(CORNER_ANGLE)) if turned else np.inf)
    return corners


def teeth(glyph: GlyphResult, scale: float, whose: Whose = "result", *, in_corners: bool = False) -> list[Teeth]:
    """Feet and tips of each contour's comb. Teeth point away from the centre of curvature.

    Without ``in_corners`` a result's teeth in the turn of a corner have no length. Those of an open path come there and
    back, so that a line through their tips is closed.
    """
    from ...outlines.ink import ink_sides  # as above

    em, curves = glyph.outline.metrics.units_per_em, curves_of(glyph, whose)
    opened = are_open(curves)
    sides = np.where(opened, 1.0, ink_sides(curves))
    corners, offsets = corners_left_out(glyph.arrays.source, glyph.options, whose, in_corners)
    found = []
    for item, c in zip(combs(glyph, 1.0, whose), np.flatnonzero(np.diff(curves.offsets)).tolist(), strict=True):
        own = teeth_of(item, em, scale, float(sides[c]), corners[offsets[c] : offsets[c + 1]])
        found.append(own.there_and_back() if opened[c] else own)
    return found


def teeth_of(item: Comb, em: float, scale: float, side: float = 1.0, corners: FloatArray | None = None) -> Teeth:
    """Feet and tips of one comb.

    Args:
        side: 1.0 where the ink is to the left of its contour, else -1.0.
        corners: (k, 2) the teeth in whose turn have no length; see :func:`...outlines.ink.turned_about`.
    """
    strength = relative(item.curvature, scale)
    cut = np.abs(strength) > LONGEST
    if corners is not None and len(corners):
        from ...outlines.ink import turned_about  # as above

        hidden = turned_about(corners, item.points, cut, NEAR * em)
        strength[hidden], cut[hidden] = 0.0, False
    shown = np.clip(strength, -LONGEST, LONGEST)
    tips = item.points - (TOOTH * em * shown)[:, None] * item.normals
    return Teeth(item.points, tips, side * strength, cut)


def colour_classes(relative: FloatArray) -> IntArray:
    """Class -SIDES to SIDES of curvature in units of the scale; ±1 and all beyond are the outermost."""
    return np.clip(np.rint(relative * SIDES), -SIDES, SIDES).astype(np.int64)


def palette() -> list[str]:
    """The colours "#rrggbb" of the classes, from the most concave ink to the most convex; 0 is grey.

    Their OKLCh lightness is 0.66: contrast of about 3:1 with white and 6:1 with black, so both themes can show them.
    Chroma grows from 0.06 to 0.2. Hues run from green-blue (215°) to violet (300°) where the ink is convex, from yellow
    (80°) to red (20°) where it is concave.
    """
    return COLOURS.split()
