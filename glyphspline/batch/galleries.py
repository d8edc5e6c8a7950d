"""The gallery of folders that are there already: one run, or several side by side."""

from __future__ import annotations

from pathlib import Path

from ..errors import OutputError
from ..report import write_index, write_report
from .manifest import MANIFEST, entries_of
from .spec import read_run


def write_gallery(folder: Path) -> None:
    """Write ``index.html`` anew from what runs have left in a folder, or in the folders below it.

    Raises:
        OutputError: there is no finished run, or one that cannot be read.
    """
    if (folder / MANIFEST).is_file():
        write_report(folder, entries_of(folder), read_run(folder) or {})
        return
    below = sorted(path.parent for path in folder.glob(f"**/{MANIFEST}"))
    if not below:
        raise OutputError("holds no finished run, nor do the folders in it", font=str(folder))
    for path in below:
        write_report(path, entries_of(path), read_run(path) or {})
    write_index(folder, [path.relative_to(folder).as_posix() for path in below], f"{len(below)} fonts")
