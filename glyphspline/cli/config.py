"""Options from files: TOML given with ``--config``, and ``[tool.glyphspline]`` of a ``pyproject.toml``.

Those of ``check`` are in the table ``check`` therein, its thresholds beside them by their names.
"""

from __future__ import annotations

import tomllib
from collections.abc import Collection, Iterable, Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

from ..checks.kinds import Thresholds
from ..errors import GlyphsplineError

PROJECT = "pyproject.toml"

NOT_IN_FILES = ("config", "help", "thresholds")

TABLES = ("check",)
"""Commands with a table of their own, which no other command reads."""


def settings(path: Path | None, parameters: Iterable[Any], command: str | None = None) -> dict[str, Any]:
    """Values for a command's parameters: those of the working folder's project, and over them those of ``path``.

    Args:
        path: a file of settings; a ``pyproject.toml`` has them in ``[tool.glyphspline]``.
        parameters: of the command; a key is the long name of an option, without its hyphens.
        command: its name.

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
    limits: dict[str, float] = {}
    own = [field.name for field in fields(Thresholds) if field.name not in names.values()] if command in TABLES else []
    for file in (Path(PROJECT), path):
        if file is None or (file is not path and not file.is_file()):
            continue
        table = _read(file)
        if command in TABLES:
            if file is path and command not in table:
                raise GlyphsplineError(f"has no table of settings for {command!r}", font=str(file))
            table = _table(table.get(str(command), {}), str(command), file)
        else:
            table = {key: value for key, value in table.items() if key not in TABLES}
        limits |= _limits(table, own, file)
        for key, value in table.items():
            if key.replace("-", "_") in own:
                continue
            if key.replace("_", "-") not in names:
                raise GlyphsplineError(
                    f"no option {key!r}: there are {', '.join(sorted([*names, *own]))}", font=str(file)
                )
            found[names[key.replace("_", "-")]] = _value(key, value, file)
    if limits:
        found["thresholds"] = ",".join([f"{name}={value!r}" for name, value in limits.items()])
    return found


def _limits(table: Mapping[str, Any], names: Collection[str], file: Path) -> dict[str, float]:
    """The thresholds of a table."""
    found = {key.replace("-", "_"): value for key, value in table.items() if key.replace("-", "_") in names}
    try:
        Thresholds(**found)
    except GlyphsplineError as error:
        raise GlyphsplineError(error.message, font=str(file)) from None
    return found


def _read(file: Path) -> Mapping[str, Any]:
    try:
        table = tomllib.loads(file.read_text(encoding="utf-8-sig"))
    except OSError as error:
        raise GlyphsplineError(f"cannot be read: {error.strerror or error}", font=str(file)) from error
    except ValueError as error:
        raise GlyphsplineError(f"is not TOML: {error}", font=str(file)) from error
    if file.name == PROJECT:
        return _table(_table(table.get("tool", {}), "tool", file).get("glyphspline", {}), "tool.glyphspline", file)
    return table


def _table(value: Any, name: str, file: Path) -> Mapping[str, Any]:
    if not isinstance(value, dict):
        raise GlyphsplineError(f"{name} is no table", font=str(file))
    return value


def _value(key: str, value: Any, file: Path) -> Any:
    """A value as the command line has it: lists are joined by commas, and so are the axes of a location."""
    if isinstance(value, list):
        return ",".join(map(str, value))
    if isinstance(value, dict) and key == "location":
        return ",".join(f"{tag}={place}" for tag, place in value.items())
    if not isinstance(value, str | int | float):
        raise GlyphsplineError(f"{key} cannot be {value!r}", font=str(file))
    return value
