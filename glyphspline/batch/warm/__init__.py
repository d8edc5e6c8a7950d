"""Loads compiled code once, in the process from which workers are forked.

Importing a module of this package converts three contours in one mode, which compiles functions that are not cached.
This happens once, before the workers' time limits begin.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...fitting.convert import convert
from ...fitting.options import Options
from ...fitting.results import GlyphResult
from ...outlines.outline import Contour, Outline

SQUARE = Contour(np.array([[0, 0], [100, 0], [100, 100], [0, 100]]), np.ones(4, dtype=np.int64))
LEAF = Contour(
    np.array([[0.0, 0.0], [60.0, 0.0], [100.0, 40.0], [100.0, 100.0], [40.0, 100.0], [0.0, 60.0]]), np.array([3, 3])
)

DISC = Contour(
    np.array(
        [[9.0, 0], [9, 5], [5, 9], [0, 9], [-5, 9], [-9, 5], [-9, 0], [-9, -5], [-5, -9], [0, -9], [5, -9], [9, -5]]
    )
    * 10,
    np.full(4, 3),
)


def modules_for(options: Options | None, formats: Sequence[str] = ()) -> list[str]:
    """Names of the modules of this package that a run with these options needs; None: nothing is converted."""
    if options is None:
        return []
    drawings = ["drawings"] if {"curvature", "gallery"} & set(formats) else []
    return [f"{__name__}.{name}" for name in ("fixed" if options.is_fixed else options.corners, *drawings)]


def converted(options: Options) -> GlyphResult:
    """Convert a leaf with two corners, a square and a disc, after importing all modules of a worker.

    The disc needs a spline of several spans in the sharp mode, whose fit takes longest to compile.
    """
    from ...readers.opentype.bulk import load_compiled
    from ...writers.svg.document import to_svg
    from .. import worker  # noqa: F401

    load_compiled()
    result = convert(Outline("leaf", contours=(LEAF, SQUARE, DISC)), options)
    to_svg(result)
    return result
