"""The facts of a file that need the outlines of all its glyphs, counted by workers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from pathlib import Path
from typing import Any

from .calls import look
from .schedule import slices, spread

BATCH = 200
"""Glyphs looked at in a call: a few megabytes of outlines."""


def add_glyph_facts(
    path: Path, facts: dict[str, Any], executor: Executor, observer: Callable[[int, int, int], None] | None = None
) -> None:
    """Add to each face of :func:`..readers.facts.file_facts` what :func:`..readers.facts.glyph_facts` finds.

    Args:
        path: the file. facts: are added to. executor: of the calls.
        observer: called with the number of glyphs done, of all, and of those that cannot be read.
    """
    total = sum(font["glyphs"] for font in facts["fonts"])
    done = broken = 0
    for font in facts["fonts"]:
        place = (path, font["face_index"], tuple(font["location"].items()))
        parts = {}
        for gids, part in spread(executor, look, place, slices(range(font["glyphs"]), BATCH)):
            lost: dict[str, Any] = {
                "contours": 0,
                "segments": 0,
                "broken_glyphs": 1,
                "broken": [f"gid {gids[0]}"],
                "degenerate": [],
            }
            found = part if isinstance(part, dict) else lost
            parts[gids[0]] = found
            done, broken = done + len(gids), broken + found["broken_glyphs"]
            if observer:
                observer(done, total, broken)
        font |= _together([parts[first] for first in sorted(parts)])


def _together(parts: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Counts are added, lists put end to end; overlaps are null if nobody could look for them."""
    names = ("contours", "segments", "broken_glyphs")
    found: dict[str, Any] = {name: sum(part[name] for part in parts) for name in names}
    found |= {name: [glyph for part in parts for glyph in part[name]] for name in ("broken", "degenerate")}
    looked = [part["overlaps"] for part in parts if part.get("overlaps") is not None]
    return found | {"overlaps": [name for names in looked for name in names] if looked else None}
