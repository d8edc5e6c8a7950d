"""The options of the command line, and their conversion to :class:`Options`, a selection and a location."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..fitting.options import PRESETS, Continuity, Corners, Effort, Options, Preset
from ..interpolation.method import Fallback
from ..writers.svg.appearance import ViewBox
from ..writers.svg.curvature_map import Whose

if TYPE_CHECKING:
    from ..batch import RunSpec
    from ..readers import Selection, Source

FONT_HELP = "TTF, OTF, TTC, WOFF, WOFF2, UFO or SVG; - is standard input."

FontFile = Annotated[Path, typer.Argument(metavar="FONT", help=FONT_HELP, show_default=False)]
OwnFont = Annotated[Path | None, typer.Argument(metavar="[FONT]", help="A font of your own.", show_default=False)]
Folder = Annotated[Path, typer.Argument(metavar="DIR", help="Folder that a run has written.", show_default=False)]
RunFont = Annotated[Path | None, typer.Option("--font", metavar="FONT", help="The font that the run was made of.")]
Out = Annotated[Path, typer.Option("--out", "-o", help="Folder to write to.", show_default=False)]

Text = Annotated[str | None, typer.Option("--text", help="Glyphs of these characters.")]
TextFile = Annotated[Path | None, typer.Option("--text-file", help="Glyphs of a UTF-8 file's characters.")]
Unicodes = Annotated[str | None, typer.Option("--unicodes", help="Code points: U+4E00-4E10,9F8D or *.")]
Glyphs = Annotated[str | None, typer.Option("--glyphs", help="Glyph names, between commas, or *.")]
Gids = Annotated[str | None, typer.Option("--gids", help="Glyph indices: 5,10-20 or *.")]
Every = Annotated[bool, typer.Option("--all", help="Every glyph of the font.")]

FaceIndex = Annotated[int, typer.Option("--face-index", min=0, help="Which font of a collection.")]
OneFace = Annotated[int | None, typer.Option("--face-index", min=0, help="Only this font of a collection.")]
Location = Annotated[
    str | None,
    typer.Option(
        "--location", metavar="TAG=VALUE,…", help="Place of a variable font: wght=700,wdth=80, or a name: Bold."
    ),
]

Variant = Annotated[int, typer.Option("--variant", help="Of the paper's Table 1, 0 to 4.")]
Margin = Annotated[float, typer.Option("--margin", help="c of Lemma 2, 0 to 0.5.")]
WhereNone = Annotated[Fallback, typer.Option("--fallback", help="Where Lemma 2 has no interval.")]
CornerMode = Annotated[
    Corners,
    typer.Option(
        "--corners", help="smooth: one curve a contour, for brush and traced outlines. sharp: corners stay, for type."
    ),
]
Between = Annotated[
    Continuity,
    typer.Option("--continuity", help="Between corners: c2, one spline; g1, cubics that only meet without a kink."),
]
Choice = Annotated[
    Preset | None,
    typer.Option("--preset", help="paper: smooth, c = 0, as the paper has it. type: sharp, c2, best."),
]
Tolerance = Annotated[
    float | None,
    typer.Option("--tolerance", help="Distance allowed from the source, in font units. Without it, 1/1000 em."),
]
Step = Annotated[float | None, typer.Option("--step", help="Instead: distance between vertices, in font units.")]
Count = Annotated[int | None, typer.Option("--count", help="Instead: this number of vertices a contour.")]
HowHard = Annotated[Effort, typer.Option("--effort", help="best takes longer to find fewer vertices.")]
Region = Annotated[ViewBox, typer.Option("--view-box", help="Region a drawing shows.")]
Comb = Annotated[
    Whose, typer.Option("--comb", help="Whose curvature is shown: the result's, or the source outline's own, exact.")
]
CornerTeeth = Annotated[
    bool, typer.Option("--corner-teeth", help="Teeth of a smooth result's comb also in the turn of a corner.")
]
Height = Annotated[
    str | None, typer.Option("--size", help="Height of a drawing with its unit, as 20mm; its width in proportion.")
]
Fill = Annotated[str, typer.Option("--fill", help="Colour of the ink: a CSS name, #rrggbb, none or currentColor.")]
Stroke = Annotated[str, typer.Option("--stroke", help="Colour of a thin line along the outline, likewise.")]
Precision = Annotated[int, typer.Option("--precision", help="Decimals written, 0 to 9.")]
RemoveOverlaps = Annotated[bool, typer.Option("--remove-overlaps", help="Unite overlapping contours.")]
Measure = Annotated[bool, typer.Option("--measure", help="Deviation, length, curvature with --step and --count too.")]
Formats = Annotated[
    str,
    typer.Option(
        "--format", help="Of svg, png, pdf, curvature, curvature-png, curvature-pdf, gallery, ufo, otf, ttf, parquet."
    ),
]

Jobs = Annotated[int | None, typer.Option("--jobs", "-j", min=0, help="Worker processes. Without it, one a core.")]
Resume = Annotated[bool, typer.Option("--resume/--restart", help="Go on with what is in --out, or do it all anew.")]
Scheduler = Annotated[
    str | None, typer.Option("--scheduler", metavar="TCP://…", help="Work on this dask.distributed cluster instead.")
]
JsonLog = Annotated[bool, typer.Option("--json-log", help="Progress and summary as JSON lines on standard error.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Say nothing but errors.")]
AtlasFile = Annotated[Path, typer.Option("--out", "-o", help="PDF to write.")]
Profiles = Annotated[
    str | None, typer.Option("--profiles", help="Characters that get a page with κ(s); of up to 12 glyphs, all.")
]
Port = Annotated[int, typer.Option("--port", min=0, max=65535, help="Port to listen on; 0 takes any that is free.")]
Browser = Annotated[bool, typer.Option("--browser/--no-browser", help="Open the page in a browser.")]
Json = Annotated[bool, typer.Option("--json", help="As JSON.")]


DRAWN = ("view_box", "size", "fill", "stroke", "comb", "corner_teeth")
"""Options of a run's drawings."""


def options_of(given: Mapping[str, Any]) -> Options:
    """The options of a conversion, from a command's arguments by name."""
    given = {**given, **preset_of(given)}
    return Options(**{field.name: given[field.name] for field in fields(Options) if field.name in given})


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
    drawn = {name: given[name] for name in DRAWN if name in given}
    return RunSpec(options_of(given), formats, **drawn)


def selection_of(source: Source, given: Mapping[str, Any]) -> Selection:
    """The selected glyphs."""
    from ..errors import GlyphsplineError

    text = given["text"]
    if given["text_file"] is not None:
        text = (text or "") + given["text_file"].read_text(encoding="utf-8-sig")
    asked = {name: given[name] for name in ("unicodes", "glyphs", "gids")}
    if not given["every"] and text is None and all(value is None for value in asked.values()):
        raise GlyphsplineError("no glyphs asked for: give --text, --text-file, --unicodes, --glyphs, --gids or --all")
    return source.select(text=text, **asked, all_glyphs=given["every"])


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
