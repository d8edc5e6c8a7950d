"""Rows of tables in the making, as the record of a run keeps them: a killed run does not make them again."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import lru_cache
from itertools import groupby
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...extras import need
from ...files import reading, replacing
from ...runs.record import Record
from .table import schema, write_rows


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
    """An Arrow table as a compressed IPC stream."""
    pa = need("parquet")
    sink = pa.BufferOutputStream()
    with pa.ipc.new_stream(sink, table.schema, options=pa.ipc.IpcWriteOptions(compression="zstd")) as writer:
        writer.write_table(table.combine_chunks())
    return bytes(sink.getvalue().to_pybytes())


def table_in(rows: bytes) -> Any:
    """The Arrow table of an IPC stream."""
    return need("parquet").ipc.open_stream(rows).read_all()


class Chunks:
    """The first chunks of a shard in the making, each a batch of the record.

    Args:
        mark: of the shard; batches of others count as not there.

    Attributes:
        count: number of chunks that the record had at first.
    """

    def __init__(self, record: Record, mark: str) -> None:
        self._record, self._mark = record, mark
        found = {number: json.loads(facts) for number, facts in record.batches()}
        self._facts = {number: parts for number, (own, parts) in found.items() if own == mark}
        self.count = next(k for k in range(len(found) + 1) if k not in self._facts)

    def chunk(self, number: int) -> list[Made]:
        """The parts of one of them."""
        rows, parts, at = self._record.rows(number), [], 0
        for size, glyphs, failed in self._facts[number]:
            parts.append(Made(rows[at : at + size], glyphs, failed))
            at += size
        return parts

    def add(self, number: int, parts: Sequence[Made]) -> None:
        """Add the parts of a chunk."""
        facts = [self._mark, [(len(part.rows), part.glyphs, part.failed) for part in parts]]
        self._record.add((), b"".join(part.rows for part in parts), number, json.dumps(facts))


def groups_of(path: Path) -> dict[int, int]:
    """The row group of each glyph of a run's table; none of a file that is not one."""
    pa = need("parquet")
    from pyarrow import parquet

    try:
        with parquet.ParquetFile(path) as file:
            if not file.schema_arrow.equals(schema()):
                return {}
            gids = [file.read_row_group(k, columns=["gid"])["gid"].unique() for k in range(file.num_row_groups)]
            return {gid: k for k, own in enumerate(gids) for gid in own.to_pylist()}
    except (OSError, pa.ArrowException):
        return {}


def write_again(path: Path, places: Iterable[tuple[int, int | None]], rows: Callable[[int], bytes]) -> int:
    """Write a run's table; see :meth:`.TableFormat.write`."""
    groups = groups_of(path)

    @lru_cache(8)  # pieces held in memory: those of several workers or runs alternate
    def piece(batch: int | None, group: int | None) -> Any:
        from pyarrow import parquet

        if batch is not None:
            return table_in(rows(batch))
        with reading(path), parquet.ParquetFile(path) as file:
            return file.read_row_group(group)

    def tables() -> Iterator[Any]:
        placed = [(gid, (batch, None if batch else groups.get(gid))) for gid, batch in places]
        for place, own in groupby((each for each in placed if each[1] != (None, None)), lambda each: each[1]):
            table = piece(*place)
            yield table.filter(np.isin(table["gid"].to_numpy(), [gid for gid, _ in own]))

    with replacing(path, durable=True) as file:
        return write_rows(tables(), file)
