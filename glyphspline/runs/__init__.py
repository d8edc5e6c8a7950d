"""Conversion of many glyphs to a folder of files, with workers; interrupted runs are resumed."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ..errors import OutputError as OutputError
    from .atlas_run import make_atlas as make_atlas
    from .atlas_run import make_axis_atlas as make_axis_atlas
    from .font_difference import FontDifference as FontDifference
    from .font_difference import compare_fonts as compare_fonts
    from .font_difference import pairs_of as pairs_of
    from .font_run import convert_font as convert_font
    from .font_search import faces_of as faces_of
    from .font_search import find_fonts as find_fonts
    from .font_search import folders_for as folders_for
    from .galleries import write_gallery as write_gallery
    from .lock import locked as locked
    from .manifest import entries_of as entries_of
    from .masters_run import convert_font_masters as convert_font_masters
    from .spec import Limits as Limits
    from .spec import RunSpec as RunSpec
    from .summary import Summary as Summary

_HOMES = {
    "FontDifference": ".font_difference",
    "Limits": ".spec",
    "OutputError": "..errors",
    "RunSpec": ".spec",
    "Summary": ".summary",
    "compare_fonts": ".font_difference",
    "convert_font": ".font_run",
    "convert_font_masters": ".masters_run",
    "entries_of": ".manifest",
    "faces_of": ".font_search",
    "find_fonts": ".font_search",
    "folders_for": ".font_search",
    "locked": ".lock",
    "make_atlas": ".atlas_run",
    "make_axis_atlas": ".atlas_run",
    "pairs_of": ".font_difference",
    "write_gallery": ".galleries",
}
"""Modules of the names, imported on first use: workers start before the font libraries are imported."""


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOMES[name], __name__), name)
