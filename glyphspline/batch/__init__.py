"""Many glyphs of a font into a folder of files, with workers, and so that an interrupted run goes on."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ..errors import OutputError
    from .atlas_run import make_atlas
    from .font_run import convert_font
    from .font_search import find_fonts, folders_for
    from .galleries import write_gallery
    from .manifest import entries_of
    from .spec import Limits, RunSpec
    from .summary import Summary

_HOMES = {
    "Limits": ".spec",
    "OutputError": "..errors",
    "RunSpec": ".spec",
    "Summary": ".summary",
    "convert_font": ".font_run",
    "entries_of": ".manifest",
    "find_fonts": ".font_search",
    "folders_for": ".font_search",
    "make_atlas": ".atlas_run",
    "write_gallery": ".galleries",
}
"""Where names are, imported when they are asked for: workers can start before the font libraries are there."""


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOMES[name], __name__), name)


__all__ = [
    "Limits",
    "OutputError",
    "RunSpec",
    "Summary",
    "convert_font",
    "entries_of",
    "find_fonts",
    "folders_for",
    "make_atlas",
    "write_gallery",
]
