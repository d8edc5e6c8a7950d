"""Findings as a table on the terminal, JSON, CSV and Markdown."""

from __future__ import annotations

import csv
import json
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict
from io import StringIO
from typing import TYPE_CHECKING

from ...cli.messages import printable
from ...outlines.flaws.kinds import KINDS, Level, Thresholds
from ...types import counted, shortened
from .finding import Finding, place_on_axes

if TYPE_CHECKING:
    from .job import FaceFindings

MARKDOWN_ROWS = 200
"""Findings in Markdown: GitHub takes 65,536 characters."""

COLUMNS = (
    "font", "glyph", "gid", "level", "kind", "contour", "segment", "parameter", "x", "y", "value", "unit", "detail",
    "other", "location", "between", "sentence", "seen", "score",
)  # fmt: skip
"""Of CSV."""

NUMBERS = ("score", "contour", "segment", "point")
"""Columns of tables that are aligned to the right."""

LEVEL_OF: Mapping[str, Level] = {kind.name: kind.level for kind in KINDS}


def columns(found: Sequence[tuple[FaceFindings, Finding]], several: bool) -> tuple[list[str], list[list[str]]]:
    """Headings and rows of a table of findings, with the fonts' names if there are ``several``."""
    located = any(finding.location for _, finding in found)
    headings = ["font"] * several + ["glyph", "level", *NUMBERS, "finding"] + ["location"] * located
    rows = [
        [face.font] * several
        + [finding.glyph, finding.level, f"{face.scores.get(finding.glyph, 0.0):.0f}"]
        + [str(finding.contour), str(finding.segment)]
        + ["{:.0f}, {:.0f}".format(*finding.point), f"{finding.kind}: {finding.sentence}"]
        + [place_on_axes(finding, face.home)] * located
        for face, finding in found
    ]
    return headings, rows


def counts_words(counts: Mapping[str, int], level: Level | None = None) -> str:
    """Counts by kind: "12 kink, 3 jump"; of one level, or all."""
    return ", ".join(
        [f"{counts[kind]} {kind}" for kind in LEVEL_OF if counts[kind] and level in (None, LEVEL_OF[kind])]
    )


def sentences(faces: Sequence[FaceFindings], found: int, shown: int, level: Level) -> Iterator[str]:
    """What the table does not say: what is left out of it, and what could not be checked."""
    counts = sum((face.counts for face in faces), Counter())
    checked = counted(sum(face.glyphs for face in faces), "glyph")
    if len(faces) > 1:
        checked += f" of {counted(sum(face.error is None for face in faces), 'font')}"
    yield f"{checked}: {counted(found, 'finding')} of {'any level' if level == 'INFO' else level}"
    if found > shown:
        yield f"and {found - shown} more; --rows {found} shows all"
    again = sum((face.repeated for face in faces), Counter())
    if number := sum(again[kind] for kind in again if level in ("INFO", LEVEL_OF[kind])):
        yield f"not counted, as other glyphs have the same contours: {number}"
    if level == "WARN" and (words := counts_words(counts, "INFO")):
        yield f"INFO, shown with -l INFO: {words}"
    if known := sum(face.known for face in faces):
        yield f"not counted, as the baseline has them: {known}"
    failed, broken = failures(faces)
    for lines, noun in ((failed, "glyphs"), (broken, "fonts")):
        yield from (f"not checked: {line}" for line in shortened(lines, 3, f"and {{}} {noun} more"))
    parts = [f"{glyph}: {what}" for face in faces for glyph, what in face.unread]
    yield from (f"not read: {line}" for line in shortened(parts, 3, "of {} glyphs more"))


def failures(faces: Sequence[FaceFindings]) -> tuple[list[str], list[str]]:
    """Glyphs that could not be checked, and fonts, with the reasons."""
    failed = [f"{face.font}: {glyph}: {error}" for face in faces for glyph, error in face.failed]
    return failed, [face.error for face in faces if face.error is not None]


def as_json(faces: Sequence[FaceFindings], thresholds: Thresholds) -> str:
    """All faces as JSON: each with its findings, kinks along its axes in numbers, and glyphs that failed."""
    fonts = [
        {
            "font": face.font,
            "family": face.family,
            "style": face.style,
            "error": face.error,
            "glyphs": face.glyphs,
            "counts": {kind: face.counts[kind] for kind in LEVEL_OF if face.counts[kind]},
            "repeated": {kind: face.repeated[kind] for kind in LEVEL_OF if face.repeated[kind]},
            "known": face.known,
            "scores": face.scores,
            "axes": [asdict(numbers) for numbers in face.axes],
            "findings": [asdict(finding) for finding in face.findings],
            "failed": [{"glyph": glyph, "error": error} for glyph, error in face.failed],
            "unread": dict(face.unread),
        }
        for face in faces
    ]
    return json.dumps({"thresholds": asdict(thresholds), "fonts": fonts}, indent=1, ensure_ascii=False)


def as_csv(found: Sequence[tuple[FaceFindings, Finding]]) -> str:
    """A line for each finding, below a header. Text that a spreadsheet would compute is kept from it."""
    text = StringIO()
    writer = csv.writer(text)  # lines end with \r\n, as RFC 4180 has them
    writer.writerow(COLUMNS)
    for face, item in found:
        own = {
            "font": face.font,
            "x": item.point[0],
            "y": item.point[1],
            "location": " ".join([f"{tag}={value!r}" for tag, value in item.location.items()]),
            "between": "" if item.between is None else "{!r} {!r}".format(*item.between),
            "score": face.scores.get(item.glyph, 0.0),
        }
        cells = [own[name] if name in own else getattr(item, name) for name in COLUMNS]
        writer.writerow([_inert(cell) if isinstance(cell, str) else cell for cell in cells])
    return text.getvalue()


def _inert(text: str) -> str:
    return f"'{text}" if text[:1] in ("=", "+", "-", "@", "\t", "\r") else text


def as_markdown(faces: Sequence[FaceFindings], found: Sequence[tuple[FaceFindings, Finding]], level: Level) -> str:
    """A heading with counts and a table of the worst findings, as GitHub shows it in a comment or a summary."""
    counts = sum((face.counts for face in faces), Counter())
    lines = [
        "### glyphspline check",
        "",
        f"{counted(sum(face.glyphs for face in faces), 'glyph')} of "
        f"{_code(faces[0].font) if len(faces) == 1 else counted(len(faces), 'font')}: "
        f"{counts_words(counts) or 'no findings'}.",
    ]
    if found:
        headings, rows = columns(found[:MARKDOWN_ROWS], len(faces) > 1)
        lines += ["", _row(headings), _row("---:" if heading in NUMBERS else "---" for heading in headings)]
        for cells in rows:
            named = zip(headings, cells, strict=True)
            lines.append(_row(_code(cell) if heading in ("font", "glyph") else _plain(cell) for heading, cell in named))
    if len(found) > MARKDOWN_ROWS:
        lines += ["", f"And {len(found) - MARKDOWN_ROWS} more."]
    if level == "WARN" and (words := counts_words(counts, "INFO")):
        lines += ["", f"Not listed, INFO: {words}."]
    if unchecked := [line for part in failures(faces) for line in part]:
        lines += ["", *[f"- not checked: {_code(line)}" for line in unchecked[:MARKDOWN_ROWS]]]
    return "\n".join(lines) + "\n"


def _row(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _plain(text: str) -> str:
    """Text that Markdown shows as it is, in a cell too."""
    line = printable(text).replace("\n", " ").replace("&", "&amp;")
    return re.sub(r"[\\`*_{}\[\]<>#|~@$]", lambda found: f"&#{ord(found[0])};", line)


def _code(text: str) -> str:
    """A name from a font or a path; as code, in which ``@`` mentions no user."""
    return f"<code>{_plain(text)}</code>"
