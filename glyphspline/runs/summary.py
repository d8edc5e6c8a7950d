"""The summary of a run: glyphs by status, the worst of them, and what failed."""

from __future__ import annotations

import heapq
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any, NamedTuple

from ..fitting.results import MEASURES, MeasureColumns
from ..readers.pens import NO_AREA
from ..types import counted

SHOWN = 10
"""Maximum number of the worst, slowest and failed glyphs kept by name; a CJK face may have thousands."""

SLOW = 5.0
"""Seconds from which the slowest glyphs are listed."""

NAMED = 5
"""Glyphs outside the tolerance, or with other crossings or areas, that are named; of others there is the number."""


class Facts(NamedTuple):
    """What the summary takes from a glyph.

    Attributes:
        not_converged, outside: whether a contour did not converge, whether one is outside the tolerance.
        deviation: the largest of its contours; None if none was measured.
        crossings, collapsed, kept: whether a contour crosses where its source does not, has lost its area, or is the
            source's own.
        contours, splines: number of its contours that were fitted, and of those that are one closed spline.
        notes: of a glyph that came out empty: what was left out.
    """

    not_converged: bool = False
    outside: bool = False
    deviation: float | None = None
    crossings: bool = False
    collapsed: bool = False
    kept: bool = False
    contours: int = 0
    splines: int = 0
    notes: tuple[str, ...] = ()


NO_FACTS = Facts()

CHANGED = {
    "new_crossings": "cross where the source does not",
    "collapsed": "have a contour that lost its area",
    "source_kept": "have a contour kept as the source has it, because every fit crosses or loses its area",
}
"""What the summary says of glyphs whose contours enclose something else."""


def facts_of(measures: MeasureColumns, first: int = 0, last: int | None = None) -> Facts:
    """The facts of a glyph whose contours are those from ``first`` up to ``last``."""
    names = (
        "converged", "within_tolerance", "deviation", "new_crossings", "collapsed", "source_kept", "segments",
        "numbers", "iterations",
    )  # fmt: skip
    converged, within, deviations, crossings, collapsed, kept, *sizes = (
        measures.get(name, ())[first:last] for name in names
    )
    deviation = max((value for value in deviations if value is not None), default=None)
    return Facts(
        False in converged, False in within, deviation, any(crossings), any(collapsed), any(kept), len(sizes[0]),
        # A closed spline stores a point a segment; arcs between corners store two more. Lines alone iterate nothing.
        sum(numbers == 2 * segments and passes is not None for segments, numbers, passes in zip(*sizes, strict=False)),
    )  # fmt: skip


def facts_of_entry(entry: Mapping[str, Any]) -> Facts:
    """The facts of a glyph from its line of the manifest."""
    contours = entry["contours"] or ()
    facts = facts_of({name: [contour.get(name) for contour in contours] for name in MEASURES})
    return facts._replace(notes=tuple(entry.get("notes") or ())) if entry["status"] == "empty" else facts


@dataclass
class Summary:
    """Counts of a folder's glyphs, and the extreme ones by name.

    Attributes:
        statuses: glyphs by status. not_converged, outside_tolerance, new_crossings, collapsed, source_kept: glyphs with
            such a contour.
        contours, splines: that were fitted, and those of them that are one closed spline without a corner.
        named: the first few glyphs of the last four, by what it is. left_out: (glyph, notes), the first few that came
            out empty because of what was left out.
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
    left_out: list[tuple[str, str]] = field(default_factory=list)
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
        self.count(entry["glyph"], entry["status"], entry["error"], facts_of_entry(entry))

    def count(self, glyph: str, status: str, error: str | None, facts: Facts) -> None:
        """Count one glyph."""
        self.statuses[status] += 1
        if status == "failed" and len(self.failures) < SHOWN:
            self.failures.append((glyph, error or ""))
        self.not_converged += facts.not_converged
        self.contours += facts.contours
        self.splines += facts.splines
        those = facts.outside, facts.crossings, facts.collapsed, facts.kept
        for name, is_one in zip(("outside_tolerance", *CHANGED), those, strict=True):
            if is_one:
                setattr(self, name, getattr(self, name) + 1)
                named = self.named.setdefault(name, [])
                named += [glyph] if len(named) < NAMED else []
        if (notes := [note for note in facts.notes if NO_AREA not in note]) and len(self.left_out) < NAMED:
            self.left_out.append((glyph, ", ".join(notes)))
        if facts.deviation is not None:
            keep_largest(self.worst, (facts.deviation, glyph))

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
        if self.contours:
            yield f"contours that are one closed spline without a corner: {self.splines} of {self.contours}"
        if self.worst and self.aim and self.outside_tolerance:
            yield f"not within {self.aim}: {listed(self.named['outside_tolerance'], self.outside_tolerance)}"
        for name, words in CHANGED.items():
            if count := getattr(self, name):
                yield f"{words}: {listed(self.named[name], count)}"
        if self.not_converged:
            yield f"{counted(self.not_converged, 'glyph')} with a contour that did not converge"
        for glyph, notes in self.left_out:
            yield f"{glyph} came out empty: {notes}"
        yield from self.remarks
        if self.slowest and self.slowest[0][0] > SLOW:
            yield "slowest: " + ", ".join(f"{glyph} {value:.1f} s" for value, glyph in self.slowest[:5])
        for glyph, error in self.failures:
            yield f"failed: {glyph}: {error}"
        if self.failed > len(self.failures):
            yield f"and {self.failed - len(self.failures)} more, in the manifest"

    @property
    def undone(self) -> bool:
        """Whether something asked for was not done: a glyph is missing, failed, or is not within the tolerance."""
        return bool(self.missing or self.failed or (self.aim and self.outside_tolerance))

    @property
    def failed(self) -> int:
        """Number of glyphs that failed."""
        return self.statuses["failed"]


def keep_largest(items: list[tuple[float, str]], item: tuple[float, str]) -> None:
    """Insert an item into a descending list of at most ``SHOWN`` largest items."""
    if len(items) < SHOWN or item[0] > items[-1][0]:
        items[:] = heapq.nlargest(SHOWN, [*items, item], key=lambda each: each[0])


def listed(names: Sequence[str], count: int) -> str:
    """The names, and how many more there are of ``count``."""
    more = f" and {count - len(names)} more" if count > len(names) else ""
    return ", ".join(names) + more
