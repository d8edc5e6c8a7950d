"""The drawings of a text, made by a worker: a text is laid out by the command, and fitted where it can be killed."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Literal, NamedTuple

from ..errors import GlyphsplineError
from ..fitting.options import Options
from ..typesetting.placed import Layout
from ..typesetting.setting import Side
from ..writers.settings import Settings

if TYPE_CHECKING:
    from ..fitting.results import GlyphResult
    from ..typesetting.path import Path


@dataclass(frozen=True)
class TextJob:
    """A text and its drawings, as a worker needs them.

    Attributes:
        layout: the text on its lines. options: of the fit. formats: names, one for each drawing.
        settings: of the drawings. each_glyph: each glyph is an element of an SVG drawing.
        path: in font units, that the text is to follow, or None. bend: its letters too. align, side, offset: on it.
    """

    layout: Layout
    options: Options
    formats: tuple[str, ...]
    settings: Settings
    each_glyph: bool = False
    path: Path | None = None
    bend: bool = False
    align: Literal["start", "center", "end"] = "start"
    side: Side = "left"
    offset: float = 0.0


class Drawings(NamedTuple):
    """The drawings of a text as bytes, in the order of the formats, and what is left out of them or noted."""

    contents: list[bytes]
    notes: list[str]


def drawings(job: TextJob) -> Drawings:
    """Fit a text and draw it in all formats.

    Raises:
        GlyphsplineError: it cannot be fitted, or a format cannot draw it.
    """
    drawn = _Drawn(job)
    return Drawings([drawn.content(name) for name in job.formats], list(drawn.notes))


class _Drawn:
    """A text whose glyphs are fitted once for all formats, and not at all for a source's outline."""

    def __init__(self, job: TextJob) -> None:
        self.job, self.layout, self.options = job, job.layout, job.options
        self.notes: dict[str, None] = {}
        self.bent = None
        if job.path is not None and job.bend:
            from ..typesetting.bent import SHARE, bend

            tolerance = SHARE * self.options.tolerance_for(self.layout.fonts[0].metrics.units_per_em)
            self.bent = bend(self.layout, job.path, tolerance, align=job.align, side=job.side, offset=job.offset)
        elif job.path is not None:
            from ..typesetting.along_path import along

            self.layout = along(self.layout, job.path, align=job.align, side=job.side, offset=job.offset)

    @cached_property
    def fitted(self) -> GlyphResult:
        """The whole text, fitted."""
        from ..fitting.convert import convert

        result = self.layout.convert(self.options) if self.bent is None else convert(self.bent, self.options)
        self.notes |= dict.fromkeys(result.notes)
        return result

    @cached_property
    def unfitted(self) -> GlyphResult:
        """The whole text as the fonts have it."""
        from ..fitting.convert import unfitted

        outline = self.layout.outline() if self.bent is None else self.bent
        (found,) = unfitted([outline], self.options)
        if isinstance(found, GlyphsplineError):
            raise found
        self.notes |= dict.fromkeys((*outline.notes, *found.notes))
        return found

    @cached_property
    def settings(self) -> Settings:
        """Settings of the writers, with the scale of the first font."""
        return self.job.settings.scaled(self.layout.fonts[0].metrics)

    def content(self, name: str) -> bytes:
        """A drawing as bytes."""
        from ..writers.formats import format_named

        form = format_named(name)
        if self.job.each_glyph and name in ("svg", "source"):
            return self.each_glyph(fitted=form.fitted)
        made = form.write(self.fitted if form.fitted else self.unfitted, self.settings)
        return made.encode() if isinstance(made, str) else made

    def each_glyph(self, *, fitted: bool) -> bytes:
        """The SVG drawing in which each glyph is an element."""
        from ..writers.svg.text_drawing import text_document

        if self.bent is not None:
            raise GlyphsplineError("--each-glyph: bent text is one outline")
        results = self.layout.results(self.options) if fitted else self.layout.unfitted(self.options)
        self.notes |= dict.fromkeys([note for result in results for note in (*result.outline.notes, *result.notes)])
        return text_document(self.layout, results, self.job.settings.look)
