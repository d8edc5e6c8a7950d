"""The commands of ``glyphspline``; each imports its heavy modules itself."""

from __future__ import annotations

import json
import logging
import os
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, nullcontext, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import typer

from ..fitting.options import Options
from . import arguments as opt
from . import interruption

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from ..batch import RunSpec, Summary
    from ..readers import Source
    from .closing import FontRun

PATIENCE = 60.0
"""Time limit in seconds of ``info --deep`` for some hundred glyphs."""

LOOKED_AT = 64
"""Outlines that are looked at to tell type from brush."""

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
    variant: opt.Variant = 2,
    margin: opt.Margin = 0.02,
    fallback: opt.WhereNone = "peak",
    preset: opt.Choice = None,
    corners: opt.CornerMode = "smooth",
    corner_angle: opt.CornerAngle = Options.corner_angle,
    continuity: opt.Between = "c2",
    tolerance: opt.Tolerance = None,
    step: opt.Step = None,
    count: opt.Count = None,
    effort: opt.HowHard = "fast",
    names: opt.FileNames = "glyph",
    each: opt.Each = False,
    view_box: opt.Region = "em",
    size: opt.Height = None,
    fill: opt.Fill = "currentColor",
    stroke: opt.Stroke = "none",
    comb: opt.Comb = "result",
    corner_teeth: opt.CornerTeeth = False,
    precision: opt.Precision = 2,
    remove_overlaps: opt.RemoveOverlaps = False,
    measure: opt.Measure = False,
    formats: opt.Formats = "svg,curvature,gallery",
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
        spec = opt.spec_of(given)
        from ..batch import find_fonts

        found = find_fonts(fonts)
        if not found:
            stop("no fonts found")
        alone = not each and found == [Path(fonts[0])] and len(fonts) == 1
        with workplace(jobs, scheduler, spec) as executor:  # first: workers get ready while the font is opened
            runs = convert_fonts(found, spec, executor, given, alone)
        from . import closing

        if not (quiet or json_log or alone):
            say(f"written to {out}")
            say(closing.table(runs))
        if as_json:
            typer.echo(json.dumps(closing.totals(runs), indent=1, ensure_ascii=False))
    raise typer.Exit(1 if any(run.failed for run in runs) else 0)


def convert_fonts(
    fonts: Sequence[Path], spec: RunSpec, executor: Executor, given: Mapping[str, Any], alone: bool
) -> list[FontRun]:
    """Convert one font alone into the folder itself, or several, each face into a folder of its own.

    Of several, every glyph is converted unless some are asked for, and a font that cannot be read is passed over.
    """
    from ..batch import OutputError, faces_of, folders_for, locked
    from ..errors import GlyphsplineError
    from .closing import FontRun

    if alone:
        given, folders = {**given, "face_index": given["face_index"] or 0}, [given["out"]]
    else:
        given = {**given, "every": given["every"] or not opt.is_selected(given)}
        folders = [given["out"] / name for name in folders_for(fonts)]
    location = opt.location_of(given["location"])
    runs: list[FontRun] = []
    with nullcontext() if alone else locked(given["out"]):
        for font, folder in zip(fonts, folders, strict=True):
            try:
                for source in faces_of(font, location, given["face_index"]):
                    runs.append(convert_face(source, str(font), folder, spec, executor, given, alone))
            except GlyphsplineError as error:
                if alone or isinstance(error, OutputError):
                    raise
                if given["quiet"] or given["json_log"]:  # or else it is said below the table
                    say(str(error))
                runs.append(FontRun(str(font), folder, error=str(error)))
    return runs


def convert_face(
    source: Source, name: str, out: Path, spec: RunSpec, executor: Executor, given: Mapping[str, Any], alone: bool
) -> FontRun:
    """Convert one face of the font called ``name``; those of a collection go to a folder each unless it is alone."""
    from .closing import FontRun, missing_words

    if source.num_faces > 1 and not alone:
        name, out = f"{name}, face {source.face_index}", out / f"face-{source.face_index}"
    quiet, json_log = given["quiet"], given["json_log"]
    names = opt.selection_of(source, given)
    if names.missing and not quiet:
        say(("" if alone else f"{name}: ") + f"not in the font: {missing_words(names.missing)}")
    if alone and not names:
        stop("none of the glyphs asked for is in the font")
    heading, restart = None if alone else name, not given["resume"]
    summary = run(source, names, out, spec, executor, restart=restart, quiet=quiet, json_log=json_log, name=heading)
    if alone and not (quiet or json_log) and looks_like_type(source, names, spec):
        say("most joints of these glyphs are corners or lines, which --corners sharp (or --preset type) keeps")
    return FontRun(name, out, summary)


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
        from .closing import printable
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
def report(folder: opt.Folder, font: opt.RunFont = None) -> None:
    """Write the gallery, index.html, of one run, or of a folder that holds several.

    Results of a run without --format gallery come from its drawings, source outlines from its font: --font, or the
    file of the same name and bytes in the current folder, in DIR or above it. There are no polygons in such a gallery,
    and without the font no sources.
    """
    with errors():
        from ..batch import write_gallery

        write_gallery(folder, font)
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
    profiles: opt.Profiles = None,
    face_index: opt.FaceIndex = 0,
    location: opt.Location = None,
    variant: opt.Variant = 2,
    margin: opt.Margin = 0.02,
    fallback: opt.WhereNone = "peak",
    preset: opt.Choice = None,
    corners: opt.CornerMode = "smooth",
    corner_angle: opt.CornerAngle = Options.corner_angle,
    continuity: opt.Between = "c2",
    tolerance: opt.Tolerance = None,
    step: opt.Step = None,
    count: opt.Count = None,
    effort: opt.HowHard = "fast",
    comb: opt.Comb = "result",
    corner_teeth: opt.CornerTeeth = False,
    quiet: opt.Quiet = False,
) -> None:
    """Draw the curvature of many glyphs as a PDF: combs on one scale, and κ(s) of chosen contours."""
    given = dict(locals())
    with errors(quiet):
        from ..batch import make_atlas
        from ..readers import open_font

        source = open_font(font, face_index, opt.location_of(location))
        names = opt.selection_of(source, given)
        if not names:
            stop("none of the glyphs asked for is in the font")
        chosen = None if profiles is None else source.select(text=profiles)
        with progress(quiet) as observer:
            each = (lambda done, total: observer(done, total, 0)) if observer else None
            pages, failed = make_atlas(
                source, names, out, opt.options_of(given), profiles=chosen, comb=comb, in_corners=corner_teeth,
                observer=each,
            )  # fmt: skip
        if not quiet:
            say(f"{pages} pages written to {out}" + (f"; {failed} glyphs failed" if failed else ""))
    raise typer.Exit(1 if failed else 0)


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
        from ..readers import open_source

        listen(quiet)
        shown, spec = [], RunSpec()
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
    """Compile everything now, so that no other command has to; done once after each installation."""
    with errors(quiet=True):  # the bar tells
        from ..batch.precompile import precompile

        with counted(quiet) as observer:
            total = precompile(jobs, observer)
    if not quiet:
        say(f"{total} functions are compiled")


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


@contextmanager
def workplace(jobs: int | None, scheduler: str | None, spec: RunSpec) -> Iterator[Executor]:
    """The executor of a run: worker processes (None: one a core, 0: none, in this process), or a cluster."""
    if scheduler is not None:
        from ..batch.cluster import ClusterExecutor

        executor: Executor = ClusterExecutor(scheduler)
    else:
        from ..batch.schedule import workers

        executor = workers(jobs, spec.limits.seconds, spec.options, spec.formats)
    with executor:
        yield executor


def run(
    source: Source,
    names: Sequence[str],
    out: Path,
    spec: RunSpec,
    executor: Executor,
    *,
    restart: bool,
    quiet: bool,
    json_log: bool = False,
    name: str | None = None,
) -> Summary:
    """Convert glyphs with progress on a terminal, then print the summary; ``name`` is that of one font of several."""
    from ..batch import convert_font
    from ..report.data import FOLDER as GALLERY

    with json_lines() if json_log else progress(quiet) as observer:
        summary = convert_font(source, names, out, spec, executor=executor, restart=restart, observer=observer)
    if json_log:
        say(json.dumps({"out": str(out), **summary.facts()}))
    elif not quiet:
        seen = f"open {out / 'index.html'}" if GALLERY in spec.formats else f"written to {out}"
        say(f"{name}: {summary.headline()}" if name else f"{summary.headline()}; {seen}")
        for line in summary.lines():
            say(f"  {line}" if name else line)
    return summary


def looks_like_type(source: Source, names: Sequence[str], spec: RunSpec) -> bool:
    """Whether a run in smooth mode is over glyphs most of whose joints are corners or ends of lines."""
    from ..errors import GlyphsplineError
    from ..outlines.corner_share import share_of_corners

    if spec.options.corners != "smooth" or spec.options.is_fixed:
        return False
    outlines = []
    for name in names[:: max(len(names) // LOOKED_AT, 1)][:LOOKED_AT]:
        with suppress(GlyphsplineError):
            outlines.append(source.outline(name))
    return share_of_corners(outlines) > 0.5


@contextmanager
def json_lines() -> Iterator[Any]:
    """Progress as JSON lines on standard error, one a second at most."""
    last = 0.0

    def observe(done: int, total: int, failed: int) -> None:
        nonlocal last
        now = time.monotonic()
        if now - last >= 1 or done == total:
            last = now
            say(json.dumps({"done": done, "total": total, "failed": failed}))

    yield observe


@contextmanager
def progress(quiet: bool) -> Iterator[Any]:
    """A progress bar on standard error, if that is a terminal."""
    if quiet or not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[rate]:.0f}/s"),
        TimeRemainingColumn(),
        TextColumn("{task.fields[failed]} failed"),
    )
    bar = Progress(*columns, console=Console(stderr=True), transient=True)
    task = bar.add_task("", total=None, rate=0.0, failed=0)

    def observe(done: int, total: int, failed: int) -> None:
        bar.start()  # not before: until then the line belongs to what is compiled
        speed = bar.tasks[0].speed or 0.0
        bar.update(task, completed=done, total=total, failed=failed, rate=speed)

    try:
        yield observe
    finally:
        bar.stop()


@contextmanager
def counted(quiet: bool) -> Iterator[Any]:
    """A bar of functions that are ready, on standard error, if that is a terminal."""
    if quiet or not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("compiling"), BarColumn(), MofNCompleteColumn(), TextColumn("functions"), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("", total=None)
        yield lambda ready, total: bar.update(task, completed=ready, total=total or None)


@contextmanager
def errors(quiet: bool = False, json_log: bool = False) -> Iterator[None]:
    """Print an expected error as one line on standard error and exit with status 2.

    Args:
        quiet, json_log: of the command: how this process and those it starts tell what they compile.
    """
    from ..cache import TELLS, settle
    from ..errors import GlyphsplineError

    os.environ[TELLS] = "" if quiet else "json" if json_log else "line"
    try:
        settle()
        yield
    except (GlyphsplineError, OSError, UnicodeDecodeError) as error:
        stop(str(error))
    except MemoryError:
        stop("not enough memory")
    except KeyboardInterrupt:
        say(interruption.WORDS)
        raise typer.Exit(interruption.STATUS) from None
    finally:
        del os.environ[TELLS]


def say(line: str) -> None:
    """Print a line on standard error. What fonts have in names does not move the cursor."""
    from .closing import printable

    typer.echo(printable(line), err=True)


class Said(logging.Handler):
    """Prints what this package and fontTools log, each sentence once."""

    def __init__(self, level: int) -> None:
        super().__init__(level)
        self._before: set[str] = set()

    def emit(self, record: logging.LogRecord) -> None:
        """Print a record as a line on standard error."""
        line = f"{record.name.partition('.')[0]}: {record.getMessage()}"
        if line not in self._before:
            self._before.add(line)
            say(line)


def listen(quiet: bool = False) -> None:
    """Print warnings of the libraries on standard error, or only their errors."""
    for name in ("glyphspline", "fontTools"):
        log = logging.getLogger(name)
        log.handlers[:] = [handler for handler in log.handlers if not isinstance(handler, Said)]
        log.addHandler(Said(logging.ERROR if quiet else logging.WARNING))


def stop(message: str) -> NoReturn:
    """Exit with a message and status 2: the call or the font is unusable."""
    say(f"glyphspline: {message}")
    raise typer.Exit(2)


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
