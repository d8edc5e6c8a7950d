"""Findings as a table on the terminal, JSON, CSV and Markdown."""

from __future__ import annotations

import csv
import json
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from io import StringIO
from typing import TYPE_CHECKING, Any

from ..checks.finding import place_on_axes
from ..checks.kinds import KINDS, Level
from ..types import counted
from .messages import printable
from .text_table import plain

if TYPE_CHECKING:
    from ..checks.finding import Finding
    from ..checks.kinds import Thresholds
    from ..runs.check_fonts import Face

MARKDOWN_ROWS = 200
"""Findings in Markdown: GitHub takes 65,536 characters."""

FAILURES = 3
"""Glyphs and fonts that are named below the table."""

COLUMNS = (
    "font", "glyph", "gid", "level", "kind", "contour", "segment", "parameter", "x", "y", "value", "unit", "detail",
    "other", "location", "between", "sentence",
)  # fmt: skip
"""Of CSV."""

LEVEL_OF: Mapping[str, Level] = {kind.name: kind.level for kind in KINDS}


def table(found: Sequence[tuple[Face, Finding]], shown: int, several: bool) -> str:
    """The worst findings, one a line."""
    located = any(finding.location for _, finding in found[:shown])
    headings = ("font",) * several + ("glyph", "level", "contour", "segment", "point", "finding")
    rows = []
    for face, finding in found[:shown]:
        cells = [face.font] * several + [finding.glyph, finding.level, str(finding.contour), str(finding.segment)]
        cells += ["{:.0f}, {:.0f}".format(*finding.point), f"{finding.kind}: {finding.sentence}"]
        rows.append(cells + [place_on_axes(finding, face.home)] * located)
    return plain(headings + ("location",) * located, rows, numbers=("contour", "segment", "point"))


def counts_words(counts: Mapping[str, int], level: Level | None = None) -> str:
    """Counts by kind: "12 kink, 3 jump"; of one level, or all."""
    return ", ".join(
        [f"{counts[kind]} {kind}" for kind in LEVEL_OF if counts[kind] and level in (None, LEVEL_OF[kind])]
    )


def sentences(faces: Sequence[Face], found: int, shown: int, level: Level) -> Iterator[str]:
    """What the table does not say: what is left out of it, and what could not be checked."""
    counts = sum((face.counts for face in faces), Counter())
    checked = counted(sum(face.glyphs for face in faces), "glyph")
    if len(faces) > 1:
        checked += f" of {counted(sum(face.error is None for face in faces), 'font')}"
    yield f"{checked}: {counted(found, 'finding')} of {'any level' if level == 'INFO' else level}"
    if found > shown:
        yield f"and {found - shown} more; --rows {found} shows all"
    if level == "WARN" and (words := counts_words(counts, "INFO")):
        yield f"INFO, shown with -l INFO: {words}"
    if known := sum(face.known for face in faces):
        yield f"not counted, as the baseline has them: {known}"
    failed = [(face.font, *pair) for face in faces for pair in face.failed]
    yield from [f"not checked: {font}: {glyph}: {error}" for font, glyph, error in failed[:FAILURES]]
    if len(failed) > FAILURES:
        yield f"not checked: and {len(failed) - FAILURES} glyphs more"
    unread = [face.error for face in faces if face.error is not None]
    yield from [f"not checked: {error}" for error in unread[:FAILURES]]
    if len(unread) > FAILURES:
        yield f"not checked: and {len(unread) - FAILURES} fonts more"


def as_json(faces: Sequence[Face], thresholds: Thresholds) -> str:
    """All faces as JSON: each with its findings, kinks along its axes in numbers, and glyphs that failed."""
    data = {"thresholds": asdict(thresholds), "fonts": [face_facts(face) for face in faces]}
    return json.dumps(data, indent=1, ensure_ascii=False)


def face_facts(face: Face) -> dict[str, Any]:
    """A face as JSON data."""
    return {
        "font": face.font,
        "family": face.family,
        "style": face.style,
        "error": face.error,
        "glyphs": face.glyphs,
        "counts": {kind: face.counts[kind] for kind in LEVEL_OF if face.counts[kind]},
        "known": face.known,
        "axes": [asdict(numbers) for numbers in face.axes],
        "findings": [asdict(finding) for finding in face.findings],
        "failed": [{"glyph": glyph, "error": error} for glyph, error in face.failed],
    }


def as_csv(found: Sequence[tuple[Face, Finding]]) -> str:
    """A line for each finding, below a header. Text that a spreadsheet would compute is kept from it."""
    text = StringIO()
    writer = csv.writer(text)  # lines end with \r\n, as RFC 4180 has them
    writer.writerow(COLUMNS)
    for face, item in found:
        location = " ".join([f"{tag}={value!r}" for tag, value in item.location.items()])
        between = "" if item.between is None else "{!r} {!r}".format(*item.between)
        row = [
            face.font, item.glyph, item.gid, item.level, item.kind, item.contour, item.segment, item.parameter,
            *item.point, item.value, item.unit, item.detail, item.other, location, between, item.sentence,
        ]  # fmt: skip
        writer.writerow([_inert(cell) if isinstance(cell, str) else cell for cell in row])
    return text.getvalue()


def _inert(text: str) -> str:
    return f"'{text}" if text[:1] in ("=", "+", "-", "@", "\t", "\r") else text


def as_markdown(faces: Sequence[Face], found: Sequence[tuple[Face, Finding]], level: Level) -> str:
    """A heading with counts and a table of the worst findings, as GitHub shows it in a comment or a summary."""
    counts = sum((face.counts for face in faces), Counter())
    lines = [
        "### glyphspline check",
        "",
        f"{counted(sum(face.glyphs for face in faces), 'glyph')} of "
        f"{_code(faces[0].font) if len(faces) == 1 else counted(len(faces), 'font')}: "
        f"{counts_words(counts) or 'no findings'}.",
    ]
    columns = [("font", "---")] * (len(faces) > 1) + [("glyph", "---"), ("level", "---"), ("contour", "---:")]
    columns += [("segment", "---:"), ("point", "---:"), ("finding", "---")]
    located = any(item.location for _, item in found)
    columns += [("location", "---")] * located
    if found:
        lines += ["", *[f"| {' | '.join(cells)} |" for cells in zip(*columns, strict=True)]]
    for face, item in found[:MARKDOWN_ROWS]:
        cells = [_code(face.font)] * (len(faces) > 1) + [_code(item.glyph), item.level, str(item.contour)]
        cells += [str(item.segment), "{:.0f}, {:.0f}".format(*item.point), _plain(f"{item.kind}: {item.sentence}")]
        cells += [_plain(place_on_axes(item, face.home))] * located
        lines.append(f"| {' | '.join(cells)} |")
    if len(found) > MARKDOWN_ROWS:
        lines += ["", f"And {len(found) - MARKDOWN_ROWS} more."]
    if level == "WARN" and (words := counts_words(counts, "INFO")):
        lines += ["", f"Not listed, INFO: {words}."]
    failed = [f"{face.font}: {glyph}: {error}" for face in faces for glyph, error in face.failed]
    failed += [face.error for face in faces if face.error is not None]
    if failed:
        lines += ["", *[f"- not checked: {_code(line)}" for line in failed[:MARKDOWN_ROWS]]]
    return "\n".join(lines) + "\n"


def _plain(text: str) -> str:
    """Text that Markdown shows as it is, in a cell too."""
    line = printable(text).replace("\n", " ").replace("&", "&amp;")
    return re.sub(r"[\\`*_{}\[\]<>#|~@$]", lambda found: f"&#{ord(found[0])};", line)


def _code(text: str) -> str:
    """A name from a font or a path; as code it mentions nobody."""
    return f"<code>{_plain(text)}</code>"
