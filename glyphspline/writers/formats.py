"""Formats of a drawing: a glyph or a text as a file, by name. Plug-ins add theirs.

Formats are found by name in one table, ``OURS``; only for a name that is not in it plug-ins are asked.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any

from .. import hooks
from ..errors import GlyphsplineError, OptionError, require
from ..extras import EXTRAS
from .settings import Settings

if TYPE_CHECKING:
    from ..fitting.results import GlyphResult

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
    """The format of that name: the pipeline's, or a plug-in's.

    Raises:
        OptionError: there is none; the message lists all there are.
        GlyphsplineError: the plug-in cannot be loaded, or has no format of that name there.
    """
    if name in OURS:
        return OURS[name]
    found = hooks.find("formats", name)
    if found is None:
        raise OptionError(f"no format {name}: there are {', '.join(format_names())}{hooks.away_words()}")
    if not isinstance(found, Format) or found.name != name:
        raise GlyphsplineError(f"the plug-in for format {name!r} has {found!r} in its place")
    return found


def formats() -> tuple[Format, ...]:
    """All formats with one file a glyph: the pipeline's, then those of plug-ins by name.

    Raises:
        GlyphsplineError: a plug-in cannot be loaded.
    """
    return tuple(format_named(name) for name in format_names())


def format_names() -> tuple[str, ...]:
    """The names of all formats; none is imported."""
    return (*OURS, *(name for name in hooks.names("formats") if name not in OURS))


def is_format(name: str) -> bool:
    """Whether there is a format of that name; none is imported."""
    return name in OURS or name in hooks.names("formats")


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
)}  # fmt: skip
"""The pipeline's formats by name, in the order in which a run writes and lists them."""
