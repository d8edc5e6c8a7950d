"""The facts of a file of glyphs as plain data."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Any

from ..outlines.masters import DesignAxis
from .open import STDIN, is_font, open_source, standard_input
from .opentype.font import open_faces
from .source import Location, Source


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
