"""The facts of a file that need the outlines of all its glyphs, counted by workers."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..engine import Item, Job, Observer, run
from ..schedule import Place, sources

Glyph = tuple[int, int]
"""The number of a face, and a glyph's index."""


@dataclass(frozen=True)
class FactsJob(Job[Glyph, dict[str, Any]]):
    """Facts from the outlines of the glyphs of some faces."""

    places: tuple[Place, ...]

    chunk = 200
    """A few megabytes of outlines."""

    def read(self, tasks: Sequence[Glyph]) -> list[Item | Exception]:
        """Glyphs of one face are looked at together."""
        return [Item(gid, kind=face) for face, gid in tasks]

    def together(self, tasks: Sequence[Glyph], contents: Sequence[Any]) -> dict[str, Any]:
        """The facts of glyphs that follow one another."""
        from ...readers.facts import glyph_facts

        return glyph_facts(sources(self.places[tasks[0][0]])[0], contents[0], contents[-1] + 1)

    def failed(self, task: Glyph, error: Exception) -> dict[str, Any]:
        """A broken glyph."""
        return {"contours": 0, "segments": 0, "broken_glyphs": 1, "broken": [f"gid {task[1]}"], "degenerate": []}

    def failures(self, result: dict[str, Any]) -> int:
        """Number of broken glyphs."""
        return int(result["broken_glyphs"])


def add_glyph_facts(path: Path, facts: dict[str, Any], executor: Executor, observer: Observer | None = None) -> None:
    """Add to each face of :func:`..readers.facts.file_facts` what :func:`..readers.facts.glyph_facts` finds.

    Args:
        path: the file. facts: are added to. executor: of the calls.
        observer: called with the number of glyphs done, of all, and of those that cannot be read.
    """
    faces = facts["fonts"]
    job = FactsJob(tuple((path, face["face_index"], tuple(face["location"].items())) for face in faces))
    tasks = [(k, gid) for k, face in enumerate(faces) for gid in range(face["glyphs"])]
    found = list(run(job, tasks, executor, ordered=True, observer=observer))
    for k, face in enumerate(faces):
        face |= _together([part.result for part in found if part.tasks[0][0] == k])


def _together(parts: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Counts are added, lists joined; overlaps are null if the search needs a missing library."""
    names = ("contours", "segments", "broken_glyphs")
    found: dict[str, Any] = {name: sum(part[name] for part in parts) for name in names}
    found |= {name: [glyph for part in parts for glyph in part[name]] for name in ("broken", "degenerate")}
    looked = [part["overlaps"] for part in parts if part.get("overlaps") is not None]
    return found | {"overlaps": [name for names in looked for name in names] if looked else None}
