"""Tables and lines of text: what a font holds, and what became of several fonts."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..types import counted, listed
from .messages import printable

if TYPE_CHECKING:
    from ..runs.summary import Summary


def plain(
    headings: Sequence[str], rows: Iterable[Sequence[str]], numbers: Sequence[str] = (), footer: Sequence[str] = ()
) -> str:
    """A table.

    Args:
        headings: of the columns. rows: their cells; what fonts have in names moves no cursor.
        numbers: headings of the columns that are aligned to the right. footer: cells of the last line, if there is one.
    """
    from rich import box
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    lines = Table(box=box.ASCII2, show_edge=False, show_footer=bool(footer))
    for k, heading in enumerate(headings):
        below = footer[k] if footer else ""
        lines.add_column(heading, footer=below, justify="right" if heading in numbers else "left")
    for cells in rows:
        lines.add_row(*[Text(printable(cell)) for cell in cells])
    text = StringIO()
    Console(file=text, width=1000, color_system=None).print(lines)  # terminals break lines themselves
    return "\n".join([line.rstrip() for line in text.getvalue().splitlines()])


def named(glyphs: Sequence[str], what: str, shown: int) -> Iterator[str]:
    """The number of glyphs and the names of the first; nothing if there are none."""
    if glyphs:
        yield f"{counted(len(glyphs), 'glyph')}{what}: {listed(glyphs[:shown], len(glyphs))}"


def font_lines(facts: Mapping[str, Any]) -> Iterator[str]:
    """The facts that :func:`glyphspline.readers.open.file_facts` gives, line by line."""
    yield f"{facts['file']}: {facts['format']}, {counted(facts['faces'], 'face')}"
    for font in facts["fonts"]:
        yield f"face {font['face_index']}: {font['family']} {font['style']}"
        yield (
            f"  {font['units_per_em']:g} units per em, ascender {font['ascender']:g}, descender {font['descender']:g}"
        )
        for axis in font["axes"]:
            limits = f"{axis['minimum']:g} to {axis['maximum']:g}, default {axis['default']:g}"
            yield f"  axis {axis['tag']} ({axis['name']}): {limits}"
        if font["instances"]:
            yield f"  named instances: {', '.join(font['instances'])}"
        counts = [f"{font[what]} {what}" for what in ("glyphs", "characters", "contours", "segments") if what in font]
        yield f"  {', '.join(counts)}"
        for key, what in (
            ("doubled_points", "points that are there more than once"),
            ("leftover_points", "points on a line between two others"),
            ("contours_left_out", "contours that enclose nothing: of one or two points, or on a line"),
            ("open_contours", "open paths, or strokes of a single-line font"),
        ):
            if key in font:
                yield f"  {font[key]:,} {what}"
        for key, what in (
            ("broken", "cannot be read"),
            ("degenerate", "with contours that enclose nothing"),
            ("overlaps", "with overlaps"),
        ):
            yield from (f"  {line}" for line in named(font.get(key) or (), f" {what}", 5))


@dataclass
class FontRun:
    """What became of one face of a font.

    Attributes:
        name: of the file, with the face if there are several. out: its folder.
        error: why the font could not be read; its summary is empty then.
    """

    name: str
    out: Path
    summary: Summary
    error: str | None = None

    @property
    def counts(self) -> tuple[int, int, int]:
        """Glyphs of the folder that have a result, that failed, and with a contour outside the tolerance."""
        statuses = self.summary.statuses
        return statuses["ok"] + statuses["empty"], statuses["failed"], self.summary.outside_tolerance

    @property
    def undone(self) -> bool:
        """Whether something asked for was not done."""
        return self.error is not None or self.summary.undone

    def failures(self) -> Iterator[str]:
        """What failed, the first three and the number of the others."""
        if self.error is not None:
            yield f"failed: {self.error}"
        for glyph, error in self.summary.failures[:3]:
            yield f"failed: {self.name}: {glyph}: {error}"
        if self.summary.failed > 3:
            yield f"failed: {self.name}: and {self.summary.failed - 3} more, in the manifest"


def runs_table(runs: Sequence[FontRun]) -> str:
    """All fonts with the numbers of their glyphs; those with failures come last, and why fonts failed."""
    order = sorted(runs, key=lambda run: (run.error is not None, run.summary.failed > 0))
    rows = [[run.name, *("---" if run.error else map(str, run.counts)), f"{run.summary.seconds:.1f}"] for run in order]
    headings = ("font", "glyphs", "failed", "outside tolerance", "seconds")
    sums = [str(sum(column)) for column in zip(*(run.counts for run in runs), strict=True)]
    footer = [f"{len(runs)} in all", *sums, f"{sum(run.summary.seconds for run in runs):.1f}"]
    return "\n".join([plain(headings, rows, headings[1:], footer), *(line for run in order for line in run.failures())])


def runs_facts(runs: Sequence[FontRun]) -> dict[str, Any]:
    """All runs as JSON data."""
    glyphs, failed, outside = (sum(column) for column in zip(*(run.counts for run in runs), strict=True))
    return {
        "fonts": [
            {"font": run.name, "out": str(run.out), "error": run.error, **({} if run.error else run.summary.facts())}
            for run in runs
        ],
        "glyphs": glyphs,
        "failed": failed,
        "outside_tolerance": outside,
        "unreadable": sum(run.error is not None for run in runs),
        "missing": sum(len(run.summary.missing) for run in runs),
        "seconds": round(sum(run.summary.seconds for run in runs), 3),
    }


def with_character(phrase: str) -> str:
    """Code points, "U+9F8D", with their character; other phrases as they are."""
    if not phrase.startswith("U+") or "-" in phrase:
        return phrase
    character = "".join([chr(int(code[2:], 16)) for code in phrase.split()])
    return f"{phrase} {character}" if character[0].isprintable() and not character.isspace() else phrase
