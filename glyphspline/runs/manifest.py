"""The manifest and its journal, by which an interrupted run is resumed.

During a run each finished glyph appends a line to the journal, in any order: the sizes of its files, a tab, its
manifest line. At the end the manifest is written in glyph index order, and the journal is removed. A truncated line, or
one whose files are missing or differ in size, is ignored.

Only ``run.json`` and, at the end, the manifest and ``SIZES`` are synced to the disk. A power cut may lose other files;
``SIZES`` has the sizes of the files of each glyph of the manifest, by which such a loss is found.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, BinaryIO

from ..errors import OutputError
from ..files import O_BINARY, replacing, sizes, writing
from .jobs.glyphs import Done
from .spec import is_folder
from .summary import Facts, Summary

MANIFEST = "manifest.jsonl"
JOURNAL = ".journal.jsonl"
SIZES = ".sizes.txt"

_SIZES_LINE = re.compile(rb"(\d{1,9})\t((?:\d{1,15}(?:,\d{1,15})*)?)")

Note = tuple[str, str, str, Facts]
"""Name, status, row of the gallery's table and facts of a glyph converted in this run."""


@dataclass
class Record:
    """An index of finished glyphs; their lines stay on disk.

    Attributes:
        where: glyph index to the file and the offset of its line. failed: indices of glyphs that failed.
        counts: summary of an earlier run's lines. notes: on glyphs converted in this run.
        sizes: of the files of each glyph of the manifest, in the journal's format.
    """

    where: dict[int, tuple[str, int]] = field(default_factory=dict)
    failed: set[int] = field(default_factory=set)
    counts: Summary = field(default_factory=Summary)
    notes: dict[int, Note] = field(default_factory=dict)
    sizes: dict[int, bytes] = field(default_factory=dict)

    def finished(self) -> set[int]:
        """Glyphs that are not converted again. Glyphs that failed are: the cause may be gone."""
        return self.where.keys() - self.failed


def read_record(out: Path) -> Record:
    """Read the record of an earlier run from the manifest and journal of a folder."""
    record = Record(sizes=_known_sizes(out / SIZES))
    present: dict[str, dict[str, int]] = {}
    for name in (MANIFEST, JOURNAL):
        for offset, lengths, entry in _lines(out / name):
            if not _is_entry(entry):
                continue
            if lengths is None and entry["gid"] in record.sizes:
                lengths = _numbers(record.sizes[entry["gid"]])
            if not _written(out, entry["files"], lengths, present):
                continue
            record.where[entry["gid"]] = (name, offset)
            record.counts.add(entry)
            (record.failed.add if entry["status"] == "failed" else record.failed.discard)(entry["gid"])
    return record


def _lines(path: Path) -> Iterator[tuple[int, list[int] | None, Any]]:
    """Offset, file sizes (None in a manifest) and parsed content of each complete line of a manifest or journal."""
    try:
        with open(path, "rb") as file:
            offset = 0
            for line in file:
                head, tab, text = line.rpartition(b"\t")
                try:
                    if line.endswith(b"\n"):
                        yield offset, _numbers(head) if tab else None, json.loads(text)
                except ValueError:
                    pass  # a truncated line that the next run continued
                offset += len(line)
    except FileNotFoundError:
        return


def _known_sizes(path: Path) -> dict[int, bytes]:
    """The content of ``SIZES`` by glyph index; malformed lines are ignored."""
    try:
        found = map(_SIZES_LINE.fullmatch, path.read_bytes().splitlines())
    except FileNotFoundError:
        return {}
    return {int(match[1]): match[2] for match in found if match}


def _numbers(text: bytes) -> list[int]:
    return [int(part) for part in text.split(b",") if part]


def _is_entry(entry: Any) -> bool:
    return isinstance(entry, dict) and isinstance(entry.get("gid"), int) and isinstance(entry.get("files"), dict)


def _written(out: Path, files: dict[str, str], lengths: list[int] | None, present: dict[str, dict[str, int]]) -> bool:
    """Whether all files of an entry exist with the sizes ``lengths``, or are not empty if these are None.

    ``present``: sizes of files by folder, as far as they are known; folders are added.
    """
    there = []
    for path in files.values():
        folder, _, name = path.rpartition("/")
        if folder not in present:
            present[folder] = sizes(out / folder) if is_folder(folder) else {}
        there.append(present[folder].get(name))
    if not (all(there) if lengths is None else there == lengths):
        return False
    return all(_stored(f"{out}/{path}", size or 0) for path, size in zip(files.values(), there, strict=True))


def _stored(path: str, size: int) -> bool:
    """Whether a file's last byte is not 0. Data lost in a power cut may read as zeros; no output file ends with 0."""
    try:
        with open(path, "rb", buffering=0) as file:
            file.seek(size - 1)
            return file.read(1) not in (b"\0", b"")
    except OSError:
        return False


def remove_written(out: Path) -> None:
    """Remove the files listed in the manifest and journal of an earlier run, only inside the folders of formats."""
    for name in (MANIFEST, JOURNAL):
        for _, _, entry in _lines(out / name):
            for path in entry["files"].values() if _is_entry(entry) else ():
                folder, _, file = str(path).partition("/")
                if is_folder(folder) and file == Path(file).name and not (out / folder).is_symlink():
                    (out / folder / file).unlink(missing_ok=True)


class Journal:
    """The journal, open for appending. A symbolic link of its name is not followed."""

    def __init__(self, out: Path, record: Record) -> None:
        flags = os.O_WRONLY | os.O_CREAT | os.O_APPEND | getattr(os, "O_NOFOLLOW", 0) | O_BINARY
        self.path = out / JOURNAL
        self.record = record
        with writing(self.path):
            self._file = open(os.open(self.path, flags, 0o666), "ab", buffering=0)  # noqa: SIM115
            self._offset = os.fstat(self._file.fileno()).st_size
            self._write(b"\n")  # ends a truncated line

    def _write(self, data: bytes) -> None:
        view = memoryview(data)
        while view:
            written = self._file.write(view) or 0
            self._offset += written
            view = view[written:]

    def add(self, done: list[Done]) -> None:
        """Record glyphs whose files are written."""
        at = self._offset
        for glyph in done:
            self.record.where[glyph.gid] = (JOURNAL, at)
            self.record.notes[glyph.gid] = (glyph.name, glyph.status, glyph.row, glyph.facts)
            at += len(glyph.line)
        with writing(self.path):
            self._write(b"".join([glyph.line for glyph in done]))

    def close(self) -> None:
        """Close the file."""
        self._file.close()


def entries_of(out: Path) -> Iterator[dict[str, Any]]:
    """The entries of a finished folder's manifest, in glyph index order.

    Raises:
        OutputError: there is no manifest, or a line of it cannot be read.
    """
    path = out / MANIFEST
    try:
        with open(path, encoding="utf-8") as file:
            for line in file:
                yield json.loads(line)
    except FileNotFoundError:
        raise OutputError("no manifest: the folder holds no finished run", font=str(path)) from None
    except ValueError as error:
        raise OutputError(f"cannot be read: {error}", font=str(path)) from error


def _same(line: bytes) -> bytes:
    return line


@contextmanager
def finish(
    out: Path, record: Record, changed: Callable[[bytes], bytes] = _same
) -> Iterator[Iterator[tuple[int, bytes]]]:
    """Write manifest and sizes in glyph index order, yielding each glyph's index and line.

    Args:
        changed: from a line, as it was recorded, to the one that is written.

    The manifest gets its name, and the journal is removed, when the block ends without an error. All other files of
    the end of a run have to be written inside the block; otherwise an interruption would leave them missing.
    """
    with replacing(out / MANIFEST, durable=True) as manifest, replacing(out / SIZES, durable=True) as lengths:
        yield _written_to(manifest, lengths, out, record, changed)
    (out / JOURNAL).unlink(missing_ok=True)


def _written_to(
    manifest: BinaryIO, lengths: BinaryIO, out: Path, record: Record, changed: Callable[[bytes], bytes]
) -> Iterator[tuple[int, bytes]]:
    for gid, known, recorded in recorded_lines(out, record):
        line = changed(recorded)
        manifest.write(line)
        if known is not None:
            lengths.write(b"%d\t%s\n" % (gid, known))
        yield gid, line


def recorded_lines(out: Path, record: Record) -> Iterator[tuple[int, bytes | None, bytes]]:
    """Index, sizes of files (None if they are not known) and line of each glyph, in glyph index order."""
    with ExitStack() as opened:
        files: dict[str, BinaryIO] = {}
        for gid in sorted(record.where):
            name, offset = record.where[gid]
            if name not in files:
                files[name] = opened.enter_context(open(out / name, "rb"))
            files[name].seek(offset)
            head, tab, line = files[name].readline().rpartition(b"\t")
            yield gid, head if tab else record.sizes.get(gid), line
