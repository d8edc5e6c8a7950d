"""The gallery of one or several finished runs."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path, PurePosixPath
from typing import Any
from xml.etree.ElementTree import ParseError

from defusedxml.common import DefusedXmlException
from defusedxml.ElementTree import fromstring

from ..errors import GlyphsplineError, OutputError
from ..files import make_folder, write_whole
from ..readers import Source, open_source
from ..report.data import glyph_text, inside
from ..report.gallery import write_index, write_report
from ..report.gallery_files import FOLDER, SUFFIX
from ..writers.svg.path_data import path_data
from .manifest import MANIFEST, entries_of
from .spec import read_run

_PATH = re.compile(r"[MLQCZlqc0-9 .e+-]*")


def write_gallery(folder: Path, font: Path | None = None) -> None:
    """Write ``index.html`` for a run's folder, or for all runs in the folders below it.

    For a run without the format "gallery" the results are read from its drawings and the source outlines from its
    font; its gallery shows no polygons.

    Args:
        folder: of one run, or of several.
        font: the font of a run. By default the file of its name in the current folder, in the run's or its parent, if
            the bytes are the same. Without a font such a gallery shows only the results.

    Raises:
        OutputError: there is no finished run, or one that cannot be read; or ``font`` is not the run's.
    """
    if (folder / MANIFEST).is_file():
        _write_one(folder, font)
        return
    below = sorted(path.parent for path in folder.glob(f"**/{MANIFEST}"))
    if not below:
        raise OutputError("holds no finished run, nor do the folders in it", font=str(folder))
    for path in below:
        _write_one(path, font)
    write_index(folder, [path.relative_to(folder).as_posix() for path in below], f"{len(below)} fonts")


def _write_one(folder: Path, font: Path | None) -> None:
    run = read_run(folder) or {}
    write_report(folder, _with_drawings(folder, run, font), run)


def _with_drawings(folder: Path, run: Mapping[str, Any], font: Path | None) -> Iterator[dict[str, Any]]:
    """The entries of a run's manifest, after writing the data files of glyphs that have none."""
    source: Source | None = None
    searched = False
    for entry in entries_of(folder):
        files = {str(kind): path for kind, path in (entry.get("files") or {}).items() if inside(path)}
        if files and FOLDER not in files:
            if not searched:
                make_folder(folder / FOLDER)
                source, searched = _font_of(folder, run, font), True
            drawing = {"source": "", "result": result_path(folder, files), "polygon": "", "control": ""}
            if source is not None:
                precision = int(run.get("options", {}).get("precision", 2))
                drawing["source"] = path_data(source.outline(entry["glyph"]).contours, precision)
            files[FOLDER] = f"{FOLDER}/{PurePosixPath(next(iter(files.values()))).stem}{SUFFIX}"
            write_whole(f"{folder}/{files[FOLDER]}", glyph_text(drawing, files, entry.get("contours") or ()))
            entry = entry | {"files": files}
        yield entry


def _font_of(folder: Path, run: Mapping[str, Any], given: Path | None) -> Source | None:
    """The font of a run, identified by its checksum; None if it is not found."""
    facts = run.get("font", {})
    name = Path(str(facts.get("file", ""))).name
    for path in [given] if given else [place / name for place in (Path(), folder, folder.parent)]:
        try:
            source = open_source(path, int(facts.get("face_index", 0)), facts.get("location") or None)
        except GlyphsplineError:
            if given:
                raise
            continue
        if source.sha256 == facts.get("sha256"):
            return source
    if given:
        raise OutputError("was made of another font", font=str(folder))
    return None


def result_path(folder: Path, files: Mapping[str, str]) -> str:
    """Path data of a result from its drawing or its map; "" if neither has any."""
    for kind in ("svg", "curvature"):
        if kind not in files:
            continue
        try:
            root = fromstring((folder / files[kind]).read_bytes())
        except (OSError, ParseError, DefusedXmlException):
            continue
        for path in root.iter("{http://www.w3.org/2000/svg}path"):
            data = path.get("d", "")
            if path.get("class") == "outline" or path.get("id", "").endswith("-outline"):
                return data if _PATH.fullmatch(data) else ""
    return ""
