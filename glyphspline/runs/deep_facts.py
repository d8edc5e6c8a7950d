"""The facts of a file that need the outlines of all its glyphs, counted by workers."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..errors import GlyphsplineError
from ..extras import has
from ..outlines.contour_arrays import joined
from ..outlines.open_paths import are_open
from ..outlines.outline import Outline
from ..readers.pens import NO_AREA
from .engine import Item, Job, Observer, run
from .schedule import Place, sources

COUNTS = (
    "contours", "open_contours", "segments", "doubled_points", "leftover_points", "contours_left_out", "broken_glyphs"
)  # fmt: skip
"""Facts that are numbers."""


@dataclass(frozen=True)
class FactsJob(Job[int, dict[str, Any]]):
    """Facts from the outlines of glyphs, by their indices."""

    place: Place

    chunk = 200
    """A few megabytes of outlines."""

    def read(self, tasks: Sequence[int]) -> list[Item | Exception]:
        """Outlines. A face that cannot be opened is not opened for each."""
        try:
            (source,) = sources(self.place)
            read = source.outlines(tasks, errors="return")
        except GlyphsplineError as error:
            return [error] * len(tasks)
        return [Item(each, len(each.arrays.degrees)) if isinstance(each, Outline) else each for each in read]

    def together(self, tasks: Sequence[int], contents: Sequence[Any]) -> dict[str, Any]:
        """Facts from the outlines of glyphs: counts, and unusual glyphs by name.

        ``doubled_points`` are those that readers leave out, ``leftover_points`` those of :mod:`..checks` on lines.
        ``overlaps`` are glyphs with contours that overlap or cross themselves; parts of them are filled twice. It is
        null if skia-pathops (the extra ``overlaps``) is not installed. ``degenerate`` glyphs have contours that enclose
        nothing: of one or two points mostly, which TrueType fonts use as anchors. ``contours_left_out`` counts these.
        """
        left_out = [sum(NO_AREA in note for note in outline.notes) for outline in contents]
        return {
            "contours": sum(len(outline.contours) for outline in contents),
            "open_contours": sum(int(are_open(outline.arrays).sum()) for outline in contents),
            "segments": sum(len(outline.arrays.degrees) for outline in contents),
            "doubled_points": sum(int(outline.repeats.sum()) for outline in contents if outline.repeats is not None),
            "leftover_points": leftovers(contents),
            "contours_left_out": sum(left_out),
            "broken_glyphs": 0,
            "broken": [],
            "degenerate": [outline.name for outline, count in zip(contents, left_out, strict=True) if count],
            "overlaps": [outline.name for outline in contents if overlaps(outline)] if has("overlaps") else None,
        }

    def failed(self, task: int, error: Exception) -> dict[str, Any]:
        """A broken glyph."""
        name = getattr(error, "glyph", None) or f"gid {task}"
        return dict.fromkeys(COUNTS, 0) | {"broken_glyphs": 1, "broken": [name], "degenerate": []}


def add_glyph_facts(path: Path, facts: dict[str, Any], executor: Executor, observer: Observer | None = None) -> None:
    """Add to each face of :func:`..readers.open.file_facts` what :meth:`FactsJob.together` finds.

    Args:
        path: the file. facts: are added to. executor: of the calls.
        observer: called with the number of glyphs done, of all, and of those that cannot be read.
    """
    done, total = 0, sum(face["glyphs"] for face in facts["fonts"])
    for face in facts["fonts"]:
        job = FactsJob((path, face["face_index"], tuple(face["location"].items())))
        found = run(job, range(face["glyphs"]), executor, ordered=True, observer=observer, before=done, total=total)
        face |= _together([part.result for part in found])
        done += face["glyphs"]


def _together(parts: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Counts are added, lists joined; overlaps are null if the search needs a missing library."""
    found: dict[str, Any] = {name: sum(part[name] for part in parts) for name in COUNTS}
    found |= {name: [glyph for part in parts for glyph in part[name]] for name in ("broken", "degenerate")}
    looked = [part["overlaps"] for part in parts if part.get("overlaps") is not None]
    return found | {"overlaps": [name for names in looked for name in names] if looked else None}


def leftovers(outlines: Sequence[Outline]) -> int:
    """Number of points on lines in glyphs of one em, at least one."""
    from ..outlines.flaws.joints import WHAT, Segments, joint_findings
    from ..outlines.flaws.kinds import LEFTOVER, THRESHOLDS
    from ..outlines.segments import all_cubics

    contours = joined([outline.arrays for outline in outlines])
    limits = THRESHOLDS.limits(outlines[0].metrics.units_per_em)
    found = joint_findings(Segments.of(all_cubics(contours), contours), limits)
    return int((found[:, WHAT] == LEFTOVER).sum())


def overlaps(outline: Outline) -> bool:
    """Whether any part of a glyph is filled twice or inside out: its area then differs from the sum over contours."""
    import pathops

    from ..curves.integrals import area
    from ..outlines.overlaps import contours_of

    if not outline.contours:
        return False
    path = pathops.Path()
    for contour in outline.contours:
        contour.draw(path.getPen(), stays_open=False)
    try:
        path.simplify(fix_winding=True)
    except pathops.PathOpsError:
        return False  # Skia fails on the glyph
    filled, summed = (
        sum(area(contour.cubics()) for contour in contours) for contours in (contours_of(path), outline.contours)
    )
    # Share of a square em below which the area of an overlap counts as rounding.
    return abs(abs(filled) - abs(summed)) > 1e-5 * outline.metrics.units_per_em**2
