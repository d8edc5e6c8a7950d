"""The work of a worker that compares glyphs: pairs to outlines to differences."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache

from ..comparing.compare import compare_many
from ..comparing.difference import Difference
from ..errors import GlyphsplineError
from ..outlines.outline import Outline
from ..readers import open_source
from ..readers.opentype.bulk import BulkReader
from ..readers.source import OutlineOrError
from .compare_job import Comparison, Found, Head, Pair, Side, Unread
from .pool import sign_of_life
from .spec import Limits
from .worker import reason

Read = Callable[[Sequence[Head]], Sequence[OutlineOrError]]

SEGMENTS = 20_000
"""Segments of both fonts compared at once. A worker's time limit and memory are for so many."""


MOST = Limits().segments
"""Segments of one outline."""


def tell_apart(comparison: Comparison, pairs: Sequence[Pair]) -> Found:
    """Compare glyphs. One that cannot be compared does not affect the others."""
    old, new = readers(comparison)
    identical, differences, unread = 0, [], []
    batch: list[tuple[Outline, Outline]] = []
    cost = 0

    def finish() -> None:
        nonlocal identical, cost
        for one, other in zip(batch, together(batch, comparison.tolerance), strict=True):
            if isinstance(other, GlyphsplineError):
                unread.append(Unread(one[0].name, one[0].gid, other.message))
            elif other.is_none:
                identical += 1
            else:
                differences.append(other)
        batch.clear()
        cost = 0
        sign_of_life()

    mine, its = old([pair.old for pair in pairs]), new([pair.new for pair in pairs])
    for pair, *outlines in zip(pairs, mine, its, strict=True):
        try:
            one, other = (accepted(outline, which) for outline, which in zip(outlines, ("old", "new"), strict=True))
        except GlyphsplineError as error:
            unread.append(Unread(*pair.old[:2], error.message))
            continue
        own = len(one.arrays.degrees) + len(other.arrays.degrees)
        if batch and cost + own > SEGMENTS:
            finish()
        batch.append((one, other))
        cost += own
    if batch:
        finish()
    return identical, differences, unread


def accepted(outline: OutlineOrError, which: str) -> Outline:
    """An outline that can be compared.

    Raises:
        GlyphsplineError: it could not be read, or is too large.
    """
    if isinstance(outline, GlyphsplineError):
        raise GlyphsplineError(f"{which}: {reason(outline)}")
    if len(outline.arrays.degrees) > MOST:
        raise GlyphsplineError(f"{which}: {len(outline.arrays.degrees)} segments, more than the {MOST} allowed")
    return outline


def together(batch: Sequence[tuple[Outline, Outline]], tolerance: float) -> Sequence[Difference | GlyphsplineError]:
    """The differences of a batch; after an unexpected error, glyph by glyph."""
    try:
        return compare_many([one for one, _ in batch], [other for _, other in batch], tolerance)
    except Exception as error:
        if len(batch) == 1:
            return [GlyphsplineError(reason(error))]
        return [found for one in batch for found in together([one], tolerance)]


@lru_cache(maxsize=1)
def readers(comparison: Comparison) -> tuple[Read, Read]:
    """The readers of both sources, opened once a process."""
    return reader(comparison.old), reader(comparison.new)


def reader(side: Side) -> Read:
    """What reads the outlines of one source."""
    if side.is_font:
        bulk = BulkReader(side.path, side.face_index, side.location)
        return lambda heads: bulk.outlines(heads, side.metrics)
    source = open_source(side.path, side.face_index, dict(side.location))
    return lambda heads: source.outlines([gid for _, gid, _ in heads], errors="return")
