"""A few glyphs looked at before or after a run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ..engine import Item, Job
from ..places import Side, readers
from ..spec import RunSpec
from .glyphs import Task

if TYPE_CHECKING:
    from ...curves.curvature import Comb


@dataclass(frozen=True)
class SurveyJob(Job[Task, "list[Comb]"]):
    """The combs of outlines, for a run's curvature scale; glyphs that fail are skipped.

    They are reported when they are converted for their files. Chunks are small, so that a run over few glyphs uses all
    workers.
    """

    side: Side
    spec: RunSpec

    chunk = 4
    budget = 1.0

    def read(self, tasks: Sequence[Task]) -> list[Item | Exception]:
        """Outlines."""
        from ..worker import read

        return read(self.side, tasks, self.spec)

    def together(self, tasks: Sequence[Task], contents: Sequence[Any]) -> list[Comb]:
        """The combs of outlines."""
        from ...fitting.results import as_glyph
        from ...writers.svg.curvature_map import combs

        return [comb for outline in contents for comb in combs(as_glyph(outline))]

    def failed(self, task: Task, error: Exception) -> list[Comb]:
        """None."""
        return []


def corners_of(side: Side, tasks: Sequence[Task]) -> float:
    """:func:`..outlines.joins.share_of_corners` of the glyphs that can be read, in a worker."""
    from ...outlines.joins import share_of_corners
    from ...outlines.outline import Outline

    (read,) = readers(side)
    return share_of_corners([each for each in read([task.head for task in tasks]) if isinstance(each, Outline)])
