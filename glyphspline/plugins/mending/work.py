"""Small runs that call all compiled functions of this plug-in, for the types of arguments that it has."""

from __future__ import annotations

import numpy as np

from ...outlines.outline import Contour, Outline
from ..checks.work import checks


def mending() -> None:
    """A kink mended, of an outline, which is one master."""
    from .mend import mend

    checks()
    points = np.array([[0.0, 0], [0, 262], [161, 563], [300, 500], [424, 435], [600, 292], [600, 0]])
    mend(Outline("kink", contours=(Contour(points, np.array([3, 3, 1])),)), tolerance=5.0)
