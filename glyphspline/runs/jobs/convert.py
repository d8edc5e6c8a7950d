"""Glyphs converted, drawn and written to files, each with a line of the manifest."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..engine import Item, Job
from .glyphs import Done, Output, Task, failed


class ConvertJob(Output, Job[Task, list[Done]]):
    """A run over the glyphs of one font."""

    budget = 40_000
    """Segments and vertices converted at once: some 40 glyphs of a CJK face."""

    def read(self, tasks: Sequence[Task]) -> list[Item | Exception]:
        """Outlines; one that is too large is an error."""
        from ..worker import read

        return read(self.side, tasks, self.spec)

    def together(self, tasks: Sequence[Task], contents: Sequence[Any]) -> list[Done]:
        """Convert outlines and write their files."""
        from ..worker import convert_and_write

        return convert_and_write(self, tasks, contents)

    def failed(self, task: Task, error: Exception) -> list[Done]:
        """The line of a glyph that could not be converted."""
        return [failed(task, error)]

    def failures(self, result: list[Done]) -> int:
        """Number of glyphs that failed."""
        return sum(done.status == "failed" for done in result)
