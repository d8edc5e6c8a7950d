"""The command ``text``: sets a text on lines, and writes drawings."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ...cli import arguments as opt
from ...cli.convert import opened
from ...cli.groups import grouped, only, without
from ...cli.messages import put, say
from ...errors import GlyphsplineError, OptionError
from ...fitting.options import Options
from ...types import INCHES, listed, shortened
from ...writers.settings import Appearance, Maps, Settings, paper_length
from .options import DrawingOptions, TextOptions

if TYPE_CHECKING:
    from ...readers import Source
    from .placed import Layout

SHOWN = 10
"""Maximum number of remarks printed, and of characters named in one."""

BY_SUFFIX = {
    ".svg": "svg", ".png": "png", ".pdf": "pdf", ".dxf": "dxf", ".json": "json", ".csv": "polyline-csv",
}  # fmt: skip
"""The format of a file by its suffix, without ``--format``."""

LENGTH = re.compile(r"(-?\d{1,9}(?:\.\d{1,9})?)([a-z]*)")


@grouped
def text(
    font: opt.FontFile,
    out: Annotated[
        list[Path],
        opt.out(
            "Write this SVG, PNG, PDF, DXF, JSON or CSV (polylines); - is standard output. Repeatable.",
            "FILE",
            show_default=False,
        ),
    ],
    lines: TextOptions,
    options: Annotated[Options, without("measure")],
    settings: Settings,
    maps: Maps,
    drawings: DrawingOptions,
    run: Annotated[opt.RunOptions, only("config", "quiet")],
    *,
    words: Annotated[
        str | None, typer.Argument(metavar="[TEXT]", help="Text to set; - is standard input.", show_default=False)
    ] = None,
    instance: opt.Instance,
) -> bool:
    """Set a text: shaped by HarfBuzz, on one line or several, as SVG, DXF and other drawings.

    Each glyph is fitted once, however often it occurs.
    """
    from ...runs.schedule import workers
    from ...runs.spec import kinds_for

    files = list(formats_of(out, drawings.format_name))
    names = tuple(name for _, name in files)
    # First: the worker gets ready while the text is laid out.
    with workers(1, kinds=kinds_for(options, names), expected=1) as executor:
        from .job import TextJob, draw
        from .placed import LEFT_OUT

        content = words_of(words, lines.text_file)
        source = opened(font, instance, run.quiet)
        settings = replace(settings, look=sized(settings.look, lines, source))
        layout = laid_out(source, content, lines, settings.look)
        settings = replace(settings, title=layout.text)
        job = TextJob(layout, options, names, settings, drawings.each_glyph, lines.fit_width, maps)
        drawn = draw(job, executor)
    for (file, _), drawing in zip(files, drawn.contents, strict=True):  # nothing is written if one of them fails
        put(file, drawing)
    remarks = [*remarks_on(layout), *sorted(drawn.notes, key=lambda note: f"{LEFT_OUT}: " not in note)]
    for line in () if run.quiet else shortened(remarks, SHOWN, "and {} remarks more"):
        say(line)
    return bool(layout.missing or layout.unvaried or not drawn.complete)


def formats_of(files: Sequence[Path], name: str | None) -> Iterator[tuple[Path, str]]:
    """The name of the format of each file: ``name``, or by its suffix.

    Raises:
        GlyphsplineError: there is none, or several files with one name.
    """
    from ...extras import need
    from ...writers.formats import format_named

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
    return opt.as_typed(words)


def sized(look: Appearance, lines: TextOptions, source: Source) -> Appearance:
    """The look with the length of an em that the heights of letters ask for.

    Raises:
        OptionError: two sizes are given, or the font has no such height.
    """
    given = {name: value for name in ("cap_height", "x_height", "fit_width") if (value := getattr(lines, name))}
    options = [f"--{name.replace('_', '-')}" for name in (["size"] if look.em else []) + list(given)]
    if len(options) > 1:
        raise OptionError(f"give one of --size, --cap-height, --x-height and --fit-width, not {' and '.join(options)}")
    for name, text in given.items():
        (value, unit), height = paper_length(options[0], text) or (0.0, ""), getattr(source, name, 1.0)
        if height is None:
            letter = "H" if name == "cap_height" else "x"
            raise OptionError(
                f"{options[0]}: {source.path} has no {letter} to measure, and its OS/2 table no such height"
            )
        if name != "fit_width":  # which the worker measures
            return replace(look, em=f"{value * source.metrics.units_per_em / height:.9f}{unit}")
    return look


def laid_out(source: Source, text: str, lines: TextOptions, look: Appearance) -> Layout:
    """The text on its lines.

    Raises:
        GlyphsplineError: it cannot be laid out.
    """
    from ...readers import open_source
    from .lay_out import layout

    em = source.metrics.units_per_em
    return layout(
        source, text, fallbacks=[open_source(file) for file in lines.fallbacks or ()], features=lines.features,
        script=lines.script, language=lines.language, direction=lines.direction,
        width=length("width", lines.width, em, look), line_height=length("line_height", lines.line_height, em, look),
        align=lines.align, letter_spacing=length("letter_spacing", lines.letter_spacing, em, look) or 0.0,
    )  # fmt: skip


def length(name: str, text: str | None, em: float, look: Appearance) -> float | None:
    """A length in font units from one with a unit: "80mm" where ``--size`` is given, "12em", or "1000" font units.

    Raises:
        OptionError: it is none.
    """
    if text is None:
        return None
    option = f"--{name.replace('_', '-')}"
    found = LENGTH.fullmatch(text)
    if found is None or found[2] not in ("", "em", *INCHES):
        raise OptionError(f"{option} is a length in font units, em, {', '.join(INCHES)}, not {text!r}")
    value, unit = float(found[1]), found[2]
    if unit in INCHES:
        drawn = look.scale(1.0, em)
        if drawn is None:
            raise OptionError(f"{option} {text} needs --size, --cap-height or --x-height: how large is an em?")
        return value * INCHES[unit] / (drawn[0] * INCHES[drawn[1]])
    return value * em if unit else value


def remarks_on(layout: Layout) -> Iterator[str]:
    """Notes of the layout, characters and variations that no font has, and scripts whose letters join, if spaced."""
    yield from layout.notes
    if layout.missing:
        named = [f"{c} (U+{ord(c[0]):04X})" for c in layout.missing[:SHOWN]]
        yield f"no glyph for {listed(named, len(layout.missing))}: .notdef stands there"
    if layout.unvaried:
        named = [" ".join([f"U+{ord(character):04X}" for character in each]) for each in layout.unvaried[:SHOWN]]
        yield f"no variation {listed(named, len(layout.unvaried))}: it stands there without the selector"
    if layout.letter_spacing:
        from fontTools.unicodedata import script_name

        from .scripts import JOINED, scripts_of

        if found := sorted(JOINED.intersection(scripts_of(layout.text))):
            names = ", ".join(map(script_name, found))
            yield f"letters of {names} join, and --letter-spacing pulls them apart"
