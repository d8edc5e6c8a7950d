"""Shards: rows in order, in row groups of bounded size; a finished shard says itself what it holds."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any, BinaryIO, NamedTuple, TypeAlias

import numpy as np

from ...extras import need
from ...runs.shapes import Shapes
from ...types import BoolArray, IntArray
from . import remote
from .kept import Made, table_in
from .spec import Sizes
from .table import writing_of

NAMED = 3
"""Glyphs of a font that failed and are named, in each shard."""

FACTS, MARK = b"glyphspline.shard", b"glyphspline.run"
"""Keys of the metadata in a shard's footer: its content, and the mark of its run."""

Held: TypeAlias = "dict[int, OfFont]"
"""What a finished shard holds of each font, by the font's number in the plan."""


class OfFont(NamedTuple):
    """What a shard, or a data set, has of a font.

    Attributes:
        glyphs: those with rows. rows: their number. duplicates: of them. failed: glyphs without rows.
        outside: glyphs with a contour that is not within the tolerance.
        reasons: (glyph, reason) of the first few of those.
    """

    glyphs: int = 0
    rows: int = 0
    duplicates: int = 0
    failed: int = 0
    outside: int = 0
    reasons: tuple[Sequence[str], ...] = ()

    def plus(self, other: OfFont) -> OfFont:
        """The sum of two."""
        sums = [a + b for a, b in zip(self[:-1], other[:-1], strict=True)]
        return OfFont._make([*sums, (*self.reasons, *other.reasons)[:NAMED]])


def numbers_of(column: Any) -> tuple[IntArray, BoolArray]:
    """Shapes as 64-bit numbers, and which rows have one: a shape is a hash in hexadecimal."""
    texts = column.to_pylist()
    has = np.array([text is not None for text in texts], dtype=np.bool_)
    numbers = [int(text[:16], 16) for text in texts if text is not None]
    return np.array(numbers, dtype=np.uint64).view(np.int64), has


def marked(table: Any, shapes: Shapes) -> tuple[Any, int]:
    """The table with the column of duplicates filled, and their number; a row without a shape is none."""
    pa = need("parquet")
    numbers, has = numbers_of(table["shape"])
    values = np.zeros(table.num_rows, dtype=np.bool_)
    values[has] = shapes.first(numbers) != np.arange(len(numbers))
    at = table.schema.get_field_index("duplicate")
    return table.set_column(at, table.schema.field(at), pa.array(values)), int(values.sum())


def outside(table: Any) -> int:
    """Number of glyphs of a table with a contour that is not within the tolerance."""
    rows = zip(table["gid"].to_pylist(), table["within_tolerance"].to_pylist(), strict=True)
    return len({gid for gid, within in rows if False in (within if isinstance(within, list) else [within])})


def write_shard(
    path: str, made: Iterable[tuple[int, Made]], shapes: Shapes, mark: str, schema: Any, sizes: Sizes
) -> Held:
    """Write a shard whole.

    Args:
        made: the rows of its chunks in order, each with the number of its font. shapes: of the rows before it; those
            of the shard are added. mark: see :func:`finished`. schema: of the rows. sizes: of row groups.

    Raises:
        OutputError: it cannot be written.
    """
    from pyarrow import parquet

    held: Held = {}

    def tables() -> Iterator[Any]:
        for font, chunk in made:
            table = table_in(chunk.rows) if chunk.rows else schema.empty_table()
            table, duplicates = marked(table, shapes)
            reasons = tuple(chunk.failed[:NAMED])
            new = OfFont(chunk.glyphs, table.num_rows, duplicates, len(chunk.failed), outside(table), reasons)
            held[font] = held.get(font, OfFont()).plus(new)
            yield table

    def write(file: BinaryIO) -> None:
        # A thread writes one row group while this one gives work to the workers and collects the rows of the next.
        with parquet.ParquetWriter(file, schema, **writing_of(schema)) as writer, ThreadPoolExecutor(1) as thread:
            written: Future[None] | None = None
            for group in _groups(tables(), schema, sizes):
                if written is not None:
                    written.result()
                written = thread.submit(writer.write_table, group, row_group_size=sizes.group)
            if written is not None:
                written.result()
            facts = json.dumps({str(font): of_font for font, of_font in held.items()}, ensure_ascii=False)
            writer.add_key_value_metadata({FACTS: facts.encode(), MARK: mark.encode()})

    remote.put(path, write)
    return held


def _groups(tables: Iterable[Any], schema: Any, sizes: Sizes) -> Iterator[Any]:
    """The rows of tables in tables of ``sizes.group``, or fewer if these are large; the last one is shorter."""
    pa = need("parquet")
    waiting, count, size = [schema.empty_table()], 0, 0
    for table in tables:
        waiting.append(table)
        count, size = count + table.num_rows, size + table.nbytes
        while count >= sizes.group or size >= sizes.group_bytes:
            whole = pa.concat_tables(waiting).combine_chunks()
            yield whole.slice(0, sizes.group)
            rest = whole.slice(sizes.group)
            waiting, count, size = [rest], rest.num_rows, rest.nbytes
    if count:
        yield pa.concat_tables(waiting).combine_chunks()


def finished(path: str, mark: str) -> Held | None:
    """What a shard holds that has this mark, of run and shard; None if there is no file, or another."""
    pa = need("parquet")
    from pyarrow import parquet

    if remote.size(path) is None:
        return None
    try:
        with remote.read(path) as file:
            metadata = parquet.read_metadata(file).metadata or {}
        if metadata.get(MARK) != mark.encode():
            return None
        facts = json.loads(metadata[FACTS])
        return {int(k): OfFont._make([*counts, tuple(reasons)]) for k, (*counts, reasons) in facts.items()}
    except (pa.ArrowException, KeyError, ValueError, TypeError):
        return None


def add_shapes(path: str, shapes: Shapes) -> None:
    """Add the shapes of a finished shard, one row group after the other."""
    from pyarrow import parquet

    with remote.read(path) as file:
        whole = parquet.ParquetFile(file)
        for k in range(whole.num_row_groups):
            shapes.first(numbers_of(whole.read_row_group(k, columns=["shape"])["shape"])[0])
