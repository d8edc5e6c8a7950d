"""Glyphs converted in all masters at once, each with its result in a file and a line of the manifest."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...errors import GlyphsplineError
from ...files import make_folder, write_whole
from ...fitting.options import Options
from ...types import rounded_up
from ..engine import Job, reason
from ..entry import journal_line
from ..places import Place, sources
from ..spec import RESULTS
from .glyphs import Done, Task

if TYPE_CHECKING:
    from ...fitting.convert_masters import MastersContourResult, MastersResult
    from ...outlines.masters import Masters

UNMATCHED = "unmatched"
"""The folder of pictures of glyphs whose outlines in single fonts cannot be matched."""


@dataclass(frozen=True)
class MastersJob(Job[Task, list[Done]]):
    """What a worker needs: the font, or the single fonts and their axis; the folder of the run; the options."""

    places: tuple[Place, ...]
    axis: str | None
    out: Path
    options: Options

    budget = 1.0

    def together(self, tasks: Sequence[Task], contents: Sequence[Any]) -> list[Done]:
        """Convert one glyph and store its result."""
        from ...fitting.convert_masters import convert_masters
        from ..result_text import to_text

        (task,) = tasks
        result = convert_masters(self._masters(task), self.options)
        return [_done(task, result, write_whole(f"{self.out}/{_file(task)}", to_text(result)))]

    def failed(self, task: Task, error: Exception) -> list[Done]:
        """The line of a glyph that has no result; it names the font that is at fault, if that is not the first."""
        others = {str(path): path.name for path, _, _ in self.places[1:]}
        where = others.get(error.font or "") if isinstance(error, GlyphsplineError) else None
        return [_done(task, error=f"{where}: {reason(error)}" if where else reason(error))]

    def failures(self, result: list[Done]) -> int:
        """Number of glyphs that failed."""
        return sum(done.status == "failed" for done in result)

    def _masters(self, task: Task) -> Masters:
        from ...readers.single_fonts import Unmatched, masters_of_fonts

        fonts = sources(*self.places)
        if self.axis is None:
            return fonts[0].masters(task.name)
        found = next(iter(masters_of_fonts(fonts, self.axis, [task.name])))
        if isinstance(found, Unmatched):
            from ...writers.svg.unmatched import to_unmatched_svg

            if found.outlines:
                folder = self.out / UNMATCHED
                make_folder(folder)
                write_whole(f"{folder}/{task.stem}.svg", to_unmatched_svg(found.outlines, found.error.message))
            raise found.error
        return found


def _file(task: Task) -> str:
    return f"{RESULTS}/{task.stem}.json"


def _done(task: Task, result: MastersResult | None = None, size: int = 0, error: str | None = None) -> Done:
    """A glyph's line of the manifest: with its result, or why it has none."""
    status = "failed" if result is None else ("ok" if result.contours else "empty")
    line = {
        "glyph": task.name,
        "gid": task.gid,
        "unicodes": [f"U+{code:04X}" for code in task.unicodes],
        "status": status,
        "files": {} if result is None else {RESULTS: _file(task)},
        "masters": None if result is None else len(result.masters),
        "contours": [] if result is None else [_measures(contour) for contour in result.contours],
        "notes": [] if result is None else list(result.notes),
        "kept": None,
        "error": error,
    }
    text = json.dumps(line, ensure_ascii=False)
    return Done(task.gid, task.name, status, journal_line([] if result is None else [size], text))


def _measures(contour: MastersContourResult) -> dict[str, Any]:
    rate = contour.rate_bound
    return {
        "segments": len(contour.curve),
        "source_segments": len(contour.source),
        "iterations": contour.iterations,
        "rate_bound": None if rate is None else rounded_up(rate, 6),
        "deviation_bound": rounded_up(contour.deviation_bound, 6),
        "within_tolerance": contour.within_tolerance,
        "source_segments_kept": contour.kept,
        "regular": contour.regular,
        "new_crossings": contour.new_crossings,
        "collapsed": contour.collapsed,
    }
