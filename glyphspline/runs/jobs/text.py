"""The drawings of a text, made by a worker: the command lays the text out, a process that can be killed fits it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Literal, NamedTuple

from ...errors import GlyphsplineError
from ...fitting.options import Options
from ...typesetting.placed import Layout
from ...typesetting.setting import Side
from ...writers.settings import Settings

if TYPE_CHECKING:
    from ...fitting.results import GlyphResult
    from ...typesetting.path import Path


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
    """Fit a text and draw it in all formats; it is fitted once for all, and not at all for its source's outline.

    Raises:
        GlyphsplineError: it cannot be fitted, or a format cannot draw it.
    """
    from ...fitting.convert import convert, unfitted
    from ...writers.formats import format_named

    layout, bent, options = job.layout, None, job.options
    metrics = layout.fonts[0].metrics
    if job.path is not None and job.bend:
        from ...typesetting.bent import SHARE, bend

        tolerance = SHARE * options.tolerance_for(metrics.units_per_em)
        bent = bend(layout, job.path, tolerance, align=job.align, side=job.side, offset=job.offset)
    elif job.path is not None:
        from ...typesetting.along_path import along

        layout = along(layout, job.path, align=job.align, side=job.side, offset=job.offset)
    notes: dict[str, None] = {}

    @cache
    def whole(fitted: bool) -> GlyphResult:
        if fitted:
            result = layout.convert(options) if bent is None else convert(bent, options)
        else:
            outline = layout.outline() if bent is None else bent
            (found,) = unfitted([outline], options)
            if isinstance(found, GlyphsplineError):
                raise found
            result = found
            notes.update(dict.fromkeys(outline.notes))
        notes.update(dict.fromkeys(result.notes))
        return result

    def each_glyph(fitted: bool) -> bytes:
        from ...writers.svg.text_drawing import text_document

        if bent is not None:
            raise GlyphsplineError("--each-glyph: bent text is one outline")
        results = layout.results(options) if fitted else layout.unfitted(options)
        notes.update(dict.fromkeys([note for result in results for note in (*result.outline.notes, *result.notes)]))
        return text_document(layout, results, job.settings.look)

    contents = []
    for name in job.formats:
        form = format_named(name)
        if job.each_glyph and name in ("svg", "source"):
            contents.append(each_glyph(form.fitted))
        else:
            made = form.write(whole(form.fitted), job.settings.scaled(metrics))
            contents.append(made.encode() if isinstance(made, str) else made)
    return Drawings(contents, list(notes))
