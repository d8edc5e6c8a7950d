"""The folder of a run: its lock, and its manifest, by which with the record an interrupted run is resumed.

While a run goes on, the record has each finished glyph, and the manifest, for those who look at it, grows by lines in
any order. At the end it is written in glyph index order, and the record is removed. What these name but the disk has
not whole counts as not done.

Only ``run.json`` and, at the end, the manifest and ``SIZES`` are synced to the disk. A power cut may lose other files;
``SIZES`` has the sizes of the files of each glyph of the manifest, by which such a loss is found.
"""

from __future__ import annotations

import errno
import json
import logging
import os
import re
import shutil
import socket
from collections.abc import Callable, Container, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import cache
from itertools import chain, islice
from pathlib import Path
from typing import Any, NamedTuple

from filelock import FileLock, Timeout

from ..errors import OutputError, words_of
from ..files import make_folder, reading, remove_partials, replacing, sizes, write_all, writing
from ..report.data import encoded, row_of
from ..report.gallery import Gallery, remove_gallery
from ..types import Head
from .engine import Job, Observer, Part, run
from .record import RECORD, Entry, Record, open_record, remove_record
from .spec import RUN_FILE, RunSpec, differences, is_folder, read_run, suffix_of
from .whole_formats import TableFormat

LOCK = ".lock"
MANIFEST = "manifest.jsonl"
SIZES = ".sizes.txt"

JOURNAL, UNFINISHED = ".journal.jsonl", ".unfinished"
"""What older versions have while a run is not finished: lines of glyphs, and a folder of rows of tables."""

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
    """What a worker needs to write the files of glyphs.

    Attributes:
        out: the run's folder. curvature_scale: of all maps, in 1/unit of a full tooth; None: the one asked for, or 4
            in 1/em. font: family and style, for rows.
    """

    out: Path
    spec: RunSpec
    curvature_scale: float | None = None
    font: tuple[str, str] = ("", "")


class Done(NamedTuple):
    """A finished glyph.

    Attributes:
        sizes: of its files. line: of the manifest. row: of the gallery's table; "" if not made yet.
        rows: of the table of contours, an IPC stream; the first glyph of a batch has those of all.
    """

    gid: int
    name: str
    status: str
    sizes: str
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
    lengths, line = ",".join(map(str, sizes)), f"{encode(whole)}\n".encode()
    return Done(gid, name, entry["status"], lengths, line, row(whole) if row else "")


class Progress:
    """How far the run of a folder is: what the record has, or else the manifest of a finished run.

    Args:
        rows: the glyphs whose rows a finished table has, if there is to be one; one without rows is not done.

    Attributes:
        known: glyph indices that have a line. finished: of them those that are not converted again: glyphs that failed
            are, as the cause may be gone. is_concluded: whether the run was finished.
        stems: the names of their files, without suffix.
    """

    def __init__(self, out: Path, record: Record, rows: Container[int] | None = None) -> None:
        self._out, self._record = out, record
        self.is_concluded = not (record.is_open or record.is_lost) and (out / MANIFEST).exists()
        kept = {number for number, _ in record.batches()} if record.is_open else set[int]()
        present: dict[str, dict[str, int]] = {}
        failed = set[int]()
        self.known = set[int]()
        self.stems: dict[int, str] = {}
        for entry in record.entries() if record.is_open else self._of_manifest():
            facts = json.loads(entry.line)
            if not _are_there(out, facts["files"], entry.sizes, present):
                continue
            if (
                rows is None
                or facts["status"] != "ok"
                or entry.batch in kept
                or (not entry.batch and entry.gid in rows)
            ):
                self.known.add(entry.gid)
                for name, path in islice(facts["files"].items(), 1):
                    self.stems[entry.gid] = path.rpartition("/")[2].removesuffix(suffix_of(name))
                (failed.add if facts["status"] == "failed" else failed.discard)(entry.gid)
        self.finished = self.known - failed

    def entries(self) -> Iterator[Entry]:
        """What is known of each glyph, in glyph index order."""
        every = self._record.entries() if self._record.is_open else self._of_manifest()
        return (entry for entry in every if entry.gid in self.known)

    def _of_manifest(self) -> Iterator[Entry]:
        """Glyphs of the manifest; where a record is lost, only those that ``SIZES`` has."""
        known: dict[int, str] = {}
        with suppress(FileNotFoundError):
            line = re.compile(rb"(\d{1,9})\t((?:\d{1,15}(?:,\d{1,15})*)?)")
            found = map(line.fullmatch, (self._out / SIZES).read_bytes().splitlines())
            known = {int(match[1]): match[2].decode() for match in found if match}
        for text, entry in _lines(self._out / MANIFEST):
            if entry["gid"] in known or not self._record.is_lost:
                yield Entry(entry["gid"], None, known.get(entry["gid"]), text)

    def advance(
        self, job: Job[Task, list[Done]], tasks: Sequence[Task], pool: Executor, observer: Observer | None
    ) -> Iterator[Part[Task, list[Done]]]:
        """Do tasks in a pool; each is in the record once its files are written, so that an interrupted run goes on."""
        if not tasks:
            return
        if not self._record.is_open:
            self._record.begin(self.entries())
        path = self._out / MANIFEST
        with replacing(path) as file:  # what an interruption cut off is not in it
            file.writelines(entry.line for entry in self.entries())
        with writing(path):
            manifest = open(path, "ab", buffering=0)  # noqa: SIM115
        with manifest:
            for part in run(job, tasks, pool, observer=observer, before=len(self.finished)):
                with writing(path):
                    write_all(manifest, b"".join(glyph.line for glyph in part.result))
                entries = [Entry(glyph.gid, None, glyph.sizes, glyph.line, glyph.row) for glyph in part.result]
                self._record.add(entries, b"".join(glyph.rows for glyph in part.result))
                self.known.update(entry.gid for entry in entries)
                yield part

    def write_table(self, table: TableFormat, path: Path) -> int:
        """Write a table of all glyphs; returns the number of its rows."""
        return table.write(path, ((entry.gid, entry.batch) for entry in self.entries()), self._record.rows)

    def conclude(self, with_gallery: bool = False, changed: Callable[[bytes], bytes] = bytes) -> None:
        """Write manifest and sizes in glyph index order with the gallery's page and tables, and remove the record.

        Args:
            changed: from a line, as it was recorded, to the one that is written.
        """
        out = self._out
        gallery = Gallery(out) if with_gallery else None
        with replacing(out / MANIFEST, durable=True) as manifest, replacing(out / SIZES, durable=True) as lengths:
            for entry in self.entries():
                line = changed(entry.line)
                manifest.write(line)
                if entry.sizes is not None:
                    lengths.write(f"{entry.gid}\t{entry.sizes}\n".encode())
                if gallery:
                    gallery.add(entry.row or row_of(json.loads(line)))
            if gallery:
                gallery.close(read_run(out) or {})
        self._record.remove()


def _lines(path: Path) -> Iterator[tuple[bytes, dict[str, Any]]]:
    """Each whole line of a manifest, or of an older version's journal, and its parsed content."""
    with suppress(FileNotFoundError), open(path, "rb") as file:
        for line in file:
            text, entry = line.rpartition(b"\t")[2], None
            with suppress(ValueError):  # a truncated line
                entry = json.loads(text) if line.endswith(b"\n") else None
            if isinstance(entry, dict) and isinstance(entry.get("gid"), int) and isinstance(entry.get("files"), dict):
                yield text, entry


def _are_there(out: Path, files: dict[str, str], lengths: str | None, present: dict[str, dict[str, int]]) -> bool:
    """Whether all files exist with these sizes (None: are not empty); ``present``: known sizes by folder, added to."""
    there = []
    for path in files.values():
        folder, _, name = path.rpartition("/")
        if folder not in present:
            present[folder] = sizes(out / folder) if is_folder(folder) else {}
        there.append(present[folder].get(name))
    if not (all(there) if lengths is None else lengths == ",".join(map(str, there))):
        return False
    return all(_is_on_disk(f"{out}/{path}", size or 0) for path, size in zip(files.values(), there, strict=True))


def _is_on_disk(path: str, size: int) -> bool:
    """Whether a file's last byte is not 0. Data lost in a power cut may read as zeros; no output file ends with 0."""
    try:
        with open(path, "rb", buffering=0) as file:
            file.seek(size - 1)
            return file.read(1) not in (b"\0", b"")
    except OSError:
        return False


@contextmanager
def progress_of(
    out: Path, spec: RunSpec, run: dict[str, Any], restart: bool, table: Path | None = None
) -> Iterator[Progress]:
    """How far a run is, in its folder, which is locked; what is there of one that does not go on is removed.

    Args:
        run: the content of ``run.json``. table: its path, if the run has one.

    Raises:
        OutputError: the folder cannot be written, or another run writes to it; or, unless ``restart`` is given, a run
            with other options is there, or an unfinished one of an older version.
    """
    with locked(out):
        if not restart:
            refuse_older(out)
        old = None if restart else read_run(out)
        if old is None:
            remove_run(out)
            if table:
                table.unlink(missing_ok=True)
        elif changed := differences(old, run):
            raise OutputError(
                "holds a run with other options; --restart does it anew:\n  " + "\n  ".join(changed), font=str(out)
            )
        for folder in (*spec.folders, "."):
            make_folder(out / folder)
            remove_partials(out / folder)
        with open_record(out) as record:
            yield Progress(out, record, spec.table.held(table) if spec.table and table else None)


def remove_run(out: Path) -> None:
    """Remove what there is of a run: files that a manifest or journal lists, only inside the folders of formats."""
    is_own = cache(lambda folder: is_folder(folder) and not (out / folder).is_symlink())
    for _, entry in chain.from_iterable(_lines(out / name) for name in (MANIFEST, JOURNAL)):
        for path in entry["files"].values():
            folder, _, file = str(path).partition("/")
            if is_own(folder) and file == os.path.basename(file):
                with suppress(FileNotFoundError):
                    os.unlink(f"{out}/{path}")
    remove_gallery(out)
    for name in (MANIFEST, SIZES, JOURNAL, RUN_FILE):
        (out / name).unlink(missing_ok=True)
    shutil.rmtree(out / UNFINISHED, ignore_errors=True)
    remove_record(out)


def refuse_older(out: Path) -> None:
    """Raise an OutputError if a run of an older version is not finished."""
    for name in (JOURNAL, UNFINISHED):
        if (out / name).exists():
            words = f"an older version left a run unfinished ({name}): finish it with that, or --restart does it anew"
            raise OutputError(words, font=str(out))


def entries_of(out: Path) -> Iterator[dict[str, Any]]:
    """The entries of a finished folder's manifest, in glyph index order.

    Raises:
        OutputError: there is no manifest of a finished run, or a line of it cannot be read.
    """
    path = out / MANIFEST
    if not path.exists() or (out / RECORD).exists():
        raise OutputError("no manifest: the folder holds no finished run", font=str(path))
    with open(path, encoding="utf-8") as file:
        for line in file:
            with reading(path):
                entry = json.loads(line)
            yield entry


STORED = "stored"
"""In a line of the manifest: what the run's files of a whole font hold of the glyph, by format."""


def add_stored(out: Path, stored: Mapping[str, Mapping[str, Any]]) -> None:
    """Write to the manifest of a finished folder what files of a whole font hold: facts by format and glyph."""
    with replacing(out / MANIFEST, durable=True) as manifest:
        for entry in entries_of(out):
            known = {**entry.get(STORED, {}), **{kind: facts.get(entry["glyph"]) for kind, facts in stored.items()}}
            manifest.write(f"{encoded(entry | {STORED: known})}\n".encode())


def has_stored(out: Path) -> bool:
    """Whether the manifest says what such files hold; one that is written anew does not."""
    return all(STORED in entry for entry in islice(entries_of(out), 1))


def without_stored(line: bytes) -> bytes:
    """A line of a manifest without what such files hold."""
    if f'"{STORED}"'.encode() not in line:
        return line
    entry = json.loads(line)
    entry.pop(STORED, None)
    return f"{encoded(entry)}\n".encode()
