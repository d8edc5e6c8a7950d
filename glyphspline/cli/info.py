"""The command ``info``: what a font file holds."""

from __future__ import annotations

from typing import Annotated

import typer

from ..fields import About
from . import arguments as opt
from .groups import grouped, only
from .messages import print_json, printable, progress
from .tables import font_lines


@grouped
def info(
    font: opt.FontFile,
    instance: opt.Instance,
    run: Annotated[opt.RunOptions, only("as_json")],
    deep: Annotated[
        bool, About("Read every glyph: count contours, find overlaps and what is broken. Takes minutes.")
    ] = False,
) -> None:
    """Show what a font file holds: faces, axes, units per em, numbers of glyphs and characters."""
    from ..readers.open import file_facts

    facts = file_facts(font, instance.face_index, instance.place)
    if deep:
        from ..readers.open import STDIN, standard_input
        from ..runs.deep_facts import add_glyph_facts
        from ..runs.schedule import workers

        path = standard_input() if str(font) == STDIN else font
        # In processes with a time limit: counting the contours of a hostile font can take years.
        with workers(None, kinds=["checks"]) as executor, progress(quiet=False) as observer:
            add_glyph_facts(path.absolute(), facts, executor, observer)
    if run.as_json:
        print_json(facts)
    else:
        typer.echo(printable("\n".join(font_lines(facts))))
