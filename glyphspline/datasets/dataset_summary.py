"""Counts of a data set that was made."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from ..types import counted
from .licences import UNKNOWN
from .plan import Plan, Shard
from .scan import SPLITS
from .shards import OfFont

STATUSES = ("taken", "left out", "duplicate", "failed")
"""Of fonts."""

SHOWN = 5
"""Fonts that failed and are named."""


@dataclass
class OfSplit:
    """Counts of a split; ``bytes`` of its files."""

    families: int = 0
    fonts: int = 0
    glyphs: int = 0
    rows: int = 0
    duplicates: int = 0
    bytes: int = 0


@dataclass
class Summary:
    """Counts of a data set.

    Attributes:
        splits: by name. fonts: faces, at each of their locations, by status: taken, left out, duplicate, failed.
        licences: fonts and rows by licence. failed: glyphs that have no rows, and some of them: (font, glyph, reason).
        unread: the first few fonts that failed: (file, reason). seconds: that the run took.
    """

    splits: dict[str, OfSplit] = field(default_factory=dict)
    fonts: dict[str, int] = field(default_factory=lambda: dict.fromkeys(STATUSES, 0))
    licences: dict[str, tuple[int, int]] = field(default_factory=dict)
    failed: int = 0
    failures: list[tuple[str, str, str]] = field(default_factory=list)
    unread: list[tuple[str, str]] = field(default_factory=list)
    seconds: float = 0.0

    @classmethod
    def of(cls, plan: Plan, totals: Mapping[int, OfFont], sizes: Mapping[Shard, int]) -> Summary:
        """The counts of a plan that was carried out, from those of each font and the sizes of shards."""
        found = cls()
        families: dict[str, set[str | None]] = {split: set() for split in SPLITS}
        for number, font in enumerate(plan.fonts):
            found.fonts[font.status] += 1
            if font.status == "failed" and len(found.unread) < SHOWN:
                found.unread.append((font.file, font.reason or ""))
            if font.split is None:
                continue
            own = totals.get(number, OfFont())
            split = found.splits.setdefault(font.split, OfSplit())
            families[font.split].add(font.family)
            split.fonts += 1
            split.glyphs += own.glyphs
            split.rows += own.rows
            split.duplicates += own.duplicates
            fonts, rows = found.licences.get(font.licence or UNKNOWN, (0, 0))
            found.licences[font.licence or UNKNOWN] = fonts + 1, rows + own.rows
            found.failed += own.failed
            found.failures += [(font.file, *pair) for pair in own.reasons][: SHOWN - len(found.failures)]
        for name, split in found.splits.items():
            split.families = len(families[name])
            split.bytes = sum(size for shard, size in sizes.items() if shard.split == name)
        return found

    @property
    def rows(self) -> int:
        """Number of rows of all splits."""
        return sum(split.rows for split in self.splits.values())

    @property
    def glyphs(self) -> int:
        """Number of glyphs of all splits."""
        return sum(split.glyphs for split in self.splits.values())

    @property
    def bytes(self) -> int:
        """Size of the shards."""
        return sum(split.bytes for split in self.splits.values())

    def facts(self) -> dict[str, Any]:
        """As plain data."""
        return asdict(self) | {"rows": self.rows, "glyphs": self.glyphs, "bytes": self.bytes}

    def lines(self) -> Iterator[str]:
        """What is said of it."""
        rest = [f"{count} {status}" for status, count in sorted(self.fonts.items()) if count and status != "taken"]
        more = f" ({', '.join(rest)})" if rest else ""
        size = f"{self.bytes / 1e6:.1f} MB"
        yield (
            f"{counted(self.rows, 'row')} of {counted(self.glyphs, 'glyph')} of {counted(self.fonts['taken'], 'font')}"
            f"{more}, {size}, in {self.seconds:.1f} s"
        )
        for file, reason in self.unread:
            yield f"{file}: {reason}"
        if self.failed:
            yield f"{counted(self.failed, 'glyph')} failed"
            for file, glyph, reason in self.failures:
                yield f"{file}, {glyph}: {reason}"
