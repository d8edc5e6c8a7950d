"""The functions that workers call. The scheduling process imports this module without the compiled code."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from .job import Done, Job, Place, Task

if TYPE_CHECKING:
    from ..curves.curvature import Comb
    from .compare_job import Comparison, Found, Pair


def work(job: Job, tasks: Sequence[Task]) -> list[Done]:
    """:func:`.worker.work`, in a worker."""
    from .worker import work

    return work(job, tasks)


def survey(job: Job, tasks: Sequence[Task]) -> list[Comb]:
    """:func:`.worker.survey`, in a worker."""
    from .worker import survey

    return survey(job, tasks)


def look(place: Place, gids: Sequence[int]) -> dict[str, Any]:
    """:func:`..readers.facts.glyph_facts` of glyphs one after the other, in a worker."""
    from ..readers.facts import glyph_facts
    from .worker import source_of

    return glyph_facts(source_of(*place), gids[0], gids[-1] + 1)


def corners_of(job: Job, tasks: Sequence[Task]) -> float:
    """:func:`..outlines.joins.share_of_corners` of the glyphs that can be read, in a worker."""
    from ..outlines.joins import share_of_corners
    from ..outlines.outline import Outline
    from .worker import outlines

    return share_of_corners([outline for outline in outlines(job, tasks) if isinstance(outline, Outline)])


def tell_apart(comparison: Comparison, pairs: Sequence[Pair]) -> Found:
    """:func:`.compare_glyphs.tell_apart`, in a worker."""
    from .compare_glyphs import tell_apart

    return tell_apart(comparison, pairs)
