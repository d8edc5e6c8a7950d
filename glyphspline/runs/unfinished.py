"""The rows of a table in the making, kept chunk by chunk, so that a killed run does not make them again."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple
from zlib import crc32

from ..extras import need
from ..files import O_BINARY, writing

UNFINISHED = ".unfinished"
"""Name of the file in a run's folder; it is there only until the table is whole."""

CODEC = "zstd"


class Made(NamedTuple):
    """The rows of some glyphs.

    Attributes:
        rows: an Arrow table as an IPC stream. glyphs: number of glyphs in it.
        failed: name of each glyph that has no rows, and why.
    """

    rows: bytes
    glyphs: int
    failed: list[tuple[str, str]]


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
    """A file of the chunks of one table: for each a line that describes its parts, then their rows.

    What is cut off or damaged, and all after it, counts as not there.

    Args:
        path: the file. mark: of the table; a file of another is removed.

    Attributes:
        chunks: number of chunks that it held when it was opened.
    """

    def __init__(self, path: Path, mark: str) -> None:
        self._path, self._mark, self._ends = path, mark, [0]
        if not path.is_symlink():
            with suppress(OSError, ValueError, KeyError, TypeError), open(path, "rb") as file:
                while self._read(file):
                    self._ends.append(file.tell())
        self.chunks = len(self._ends) - 1
        with writing(path):
            if not self.chunks:
                path.unlink(missing_ok=True)
            elif path.stat().st_size > self._ends[-1]:
                with open(path, "r+b") as file:
                    file.truncate(self._ends[-1])

    def _read(self, file: BinaryIO) -> list[Made]:
        """The parts of the chunk that begins here; none at the end of what is whole, or where it is of another."""
        pa = need("parquet")
        head = json.loads(file.readline())
        parts = []
        for glyphs, failed, length, packed, check in head["parts"] if head["of"] == self._mark else ():
            data = file.read(packed)
            if len(data) < packed or crc32(data) != check:
                return []
            rows = pa.decompress(data, length, CODEC, asbytes=True) if length else b""
            parts.append(Made(rows, glyphs, [(name, why) for name, why in failed]))
        return parts

    def chunk(self, number: int) -> list[Made]:
        """The parts of a chunk, also of one added since."""
        with writing(self._path), open(self._path, "rb") as file:
            file.seek(self._ends[number])
            return self._read(file)

    def __iter__(self) -> Iterator[list[Made]]:
        """The parts of each chunk that the file held when it was opened."""
        return map(self.chunk, range(self.chunks))

    def add(self, parts: Sequence[Made]) -> int:
        """Add the parts of the next chunk; returns its number.

        Raises:
            OutputError: the file cannot be written.
        """
        pa = need("parquet")
        packed = [pa.compress(part.rows, CODEC, asbytes=True) if part.rows else b"" for part in parts]
        about = [
            [part.glyphs, part.failed, len(part.rows), len(data), crc32(data)]
            for part, data in zip(parts, packed, strict=True)
        ]
        with writing(self._path), open(self._path, "ab", opener=_no_link) as file:
            file.write(json.dumps({"of": self._mark, "parts": about}).encode() + b"\n" + b"".join(packed))
            self._ends.append(file.tell())
        return len(self._ends) - 2

    def remove(self) -> None:
        """Remove the file."""
        with writing(self._path):
            self._path.unlink(missing_ok=True)


def _no_link(path: str, flags: int) -> int:
    """Open a file, but not through a link, which could lead out of the folder."""
    return os.open(path, flags | O_BINARY | getattr(os, "O_NOFOLLOW", 0), 0o666)
