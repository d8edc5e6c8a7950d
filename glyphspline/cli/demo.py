"""The command ``demo``: a few glyphs, so that a newcomer sees what the program makes."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from .. import hooks
from ..files import make_folder, write_whole
from ..runs.spec import RunSpec
from . import arguments as opt
from .convert import Conversion, opened, run_face, workplace
from .groups import grouped, only
from .messages import say, stop

BRUSHED, LATIN = "龍好", "g&"
"""Characters of the demonstration, in a brush face and in a Latin one."""


@grouped
def demo(
    subset: Annotated[opt.Subset, only("text")],
    run: Annotated[opt.RunOptions, only("jobs", "quiet")],
    font: Annotated[
        Path | None, typer.Argument(metavar="[FONT]", help="A font of your own.", show_default=False)
    ] = None,
    out: opt.Out = Path("outputs/demo"),
) -> bool:
    """Make the paper's figures for 龍 and 好, convert letters and say where to look; of a font, those of --text.

    Points of 龍 and 好 are clicked ones. The package's notebooks are copied to notebooks/.
    """
    asked, shown, spec = opt.as_typed(subset.text or ""), list[str](), RunSpec()
    figures, drawn = (font, font) if font else demo_fonts()
    with workplace(run, spec) as executor:
        source = opened(drawn, opt.Instance(), run.quiet)
        names = source.select(text=asked or (BRUSHED if font else LATIN)) or source.select(text=LATIN)
        if not names:
            stop(f"{drawn} has none of {asked or BRUSHED}: give --text")
        if figures_of := hooks.find("services", "experiment"):
            clicked = None if font or asked else figures.with_suffix(".csv")
            shown.append(figures_of(figures, asked or BRUSHED, clicked, out / "experiment", run, executor))
        if not run.quiet:
            say(f"{drawn.name}: {asked or (BRUSHED if font else LATIN)}")
        folder = out / f"{drawn.stem}-{drawn.suffix[1:].lower()}"
        call = Conversion(folder, spec, subset, opt.Instance(), replace(run, resume=False))
        undone = run_face(source, names, call, executor).undone
        shown.append(str(folder / "index.html"))
    notebooks = out / "notebooks"
    make_folder(notebooks)
    for path in sorted((Path(__file__).parents[1] / "examples").glob("*.ipynb")):
        write_whole(str(notebooks / path.name), path.read_bytes())
    if not run.quiet:
        typer.echo("\n".join([
            "Open in a browser:", *(f"  {page}" for page in shown),
            "Drawings are in svg/ beside it, curvature maps in curvature/.",
            f"Open in Jupyter: {notebooks / 'example.ipynb'}",
        ]))  # fmt: skip
    return undone


def demo_fonts() -> tuple[Path, Path]:
    """The fonts shown when none is given: the repository's, for figures, and one that comes with matplotlib."""
    brush = Path(__file__).parents[2] / "fonts_test" / "kouzan-gyosho.ttf"
    if not brush.exists():
        stop("the demonstration fonts are in the repository's fonts_test/; here, give a font: glyphspline demo FONT")
    import matplotlib

    return brush, Path(matplotlib.get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf"
