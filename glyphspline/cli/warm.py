"""The command ``warm``: everything compiled."""

from __future__ import annotations

from typing import Annotated

from . import arguments as opt
from .groups import grouped, only
from .messages import say


@grouped
def warm(run: Annotated[opt.RunOptions, only("jobs", "quiet")]) -> None:
    """Compile everything now, so that no other command has to: for checkouts and containers."""
    from ..runs.warm import warm as compile_all

    compile_all(run.processes)
    if not run.quiet:
        say("everything is compiled")
