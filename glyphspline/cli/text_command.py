"""The command ``text``: a text laid out on lines or along a path, and written as drawings."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import GlyphsplineError, OptionError
from . import arguments as opt
from .messages import say

if TYPE_CHECKING:
    from ..batch.text_drawings import TextJob
    from ..fitting.options import Options
    from ..typesetting.placed import Layout
    from ..writers.svg.appearance import Appearance

SHOWN = 10
"""Remarks that are said."""

BY_SUFFIX = {
    ".svg": "svg", ".png": "png", ".pdf": "pdf", ".dxf": "dxf", ".json": "json", ".csv": "polyline-csv",
    ".scad": "polyline-scad",
}  # fmt: skip
"""The format of a file, unless ``--format`` says it."""

LENGTH = re.compile(r"(-?\d{1,9}(?:\.\d{1,9})?)([a-z]*)")


def set_text(given: Mapping[str, Any]) -> int:
    """Lay a text out and write its drawings; returns the exit status: 1 if something is left out of them, else 0.

    Raises:
        GlyphsplineError: the text cannot be laid out, or a format is unknown.
        OSError: a file cannot be read or written.
    """
    from ..batch.schedule import workers

    files = list(formats_of(given["out"], given["format_name"]))
    look, options, names = look_of(given), opt.options_of(given), tuple(name for _, name in files)
    # First: the worker gets ready while the text is laid out. Without a time limit: a text may be of any length.
    with workers(1, inf, options, names, expected=1) as executor:
        from ..batch.text_drawings import drawings
        from ..typesetting.placed import LEFT_OUT

        job = job_of(given, look, options, names)
        drawn = executor.submit(drawings, job).result()
    for (file, _), content in zip(files, drawn.contents, strict=True):  # nothing is written if one of them fails
        if str(file) == "-":
            sys.stdout.buffer.write(content)
        else:
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(content)
    remarks = [*missing(job.layout), *drawn.notes]
    if not given["quiet"]:
        for line in remarks[:SHOWN]:
            say(line)
        if len(remarks) > SHOWN:
            say(f"and {len(remarks) - SHOWN} remarks more")
    return 1 if job.layout.missing or any(f"{LEFT_OUT}: " in note for note in drawn.notes) else 0


def formats_of(files: Sequence[Path], name: str | None) -> Iterator[tuple[Path, str]]:
    """The name of the format of each file: as said, or by its suffix.

    Raises:
        GlyphsplineError: there is none, or several files with one name.
    """
    from ..extras import need
    from ..writers.formats import format_named

    if name is not None and len(files) > 1:
        raise GlyphsplineError("--format is for one --out; of several, suffixes say the formats")
    for file in files:
        known = name or BY_SUFFIX.get(file.suffix.lower())
        if known is None:
            raise GlyphsplineError(
                f"--out {file}: its suffix says no format; there are {', '.join(BY_SUFFIX)}, or give --format"
            )
        found = format_named(known)
        if found.extra:
            need(found.extra)
        yield file, known


def look_of(given: Mapping[str, Any]) -> Appearance:
    """How the drawing looks; ``--size`` is that of an em."""
    from ..writers.svg.appearance import Appearance

    try:
        return Appearance(given["view_box"], None, given["fill"], given["stroke"], given["size"])
    except OptionError as error:
        raise OptionError(re.sub("^em is", "--size is", error.message)) from None


def words_of(given: Mapping[str, Any]) -> str:
    """The text: the argument, or that of a file; - is standard input.

    Raises:
        GlyphsplineError: none is given, or both.
    """
    words, file = given["words"], given["text_file"]
    if (words is None) == (file is None):
        raise GlyphsplineError(
            "give a text, or --text-file" if words is None else "give a text or --text-file, not both"
        )
    if words == "-" or str(file) == "-":
        return sys.stdin.buffer.read().decode("utf-8-sig")
    return words if file is None else file.read_text(encoding="utf-8-sig")


def job_of(given: Mapping[str, Any], look: Appearance, options: Options, formats: tuple[str, ...]) -> TextJob:
    """The text on its lines, with the path that it is to follow, and how it is drawn.

    Raises:
        GlyphsplineError: it cannot be laid out, or options clash.
    """
    from ..batch.text_drawings import TextJob
    from ..readers import open_source
    from ..typesetting.lay_out import layout

    text = words_of(given)
    location = opt.location_of(given["location"])
    font = open_source(given["font"], given["face_index"], location)
    fallbacks = [open_source(file) for file in given["fallbacks"] or ()]
    em = font.metrics.units_per_em
    setting: dict[str, Any] = {name: given[name] for name in ("features", "script", "language", "direction")}
    lengths: dict[str, Any] = {name: length(name, given[name], em, look) for name in ("width", "line_height")}
    curve = None
    if given["path"] is None:
        for name in ("bend", "offset", "side"):
            if given[name] not in (False, None, "left"):
                raise GlyphsplineError(f"--{name} is for text on a --path")
    else:
        if given["width"] is not None:
            raise GlyphsplineError("--width is for lines; text on a --path is one")
        if given["direction"] in ("ttb", "btt"):
            raise GlyphsplineError("columns cannot stand on a --path")
        from ..typesetting.path_file import open_path

        curve = open_path(given["path"]).scaled(pixel(em, look))
    setting["align"] = given["align"] if curve is None else "start"
    return TextJob(
        layout(font, text, fallbacks=fallbacks, **setting, **lengths), options, formats, look, given["flatness"],
        given["dxf"], given["each_glyph"], curve, given["bend"], given["align"], given["side"],
        length("offset", given["offset"], em, look) or 0.0,
    )  # fmt: skip


def pixel(em: float, look: Appearance) -> float:
    """Font units in a user unit of a path's drawing, which is 1/96 inch; without ``--size``, one."""
    from ..writers.svg.appearance import INCHES

    found = look.scale(1.0, em)
    return 1.0 if found is None else INCHES["px"] / (found[0] * INCHES[found[1]])


def length(name: str, text: str | None, em: float, look: Appearance) -> float | None:
    """A length in font units from one with a unit: "80mm" where ``--size`` is given, "12em", or "1000" font units.

    Raises:
        OptionError: it is none.
    """
    from ..writers.svg.appearance import INCHES

    if text is None:
        return None
    option = f"--{name.replace('_', '-')}"
    found = LENGTH.fullmatch(text)
    if found is None or found[2] not in ("", "em", *INCHES):
        raise OptionError(f"{option} is a length in font units, em, {', '.join(INCHES)}, not {text!r}")
    value, unit = float(found[1]), found[2]
    if unit in INCHES:
        if look.em is None:
            raise OptionError(f"{option} {text} needs --size, which says how large an em is")
        return value * INCHES[unit] / INCHES["px"] * pixel(em, look)
    return value * em if unit else value


def missing(layout: Layout) -> Iterator[str]:
    """What is said of characters that no font has."""
    if layout.missing:
        named = ", ".join([f"{c} (U+{ord(c[0]):04X})" for c in layout.missing[:SHOWN]])
        more = f" and {len(layout.missing) - SHOWN} more" if len(layout.missing) > SHOWN else ""
        yield f"no glyph for {named}{more}: .notdef stands there"
