"""The functions that workers call. The scheduling process imports this module without the compiled code."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from .job import Done, Job, Task

if TYPE_CHECKING:
    from ..curves.curvature import Comb


def work(job: Job, tasks: Sequence[Task]) -> list[Done]:
    """:func:`.worker.work`, in a worker."""
    from .worker import work

    return work(job, tasks)


def survey(job: Job, tasks: Sequence[Task]) -> list[Comb]:
    """:func:`.worker.survey`, in a worker."""
    from .worker import survey

    return survey(job, tasks)
