"""What single options or measures need: the check of united contours, joins, the variation of curvature."""

from ...curves.fairness import curvature_variation
from ...outlines.joins import joins
from ...outlines.overlaps import inked_area
from . import DISC, LEAF

inked_area([DISC, LEAF])
joins(LEAF)
curvature_variation(DISC.cubics())
