"""From outlines to results, in batches; a single glyph is a batch of one."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any, Literal, overload

import numpy as np

from .. import hooks
from ..errors import GlyphsplineError
from ..outlines.contour_arrays import ContourArrays, joined, offsets_of
from ..outlines.open_paths import are_open, by_kind
from ..outlines.outline import Outline
from ..types import BoolArray, IntArray, counted, rounded_up
from .options import Options
from .results import NOTHING, ContourResults, ConvertedContours, GlyphResult, MeasureColumns, as_glyphs, assembled

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
    ``notes`` of the result says so. Open paths stay open, with their corners in every mode.

    Args:
        outlines: of glyphs. options: for all of them.
        errors: "return" puts the error of a glyph that cannot be converted in its place in the list.

    Raises:
        GlyphsplineError: a contour that cannot be interpolated, or options that contradict each other; it names glyph
            and contour.

    Example:
        >>> from glyphspline import Options, convert_many, open_font
        >>> font = open_font("fonts_test/kouzan-gyosho.ttf")
        >>> for glyph in convert_many(font.outlines(font.select(text="gO")), Options(count=24)):
        ...     print(glyph)
        <GlyphResult 'g': 4 contours, 96 vertices, 96 segments>
        <GlyphResult 'O': 2 contours, 48 vertices, 48 segments>
    """
    glyphs = list(outlines)
    try:
        return _convert_batch(glyphs, options)
    except GlyphsplineError:
        if errors == "raise":
            raise
        return [_attempt(outline, options) for outline in glyphs]


def convert(outline: Outline, options: Options = DEFAULTS) -> GlyphResult:
    """Interpolate every contour of a glyph on its own: :func:`convert_many` of a batch of one.

    Args:
        outline: of the glyph. options: how it is converted.

    Raises:
        GlyphsplineError: as for :func:`convert_many`.

    Example:
        >>> from glyphspline import Options, convert, open_font
        >>> outline = open_font("fonts_test/kouzan-gyosho.ttf").outline("O")
        >>> outline
        <Outline 'O' gid 6 U+004F: 2 contours, 47 segments, advance 515, 1024 units per em>
        >>> glyph = convert(outline, Options(tolerance=2.0))
        >>> all(contour.measures.within_tolerance for contour in glyph.contours)
        True
    """
    return _convert_batch([outline], options)[0]


def unfitted(outlines: Sequence[Outline], options: Options = DEFAULTS) -> list[GlyphResult | GlyphsplineError]:
    """The outlines as results whose curves are their own contours, overlaps removed if the options say so.

    The error of an outline that cannot be united is in its place.
    """
    if not options.remove_overlaps:
        return list(as_glyphs(outlines, options))
    found: list[GlyphResult | GlyphsplineError] = []
    for outline in outlines:
        try:
            united, notes = _united(outline)
            found += [replace(result, notes=tuple(notes)) for result in as_glyphs([united], options)]
        except GlyphsplineError as error:
            found.append(error)
    return found


def _united(outline: Outline) -> tuple[Outline, list[str]]:
    """The outline without overlaps, and what there is to say of them."""
    from ..outlines.overlaps import remove_overlaps

    united, note = remove_overlaps(outline)
    return united, [note] if note else []


def _attempt(outline: Outline, options: Options) -> GlyphResult | GlyphsplineError:
    try:
        return convert(outline, options)
    except GlyphsplineError as error:
        return error


def _convert_batch(glyphs: list[Outline], options: Options) -> list[GlyphResult]:
    """Convert glyphs of one tolerance at a time: it depends on the em, and on what the reader took of it."""
    given = [_united(outline) if options.remove_overlaps else (outline, []) for outline in glyphs]
    alike: dict[tuple[float, float], list[int]] = {}
    for k, (outline, _) in enumerate(given):
        # Set aside of the tolerance, in font units: what the reader snapped, or at least more than readers of fonts do,
        # so that most outlines are converted together.
        reserve = max(outline.snapped, 0.0015) if outline.snapped else 0.0
        alike.setdefault((outline.metrics.units_per_em, reserve), []).append(k)
    results: dict[int, GlyphResult] = {}
    for (em, reserve), those in alike.items():
        outlines, notes = zip(*(given[k] for k in those), strict=True)
        results |= zip(those, _convert_alike(outlines, notes, options.for_em(em), em, reserve), strict=True)
    return [results[k] for k in range(len(glyphs))]


def _convert_alike(
    glyphs: Sequence[Outline], notes: Sequence[list[str]], options: Options, em: float, reserve: float
) -> list[GlyphResult]:
    """Convert glyphs whose em is ``em``, all contours end to end; ``reserve`` of the tolerance is set aside."""
    tolerance = options.tolerance_for(em)
    given = joined([outline.arrays for outline in glyphs])
    before = offsets_of([len(outline.contours) for outline in glyphs])
    opened = are_open(given)
    kept, owners = enclosing(given) | opened, np.repeat(np.arange(len(glyphs)), np.diff(before))
    for index in np.flatnonzero(~kept).tolist():
        k = owners[index]
        notes[k].append(f"contour {index - before[k]} has fewer than three distinct points and is left out")
    for k in np.unique(owners[opened]).tolist():
        notes[k].append(f"{counted(int(opened[before[k] : before[k + 1]].sum()), 'open path')}, drawn as strokes")
    which = np.flatnonzero(kept)
    try:
        ends = np.searchsorted(which, before)
        contours = given.chosen(which.tolist())
        found = _convert_contours(contours, opened[which], ends, options, max(tolerance - reserve, tolerance / 2), em)
    except GlyphsplineError as error:
        k = 0
        if error.contour is not None:
            index = which[error.contour]
            k = owners[index]
            error.contour = int(index - before[k])
        raise error.locate(glyph=glyphs[k].name) from error.__cause__
    if reserve and "deviation_bound" in found.measures:
        from .measures import distance_columns  # imports the compiler

        snapped = np.repeat([outline.snapped for outline in glyphs], np.diff(ends)).tolist()
        bounds = [a + b for a, b in zip(found.measures["deviation_bound"], snapped, strict=True)]
        columns = distance_columns(found.measures["deviation"], bounds, tolerance)
        found = replace(found, measures={**found.measures, **columns})
    results = []
    for outline, (first, last), said in zip(glyphs, pairwise(ends.tolist()), notes, strict=True):
        own = ContourResults(found, first, last)
        results.append(GlyphResult(outline, options, own, (*said, *remarks(found.measures, first, last, tolerance))))
    return results


def _convert_contours(
    contours: ContourArrays, opened: BoolArray, glyphs: IntArray, options: Options, tolerance: float, em: float
) -> ConvertedContours:
    """Fit contours, those that are ``opened`` as paths; ``glyphs``: (G + 1,) where those of each glyph begin."""
    if not opened.any():
        return _convert_closed(contours, glyphs, options, tolerance, em)
    from .open_paths import convert_open  # imports the compiler

    chosen: dict[int, tuple[ConvertedContours, int]] = {}
    for which, ends in by_kind(opened, glyphs):
        own = contours.chosen(which)
        try:
            if len(which) and opened[which[0]]:
                found = convert_open(own, options, tolerance, em)
            else:
                found = _convert_closed(own, ends, options, tolerance, em)
        except GlyphsplineError as error:
            error.contour = None if error.contour is None else int(which[error.contour])
            raise
        chosen |= {c: (found, k) for k, c in enumerate(which.tolist())}
    return assembled([chosen[c] for c in range(len(chosen))])


def _convert_closed(
    contours: ContourArrays, glyphs: IntArray, options: Options, tolerance: float, em: float
) -> ConvertedContours:
    """Fit closed contours in the mode of the options; an error's ``contour`` is the index."""
    # Imported here because these import the compiler, which the package itself does not need.
    if contours.num_contours == 0:
        return NOTHING
    from .closed_curves import convert_fixed
    from .faithful import Fits, faithful
    from .measures import check_coordinates
    from .traces import calming

    check_coordinates(contours, np.inf if options.is_fixed else tolerance)
    if options.is_fixed and not options.measure:
        return convert_fixed(contours, options, tolerance)
    if options.is_fixed:
        fits = Fits(1, lambda given, _: convert_fixed(given, options, tolerance), keeps_collapsed=False)
    elif options.is_for_fonts:
        fits = calming(lambda near: hooks.service("g2_fits")(options, near, em), contours, options, tolerance)
    else:
        from .sharp.sharp_fit import sharp_fits
        from .smooth.smooth_fit import smooth_fits

        sharp = calming(lambda near: sharp_fits(options, near, em), contours, options, tolerance)
        if options.corners == "sharp":
            fits = sharp
        else:
            fits = calming(lambda near: smooth_fits(options, near), contours, options, tolerance)
            fits = fits._replace(instead=sharp if options.hold_corners else None)
    return faithful(contours, glyphs, fits, options, tolerance)


def enclosing(contours: ContourArrays) -> BoolArray:
    """(C,) whether three of a contour's points are distinct."""
    if len(contours.points) == 0:
        return np.zeros(contours.num_contours, dtype=np.bool_)
    first = contours.points.take(contours.starts[:-1, None] + np.arange(3), axis=0, mode="wrap")  # mostly enough
    kept: BoolArray = (first != first[:, [1, 2, 0]]).any(axis=2).all(axis=1) & (np.diff(contours.starts) >= 3)
    for c in np.flatnonzero(~kept).tolist():
        points = contours.points[contours.starts[c] : contours.starts[c + 1]]
        others = points[(points != points[:1]).any(axis=1)]
        kept[c] = bool((others != others[:1]).any())
    return kept


def remarks(measures: MeasureColumns, first: int, last: int, tolerance: float) -> Iterator[str]:
    """Remarks on the contours from ``first`` up to ``last`` that miss the tolerance, or enclose something else."""

    def column(name: str) -> Iterator[tuple[int, Any]]:
        return enumerate(measures.get(name, ())[first:last])

    for (contour, within), (_, bound) in zip(column("within_tolerance"), column("deviation_bound"), strict=True):
        if within is False:
            yield f"result contour {contour} is certified to {rounded_up(bound, 3):.3g} units, not to {tolerance:g}"
    for (contour, crossings), (_, collapsed) in zip(column("new_crossings"), column("collapsed"), strict=True):
        if crossings:
            yield f"result contour {contour} crosses itself or others, {crossings} times more than its source"
        elif crossings is None and collapsed is not None:  # of open paths neither is known
            yield f"crossings of result contour {contour} are not counted: too many strands lie on each other"
    for contour, collapsed in column("collapsed"):
        if collapsed:
            yield f"result contour {contour} has lost its area, or runs the other way round than its source"
    for contour, kept in column("corners_kept"):
        if kept:
            yield f"result contour {contour} keeps its corners: a smooth curve there crosses itself or others"
    for contour, kept in column("source_kept"):
        if kept:
            yield f"result contour {contour} is the source's own: its fits cross or lose their area"
