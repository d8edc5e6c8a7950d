"""Arguments and options that only commands have; what the API has is in its own dataclasses."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from .._version import __version__
from ..checks.kinds import KINDS, Level
from ..errors import GlyphsplineError, OptionError
from ..fields import LOOK, WRITTEN, About, option
from ..typesetting.setting import Align, Direction
from .config import settings
from .groups import natural, place
from .messages import stop

if TYPE_CHECKING:
    from ..readers import Selection, Source

GLYPHS = "Which glyphs"
TEXT = "The text"
RUN = "The run"
FOUND = "What is found"
REPORTED = "What is reported"
"""Headings of groups of options."""

NATURAL, PLACE = {"parser": natural}, {"parser": place}

FONT_HELP = "TTF, OTF, TTC, WOFF, WOFF2, UFO, designspace, Glyphs or SVG; - is standard input."
FONTS_HELP = (
    "Fonts (TTF, OTF, TTC, WOFF, WOFF2, UFO, designspace, Glyphs, SVG; - is standard input), folders, globs, URLs, or "
    "@file with one a line."
)


def configured(context: typer.Context, path: Path | None) -> Path | None:
    """Take defaults from a file of settings, before the other options are read."""
    if not context.resilient_parsing:
        named = ((one.opts, str(one.name)) for one in context.command.params)
        try:
            context.default_map = settings(path, named, context.command.name)
        except GlyphsplineError as error:
            stop(str(error))
    return path


def items_of(text: str | None) -> list[str]:
    """The items of a list between commas."""
    return [item for item in (text or "").replace(" ", "").split(",") if item]


def numbers_of(text: str | None, rule: str) -> dict[str, float]:
    """Numbers by name of a list as kink=1,short=2; of one that is given twice the last counts.

    Raises:
        OptionError: one is no number, with the rule that says how the list is.
    """
    found = {}
    for item in items_of(text):
        name, _, value = item.partition("=")
        try:
            found[name] = float(value)
        except ValueError:
            raise OptionError(f"{rule}, not {item!r}") from None
    return found


def print_version(wanted: bool) -> None:
    """Print the version and exit, if that is wanted."""
    if wanted:
        typer.echo(f"glyphspline {__version__}")
        raise typer.Exit


def more_thresholds(context: typer.Context, text: str | None) -> str | None:
    """Thresholds of the command line after those of a file, which they replace one by one."""
    before = (context.default_map or {}).get("thresholds")
    return text if text == before else ",".join(filter(None, [before, text]))


Version = Annotated[
    bool, typer.Option("--version", callback=print_version, is_eager=True, help="Print the version and exit.")
]


def out(help: str, metavar: str, **more: Any) -> About:
    """The option that says where something is written."""
    return About(help, WRITTEN, metavar, ("--out", "-o"), more=more)


FontFile = Annotated[Path, typer.Argument(metavar="FONT", help=FONT_HELP, show_default=False)]
FontFiles = Annotated[list[str], typer.Argument(metavar="FONT", help=FONTS_HELP, show_default=False)]
Out = Annotated[Path, out("Write to this folder.", "DIR", parser=place, show_default=False)]


def as_typed(text: str) -> str:
    """Text of the command line as UTF-8, also where the locale is not: with LC_ALL=C Python keeps its bytes."""
    return text.encode(errors="surrogateescape").decode(errors="surrogateescape")


@dataclass(frozen=True)
class Subset:
    """The glyphs that are asked for, as in the fontTools subsetter."""

    text: str | None = option(None, "Take the glyphs of these characters.", GLYPHS)
    text_file: Path | None = option(None, "Take the glyphs of a UTF-8 file's characters.", GLYPHS)
    unicodes: str | None = option(None, "Take these code points: U+4E00-4E10,9F8D or *.", GLYPHS)
    glyphs: str | None = option(None, "Take the glyphs of these names, between commas, or *.", GLYPHS)
    gids: str | None = option(None, "Take these glyph indices: 5,10-20 or *.", GLYPHS)
    all_glyphs: bool = option(False, "Take every glyph of the font.", GLYPHS, flags="--all")

    @property
    def is_given(self) -> bool:
        """Whether any glyphs are asked for."""
        return self != Subset()

    def of(self, source: Source) -> Selection:
        """The glyphs in a font.

        Raises:
            GlyphsplineError: none are asked for, or what is asked for is no list of glyphs.
        """
        if not self.is_given:
            raise GlyphsplineError(
                "no glyphs asked for: give --text, --text-file, --unicodes, --glyphs, --gids or --all"
            )
        text = as_typed(self.text) if self.text else None
        if self.text_file is not None:
            text = (text or "") + self.text_file.read_text(encoding="utf-8-sig")
        glyphs = as_typed(self.glyphs) if self.glyphs else None
        return source.select(
            text=text, unicodes=self.unicodes, glyphs=glyphs, gids=self.gids, all_glyphs=self.all_glyphs
        )


@dataclass(frozen=True)
class Instance:
    """A font of a file, and where in its design space."""

    face_index: int | None = option(None, "Read only this font of a collection.", GLYPHS, "N", more=NATURAL)
    location: str | None = option(
        None, "Set the place of a variable font: wght=700,wdth=80, or a name: Bold.", GLYPHS, "TAG=VALUE,…"
    )

    @property
    def place(self) -> dict[str, float] | str:
        """``wght=700,wdth=80`` as a dictionary; text without ``=`` is the name of an instance, and stays as it is.

        Raises:
            OptionError: a value is no number.
        """
        if self.location and "=" not in self.location:
            return self.location
        return numbers_of(self.location, "--location is like wght=700,wdth=80")


@dataclass(frozen=True)
class RunOptions:
    """How a command runs, and what it prints."""

    jobs: int | None = option(
        None, "Start this number of worker processes. Without it, one a core.",
        RUN, "N", flags="--jobs -j", more=NATURAL,
    )  # fmt: skip
    scheduler: str | None = option(None, "Work on this dask.distributed cluster instead.", RUN, "TCP://…")
    resume: bool = option(True, "Go on with what is in --out, or do it all anew.", RUN, flags="--resume/--restart")
    config: Path | None = option(
        None,
        "Read options by name from a TOML file: tolerance = 2. The table tool.glyphspline of ./pyproject.toml "
        "is read before.",
        RUN, "FILE", more={"callback": configured, "is_eager": True},
    )  # fmt: skip
    quiet: bool = option(False, "Print nothing but errors.", RUN, flags="--quiet -q")
    as_json: bool = option(False, "Print the result as JSON on standard output.", RUN, flags="--json")
    json_log: bool = option(
        False, "Print progress and summary as JSON lines on standard error.", RUN, flags="--json-log"
    )


@dataclass(frozen=True)
class SingleFonts:
    """Single fonts that become masters beside the first one, and their axis."""

    others: list[Path] | None = option(
        None, "Add the glyphs of this single font as masters beside FONT's, on --axis. Repeatable.",
        WRITTEN, "FONT", flags="--from",
    )  # fmt: skip
    axis: str | None = option(
        None, "Set the axis of such fonts, as wght=300:700, a value for each in turn.", WRITTEN, "TAG=A:B"
    )


@dataclass(frozen=True)
class TextOptions:
    """How a text is set on lines, and where it comes from."""

    text_file: Path | None = option(None, "Set the text of a UTF-8 file instead.", TEXT, "FILE")
    fallbacks: list[Path] | None = option(
        None, "Use this font for characters that FONT lacks. Repeatable.", TEXT, "FONT", flags="--fallback-font"
    )
    features: str = option("", "Switch OpenType features: liga,-kern,ss01=2.", TEXT, "TAG,…")
    script: str | None = option(None, "Set the script of all text, by ISO 15924: Arab.", TEXT, "CODE")
    language: str | None = option(None, "Set the language, by BCP 47: de, zh-Hant.", TEXT, "TAG")
    direction: Direction | None = option(
        None, "Set the direction; ttb and btt are columns. Without it, that of the first letter.", TEXT
    )
    width: str | None = option(
        None, "Break lines at this width: font units, 12em, or 80mm if --size is given.", TEXT, "LENGTH"
    )
    align: Align = option("start", "Align lines; justify widens spaces.", TEXT)
    line_height: str | None = option(None, "Set the distance of baselines. Without it, the font's.", TEXT, "LENGTH")
    letter_spacing: str | None = option(None, "Add this space between letters.", TEXT, "LENGTH")
    cap_height: str | None = option(
        None, "Set the size by the height of a capital H: 50mm, instead of --size.", LOOK, "LENGTH"
    )
    x_height: str | None = option(None, "Set the size by the height of a small x, likewise.", LOOK, "LENGTH")
    fit_width: str | None = option(None, "Set the size by the width of all ink of the lines: 1200mm.", LOOK, "LENGTH")


@dataclass(frozen=True)
class DrawingOptions:
    """How drawings of a text are written."""

    format_name: str | None = option(
        None, "Write this format (curvature, source, …) instead of that of --out's suffix.",
        WRITTEN, "NAME", flags="--format",
    )  # fmt: skip
    each_glyph: bool = option(False, "Write each glyph in SVG as an element with an id, not all as one path.", WRITTEN)


@dataclass(frozen=True)
class CheckOptions:
    """What ``check`` looks for."""

    kinds: str | None = option(None, f"Look only for {', '.join(kind.name for kind in KINDS)}.", FOUND, "KIND,…")
    thresholds: str | None = option(
        None, "Set from which value on each kind counts, as kink=1,short=2: degrees, thousandths of an em, shares.",
        FOUND, "NAME=VALUE,…", more={"callback": more_thresholds},
    )  # fmt: skip
    corner_angle: float | None = option(
        None, "Count a joint as a corner from this turn on. Without it, 12.", FOUND, "DEGREES"
    )
    axis: str | None = option(None, "Look along this axis of a variable font only.", FOUND, "TAG")
    steps: int | None = option(
        None, "Look at this number of steps of each axis besides the masters.", FOUND, "N", more=NATURAL
    )


@dataclass(frozen=True)
class ReportOptions:
    """What ``check`` makes of its findings."""

    loglevel: Level | None = option(
        None, "Show findings from this level on. Without it, WARN in tables, INFO in JSON, CSV and HTML.",
        REPORTED, flags="--loglevel -l", more={"case_sensitive": False},
    )  # fmt: skip
    error_level: Level | None = option(
        None, "Exit with status 1 if there are findings of this level or above.",
        REPORTED, flags="--error-level -e", more={"case_sensitive": False},
    )  # fmt: skip
    baseline: Path | None = option(None, "Leave out the findings of this file that are no worse now.", REPORTED, "FILE")
    write_baseline: Path | None = option(
        None, "Write all findings to this file, as known ones.", REPORTED, "FILE", more=PLACE
    )
    rows: int = option(20, "Print this number of lines of the table.", REPORTED, "N", more=NATURAL)
    csv: Path | None = option(None, "Write findings as CSV; - is standard output.", REPORTED, "FILE", more=PLACE)
    ghmarkdown: Path | None = option(
        None, "Write findings as Markdown for GitHub; - is standard output.", REPORTED, "FILE", more=PLACE
    )
    html: Path | None = option(None, "Write a page with a drawing of each finding.", REPORTED, "FILE", more=PLACE)
    plot: Path | None = option(
        None, "Draw the largest turn against the axis: SVG, PNG, PDF.", REPORTED, "FILE", more=PLACE
    )
