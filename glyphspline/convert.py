"""A glyph's way through the pipeline: an outline in, a :class:`GlyphResult` out."""

from __future__ import annotations

from collections.abc import Iterator

from .arrays import FloatArray
from .errors import GlyphsplineError
from .glyph import ContourResult, GlyphResult, Options
from .outline import Outline

DEFAULTS = Options()


def convert(outline: Outline, options: Options = DEFAULTS) -> GlyphResult:
    """Interpolate every contour of a glyph on its own.

    Contours with fewer than three distinct points enclose nothing and draw nothing; they are left out, and
    ``notes`` of the result says so.

    Raises:
        GlyphsplineError: a contour that cannot be interpolated, or an option out of range; it names glyph and contour.
    """
    # Here and not above, as it brings the compiler with it: the package opens without.
    from .contours import convert_contour

    tolerance = options.tolerance_for(outline.metrics.units_per_em)
    if not tolerance > 0:
        raise GlyphsplineError(f"tolerance is a positive distance, not {tolerance}")
    if options.corners == "sharp" and (options.step is not None or options.count is not None):
        raise GlyphsplineError('step and count sample whole contours, which corners="sharp" cuts: give a tolerance')
    results: list[ContourResult] = []
    notes: list[str] = []
    if options.remove_overlaps:
        from .overlaps import remove_overlaps

        outline, note = remove_overlaps(outline)
        notes += [note] if note else []
    for index, contour in enumerate(outline.contours):
        if not encloses(contour.points):
            notes.append(f"contour {index} has fewer than three distinct points and is left out")
            continue
        try:
            results.append(convert_contour(contour, options, tolerance, outline.metrics.units_per_em))
        except GlyphsplineError as error:
            raise error.locate(glyph=outline.name, contour=index) from error.__cause__
    return GlyphResult(outline, options, tuple(results), (*notes, *remarks(results, tolerance)))


def encloses(points: FloatArray) -> bool:
    """Whether three of the points (n, 2) are distinct."""
    others = points[(points != points[:1]).any(axis=1)]
    return bool((others != others[:1]).any())


def remarks(results: list[ContourResult], tolerance: float) -> Iterator[str]:
    """What a reader has to know: contours out of tolerance, or crossing themselves where their source does not."""
    for index, result in enumerate(results):
        measures = result.measures
        if measures.within_tolerance is False:
            yield f"result contour {index} is certified to {measures.deviation_bound:.3g} units, not to {tolerance:g}"
        if measures.new_crossings:
            yield f"result contour {index} crosses itself, {measures.new_crossings} times more than its source"
