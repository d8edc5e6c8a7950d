"""A glyph's way through the pipeline: an outline in, a :class:`GlyphResult` out."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Literal, overload

from ..errors import GlyphsplineError
from ..outlines.outline import Contour, Outline
from ..types import FloatArray
from .options import Options
from .results import ContourResult, GlyphResult

DEFAULTS = Options()


@overload
def convert_many(
    outlines: Iterable[Outline], options: Options = ..., *, errors: Literal["raise"] = "raise"
) -> list[GlyphResult]: ...
@overload
def convert_many(
    outlines: Iterable[Outline], options: Options = ..., *, errors: Literal["return"]
) -> list[GlyphResult | GlyphsplineError]: ...
def convert_many(
    outlines: Iterable[Outline], options: Options = DEFAULTS, *, errors: Literal["raise", "return"] = "raise"
) -> list[GlyphResult] | list[GlyphResult | GlyphsplineError]:
    """Interpolate every contour of every glyph on its own; the results do not depend on the batch.

    Contours with fewer than three distinct points enclose nothing and draw nothing; they are left out, and
    ``notes`` of the result says so.

    Args:
        outlines: of glyphs. options: for all of them.
        errors: "return" puts the error of a glyph that cannot be converted in its place in the list.

    Raises:
        GlyphsplineError: a contour that cannot be interpolated, or options that contradict each other; it names glyph
            and contour.
    """
    found: list[GlyphResult | GlyphsplineError] = []
    for outline in outlines:
        try:
            found.append(_convert_one(outline, options))
        except GlyphsplineError as error:
            if errors == "raise":
                raise
            found.append(error)
    return found


def convert(outline: Outline, options: Options = DEFAULTS) -> GlyphResult:
    """Interpolate every contour of a glyph on its own: :func:`convert_many` of a batch of one."""
    return convert_many([outline], options)[0]


def _convert_one(outline: Outline, options: Options) -> GlyphResult:
    tolerance = options.tolerance_for(outline.metrics.units_per_em)
    if not tolerance > 0:
        raise GlyphsplineError(f"tolerance is a positive distance, not {tolerance}")
    if options.corners == "sharp" and (options.step is not None or options.count is not None):
        raise GlyphsplineError('step and count sample whole contours, which corners="sharp" cuts: give a tolerance')
    notes: list[str] = []
    if options.remove_overlaps:
        from ..outlines.overlaps import remove_overlaps

        outline, note = remove_overlaps(outline)
        notes += [note] if note else []
    kept = [index for index, contour in enumerate(outline.contours) if encloses(contour.points)]
    for index in sorted(set(range(len(outline.contours))) - set(kept)):
        notes.append(f"contour {index} has fewer than three distinct points and is left out")
    try:
        results = _converted([outline.contours[index] for index in kept], options, tolerance, outline)
    except GlyphsplineError as error:
        error.contour = None if error.contour is None else kept[error.contour]
        raise error.locate(glyph=outline.name) from error.__cause__
    return GlyphResult(outline, options, tuple(results), (*notes, *remarks(results, tolerance)))


def _converted(
    contours: list[Contour], options: Options, tolerance: float, outline: Outline
) -> list[ContourResult]:  # fmt: skip
    """The contours' results; an error's ``contour`` is the index in the list."""
    # Here and not above, as these bring the compiler with them: the package opens without.
    if options.corners == "sharp":
        from .sharp.sharp_contours import convert_sharp

        return convert_sharp(contours, options, tolerance, outline.metrics.units_per_em)
    if options.step is None and options.count is None:
        from .smooth.smooth_fit import convert_smooth

        return convert_smooth(contours, options, tolerance)
    from .fixed_contours import convert_contour

    results: list[ContourResult] = []
    for index, contour in enumerate(contours):
        try:
            results.append(convert_contour(contour, options, tolerance))
        except GlyphsplineError as error:
            error.contour = index
            raise
    return results


def encloses(points: FloatArray) -> bool:
    """Whether three of the points (n, 2) are distinct."""
    if len({tuple(point) for point in points[:4].tolist()}) >= 3:
        return True  # at once, for nearly all contours
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
