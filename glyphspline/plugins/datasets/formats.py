"""The table of a run's contours, as a format with one file a font."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ...writers.formats import TableFormat

if TYPE_CHECKING:
    from ...fitting.results import GlyphResult
    from .kept import Rows


class Parquet(TableFormat):
    """A row for each contour: see :mod:`.table`."""

    name = extra = "parquet"

    def rows(self, font: tuple[str, str], glyphs: Sequence[GlyphResult]) -> bytes:
        """The rows as an IPC stream."""
        from .kept import streamed  # imports pyarrow
        from .table import rows

        return streamed(rows(font, list(glyphs)))

    def kept(self, path: Path, mark: str) -> Rows:
        """Rows in the table of an earlier run, and beside it."""
        from .kept import Rows

        return Rows(path, mark)

    def forget(self, folder: Path) -> None:
        """Remove the chunks of an unfinished table."""
        from .kept import remove_unfinished

        remove_unfinished(folder)


PARQUET = Parquet()
