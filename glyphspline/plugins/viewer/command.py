"""The commands ``view`` and ``atlas``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from ...cli import arguments as opt
from ...cli.convert import chosen, opened
from ...cli.groups import as_path, grouped, only, without
from ...cli.messages import progress, say, stop
from ...extras import need
from ...fields import About
from ...fitting.options import Options
from ...types import listed, shortened
from ...writers.settings import BOTH, Maps


@grouped
def view(
    font: opt.FontFile,
    instance: Annotated[opt.Instance, only("face_index")],
    port: Annotated[
        int, About("Listen on this port; 0 takes any that is free.", more={"min": 0, "max": 65535, "parser": None})
    ] = 0,
    browser: Annotated[bool, About("Open the page in a browser.", flags=("--browser/--no-browser",))] = True,
) -> None:
    """Look at a font live: a page, for this machine only, on which sliders move and curves follow."""
    need("view")
    from .app import serve

    face = opened(font, instance, quiet=False).face_index
    serve(font, face, port=port, browser=browser, announce=lambda address: say(f"{address} (Ctrl-C ends it)"))


@grouped
def atlas(
    font: opt.FontFile,
    subset: opt.Subset,
    options: Annotated[Options, without("measure", "precision", "remove_overlaps")],
    run: Annotated[opt.RunOptions, only("jobs", "quiet")],
    instance: opt.Instance,
    out: Annotated[Path, opt.out("Write this PDF.", "FILE", parser=as_path)] = Path("atlas.pdf"),
    axis: Annotated[
        str | None,
        About(
            "Draw each glyph along this axis of a variable font instead, its source and the sharp curve for all "
            "masters.",
            metavar="TAG",
        ),
    ] = None,
    profiles: Annotated[
        str | None, About("Add a page with κ(s) for these characters; for up to 12 glyphs, for all.")
    ] = None,
    maps: Maps = BOTH,
) -> bool:
    """Draw the curvature of many glyphs as a PDF: combs on one scale, and κ(s) of chosen contours.

    The combs are those of the results, and a dashed line is through the tips of the sources', unless --comb says
    otherwise.

    With --axis, each glyph of a variable font has a page: combs of source and result at places of the axis, and the
    largest turn and the bending energy against it. Other axes are at --location, or at their default.
    """
    from .atlas import make_atlas

    if out.suffix.lower() not in (".pdf", ""):
        stop(f"--out {out}: an atlas is a PDF, and its name ends in .pdf")
    if axis is not None and (profiles is not None or maps.comb != "both"):
        stop("--profiles and --comb are of an atlas without --axis, which shows both combs")
    source = opened(font, instance, run.quiet)
    names = chosen(source, subset, run.quiet)
    profiled = None if profiles is None else source.select(text=opt.as_typed(profiles))
    with progress(run.quiet) as observer:
        made = make_atlas(
            source, names, out, options, axis, profiles=profiled, maps=maps, jobs=run.processes, observer=observer
        )
    if not run.quiet:
        failed = made.failed
        say(f"{made.pages} pages written to {out}" + (f"; {len(failed)} glyphs failed" if failed else ""))
        for line in shortened(failed, 10):
            say(f"failed: {line}")
        if made.outside:
            say(f"not within the tolerance: {listed(made.outside[:10], len(made.outside))}")
    return bool(made.failed or made.outside or names.missing)
