"""The table of a run's contours, as a format with one file a font."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ...runs.whole_formats import TableFormat

if TYPE_CHECKING:
    from ...fitting.results import GlyphResult


class Parquet(TableFormat):
    """A row for each contour: see :mod:`.table`."""

    name = extra = "parquet"

    def rows(self, font: tuple[str, str], glyphs: Sequence[GlyphResult]) -> bytes:
        """The rows as an IPC stream."""
        from .kept import streamed  # imports pyarrow
        from .table import rows

        return streamed(rows(font, list(glyphs)))

    def held(self, path: Path) -> Container[int]:
        """Glyphs of a table of these columns."""
        from .kept import groups_of

        return groups_of(path)

    def write(self, path: Path, places: Iterable[tuple[int, int | None]], rows: Callable[[int], bytes]) -> int:
        """Write the table in row groups, of which few are in memory."""
        from .kept import write_again

        return write_again(path, places, rows)


PARQUET = Parquet()
