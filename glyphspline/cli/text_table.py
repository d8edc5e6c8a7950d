"""Tables as text."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from io import StringIO

from .messages import printable

WIDE = 1000
"""Columns of text within which no line of a table is broken; terminals break lines themselves."""


def plain(
    headings: Sequence[str], rows: Iterable[Sequence[str]], numbers: Sequence[str] = (), footer: Sequence[str] = ()
) -> str:
    """A table.

    Args:
        headings: of the columns. rows: their cells; what fonts have in names moves no cursor.
        numbers: headings of the columns that stand to the right. footer: cells of the last line, if there is one.
    """
    from rich import box
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    lines = Table(box=box.ASCII2, show_edge=False, show_footer=bool(footer))
    for k, heading in enumerate(headings):
        below = footer[k] if footer else ""
        lines.add_column(heading, footer=below, justify="right" if heading in numbers else "left")
    for cells in rows:
        lines.add_row(*[Text(printable(cell)) for cell in cells])
    text = StringIO()
    Console(file=text, width=WIDE, color_system=None).print(lines)
    return "\n".join([line.rstrip() for line in text.getvalue().splitlines()])
