"""From a contour to a polygon whose vertices lie on it; the bounds of what polygons are sampled by.

What checks options imports this, and no NumPy with it: a command starts its workers before it imports libraries.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..errors import GlyphsplineError, OptionError, is_number, is_positive, is_whole, require
from ..types import FloatArray

if TYPE_CHECKING:
    from .outline import Contour

CORNER_ANGLE = 12.0
"""Degrees of turn from which a join of two segments is a corner. Brush faces join smooth strokes at up to 10."""

MOST_VERTICES = 200_000
"""Maximum number of vertices of a polygon."""

MAX_RATIO, LARGEST_RATIO = 4.0, 1e6
"""Bound on the ratio of adjacent spacings up to which every basis function rises above 1/2. Upper bound of
``max_ratio``."""


def check_sampling(count: int | None, step: float | None, max_ratio: float, corner_angle: float) -> None:
    """Validate the parameters of :func:`sample`.

    Raises:
        OptionError: a value out of range or of the wrong kind.
    """
    rule = f"count is a whole number from 3 to {MOST_VERTICES}"
    require(count is None or is_whole(count, 3, MOST_VERTICES), rule, count)
    require(step is None or is_positive(step), "step is a positive distance", step)
    require(is_number(max_ratio, 2, LARGEST_RATIO), f"max_ratio is a ratio from 2 to {LARGEST_RATIO:g}", max_ratio)
    rule = "corner_angle is an angle in degrees, above 0 and up to 180"
    require(is_positive(corner_angle, 180), rule, corner_angle)


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
    import numpy as np

    from .places import sampled

    if (count is None) == (step is None):
        raise OptionError("sample by count or by step")
    check_sampling(count, step, max_ratio, corner_angle)
    ends, angle = np.array([0, len(contour)]), np.radians(corner_angle)
    points, _, _, refused = sampled(contour.cubics(), ends, step or 0.0, count or 0, max_ratio, angle, MOST_VERTICES)
    if refused[0]:
        raise GlyphsplineError(f"sampling takes more than {MOST_VERTICES} vertices")
    return points
