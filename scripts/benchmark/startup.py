"""What a process pays before its first curve. Every figure is the median of fresh processes."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from os import environ
from statistics import median

from .measure import Row

IMPORT = "from time import perf_counter as c; a = c(); import glyphspline; print(c() - a)"
FIRST = (
    "from time import perf_counter as c; a = c(); import numpy, glyphspline; "
    "glyphspline.interpolate(numpy.random.default_rng(0).random((20, 2))); print(c() - a)"
)


def _seconds(code: str, **place: str) -> float:
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environ | place)
    return float(run.stdout)


def rows() -> list[Row]:
    """Import, and the first call with its imports: as plain Python where there is no code, and compiled."""
    with tempfile.TemporaryDirectory() as nothing:
        imported = median(_seconds(IMPORT) for _ in range(5))
        plain = median(_seconds(FIRST, NUMBA_CACHE_DIR=nothing) for _ in range(5))
        compiled = median(_seconds(FIRST) for _ in range(5))
    return [
        Row("`import glyphspline`", imported, "s", must=0.35, more=False),
        Row("first interpolation and all imports, nothing compiled", plain, "s", must=1.0, aim=0.5, more=False),
        Row("first interpolation and all imports, compiled", compiled, "s", more=False),
    ]
