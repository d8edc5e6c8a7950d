"""What every run needs, and sampling by step or count: a square taken through both ways."""

from __future__ import annotations

import numpy as np

from ...fitting.convert import convert
from ...fitting.options import Options
from ...fitting.smooth.insertion import graded_polygons
from ...outlines.outline import Outline
from ...outlines.places import sampled
from ...readers.opentype.bulk_contours import cubics_of
from ...writers.svg.digit_tables import figures
from ...writers.svg.spline_paths import cubics_of_splines, paths
from . import SQUARE


def warm() -> None:
    """Take a square through both ways."""
    result = convert(Outline("square", contours=(SQUARE,)), Options(step=20.0))
    spline = result.contours[0].interpolations[0].spline
    cubics_of(np.array([2.0, 2.0]), np.array([2, 2]))
    sampled(SQUARE.cubics(), np.array([0, 4]), 20.0, 0, 4.0, 0.2, 1000)
    graded_polygons(result.contours[0].polygon, np.array([0, len(result.contours[0].polygon)]), 4.0)
    counts = np.array([len(spline.control_points)])
    cubics, starts = cubics_of_splines(spline.control_points, spline.knots, np.array([0, counts[0]]), counts)
    paths(cubics, starts, np.array([0, 1]), *figures(2))


warm()
