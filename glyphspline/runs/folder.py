"""The folder of a run: its lock, and the manifest with its journal, by which an interrupted run is resumed.

During a run each finished glyph appends a line to the journal, in any order: the sizes of its files, a tab, its
manifest line. At the end the manifest is written in glyph index order, and the journal is removed. A truncated line, or
one whose files are missing or differ in size, is ignored.

Only ``run.json`` and, at the end, the manifest and ``SIZES`` are synced to the disk. A power cut may lose other files;
``SIZES`` has the sizes of the files of each glyph of the manifest, by which such a loss is found.
"""

from __future__ import annotations

import errno
import json
import logging
import os
import re
import socket
from collections.abc import Callable, Container, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, field
from functools import cache
from itertools import islice
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple

from filelock import FileLock, Timeout

from ..errors import OutputError, words_of
from ..files import O_BINARY, make_folder, reading, remove_partials, replacing, sizes, write_all, writing
from ..report.data import encoded, row_of
from ..report.gallery import Gallery, remove_gallery
from ..types import Head
from ..writers.formats import KeptRows
from .engine import Job, Observer, Part, run
from .spec import RUN_FILE, RunSpec, differences, is_folder, read_run

LOCK = ".lock"
MANIFEST = "manifest.jsonl"
JOURNAL = ".journal.jsonl"
SIZES = ".sizes.txt"

UNSUPPORTED = {errno.ENOLCK, errno.EOPNOTSUPP, errno.ENOTSUP, errno.EINVAL}
"""Errors of file systems that know no locks."""

log = logging.getLogger(__name__)


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold the lock of a folder, which is made if it does not exist: one run at a time writes to it.

    The system holds the lock for the open file, not the file's presence: it ends with the process, however that ends,
    so a file left by ``kill -9`` locks nothing. On a network drive its server holds it for all machines.

    Raises:
        OutputError: another run holds it; the message has its process id. Or folder or file cannot be made.
    """
    make_folder(folder)
    path = folder / LOCK
    lock = FileLock(path, timeout=0)
    try:
        lock.acquire()
    except Timeout:
        note = "a process that has not yet said which"
        with suppress(OSError):  # the file may be anybody's
            text = path.read_bytes()[:200].decode(errors="replace").strip()
            note = text if text.isprintable() and text else note
        raise OutputError(f"another run is writing to it: {note}", font=str(folder)) from None
    except OSError as error:
        if error.errno not in UNSUPPORTED:
            raise OutputError(f"cannot be written: {words_of(error)}", font=str(path)) from error
        log.warning("%s: its file system has no locks: no other run may write to it now", folder)
    try:
        with suppress(OSError):  # Windows: the lock is of the byte written first
            path.write_text(f"process {os.getpid()} on {socket.gethostname()}\n")
        yield
    finally:
        # Elsewhere than on Windows, once released it may be another run's.
        for step in (lock.release, path.unlink) if os.name == "nt" else (path.unlink, lock.release):
            with suppress(OSError):
                step()


class Task(NamedTuple):
    """One glyph of a run, and the name of its files without suffix."""

    head: Head
    stem: str


@dataclass(frozen=True)
class Output:
    """What a worker needs to write the files of glyphs: the folder, and how.

    ``curvature_scale``: of all maps; None: the one asked for, or 4 in 1/em. ``font``: family and style, for rows.
    """

    out: Path
    spec: RunSpec
    curvature_scale: float | None = None
    font: tuple[str, str] = ("", "")


class Done(NamedTuple):
    """A finished glyph.

    Attributes:
        line: of the journal. row: of the gallery's table; "" if not made yet.
        rows: of the table of contours, an IPC stream; the first glyph of a batch has those of all.
    """

    gid: int
    name: str
    status: str
    line: bytes
    row: str = ""
    rows: bytes = b""


def done(
    task: Task,
    entry: Mapping[str, Any],
    sizes: Sequence[int] = (),
    row: Callable[[Mapping[str, Any]], str] | None = None,
    encode: Callable[[Any], str] = encoded,
) -> Done:
    """A finished glyph with its line of the manifest: the glyph, then ``entry``.

    Args:
        entry: with status and files. sizes: of the files. row: makes the gallery's row of the whole line.
    """
    name, gid, unicodes = task.head
    whole = {"glyph": name, "gid": gid, "unicodes": [f"U+{code:04X}" for code in unicodes], **entry}
    line = f"{','.join(map(str, sizes))}\t{encode(whole)}\n".encode()
    return Done(gid, name, entry["status"], line, row(whole) if row else "")


@dataclass
class Record:
    """An index of finished glyphs; their lines stay on disk.

    Attributes:
        where: glyph index to the file and the offset of its line. failed: indices of glyphs that failed.
        rows: of the gallery's table, for glyphs of this run.
        sizes: of the files of each glyph of the manifest, in the journal's format.
    """

    where: dict[int, tuple[str, int]] = field(default_factory=dict)
    failed: set[int] = field(default_factory=set)
    rows: dict[int, str] = field(default_factory=dict)
    sizes: dict[int, bytes] = field(default_factory=dict)

    def finished(self) -> set[int]:
        """Glyphs that are not converted again. Glyphs that failed are: the cause may be gone."""
        return self.where.keys() - self.failed


def read_record(out: Path, rows: Container[int] | None = None) -> Record:
    """Read the record of an earlier run from the manifest and journal of a folder.

    Args:
        rows: the glyphs whose rows of a table are there, if there is to be one; one without does not count.
    """
    record = Record()
    with suppress(FileNotFoundError):
        line = re.compile(rb"(\d{1,9})\t((?:\d{1,15}(?:,\d{1,15})*)?)")
        found = map(line.fullmatch, (out / SIZES).read_bytes().splitlines())
        record.sizes = {int(match[1]): match[2] for match in found if match}
    present: dict[str, dict[str, int]] = {}
    for name in (MANIFEST, JOURNAL):
        for offset, lengths, entry in _lines(out / name):
            gid = entry["gid"]
            if not _written(out, entry["files"], record.sizes.get(gid) if lengths is None else lengths, present):
                continue
            if rows is not None and entry.get("status") == "ok" and gid not in rows:
                continue
            record.where[gid] = (name, offset)
            (record.failed.add if entry["status"] == "failed" else record.failed.discard)(gid)
    return record


def _lines(path: Path) -> Iterator[tuple[int, bytes | None, dict[str, Any]]]:
    """Offset, file sizes (None in a manifest) and parsed content of each whole line of a manifest or journal."""
    with suppress(FileNotFoundError), open(path, "rb") as file:
        offset = 0
        for line in file:
            head, tab, text = line.rpartition(b"\t")
            entry = None
            with suppress(ValueError):  # a truncated line that the next run continued
                entry = json.loads(text) if line.endswith(b"\n") else None
            if isinstance(entry, dict) and isinstance(entry.get("gid"), int) and isinstance(entry.get("files"), dict):
                yield offset, head if tab else None, entry
            offset += len(line)


def _written(out: Path, files: dict[str, str], lengths: bytes | None, present: dict[str, dict[str, int]]) -> bool:
    """Whether all files of an entry exist with the sizes ``lengths``, or are not empty if these are None.

    ``present``: sizes of files by folder, as far as they are known; folders are added.
    """
    there = []
    for path in files.values():
        folder, _, name = path.rpartition("/")
        if folder not in present:
            present[folder] = sizes(out / folder) if is_folder(folder) else {}
        there.append(present[folder].get(name))
    if not (all(there) if lengths is None else lengths == ",".join(map(str, there)).encode()):
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
    is_own = cache(lambda folder: is_folder(folder) and not (out / folder).is_symlink())
    for name in (MANIFEST, JOURNAL):
        for _, _, entry in _lines(out / name):
            for path in entry["files"].values():
                folder, _, file = str(path).partition("/")
                if is_own(folder) and file == os.path.basename(file):
                    with suppress(FileNotFoundError):
                        os.unlink(f"{out}/{path}")


def entries_of(out: Path) -> Iterator[dict[str, Any]]:
    """The entries of a finished folder's manifest, in glyph index order.

    Raises:
        OutputError: there is no manifest, or a line of it cannot be read.
    """
    path = out / MANIFEST
    if not path.exists():
        raise OutputError("no manifest: the folder holds no finished run", font=str(path))
    with open(path, encoding="utf-8") as file:
        for line in file:
            with reading(path):
                entry = json.loads(line)
            yield entry


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


def prepare(out: Path, spec: RunSpec, run: dict[str, Any], restart: bool, table: Path | None = None) -> None:
    """Make the folders of a run, and remove what is there of one that does not go on.

    Args:
        run: the content of ``run.json``. table: its path, if the run has one.

    Raises:
        OutputError: a run with other options is there, and ``restart`` is not given.
    """
    old = None if restart else read_run(out)
    if old is None:
        if table and spec.table:
            table.unlink(missing_ok=True)
            spec.table.forget(out)
        remove_written(out)
        remove_gallery(out)
        for name in (MANIFEST, SIZES, JOURNAL, RUN_FILE):
            (out / name).unlink(missing_ok=True)
    elif changed := differences(old, run):
        raise OutputError(
            "holds a run with other options; --restart does it anew:\n  " + "\n  ".join(changed), font=str(out)
        )
    for name in spec.folders:
        make_folder(out / name)
        remove_partials(out / name)
    remove_partials(out)


def recorded(
    job: Job[Task, list[Done]],
    tasks: Sequence[Task],
    pool: Executor,
    record: Record,
    out: Path,
    observer: Observer | None,
    rows: KeptRows | None = None,
) -> Iterator[Part[Task, list[Done]]]:
    """Do tasks in a pool; each is in the journal once its files are written, so that an interrupted run goes on.

    Its rows are kept before that. A symbolic link of the journal's name is not followed.
    """
    if not tasks:
        return
    path, before = out / JOURNAL, len(record.finished())
    flags = os.O_WRONLY | os.O_CREAT | os.O_APPEND | getattr(os, "O_NOFOLLOW", 0) | O_BINARY
    with writing(path):
        journal = open(os.open(path, flags, 0o666), "ab", buffering=0)  # noqa: SIM115

    def write(data: bytes) -> None:
        with writing(path):
            write_all(journal, data)

    with journal:
        write(b"\n")  # ends a truncated line
        for part in run(job, tasks, pool, observer=observer, before=before):
            for stream in [glyph.rows for glyph in part.result if glyph.rows]:
                assert rows is not None
                rows.add(stream)
            at = os.fstat(journal.fileno()).st_size
            for glyph in part.result:
                record.where[glyph.gid] = (JOURNAL, at)
                record.rows[glyph.gid] = glyph.row
                at += len(glyph.line)
            write(b"".join([glyph.line for glyph in part.result]))
            yield part


def conclude(out: Path, record: Record, with_gallery: bool = False, changed: Callable[[bytes], bytes] = bytes) -> None:
    """Write manifest and sizes in glyph index order with the gallery's page and tables.

    The manifest gets its name, and the journal is removed, when all the rest is written: otherwise an interruption
    would leave it missing.

    Args:
        changed: from a line, as it was recorded, to the one that is written.
    """
    gallery = Gallery(out) if with_gallery else None
    with replacing(out / MANIFEST, durable=True) as manifest, replacing(out / SIZES, durable=True) as lengths:
        for gid, known, own in recorded_lines(out, record):
            line = changed(own)
            manifest.write(line)
            if known is not None:
                lengths.write(b"%d\t%s\n" % (gid, known))
            if gallery:
                gallery.add(record.rows.get(gid) or row_of(json.loads(line)))
        if gallery:
            gallery.close(read_run(out) or {})
    (out / JOURNAL).unlink(missing_ok=True)


STORED = "stored"
"""In a line of the manifest: what the run's files of a whole font hold of the glyph, by format."""


def state(out: Path, stored: Mapping[str, Mapping[str, Any]]) -> None:
    """Say in the manifest of a finished folder what files hold: facts by format and glyph."""
    with replacing(out / MANIFEST, durable=True) as manifest:
        for entry in entries_of(out):
            known = {**entry.get(STORED, {}), **{kind: facts.get(entry["glyph"]) for kind, facts in stored.items()}}
            manifest.write(f"{encoded(entry | {STORED: known})}\n".encode())


def is_stated(out: Path) -> bool:
    """Whether it is said there; a manifest that is written anew does not."""
    return all(STORED in entry for entry in islice(entries_of(out), 1))


def unstated(line: bytes) -> bytes:
    """A line of a manifest that does not say it."""
    if f'"{STORED}"'.encode() not in line:
        return line
    entry = json.loads(line)
    entry.pop(STORED, None)
    return f"{encoded(entry)}\n".encode()
