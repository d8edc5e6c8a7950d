"""Formats of a drawing: a glyph or a text as a file, by name. Plug-ins add theirs through an entry point.

Formats are found by name in one table, ``OURS``; only a name that is not in it is looked for among the entry points
of installed packages, as that takes time.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

from ..errors import GlyphsplineError, OptionError, require
from ..extras import EXTRAS
from .settings import Settings

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

    from ..fitting.results import GlyphResult

GROUP = "glyphspline.formats"
"""The entry point group: the value of an entry point is a :class:`Format` of the same name."""

_NAME = re.compile(r"[a-z][a-z0-9]*(-[a-z0-9]+)*")
_SUFFIX = re.compile(r"(\.[A-Za-z0-9]+)+")


@dataclass(frozen=True)
class Format:
    """A format with one file a glyph, or a text.

    Attributes:
        name: as in ``--format``; also the folder's: lower-case letters, digits, hyphens.
        suffix: of its files, with the dot.
        write: the file of a result, as bytes or text in UTF-8; the same bytes at every call.
        extra: the extra of pyproject.toml that it needs.
        fitted: False if it shows the outline as the font has it. In a run of such formats alone nothing is fitted:
            curves of results are the source's contours, without polygons, interpolations and measures.

    Raises:
        OptionError: a name or suffix of other characters, or an unknown extra.
    """

    name: str
    suffix: str
    write: Callable[[GlyphResult, Settings], str | bytes]
    extra: str | None = None
    fitted: bool = True

    def __post_init__(self) -> None:
        name, suffix = self.name, self.suffix
        good = isinstance(name, str) and _NAME.fullmatch(name) is not None
        require(good, "the name of a format has lower-case letters, digits and hyphens", name)
        good = isinstance(suffix, str) and _SUFFIX.fullmatch(suffix) is not None
        require(good, "the suffix of a format is like '.svg'", suffix)
        require(callable(self.write), "a format writes with a function", self.write)
        require(self.extra is None or self.extra in EXTRAS, f"extra is one of {', '.join(EXTRAS)}", self.extra)


def format_named(name: str) -> Format:
    """The format of that name: ours, or a plug-in's.

    Raises:
        OptionError: there is none; the message lists all there are.
        GlyphsplineError: the plug-in cannot be loaded, or is no format of that name.
    """
    found = OURS.get(name) or _loaded(name)
    if found is None:
        raise OptionError(f"no format {name}: there are {', '.join(format_names())}")
    return found


def formats() -> tuple[Format, ...]:
    """All formats with one file a glyph: ours, then those of plug-ins by name.

    Raises:
        GlyphsplineError: a plug-in cannot be loaded.
    """
    return tuple(format_named(name) for name in format_names())


def format_names() -> tuple[str, ...]:
    """The names of all formats, without loading plug-ins."""
    return (*OURS, *sorted(_plug_ins()))


def is_format(name: str) -> bool:
    """Whether there is a format of that name; a plug-in is not loaded."""
    return name in OURS or name in _plug_ins()


@cache
def _plug_ins() -> dict[str, EntryPoint]:
    """Entry points of plug-ins by name, of several with one name the first; names of ours are left out."""
    from importlib.metadata import entry_points  # here and not above: few runs name a plug-in

    found: dict[str, EntryPoint] = {}
    for entry in entry_points(group=GROUP):
        if entry.name not in OURS and _NAME.fullmatch(entry.name):
            found.setdefault(entry.name, entry)
    return found


@cache
def _loaded(name: str) -> Format | None:
    entry = _plug_ins().get(name)
    if entry is None:
        return None
    package = f" of {entry.dist.name}" if entry.dist else ""
    try:
        found = entry.load()
    except Exception as error:  # a plug-in may raise anything
        said = f"{type(error).__name__}: {error}"
        raise GlyphsplineError(f"the plug-in for format {name!r}{package} cannot be loaded: {said}") from error
    if not isinstance(found, Format) or found.name != name:
        raise GlyphsplineError(
            f"the plug-in for format {name!r}{package} is no such format: {entry.value} is {found!r}"
        )
    return found


def _by_name(all_formats: Iterable[Format]) -> dict[str, Format]:
    return {each.name: each for each in all_formats}


# The functions import their modules themselves: a run imports only those that it needs.


def _source(result: GlyphResult, settings: Settings) -> bytes:
    from .svg.document import svg_document
    from .svg.polygon_drawing import source_data

    return svg_document(result, source_data([result])[0], settings.look)


def _svg(result: GlyphResult, settings: Settings) -> bytes:
    from .svg.document import svg_document
    from .svg.path_data import curves_data

    return svg_document(result, curves_data(result.arrays.curves, result.options.precision)[0], settings.look)


def _curvature(result: GlyphResult, settings: Settings) -> str:
    from .svg.curvature_map import to_curvature_svg

    return to_curvature_svg(result)


def _png(result: GlyphResult, settings: Settings) -> bytes:
    from .figures.drawing import drawing_image

    return drawing_image(result, "png", settings.look)


def _pdf(result: GlyphResult, settings: Settings) -> bytes:
    from .figures.drawing import drawing_image

    return drawing_image(result, "pdf", settings.look)


def _curvature_png(result: GlyphResult, settings: Settings) -> bytes:
    from .figures.raster import map_image

    return map_image(result, "png")


def _curvature_pdf(result: GlyphResult, settings: Settings) -> bytes:
    from .figures.raster import map_image

    return map_image(result, "pdf")


def _json(result: GlyphResult, settings: Settings) -> str:
    from .json_file import json_text

    return json_text(result, settings)


def _polyline(result: GlyphResult, settings: Settings) -> str:
    from .polyline_files import polyline_json

    return polyline_json(result, settings)


def _polyline_csv(result: GlyphResult, settings: Settings) -> str:
    from .polyline_files import polyline_csv

    return polyline_csv(result, settings)


def _polyline_scad(result: GlyphResult, settings: Settings) -> str:
    from .polyline_files import polyline_scad

    return polyline_scad(result, settings)


def _dxf(result: GlyphResult, settings: Settings) -> str:
    from .dxf import write

    return write(result, settings)


OURS = _by_name([
    Format("source", ".svg", _source, fitted=False),
    Format("svg", ".svg", _svg),
    Format("curvature", ".svg", _curvature),
    Format("png", ".png", _png),
    Format("pdf", ".pdf", _pdf),
    Format("curvature-png", ".png", _curvature_png),
    Format("curvature-pdf", ".pdf", _curvature_pdf),
    Format("json", ".json", _json),
    Format("polyline", ".json", _polyline),
    Format("polyline-csv", ".csv", _polyline_csv),
    Format("polyline-scad", ".scad", _polyline_scad),
    Format("dxf", ".dxf", _dxf, extra="cad"),
])  # fmt: skip
"""Our formats by name, in the order in which a run writes and lists them."""
