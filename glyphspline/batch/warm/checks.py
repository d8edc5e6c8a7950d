"""Checks of outlines, of one font and along an axis."""

import numpy as np

from ...checks.check import check
from ...checks.kinds import Thresholds
from ...checks.on_axes import on_axes
from ...outlines.masters import DesignAxis, MasterContour, Masters
from ...readers.opentype.bulk import load_compiled
from .. import worker  # noqa: F401
from . import DISC, KNOT, SHAPES

load_compiled()
check(SHAPES)
check(SHAPES.__class__("twice", contours=(KNOT, KNOT)))

masters = Masters(
    "disc",
    axes=(DesignAxis("wght", "Weight", 0, 0, 1),),
    regions=np.array([[[0.0, 1.0, 1.0]]]),
    contours=[MasterContour(np.stack([DISC.points, DISC.points * 2]), DISC.degrees)],
    advances=np.ones(2),
)
on_axes([masters], {}, ["wght"], 2, Thresholds())
