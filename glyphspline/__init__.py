"""Font glyph outlines as closed C2 B-splines, by the geometric interpolation of Xiong, Li and Mao (2012)."""

from __future__ import annotations

import ast
import pathlib
import sys
from importlib import import_module
from typing import Any

from . import hooks
from ._version import __version__ as __version__

_LISTED = ast.parse(pathlib.Path(__file__).with_suffix(".pyi").read_text(encoding="utf-8")).body
_HOMES = {alias.name: f".{one.module}" for one in _LISTED if isinstance(one, ast.ImportFrom) for alias in one.names}
"""The public names and their modules, as ``__init__.pyi`` lists them for type checkers.

They are imported on first use: a command or a worker imports what it needs and nothing else.
"""

__all__ = [*_HOMES]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        if name.startswith("_") or (value := hooks.find("names", name)) is None:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        return value
    try:
        value = getattr(import_module(_HOMES[name], __name__), name)
    except ModuleNotFoundError as error:
        if not hooks.is_away(error):
            raise
        raise AttributeError(f"{__name__}.{name} needs a plug-in that is not there: {error.name}") from error
    if "IPython" in sys.modules and (install := hooks.find("services", "notebook")):
        install()
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return __all__
