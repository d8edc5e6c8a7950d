"""Small runs that call all compiled functions of this plug-in, for the types of arguments that it has."""

from __future__ import annotations

import numpy as np

from ...outlines.outline import Outline
from ...runs.small_runs import DISC, LEAF, SHAPES, SQUARE


def points() -> None:
    """Rows of data sets: canonical outlines, and points at equal arc lengths or at vertices."""
    from ...fitting.results import as_glyph
    from .canonical_outlines import canonical_outlines
    from .resampling import at_vertices, resampled

    both = (Outline("in order", contours=(SQUARE, DISC)), Outline("other order", contours=(LEAF, DISC)))
    canonical_outlines([SHAPES, *both])
    arrays = as_glyph(SHAPES).arrays
    resampled(arrays.curves, 8, float(np.radians(30.0)))
    at_vertices(arrays.curves, arrays.polygons, float(np.radians(30.0)))
