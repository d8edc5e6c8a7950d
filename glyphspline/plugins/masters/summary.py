"""The summary of a run over masters."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from ...runs.summary import CHANGED, NAMED
from ...types import counted, listed, rounded_up, shortened


@dataclass
class MastersSummary:
    """The summary of a run over masters: of all glyphs of its folder.

    Attributes:
        glyphs: those that have a result. failed: the others, and why.
        outside, stopping: glyphs outside the tolerance; and not proven free of cusps.
        crossing, collapsed: glyphs that cross, or have a contour that lost its area, at a corner of the design space
            where the source does not.
        segments, source_segments: of all glyphs. kept: of the segments those that stay as the source has them.
        bound: largest certified distance; None if there is no contour.
    """

    glyphs: int = 0
    failed: dict[str, str] = field(default_factory=dict)
    outside: list[str] = field(default_factory=list)
    stopping: list[str] = field(default_factory=list)
    crossing: list[str] = field(default_factory=list)
    collapsed: list[str] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)
    segments: int = 0
    source_segments: int = 0
    kept: int = 0
    bound: float | None = None
    seconds: float = 0.0

    def add(self, entry: Mapping[str, Any]) -> None:
        """Count one line of the manifest."""
        if entry["status"] == "failed":
            self.failed[entry["glyph"]] = entry["error"]
            return
        self.glyphs += 1
        contours, stored = entry["contours"], entry.get("stored")
        for contour in contours:
            self.segments += contour["segments"]
            self.source_segments += contour["source_segments"]
            self.kept += contour["source_segments_kept"]
            self.bound = max(self.bound or 0.0, contour["deviation_bound"])
        for named, holds in (
            (self.outside, any(not each["within_tolerance"] for each in ([stored] if stored else contours))),
            (self.stopping, any(not contour["regular"] for contour in contours)),
            (self.crossing, any(contour["new_crossings"] for contour in contours)),
            (self.collapsed, any(contour["collapsed"] for contour in contours)),
        ):
            named += [entry["glyph"]] * holds

    def facts(self) -> dict[str, Any]:
        """The summary as JSON data."""
        return asdict(self)

    def lines(self) -> Iterator[str]:
        """The lines printed at the end of a run."""
        head = f"{counted(self.glyphs, 'glyph')} in all masters at once, {counted(self.segments, 'segment')}"
        head += f" for {self.source_segments} of the source"
        yield head if self.bound is None else f"{head}, certified within {rounded_up(self.bound, 3):g} units"
        if self.kept:
            yield f"{counted(self.kept, 'segment')} of them stay as the source has them: no curve for all masters there"
        for names, words in (
            (self.outside, "outside the tolerance"),
            (self.stopping, "not proven free of cusps everywhere"),
            (self.crossing, CHANGED["new_crossings"]),
            (self.collapsed, CHANGED["collapsed"]),
        ):
            if names:
                yield f"{words}: {listed(names[:NAMED], len(names))}"
        failed = [f"{name}: {error}" for name, error in self.failed.items()]
        yield from (f"failed: {line}" for line in shortened(failed, NAMED, "{} more, which the manifest lists"))
        yield from self.remarks
