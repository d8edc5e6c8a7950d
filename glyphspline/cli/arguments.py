"""The options of the command line, and their conversion to :class:`Options`, a selection and a location."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from .._version import __version__
from ..checks.kinds import KINDS, Level
from ..fitting.options import PRESETS, Continuity, Corners, Effort, Options, Preset
from ..interpolation.method import Fallback
from ..types import Names
from ..typesetting.setting import Align, Direction, Side
from ..writers.formats import OURS
from ..writers.settings import DxfKind
from ..writers.svg.appearance import ViewBox, Whose

if TYPE_CHECKING:
    from ..batch import RunSpec
    from ..readers import Selection, Source

glyph_option = partial(typer.Option, rich_help_panel="Which glyphs")
closeness_option = partial(typer.Option, rich_help_panel="How close to the source")
corner_option = partial(typer.Option, rich_help_panel="Corners")
file_option = partial(typer.Option, rich_help_panel="What is written")
text_option = partial(typer.Option, rich_help_panel="The text")
look_option = partial(typer.Option, rich_help_panel="How drawings look")
run_option = partial(typer.Option, rich_help_panel="The run")
look_for_option = partial(typer.Option, rich_help_panel="What is looked for")
say_option = partial(typer.Option, rich_help_panel="What is said")
method_option = partial(typer.Option, rich_help_panel="The method, in the paper's terms")

FONT_HELP = "TTF, OTF, TTC, WOFF, WOFF2, UFO, designspace, Glyphs or SVG; - is standard input."
FONTS_HELP = (
    "Fonts (TTF, OTF, TTC, WOFF, WOFF2, UFO, designspace, Glyphs, SVG; - is standard input), folders, globs, URLs, or "
    "@file with one a line."
)


def number(text: Any) -> float:
    """A number, in words that name the value if it is none."""
    try:
        return float(text)
    except (TypeError, ValueError):
        raise typer.BadParameter(f"{text!r} is not a number") from None


def whole(text: Any) -> int:
    """A whole number, in words that name the value if it is none."""
    try:
        if isinstance(text, float | bool):
            raise ValueError
        return int(text)
    except (TypeError, ValueError):
        raise typer.BadParameter(f"{text!r} is not a whole number") from None


def natural(text: Any) -> int:
    """A whole number from 0 on, in words that name the value if it is none."""
    found = whole(text)
    if found < 0:
        raise typer.BadParameter(f"{found} is below 0")
    return found


def place(text: Any) -> Path:
    """A path; one of no characters would be the current folder, which nobody means."""
    if not str(text):
        raise typer.BadParameter("it is empty: give a folder, or . for this one")
    return Path(text)


def place_or_url(text: Any) -> str:
    """A path or a URL, as it is written."""
    place(text)
    return str(text)


def configured(context: typer.Context, path: Path | None) -> Path | None:
    """Take defaults from a file of settings, before the other options are read."""
    from ..errors import GlyphsplineError
    from .config import settings

    if not context.resilient_parsing:
        try:
            context.default_map = settings(path, context.command.params, context.command.name)
        except GlyphsplineError as error:
            typer.echo(f"glyphspline: {error}", err=True)
            raise typer.Exit(2) from None
    return path


def say_version(wanted: bool) -> None:
    """Print the version and exit, if that is wanted."""
    if wanted:
        typer.echo(f"glyphspline {__version__}")
        raise typer.Exit


Version = Annotated[bool, typer.Option("--version", callback=say_version, is_eager=True, help="Say the version.")]

FontFile = Annotated[Path, typer.Argument(metavar="FONT", help=FONT_HELP, show_default=False)]
FontFiles = Annotated[list[str], typer.Argument(metavar="FONT", help=FONTS_HELP, show_default=False)]
OwnFont = Annotated[Path | None, typer.Argument(metavar="[FONT]", help="A font of your own.", show_default=False)]
Folder = Annotated[Path, typer.Argument(metavar="DIR", help="Folder that a run has written.", show_default=False)]

Text = Annotated[str | None, glyph_option("--text", help="Glyphs of these characters.")]
TextFile = Annotated[Path | None, glyph_option("--text-file", help="Glyphs of a UTF-8 file's characters.")]
Unicodes = Annotated[str | None, glyph_option("--unicodes", help="Code points: U+4E00-4E10,9F8D or *.")]
Glyphs = Annotated[str | None, glyph_option("--glyphs", help="Glyph names, between commas, or *.")]
Gids = Annotated[str | None, glyph_option("--gids", help="Glyph indices: 5,10-20 or *.")]
Every = Annotated[bool, glyph_option("--all", help="Every glyph of the font.")]

face_option = partial(glyph_option, "--face-index", parser=natural, metavar="N")
FaceIndex = Annotated[int, face_option(help="Which font of a collection.")]
OneFace = Annotated[int | None, face_option(help="Only this font of a collection.")]
Location = Annotated[
    str | None,
    glyph_option(
        "--location", metavar="TAG=VALUE,…", help="Place of a variable font: wght=700,wdth=80, or a name: Bold."
    ),
]

Tolerance = Annotated[
    float | None,
    closeness_option(
        "--tolerance",
        parser=number,
        metavar="UNITS",
        help="How far a curve may be from its source, in font units. Without it, 1/1000 em.",
    ),
]
HowHard = Annotated[Effort, closeness_option("--effort", help="best takes longer to find fewer points.")]
Step = Annotated[
    float | None,
    closeness_option(
        "--step", parser=number, metavar="UNITS", help="Instead: a point at every so many font units of the outline."
    ),
]
Count = Annotated[
    int | None, closeness_option("--count", parser=whole, metavar="N", help="Instead: this number of points a contour.")
]
Measure = Annotated[
    bool, closeness_option("--measure", help="With --step and --count too: measure distance, length, curvature.")
]

Choice = Annotated[
    Preset | None,
    corner_option(
        "--preset", help="type: sharp corners, few points, for letters. paper: smooth, c = 0, as the paper has it."
    ),
]
CornerMode = Annotated[
    Corners,
    corner_option(
        "--corners", help="smooth: one curve a contour, for brush and traced outlines. sharp: corners stay, for type."
    ),
]
CornerAngle = Annotated[
    float,
    corner_option("--corner-angle", parser=number, metavar="DEGREES", help="How sharp a turn counts as a corner."),
]
Between = Annotated[
    Continuity,
    corner_option(
        "--continuity",
        help="Between corners: c2, one spline, whose curvature has no jumps; g1, cubics that only meet without a kink.",
    ),
]

Out = Annotated[
    Path, file_option("--out", "-o", parser=place, metavar="DIR", help="Folder to write to.", show_default=False)
]
Formats = Annotated[
    str,
    file_option(
        "--format", metavar="NAME,…", help=f"Of {', '.join(OURS)}, gallery, ufo, otf, ttf, parquet, and of plug-ins."
    ),
]
Flatness = Annotated[
    float | None,
    file_option(
        "--flatness",
        parser=number,
        metavar="UNITS",
        help="How far a polyline may be from its curve, in font units. Without it, 1/2000 em.",
    ),
]
Dxf = Annotated[DxfKind, file_option("--dxf", help="Contours in a DXF as splines, exact, or as polylines.")]
OfMasters = Annotated[
    bool,
    file_option(
        "--masters",
        help="All masters of a variable font at once: a variable font (--format otf, ttf) or designspace (ufo) out.",
    ),
]
MoreFonts = Annotated[
    list[Path] | None,
    file_option(
        "--from",
        metavar="FONT",
        help="With --axis, for --masters: another single font, whose glyphs become masters beside FONT's. Repeatable.",
    ),
]
NewAxis = Annotated[
    str | None,
    file_option("--axis", metavar="TAG=A:B", help="The axis of such fonts, as wght=300:700, a value for each in turn."),
]
FileNames = Annotated[
    Names,
    file_option(
        "--names",
        help="What files are called after: the glyph's name, its code point (uni9F8D), its index, its character.",
    ),
]
Each = Annotated[bool, file_option("--each", help="A folder in DIR for each font, as of several, for one font too.")]
Precision = Annotated[int, file_option("--precision", parser=whole, metavar="N", help="Decimals written, 0 to 9.")]
RemoveOverlaps = Annotated[bool, file_option("--remove-overlaps", help="Unite overlapping contours first.")]

Words = Annotated[
    str | None, typer.Argument(metavar="[TEXT]", help="What is set; - is standard input.", show_default=False)
]
WordsFile = Annotated[Path | None, text_option("--text-file", metavar="FILE", help="Instead: a UTF-8 file's text.")]
Fallbacks = Annotated[
    list[Path] | None,
    text_option("--fallback-font", metavar="FONT", help="For characters that FONT lacks. Repeatable."),
]
Features = Annotated[str, text_option("--features", metavar="TAG,…", help="OpenType features: liga,-kern,ss01=2.")]
Script = Annotated[str | None, text_option("--script", metavar="CODE", help="Of all text, by ISO 15924: Arab.")]
Language = Annotated[str | None, text_option("--language", metavar="TAG", help="By BCP 47: de, zh-Hant.")]
Flow = Annotated[
    Direction | None, text_option("--direction", help="Without it as the text's first letter has it; ttb: columns.")
]
LineWidth = Annotated[
    str | None,
    text_option("--width", metavar="LENGTH", help="Break lines at it: font units, 12em, or 80mm if --size is given."),
]
Alignment = Annotated[Align, text_option("--align", help="Of lines, or on the path.")]
LineHeight = Annotated[
    str | None, text_option("--line-height", metavar="LENGTH", help="Distance of baselines. Without it, the font's.")
]
OnPath = Annotated[
    str | None,
    text_option(
        "--path",
        metavar="SVG#ID",
        help="Letters stand along this path of a drawing, whose user unit is a pixel if --size is given, or else a "
        "font unit.",
    ),
]
Bend = Annotated[bool, text_option("--bend", help="Deform letters along the path too, within the tolerance.")]
Offset = Annotated[
    str | None, text_option("--offset", metavar="LENGTH", help="How far along the path the text begins.")
]
WhichSide = Annotated[Side, text_option("--side", help="Of the path; right: the text runs from its end.")]
Drawings = Annotated[
    list[Path],
    file_option(
        "--out", "-o", metavar="FILE", show_default=False,
        help="SVG, PNG, PDF, DXF, JSON, CSV (polylines) or SCAD to write; - is standard output. Repeatable.",
    ),
]  # fmt: skip
FormatName = Annotated[
    str | None,
    file_option("--format", metavar="NAME", help="Of --out, if its suffix does not say it: curvature, source, …"),
]
EachGlyph = Annotated[
    bool, file_option("--each-glyph", help="In SVG each glyph is an element with an id, not all one path.")
]
TypeSize = Annotated[str | None, look_option("--size", metavar="LENGTH", help="How large an em is: 12pt, 20mm.")]

Region = Annotated[ViewBox, look_option("--view-box", help="Region a drawing shows.")]
Height = Annotated[
    str | None, look_option("--size", help="Height of a drawing with its unit, as 20mm; its width in proportion.")
]
Fill = Annotated[str, look_option("--fill", help="Colour of the ink: a CSS name, #rrggbb, none or currentColor.")]
Stroke = Annotated[str, look_option("--stroke", help="Colour of a thin line along the outline, likewise.")]
Comb = Annotated[
    Whose, look_option("--comb", help="Whose curvature is shown: the result's, or the source outline's own, exact.")
]
CornerTeeth = Annotated[
    bool, look_option("--corner-teeth", help="Teeth of a smooth result's comb also in the turn of a corner.")
]

Jobs = Annotated[
    int | None,
    run_option("--jobs", "-j", parser=natural, metavar="N", help="Worker processes. Without it, one a core."),
]
Resume = Annotated[bool, run_option("--resume/--restart", help="Go on with what is in --out, or do it all anew.")]
Scheduler = Annotated[
    str | None, run_option("--scheduler", metavar="TCP://…", help="Work on this dask.distributed cluster instead.")
]
Config = Annotated[
    Path | None,
    run_option(
        "--config",
        metavar="FILE",
        callback=configured,
        is_eager=True,
        help="TOML with options by name: tolerance = 2. So is the table tool.glyphspline of ./pyproject.toml.",
    ),
]
Quiet = Annotated[bool, run_option("--quiet", "-q", help="Say nothing but errors.")]
JsonSummary = Annotated[bool, run_option("--json", help="The summary as JSON on standard output.")]
JsonLog = Annotated[bool, run_option("--json-log", help="Progress and summary as JSON lines on standard error.")]

Variant = Annotated[
    int, method_option("--variant", parser=whole, metavar="0…4", help="How footpoints are sought (Table 1).")
]
Margin = Annotated[
    float,
    method_option(
        "--margin",
        parser=number,
        metavar="C",
        help="How much less than it might a footpoint moves from its knot, 0 to 0.5 (c of Lemma 2).",
    ),
]
WhereNone = Annotated[
    Fallback, method_option("--fallback", help="Where chords are too uneven for a guarantee (Lemma 2 has no interval).")
]


def more_thresholds(context: typer.Context, text: str | None) -> str | None:
    """Thresholds of the command line after those of a file, which they replace one by one."""
    before = (context.default_map or {}).get("thresholds")
    return text if text == before else ",".join(filter(None, [before, text]))


AxisTag = Annotated[
    str | None, look_for_option("--axis", metavar="TAG", help="Of a variable font, only along this axis.")
]
AxisSteps = Annotated[
    int | None, look_for_option("--steps", parser=natural, metavar="N", help="Steps of each axis, besides the masters.")
]
KindNames = Annotated[
    str | None, look_for_option("--kinds", metavar="KIND,…", help=f"Only of {', '.join(kind.name for kind in KINDS)}.")
]
Limits = Annotated[
    str | None,
    look_for_option(
        "--thresholds", metavar="NAME=VALUE,…", callback=more_thresholds,
        help="From which value on each kind counts, as kink=1,short=2: degrees, thousandths of an em, shares.",
    ),
]  # fmt: skip
CheckAngle = Annotated[
    float | None,
    look_for_option(
        "--corner-angle",
        parser=number,
        metavar="DEGREES",
        help="From this turn on a joint is a corner. Without it, 12.",
    ),
]
ShownLevel = Annotated[
    Level | None,
    say_option(
        "--loglevel", "-l", case_sensitive=False,
        help="The lowest level that is shown. Without it WARN in tables, INFO in JSON, CSV and HTML.",
    ),
]  # fmt: skip
ErrorLevel = Annotated[
    Level | None,
    say_option("--error-level", "-e", case_sensitive=False, help="Exit status 1 for findings of this level or above."),
]
Known = Annotated[
    Path | None,
    say_option("--baseline", metavar="FILE", help="Leave out what this file knows, unless it is worse now."),
]
NewKnown = Annotated[
    Path | None, say_option("--write-baseline", parser=place, metavar="FILE", help="Write all findings as known ones.")
]
CsvFile = Annotated[
    Path | None, say_option("--csv", parser=place, metavar="FILE", help="As CSV; - is standard output.")
]
MarkdownFile = Annotated[
    Path | None,
    say_option("--ghmarkdown", parser=place, metavar="FILE", help="As Markdown for GitHub; - is standard output."),
]
HtmlFile = Annotated[
    Path | None, say_option("--html", parser=place, metavar="FILE", help="As a page with a drawing of each place.")
]
Rows = Annotated[int, say_option("--rows", parser=natural, metavar="N", help="Lines of the table.")]
OldFont = Annotated[Path, typer.Argument(metavar="OLD", help=FONT_HELP, show_default=False)]
NewFont = Annotated[
    Path, typer.Argument(metavar="NEW", help="What it is compared with, of any of these kinds.", show_default=False)
]
Apart = Annotated[
    float | None,
    typer.Option(
        "--tolerance",
        parser=number,
        metavar="UNITS",
        help="How far outlines and advances may differ, in units of OLD. Without it, 1/1000 em.",
    ),
]
Page = Annotated[
    Path | None, typer.Option("--html", parser=place, metavar="FILE", help="Draw both over each other, on a page.")
]
Plot = Annotated[
    Path | None,
    say_option("--plot", parser=place, metavar="FILE", help="Draw the largest turn against the axis: SVG, PNG, PDF."),
]
AtlasFile = Annotated[Path, typer.Option("--out", "-o", parser=place, metavar="FILE", help="PDF to write.")]
AlongAxis = Annotated[
    str | None,
    typer.Option(
        "--axis",
        metavar="TAG",
        help="Instead: each glyph along this axis of a variable font, its source and the curve for all masters. "
        "Corners are sharp.",
    ),
]
Profiles = Annotated[
    str | None, typer.Option("--profiles", help="Characters that get a page with κ(s); of up to 12 glyphs, all.")
]
Port = Annotated[int, typer.Option("--port", min=0, max=65535, help="Port to listen on; 0 takes any that is free.")]
Browser = Annotated[bool, typer.Option("--browser/--no-browser", help="Open the page in a browser.")]
Json = Annotated[bool, typer.Option("--json", help="As JSON.")]
Deep = Annotated[
    bool,
    typer.Option("--deep", help="Read every glyph: count contours, find overlaps and what is broken. Takes minutes."),
]


DRAWN = ("view_box", "size", "fill", "stroke", "comb", "corner_teeth")
"""Options of a run's drawings."""


def options_of(given: Mapping[str, Any]) -> Options:
    """The options of a conversion, from a command's arguments by name."""
    from ..errors import OptionError

    given = {**given, **preset_of(given)}
    names = [field.name for field in fields(Options) if field.name in given]
    try:
        return Options(**{name: given[name] for name in names})
    except OptionError as error:
        first, _, rest = error.message.partition(" is ")
        raise OptionError(f"--{first.replace('_', '-')} is {rest}" if first in names else error.message) from None


def preset_of(given: Mapping[str, Any]) -> Mapping[str, Any]:
    """The options that ``--preset`` sets; none of them may be given another value beside it."""
    from ..errors import OptionError

    preset = given.get("preset")
    if preset is None:
        return {}
    for name, value in PRESETS[preset].items():
        if given[name] not in (value, getattr(Options, name)):
            raise OptionError(f"--preset {preset} sets --{name} {value}, not {given[name]}")
    return PRESETS[preset]


def spec_of(given: Mapping[str, Any]) -> RunSpec:
    """The options of a run, from a command's arguments by name."""
    from ..batch import RunSpec

    formats = tuple(filter(None, given["formats"].replace(" ", "").split(",")))
    drawn = {name: given[name] for name in (*DRAWN, "names", "masters", "flatness", "dxf") if name in given}
    return RunSpec(options_of(given), formats, **drawn)


def selection_of(source: Source, given: Mapping[str, Any]) -> Selection:
    """The selected glyphs."""
    from ..errors import GlyphsplineError

    if not is_selected(given):
        raise GlyphsplineError("no glyphs asked for: give --text, --text-file, --unicodes, --glyphs, --gids or --all")
    text = given["text"]
    if given["text_file"] is not None:
        text = (text or "") + given["text_file"].read_text(encoding="utf-8-sig")
    asked = {name: given[name] for name in ("unicodes", "glyphs", "gids")}
    return source.select(text=text, **asked, all_glyphs=given["every"])


def is_selected(given: Mapping[str, Any]) -> bool:
    """Whether any glyphs are asked for."""
    return given["every"] or any(
        given[name] is not None for name in ("text", "text_file", "unicodes", "glyphs", "gids")
    )


def location_of(text: str | None) -> dict[str, float] | str:
    """``wght=700,wdth=80`` as a dictionary; text without ``=`` is the name of an instance and returned as it is."""
    from ..errors import GlyphsplineError

    if text and "=" not in text:
        return text
    found: dict[str, float] = {}
    for item in filter(None, (text or "").replace(" ", "").split(",")):
        tag, _, value = item.partition("=")
        try:
            found[tag] = float(value)
        except ValueError:
            raise GlyphsplineError(f"--location is like wght=700,wdth=80, not {item!r}") from None
    return found
