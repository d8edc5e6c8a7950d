"""What processes load before they are given work.

The process from which workers are forked imports this module, as it takes names of modules and no arguments; what it is
to load stands in its environment.
"""

from __future__ import annotations

import gc
import os
from collections.abc import Iterable, Sequence
from importlib import import_module

from ..fitting.options import Options
from .spec import needs_fit

ASKED = "GLYPHSPLINE_PRELOAD"
"""Environment variable: what to load, separated by spaces."""

WARM = f"{__package__}.warm"


def kinds_for(options: Options | None, formats: Sequence[str] = (), masters: bool = False) -> list[str]:
    """The kinds of work of :mod:`.warm` in a run with these options; None: nothing is converted."""
    if options is None:
        return []
    if masters:
        return ["masters"]
    if formats and not needs_fit(formats):
        return ["unfitted", *(["rest"] if options.remove_overlaps else [])]
    fit = "g1" if (options.corners, options.continuity) == ("sharp", "g1") else options.corners
    best = [f"{options.corners}_best"] if options.effort == "best" else []
    drawings = ["drawings"] if {"curvature", "gallery", "png", "pdf"} & set(formats) else []
    rest = ["rest"] if options.remove_overlaps else []
    return [*(["fixed"] if options.is_fixed else [fit, *best]), *drawings, *rest]


def code_for(kinds: Iterable[str]) -> list[str]:
    """What to load for kinds of work."""
    return [f"{WARM}:{kind}" for kind in kinds]


def load(items: Iterable[str]) -> None:
    """Import modules, and call what follows a colon: ``prepare`` of the module with it."""
    for item in items:
        name, _, kind = item.partition(":")
        module = import_module(name)
        if kind:
            module.prepare(kind)


if ASKED in os.environ:
    gc.disable()  # there is no garbage yet, and looking for it takes a sixth of the time; workers enable it again
    load(os.environ.pop(ASKED).split())
