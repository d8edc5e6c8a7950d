"""The gallery: one page, and beside it in ``gallery/`` the data of all glyphs in script files that it loads as needed.

Scripts, because a page opened from disk may not read other files in any other way. ``run.js`` says what was run,
``table-N.js`` have the measures that glyphs are sorted by, ``glyphs-N.js`` their drawings.
"""

from __future__ import annotations

import os
import re
from base64 import b64encode
from collections.abc import Callable, Container, Iterable, Mapping, Sequence
from functools import partial
from hashlib import sha256
from importlib.resources import files
from itertools import chain
from pathlib import Path
from string import Template
from typing import Any

from ..writers.svg.colours import SIDES, class_colour
from ..writers.svg.markup import text
from .data import (
    CHUNK,
    FOLDER,
    as_json,
    contours_text,
    files_text,
    glyph_text,
    page_file,
    page_text,
    script,
    table_row,
    table_text,
)
from .drawings import inside, read_drawing
from .glyph_measures import MEASURES

TABLE = 5000
"""Glyphs in a file of measures."""

SCRIPTS = (
    "shapes.js", "zoom.js", "gallery_data.js", "gallery_table.js", "gallery_grid.js", "gallery_detail.js", "gallery.js",
)  # fmt: skip
"""In the order in which they build on one another."""

LAYERS = {
    "source": ("Source", "s"), "result": ("Result", "r"), "polygon": ("Polygon", "p"), "vertices": ("Vertices", "v"),
    "control": ("Control polygon", "k"), "comb": ("Curvature comb", "c"), "colour": ("Colour", "l"),
}  # fmt: skip
"""What can be switched on and off: its name, and the key that does it."""

Entry = Mapping[str, Any]


def write_report(out_dir: Path, entries: Iterable[Entry], run: Mapping[str, Any]) -> None:
    """Write a run's ``index.html`` and the data beside it.

    Args:
        out_dir: the run's folder.
        entries: the lines of its ``manifest.jsonl``, parsed. A few thousand rows of measures are held at a time.
        run: its ``run.json``.
    """
    gallery = Gallery(out_dir)
    for entry in entries:
        gallery.add(row_of(entry), partial(shown, out_dir, entry))
    gallery.close(run)


class Gallery:
    """A run's gallery as it is written, glyph after glyph in the order in which they are shown.

    Args:
        out_dir: the run's folder.
        pages: numbers of the pages, of ``CHUNK`` glyphs each, that are there and as they should be.
    """

    def __init__(self, out_dir: Path, pages: Container[int] = ()) -> None:
        self._out, self._there = out_dir, pages
        self._rows: list[str] = []
        self._glyphs: list[Callable[[], bytes]] = []
        self._count = self._tables = self._pages = 0
        (out_dir / FOLDER).mkdir(exist_ok=True)

    def add(self, row: str, glyph: Callable[[], bytes]) -> None:
        """The next glyph: its row of the table, and what gives its drawing if its page has to be written."""
        self._rows.append(row)
        self._glyphs.append(glyph)
        self._count += 1
        if len(self._glyphs) == CHUNK:
            self._end_page()
        if len(self._rows) == TABLE:
            self._end_table()

    def close(self, run: Mapping[str, Any]) -> None:
        """Write what is left, and the page to look at. ``run`` is the content of ``run.json``."""
        if self._glyphs:
            self._end_page()
        if self._rows:
            self._end_table()
        folder = self._out / FOLDER
        _replace(folder / "run.js", script(_run(run, self._count)))
        _remove_stale(folder, {"table": self._tables, "glyphs": self._pages})
        write_index(self._out, [""], _heading(run))

    def _end_page(self) -> None:
        if self._pages not in self._there:
            _replace(self._out / page_file(self._pages), page_text(glyph() for glyph in self._glyphs))
        self._glyphs.clear()
        self._pages += 1

    def _end_table(self) -> None:
        _replace(self._out / FOLDER / f"table-{self._tables:05}.js", table_text(self._rows))
        self._rows.clear()
        self._tables += 1


def is_whole(out_dir: Path, count: int) -> bool:
    """Whether the gallery of so many glyphs is there, and no file of it was cut off."""
    names = ["run.js", *(f"table-{k:05}.js" for k in range(-(-count // TABLE)))]
    paths = [*(f"{FOLDER}/{name}" for name in names), *(page_file(k) for k in range(-(-count // CHUNK)))]
    ends = [*((path, b");\n") for path in paths), ("index.html", b"</html>\n")]
    return all(_end_of(out_dir / path, len(end)) == end for path, end in ends)


def _end_of(path: Path, size: int) -> bytes:
    try:
        with open(path, "rb") as file:
            file.seek(-size, os.SEEK_END)
            return file.read()
    except OSError:  # not there, or shorter
        return b""


def row_of(entry: Entry) -> str:
    """An entry's row of the table."""
    return table_row(
        str(entry["glyph"]), int(entry["gid"]), entry.get("unicodes") or (), entry.get("advance"),
        str(entry["status"]), entry.get("contours") or (),
    )  # fmt: skip


def shown(out_dir: Path, entry: Entry) -> bytes:
    """An entry on its page, its drawing read from the files."""
    named = {str(kind): path for kind, path in (entry.get("files") or {}).items() if inside(path)}
    contours = contours_text(entry.get("contours") or ())
    return glyph_text(read_drawing(out_dir, named), files_text(named), contours, entry.get("error"))


def write_index(out_dir: Path, runs: Sequence[str], heading: str) -> None:
    """Write an ``index.html`` over one or several runs, whose galleries are in these folders below ``out_dir``."""
    measures = [[key, label] for key, (label, _) in MEASURES.items()]
    setup = {"runs": list(runs), "measures": measures, "palette": palette()}
    script = "".join(package_text(name) for name in SCRIPTS)
    page = Template(package_text("gallery.html")).substitute(
        heading=text(heading), style=package_text("theme.css") + package_text("gallery.css"), layers=layer_switches(),
        setup=as_json(setup), script=script, digest=b64encode(sha256(("\n" + script).encode()).digest()).decode(),
    )  # fmt: skip
    _replace(out_dir / "index.html", page)


def palette() -> list[str]:
    """The colours of curvature, from the strongest right turn to the strongest left turn."""
    return [class_colour(index) for index in range(-SIDES, SIDES + 1)]


def layer_switches() -> str:
    """The row of switches, as HTML."""
    switches = "".join(
        f'<label title="key {key}"><input type="checkbox" data-layer="{name}" data-key="{key}"><i></i>{label}</label>'
        for name, (label, key) in LAYERS.items()
    )
    return f'<fieldset class="layers"><legend class="unseen">Layers</legend>{switches}</fieldset>'


def package_text(name: str) -> str:
    """A text file of this room."""
    return files(__package__).joinpath(name).read_text(encoding="utf-8")


def _heading(run: Mapping[str, Any]) -> str:
    font = run.get("font", {})
    return f"{font.get('family', 'Glyphs')} {font.get('style', '')}".strip()


def _run(run: Mapping[str, Any], count: int) -> dict[str, Any]:
    font = run.get("font", {})
    metrics = font.get("metrics") or {"units_per_em": 1000.0, "ascender": 800.0, "descender": -200.0}
    return {
        "family": font.get("family", ""),
        "style": font.get("style", ""),
        "location": font.get("location", {}),
        "metrics": metrics,
        "scale": run.get("curvature_scale") or 4 / metrics["units_per_em"],
        "options": run.get("options", {}),
        "glyphs": count,
        "chunk": CHUNK,
        "table": TABLE,
    }


def _replace(path: Path, content: str | bytes) -> None:
    """Write under a temporary name, then rename: a file is there whole or not at all."""
    temporary = path.with_name(f".{path.name}.part")
    temporary.write_bytes(content.encode() if isinstance(content, str) else content)
    os.replace(temporary, path)


def _remove_stale(folder: Path, counts: Mapping[str, int]) -> None:
    """Remove files that an earlier, larger run left behind."""
    for path in chain.from_iterable(folder.glob(f"{kind}-*.js") for kind in counts):
        found = re.fullmatch(r"(table|glyphs)-(\d{5,})\.js", path.name)
        if found and int(found[2]) >= counts[found[1]]:
            path.unlink()
