"""What is not installed with the package itself: the extras of pyproject.toml."""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec
from typing import Any

from .errors import GlyphsplineError

EXTRAS = {
    "overlaps": ("removing overlaps", "pathops"),
    "fonts": ("writing an otf", "cffsubr"),
    "text": ("text on lines", "unicode_segmentation_rs"),
    "cad": ("DXF", "ezdxf"),
    "drawings": ("a drawing with style sheets, clips or strokes", "cssselect2", "tinycss2", "pathops"),
    "parquet": ("Parquet", "pyarrow"),
    "sources": ("reading Glyphs files", "glyphsLib", "ufo2ft"),
    "cluster": ("--jobs tcp://…", "distributed"),
    "remote": ("a URL", "fsspec"),
    "fontspector": ("the plug-in of fontspector", "fontspectorapi"),
    "view": ("the viewer", "starlette", "uvicorn"),
}
"""By extra: what needs it, and the modules that are imported. Nothing here imports what is in ``notebook``."""


def need(extra: str) -> Any:
    """Import the modules of an extra; returns the first.

    Raises:
        GlyphsplineError: it is not installed.
    """
    purpose, *modules = EXTRAS[extra]
    try:
        first, *_ = [import_module(name) for name in modules]
    except ImportError as error:
        raise GlyphsplineError(f"{purpose} needs {error.name}: pip install 'glyphspline[{extra}]'") from error
    return first


def has(extra: str) -> bool:
    """Whether an extra is installed."""
    return all(find_spec(name) is not None for name in EXTRAS[extra][1:])
