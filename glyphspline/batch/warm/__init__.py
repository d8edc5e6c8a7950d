"""Loads compiled code once, in the process from which workers are forked, instead of in each of them.

Importing a module of this package runs what it loads, and compiles it where no cache holds it yet: so that a cold
start takes its time before the workers' time limits count, and is not made twice.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...fitting.options import Options
from ...outlines.outline import Contour

SQUARE = Contour(np.array([[0, 0], [100, 0], [100, 100], [0, 100]]), np.ones(4, dtype=np.int64))
LEAF = Contour(
    np.array([[0.0, 0.0], [60.0, 0.0], [100.0, 40.0], [100.0, 100.0], [40.0, 100.0], [0.0, 60.0]]), np.array([3, 3])
)


def modules_for(options: Options | None, formats: Sequence[str] = ()) -> list[str]:
    """Names of the modules of this package that a run with these options wants loaded; None: nothing is converted."""
    if options is None:
        return []
    wanted = ["stepped"]
    if options.step is None and options.count is None:
        wanted.append(options.corners)
    if "curvature" in formats:
        wanted.append("mapped")
    return [f"{__name__}.{name}" for name in wanted]
