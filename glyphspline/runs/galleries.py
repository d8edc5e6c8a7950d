"""The gallery of one or several finished runs."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

from ..errors import OutputError
from ..report.gallery import write_index, write_report
from ..report.gallery_files import FOLDER
from .manifest import MANIFEST, entries_of
from .spec import read_run


def write_gallery(folder: Path) -> None:
    """Write ``index.html`` for a run's folder, or for all runs in the folders below it.

    Raises:
        OutputError: there is no finished run, or one that cannot be read; or a run without the format "gallery". The
            message has the command that adds it.
    """
    if (folder / MANIFEST).is_file():
        _write_one(folder)
        return
    below = sorted(path.parent for path in folder.glob(f"**/{MANIFEST}"))
    if not below:
        raise OutputError("holds no finished run, nor do the folders in it", font=str(folder))
    for path in below:
        _write_one(path)
    write_index(folder, [path.relative_to(folder).as_posix() for path in below], f"{len(below)} fonts")


def _write_one(folder: Path) -> None:
    run = read_run(folder) or {}
    drawn: dict[str, str] = next((files for entry in entries_of(folder) if (files := entry.get("files"))), {})
    if drawn and FOLDER not in drawn:
        made = re.sub(r" --format \S+", "", run.get("command", "glyphspline convert FONT"))
        command = f"{made} --format {','.join([*drawn, FOLDER])} --out {shlex.quote(str(folder))} --restart"
        raise OutputError(f"was made without the format gallery; add it by: {command}", font=str(folder))
    write_report(folder, entries_of(folder), run)
