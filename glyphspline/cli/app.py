"""The command line: which commands there are, and how one is found. Each is imported when it is called."""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Callable
from importlib import import_module
from typing import Any

import typer
from typer.core import TyperGroup
from typer.main import get_command

from .. import hooks
from ..hooks import Listed
from . import arguments as opt
from .messages import RULE, UNDONE, errors, watch_interruption

MEMORY = 16 << 30
"""Limit of a process's address space in bytes. Compiled code and thread stacks take a few GB of it."""

OWN = {
    "convert": Listed(
        ".convert:convert", "Convert glyphs of fonts to SVG drawings and curvature maps, with a manifest and an index."
    ),
    "info": Listed(
        ".info:info", "Show what a font file holds: faces, axes, units per em, numbers of glyphs and characters."
    ),
    "report": Listed(".report:report", "Write the gallery, index.html, of one run, or of a folder that holds several."),
    "demo": Listed(
        ".demo:demo",
        "Make the paper's figures for 龍 and 好, convert letters and say where to look; of a font, those of --text.",
    ),
    "warm": Listed(
        ".warm:warm", "Compile everything now, so that no other command has to: for checkouts and containers."
    ),
}  # fmt: skip
"""The commands of the pipeline, as the help lists them."""


USAGE_ERROR: Any = typer.BadParameter.__mro__[1]
"""What a call that cannot be understood ends with; typer has a copy of click, or click itself."""


class Commands(TyperGroup):
    """The pipeline's commands, and those of plug-ins."""

    def list_commands(self, ctx: Any) -> list[str]:
        """Their names, in the order of the help."""
        return [*OWN, *(name for name in hooks.names("commands") if name not in OWN)]

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """The command of that name, or None."""
        with errors(quiet=False):
            if cmd_name in OWN:
                module, _, name = OWN[cmd_name].place.partition(":")
                function = getattr(import_module(module, __package__), name)
            elif (function := hooks.find("commands", cmd_name)) is None:
                return None
        return made(cmd_name, function)

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """The command that the arguments name; a plug-in may be away that had it."""
        try:
            return super().resolve_command(ctx, args)
        except USAGE_ERROR as error:
            error.message += hooks.away_words()
            raise

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write the list of commands, each with its sentence whole, where it would be cut at the line's end."""
        listed = {name: one for plugin in hooks.plugins().values() for name, one in plugin.commands.items()} | OWN
        with formatter.section("Commands"):
            formatter.write_dl([(name, listed[name].help) for name in self.list_commands(ctx)])


def made(name: str, function: Callable[..., None]) -> Any:
    """The command of a function that :func:`.groups.grouped` has made."""
    alone = typer.Typer(add_completion=False, pretty_exceptions_enable=False, rich_markup_mode=None)
    alone.command(name, cls=function.cls)(function)  # type: ignore[attr-defined]
    return get_command(alone)


app = typer.Typer(
    cls=Commands,
    no_args_is_help=True,
    epilog=RULE,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 120},
)


@app.callback()
def common(version: opt.Version = False) -> None:
    """Font glyph outlines as closed C2 B-splines: SVG drawings and curvature maps."""
    gc.enable()


def limit_memory() -> None:
    """Limit the memory of this process and its children, as a hostile font can ask for any amount."""
    try:
        import resource
    except ImportError:  # not on Windows
        return
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    if soft == resource.RLIM_INFINITY or soft > MEMORY:
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, hard))


def main() -> None:
    """The command ``glyphspline``."""
    limit_memory()
    watch_interruption()
    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(errors="replace")
    try:
        app(prog_name="glyphspline")
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(UNDONE)
