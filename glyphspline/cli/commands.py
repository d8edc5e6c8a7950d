"""The commands of ``glyphspline``; each imports its heavy modules itself."""

from __future__ import annotations

import gc
import os
import sys
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer

from ..datasets.spec import ROWS, TAKEN, DatasetSpec
from ..errors import OptionError
from ..extras import need
from ..fields import About
from ..files import make_folder, write_whole
from ..fitting.options import PRESETS, Options
from ..runs.spec import RunSpec
from ..types import listed, shortened
from ..writers.settings import BOTH, Maps
from . import arguments as opt
from .check_command import check
from .diff_command import diff
from .groups import BareOptions, Command, Commands, grouped, only, place, without
from .mend_command import mend
from .messages import RULE, UNDONE, print_json, printable, progress, say, stop, watch_interruption
from .running import Conversion, check_masters, chosen, convert_fonts, convert_masters, opened, run_face, workplace
from .tables import font_lines, runs_facts, runs_table
from .text_command import text

MEMORY = 16 << 30
"""Limit of a process's address space in bytes. Compiled code and thread stacks take a few GB of it."""

BRUSHED = "龍好"
"""Characters of the demonstration in brush faces."""

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


@app.command(cls=BareOptions)
@grouped
def convert(
    fonts: opt.FontFiles,
    out: opt.Out,
    spec: RunSpec,
    subset: opt.Subset,
    instance: opt.Instance,
    single: opt.SingleFonts,
    run: opt.RunOptions,
) -> bool:
    """Convert glyphs of fonts to SVG drawings and curvature maps, with a manifest and an index.

    One font goes to the folder itself, several to a folder each in it, each face of a collection to one in that.

    Of several fonts, or a folder, glob or list of them, every glyph is converted unless some are asked for.
    """
    call = Conversion(out, spec, subset, instance, run)
    if spec.masters or single != opt.SingleFonts():
        call = replace(call, spec=replace(spec, masters=True))
        check_masters(call, single)
    with workplace(run.jobs, run.scheduler, call.spec) as executor:  # first: workers start while fonts are opened
        from ..runs.font_search import find_fonts

        found = find_fonts(fonts)
        if not found:
            stop("no fonts found")
        if call.spec.masters:
            return convert_masters(found, call, single, executor)
        alone = found == [Path(fonts[0])] and len(fonts) == 1
        runs = convert_fonts(found, call, executor, alone)
    if not (run.quiet or run.json_log or alone):
        say(f"written to {out}")
        say(runs_table(runs))
    if run.as_json:
        print_json(runs_facts(runs))
    return any(one.undone for one in runs)


def place_or_url(text: Any) -> str:
    """Parse a path or URL, which stays as it is written."""
    place(text)
    return str(text)


@app.command(cls=Command)
@grouped
def dataset(
    fonts: opt.FontFiles,
    out: Annotated[
        str, opt.out("Write to this folder, or s3://bucket/folder.", "DIR|URL", parser=place_or_url, show_default=False)
    ],
    spec: DatasetSpec,
    run: Annotated[opt.RunOptions, only("jobs", "scheduler", "resume", "config", "quiet", "as_json")],
    fit: Annotated[bool, About("Fit splines and measure them.", ROWS, flags=("--fit/--no-fit",))] = True,
    text_file: Annotated[Path | None, About("Take only glyphs of a UTF-8 file's characters.", TAKEN)] = None,
) -> bool:
    """Make a data set of the glyphs of fonts: Parquet files that datasets, pandas, DuckDB and Arrow open.

    Splits are by family. The same fonts and options give the same bytes, and a run that was interrupted goes on.
    """
    from ..datasets.run import dataset as make

    spec = replace(spec, characters=opt.as_typed(spec.characters), options=spec.options if fit else None)
    if text_file is not None:
        if spec.characters:
            raise OptionError("give --text or --text-file, not both")
        text = text_file.read_text(encoding="utf-8-sig")
        spec = replace(spec, characters="".join(sorted(set(text) - set("\r\n"))))
    with progress(run.quiet) as observer:
        summary = make(
            fonts, out, spec, jobs=run.jobs, scheduler=run.scheduler, restart=not run.resume, observer=observer
        )
    if not run.quiet:
        for line in summary.lines():
            say(line)
        say(f"written to {out}: read {out.rstrip('/')}/README.md")
    if run.as_json:
        print_json(summary.facts())
    return bool(summary.failed or summary.outside_tolerance or summary.fonts["failed"])


app.command(cls=Command)(text)


@app.command(cls=Command)
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
        from ..runs.jobs.deep_facts import add_glyph_facts
        from ..runs.schedule import workers

        path = standard_input() if str(font) == STDIN else font
        # In processes with a time limit: counting the contours of a hostile font can take years.
        with workers(None, kinds=["checks"]) as executor, progress(quiet=False) as observer:
            add_glyph_facts(path.absolute(), facts, executor, observer)
    if run.as_json:
        print_json(facts)
    else:
        typer.echo(printable("\n".join(font_lines(facts))))


@app.command(cls=Command)
@grouped
def report(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Folder that a run has written.", show_default=False)],
) -> None:
    """Write the gallery, index.html, of one run, or of a folder that holds several.

    A run without the format gallery is named, with the command that adds it.
    """
    from ..runs.jobs.convert import write_gallery

    write_gallery(folder)
    typer.echo(folder / "index.html")


@app.command(cls=Command)
@grouped
def atlas(
    font: opt.FontFile,
    subset: opt.Subset,
    options: Annotated[Options, without("measure", "precision", "remove_overlaps")],
    run: Annotated[opt.RunOptions, only("jobs", "quiet")],
    instance: opt.Instance,
    out: Annotated[Path, opt.out("Write this PDF.", "FILE", parser=place)] = Path("atlas.pdf"),
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
    from ..runs.jobs.atlas import make_atlas

    if out.suffix.lower() not in (".pdf", ""):
        stop(f"--out {out}: an atlas is a PDF, and its name ends in .pdf")
    if axis is not None and (profiles is not None or maps.comb != "both"):
        stop("--profiles and --comb are of an atlas without --axis, which shows both combs")
    source = opened(font, instance, run.quiet)
    names = chosen(source, subset, run.quiet)
    profiled = None if profiles is None else source.select(text=opt.as_typed(profiles))
    with progress(run.quiet) as observer:
        made = make_atlas(
            source, names, out, options, axis, profiles=profiled, maps=maps, jobs=run.jobs, observer=observer
        )
    if not run.quiet:
        failed = made.failed
        say(f"{made.pages} pages written to {out}" + (f"; {len(failed)} glyphs failed" if failed else ""))
        for line in shortened(failed, 10):
            say(f"failed: {line}")
        if made.outside:
            say(f"not within the tolerance: {listed(made.outside[:10], len(made.outside))}")
    return bool(made.failed or made.outside or names.missing)


app.command(cls=Command)(check)
app.command(cls=Command)(diff)
app.command(cls=BareOptions)(mend)


@app.command(cls=Command)
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
    from ..viewer import serve

    face = opened(font, instance, quiet=False).face_index
    serve(font, face, port=port, browser=browser, announce=lambda address: say(f"{address} (Ctrl-C ends it)"))


@app.command(cls=Command)
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
    with workplace(run.jobs, None, *specs) as executor:
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


@app.command(cls=Command)
@grouped
def warm(run: Annotated[opt.RunOptions, only("jobs", "quiet")]) -> None:
    """Compile everything now, so that no other command has to: for checkouts and containers."""
    from ..runs.warm import warm as compile_all

    compile_all(run.jobs)
    if not run.quiet:
        say("everything is compiled")


def demo_fonts() -> list[tuple[Path, str]]:
    """The fonts and characters shown when none are given: the repository's, and one that comes with matplotlib."""
    fonts = Path(__file__).parents[2] / "fonts_test"
    if not (fonts / "kouzan-gyosho.ttf").exists():
        stop("the demonstration fonts are in the repository's fonts_test/; here, give a font: glyphspline demo FONT")
    import matplotlib

    dejavu = Path(matplotlib.get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf"
    brushes = ("kouzan-gyosho.ttf", "kouzan-kaisho.ttf", "kouzan-gyosho.otf")
    return [(dejavu, "g&"), *((fonts / name, BRUSHED) for name in brushes)]  # a picture comes soon


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
