"""Options from files: TOML given with ``--config``, and ``[tool.glyphspline]`` of a ``pyproject.toml``.

Those of ``check`` are in the table ``check`` therein, its thresholds beside them by their names.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

from ..checks.kinds import Thresholds
from ..errors import GlyphsplineError
from ..files import reading

PROJECT = "pyproject.toml"

NOT_IN_FILES = ("config", "help", "thresholds")

CHECK = "check"
"""The command with a table of its own, which no other command reads."""


def settings(path: Path | None, options: Iterable[tuple[Iterable[str], str]], command: str | None) -> dict[str, Any]:
    """Values for a command's parameters: those of the working folder's project, and over them those of ``path``.

    Args:
        path: a file of settings; a ``pyproject.toml`` has them in ``[tool.glyphspline]``.
        options: flags of each option, whose long names without hyphens are the keys in files, and its parameter.
        command: its name.

    Raises:
        GlyphsplineError: a file cannot be read, has a key that is no option, or a value that no option can have.
    """
    long = [(flag, name) for flags, name in options for flag in flags if flag.startswith("--")]
    names = {flag.removeprefix("--"): name for flag, name in long if name not in NOT_IN_FILES}
    found: dict[str, Any] = {}
    limits: dict[str, float] = {}
    own = {each.name for each in fields(Thresholds)} - set(names.values()) if command == CHECK else set()
    for file in (Path(PROJECT), path):
        if file is None or (file is not path and not file.is_file()):
            continue
        table = _read(file)
        if command == CHECK:
            if file is path and CHECK not in table:
                raise GlyphsplineError(f"has no table of settings for {CHECK!r}", font=str(file))
            table = _table(table.get(CHECK, {}), CHECK, file)
        for key, value in table.items():
            threshold, flag = key.replace("-", "_"), key.replace("_", "-")
            if threshold in own:
                limits[threshold] = value
            elif flag in names:
                found[names[flag]] = _value(key, value, file)
            elif key != CHECK or command == CHECK:
                raise GlyphsplineError(
                    f"no option {key!r}: there are {', '.join(sorted([*names, *own]))}", font=str(file)
                )
        try:
            Thresholds(**limits)
        except GlyphsplineError as error:
            raise error.locate(font=str(file)) from None
    if limits:
        found["thresholds"] = ",".join([f"{name}={value!r}" for name, value in limits.items()])
    return found


def _read(file: Path) -> Mapping[str, Any]:
    with reading(file, GlyphsplineError, "TOML"):
        table = tomllib.loads(file.read_text(encoding="utf-8-sig"))
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
