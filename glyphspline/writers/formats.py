"""Formats of a drawing: a glyph or a text as a file, by name. Plug-ins add theirs through an entry point."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from ..fitting.results import GlyphResult
from .svg.appearance import PLAIN, Appearance

GROUP = "glyphspline.formats"
"""The entry point group: the value of an entry point is a :class:`Format` of the same name."""

DxfKind = Literal["spline", "polyline"]


@dataclass(frozen=True)
class Settings:
    """What a writer is told besides the result.

    Attributes:
        look: of drawings. scale: length of a font unit in the drawing, in ``unit``.
        unit: "mm", "cm", "in", "pt", "pc" or "px"; None: a font unit.
        flatness: largest distance of a polyline from its curve, in font units; None: 1/2000 em.
        dxf: contours as splines, or flattened.
    """

    look: Appearance = PLAIN
    scale: float = 1.0
    unit: str | None = None
    flatness: float | None = None
    dxf: DxfKind = "spline"


@dataclass(frozen=True)
class Format:
    """A format with one file a glyph, or a text.

    Attributes:
        name: as in ``--format``; also the folder's. suffix: of its files, with the dot.
        write: the file of a result, as bytes or text in UTF-8; the same bytes at every call.
        extra: the extra of pyproject.toml that it needs.
    """

    name: str
    suffix: str
    write: Callable[[GlyphResult, Settings], str | bytes]
    extra: str | None = None
