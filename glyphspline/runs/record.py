"""The record of a run that is not finished: an SQLite file that has the glyphs that are done, and rows of a table.

It is there from the first batch until the manifest is whole. A batch is one transaction: a process that is killed
leaves all of it or nothing. Check sums tell what a disk has changed: rows of a table count as not there then, and of
a file that is damaged otherwise nothing is trusted.

On a disk of this machine the file has a write-ahead log, which is synced now and then: a power cut costs the last
batches alone. Such a log needs memory that all users of the file share, so elsewhere there is a rollback journal.
"""

from __future__ import annotations

import logging
import sqlite3
from collections import deque
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple
from zlib import crc32

from ..errors import OutputError
from ..files import writing

RECORD = ".record.sqlite"

LAYOUT = """
begin;
create table batch (number integer primary key, facts text, rows blob, sum integer);
create table glyph (gid integer primary key, batch integer, sizes text, line blob, row text, sum integer);
pragma user_version = 1;
"""

LOCAL = {"bcachefs", "btrfs", "exfat", "ext2", "ext3", "ext4", "f2fs", "jfs", "overlay", "tmpfs", "vfat", "xfs", "zfs"}
"""Types of file systems that one machine has for itself."""

UNREADABLE = {sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB, sqlite3.SQLITE_CANTOPEN}

log = logging.getLogger(__name__)


class Entry(NamedTuple):
    """A glyph that is done.

    Attributes:
        batch: number of the batch that has its rows of a table; None: none has.
        sizes: of its files; None: not known. line: of the manifest. row: of the gallery's table; "" if not made yet.
    """

    gid: int
    batch: int | None
    sizes: str | None
    line: bytes
    row: str = ""


class Record:
    """A record, which is open if its file is there; see :func:`open_record`.

    Attributes:
        is_open: whether there is one. is_lost: whether there was one that is damaged; it has been removed.
    """

    _db: sqlite3.Connection

    def __init__(self, path: Path) -> None:
        self._path, self.is_open, self.is_lost = path, False, False
        for each in _files(path):
            if (
                each.is_symlink() or not path.exists()
            ):  # a link could lead out of the folder, a log be of another record
                with writing(each):
                    each.unlink(missing_ok=True)
        if not path.exists():
            return
        try:
            self._connect()
            self.is_lost = not self._is_sound()
        except sqlite3.DatabaseError as error:
            if error.sqlite_errorcode & 0xFF not in UNREADABLE:
                raise
            self.is_lost = True
        if self.is_lost:
            log.warning("%s: the record of the run is damaged: what was done since it began is done again", path)
            self.remove()

    def begin(self, entries: Iterable[Entry] = ()) -> None:
        """Make the file, with what is done already; it is on the disk when this returns."""
        self._connect()
        self._db.execute("pragma synchronous = full")
        self._db.executescript(LAYOUT)
        self.add(entries)
        self._db.execute("pragma synchronous = normal")

    def add(self, entries: Iterable[Entry] = (), rows: bytes = b"", number: int | None = None, facts: str = "") -> None:
        """Add a batch: glyphs, which get its number if it has rows, and the rows.

        Args:
            number: of the batch, in the place of an earlier one; None: a new one. facts: of the rows.
        """
        with self._db:
            if rows or facts:
                values = number, facts, rows, _sum(facts, rows)
                number = self._db.execute("insert or replace into batch values (?, ?, ?, ?)", values).lastrowid
                entries = (entry._replace(batch=number) for entry in entries)
            summed = ((*entry, _sum(*entry)) for entry in entries)
            self._db.executemany("insert or replace into glyph values (?, ?, ?, ?, ?, ?)", summed)

    def entries(self) -> Iterator[Entry]:
        """The glyphs, in glyph index order."""
        for *values, _ in self._db.execute("select * from glyph order by gid"):
            yield Entry._make(values)

    def batches(self) -> Iterator[tuple[int, str]]:
        """Number and facts of each batch whose rows are whole, in order."""
        for number, facts, rows, total in self._db.execute("select * from batch order by number"):
            if total == _sum(facts, rows):
                yield number, facts

    def rows(self, number: int) -> bytes:
        """The rows of a batch."""
        ((rows,),) = self._db.execute("select rows from batch where number = ?", (number,))
        return bytes(rows)

    def close(self) -> None:
        """Close the file, which stays."""
        if self.is_open:
            self._db.close()
        self.is_open = False

    def remove(self) -> None:
        """Close the file and remove it."""
        if self.is_open and not self.is_lost:
            self._db.execute("pragma synchronous = off")  # closing writes what is in the log
        self.close()
        remove_record(self._path.parent)

    def _connect(self) -> None:
        """Open the file for this process alone; the locks of a shared folder, which may know none, are not asked."""
        is_local = local(self._path.parent)
        url = f"{self._path.absolute().as_uri()}{'' if is_local else '?nolock=1'}"
        self._db, self.is_open = sqlite3.connect(url, uri=True, timeout=0), True
        self._db.text_factory = lambda text: text.decode(errors="replace")  # the sum of a damaged one differs
        for pragma in ("locking_mode = exclusive", f"journal_mode = {'wal' if is_local else 'delete'}"):
            self._db.execute(f"pragma {pragma}")
        self._db.execute("pragma synchronous = normal")

    def _is_sound(self) -> bool:
        """Whether the tables are there and whole, each batch can be read, and each glyph is as it was written."""
        facts = [self._db.execute(f"pragma {name}").fetchone() for name in ("user_version", "quick_check(1)")]
        if facts != [(1,), ("ok",)]:
            return False
        deque(self.batches(), 0)
        return all(total == _sum(*values) for *values, total in self._db.execute("select * from glyph"))


@contextmanager
def open_record(folder: Path) -> Iterator[Record]:
    """The record of a run's folder, closed at the end.

    Raises:
        OutputError: it cannot be read or written, also within the block.
    """
    path, record = folder / RECORD, None
    try:
        record = Record(path)
        yield record
    except sqlite3.Error as error:
        raise OutputError(f"the record of the run cannot be used: {error}", font=str(path)) from error
    finally:
        if record:
            record.close()


def remove_record(folder: Path) -> None:
    """Remove a record that is closed: its own file last, without which there is none."""
    for each in _files(folder / RECORD):
        with writing(each):
            each.unlink(missing_ok=True)


def local(folder: Path) -> bool:
    """Whether a folder is known to be on a disk of this machine. Where there is no list of mounts, it is not."""
    try:
        lines = Path("/proc/self/mounts").read_text(errors="replace").splitlines()
    except OSError:
        return False
    kinds = {place.replace("\\040", " "): kind for _, place, kind, *_ in map(str.split, lines)}
    return kinds.get(max(filter(folder.resolve().is_relative_to, kinds), key=len, default="")) in LOCAL


def _files(path: Path) -> list[Path]:
    return [path.with_name(path.name + suffix) for suffix in ("-wal", "-shm", "-journal", "")]


def _sum(*values: object) -> int:
    return crc32(b"\0".join(value if isinstance(value, bytes) else str(value).encode() for value in values))
