"""A text laid out: which glyphs stand where, and their results and outlines put there."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import sqrt

import numpy as np

from ..errors import GlyphsplineError
from ..fitting.convert import DEFAULTS, convert_many
from ..fitting.options import Options
from ..fitting.results import ContourResults, GlyphResult, end_to_end
from ..outlines.contour_arrays import ContourArrays, joined, offsets_of
from ..outlines.outline import Contours, FontMetrics, Outline
from ..readers import Source
from ..types import FloatArray, IntArray, counted
from .moved import Motion, moved_contours, moved_results, ranges

NAME = "text"
"""The name of a text's outline."""


@dataclass(frozen=True, eq=False)
class Layout:
    """A text laid out: n glyphs in visual order, line by line. Lengths are in font units of the first font, y is up.

    Attributes:
        text: what is laid out. fonts: the first, and those that stand in for glyphs it lacks.
        font: (n,) which of the fonts a glyph is of. gid: (n,) its index in that font.
        cluster: (n,) number of the first character of the text that the glyph stands for.
        line: (n,) which line it is on.
        origin: (n, 2) where its origin lies; the first baseline is at y = 0 and begins at x = 0.
        angle: (n,) radians by which it is turned about its origin, counter-clockwise.
        advance: (n,) length of the line that it takes.
        box: left, bottom, right, top of the lines' boxes, from descender to ascender.
        missing: characters without a glyph, each once, in the order of the text: the first font's .notdef stands there.
        scale: (n,) by which the glyph is enlarged: units of the first font per unit of its own. None: all by 1.
        notes: remarks, such as that a source has no tables for shaping.
    """

    text: str
    fonts: tuple[Source, ...]
    font: IntArray
    gid: IntArray
    cluster: IntArray
    line: IntArray
    origin: FloatArray
    angle: FloatArray
    advance: FloatArray
    box: tuple[float, float, float, float]
    missing: tuple[str, ...] = ()
    scale: FloatArray | None = None
    notes: tuple[str, ...] = ()

    def __repr__(self) -> str:
        said = f"{self.text[:24]}…" if len(self.text) > 25 else self.text
        lines = counted(int(self.line[-1]) + 1 if len(self) else 0, "line")
        left, bottom, right, top = self.box
        size = f"{right - left:g} by {top - bottom:g} units"
        lacking = f", {counted(len(self.missing), 'character')} without a glyph" if self.missing else ""
        return f"<Layout {said!r}: {counted(len(self), 'glyph')}, {lines}, {size}{lacking}>"

    def __len__(self) -> int:
        return len(self.gid)

    @cached_property
    def _distinct(self) -> tuple[IntArray, IntArray]:
        """(k, 2) font and index of the distinct glyphs; (n,) which of them each placed glyph is."""
        pairs, which = np.unique(np.stack([self.font, self.gid], axis=1).reshape(-1, 2), axis=0, return_inverse=True)
        return pairs, which.reshape(-1)

    def distinct(self) -> list[tuple[int, int]]:
        """Font and glyph index of each glyph, once however often it stands in the text, in ascending order."""
        return [(font, gid) for font, gid in self._distinct[0].tolist()]

    def outlines(self) -> list[Outline | GlyphsplineError]:
        """The outlines of :meth:`distinct`, in units of the first font; an error in place of each broken glyph."""
        found: list[Outline | GlyphsplineError] = []
        pairs = self._distinct[0]
        metrics = self.fonts[0].metrics
        for k in np.unique(pairs[:, 0]).tolist():
            scale = metrics.units_per_em / self.fonts[k].metrics.units_per_em
            read = self.fonts[k].outlines(pairs[pairs[:, 0] == k, 1].tolist(), errors="return")
            found += read if scale == 1.0 else [_scaled(outline, scale, metrics) for outline in read]
        return found

    def outline(self) -> Outline:
        """The text as one outline named "text", in units of the first font; broken glyphs are left out, with a note.

        ``advance`` is the width of the box, ascender and descender are its top and bottom.
        """
        found = [outline if isinstance(outline, Outline) else Outline("") for outline in self.outlines()]
        return self._as_outline(joined([o.arrays for o in found]), offsets_of([len(o.contours) for o in found]))

    def convert(self, options: Options = DEFAULTS) -> GlyphResult:
        """Interpolate the text: each distinct glyph is fitted once, and its result moved into place.

        The measures of a contour are those of its glyph: crossings of different glyphs are not counted. Where a glyph
        is turned, or moved by other than whole units of the last digit written, rounding moves it once more: so much is
        set aside of the tolerance, and is in ``deviation_bound``.

        Args:
            options: for all glyphs.

        Returns:
            One result of all contours, in the order of the glyphs. Its outline is :meth:`outline`; what cannot be read
            or converted is left out, and ``notes`` says so.

        Raises:
            OptionError: options that contradict each other.
        """
        read, notes = self.outlines(), list(self.notes)
        if self._rounded_anew(options.precision):
            moved = sqrt(2.0) * 10.0**-options.precision
            read = [replace(o, snapped=o.snapped + moved) if isinstance(o, Outline) else o for o in read]
        whole = [outline if isinstance(outline, Outline) else Outline("") for outline in read]
        converted = convert_many(whole, options, errors="return")
        glyphs = []
        for outline, source, result in zip(read, whole, converted, strict=True):
            failed = next((found for found in (outline, result) if isinstance(found, GlyphsplineError)), None)
            if failed is not None or not isinstance(result, GlyphResult):
                notes.append(f"left out: {failed}")
                result = GlyphResult(replace(source, contours=()), options, ())
            notes += [f"glyph {source.name!r}: {note}" for note in (*source.notes, *result.notes)]
            glyphs.append(result)
        found, ends = end_to_end(glyphs)
        which, motion = self._contours(ends)
        results = moved_results(found, which, motion)
        outline = replace(self._as_outline(found.source, ends), notes=())
        return GlyphResult(outline, options, ContourResults(results), tuple(notes))

    def _contours(self, ends: IntArray) -> tuple[IntArray, Motion]:
        """Which contours stand in the text, glyph by glyph, and how each is moved; ``ends`` as of offsets."""
        which = self._distinct[1]
        counts = np.diff(ends)[which]
        motion = Motion(self.origin, self.angle).repeated(counts)
        return ranges(ends[:-1][which], counts), motion

    def _as_outline(self, contours: ContourArrays, ends: IntArray) -> Outline:
        which, motion = self._contours(ends)
        left, bottom, right, top = self.box
        metrics = FontMetrics(self.fonts[0].metrics.units_per_em, top, bottom)
        return Outline(
            NAME, advance=right - left, contours=Contours(moved_contours(contours, which, motion)), metrics=metrics
        )

    def _rounded_anew(self, precision: int) -> bool:
        """Whether coordinates with so many decimals are not such any more where glyphs are put."""
        steps = self.origin * 10.0**precision
        quarters = self.angle * (2.0 / np.pi)
        return any(bool(np.abs(values - np.round(values)).max(initial=0.0) > 1e-6) for values in (steps, quarters))


def _scaled(outline: Outline | GlyphsplineError, scale: float, metrics: FontMetrics) -> Outline | GlyphsplineError:
    if isinstance(outline, GlyphsplineError):
        return outline
    arrays = outline.arrays._replace(points=outline.arrays.points * scale)
    advance, snapped = outline.advance * scale, outline.snapped * scale
    return replace(outline, advance=advance, snapped=snapped, contours=Contours(arrays), metrics=metrics)
