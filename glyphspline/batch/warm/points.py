"""Rows of data sets: canonical outlines, and points at equal arc lengths or at vertices."""

import numpy as np

from ...fitting.results import as_glyph
from ...outlines.canonical_outlines import canonical_outlines
from ...outlines.outline import Outline
from ...outlines.resampling import at_vertices, resampled
from ...readers.opentype.bulk import load_compiled
from .. import worker  # noqa: F401
from . import DISC, LEAF, SHAPES, SQUARE

load_compiled()
canonical_outlines(
    [SHAPES, Outline("in order", contours=(SQUARE, DISC)), Outline("other order", contours=(LEAF, DISC))]
)
arrays = as_glyph(SHAPES).arrays
resampled(arrays.curves, 8, float(np.radians(30.0)))
at_vertices(arrays.curves, arrays.polygons, float(np.radians(30.0)))
