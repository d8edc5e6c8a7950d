"""Outlines of many glyphs at once, for those that are converted one by one."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

from ...outlines.outline import Contour
from .bulk import BulkReader
from .bulk_contours import cubics_of


class Read(NamedTuple):
    """What is drawn of a glyph: its advance and contours, as an outline has them."""

    advance: float
    contours: tuple[Contour, ...]


def read_chunk(reader: BulkReader, gids: Sequence[int]) -> list[Read | None]:
    """Read glyphs; None where something is unusual, or nothing is drawn, and the font's own reader has to look."""
    buffer, starts, advances, broken = reader.read(gids)
    _, segments, before, strange, points, degrees, owns = cubics_of(buffer, starts)
    contours = [
        Contour(points[owns[k] : owns[k + 1]], degrees[segments[k] : segments[k + 1]]) for k in range(len(owns) - 1)
    ]
    left = (broken | strange).tolist()
    each = zip(left, advances, pairwise(before.tolist()), strict=True)
    return [None if odd or a == b else Read(float(advance), tuple(contours[a:b])) for odd, advance, (a, b) in each]
