"""What processes load before they are given work.

The process from which workers are forked imports this module, as it takes names of modules and no arguments; what it is
to load stands in its environment.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from importlib import import_module

ASKED = "GLYPHSPLINE_PRELOAD"
"""Environment variable: what to load, separated by spaces."""


def load(items: Iterable[str]) -> None:
    """Import modules, and call what follows a colon: ``prepare`` of the module with it."""
    for item in items:
        name, _, kind = item.partition(":")
        module = import_module(name)
        if kind:
            module.prepare(kind)


load(os.environ.pop(ASKED, "").split())
