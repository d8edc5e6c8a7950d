"""Arguments and options that only commands have; what the API has is in its own dataclasses."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from .._version import __version__
from ..errors import GlyphsplineError, OptionError, require
from ..fields import WRITTEN, About, option
from .config import settings
from .groups import as_path, natural
from .messages import stop

if TYPE_CHECKING:
    from ..readers import Selection, Source

GLYPHS = "Which glyphs"
RUN = "The run"
"""Headings of groups of options."""

NATURAL, PATH = {"parser": natural}, {"parser": as_path}

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
            command: Any = context.command
            context.default_map = settings(path, named, command.name, command.own)
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


def jobs_or_address(text: Any) -> str:
    """Parse a number of processes, or the address of a cluster."""
    return str(text) if "://" in str(text) else str(natural(text))


def print_version(wanted: bool) -> None:
    """Print the version and exit, if that is wanted."""
    if wanted:
        typer.echo(f"glyphspline {__version__}")
        raise typer.Exit


Version = Annotated[
    bool, typer.Option("--version", callback=print_version, is_eager=True, help="Print the version and exit.")
]


def out(help: str, metavar: str, **more: Any) -> About:
    """The option that says where something is written."""
    return About(help, WRITTEN, metavar, ("--out", "-o"), more=more)


FontFile = Annotated[Path, typer.Argument(metavar="FONT", help=FONT_HELP, show_default=False)]
FontFiles = Annotated[list[str], typer.Argument(metavar="FONT", help=FONTS_HELP, show_default=False)]
Out = Annotated[Path, out("Write to this folder.", "DIR", parser=as_path, show_default=False)]


def as_typed(text: str) -> str:
    """Text of the command line as UTF-8, also where the locale is not: with LC_ALL=C Python keeps its bytes."""
    return text.encode(errors="surrogateescape").decode(errors="surrogateescape")


def characters_of(text: str) -> str:
    """The characters of an option: the text itself, or after an @ that of a UTF-8 file. A single @ is a character.

    Raises:
        OptionError: the file cannot be read.
    """
    typed = as_typed(text)
    if not typed.startswith("@") or len(typed) == 1:
        return typed
    try:
        return Path(typed[1:]).read_text(encoding="utf-8-sig")
    except (OSError, ValueError) as error:
        words = getattr(error, "strerror", None) or error
        raise OptionError(f"{typed[1:]}: {words}. A text of @ and others has the @ behind another character") from error


@dataclass(frozen=True)
class Subset:
    """The glyphs that are asked for, as in the fontTools subsetter."""

    text: str | None = option(None, "Take the glyphs of these characters, or of those of a UTF-8 @file.", GLYPHS)
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
            raise GlyphsplineError("no glyphs asked for: give --text, --unicodes, --glyphs, --gids or --all")
        text = characters_of(self.text) if self.text else None
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
    strokes: bool = option(False, "Draw the strokes of SVG drawings too, as outlines.", GLYPHS)

    @property
    def place(self) -> dict[str, float] | str:
        """``wght=700,wdth=80`` as a dictionary; text without ``=`` is the name of an instance, and stays as it is.

        Drawings with their strokes are the instance "strokes".

        Raises:
            OptionError: a value is no number, or strokes have a location.
        """
        if self.strokes:
            require(self.location is None, "--strokes is for drawings, which have no --location", self.location)
            return "strokes"
        if self.location and "=" not in self.location:
            return self.location
        return numbers_of(self.location, "--location is like wght=700,wdth=80")


@dataclass(frozen=True)
class RunOptions:
    """How a command runs, and what it prints."""

    jobs: str | None = option(
        None, "Start this number of worker processes; without it, one a core. Or work on a dask.distributed cluster.",
        RUN, "N|TCP://…", flags="--jobs -j", more={"parser": jobs_or_address},
    )  # fmt: skip
    resume: bool = option(True, "Go on with what is in --out, or do it all anew.", RUN, flags="--resume/--restart")
    config: Path | None = option(
        None,
        "Read options by name from a TOML file: tolerance = 2. The table tool.glyphspline of ./pyproject.toml "
        "is read before.",
        RUN, "FILE", more={"callback": configured, "is_eager": True},
    )  # fmt: skip
    quiet: bool = option(False, "Print nothing but errors.", RUN, flags="--quiet -q")
    as_json: bool = option(
        False, "Print the result as JSON on standard output, and progress as JSON lines on standard error.",
        RUN, flags="--json",
    )  # fmt: skip

    @property
    def scheduler(self) -> str | None:
        """The address of a cluster."""
        return None if self.jobs is None or self.jobs.isdecimal() else self.jobs

    @property
    def processes(self) -> int | None:
        """Worker processes on this machine; None: one a core.

        Raises:
            OptionError: a cluster is asked for.
        """
        if self.scheduler:
            raise OptionError(f"--jobs {self.jobs}: this command works on this machine")
        return None if self.jobs is None else int(self.jobs)
