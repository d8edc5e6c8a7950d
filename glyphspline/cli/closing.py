"""What a run over fonts ends with: a table, or JSON."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .text_table import plain

if TYPE_CHECKING:
    from ..runs import Summary

FAILURES = 3
"""Glyphs of a font that are named below the table."""


@dataclass
class FontRun:
    """What became of one face of a font.

    Attributes:
        name: of the file, with the face if there are several. out: its folder.
        summary: None if the font could not be read; then ``error`` says why.
    """

    name: str
    out: Path
    summary: Summary | None = None
    error: str | None = None

    @property
    def failed(self) -> int:
        """Number of glyphs that failed; a font that could not be read counts as one."""
        return 1 if self.summary is None else self.summary.failed

    def facts(self) -> dict[str, Any]:
        """The run as JSON data."""
        summary = {} if self.summary is None else self.summary.facts()
        return {"font": self.name, "out": str(self.out), "error": self.error, **summary}


def table(runs: Sequence[FontRun]) -> str:
    """All fonts with the numbers of their glyphs; those with failures come last, and why fonts failed."""
    columns = [[count(run) for run in runs] for count in (glyphs, failed, outside)]
    seconds = [0.0 if run.summary is None else run.summary.seconds for run in runs]
    order = sorted(range(len(runs)), key=lambda k: (runs[k].summary is None, runs[k].failed > 0))
    rows = []
    for k in order:
        cells = ["-"] * 3 if runs[k].summary is None else [str(numbers[k]) for numbers in columns]
        rows.append([runs[k].name, *cells, f"{seconds[k]:.1f}"])
    headings = ("font", "glyphs", "failed", "outside tolerance", "seconds")
    footer = [f"{len(runs)} in all", *[str(sum(numbers)) for numbers in columns], f"{sum(seconds):.1f}"]
    shown = plain(headings, rows, headings[1:], footer)
    return "\n".join([shown, *(line for k in order for line in failures(runs[k]))])


def failures(run: FontRun) -> Iterator[str]:
    """What failed, the first few and the number of the others."""
    if run.error is not None:
        yield f"failed: {run.error}"
    if run.summary is not None and run.summary.failed:
        for glyph, error in run.summary.failures[:FAILURES]:
            yield f"failed: {run.name}: {glyph}: {error}"
        if run.summary.failed > FAILURES:
            yield f"failed: {run.name}: and {run.summary.failed - FAILURES} more, in the manifest"


def totals(runs: Sequence[FontRun]) -> dict[str, Any]:
    """All runs as JSON data."""
    return {
        "fonts": [run.facts() for run in runs],
        "glyphs": sum(map(glyphs, runs)),
        "failed": sum(map(failed, runs)),
        "outside_tolerance": sum(map(outside, runs)),
        "unreadable": sum(run.summary is None for run in runs),
        "missing": sum(len(run.summary.missing) for run in runs if run.summary is not None),
        "seconds": round(sum(run.summary.seconds for run in runs if run.summary is not None), 3),
    }


def glyphs(run: FontRun) -> int:
    """Glyphs of the run's folder that have a result."""
    return 0 if run.summary is None else run.summary.statuses["ok"] + run.summary.statuses["empty"]


def failed(run: FontRun) -> int:
    """Glyphs that failed."""
    return 0 if run.summary is None else run.summary.failed


def outside(run: FontRun) -> int:
    """Glyphs with a contour outside the tolerance."""
    return 0 if run.summary is None else run.summary.outside_tolerance


def missing_words(missing: Sequence[str], shown: int = 10) -> str:
    """What a font does not have: code points with their characters, the first few and the number of the others."""
    from ..runs.summary import listed

    return listed([_with_character(phrase) for phrase in missing[:shown]], len(missing))


def _with_character(phrase: str) -> str:
    if not phrase.startswith("U+") or "-" in phrase:
        return phrase
    character = chr(int(phrase[2:], 16))
    return f"{phrase} {character}" if character.isprintable() and not character.isspace() else phrase
