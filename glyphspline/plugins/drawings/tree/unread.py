"""What is said of a drawing: what a browser shows of it and is not read here, and what is worth knowing besides."""

from __future__ import annotations

NAMED = 3
"""Lines that are named one by one."""


class Unread:
    """Kinds of things that are not read, each with the lines of the file where it stands; and remarks likewise."""

    def __init__(self) -> None:
        self._parts: dict[str, dict[int, None]] = {}
        self._remarks: dict[str, dict[int, None]] = {}

    def add(self, what: str, line: int = 0) -> None:
        """Name what is not read, at a line; 0 is none."""
        self._parts.setdefault(what, {})[line] = None

    def note(self, what: str, line: int = 0) -> None:
        """Remark on what is read as a browser does."""
        self._remarks.setdefault(what, {})[line] = None

    @property
    def phrases(self) -> tuple[str, ...]:
        """A phrase for each kind that is not read, in the order in which they were met."""
        return tuple(_phrase(what, list(lines)) for what, lines in self._parts.items())

    @property
    def remarks(self) -> tuple[str, ...]:
        """A phrase for each remark, likewise."""
        return tuple(_phrase(what, list(lines)) for what, lines in self._remarks.items())


def _phrase(what: str, at: list[int]) -> str:
    lines = [line for line in at if line]
    if not lines:
        return what
    numbers = ", ".join(map(str, lines[:NAMED])) + (f" and {len(lines) - NAMED} more" if len(lines) > NAMED else "")
    return f"{what} (line{'s' if len(lines) > 1 else ''} {numbers})"
