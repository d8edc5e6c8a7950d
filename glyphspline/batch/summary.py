"""The summary of a run: glyphs by status, the worst of them, and what failed."""

from __future__ import annotations

import heapq
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from ..fitting.results import MeasureColumns
from .entry import columns_of

SHOWN = 10
"""Maximum number of the worst, slowest and failed glyphs kept by name; a CJK face may have thousands."""

SLOW = 0.5
"""Seconds from which the slowest glyphs are listed."""

Facts = tuple[bool, bool, float | None]
"""For a glyph: whether a contour did not converge, whether one is outside the tolerance, the largest deviation."""

NO_FACTS: Facts = (False, False, None)


def facts_of(measures: MeasureColumns, first: int = 0, last: int | None = None) -> Facts:
    """The facts of a glyph whose contours are those from ``first`` up to ``last``."""
    names = ("converged", "within_tolerance", "deviation")
    converged, within, deviations = (measures.get(name, ())[first:last] for name in names)
    known = [value for value in deviations if value is not None]
    return False in converged, False in within, max(known, default=None)


@dataclass
class Summary:
    """Counts of a folder's glyphs, and the extreme ones by name.

    Attributes:
        statuses: glyphs by status. not_converged, outside_tolerance: glyphs with such a contour.
        worst: largest deviations, (font units, glyph). failures: (glyph, error), the first few.
        slowest: (seconds, glyph). done: number of glyphs converted in this run, not in an earlier one.
        remarks: on formats with one file a font.
    """

    statuses: Counter[str] = field(default_factory=Counter)
    not_converged: int = 0
    outside_tolerance: int = 0
    worst: list[tuple[float, str]] = field(default_factory=list)
    slowest: list[tuple[float, str]] = field(default_factory=list)
    failures: list[tuple[str, str]] = field(default_factory=list)
    done: int = 0
    remarks: list[str] = field(default_factory=list)

    def add(self, entry: Mapping[str, Any]) -> None:
        """Count one line of the manifest."""
        self.count(entry["glyph"], entry["status"], entry["error"], facts_of(columns_of(entry["contours"])))

    def count(self, glyph: str, status: str, error: str | None, facts: Facts) -> None:
        """Count one glyph."""
        self.statuses[status] += 1
        if status == "failed" and len(self.failures) < SHOWN:
            self.failures.append((glyph, error or ""))
        not_converged, outside_tolerance, deviation = facts
        self.not_converged += not_converged
        self.outside_tolerance += outside_tolerance
        if deviation is not None:
            keep_largest(self.worst, (deviation, glyph))

    def time(self, seconds: float, glyph: str) -> None:
        """Count a glyph converted in this run, and its time."""
        self.done += 1
        keep_largest(self.slowest, (seconds, glyph))

    def facts(self) -> dict[str, Any]:
        """The summary as JSON data."""
        return {**asdict(self), "statuses": dict(self.statuses)}

    def lines(self) -> Iterator[str]:
        """The summary as lines of text."""
        counts = ", ".join(f"{self.statuses[status]} {status}" for status in ("ok", "empty", "failed"))
        yield f"{counts}; {self.done} done now"
        if self.not_converged:
            yield f"{self.not_converged} glyphs with a contour that did not converge"
        if self.outside_tolerance:
            yield f"{self.outside_tolerance} glyphs with a contour outside the tolerance"
        yield from self.remarks
        if self.worst:
            yield "largest deviations: " + ", ".join(f"{glyph} {value:.3g}" for value, glyph in self.worst[:5])
        if self.slowest and self.slowest[0][0] > SLOW:
            yield "slowest: " + ", ".join(f"{glyph} {value:.1f} s" for value, glyph in self.slowest[:5])
        for glyph, error in self.failures:
            yield f"failed: {glyph}: {error}"
        if self.failed > len(self.failures):
            yield f"and {self.failed - len(self.failures)} more, in the manifest"

    @property
    def failed(self) -> int:
        """Number of glyphs that failed."""
        return self.statuses["failed"]


def keep_largest(items: list[tuple[float, str]], item: tuple[float, str]) -> None:
    """Insert an item into a descending list of at most ``SHOWN`` largest items."""
    if len(items) < SHOWN or item[0] > items[-1][0]:
        items[:] = heapq.nlargest(SHOWN, [*items, item], key=lambda each: each[0])
