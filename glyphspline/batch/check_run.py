"""Fonts checked whole: findings glyph by glyph, in glyph index order, from workers."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from typing import NamedTuple

from ..checks.check import THRESHOLDS, check
from ..checks.finding import Finding
from ..checks.kinds import Thresholds
from ..errors import GlyphsplineError
from ..readers import Source

STEPS = 8
"""Steps of each axis of a variable font, at whose ends its glyphs are checked besides the masters."""

Observer = Callable[[int, int, int], None]
"""Called with the number of glyphs done, of all glyphs, and of those that failed."""


class GlyphFindings(NamedTuple):
    """What was found in a glyph.

    Attributes:
        findings: kinks first, the largest value of each kind first. error: why it could not be checked, or None.
    """

    glyph: str
    gid: int
    findings: list[Finding]
    error: str | None


def check_font(
    source: Source,
    names: Sequence[str],
    thresholds: Thresholds = THRESHOLDS,
    *,
    axes: Sequence[str] | None = None,
    steps: int = STEPS,
    executor: Executor | None = None,
    observer: Observer | None = None,
) -> Iterator[GlyphFindings]:
    """Check glyphs of a font, one after the other in glyph index order. Nothing is fitted.

    Args:
        source: the opened font. names: of its glyphs. thresholds: from which values on it counts.
        axes: tags of the axes along which glyphs of a variable font are checked; without it all, of () none: glyphs
            are checked where the font is open.
        steps: of each axis, at whose ends glyphs are checked besides the masters.
        executor: see :func:`.schedule.workers`; without it, glyphs are checked in this process.
        observer: called now and then.
    """
    index = {name: gid for gid, name in enumerate(source.glyph_names)}
    chosen, broken = sorted(set(names), key=index.__getitem__), 0
    for done, name in enumerate(chosen, 1):
        try:
            found = GlyphFindings(name, index[name], check(source.outline(name), thresholds), None)
        except GlyphsplineError as error:
            found = GlyphFindings(name, index[name], [], error.message)
            broken += 1
        if observer:
            observer(done, len(chosen), broken)
        yield found
