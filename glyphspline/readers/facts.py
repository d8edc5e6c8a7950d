"""The facts of a file of glyphs as plain data."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Any

from ..errors import GlyphsplineError
from ..extras import has
from ..outlines.masters import DesignAxis
from ..outlines.outline import Outline
from .open import STDIN, is_font, open_source, standard_input
from .opentype.font import open_faces
from .source import Location, Source

OVERLAP = 1e-5
"""Share of a square em below which the area of an overlap counts as rounding."""


def file_facts(path: str | Path, face_index: int | None = None, location: Location = None) -> dict[str, Any]:
    """The file's format, and the facts of each face or of the one requested. No glyph is read.

    Raises:
        FontError: as in :func:`open_source`.
    """
    faces: list[Source]
    if is_font(path):
        faces = [*open_faces(standard_input() if str(path) == STDIN else path, face_index, location)]
    else:
        faces = [open_source(path, face_index or 0, location)]
    return {
        "file": str(path),
        "format": faces[0].format,
        "faces": faces[0].num_faces,
        "fonts": [face_facts(face) for face in faces],
    }


def face_facts(face: Source) -> dict[str, Any]:
    """The facts of one face: names, metrics, axes, instances, and the numbers of glyphs and characters."""
    glyphs, characters = face.counts()
    return {
        "face_index": face.face_index,
        "family": face.family,
        "style": face.style,
        **asdict(face.metrics),
        "axes": [axis_facts(axis) for axis in face.axes],
        "instances": {name: dict(place) for name, place in face.instances.items()},
        "location": dict(face.location),
        "glyphs": glyphs,
        "characters": characters,
    }


def axis_facts(axis: DesignAxis) -> dict[str, Any]:
    """An axis in user space."""
    return {name: value for name, value in asdict(axis).items() if name != "mapping"}


def glyph_facts(source: Source, first: int, last: int) -> dict[str, Any]:
    """Facts from the outlines of glyphs ``first`` up to ``last``: counts, and unusual glyphs by name.

    ``overlaps`` are glyphs with contours that overlap or cross themselves; parts of them are filled twice. It is null
    if skia-pathops (the extra ``overlaps``) is not installed. ``degenerate`` glyphs have contours that enclose nothing.
    """
    contours = segments = 0
    broken, degenerate, overlapping = [], [], []
    has_pathops = has("overlaps")
    names = source.glyph_names[first:last]
    for name, outline in zip(names, source.outlines(names, errors="return"), strict=True):
        if isinstance(outline, GlyphsplineError):
            broken.append(name)
            continue
        contours += len(outline.contours)
        segments += sum(len(contour) for contour in outline.contours)
        if any("encloses nothing" in note for note in outline.notes):
            degenerate.append(name)
        if has_pathops and overlaps(outline):
            overlapping.append(name)
    return {
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

    from ..curves.integrals import area  # imports the compiler, which the quick facts do not need
    from ..outlines.overlaps import contours_of

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
