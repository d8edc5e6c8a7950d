"""Small runs that call all compiled functions of this plug-in, for the types of arguments that it has."""

from __future__ import annotations

import numpy as np

from ...fitting.options import Options
from ...outlines.outline import Contour, Outline
from ...runs.small_runs import converted

ROUND = Contour(
    np.array([
        [300.0, 0], [300, 120], [210, 210], [120, 300], [0, 300], [-120, 300], [-210, 210], [-300, 120], [-300, 0],
        [-300, -300], [0, -300], [200, -300], [280, -100], [300, -50],
    ]),
    np.array([2, 2, 2, 2, 2, 2, 1, 1]),
)  # fmt: skip
"""Quadratics, as TrueType has them."""


OVAL = Contour(
    np.array([
        [400.0, 0], [400, 290], [165, 500], [0, 500], [-150, 500], [-400, 262], [-400, 0], [-400, -290], [-165, -500],
        [0, -500], [150, -500], [400, -262],
    ]),
    np.full(4, 3),
)  # fmt: skip
"""Its curvatures jump, and do not meet with all cubics together."""


def outlines() -> None:
    """Outlines as fonts store them, once with curvatures that are let meet at one node after the other."""
    from ...fitting.convert import convert

    options = Options(corners="sharp", continuity="g2", tolerance=0.3)
    converted(options)
    convert(Outline("oval", contours=(OVAL,)), options)


def quadratics() -> None:
    """What a TTF stores."""
    from .fit.points import quadratic_points

    options = Options(corners="sharp", continuity="g2")
    quadratic_points(Outline("round", contours=(ROUND,)).arrays, options, 1.0, 1000.0)
