"""A plug-in of fontspector, which gives what ``glyphspline check`` finds in its report.

fontspector runs ``glyphspline-fontspector --metadata`` for the profile ``glyphspline`` and its checks, and
``glyphspline-fontspector --check glyphspline/outlines FONT`` for the findings in a font, as JSON. A check is of one
type of files, so sources have checks of their own. Thresholds, kinds and baseline are those of
``[tool.glyphspline.check]`` in the ``pyproject.toml`` of the working folder.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from dataclasses import replace
from itertools import groupby
from pathlib import Path
from typing import Any

from ...errors import GlyphsplineError
from ...extras import need
from ...types import shortened
from .finding import Finding, severity

PROFILE = "glyphspline"
CHECK = "glyphspline/outlines"

SOURCES = {"UFO": "metainfo.plist", "DESIGNSPACE": "*.designspace", "GLYPHS": "*.glyphs"}
"""Types of source files, which fontspector does not know by itself, and the names of such files. fontspector reads all
files that it is given, and no folders: a UFO is given by the file that makes its folder one."""

LISTED = 10
"""Findings of a kind that are named in a message, as in fontspector's own; its ``metadata`` has all."""

RATIONALE = (
    "Joints that are meant to be smooth but turn, jumps and swellings of curvature, nearly straight segments, missing "
    "points at extrema, crossing and wrongly directed contours, in the outlines as the font has them; of a variable "
    "font also between its masters. The code of a message is the kind of its findings."
)


def main() -> int:
    """The command ``glyphspline-fontspector``; returns its exit status."""
    try:
        api = need("fontspector")
    except GlyphsplineError as error:
        sys.stderr.write(f"glyphspline-fontspector: {error}\n")
        return 2
    try:
        status = int(api.plugin_main(register, plugin_name="glyphspline"))
        sys.stdout.flush()
    except BrokenPipeError:  # nobody reads on, as behind ``| head``
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    return status


def register(plugin: Any) -> None:
    """Register the checks and the profile with fontspector's plug-in."""
    api = need("fontspector")
    title = "Are outlines free of kinks, curvature jumps and other faults?"
    for kind, pattern in SOURCES.items():
        plugin.register_filetype(kind, pattern)
    checks = []
    for kind in ("TTF", *SOURCES):
        check = api.check(id=check_of(kind), title=title, rationale=RATIONALE, applies_to=kind)
        checks.append(check(lambda font: outlines(font)))  # a function of its own for each
    plugin.register_simple_profile(PROFILE, checks, "Outlines")


def check_of(kind: str) -> str:
    """The name of the check of a type of files."""
    return CHECK if kind == "TTF" else f"{CHECK}/{kind.lower()}"


def outlines(font: Path) -> Iterator[Any]:
    """The statuses of a font or source, a message for each kind of finding; PASS without any.

    Raises:
        GlyphsplineError: the font cannot be read; fontspector reports an ERROR.
    """
    api = need("fontspector")
    found, failed = found_in(font.parent if font.name == SOURCES["UFO"] else font)
    for kind, same in groupby(sorted(found, key=severity), key=lambda finding: finding.kind):
        findings = list(same)
        words = [
            "{0.glyph}, contour {0.contour}, segment {0.segment}, at ({1:.0f}, {2:.0f}): {0.sentence}".format(
                item, *item.point
            )
            for item in findings
        ]
        message = listed("Found in these places:", words)
        yield findings[0].level, api.Message(kind, message, [problem(item) for item in findings])
    if failed:
        words = [f"{glyph}: {error}" for glyph, error in failed]
        yield "WARN", api.Message("not-checked", listed("Glyphs that cannot be checked:", words))
    if not (found or failed):
        yield "PASS"


def found_in(font: Path) -> tuple[list[Finding], list[tuple[str, str]]]:
    """The findings in all faces of a font, and glyphs that cannot be checked, with the reasons."""
    from .command import project_settings
    from .job import check_fonts

    asked, subset, instance = project_settings()
    chosen = subset.of if subset.is_given else None
    faces = list(
        check_fonts(
            [font], replace(asked, kept="INFO"), chosen=chosen, face_index=instance.face_index,
            location=instance.place, jobs=0,
        )
    )  # fmt: skip
    for face in faces:
        if face.error is not None:
            raise GlyphsplineError(face.error)
    return [item for face in faces for item in face.findings], [pair for face in faces for pair in face.failed]


def listed(heading: str, items: list[str]) -> str:
    """A heading, the first items of a list, and how many are left out, in Markdown."""
    return "\n".join([heading, "", *(f"* {item}" for item in shortened(items, LISTED))])


def problem(finding: Finding) -> dict[str, Any]:
    """A finding as fontspector's metadata, for editors."""
    location = {"userspace_location": finding.location} if finding.location else {}
    actual = {
        "contour": finding.contour, "segment": finding.segment, "parameter": finding.parameter,
        "value": finding.value, "unit": finding.unit,
    }  # fmt: skip
    return {
        "GlyphProblem": {
            "glyph_name": finding.glyph, "glyph_id": finding.gid, "position": list(finding.point), "actual": actual,
            "message": finding.sentence, **location,
        }
    }  # fmt: skip
