"""Bounds of what polygons are sampled by, and the angle of corners.

What checks options imports this, and no NumPy with it: a command starts its workers before it imports libraries.
"""

from __future__ import annotations

from ..errors import is_number, is_positive, is_whole, require

CORNER_ANGLE = 12.0
"""Degrees of turn from which a join of two segments is a corner. Brush faces join smooth strokes at up to 10."""

MOST_VERTICES = 200_000
"""Maximum number of vertices of a polygon."""

MAX_RATIO = 4.0
"""Bound on the ratio of adjacent spacings up to which every basis function rises above 1/2."""

LARGEST_RATIO = 1e6
"""Upper bound of ``max_ratio``."""


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
