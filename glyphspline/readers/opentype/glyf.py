"""Contours and components of TrueType glyphs, counted from the records without drawing."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass

from ...errors import GlyphsplineError
from ..pens import MAX_COMPONENTS, MAX_SEGMENTS

_WORDS, _SCALE, _MORE, _TWO_SCALES, _MATRIX = 0x01, 0x08, 0x20, 0x40, 0x80


@dataclass(frozen=True)
class Parts:
    """Numbers of contours and of components of a glyph, components decomposed."""

    contours: int = 0
    components: int = 0


class GlyphRecords:
    """The ``glyf`` table: what a glyph should draw, to check that a drawing is whole.

    HarfBuzz leaves out what it cannot read without an error, and follows a loop of components up to a limit.
    """

    def __init__(self, glyf: bytes, offsets: Sequence[int], glyph_names: Sequence[str]) -> None:
        self._glyf, self._offsets, self._names = glyf, offsets, glyph_names
        self._known: dict[int, Parts | None] = {}

    def parts(self, gid: int, above: tuple[int, ...] = ()) -> Parts | None:
        """The parts of a glyph; None if its record, or that of a component, is broken.

        Raises:
            GlyphsplineError: components in a loop, or too many.
        """
        if gid in above:
            loop = [*above[above.index(gid) :], gid]
            raise GlyphsplineError("components in a loop: " + " > ".join(self._names[g] for g in loop))
        if gid not in self._known:
            try:
                self._known[gid] = self._read(gid, above)
            except (struct.error, IndexError):
                self._known[gid] = None
        return self._known[gid]

    def _read(self, gid: int, above: tuple[int, ...]) -> Parts | None:
        start, end = self._offsets[gid], self._offsets[gid + 1]
        if start >= end:
            return Parts()
        record = self._glyf[start:end]
        count = struct.unpack_from(">h", record)[0]
        if count >= 0:
            ends = struct.unpack_from(f">{count}H", record, 10)
            ascending = all(last > before for before, last in zip((-1, *ends), ends, strict=False))
            return Parts(count) if ascending else None
        contours = components = 0
        for component in component_gids(record):
            part = self.parts(component, (*above, gid))
            if part is None:
                return None
            components += 1 + part.components
            if components > MAX_COMPONENTS:
                raise GlyphsplineError(f"more than {MAX_COMPONENTS} components")
            if contours + part.contours > MAX_SEGMENTS:
                raise GlyphsplineError(f"more than {MAX_SEGMENTS} segments")
            contours += part.contours
        return Parts(contours, components)


def component_gids(record: bytes) -> list[int]:
    """Glyph indices of a composite glyph's components, in order."""
    found, at, more = [], 10, True
    while more:
        flags, gid = struct.unpack_from(">HH", record, at)
        found.append(gid)
        at += 4 + (4 if flags & _WORDS else 2)
        at += 2 if flags & _SCALE else 4 if flags & _TWO_SCALES else 8 if flags & _MATRIX else 0
        more = bool(flags & _MORE)
    return found
