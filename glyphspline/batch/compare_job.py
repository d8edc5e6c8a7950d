"""The messages between the process that schedules a comparison and its workers."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from ..comparing.difference import Difference
from ..outlines.outline import FontMetrics

Head = tuple[str, int, tuple[int, ...]]
"""Name, glyph index and code points of a glyph."""


class Side(NamedTuple):
    """One of the two sources, as workers open it; ``is_font``: a font file, whose outlines are read in bulk."""

    path: Path
    face_index: int
    location: tuple[tuple[str, float], ...]
    metrics: FontMetrics
    is_font: bool


class Comparison(NamedTuple):
    """What workers are told once: both sources, and the tolerance in units of the old em."""

    old: Side
    new: Side
    tolerance: float


class Pair(NamedTuple):
    """A glyph of both sources."""

    old: Head
    new: Head


class Unread(NamedTuple):
    """A glyph that could not be compared: its name in the old font, and why."""

    glyph: str
    gid: int
    error: str


Found = tuple[int, list[Difference], list[Unread]]
"""The number of pairs without a difference, the differences of the others, and glyphs that could not be compared."""
