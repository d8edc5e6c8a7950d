"""A text laid out: which glyphs are where, and their results and outlines moved there."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import sqrt
from typing import TypeAlias

import numpy as np

from ...errors import GlyphsplineError
from ...fitting.convert import DEFAULTS, convert_many
from ...fitting.options import Options
from ...fitting.results import ContourResults, GlyphResult, as_glyphs, joined_results
from ...outlines.contour_arrays import ContourArrays, joined, members_of, offsets_of
from ...outlines.outline import Contours, FontMetrics, Outline
from ...readers import Source
from ...types import FloatArray, IntArray, counted
from .moved import Motion, Parts, joined_where_touching, moved_contours, moved_results

LEFT_OUT = "left out"
"""How the note on a glyph begins that cannot be read or converted."""

Fit: TypeAlias = Callable[[Sequence[Outline], Options], Sequence[GlyphResult | GlyphsplineError]]
"""Fits outlines: a result for each, or its error."""

NAME = "text"
"""The name of a text's outline."""


@dataclass(frozen=True, eq=False)
class Layout:
    """A text laid out: n glyphs in visual order, line by line. Lengths are in font units of the first font, y is up.

    Attributes:
        text: what is laid out. fonts: the first, and those for glyphs that it lacks.
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
        vertical: whether lines are columns.
        unusable: glyphs that are not read: font and index, and why.
        unvaried: bases with selectors of variations that no font has: they stand there without the selector.
        letter_spacing: what of ``advance`` is space behind each letter.
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
    vertical: bool = False
    unusable: Mapping[tuple[int, int], str] = field(default_factory=dict)
    letter_spacing: float = 0.0
    unvaried: tuple[str, ...] = ()

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
    def _pairs(self) -> tuple[IntArray, IntArray]:
        """(k, 2) font and index of the distinct glyphs; (n,) which of them each glyph is."""
        pairs, which = np.unique(np.stack([self.font, self.gid], axis=1).reshape(-1, 2), axis=0, return_inverse=True)
        return pairs, which.reshape(-1)

    @property
    def which(self) -> IntArray:
        """(n,) which of :meth:`distinct` each glyph is."""
        return self._pairs[1]

    def distinct(self) -> list[tuple[int, int]]:
        """Font and glyph index of each glyph, once, however often it occurs in the text, in ascending order."""
        return [(font, gid) for font, gid in self._pairs[0].tolist()]

    def outlines(self) -> list[Outline | GlyphsplineError]:
        """The outlines of :meth:`distinct`, in units of the first font; an error in place of each broken glyph."""
        found: list[Outline | GlyphsplineError] = []
        pairs = self._pairs[0]
        metrics = self.fonts[0].metrics
        for k in np.unique(pairs[:, 0]).tolist():
            font, gids = self.fonts[k], pairs[pairs[:, 0] == k, 1].tolist()
            scale = metrics.units_per_em / font.metrics.units_per_em
            made = iter(font.outlines([gid for gid in gids if (k, gid) not in self.unusable], errors="return"))
            read = [
                GlyphsplineError(self.unusable[k, gid], font=str(font.path), glyph=_name(font, gid))
                if (k, gid) in self.unusable
                else next(made)
                for gid in gids
            ]
            found += read if scale == 1.0 else [_scaled(outline, scale, metrics) for outline in read]
        return found

    def outline(self) -> Outline:
        """The text as one outline named "text", in units of the first font; broken glyphs are left out, with a note.

        ``advance`` is the width of the box, ascender and descender are its top and bottom.
        """
        parts = self._parts(united=False)
        arrays = joined([outline.arrays for outline in parts.outlines])
        found = self._as_outline(arrays, offsets_of([len(outline.contours) for outline in parts.outlines]), parts)
        notes = [f"glyph {outline.name!r}: {note}" for outline in parts.outlines for note in outline.notes]
        return replace(found, notes=tuple(notes), snapped=max([o.snapped for o in parts.outlines], default=0.0))

    def results(self, options: Options = DEFAULTS, fit: Fit | None = None) -> list[GlyphResult]:
        """The results of :meth:`distinct`, each at its own origin, in units of the first font.

        A broken glyph has no contours, and ``notes`` of its outline or result say why. Of the tolerance is set aside
        what :meth:`convert` says.

        Args:
            options: for all glyphs. fit: of their outlines; without it, :func:`.convert_many` of all at once.

        Raises:
            GlyphsplineError: no glyph can be converted: options that contradict each other, or a missing extra.
        """
        return self._fitted(self._parts(united=False), options, fit)

    def convert(self, options: Options = DEFAULTS, fit: Fit | None = None) -> GlyphResult:
        """Interpolate the text: each distinct glyph is fitted once, and its result moved into place.

        The measures of a contour are those of its glyph: crossings of different glyphs are not counted. Where a glyph
        is turned, or moved by other than whole units of the last digit written, rounding moves it once more: so much is
        set aside of the tolerance, and is in ``deviation_bound``.

        With ``remove_overlaps`` glyphs whose boxes touch are united, as joined letters do: each such group is fitted
        once.

        Args:
            options, fit: as in :meth:`results`.

        Returns:
            One result of all contours. Its outline has their sources; what cannot be read or converted is left out, and
            ``notes`` says so.

        Raises:
            GlyphsplineError: no glyph can be converted: options that contradict each other, or a missing extra.
        """
        parts = self._parts(options.remove_overlaps)
        return self._placed(parts, self._fitted(parts, options, fit), options)

    def placed(self, results: Sequence[GlyphResult]) -> GlyphResult:
        """Results of :meth:`distinct`, moved into place: one result of all contours, as of :meth:`convert`."""
        options = results[0].options if results else DEFAULTS
        return self._placed(self._parts(united=False), results, options)

    def unfitted(self, options: Options = DEFAULTS) -> list[GlyphResult]:
        """The outlines of :meth:`distinct` as the fonts have them, as results; ``options`` say how they are written."""
        return list(as_glyphs(self._parts(united=False).outlines, options))

    def _placed(self, parts: Parts, glyphs: Sequence[GlyphResult], options: Options) -> GlyphResult:
        notes = [f"glyph {g.outline.name!r}: {note}" for g in glyphs for note in (*g.outline.notes, *g.notes)]
        found, ends = joined_results(glyphs)
        which, motion = _chosen(ends, parts)
        outline = self._as_outline(found.source, ends, parts)
        results = ContourResults(moved_results(found, which, motion))
        return GlyphResult(outline, options, results, tuple(dict.fromkeys([*self.notes, *notes])))

    def _parts(self, united: bool) -> Parts:
        """What is fitted by itself and where it stands. A broken glyph draws nothing, and has a note."""
        outlines = []
        for (font, gid), read in zip(self.distinct(), self.outlines(), strict=True):
            if isinstance(read, GlyphsplineError):
                read = Outline(_name(self.fonts[font], gid), gid, notes=(f"{LEFT_OUT}: {read}",))
            outlines.append(read)
        parts = Parts(outlines, self.which, self.origin, self.angle)
        return joined_where_touching(parts) if united else parts

    def _fitted(self, parts: Parts, options: Options, fit: Fit | None) -> list[GlyphResult]:
        outlines, options = list(parts.outlines), options.for_em(self.fonts[0].metrics.units_per_em)
        steps, quarters = parts.origin * 10.0**options.precision, parts.angle * (2.0 / np.pi)
        if any(
            np.abs(values - np.round(values)).max(initial=0.0) > 1e-6 for values in (steps, quarters)
        ):  # rounded anew
            moved = sqrt(2.0) * 10.0**-options.precision
            outlines = [replace(outline, snapped=outline.snapped + moved) for outline in outlines]
        found = fit(outlines, options) if fit else convert_many(outlines, options, errors="return")
        errors = [result for result in found if isinstance(result, GlyphsplineError)]
        if errors and len(errors) >= sum(len(outline.contours) > 0 for outline in outlines):
            raise errors[0]
        return [
            result
            if isinstance(result, GlyphResult)
            else GlyphResult(replace(outline, contours=()), options, (), (f"{LEFT_OUT}: {result}",))
            for outline, result in zip(outlines, found, strict=True)
        ]

    def _as_outline(self, contours: ContourArrays, ends: IntArray, parts: Parts) -> Outline:
        """The contours of the parts, which begin at ``ends``, wherever these stand."""
        left, bottom, right, top = self.box
        metrics = FontMetrics(self.fonts[0].metrics.units_per_em, top, bottom)
        moved = Contours(moved_contours(contours, *_chosen(ends, parts)))
        unread = dict.fromkeys(f"glyph {one.name!r}: {part}" for one in parts.outlines for part in one.unread)
        return Outline(NAME, advance=right - left, contours=moved, metrics=metrics, unread=tuple(unread))


def _chosen(ends: IntArray, parts: Parts) -> tuple[IntArray, Motion]:
    """Which contours the text has, and how each is moved; ``ends``: where those of each part begin."""
    contours, offsets = members_of(ends, parts.which)
    return contours, Motion.by(parts.origin, parts.angle).repeated(np.diff(offsets))


def _name(font: Source, gid: int) -> str:
    """The name of a glyph; a font's characters may stand for glyphs that it does not have."""
    return font.glyph_names[gid] if gid < len(font.glyph_names) else f"glyph{gid:05}"


def _scaled(outline: Outline | GlyphsplineError, scale: float, metrics: FontMetrics) -> Outline | GlyphsplineError:
    if isinstance(outline, GlyphsplineError):
        return outline
    arrays = outline.arrays._replace(points=outline.arrays.points * scale)
    advance, snapped = outline.advance * scale, outline.snapped * scale
    return replace(outline, advance=advance, snapped=snapped, contours=Contours(arrays), metrics=metrics)
