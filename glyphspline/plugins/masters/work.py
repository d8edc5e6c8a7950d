"""Small runs that call all compiled functions of this plug-in, for the types of arguments that it has."""

from __future__ import annotations

import numpy as np

from ...fitting.options import Options
from ...outlines.masters import DesignAxis, MasterContour, Masters
from ...runs.small_runs import DISC, LEAF

AXES = (DesignAxis("wght", "Weight", 0, 0, 1),)
REGIONS = np.array([[[0.0, 1.0, 1.0]]])


def masters() -> None:
    """Masters as one curve, with arcs that fail the certificate at first and one that ends on a slanted line."""
    from ...curves.nearest import near_places
    from ...readers.pens import ContourPen
    from .convert_masters import convert_masters
    from .matching.cuts import common_cuts
    from .matching.landmarks import Landmarks

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
    common_cuts(Landmarks(LEAF, 1000.0), Landmarks(LEAF, 1000.0))


def axes() -> None:
    """Checks along an axis."""
    from ...outlines.flaws.kinds import Thresholds
    from .on_axes import on_axes

    disc = MasterContour(np.stack([DISC.points, DISC.points * 2]), DISC.degrees)
    family = Masters("disc", axes=AXES, regions=REGIONS, contours=[disc], advances=np.ones(2))
    on_axes([family], {}, ["wght"], 2, Thresholds())
