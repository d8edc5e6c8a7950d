"""The gallery: one page, and beside it in ``gallery/`` the data of all glyphs in script files that it loads as needed.

Scripts, because a page opened from disk may not read other files in any other way. ``run.js`` says what was run,
``table-N.js`` have the measures that glyphs are sorted by, ``glyphs-N.js`` their drawings.
"""

from __future__ import annotations

import json
import os
import re
from base64 import b64encode
from collections.abc import Iterable, Iterator, Mapping, Sequence
from hashlib import sha256
from importlib.resources import files
from itertools import chain, islice
from pathlib import Path
from string import Template
from typing import Any

from ..writers.colours import SIDES, class_colour
from ..writers.markup import text
from .drawings import inside, read_drawing
from .measures import MEASURES, glyph_measures

FOLDER = "gallery"

CHUNK = 40
"""Glyphs in a file of drawings: about half a megabyte of CJK outlines, a tenth of a second to load."""

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
    folder = out_dir / FOLDER
    folder.mkdir(exist_ok=True)
    glyphs = tables = count = 0
    for part in _batched(entries, TABLE):
        _script(folder / f"table-{tables:05}.js", _table(part))
        for chunk in _batched(part, CHUNK):
            _script(folder / f"glyphs-{glyphs:05}.js", [_glyph(out_dir, entry) for entry in chunk])
            glyphs += 1
        tables, count = tables + 1, count + len(part)
    _script(folder / "run.js", _run(run, count))
    _remove_stale(folder, {"table": tables, "glyphs": glyphs})
    write_index(out_dir, [""], _heading(run))


def write_index(out_dir: Path, runs: Sequence[str], heading: str) -> None:
    """Write an ``index.html`` over one or several runs, whose galleries are in these folders below ``out_dir``."""
    measures = [[key, label] for key, (label, _) in MEASURES.items()]
    setup = {"runs": list(runs), "measures": measures, "palette": palette()}
    script = "".join(package_text(name) for name in SCRIPTS)
    page = Template(package_text("gallery.html")).substitute(
        heading=text(heading), style=package_text("theme.css") + package_text("gallery.css"), layers=layer_switches(),
        setup=_json(setup), script=script, digest=b64encode(sha256(("\n" + script).encode()).digest()).decode(),
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


def _table(entries: Sequence[Entry]) -> dict[str, list[Any]]:
    """Columns, which are a third of the size of rows with names."""
    measures = [glyph_measures(entry.get("contours") or ()) for entry in entries]
    columns: dict[str, list[Any]] = {
        "glyph": [str(entry["glyph"]) for entry in entries],
        "gid": [int(entry["gid"]) for entry in entries],
        "unicodes": [" ".join(map(str, entry.get("unicodes") or ())) for entry in entries],
        "advance": [entry.get("advance") for entry in entries],
        "status": [str(entry["status"]) for entry in entries],
    }
    for key in ("contours", *MEASURES):
        column = [values[key] for values in measures]
        if any(value is not None for value in column):
            columns[key] = column
    return columns


def _glyph(out_dir: Path, entry: Entry) -> dict[str, Any]:
    named = {str(kind): path for kind, path in (entry.get("files") or {}).items() if inside(path)}
    more = {"files": named, "contours": list(entry.get("contours") or ()), "error": entry.get("error")}
    return read_drawing(out_dir, named) | more


def _script(path: Path, data: Any) -> None:
    _replace(path, f"glyphsplineData({_json(data)});\n")


def _json(data: Any) -> str:
    """JSON that can stand in a script and in a page: ASCII, and no "<" that could end either."""
    return json.dumps(data, ensure_ascii=True, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")


def _replace(path: Path, content: str) -> None:
    """Write under a temporary name, then rename: a file is there whole or not at all."""
    temporary = path.with_name(f".{path.name}.part")
    temporary.write_text(content, encoding="utf-8", newline="\n")
    os.replace(temporary, path)


def _remove_stale(folder: Path, counts: Mapping[str, int]) -> None:
    """Remove files that an earlier, larger run left behind."""
    for path in chain.from_iterable(folder.glob(f"{kind}-*.js") for kind in counts):
        found = re.fullmatch(r"(table|glyphs)-(\d{5,})\.js", path.name)
        if found and int(found[2]) >= counts[found[1]]:
            path.unlink()


def _batched(items: Iterable[Entry], size: int) -> Iterator[list[Entry]]:
    rest = iter(items)
    while part := list(islice(rest, size)):
        yield part
