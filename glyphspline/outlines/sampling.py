"""From a contour to a polygon whose vertices lie on it."""

from __future__ import annotations

import numpy as np

from ..errors import GlyphsplineError, OptionError
from ..types import FloatArray
from .outline import Contour
from .sampling_limits import CORNER_ANGLE, MAX_RATIO, MOST_VERTICES, check_sampling


def sample(
    contour: Contour,
    *,
    count: int | None = None,
    step: float | None = None,
    max_ratio: float = MAX_RATIO,
    corner_angle: float = CORNER_ANGLE,
) -> FloatArray:
    """Sample a contour to a polygon whose vertices lie on it.

    Args:
        contour: the contour.
        count: number of vertices, evenly spaced by arc length; the nearest vertex moves onto each corner where
            spacings stay within ``max_ratio``.
        step: corners are vertices, and the sections between them are divided evenly into parts of about ``step`` font
            units (at least 3 vertices); spacings next to much shorter ones are halved.
        max_ratio: bound on the ratio of adjacent spacings along the contour, 2 or more. Up to 4 keeps every
            basis function above 1/2, so that convergence is certified.
        corner_angle: turn in degrees from which a join of two segments is a corner.

    Returns:
        (n, 2) vertices, in the contour's direction.

    Raises:
        OptionError: neither or both of ``count`` and ``step``, or a value out of range.
        GlyphsplineError: too many vertices.

    Example:
        >>> from glyphspline import open_font, sample
        >>> contour = open_font("fonts_test/kouzan-gyosho.ttf").outline("O").contours[0]
        >>> sample(contour, count=24).shape
        (24, 2)
    """
    from .places import sampled  # imported here, so that the package opens without a compiler

    if (count is None) == (step is None):
        raise OptionError("sample by count or by step")
    check_sampling(count, step, max_ratio, corner_angle)
    ends, angle = np.array([0, len(contour)]), np.radians(corner_angle)
    points, _, _, refused = sampled(contour.cubics(), ends, step or 0.0, count or 0, max_ratio, angle, MOST_VERTICES)
    if refused[0]:
        raise GlyphsplineError(f"sampling takes more than {MOST_VERTICES} vertices")
    return points
