"""The gallery: one page, and script files in ``gallery/`` with the data of all glyphs, loaded as needed.

A page opened from disk can read other files only as scripts. ``run.js`` describes the run, ``table-N.js`` contain the
measures by which glyphs are sorted, and each ``*.glyph.js`` contains a glyph's drawing.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from ..errors import GlyphsplineError
from ..files import write_whole
from ..fitting.options import Options
from ..fitting.results import QUANTITIES
from ..writers.svg.comb import palette
from . import FOLDER
from .data import COLUMNS, COMBINED, FULL, as_json, row_of, script
from .pages import page_of

TABLE = 5000
"""Glyphs in a file of measures."""

SCRIPTS = (
    "page.js", "shapes.js", "gallery_data.js", "gallery_table.js", "gallery_grid.js", "gallery_detail.js", "gallery.js",
)  # fmt: skip
"""In the order of their dependencies."""

LAYERS = {
    "source": ("Source", "s"), "result": ("Result", "r"), "polygon": ("Polygon", "p"), "vertices": ("Vertices", "v"),
    "control": ("Control polygon", "k"), "source-comb": ("Source's comb", "e"), "comb": ("Result's comb", "c"),
    "corners": ("Teeth in corners", "n"), "colour": ("Colour", "l"), "handles": ("Handles", "h"),
}  # fmt: skip
"""The layers that can be hidden: name and key."""


def write_report(out_dir: Path, entries: Iterable[Mapping[str, Any]], run: Mapping[str, Any]) -> None:
    """Write a run's ``index.html`` and its tables; the files of its glyphs are there.

    Args:
        out_dir: the run's folder.
        entries: the lines of its ``manifest.jsonl``, parsed. A few thousand rows of measures are held at a time.
        run: its ``run.json``.
    """
    gallery = Gallery(out_dir)
    for entry in entries:
        gallery.add(row_of(entry))
    gallery.close(run)


class Gallery:
    """Writer of a run's gallery, glyph by glyph in the order of the manifest.

    Args:
        out_dir: the run's folder.
    """

    def __init__(self, out_dir: Path) -> None:
        self._out = out_dir
        self._rows: list[str] = []
        self._count = self._tables = 0
        (out_dir / FOLDER).mkdir(exist_ok=True)

    def add(self, row: str) -> None:
        """Add the next glyph's row of the table."""
        self._rows.append(row)
        self._count += 1
        if len(self._rows) == TABLE:
            self._end_table()

    def close(self, run: Mapping[str, Any]) -> None:
        """Write the rest of the tables, and the page. ``run`` is the content of ``run.json``."""
        if self._rows:
            self._end_table()
        write_whole(str(self._out / FOLDER / "run.js"), script(_run(run, self._count)))
        for path in (self._out / FOLDER).glob("table-*.js"):  # of an earlier, larger run
            found = re.fullmatch(r"table-(\d{5,})\.js", path.name)
            if found and int(found[1]) >= self._tables:
                path.unlink()
        font = run.get("font", {})
        write_index(self._out, [""], f"{font.get('family', 'Glyphs')} {font.get('style', '')}".strip())

    def _end_table(self) -> None:
        text = f'glyphsplineData({{"columns":{as_json(COLUMNS)},"rows":[{",".join(self._rows)}]}});\n'
        write_whole(str(self._out / FOLDER / f"table-{self._tables:05}.js"), text)
        self._rows.clear()
        self._tables += 1


def remove_gallery(out_dir: Path) -> None:
    """Remove the page and the tables of an earlier run, not the glyphs' files, which the manifest lists."""
    folder = out_dir / FOLDER
    if folder.is_symlink() or not (folder / "run.js").is_file():
        return  # index.html may not be a gallery
    for path in [out_dir / "index.html", *folder.glob("table-*.js"), folder / "run.js"]:
        with suppress(OSError):
            path.unlink()


def is_whole(out_dir: Path, count: int) -> bool:
    """Whether the page and the tables of ``count`` glyphs exist and are complete."""
    names = ["run.js", *(f"table-{k:05}.js" for k in range(-(-count // TABLE)))]
    ends = [*((f"{FOLDER}/{name}", b");\n") for name in names), ("index.html", b"</html>\n")]
    return all(_end_of(out_dir / path, len(end)) == end for path, end in ends)


def _end_of(path: Path, size: int) -> bytes:
    try:
        with open(path, "rb") as file:
            file.seek(-size, os.SEEK_END)
            return file.read()
    except OSError:  # not there, or shorter
        return b""


def write_index(out_dir: Path, runs: Sequence[str], heading: str) -> None:
    """Write an ``index.html`` for one or several runs, whose galleries are in these folders below ``out_dir``."""
    setup = {"runs": list(runs), "measures": measures(), "palette": palette()}
    page = page_of(
        "gallery.html", ("theme.css", "gallery.css"), heading, SCRIPTS, setup, loads=True, layers=layer_switches()
    )
    write_whole(str(out_dir / "index.html"), page)


def measures() -> list[list[str]]:
    """Name, label, unit and meaning of each measure."""
    return [[name, *QUANTITIES[name]] for name in COMBINED]


def layer_switches() -> str:
    """The row of switches, as HTML."""
    switches = "".join(
        f'<label title="key {key}"><input type="checkbox" data-layer="{name}" data-key="{key}"><i></i>{label}</label>'
        for name, (label, key) in LAYERS.items()
    )
    return f'<fieldset class="layers"><legend class="unseen">Layers</legend>{switches}</fieldset>'


def _run(run: Mapping[str, Any], count: int) -> dict[str, Any]:
    font = run.get("font", {})
    metrics = font.get("metrics") or {"units_per_em": 1000.0, "ascender": 800.0, "descender": -200.0}
    return {
        "family": font.get("family", ""),
        "style": font.get("style", ""),
        "location": font.get("location", {}),
        "metrics": metrics,
        "scale": run.get("curvature_scale") or FULL / metrics["units_per_em"],
        "options": run.get("options", {}),
        "words": _words(run),
        "glyphs": count,
        "table": TABLE,
    }


def _words(run: Mapping[str, Any]) -> str:
    """What the page says of the conversion; nothing if the options are not those of this version."""
    try:
        options = dict(run["options"])
        if options["step"] is not None or options["count"] is not None:
            options["tolerance"] = None  # run.json has that by which results are judged
        return Options(**options).words
    except (KeyError, TypeError, GlyphsplineError):
        return ""
