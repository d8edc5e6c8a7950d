"""A glyph as a font stores it, with its error: points at extrema, whole units or, where too coarse, CFF fractions."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import chain, pairwise
from typing import Any, Literal

import numpy as np
from fontTools.misc.roundTools import otRound
from fontTools.pens.boundsPen import BoundsPen
from fontTools.pens.cu2quPen import Cu2QuPen
from fontTools.pens.t2CharStringPen import T2CharStringPen
from fontTools.pens.ttGlyphPen import TTGlyphPen, TTGlyphPointPen
from fontTools.ttLib import TTFont
from fontTools.ttLib.tables import ttProgram
from fontTools.ttLib.tables._g_l_y_f import Glyph, GlyphCoordinates, flagOnCurve, flagOverlapSimple

from ....curves.bezier import as_cubic
from ....curves.integrals import area
from ....errors import GlyphsplineError
from ....fitting.options import Options
from ....fitting.results import GlyphResult
from ....outlines.open_paths import are_open
from ....outlines.outline import Contour, Outline
from ....types import BoolArray, FloatArray, IntArray
from ..extrema import extremal_pieces
from ..read_back import Promise

Flavour = Literal["otf", "ttf"]

ROUNDING = math.sqrt(0.5)
"""Largest distance by which rounding to whole units moves a control point, and so, by convexity, the curve."""

FINE = 65536
"""Parts of a unit to which CFF coordinates are rounded where whole units would break the tolerance: all that the
format's 16.16 fixed point has. Fewer would turn stretches that stay as a source has them, where handles are short."""

SHARE = 0.2
"""Of the tolerance: what curves may use that quadratics are made of, and the least that these have. With 0.5 they have
a tenth more points, in 4 faces, and the grid sometimes none near enough."""

GRID = 1e-6
"""Distance from whole units, in font units, up to which coordinates are whole but for rounding errors."""

FONTS = Options(corners="sharp", continuity="g2")
"""How outlines that were not converted become quadratics."""

LIMIT = 32767
"""Largest coordinate of a font."""


@dataclass(frozen=True)
class Drawn:
    """A glyph ready to be stored: ``data`` for the table, and its bounds.

    ``promise`` is None if the conversion measured no distance. ``extrema`` is the number of points added at extrema.
    """

    data: Any
    bounds: tuple[float, float, float, float] | None
    promise: Promise | None
    extrema: int = 0


def fitting_tolerance(tolerance: float, flavour: Flavour) -> float:
    """Tolerance for the fit such that the written font stays within ``tolerance``.

    An OTF has fractions, so almost nothing is subtracted; if the tolerance is too small for those, the fit has half of
    it, and glyphs are reported as beyond it. For a TTF quadratics on the grid take the most.
    """
    left = tolerance - ROUNDING / FINE if flavour == "otf" else SHARE * tolerance
    return left if left > 0 else tolerance / 2


def drawn_result(
    result: GlyphResult, tolerance: float, flavour: Flavour, width: float | None, extrema: bool = True,
    in_place: bool = False,
) -> Drawn:  # fmt: skip
    """A converted glyph within ``tolerance`` of its source; ``width`` is for :func:`char_string`.

    Quadratics have as few points as follow the result; with continuity "g2" the source itself, of which what need not
    change stays. With these a glyph written ``in_place`` of a TrueType glyph keeps its directions, which composites
    rely on. In CFF, with ``extrema``, points are added at extrema, but not where rounding them moves a segment farther
    than the tolerance leaves room for and than rounding it whole does.
    """
    outline, g2 = result.outline, result.options.is_for_fonts
    if refused := open_path(outline):
        raise refused
    name, em = outline.name, outline.metrics.units_per_em
    measured = [contour.measures.deviation_bound or contour.measures.deviation for contour in result.contours]
    known = None not in measured
    deviation = max((value for value in measured if value is not None), default=0.0)
    # Measured are curves as they are rounded to the precision, which are not what is stored.
    rounding = 0.0 if g2 else ROUNDING * 10.0**-result.options.precision
    room = max(tolerance - deviation - rounding, 0.0) if known else math.inf
    if flavour == "ttf" and g2:
        contours = list(outline.contours) if in_place else oriented(outline.contours, flavour)
        data = in_quadratics(contours, result.options, tolerance, em, name)
        return Drawn(data, bounds_of(data, []), Promise(outline, tolerance))
    exact = oriented([contour.curve for contour in result.contours], flavour)
    split = [extremal_pieces(c, em) if extrema and not g2 else [[part] for part in c.segments()] for c in exact]
    if flavour == "ttf":
        contours = [Contour.from_segments(chain.from_iterable(pieces)) for pieces in split]
        near = max(room if known else 0.0, SHARE * tolerance)
        data = in_quadratics(contours, result.options, near, em, name)
    else:

        def rounded(parts: int) -> tuple[list[Contour], float]:
            contours = [chosen(*each, parts, room) for each in zip(exact, split, strict=True)]
            return contours, displacement(chain.from_iterable(map(as_stored, contours)), parts)

        contours, error = rounded(1)
        # On the grid already, but for stretches that stay as a source has them that is not.
        parts = 1 if error <= (GRID if g2 else room) else FINE
        if parts == FINE:
            contours, _ = rounded(FINE)
        data = char_string(contours, width, parts, name)
    added = sum(map(len, contours)) - sum(map(len, exact))
    return Drawn(data, bounds_of(data, contours), Promise.of(result, tolerance), added)


def open_path(outline: Outline) -> GlyphsplineError | None:
    """The error of an outline with open paths, which neither an OTF nor a TTF has."""
    which = np.flatnonzero(are_open(outline.arrays)).tolist()
    words = "an open path, which fonts would fill or not draw"
    return GlyphsplineError(words, glyph=outline.name, contour=which[0]) if which else None


def stays(result: GlyphResult, flavour: Flavour) -> bool:
    """Whether a glyph keeps its record: in CFF, an outline that is the source's still; in glyf, one of quadratics with
    points off the grid, as a scaled component has them.
    """
    source, made = result.outline.arrays, result.arrays.curves
    if not result.options.is_for_fonts:
        return False
    if flavour == "otf":
        return np.array_equal(source.degrees, made.degrees) and np.array_equal(source.points, made.points)
    whole = np.abs(2 * source.points - np.rint(2 * source.points)).max(initial=0.0) <= GRID
    return bool((source.degrees < 3).all()) and not whole


def chosen(contour: Contour, split: Sequence[list[FloatArray]], parts: int, room: float) -> Contour:
    """The contour with its segments in pieces, or whole where rounding moves these too far, and farther than those."""
    if room >= ROUNDING / parts:
        return Contour.from_segments(chain.from_iterable(split))
    found: list[FloatArray] = []
    for segment, pieces in zip(contour.segments(), split, strict=True):
        near = len(pieces) == 1 or displacement(pieces, parts) <= max(room, displacement([segment], parts))
        found += pieces if near else [segment]
    return Contour.from_segments(found)


def displacement(segments: Iterable[FloatArray], parts: int) -> float:
    """Largest distance by which rounding to multiples of 1/``parts`` moves control points and so, by convexity, curves.

    It is at most ``ROUNDING / parts``.
    """
    points = np.concatenate([np.empty((0, 2)), *segments])
    return float(np.hypot(*(on_grid(points, parts) - points).T).max(initial=0.0))


def on_grid(points: FloatArray, parts: int) -> FloatArray:
    """Points with coordinates in multiples of 1/``parts``."""
    return np.rint(parts * points) / parts + 0.0


def drawn_outline(outline: Outline, flavour: Flavour) -> Drawn:
    """The source outline of a glyph that was not converted, in the other format."""
    contours, em = oriented(outline.contours, flavour), outline.metrics.units_per_em
    if flavour == "otf":
        data = char_string(contours, round(outline.advance), 1, outline.name)
    elif (outline.arrays.degrees < 3).all():
        data = cut_alone(contours, 0.0, outline.name)
    else:
        data = in_quadratics(contours, FONTS, em / 1000, em, outline.name)
    return Drawn(data, bounds_of(data, contours), None)


def oriented(contours: Sequence[Contour], flavour: Flavour) -> list[Contour]:
    """The contours, all reversed if the ink lies on the wrong side of them.

    The total signed area is positive in CFF, which fills the left side, and negative in TrueType.
    """
    total = sum(area(contour.cubics()) for contour in contours)
    wrong = total < 0 if flavour == "otf" else total > 0
    return [contour.reversed() if wrong else contour for contour in contours]


def char_string(contours: Sequence[Contour], width: float | None, parts: int, name: str) -> Any:
    """A Type 2 char string with coordinates in multiples of 1/``parts`` unit; ``width`` is stored as given."""
    pen = T2CharStringPen(width, None, roundTolerance=0.5 if parts == 1 else 0)  # ints are shorter than floats
    raised = [Contour.from_segments(segments) for segments in map(as_stored, contours)]
    stored = [Contour(on_grid(contour.points, parts), contour.degrees) for contour in raised]
    check_size([point for contour in stored for point in (*contour.points, contour.points[0])], name)
    for contour in stored:
        contour.draw(pen, closing=False, stays_open=False)
    return pen.getCharString(optimize=not any(map(doubles_back, stored)))


def as_stored(contour: Contour) -> list[FloatArray]:
    """The segments as CFF has them: lines, (2, 2), and cubics, (4, 2)."""
    return [part if len(part) == 2 else as_cubic(part) for part in contour.segments()]


def doubles_back(contour: Contour) -> bool:
    """Whether a line goes back over the one before it: the char string optimiser would merge the two."""
    starts = contour.points[contour.offsets]
    arms = np.roll(starts, -1, axis=0) - starts
    lines = contour.degrees == 1
    before = np.roll(arms, 1, axis=0)
    opposite = ((arms * before).sum(axis=1) < 0) & (arms[:, 0] * before[:, 1] == arms[:, 1] * before[:, 0])
    return bool((opposite & lines & np.roll(lines, 1)).any())


def in_quadratics(contours: Sequence[Contour], options: Options, tolerance: float, em: float, name: str) -> Glyph:
    """A glyph as quadratics with as few points as follow its contours, within ``tolerance`` if the grid has them.

    Contours of lines and quadratics keep what need not change. Where whole units do not have others near enough, each
    cubic becomes some by itself.
    """
    from ..fit.points import quadratic_points  # compiles more than others need

    arrays = Outline(name, contours=[each for each in contours if len(each)]).arrays
    check_size(arrays.points.tolist(), name)
    found, distance = quadratic_points(arrays, options, tolerance, em)
    exact = np.concatenate([np.empty((0, 2)), *(points for points, _ in found)])
    points = np.rint(exact).astype(np.int64)  # whole but for rounding errors: cut off, one just below would move by 1
    if distance + np.hypot(*(points - exact).T).max(initial=0.0) > tolerance:
        return cut_alone(contours, max(tolerance - ROUNDING, SHARE * tolerance / 2), name)
    check_size(points.tolist(), name)
    on = np.concatenate([np.empty(0, dtype=np.bool_), *(on for _, on in found)])
    return simple_glyph(points, on, (np.cumsum([len(on) for _, on in found]) - 1).tolist(), False)


def cut_alone(contours: Sequence[Contour], step: float, name: str) -> Glyph:
    """A TrueType glyph in which each cubic is some quadratics by itself, within ``step`` before these are rounded."""
    collected = TTGlyphPen(None)
    pen = Cu2QuPen(collected, step, all_quadratic=True)
    for contour in contours:
        contour.draw(pen, stays_open=False)
    check_size(collected.points, name)
    # What is equal but for rounding errors rounds alike: a handle and its point at an extremum half a unit from whole.
    points = np.floor(np.round(np.array(collected.points, dtype=np.float64).reshape(-1, 2), 6) + 0.5).astype(np.int64)
    on, parts = np.array(collected.types, dtype=np.bool_), np.split(np.arange(len(points)), np.add(collected.endPts, 1))
    kept = [own for part in parts[:-1] if len(own := part[distinct(points[part], on[part])])]
    which = np.concatenate([np.empty(0, dtype=np.int64), *kept])
    return simple_glyph(points[which], on[which], (np.cumsum([len(own) for own in kept]) - 1).tolist(), False)


def distinct(points: IntArray, on: BoolArray) -> IntArray:
    """The points of a contour without those that rounding put on the one before or, off the curve, on a neighbour."""
    which = np.arange(len(points))
    while len(which) > 1:
        same = (points[which] == points[np.roll(which, 1)]).all(axis=1)
        own, before = on[which], on[np.roll(which, 1)]
        gone = (same & before) | np.roll(same & own & ~before, -1)
        if not gone.any():
            break
        if gone[0] and own[0]:  # a contour begins where it did
            gone[0], gone[-1] = False, True
        which = which[:1] if gone.all() else which[~gone]
    return which


def simple_glyph(points: IntArray, on: BoolArray, ends: list[int], overlap: bool) -> Glyph:
    """A glyph without instructions."""
    glyph = Glyph()
    glyph.numberOfContours = len(ends)
    if not ends:
        return glyph
    glyph.coordinates = GlyphCoordinates(points.tolist())
    glyph.flags = bytearray((on * flagOnCurve).astype(np.uint8).tobytes())
    if overlap:
        glyph.flags[0] |= flagOverlapSimple
    glyph.endPtsOfContours = ends
    glyph.program = ttProgram.Program()
    glyph.program.fromBytecode(b"")
    return glyph


def check_size(points: Sequence[Any], name: str) -> None:
    """Refuse coordinates that a font cannot hold; it stores steps from point to point."""
    if len(points) and max(np.abs(points).max(), np.abs(np.diff(points, axis=0, prepend=0.0)).max()) > LIMIT:
        raise GlyphsplineError(f"coordinates beyond {LIMIT} do not fit into a font", glyph=name)


def bounds_of(data: Any, contours: Sequence[Contour]) -> tuple[float, float, float, float] | None:
    """The box around a stored glyph, in whole units."""
    if hasattr(data, "coordinates"):
        data.recalcBounds(None)
        return (data.xMin, data.yMin, data.xMax, data.yMax) if data.numberOfContours else None
    pen = BoundsPen(None)
    for contour in contours:
        contour.draw(pen)
    return pen.bounds and tuple(map(otRound, pen.bounds))


def below(font: TTFont, name: str) -> list[str]:
    """A glyph of ``glyf`` and its components at any depth, in order, each once."""
    glyf, known, waiting = font["glyf"], dict[str, None](), [name]
    while waiting:
        name = waiting.pop()
        if name not in known:
            known[name] = None
            waiting += reversed(glyf[name].getComponentNames(glyf))
    return [*known]


def users(font: TTFont, parts: Iterable[str]) -> list[str]:
    """Glyphs of ``glyf`` that are among ``parts``, or have a component among them at any depth; in the font's order."""
    known = {*parts}
    return [name for name in font.getGlyphOrder() if not known.isdisjoint(below(font, name))]


def drop_endless(font: TTFont) -> None:
    """Empty the composites of ``glyf`` that no font can have, and that fontTools would measure for ever.

    Their components are in a loop, do not exist, or with their points are more than 65,535.
    """
    glyf, known = font["glyf"], dict[str, float]()

    def size(name: str, above: tuple[str, ...]) -> float:
        if name in above or len(above) > 64 or name not in glyf.glyphs:
            return math.inf
        if name not in known:
            parts = glyf[name].getComponentNames(glyf)
            count = len(getattr(glyf[name], "coordinates", ()))
            known[name] = count + sum(1 + size(part, (*above, name)) for part in parts)
        return known[name]

    for name in font.getGlyphOrder():
        if glyf[name].isComposite() and size(name, ()) > 0xFFFF:
            glyf[name] = Glyph()


def put_string(strings: Any, name: str, new: Any) -> None:
    """Put a char string into the place of another."""
    if strings.charStringsAreIndexed:
        strings.charStringsIndex[strings.charStrings[name]] = new
    else:
        strings[name] = new


def scales(font: TTFont, name: str, known: dict[str, dict[str, float]] | None = None) -> dict[str, float]:
    """The simple glyphs that a glyph of ``glyf`` is made of, and how much each, and its distances, are enlarged.

    Args:
        known: of glyphs that were asked for before, and now of this one.
    """
    known, glyph, found = {} if known is None else known, font["glyf"][name], dict[str, float]()
    if name in known:
        return known[name]
    for part in glyph.components if glyph.isComposite() else ():
        own = float(np.linalg.norm(part.transform, ord=2)) if hasattr(part, "transform") else 1.0
        for each, scale in scales(font, part.glyphName, known).items():
            found[each] = max(found.get(each, 0.0), own * scale)
    known[name] = found if glyph.isComposite() else {name: 1.0}
    return known[name]


def enlarged(font: TTFont) -> dict[str, float]:
    """How much simple glyphs of ``glyf`` are enlarged at most by composites, of those that are."""
    found, known = dict[str, float](), dict[str, dict[str, float]]()
    for name in font.getGlyphOrder():
        if font["glyf"].glyphs[name].isComposite():  # others are not read
            parts = scales(font, name, known).items()
            found |= {part: max(scale, found.get(part, 1.0)) for part, scale in parts if scale > 1}
    return found


def parts_of(font: TTFont, name: str) -> list[str]:
    """The simple glyphs that a glyph of ``glyf`` is made of, in order, each once; itself if it is simple."""
    return [part for part in below(font, name) if not font["glyf"][part].isComposite()]


def decomposed(glyf: Any, name: str) -> Any:
    """A composite as a simple glyph whose contours begin on the curve, where they touch it."""
    points, ends, flags = glyf[name].getCoordinates(glyf)[:3]
    pen = TTGlyphPointPen(None)
    for start, stop in pairwise([0, *(end + 1 for end in ends)]):
        first = next((i for i in range(start, stop) if flags[i] & 1), start)
        pen.beginPath()
        for i in (*range(first, stop), *range(start, first)):
            pen.addPoint(points[i], "line" if flags[i] & 1 else None)
        pen.endPath()
    return pen.glyph()
