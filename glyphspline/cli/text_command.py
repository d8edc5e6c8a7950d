"""The command ``text``: a text laid out on lines or along a path, and written as drawings."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import GlyphsplineError, OptionError
from . import arguments as opt
from .messages import say

if TYPE_CHECKING:
    from ..fitting.options import Options
    from ..runs.jobs.text import TextJob
    from ..typesetting.placed import Layout
    from ..writers.settings import Settings
    from ..writers.svg.appearance import Appearance

SHOWN = 10
"""Remarks that are said."""

BY_SUFFIX = {
    ".svg": "svg", ".png": "png", ".pdf": "pdf", ".dxf": "dxf", ".json": "json", ".csv": "polyline-csv",
    ".scad": "polyline-scad",
}  # fmt: skip
"""The format of a file, unless ``--format`` says it."""

LENGTH = re.compile(r"(-?\d{1,9}(?:\.\d{1,9})?)([a-z]*)")


@dataclass(frozen=True)
class TextCall:
    """A text, how it is set, fitted and drawn: the arguments of the command ``text``."""

    font: Path
    instance: opt.Instance
    words: str | None
    lines: opt.TextOptions
    along: opt.PathOptions
    options: Options
    settings: Settings
    drawings: opt.DrawingOptions


def set_text(call: TextCall, out: Sequence[Path], quiet: bool) -> int:
    """Lay a text out and write its drawings; returns the exit status: 1 if something is left out of them, else 0.

    Raises:
        GlyphsplineError: the text cannot be laid out, or a format is unknown.
        OSError: a file cannot be read or written.
    """
    from ..runs.schedule import kinds_for, workers

    files = list(formats_of(out, call.drawings.format_name))
    names = tuple(name for _, name in files)
    # First: the worker gets ready while the text is laid out. Without a time limit: a text may be of any length.
    with workers(1, inf, kinds_for(call.options, names), 1) as executor:
        from ..runs.jobs.text import drawings
        from ..typesetting.placed import LEFT_OUT

        job = job_of(call, names)
        drawn = executor.submit(drawings, job).result()
    for (file, _), content in zip(files, drawn.contents, strict=True):  # nothing is written if one of them fails
        if str(file) == "-":
            sys.stdout.buffer.write(content)
        else:
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(content)
    remarks = [*missing(job.layout), *drawn.notes]
    if len(remarks) > SHOWN:
        remarks[SHOWN:] = [f"and {len(remarks) - SHOWN} remarks more"]
    for line in () if quiet else remarks:
        say(line)
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


def words_of(words: str | None, file: Path | None) -> str:
    """The text: the argument, or that of a file; - is standard input.

    Raises:
        GlyphsplineError: none is given, or both.
    """
    if words is not None and file is not None:
        raise GlyphsplineError("give a text or --text-file, not both")
    if words == "-" or str(file) == "-":
        return sys.stdin.buffer.read().decode("utf-8-sig")
    if file is not None:
        return file.read_text(encoding="utf-8-sig")
    if words is None:
        raise GlyphsplineError("give a text, or --text-file")
    return words


def job_of(call: TextCall, formats: tuple[str, ...]) -> TextJob:
    """The text on its lines, with the path that it is to follow, and how it is drawn.

    Raises:
        GlyphsplineError: it cannot be laid out, or options clash.
    """
    from ..readers import open_source
    from ..runs.jobs.text import TextJob
    from ..typesetting.lay_out import layout

    lines, along, look = call.lines, call.along, call.settings.look
    text = words_of(call.words, lines.text_file)
    font = open_source(call.font, call.instance.face_index or 0, call.instance.place)
    fallbacks = [open_source(file) for file in lines.fallbacks or ()]
    em = font.metrics.units_per_em
    width, line_height = length("width", lines.width, em, look), length("line_height", lines.line_height, em, look)
    align: Any = lines.align  # "justify" is refused with the path
    curve = None
    if along.path is None:
        for name in ("bend", "offset", "side"):
            if getattr(along, name) != getattr(opt.PathOptions, name):
                raise GlyphsplineError(f"--{name} is for text on a --path")
    else:
        if lines.width is not None:
            raise GlyphsplineError("--width is for lines; text on a --path is one")
        if lines.direction in ("ttb", "btt"):
            raise GlyphsplineError("columns cannot stand on a --path")
        from ..typesetting.path_file import open_path

        curve = open_path(along.path).scaled(pixel(em, look))
    laid_out = layout(
        font, text, fallbacks=fallbacks, features=lines.features, script=lines.script, language=lines.language,
        direction=lines.direction, width=width, line_height=line_height,
        align=align if curve is None else "start",
    )  # fmt: skip
    return TextJob(
        laid_out, call.options, formats, call.settings, call.drawings.each_glyph, curve, along.bend, align,
        along.side, length("offset", along.offset, em, look) or 0.0,
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
