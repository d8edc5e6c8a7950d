"""Outlines through fontTools, which reports what is wrong with a glyph."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from io import BytesIO
from typing import Any

from fontTools.misc.roundTools import otRound
from fontTools.pens.transformPen import TransformPen
from fontTools.ttLib import TTFont

from ..pens import ContourPen


class FontTools:
    """Outlines at a location in normalised coordinates.

    Args:
        data: the file's bytes without compression. face_index: which face of a collection.
        normalized: axis tag to normalised coordinate; empty at the default.
    """

    def __init__(self, data: bytes, face_index: int, normalized: Mapping[str, float]) -> None:
        self._data, self._face_index, self._normalized = data, face_index, normalized
        self._failure: Exception | None = None

    @cached_property
    def _tables(self) -> TTFont:
        return TTFont(BytesIO(self._data), fontNumber=self._face_index, lazy=True)

    @cached_property
    def _glyphs(self) -> Any:
        """The glyph set, made when HarfBuzz fails on a glyph: it takes as long as opening a CJK face.

        Tables that fail as a whole fail once: a count in a hostile one can ask for gigabytes. The error drops its
        traceback, whose frames would keep them.
        """
        if self._failure is None:
            try:
                return self._tables.getGlyphSet(location=dict(self._normalized) or None, normalized=True)
            except Exception as error:
                self._failure = error
        raise self._failure.with_traceback(None) from None

    @cached_property
    def _static_glyf(self) -> Any:
        return self._tables["glyf"] if "glyf" in self._tables and not self._normalized else None

    def draw(self, name: str) -> tuple[ContourPen, float]:
        """Draw the contours of a glyph; also its advance. fontTools' exceptions pass through."""
        try:
            pen = ContourPen(self._glyphs, name)
            glyph = self._glyphs[name]
            glyph.draw(TransformPen(pen, (1, 0, 0, 1, self._shift(name), 0)))
            pen.finish()
            return pen, float(otRound(glyph.width))  # read last: drawing applies the variations of the width
        except Exception:
            self._forget()
            raise

    def _forget(self) -> None:
        """Open the tables again for the next glyph.

        After an exception fontTools keeps tables and glyphs that are read in part. The next reading of the same glyph
        would not find the fault.
        """
        for name in ("_tables", "_glyphs", "_static_glyf"):
            self.__dict__.pop(name, None)

    def _shift(self, name: str) -> float:
        """How far a composite glyph moves to its left side bearing.

        Rasterisers move every glyph there; fontTools moves simple glyphs only.
        """
        glyph = self._static_glyf[name] if self._static_glyf is not None else None
        return self._glyphs[name].lsb - glyph.xMin if glyph is not None and glyph.isComposite() else 0.0
