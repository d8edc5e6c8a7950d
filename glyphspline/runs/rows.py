"""The rows of a run's table of contours: kept while the run goes on, and written in glyph index order at its end."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import OutputError, words_of
from ..extras import need
from ..files import replacing
from ..writers.parquet import schema, write_rows
from .unfinished import UNFINISHED, Made, Unfinished, table_in

PIECES = 8
"""Pieces of rows held in memory: chunks of several workers or runs alternate."""


class Rows:
    """The rows that a folder has: in the table of an earlier run, and beside it in ``.unfinished``.

    A table that cannot be read, or has other columns, counts as not there.

    Args:
        path: the table. mark: of the run.
    """

    def __init__(self, path: Path, mark: str) -> None:
        self._path, self._kept = path, Unfinished(path.with_name(UNFINISHED), mark)
        self.added = self._kept.chunks > 0
        # Where the rows of each glyph are: a row group of the table, or a chunk of what is kept.
        self._where = {gid: (False, k) for k, gids in enumerate(_row_groups(path)) for gid in gids}
        for k, parts in enumerate(self._kept):
            self._index(k, [table_in(part.rows) for part in parts])
        self._piece = lru_cache(PIECES)(self._read)

    def __contains__(self, gid: object) -> bool:
        return gid in self._where

    def add(self, rows: bytes) -> None:
        """Keep the rows of some glyphs, an IPC stream."""
        table = table_in(rows)
        self._index(self._kept.add([Made(rows, 0, [])]), [table])
        self.added = True

    def write(self, gids: Iterable[int]) -> int:
        """Write the table anew with the rows of these glyphs, as far as there are any; returns their number."""
        found = sorted(self._where.keys() & set(gids))
        with replacing(self._path) as file:
            count = write_rows(self._tables(found), file)
        self._kept.remove()
        self._piece.cache_clear()
        return count

    def _index(self, chunk: int, tables: Sequence[Any]) -> None:
        self._where.update((gid, (True, chunk)) for table in tables for gid in table["gid"].unique().to_pylist())

    def _tables(self, gids: Sequence[int]) -> Iterator[Any]:
        for place, own in groupby(gids, self._where.__getitem__):
            table = self._piece(*place)
            yield table.filter(np.isin(table["gid"].to_numpy(), list(own)))

    def _read(self, kept: bool, number: int) -> Any:
        pa = need("parquet")
        from pyarrow import parquet

        if kept:
            return pa.concat_tables([table_in(part.rows) for part in self._kept.chunk(number)])
        try:
            with parquet.ParquetFile(self._path) as file:
                return file.read_row_group(number)
        except (OSError, pa.ArrowException) as error:
            raise OutputError(f"cannot be read: {words_of(error)}", font=str(self._path)) from error


def _row_groups(path: Path) -> list[list[int]]:
    """The glyphs of each row group of a table; none if it is not one of a run."""
    pa = need("parquet")
    from pyarrow import parquet

    try:
        with parquet.ParquetFile(path) as file:
            if not file.schema_arrow.equals(schema()):
                return []
            groups = range(file.num_row_groups)
            return [file.read_row_group(k, columns=["gid"])["gid"].unique().to_pylist() for k in groups]
    except (OSError, pa.ArrowException):
        return []
