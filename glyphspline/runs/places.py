"""How workers open sources: once a process."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from ..outlines.outline import FontMetrics
    from ..readers import Source
    from ..readers.source import OutlineOrError

Place = tuple[Path, int, tuple[tuple[str, float], ...]]
"""A file, a face and a location."""

Head = tuple[str, int, tuple[int, ...]]
"""Name, glyph index and code points of a glyph."""

Read = Callable[[Sequence[Head]], "Sequence[OutlineOrError]"]
"""Reads outlines: of each glyph its outline, or its error."""


class Side(NamedTuple):
    """A source whose outlines are read; ``metrics`` are those of a font file, which is read in bulk."""

    place: Place
    metrics: FontMetrics | None


def place_of(source: Source) -> Place:
    """Where a source is opened again."""
    return source.path.absolute(), source.face_index, tuple(source.location.items())


def side_of(source: Source) -> Side:
    """A source as workers read its outlines."""
    from ..readers import Font

    return Side(place_of(source), source.metrics if type(source) is Font else None)


@lru_cache(maxsize=1)
def sources(*places: Place) -> list[Source]:
    """The sources of a job, opened once; only those of one job are kept, each of which may take 100 MB."""
    from ..readers import open_source

    return [open_source(path, face_index, dict(location)) for path, face_index, location in places]


@lru_cache(maxsize=1)
def readers(*sides: Side) -> list[Read]:
    """The readers of a job's sources, opened once. One in bulk opens much faster than the font."""
    return [_reader(side) for side in sides]


def _reader(side: Side) -> Read:
    if side.metrics is None:
        (source,) = sources(side.place)
        return lambda heads: source.outlines([gid for _, gid, _ in heads], errors="return")
    from ..readers.opentype.bulk import BulkReader

    bulk, metrics = BulkReader(*side.place), side.metrics
    return lambda heads: bulk.outlines(heads, metrics)


def forget_opened() -> None:
    """Open fonts anew from now on: their files may have been edited."""
    sources.cache_clear()
    readers.cache_clear()
