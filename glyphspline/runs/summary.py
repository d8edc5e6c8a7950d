"""The summary of a run: glyphs by status, the worst of them, and what failed."""

from __future__ import annotations

import heapq
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from ..types import counted, listed

SHOWN = 10
"""Maximum number of the worst, slowest and failed glyphs kept by name; a CJK face may have thousands."""

NAMED = 5
"""Glyphs outside the tolerance, or with other crossings or areas, that are named; of others there is the number."""


CHANGED = {
    "new_crossings": "cross where the source does not",
    "collapsed": "have a contour that lost its area",
    "source_kept": "have a contour kept as the source has it, because every fit crosses or loses its area",
}
"""What the summary says of glyphs whose contours enclose something else."""


@dataclass
class Summary:
    """Counts of a folder's glyphs, and the extreme ones by name.

    Attributes:
        statuses: glyphs by status. not_converged, outside_tolerance, new_crossings, collapsed, source_kept: glyphs with
            such a contour; or that are outside the tolerance in a file of the whole font.
        contours, splines: that were fitted, and those of them that are one closed spline without a corner.
        named: the first few glyphs of the last four, by what it is.
        unread: glyphs whose source shows more than was read. parts: (glyph, what it is), the first few.
        worst: largest deviations, (font units, glyph). failures: (glyph, error), the first few.
        slowest: (seconds, glyph). done: number of glyphs converted in this run, not in an earlier one.
        remarks: on formats with one file a font.
        missing: what was asked for and is not in the font. seconds: that the run took.
        aim: the tolerance in words; "" if vertices are placed by step or count, whatever the distance.
    """

    statuses: Counter[str] = field(default_factory=Counter)
    not_converged: int = 0
    outside_tolerance: int = 0
    new_crossings: int = 0
    collapsed: int = 0
    source_kept: int = 0
    contours: int = 0
    splines: int = 0
    named: dict[str, list[str]] = field(default_factory=dict)
    unread: int = 0
    parts: list[tuple[str, str]] = field(default_factory=list)
    worst: list[tuple[float, str]] = field(default_factory=list)
    slowest: list[tuple[float, str]] = field(default_factory=list)
    failures: list[tuple[str, str]] = field(default_factory=list)
    done: int = 0
    remarks: list[str] = field(default_factory=list)
    missing: tuple[str, ...] = ()
    aim: str = ""
    seconds: float = 0.0

    def add(self, entry: Mapping[str, Any]) -> None:
        """Count one line of the manifest."""
        glyph, status, contours = entry["glyph"], entry["status"], entry["contours"] or ()
        self.statuses[status] += 1
        if status == "failed" and len(self.failures) < SHOWN:
            self.failures.append((glyph, entry["error"] or ""))
        self.not_converged += any(contour.get("converged") is False for contour in contours)
        self.contours += len(contours)
        # A closed spline stores a point a segment; arcs between corners store two more. Lines alone iterate nothing.
        self.splines += sum(
            contour.get("iterations") is not None and contour.get("numbers") == 2 * contour["segments"]
            for contour in contours
        )
        stored = [facts for facts in (entry.get("stored") or {}).values() if facts]
        outside = any(measures.get("within_tolerance") is False for measures in (*contours, *stored))
        changed = {name: any(contour.get(name) for contour in contours) for name in CHANGED}
        for name, is_one in {"outside_tolerance": outside, **changed}.items():
            if is_one:
                setattr(self, name, getattr(self, name) + 1)
                named = self.named.setdefault(name, [])
                named += [glyph] if len(named) < NAMED else []
        if entry.get("unread"):
            self.unread += 1
            self.parts += [(glyph, "; ".join(entry["unread"]))] if len(self.parts) < NAMED else []
        if entry.get("deviation") is not None:
            keep_largest(self.worst, (entry["deviation"], glyph))

    def time(self, seconds: float, glyph: str) -> None:
        """Count a glyph converted in this run, and its time."""
        self.done += 1
        keep_largest(self.slowest, (seconds, glyph))

    def facts(self) -> dict[str, Any]:
        """The summary as JSON data."""
        return {**asdict(self), "statuses": dict(self.statuses)}

    def headline(self) -> str:
        """The run in one clause: how many glyphs, in what time, how near to the source."""
        kinds = [(self.statuses["empty"], "empty"), (self.failed, "failed")]
        parts = [counted(self.statuses["ok"], "glyph"), *(f"{count} {kind}" for count, kind in kinds if count)]
        earlier = sum(self.statuses.values()) - self.done
        before = f" ({earlier} of them before)" if earlier > 0 else ""
        how = []
        if self.worst and self.aim:
            far = self.outside_tolerance
            how.append(f"{f'{far} not' if far else 'all'} within {self.aim}")
        elif self.worst:
            how.append(f"at most {self.worst[0][0]:.3g} units from the source")
        return ", ".join([" and ".join(parts) + f" in {self.seconds:.1f} s{before}", *how])

    def lines(self) -> Iterator[str]:
        """What there is to say of contours, single glyphs and files, as lines of text; failures come last."""
        if self.splines:
            yield f"contours that are one closed spline without a corner: {self.splines} of {self.contours}"
        if self.worst and self.aim and self.outside_tolerance:
            yield f"not within {self.aim}: {listed(self.named['outside_tolerance'], self.outside_tolerance)}"
        for name, words in CHANGED.items():
            if count := getattr(self, name):
                yield f"{words}: {listed(self.named[name], count)}"
        if self.not_converged:
            yield f"{counted(self.not_converged, 'glyph')} with a contour that did not converge"
        yield from (f"not read of {glyph}: {what}" for glyph, what in self.parts)
        if self.unread > len(self.parts):
            yield f"{counted(self.unread - len(self.parts), 'glyph')} more not read in full, in the manifest"
        yield from self.remarks
        # Seconds from which the slowest glyphs are listed.
        if self.slowest and self.slowest[0][0] > 5.0:
            yield "slowest: " + ", ".join(f"{glyph} {value:.1f} s" for value, glyph in self.slowest[:5])
        for glyph, error in self.failures:
            yield f"failed: {glyph}: {error}"
        if self.failed > len(self.failures):
            yield f"and {self.failed - len(self.failures)} more, in the manifest"

    @property
    def undone(self) -> bool:
        """Whether something asked for was not done: a glyph is missing, failed, not read whole, or not within the
        tolerance."""
        return bool(self.missing or self.failed or self.unread or (self.aim and self.outside_tolerance))

    @property
    def failed(self) -> int:
        """Number of glyphs that failed."""
        return self.statuses["failed"]


def keep_largest(items: list[tuple[float, str]], item: tuple[float, str]) -> None:
    """Insert an item into a descending list of at most ``SHOWN`` largest items."""
    if len(items) < SHOWN or item[0] > items[-1][0]:
        items[:] = heapq.nlargest(SHOWN, [*items, item], key=lambda each: each[0])
