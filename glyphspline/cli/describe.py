"""The text output of ``glyphspline info``."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from ..types import counted

SHOWN = 5
"""Maximum number of glyph names in a line."""


def lines_of(facts: Mapping[str, Any]) -> Iterator[str]:
    """The facts that :func:`glyphspline.readers.facts.file_facts` gives, line by line."""
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
        if "broken" not in font:
            continue
        yield from _glyphs(font["broken"], "cannot be read")
        yield from _glyphs(font["degenerate"], "with contours that enclose nothing")
        yield from _glyphs(font["overlaps"] or (), "with overlaps")


def _glyphs(names: Sequence[str], what: str) -> Iterator[str]:
    if names:
        more = ", …" if len(names) > SHOWN else ""
        yield f"  {counted(len(names), 'glyph')} {what}: {', '.join(names[:SHOWN])}{more}"
