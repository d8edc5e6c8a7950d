"""The rows of the shard in the making, kept chunk by chunk, so that a killed run does not make them again."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO
from zlib import crc32

from ..extras import need
from ..files import O_BINARY, writing
from .shards import Made

CODEC = "zstd"


class Unfinished:
    """A file of the chunks of one shard, in order: for each a line that describes its parts, then their rows.

    What is cut off or damaged, and all after it, counts as not there.

    Args:
        path: the file. mark: of the shard; a file of another is removed.

    Attributes:
        chunks: number of chunks that it holds.
    """

    def __init__(self, path: Path, mark: str) -> None:
        self._path, self._mark = path, mark
        self.chunks = length = 0
        if not path.is_symlink():
            with suppress(OSError, ValueError, KeyError, TypeError), open(path, "rb") as file:
                for _ in self._read(file):
                    self.chunks, length = self.chunks + 1, file.tell()
        with writing(path):
            if not self.chunks:
                path.unlink(missing_ok=True)
            elif path.stat().st_size > length:
                with open(path, "r+b") as file:
                    file.truncate(length)

    def _read(self, file: BinaryIO) -> Iterator[list[Made]]:
        pa = need("parquet")
        for line in file:
            head = json.loads(line)
            if head["of"] != self._mark:
                return
            parts = []
            for glyphs, failed, length, packed, check in head["parts"]:
                data = file.read(packed)
                if len(data) < packed or crc32(data) != check:
                    return
                rows = pa.decompress(data, length, CODEC, asbytes=True) if length else b""
                parts.append(Made(rows, glyphs, [(name, why) for name, why in failed]))
            yield parts

    def __iter__(self) -> Iterator[list[Made]]:
        """The parts of each chunk that the file held when it was opened."""
        if self.chunks:
            with open(self._path, "rb") as file:
                for _, parts in zip(range(self.chunks), self._read(file), strict=False):
                    yield parts

    def add(self, parts: Sequence[Made]) -> None:
        """Add the parts of the next chunk.

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


def _no_link(path: str, flags: int) -> int:
    """Open a file, but not through a link, which could lead out of the folder."""
    return os.open(path, flags | O_BINARY | getattr(os, "O_NOFOLLOW", 0), 0o666)
