"""The command ``report``: the gallery of finished runs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .groups import grouped


@grouped
def report(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Folder that a run has written.", show_default=False)],
) -> None:
    """Write the gallery, index.html, of one run, or of a folder that holds several.

    A run without the format gallery is named, with the command that adds it.
    """
    from ..runs.convert import write_gallery

    write_gallery(folder)
    typer.echo(folder / "index.html")
