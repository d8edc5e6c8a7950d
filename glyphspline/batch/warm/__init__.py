"""Loads compiled code once, in the process from which workers are forked.

Importing a module of this package converts a few contours in one mode, which compiles functions that are not cached.
This happens once, before the workers' time limits begin.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...fitting.convert import convert
from ...fitting.options import Options
from ...fitting.results import GlyphResult
from ...outlines.outline import Contour, Outline
from ..spec import needs_fit

SQUARE = Contour(np.array([[0, 0], [100, 0], [100, 100], [0, 100]]), np.ones(4, dtype=np.int64))
TIP = Contour(np.array([[100, 50], [160, 20], [160, 80], [200, 80], [160, 80]]), np.ones(5, dtype=np.int64))
"""Touches the square, and itself."""

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


KNOT = Contour(
    np.array(
        [[262, 298], [814, 92], [600, 729], [188, 55], [275, 657], [562, 150], [433, 669], [423, 633], [967, 683]],
        dtype=np.float64,
    ),
    np.full(3, 3),
)
"""Crosses itself, and is fitted again more than once."""

SHAPES = Outline("shapes", contours=(LEAF, SQUARE, DISC, KNOT, TIP))

EVERYTHING = (
    "interpolation", "drawings", "g1", "sharp", "smooth", "sharp_best", "smooth_best", "fixed", "stacked", "checks",
    "comparing", "unfitted", "points", "rest",
)  # fmt: skip
"""All modules of this package. Together they compile every function there is. The first ones share little, so that
processes that begin at the same time seldom compile the same function."""


def modules_for(options: Options | None, formats: Sequence[str] = (), masters: bool = False) -> list[str]:
    """Names of the modules of this package that a run with these options needs; None: nothing is converted."""
    if options is None:
        return []
    if masters:
        return module_names(["stacked"])
    if formats and not needs_fit(formats):
        return module_names(["unfitted", *(["rest"] if options.remove_overlaps else [])])
    fit = "g1" if (options.corners, options.continuity) == ("sharp", "g1") else options.corners
    best = [f"{options.corners}_best"] if options.effort == "best" else []
    drawings = ["drawings"] if {"curvature", "gallery", "png", "pdf"} & set(formats) else []
    rest = ["rest"] if options.remove_overlaps else []
    return module_names([*(["fixed"] if options.is_fixed else [fit, *best]), *drawings, *rest])


def module_names(names: Sequence[str]) -> list[str]:
    """The full names of modules of this package."""
    return [f"{__name__}.{name}" for name in names]


def converted(options: Options) -> GlyphResult:
    """Convert shapes with and without corners, after importing all modules of a worker.

    The disc needs a spline of several spans in the sharp mode, whose fit takes longest to compile.
    """
    from ...readers.opentype.bulk import load_compiled
    from ...writers.svg.document import to_svg
    from .. import worker  # noqa: F401

    load_compiled()
    result = convert(SHAPES, options)
    to_svg(result)
    return result
