"""What single options or measures need: united contours, joins, the variation of curvature, unlike masters."""

from ...curves.fairness import curvature_variation
from ...outlines.common_cuts import common_cuts
from ...outlines.joins import joins
from ...outlines.landmarks import Landmarks
from ...outlines.overlaps import inked_area
from . import DISC, LEAF

inked_area([DISC, LEAF])
joins(LEAF)
curvature_variation(DISC.cubics())
common_cuts(Landmarks(LEAF, 1000.0), Landmarks(LEAF, 1000.0))
