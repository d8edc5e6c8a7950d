"""SVG drawings as glyphs: filled paths and shapes through svgpathtools, transforms applied, y up.

A drawing is a font of one glyph; a folder of drawings is a font of as many glyphs. Drawings written by this package
contain name, code points and metrics. For others the file's name is the glyph's name (``A.svg``, ``uni9F8D.svg``,
``龍.svg``), and the view box gives em, ascender and advance.
"""

from __future__ import annotations

import hashlib
import math
import re
from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Any

from defusedxml.common import DefusedXmlException
from defusedxml.ElementTree import fromstring
from fontTools import agl

from ..errors import FontError, GlyphsplineError
from ..outlines.outline import FontMetrics, Outline
from .pens import ContourPen
from .source import Head, OutlineOrError, Source, first_claims, opening

LARGEST_FILE = 1 << 26
"""Limit of bytes of one drawing."""

COINCIDENT = 1e-7
"""Distance in em below which points coincide. Drawings may be in metres as well as in pixels."""


class SvgDrawings(Source):
    """One SVG file or a folder of them; made by :func:`open_svg`.

    Attributes:
        path: file or folder, as given. face_index, location: 0 and empty.
        family, style: the name of the file or folder without suffix, and "Regular".
        metrics: of the first drawing.
        glyph_names: in the order of ``data-gid`` if every drawing has one, else in the order of the files' names.
        cmap: code point to glyph.
    """

    format = "SVG"

    def __init__(self, path: Path, files: list[Path]) -> None:
        self.path, self.family, self.style = path, path.stem, "Regular"
        outlines = [read_drawing(file) for file in files]
        if not outlines:
            raise FontError("a folder without SVG drawings")
        self._files = files
        self._outlines: dict[str, Outline] = {}
        for outline in sorted(outlines, key=lambda outline: outline.gid):
            if outline.name in self._outlines:
                raise FontError("two drawings of one name", glyph=outline.name)
            self._outlines[outline.name] = outline
        self.glyph_names = tuple(self._outlines)
        self.metrics = self._outlines[self.glyph_names[0]].metrics
        self.cmap = first_claims((outline.name, outline.unicodes) for outline in self._outlines.values())

    def __reduce__(self) -> tuple[Any, ...]:
        return open_svg, (self.path,)

    @cached_property
    def sha256(self) -> str:
        """Hash of the bytes of all drawings in the order of their names, in hexadecimal."""
        return hashlib.sha256(b"".join(file.read_bytes() for file in self._files)).hexdigest()

    def _read(self, heads: Sequence[Head]) -> list[OutlineOrError]:
        return [replace(self._outlines[head.name], gid=head.gid) for head in heads]


def open_svg(path: str | Path) -> SvgDrawings:
    """Open an SVG file or a folder of them.

    Raises:
        FontError: the path cannot be read, or a drawing is broken or declares XML entities.
    """
    path = Path(path)
    with opening(path, "drawing"):
        return SvgDrawings(path, sorted(path.glob("*.svg")) if path.is_dir() else [path])


def read_drawing(file: Path) -> Outline:
    """Read one drawing as an outline, y up; its glyph index is ``data-gid``, or 0.

    Raises:
        GlyphsplineError: the file is too large, not an SVG drawing, or declares entities.
    """
    from .svg_shapes import draw_shapes  # imports SciPy, which fonts do not need

    with opening(file, "drawing"):
        root = svg_root(file)
        metrics, advance = _metrics(root)
        pen = ContourPen(coincident=COINCIDENT * metrics.units_per_em)
        notes = draw_shapes(root, pen)
        pen.finish()
    name, gid = root.get("data-glyph") or file.stem, int(root.get("data-gid") or 0)
    unicodes = _unicodes(root.get("data-unicodes"), name)
    said = (*pen.notes, *notes)
    return Outline(name, gid, unicodes, advance, tuple(pen.contours), metrics, said, pen.snapped)


def svg_root(file: Path) -> Any:
    """The root element of an SVG document.

    Raises:
        GlyphsplineError: the file is too large, not an SVG drawing, or declares entities.
    """
    if file.stat().st_size > LARGEST_FILE:
        raise GlyphsplineError(f"more than {LARGEST_FILE >> 20} MiB")
    try:
        root = fromstring(file.read_bytes())
    except DefusedXmlException as error:
        raise GlyphsplineError("its XML declares entities, which are refused") from error
    if root.tag.rpartition("}")[2] != "svg":
        raise GlyphsplineError("not an SVG drawing")
    return root


def _unicodes(written: str | None, name: str) -> tuple[int, ...]:
    if written is not None:
        return tuple(int(code, 16) for code in re.findall(r"U\+([0-9A-Fa-f]{1,6})", written))
    text = name if len(name) == 1 else agl.toUnicode(name)
    return (ord(text),) if len(text) == 1 else ()


def _metrics(root: Any) -> tuple[FontMetrics, float]:
    """Metrics and advance from ``data-*`` attributes, else from the view box, else from width and height."""
    if root.get("data-units-per-em"):
        keys = ("units-per-em", "ascender", "descender", "advance")
        em, ascender, descender, advance = (float(root.get(f"data-{key}", "nan")) for key in keys)
    else:
        box = [float(part) for part in root.get("viewBox", "").replace(",", " ").split()]
        left, top, width, height = box if len(box) == 4 else (0, 0, _length(root, "width"), _length(root, "height"))
        em, ascender, descender, advance = height, -top, -top - height, left + width
    if not (all(map(math.isfinite, (em, ascender, descender, advance))) and em > 0):
        raise GlyphsplineError("a view box or metrics that are no numbers, or of no height")
    return FontMetrics(em, ascender + 0.0, descender + 0.0), advance


def _length(root: Any, name: str) -> float:
    number = re.match(r"\s*([0-9.]+(?:[eE][+-]?[0-9]+)?)", root.get(name, ""))
    return float(number[1]) if number and not root.get(name).strip().endswith("%") else 1000.0
