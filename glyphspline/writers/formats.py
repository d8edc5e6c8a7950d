"""Formats of a drawing: a glyph or a text as a file, by name. Plug-ins add theirs through an entry point.

Formats are found by name in one table, ``OURS``; only a name that is not in it is looked for among the entry points
of installed packages, as that takes time.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING, Any

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
    if name in OURS:
        return OURS[name]
    if name not in _plug_ins():
        raise OptionError(f"no format {name}: there are {', '.join(format_names())}")
    return _loaded(_plug_ins()[name])


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

    entries = [entry for entry in entry_points(group=GROUP) if entry.name not in OURS and _NAME.fullmatch(entry.name)]
    return {entry.name: entry for entry in reversed(entries)}


@cache
def _loaded(entry: EntryPoint) -> Format:
    plug_in = f"the plug-in for format {entry.name!r}{f' of {entry.dist.name}' if entry.dist else ''}"
    try:
        found = entry.load()
    except Exception as error:  # a plug-in may raise anything
        reason = f"{type(error).__name__}: {error}"
        raise GlyphsplineError(f"{plug_in} cannot be loaded: {reason}") from error
    if not isinstance(found, Format) or found.name != entry.name:
        raise GlyphsplineError(f"{plug_in} is no such format: {entry.value} is {found!r}")
    return found


def _lazy(place: str, *more: Any) -> Callable[[GlyphResult, Settings], str | bytes]:
    """A function that is imported when it is first called: a run imports only what it writes with."""
    module, name = place.split(":")

    def write(result: GlyphResult, settings: Settings, **how: Any) -> str | bytes:
        written: str | bytes = getattr(import_module(f".{module}", __package__), name)(result, settings, *more, **how)
        return written

    return write


OURS = {each.name: each for each in (
    Format("source", ".svg", _lazy("svg.document:write_source"), fitted=False),
    Format("svg", ".svg", _lazy("svg.document:write_svg")),
    Format("curvature", ".svg", _lazy("svg.curvature_map:write_map")),
    Format("png", ".png", _lazy("figures.drawings:write_drawing", "png")),
    Format("pdf", ".pdf", _lazy("figures.drawings:write_drawing", "pdf")),
    Format("curvature-png", ".png", _lazy("figures.drawings:write_map", "png")),
    Format("curvature-pdf", ".pdf", _lazy("figures.drawings:write_map", "pdf")),
    Format("json", ".json", _lazy("json_file:json_text")),
    Format("polyline", ".json", _lazy("polyline_files:polyline_json")),
    Format("polyline-csv", ".csv", _lazy("polyline_files:polyline_csv")),
    Format("dxf", ".dxf", _lazy("dxf:write"), extra="cad"),
)}  # fmt: skip
"""Our formats by name, in the order in which a run writes and lists them."""
