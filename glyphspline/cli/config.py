"""Options from files: TOML given with ``--config``, and ``[tool.glyphspline]`` of a ``pyproject.toml``.

A command may have a table of its own therein, which no other command reads: those of ``check`` are in ``check``, its
thresholds beside them by their names.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

from .. import hooks
from ..errors import GlyphsplineError
from ..files import reading

PROJECT = "pyproject.toml"

NOT_IN_FILES = ("config", "help")


def settings(
    path: Path | None, options: Iterable[tuple[Iterable[str], str]], command: str, own: tuple[str, type] | None = None
) -> dict[str, Any]:
    """Values for a command's parameters: those of the working folder's project, and over them those of ``path``.

    Args:
        path: a file of settings; a ``pyproject.toml`` has them in ``[tool.glyphspline]``.
        options: flags of each option, whose long names without hyphens are the keys in files, and its parameter.
        command: its name. own: see :class:`.groups.Command`.

    Raises:
        GlyphsplineError: a file cannot be read, has a key that is no option, or a value that no option can have.
    """
    long = [(flag, name) for flags, name in options for flag in flags if flag.startswith("--")]
    whole, kind = own or ("", None)
    names = {flag.removeprefix("--"): name for flag, name in long if name not in (*NOT_IN_FILES, whole)}
    found: dict[str, Any] = {}
    parts: dict[str, Any] = {}
    known = {each.name for each in fields(kind)} - set(names.values()) if kind else set()
    for file in (Path(PROJECT), path):
        if file is None or (file is not path and not file.is_file()):
            continue
        table = _read(file)
        if kind:
            if file is path and command not in table:
                raise GlyphsplineError(f"has no table of settings for {command!r}", font=str(file))
            table = _table(table.get(command, {}), command, file)
        for key, value in table.items():
            part, flag = key.replace("-", "_"), key.replace("_", "-")
            if part in known:
                parts[part] = value
            elif flag in names:
                found[names[flag]] = _value(key, value, file)
            elif not isinstance(value, dict) or not _is_command(key):
                raise GlyphsplineError(
                    f"no option {key!r}: there are {', '.join(sorted([*names, *known]))}", font=str(file)
                )
        try:
            _ = kind and kind(**parts)
        except GlyphsplineError as error:
            raise error.locate(font=str(file)) from None
    if parts:
        found[whole] = ",".join([f"{name}={value!r}" for name, value in parts.items()])
    return found


def _is_command(name: str) -> bool:
    """Whether a table of that name is another command's; of a plug-in that is not there nobody knows."""
    return name in hooks.names("commands") or bool(hooks.away())


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
