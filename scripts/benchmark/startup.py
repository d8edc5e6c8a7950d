"""What a process pays before its first curve. Every figure is the median of fresh processes."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from statistics import median

from .measure import Row, in_words

IMPORT = "from time import perf_counter as c; a = c(); import glyphspline; print(c() - a)"
FIRST = (
    "import numpy, glyphspline; from time import perf_counter as c; p = numpy.random.default_rng(0).random((20, 2)); "
    "a = c(); glyphspline.interpolate(p); print(c() - a)"
)


def _seconds(code: str, cache: str) -> float:
    environment = {**os.environ, "NUMBA_CACHE_DIR": cache}
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environment)
    return float(run.stdout)


def rows() -> list[Row]:
    """Import, first call ever (it compiles), first call of any later process."""
    with tempfile.TemporaryDirectory() as cache:
        cold = _seconds(FIRST, cache)
        warm = median(_seconds(FIRST, cache) for _ in range(5))
        imported = median(_seconds(IMPORT, cache) for _ in range(5))
    return [
        Row("`import glyphspline`", imported, "s", must=0.35, more=False),
        Row("first interpolation of a process", warm, "s", must=0.6, more=False),
        Row("first interpolation ever, which compiles", cold, "s", note=in_words(cold)),
    ]
