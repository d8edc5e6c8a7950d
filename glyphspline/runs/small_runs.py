"""Small runs that call all compiled functions of one kind of work, for the types of arguments that it has.

What no run here calls is never compiled, so a new compiled function is called by one of these, and a test says so.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ..fitting.options import Options
from ..outlines.masters import DesignAxis, MasterContour, Masters
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

ROUND = Contour(
    np.array([
        [300.0, 0], [300, 120], [210, 210], [120, 300], [0, 300], [-120, 300], [-210, 210], [-300, 120], [-300, 0],
        [-300, -300], [0, -300], [200, -300], [280, -100], [300, -50],
    ]),
    np.array([2, 2, 2, 2, 2, 2, 1, 1]),
)  # fmt: skip
"""Quadratics, as TrueType has them."""

SHAPES = Outline("shapes", contours=(LEAF, SQUARE, DISC, KNOT, TIP))

AXES = (DesignAxis("wght", "Weight", 0, 0, 1),)
REGIONS = np.array([[[0.0, 1.0, 1.0]]])


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


def quadratics() -> None:
    """What a TTF stores."""
    from ..fitting.sharp.font_points import quadratic_points

    options = Options(corners="sharp", continuity="g2")
    quadratic_points(Outline("round", contours=(ROUND,)).arrays, options, 1.0, 1000.0)


def masters() -> None:
    """Masters as one curve, with arcs that fail the certificate at first and one that ends on a slanted line."""
    from ..curves.nearest import near_places
    from ..fitting.convert_masters import convert_masters
    from ..readers.pens import ContourPen

    bow = np.array([[100, 0], [100, 500], [100, 700], [500, 650], [500, 400], [500, 0]], dtype=np.float64)
    bold = np.array([[100, 0], [220, 500], [250, 625], [500, 650], [500, 300], [500, 0]], dtype=np.float64)
    disc = MasterContour(np.stack([DISC.points * 3, DISC.points[:, ::-1] * [2.0, -5.0]]), DISC.degrees)
    slanted = MasterContour(np.stack([bow, bold]), np.array([1, 3, 1, 1]))
    family = Masters("shapes", axes=AXES, regions=REGIONS, contours=(disc, slanted), advances=np.ones(2))
    result = convert_masters(family, Options(tolerance=0.3))
    result.energy_ratio({"wght": 0.5})
    result.turn({"wght": 0.5})
    ContourPen(masters=2).contour(slanted.points, slanted.degrees)  # as readers draw contours outside bulk passes
    curves, hints, skip = LEAF.cubics(), np.arange(float(len(LEAF))), np.zeros(len(LEAF), dtype=np.bool_)
    near_places(1, curves, hints, curves, skip, True, 0.0, 0.0, hints)  # as moved points are certified


def checks() -> None:
    """Checks of outlines, of one font and along an axis."""
    from ..checks.check import check
    from ..checks.kinds import Thresholds
    from ..checks.on_axes import on_axes

    check(SHAPES)
    check(Outline("twice", contours=(KNOT, KNOT)))
    disc = MasterContour(np.stack([DISC.points, DISC.points * 2]), DISC.degrees)
    family = Masters("disc", axes=AXES, regions=REGIONS, contours=[disc], advances=np.ones(2))
    on_axes([family], {}, ["wght"], 2, Thresholds())


def mending() -> None:
    """A kink mended, of an outline, which is one master."""
    from ..mending.mend import mend

    checks()
    points = np.array([[0.0, 0], [0, 262], [161, 563], [300, 500], [424, 435], [600, 292], [600, 0]])
    mend(Outline("kink", contours=(Contour(points, np.array([3, 3, 1])),)), tolerance=5.0)


def comparisons() -> None:
    """Outlines compared: one that lacks a contour, one with a contour turned round, so that it has other ink."""
    from ..comparing.compare import compare

    compare(SHAPES, Outline("shapes", contours=(LEAF.reversed(), SQUARE, DISC)))
    ring, filled = ((DISC, Contour(0.5 * inner.points, inner.degrees)) for inner in (DISC.reversed(), DISC))
    compare(Outline("ring", contours=ring), Outline("filled", contours=filled))


def unfitted() -> None:
    """What a run needs that fits nothing: reading outlines, and drawing them as they are."""
    from ..fitting.results import as_glyph
    from ..writers.svg.document import to_svg

    to_svg(as_glyph(SHAPES))


def points() -> None:
    """Rows of data sets: canonical outlines, and points at equal arc lengths or at vertices."""
    from ..fitting.results import as_glyph
    from ..outlines.canonical_outlines import canonical_outlines
    from ..outlines.resampling import at_vertices, resampled

    both = (Outline("in order", contours=(SQUARE, DISC)), Outline("other order", contours=(LEAF, DISC)))
    canonical_outlines([SHAPES, *both])
    arrays = as_glyph(SHAPES).arrays
    resampled(arrays.curves, 8, float(np.radians(30.0)))
    at_vertices(arrays.curves, arrays.polygons, float(np.radians(30.0)))


def rest() -> None:
    """What single options or measures need: united contours, joins, unlike masters."""
    from ..matching.cuts import common_cuts
    from ..matching.landmarks import Landmarks
    from ..outlines.joins import joins
    from ..outlines.overlaps import inked_area

    inked_area([DISC, LEAF])
    joins(LEAF)
    common_cuts(Landmarks(LEAF, 1000.0), Landmarks(LEAF, 1000.0))


WORK: dict[str, Callable[[], Any]] = {
    "sharp": lambda: converted(Options(tolerance=0.3)),  # pieces fail the certificate
    "interpolation": interpolations,
    "checks": checks,
    "comparing": comparisons,
    "points": points,
    "rest": rest,
    "drawings": drawings,
    "smooth": lambda: converted(Options(corners="smooth")),
    "masters": masters,
    "smooth_best": lambda: converted(Options(corners="smooth", effort="best")),
    "g2": lambda: converted(Options(corners="sharp", continuity="g2", tolerance=0.3)),
    "quadratics": quadratics,
    "sharp_best": lambda: converted(Options(effort="best")),
    "fixed": lambda: converted(Options(step=20.0)),
    "mending": mending,
    "unfitted": unfitted,
}
"""The kinds of work. Those that take long come first, and neighbours share little: two processes that begin together
seldom compile the same function."""
