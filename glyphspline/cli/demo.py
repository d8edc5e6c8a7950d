"""The command ``demo``: a few glyphs, so that a newcomer sees what the program makes."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from ..files import make_folder, write_whole
from ..fitting.options import PRESETS, Options
from ..runs.spec import RunSpec
from . import arguments as opt
from .convert import Conversion, opened, run_face, workplace
from .groups import grouped, only
from .messages import say, stop

BRUSHED = "龍好"
"""Characters of the demonstration in brush faces."""


@grouped
def demo(
    subset: Annotated[opt.Subset, only("text")],
    run: Annotated[opt.RunOptions, only("jobs", "quiet")],
    font: Annotated[
        Path | None, typer.Argument(metavar="[FONT]", help="A font of your own.", show_default=False)
    ] = None,
    out: opt.Out = Path("outputs/demo"),
) -> bool:
    """Convert a few glyphs and say where to look; without a font, 龍 and 好 of brush faces and Latin letters.

    龍 and 好 are converted with the preset paper. The package's notebooks are copied to notebooks/.
    """
    undone, shown, paper = False, [], RunSpec(Options(**PRESETS["paper"]))
    asked = opt.as_typed(subset.text or "")
    texts = [(path, asked or text) for path, text in ([(font, BRUSHED)] if font else demo_fonts())]
    specs = [paper if text == BRUSHED else RunSpec() for _, text in texts]
    with workplace(run, *specs) as executor:
        for (path, text), spec in zip(texts, specs, strict=True):
            if not run.quiet:
                say(f"{path.name}: {text}")
            source = opened(path, opt.Instance(), run.quiet)
            names = source.select(text=text)
            if not names:
                stop(f"{path} has none of {text}: give --text")
            folder = out / f"{path.stem}-{path.suffix[1:].lower()}"
            call = Conversion(folder, spec, subset, opt.Instance(), replace(run, resume=False))
            undone |= run_face(source, names, call, executor).undone
            shown.append(folder)
    notebooks = out / "notebooks"
    make_folder(notebooks)
    for path in sorted((Path(__file__).parents[1] / "examples").glob("*.ipynb")):
        write_whole(str(notebooks / path.name), path.read_bytes())
    if not run.quiet:
        pages = [f"  {folder / 'index.html'}" for folder in shown]
        typer.echo("\n".join([
            "Open in a browser:", *pages, "Drawings are in svg/ beside it, curvature maps in curvature/.",
            f"Open in Jupyter: {notebooks / 'example.ipynb'}",
        ]))  # fmt: skip
    return undone


def demo_fonts() -> list[tuple[Path, str]]:
    """The fonts and characters shown when none are given: the repository's, and one that comes with matplotlib."""
    fonts = Path(__file__).parents[2] / "fonts_test"
    if not (fonts / "kouzan-gyosho.ttf").exists():
        stop("the demonstration fonts are in the repository's fonts_test/; here, give a font: glyphspline demo FONT")
    import matplotlib

    dejavu = Path(matplotlib.get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf"
    brushes = ("kouzan-gyosho.ttf", "kouzan-kaisho.ttf", "kouzan-gyosho.otf")
    return [(dejavu, "g&"), *((fonts / name, BRUSHED) for name in brushes)]  # a picture comes soon
