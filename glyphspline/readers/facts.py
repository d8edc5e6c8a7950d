"""The facts of a file of glyphs as plain data."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Any

from ..curves.integrals import area
from ..errors import GlyphsplineError
from ..extras import has
from ..outlines.outline import Outline
from ..outlines.overlaps import contours_of
from .open import open_source
from .opentype.font import Font
from .opentype.tables import Location
from .source import Source

OVERLAP = 1e-5
"""Share of a square em below which the area of an overlap counts as rounding."""

BATCH = 200
"""Glyphs read at once: a few megabytes of outlines."""


def file_facts(path: str | Path, face_index: int | None = None, location: Location = None) -> dict[str, Any]:
    """The file's format, and the facts of each face or of the one requested. Every glyph is drawn.

    Raises:
        FontError: as in :func:`open_source`.
    """
    first = open_source(path, face_index or 0, location)
    indices = range(first.num_faces) if face_index is None else [face_index]
    sources = [first if index == first.face_index else open_source(path, index, location) for index in indices]
    return {
        "file": str(path),
        "format": first.format,
        "faces": first.num_faces,
        "fonts": [source_facts(source) for source in sources],
    }


def source_facts(source: Source) -> dict[str, Any]:
    """The facts of one face: names, metrics, axes, instances, counts, and the names of unusual glyphs.

    ``overlaps`` are glyphs with contours that overlap or cross themselves; parts of them are filled twice. It is null
    if skia-pathops (the extra ``overlaps``) is not installed. ``degenerate`` glyphs have contours that enclose nothing.
    """
    contours = segments = 0
    broken, degenerate, overlapping = [], [], []
    has_pathops = has("overlaps")
    batches = (source.glyph_names[first : first + BATCH] for first in range(0, len(source.glyph_names), BATCH))
    glyphs = (pair for names in batches for pair in zip(names, source.outlines(names, errors="return"), strict=True))
    for name, outline in glyphs:
        if isinstance(outline, GlyphsplineError):
            broken.append(name)
            continue
        contours += len(outline.contours)
        segments += sum(len(contour) for contour in outline.contours)
        if any("encloses nothing" in note for note in outline.notes):
            degenerate.append(name)
        if has_pathops and overlaps(outline):
            overlapping.append(name)
    font = source if isinstance(source, Font) else None
    return {
        "face_index": source.face_index,
        "family": source.family,
        "style": source.style,
        **asdict(source.metrics),
        "axes": [] if font is None else [asdict(axis) for axis in font.axes],
        "instances": {} if font is None else font.instances,
        "location": dict(source.location),
        "glyphs": len(source.glyph_names),
        "characters": len(source.cmap),
        "contours": contours,
        "segments": segments,
        "broken_glyphs": len(broken),
        "broken": broken,
        "degenerate": degenerate,
        "overlaps": overlapping if has_pathops else None,
    }


def overlaps(outline: Outline) -> bool:
    """Whether any part of a glyph is filled twice or inside out: its area then differs from the sum over contours."""
    import pathops

    if not outline.contours:
        return False
    path = pathops.Path()
    outline.draw(path.getPen())
    try:
        path.simplify(fix_winding=True)
    except pathops.PathOpsError:
        return False  # Skia fails on the glyph
    filled, summed = (
        sum(area(contour.cubics()) for contour in contours) for contours in (contours_of(path), outline.contours)
    )
    return abs(abs(filled) - abs(summed)) > OVERLAP * outline.metrics.units_per_em**2
