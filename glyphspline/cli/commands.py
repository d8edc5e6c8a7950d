"""The commands of ``glyphspline``; each imports its heavy modules itself."""

from __future__ import annotations

import gc
import json
import os
import sys
from pathlib import Path
from typing import Any

import typer

from ..fitting.options import Options
from ..writers.settings import Settings
from ..writers.svg.appearance import Appearance
from . import arguments as opt
from . import interruption
from .dataset_command import dataset
from .messages import errors, listen, printable, say, stop
from .progress import progress
from .running import check_masters, convert_fonts, convert_masters, run, workplace

PATIENCE = 60.0
"""Time limit in seconds of ``info --deep`` for some hundred glyphs."""

MEMORY = 16 << 30
"""Limit of a process's address space in bytes. Compiled code and thread stacks take a few GB of it."""

app = typer.Typer(
    help="Font glyph outlines as closed C2 B-splines: SVG drawings and curvature maps.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


@app.callback()
def common(version: opt.Version = False) -> None:
    """Font glyph outlines as closed C2 B-splines: SVG drawings and curvature maps."""
    gc.enable()
    listen()


@app.command()
def convert(
    fonts: opt.FontFiles,
    out: opt.Out,
    text: opt.Text = None,
    text_file: opt.TextFile = None,
    unicodes: opt.Unicodes = None,
    glyphs: opt.Glyphs = None,
    gids: opt.Gids = None,
    every: opt.Every = False,
    face_index: opt.OneFace = None,
    location: opt.Location = None,
    variant: opt.Variant = Options.variant,
    margin: opt.Margin = Options.margin,
    fallback: opt.WhereNone = Options.fallback,
    preset: opt.Choice = None,
    corners: opt.CornerMode = Options.corners,
    corner_angle: opt.CornerAngle = Options.corner_angle,
    continuity: opt.Between = Options.continuity,
    tolerance: opt.Tolerance = Options.tolerance,
    step: opt.Step = Options.step,
    count: opt.Count = Options.count,
    effort: opt.HowHard = Options.effort,
    names: opt.FileNames = "glyph",
    each: opt.Each = False,
    view_box: opt.Region = Appearance.view_box,
    size: opt.Height = Appearance.size,
    fill: opt.Fill = Appearance.fill,
    stroke: opt.Stroke = Appearance.stroke,
    comb: opt.Comb = "result",
    corner_teeth: opt.CornerTeeth = False,
    precision: opt.Precision = Options.precision,
    remove_overlaps: opt.RemoveOverlaps = Options.remove_overlaps,
    measure: opt.Measure = Options.measure,
    formats: opt.Formats = "svg,curvature,gallery",
    flatness: opt.Flatness = Settings.flatness,
    dxf: opt.Dxf = Settings.dxf,
    masters: opt.OfMasters = False,
    others: opt.MoreFonts = None,
    axis: opt.NewAxis = None,
    jobs: opt.Jobs = None,
    scheduler: opt.Scheduler = None,
    resume: opt.Resume = True,
    config: opt.Config = None,
    quiet: opt.Quiet = False,
    as_json: opt.JsonSummary = False,
    json_log: opt.JsonLog = False,
) -> None:
    """Convert glyphs of fonts to SVG drawings and curvature maps, with a manifest and an index.

    One font goes to the folder itself, several to a folder each in it, each face of a collection to one in that.

    Of several fonts, or a folder, glob or list of them, every glyph is converted unless some are asked for.
    """
    given = dict(locals())
    with errors(quiet, json_log):
        listen(quiet)
        in_masters = given["masters"] = masters or others is not None or axis is not None
        if in_masters:
            check_masters(given)
        spec = opt.spec_of(given)
        with workplace(jobs, scheduler, spec) as executor:  # first: workers get ready while fonts are found and opened
            from ..batch import find_fonts

            found = find_fonts(fonts)
            if not found:
                stop("no fonts found")
            if in_masters:
                raise typer.Exit(1 if convert_masters(found, spec, executor, given) else 0)
            alone = not each and found == [Path(fonts[0])] and len(fonts) == 1
            runs = convert_fonts(found, spec, executor, given, alone)
        from . import closing

        if not (quiet or json_log or alone):
            say(f"written to {out}")
            say(closing.table(runs))
        if as_json:
            typer.echo(json.dumps(closing.totals(runs), indent=1, ensure_ascii=False))
    raise typer.Exit(1 if any(run.failed for run in runs) else 0)


app.command()(dataset)


@app.command()
def text(
    font: opt.FontFile,
    out: opt.Drawings,
    words: opt.Words = None,
    text_file: opt.WordsFile = None,
    fallbacks: opt.Fallbacks = None,
    features: opt.Features = "",
    script: opt.Script = None,
    language: opt.Language = None,
    direction: opt.Flow = None,
    width: opt.LineWidth = None,
    align: opt.Alignment = "start",
    line_height: opt.LineHeight = None,
    path: opt.OnPath = None,
    bend: opt.Bend = False,
    offset: opt.Offset = None,
    side: opt.WhichSide = "left",
    face_index: opt.FaceIndex = 0,
    location: opt.Location = None,
    variant: opt.Variant = Options.variant,
    margin: opt.Margin = Options.margin,
    fallback: opt.WhereNone = Options.fallback,
    preset: opt.Choice = None,
    corners: opt.CornerMode = Options.corners,
    corner_angle: opt.CornerAngle = Options.corner_angle,
    continuity: opt.Between = Options.continuity,
    tolerance: opt.Tolerance = Options.tolerance,
    step: opt.Step = Options.step,
    count: opt.Count = Options.count,
    effort: opt.HowHard = Options.effort,
    remove_overlaps: opt.RemoveOverlaps = Options.remove_overlaps,
    format_name: opt.FormatName = None,
    each_glyph: opt.EachGlyph = False,
    flatness: opt.Flatness = None,
    dxf: opt.Dxf = "spline",
    precision: opt.Precision = Options.precision,
    view_box: opt.Region = Appearance.view_box,
    size: opt.TypeSize = None,
    fill: opt.Fill = Appearance.fill,
    stroke: opt.Stroke = Appearance.stroke,
    config: opt.Config = None,
    quiet: opt.Quiet = False,
) -> None:
    """Set a text: shaped by HarfBuzz, on one line, on several or along a path, as SVG, DXF and other drawings.

    Each glyph is fitted once, however often it stands there. The exit status is 1 if the fonts lack characters of the
    text, or glyphs cannot be read.
    """
    given = dict(locals())
    with errors(quiet):
        listen(quiet)
        from .text_command import set_text

        status = set_text(given)
    raise typer.Exit(status)


@app.command()
def info(
    font: opt.FontFile,
    face_index: opt.OneFace = None,
    location: opt.Location = None,
    deep: opt.Deep = False,
    as_json: opt.Json = False,
) -> None:
    """Show what a font file holds: faces, axes, units per em, numbers of glyphs and characters."""
    with errors():
        from ..readers.facts import file_facts
        from .describe import lines_of

        facts = file_facts(font, face_index, opt.location_of(location))
        if deep:
            look_deep(font, facts)
    typer.echo(json.dumps(facts, indent=1, ensure_ascii=False) if as_json else printable("\n".join(lines_of(facts))))


def look_deep(font: Path, facts: dict[str, Any]) -> None:
    """Add what needs all outlines, with progress on a terminal."""
    from ..batch.deep_facts import add_glyph_facts
    from ..batch.schedule import workers
    from ..readers.open import STDIN, standard_input

    path = standard_input() if str(font) == STDIN else font
    # In processes with a time limit: counting the contours of a hostile font can take years.
    with workers(None, PATIENCE) as executor, progress(quiet=False) as observer:
        add_glyph_facts(path.absolute(), facts, executor, observer)


@app.command()
def report(folder: opt.Folder) -> None:
    """Write the gallery, index.html, of one run, or of a folder that holds several.

    Of a run without --format gallery, the command is shown that adds it.
    """
    with errors():
        from ..batch import write_gallery

        write_gallery(folder)
    typer.echo(folder / "index.html")


@app.command()
def atlas(
    font: opt.FontFile,
    out: opt.AtlasFile = Path("atlas.pdf"),
    text: opt.Text = None,
    text_file: opt.TextFile = None,
    unicodes: opt.Unicodes = None,
    glyphs: opt.Glyphs = None,
    gids: opt.Gids = None,
    every: opt.Every = False,
    axis: opt.AlongAxis = None,
    profiles: opt.Profiles = None,
    face_index: opt.FaceIndex = 0,
    location: opt.Location = None,
    variant: opt.Variant = Options.variant,
    margin: opt.Margin = Options.margin,
    fallback: opt.WhereNone = Options.fallback,
    preset: opt.Choice = None,
    corners: opt.CornerMode = Options.corners,
    corner_angle: opt.CornerAngle = Options.corner_angle,
    continuity: opt.Between = Options.continuity,
    tolerance: opt.Tolerance = Options.tolerance,
    step: opt.Step = Options.step,
    count: opt.Count = Options.count,
    effort: opt.HowHard = Options.effort,
    comb: opt.Comb = "result",
    corner_teeth: opt.CornerTeeth = False,
    quiet: opt.Quiet = False,
) -> None:
    """Draw the curvature of many glyphs as a PDF: combs on one scale, and κ(s) of chosen contours.

    With --axis, each glyph of a variable font has a page: combs of source and result at places of the axis, and the
    largest turn and the bending energy against it. Other axes are at --location, or at their default.
    """
    given = dict(locals())
    with errors(quiet):
        from ..batch import make_atlas, make_axis_atlas
        from ..readers import open_source

        if axis is not None and (profiles is not None or corner_teeth):
            stop("--profiles and --corner-teeth are of an atlas without --axis")
        source = open_source(font, face_index, opt.location_of(location))
        names = opt.selection_of(source, given)
        if not names:
            stop("none of the glyphs asked for is in the font")
        chosen = None if profiles is None else source.select(text=profiles)
        with progress(quiet) as observer:
            options = opt.options_of(given)
            if axis is not None:
                pages, failed = make_axis_atlas(source, names, out, options, axis, observer=observer)
            else:
                pages, failed = make_atlas(
                    source, names, out, options, profiles=chosen, comb=comb, in_corners=corner_teeth, observer=observer
                )
        if not quiet:
            say(f"{pages} pages written to {out}" + (f"; {failed} glyphs failed" if failed else ""))
    raise typer.Exit(1 if failed else 0)


@app.command()
def check(
    fonts: opt.FontFiles,
    kinds: opt.KindNames = None,
    thresholds: opt.Limits = None,
    corner_angle: opt.CheckAngle = None,
    axis: opt.AxisTag = None,
    steps: opt.AxisSteps = None,
    text: opt.Text = None,
    text_file: opt.TextFile = None,
    unicodes: opt.Unicodes = None,
    glyphs: opt.Glyphs = None,
    gids: opt.Gids = None,
    every: opt.Every = False,
    face_index: opt.OneFace = None,
    location: opt.Location = None,
    loglevel: opt.ShownLevel = None,
    error_level: opt.ErrorLevel = None,
    baseline: opt.Known = None,
    write_baseline: opt.NewKnown = None,
    rows: opt.Rows = 20,
    csv: opt.CsvFile = None,
    ghmarkdown: opt.MarkdownFile = None,
    html: opt.HtmlFile = None,
    plot: opt.Plot = None,
    as_json: opt.Json = False,
    jobs: opt.Jobs = None,
    config: opt.Config = None,
    quiet: opt.Quiet = False,
) -> None:
    """Find what may be wrong with outlines as fonts have them: kinks, jumps of curvature, lumps and the like.

    The worst findings come first; kinks are WARN, the rest INFO. All glyphs are checked unless some are asked for,
    those of a variable font along its axes too. Nothing is converted. The exit status is 1 only if --error-level asks
    for it, and 2 if a font cannot be read.
    """
    given = dict(locals())
    with errors(quiet):
        listen(quiet)
        from .check_outputs import run as run_check
        from .checking import reaches

        faces = run_check(given)
    unread = any(face.error is not None for face in faces)
    bad = error_level is not None and any(reaches(face, error_level) for face in faces)
    raise typer.Exit(2 if unread else 1 if bad else 0)


@app.command()
def diff(
    old: opt.OldFont,
    new: opt.NewFont,
    tolerance: opt.Apart = None,
    text: opt.Text = None,
    text_file: opt.TextFile = None,
    unicodes: opt.Unicodes = None,
    glyphs: opt.Glyphs = None,
    gids: opt.Gids = None,
    every: opt.Every = False,
    face_index: opt.FaceIndex = 0,
    location: opt.Location = None,
    rows: opt.Rows = 20,
    html: opt.Page = None,
    as_json: opt.Json = False,
    jobs: opt.Jobs = None,
    quiet: opt.Quiet = False,
) -> None:
    """Compare two fonts glyph by glyph: a certified distance of the outlines, advances, contours and kinks.

    Exit status 1 if anything differs by more than the tolerance: an outline or an advance, contours or glyphs that only
    one of them has, or glyphs that cannot be read. Kinks do not count. All glyphs are compared unless some are asked
    for.
    """
    given = dict(locals())
    with errors(quiet):
        from ..batch import compare_fonts
        from . import comparing_fonts as comparing

        listen(quiet)
        sources = comparing.open_both(old, new, face_index, location)
        pairs = comparing.chosen_pairs(*sources, given)
        with progress(quiet) as observer:
            found = compare_fonts(*sources, pairs, tolerance=tolerance, jobs=jobs, observer=observer)
        if html is not None:
            comparing.write_page(html, *sources, found)
    worst = found.worst_first()
    if as_json:
        typer.echo(json.dumps(found.facts(), indent=1, ensure_ascii=False))
    elif worst and rows:
        typer.echo(comparing.table(worst, rows, found.tolerance))
    if not quiet:
        for line in comparing.sentences(found, 0 if as_json else rows):
            say(line)
    raise typer.Exit(1 if found.is_beyond else 0)


@app.command()
def view(
    font: opt.FontFile,
    face_index: opt.FaceIndex = 0,
    port: opt.Port = 0,
    browser: opt.Browser = True,
) -> None:
    """Look at a font live: a page, for this machine only, on which sliders move and curves follow."""
    with errors():
        from ..extras import need

        need("view")
        from ..viewer import serve

        serve(font, face_index, port=port, browser=browser, announce=lambda address: say(f"{address} (Ctrl-C ends it)"))


@app.command()
def demo(
    font: opt.OwnFont = None,
    text: opt.Text = None,
    out: opt.Out = Path("outputs/demo"),
    jobs: opt.Jobs = None,
    quiet: opt.Quiet = False,
) -> None:
    """Convert a few glyphs and say where to look; without a font, 龍 and 好 of brush faces and a Latin letter."""
    failed = 0
    with errors(quiet):
        from ..batch import RunSpec
        from ..batch.preload import kinds_for
        from ..batch.warm import warm as warm_up
        from ..readers import open_source

        listen(quiet)
        shown, spec = [], RunSpec()
        warm_up(jobs, kinds=kinds_for(spec.options, spec.formats))  # on all cores; a run's workers wait for one process
        with workplace(jobs, None, spec) as executor:
            for path, characters in [(font, "龍好")] if font else demo_fonts():
                source = open_source(path)
                names = source.select(text=text or characters)
                if not names:
                    stop(f"{path} has none of {text or characters}: give --text")
                folder = out / f"{path.stem}-{path.suffix[1:].lower()}"
                failed += run(source, names, folder, spec, executor, restart=True, quiet=quiet).failed
                shown.append(folder)
    if not quiet:
        typer.echo("Open in a browser:")
        for folder in shown:
            typer.echo(f"  {folder / 'index.html'}")
        typer.echo("Drawings are in svg/ beside it, curvature maps in curvature/.")
    raise typer.Exit(1 if failed else 0)


@app.command()
def warm(jobs: opt.Jobs = None, quiet: opt.Quiet = False) -> None:
    """Compile everything now, so that no other command has to: for checkouts and containers."""
    with errors(quiet):
        from ..batch.warm import warm as compile_all

        with progress(quiet, compiling=True) as observer:
            compile_all(jobs, observer)
    if not quiet:
        say("everything is compiled")


def demo_fonts() -> list[tuple[Path, str]]:
    """The fonts and characters shown when none are given: the repository's, and one that comes with matplotlib."""
    fonts = Path(__file__).parents[2] / "fonts_test"
    if not (fonts / "kouzan-gyosho.ttf").exists():
        stop("the demonstration fonts are in the repository's fonts_test/; here, give a font: glyphspline demo FONT")
    import matplotlib

    dejavu = Path(matplotlib.get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf"
    return [
        (fonts / "kouzan-gyosho.ttf", "龍好"),
        (fonts / "kouzan-kaisho.ttf", "龍好"),
        (fonts / "kouzan-gyosho.otf", "龍好"),
        (dejavu, "g&"),
    ]


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
    interruption.watch()
    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(errors="replace")
    try:
        app(prog_name="glyphspline")
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(1)
