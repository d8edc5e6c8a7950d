"""Rows of tables in the making, kept chunk by chunk, so that a killed run does not make them again.

A run's table of contours is written from them in glyph index order at its end.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache
from itertools import count, groupby
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...extras import need
from ...files import reading, replacing, sizes, write_whole, writing
from .table import schema, write_rows

UNFINISHED = ".unfinished"
"""Name of the folder of chunks in a run's folder; it is there only until the table is whole."""


class Made(NamedTuple):
    """The rows of some glyphs.

    Attributes:
        rows: an Arrow table as an IPC stream. glyphs: number of glyphs in it.
        failed: name of each glyph that has no rows, and why.
    """

    rows: bytes
    glyphs: int
    failed: Sequence[Sequence[str]]


def streamed(table: Any) -> bytes:
    """An Arrow table as an IPC stream."""
    pa = need("parquet")
    sink = pa.BufferOutputStream()
    with pa.ipc.new_stream(sink, table.schema) as writer:
        writer.write_table(table.combine_chunks())
    return bytes(sink.getvalue().to_pybytes())


def table_in(rows: bytes) -> Any:
    """The Arrow table of an IPC stream."""
    return need("parquet").ipc.open_stream(rows).read_all()


class Unfinished:
    """A folder of the chunks of one table, a Parquet file with check sums each, named by its number.

    A chunk that is damaged or of another table, and all after it, count as not there and are removed.

    Args:
        folder: it is made with the first chunk. mark: of the table.

    Attributes:
        chunks: number of chunks that it held when it was opened.
    """

    def __init__(self, folder: Path, mark: str) -> None:
        self._folder, self._mark = folder, mark.encode()
        if folder.is_symlink() or folder.is_file():  # a link could lead out of the run's folder
            with writing(folder):
                folder.unlink()
        self._next = self.chunks = next(number for number in count() if not self.chunk(number))
        for name in sizes(folder):
            if not (name.isdecimal() and int(name) < self.chunks):
                with writing(folder):
                    (folder / name).unlink()

    def chunk(self, number: int) -> list[Made]:
        """The parts of a chunk, also of one added since; none if it is not there."""
        pa = need("parquet")
        from pyarrow import parquet

        try:
            with parquet.ParquetFile(self._folder / str(number), page_checksum_verification=True) as file:
                table = file.read()
        except (OSError, pa.ArrowException):
            return []
        if (table.schema.metadata or {}).get(b"mark") != self._mark:
            return []
        return list(map(Made, *table.to_pydict().values()))

    def __iter__(self) -> Iterator[list[Made]]:
        """The parts of each chunk that the folder held when it was opened."""
        return map(self.chunk, range(self.chunks))

    def add(self, parts: Sequence[Made]) -> int:
        """Add the parts of the next chunk; returns its number.

        Raises:
            OutputError: it cannot be written.
        """
        pa = need("parquet")
        from pyarrow import parquet

        types = [pa.large_binary(), pa.int64(), pa.list_(pa.list_(pa.string()))]
        layout = pa.schema(zip(Made._fields, types, strict=True), metadata={"mark": self._mark})
        sink = pa.BufferOutputStream()
        parquet.write_table(
            pa.table(list(zip(*parts, strict=True)), layout), sink, compression="zstd", use_dictionary=False,
            write_statistics=False, write_page_checksum=True,
        )  # fmt: skip
        with writing(self._folder):
            self._folder.mkdir(exist_ok=True)
        write_whole(f"{self._folder}/{self._next}", sink.getvalue().to_pybytes())
        self._next += 1
        return self._next - 1


def remove_unfinished(out: Path) -> None:
    """Remove the chunks of an unfinished table from a run's folder."""
    shutil.rmtree(out / UNFINISHED, ignore_errors=True)


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
        # Pieces of rows held in memory: chunks of several workers or runs alternate.
        self._piece = lru_cache(8)(self._read)

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
        remove_unfinished(self._path.parent)
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
        with reading(self._path), parquet.ParquetFile(self._path) as file:
            return file.read_row_group(number)


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
