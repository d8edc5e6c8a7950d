"""Small runs that call all compiled functions of one kind of work, for the types of arguments that it has.

What no run here calls is never compiled, so a new compiled function is called by one of these, and a test says so.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from .. import hooks
from ..fitting.options import Options
from ..outlines.outline import Contour, Outline

SQUARE = Contour(np.array([[0, 0], [100, 0], [100, 100], [0, 100]]), np.ones(4, dtype=np.int64))
TIP = Contour(np.array([[100, 50], [160, 20], [160, 80], [200, 80], [160, 80]]), np.ones(5, dtype=np.int64))
"""Touches the square, and itself."""

LEAF = Contour(np.array([[0.0, 0], [60, 0], [100, 40], [100, 100], [40, 100], [0, 60]]), np.array([3, 3]))

DISC = Contour(
    np.array([
        [90.0, 0], [90, 50], [50, 90], [0, 90], [-50, 90], [-90, 50], [-90, 0], [-90, -50], [-50, -90], [0, -90],
        [50, -90], [90, -50],
    ]),
    np.full(4, 3),
)  # fmt: skip
"""Needs a spline of several spans in the sharp mode, whose fit takes longest to compile."""

KNOT = Contour(
    np.array([
        [262.0, 298], [814, 92], [600, 729], [188, 55], [275, 657], [562, 150], [433, 669], [423, 633], [967, 683],
    ]),
    np.full(3, 3),
)  # fmt: skip
"""Crosses itself, and is fitted again more than once."""

FISH = Contour(np.array([[136.0, 118], [10, 181], [44, 51], [36, 66], [35, 69], [162, 90]]), np.array([3, 3]))
"""A single cubic of it fails the certificate, and is fitted again by itself."""

SHAPES = Outline("shapes", contours=(LEAF, SQUARE, DISC, KNOT, TIP, FISH))


def converted(options: Options) -> Any:
    """Convert shapes with and without corners, and draw them, as a worker does."""
    from ..fitting.convert import convert
    from ..writers.svg.document import to_svg

    result = convert(SHAPES, options)
    to_svg(result)
    return result


def interpolations() -> None:
    """The interpolation of a polygon by itself: one code for all variants, curves and dimensions."""
    from ..interpolation.api import interpolate

    interpolate(SQUARE.points)


def drawings() -> None:
    """Curvature maps, and what the gallery shows."""
    from ..fitting.results import as_glyph
    from ..writers.svg.curvature_map import to_curvature_svg
    from ..writers.svg.document import polygon_document

    to_curvature_svg(as_glyph(SHAPES))  # before anything is fitted: another process may be compiling that
    glyph = converted(Options(step=20.0))
    to_curvature_svg(glyph)
    polygon_document(glyph)


def unfitted() -> None:
    """What a run needs that fits nothing: reading outlines, and drawing them as they are."""
    from ..fitting.results import as_glyph
    from ..writers.svg.document import to_svg

    to_svg(as_glyph(SHAPES))


def rest() -> None:
    """What single options or measures need: united contours, joins."""
    from ..curves.integrals import area
    from ..outlines.joins import joins
    from ..outlines.overlaps import inked_area

    inked_area([DISC, LEAF])
    area(LEAF.cubics())
    joins(LEAF)


OWN: dict[str, Callable[[], Any]] = {
    "sharp": lambda: converted(Options(tolerance=0.3)),  # pieces fail the certificate
    "interpolation": interpolations,
    "rest": rest,
    "drawings": drawings,
    "smooth": lambda: converted(Options(corners="smooth")),
    "smooth_best": lambda: converted(Options(corners="smooth", effort="best")),
    "sharp_best": lambda: converted(Options(effort="best")),
    "fixed": lambda: converted(Options(step=20.0)),
    "unfitted": unfitted,
}
"""The kinds of work of the pipeline. Those that take long come first, and neighbours share little: two processes that
begin together seldom compile the same function."""


def work() -> dict[str, Callable[[], Any]]:
    """All kinds of work: those of plug-ins come after the first two, of which most are part."""
    first, *others = OWN.items()
    return dict([first, *((name, hooks.find("work", name)) for name in hooks.names("work")), *others])
