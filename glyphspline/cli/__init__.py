"""The shell: ``glyphspline convert | atlas | info | report | view | demo``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .commands import app

__all__ = ["app", "main"]


def main() -> None:
    """The command ``glyphspline``. Its options are imported now: workers, which import what they were started by
    once more, have no use for them.
    """
    from . import commands

    commands.main()


def __getattr__(name: str) -> Any:
    if name != "app":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from .commands import app

    return app
