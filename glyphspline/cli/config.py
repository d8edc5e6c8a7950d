"""Options from files: TOML given with ``--config``, and ``[tool.glyphspline]`` of a ``pyproject.toml``."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from ..errors import GlyphsplineError

PROJECT = "pyproject.toml"

NOT_IN_FILES = ("config", "help")


def settings(path: Path | None, parameters: Iterable[Any]) -> dict[str, Any]:
    """Values for a command's parameters: those of the working folder's project, and over them those of ``path``.

    Args:
        path: a file of settings; a ``pyproject.toml`` has them in ``[tool.glyphspline]``.
        parameters: of the command; a key is the long name of an option, without its hyphens.

    Raises:
        GlyphsplineError: a file cannot be read, has a key that is no option, or a value that no option can have.
    """
    names = {
        option.removeprefix("--"): parameter.name
        for parameter in parameters
        for option in parameter.opts
        if option.startswith("--") and parameter.name not in NOT_IN_FILES
    }
    found: dict[str, Any] = {}
    for file in (Path(PROJECT), path):
        if file is None or (file is not path and not file.is_file()):
            continue
        for key, value in _read(file).items():
            if key.replace("_", "-") not in names:
                raise GlyphsplineError(f"no option {key!r}: there are {', '.join(sorted(names))}", font=str(file))
            found[names[key.replace("_", "-")]] = _value(key, value, file)
    return found


def _read(file: Path) -> Mapping[str, Any]:
    try:
        table = tomllib.loads(file.read_text(encoding="utf-8-sig"))
    except OSError as error:
        raise GlyphsplineError(f"cannot be read: {error.strerror or error}", font=str(file)) from error
    except ValueError as error:
        raise GlyphsplineError(f"is not TOML: {error}", font=str(file)) from error
    if file.name == PROJECT:
        table = table.get("tool", {}).get("glyphspline", {})
        if not isinstance(table, dict):
            raise GlyphsplineError("tool.glyphspline is no table", font=str(file))
    return table


def _value(key: str, value: Any, file: Path) -> Any:
    """A value as the command line has it: lists are joined by commas, and so are the axes of a location."""
    if isinstance(value, list):
        return ",".join(map(str, value))
    if isinstance(value, dict) and key == "location":
        return ",".join(f"{tag}={place}" for tag, place in value.items())
    if not isinstance(value, str | int | float):
        raise GlyphsplineError(f"{key} cannot be {value!r}", font=str(file))
    return value
