"""The command ``text``: a text laid out on lines or along a path, and written as drawings."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import GlyphsplineError, OptionError
from . import arguments as opt
from .messages import say

if TYPE_CHECKING:
    from ..fitting.results import GlyphResult
    from ..layout.path import Path as Curve
    from ..layout.placed import Layout
    from ..writers.formats import Format
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


def set_text(given: Mapping[str, Any]) -> int:
    """Lay a text out and write its drawings; returns the exit status: 1 if something is left out of them, else 0.

    Raises:
        GlyphsplineError: the text cannot be laid out, or a format is unknown.
        OSError: a file cannot be read or written.
    """
    from ..layout.placed import LEFT_OUT

    files = list(formats_of(given["out"], given["format_name"]))
    look = look_of(given)
    layout, path = laid_out(given, look)
    drawn = Drawn(layout, path, given, look)
    contents = [drawn.content(each) for _, each in files]  # nothing is written if one of them fails
    for (file, _), content in zip(files, contents, strict=True):
        if str(file) == "-":
            sys.stdout.buffer.write(content)
        else:
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(content)
    remarks = [*missing(layout), *drawn.notes]
    if not given["quiet"]:
        for line in remarks[:SHOWN]:
            say(line)
        if len(remarks) > SHOWN:
            say(f"and {len(remarks) - SHOWN} remarks more")
    return 1 if layout.missing or any(f"{LEFT_OUT}: " in note for note in drawn.notes) else 0


def formats_of(files: Sequence[Path], name: str | None) -> Iterator[tuple[Path, Format]]:
    """The format of each file: of that name, or by its suffix.

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
        yield file, found


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


def laid_out(given: Mapping[str, Any], look: Appearance) -> tuple[Layout, Curve | None]:
    """The text on its lines, with the path that it is to follow, in font units, or None.

    Raises:
        GlyphsplineError: it cannot be laid out, or options clash.
    """
    from ..layout.lay_out import layout
    from ..readers import open_source

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
        from ..layout.path_file import open_path

        curve = open_path(given["path"]).scaled(pixel(em, look))
    setting["align"] = given["align"] if curve is None else "start"
    return layout(font, text, fallbacks=fallbacks, **setting, **lengths), curve


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


class Drawn:
    """The drawings of a text: its glyphs are fitted once for all formats, and not at all for a source's outline."""

    def __init__(self, layout: Layout, path: Curve | None, given: Mapping[str, Any], look: Appearance) -> None:
        self.options = opt.options_of(given)
        self.look, self.each = look, given["each_glyph"]
        self.given = given
        self.notes: dict[str, None] = {}
        self.bent = None
        if path is not None:
            place: dict[str, Any] = {"align": given["align"], "side": given["side"]}
            em = layout.fonts[0].metrics.units_per_em
            place["offset"] = length("offset", given["offset"], em, look) or 0.0
            if given["bend"]:
                from ..layout.bent import SHARE, bend

                self.bent = bend(layout, path, SHARE * self.options.tolerance_for(em), **place)
            else:
                from ..layout.along_path import along

                layout = along(layout, path, **place)
        self.layout = layout

    @cached_property
    def fitted(self) -> GlyphResult:
        """The whole text, fitted."""
        from ..fitting.convert import convert

        result = self.layout.convert(self.options) if self.bent is None else convert(self.bent, self.options)
        self.notes |= dict.fromkeys(result.notes)
        return result

    @cached_property
    def unfitted(self) -> GlyphResult:
        """The whole text as the fonts have it."""
        from ..fitting.convert import unfitted

        outline = self.layout.outline() if self.bent is None else self.bent
        (found,) = unfitted([outline], self.options)
        if isinstance(found, GlyphsplineError):
            raise found
        self.notes |= dict.fromkeys((*outline.notes, *found.notes))
        return found

    @cached_property
    def settings(self) -> Settings:
        """What writers are told."""
        from ..writers.settings import settings_for

        metrics = self.layout.fonts[0].metrics
        return settings_for(self.look, metrics, self.given["flatness"], self.given["dxf"])

    def content(self, form: Format) -> bytes:
        """A drawing as bytes."""
        if self.each and form.name in ("svg", "source"):
            return self.each_glyph(fitted=form.fitted)
        made = form.write(self.fitted if form.fitted else self.unfitted, self.settings)
        return made.encode() if isinstance(made, str) else made

    def each_glyph(self, *, fitted: bool) -> bytes:
        """The SVG drawing in which each glyph is an element."""
        from ..writers.svg.text_drawing import text_document

        if self.bent is not None:
            raise GlyphsplineError("--each-glyph: bent text is one outline")
        results = self.layout.results(self.options) if fitted else self.layout.unfitted(self.options)
        self.notes |= dict.fromkeys([note for result in results for note in (*result.outline.notes, *result.notes)])
        return text_document(self.layout, results, self.look)
