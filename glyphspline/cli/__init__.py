"""The command line: ``glyphspline convert | dataset | check | diff | atlas | info | report | view | demo | warm``."""

from __future__ import annotations

import gc
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .commands import app

__all__ = ["app", "main"]


def main() -> None:
    """Run the command. Imports happen here because worker processes import this module again without needing them."""
    gc.disable()  # imports make no garbage; commands collect it from where they begin
    from . import commands

    commands.main()


def __getattr__(name: str) -> Any:
    if name != "app":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from .commands import app

    return app
