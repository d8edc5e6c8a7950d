"""A plug-in of glyphspline: the format ``count``, the command ``count``, the public name ``gs.count``.

It says how many contours and segments a glyph has. Install it beside glyphspline by
``pip install docs/examples/counting``.
"""

from __future__ import annotations

from typing import Annotated

import typer

import glyphspline as gs
from glyphspline.cli import arguments as opt
from glyphspline.cli.groups import grouped
from glyphspline.fields import About
from glyphspline.hooks import Listed, Plugin
from glyphspline.writers.formats import Format
from glyphspline.writers.settings import Settings


def count(outline: gs.Outline) -> tuple[int, int]:
    """The numbers of contours and of segments of an outline."""
    return len(outline.contours), sum(map(len, outline.contours))


def write(result: gs.GlyphResult, settings: Settings) -> str:
    """A file of the format ``count``: name, contours, segments of the result."""
    return f"{result.outline.name} {len(result.contours)} {sum(len(each.curve) for each in result.contours)}\n"


@grouped
def command(font: opt.FontFile, text: Annotated[str, About("Count the contours of these characters.")] = "A") -> bool:
    """Count the contours and segments of glyphs."""
    source = gs.open_source(font)
    for name in source.select(text=text):
        typer.echo(f"{name} {' '.join(map(str, count(source.outline(name))))}")
    return False


COUNT = Format("count", ".count.txt", write)

PLUGIN = Plugin(
    commands={"count": Listed("counting:command", "Count the contours and segments of glyphs.")},
    formats={"count": "counting:COUNT"},
    names={"count": "counting:count"},
)
