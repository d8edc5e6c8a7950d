"""From a contour to a polygon whose vertices lie on it."""

from __future__ import annotations

import numpy as np

from ..errors import GlyphsplineError, OptionError
from ..types import FloatArray
from .outline import Contour

CORNER_ANGLE = 12.0
"""Degrees of turn from which a join of two segments is a corner. Brush faces join smooth strokes at up to 10."""

MOST_VERTICES = 200_000
"""Maximum number of vertices of a polygon."""


def sample(
    contour: Contour,
    *,
    count: int | None = None,
    step: float | None = None,
    max_ratio: float = 4.0,
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
    """
    from .places import sampled  # imported here, so that the package opens without a compiler

    check_sampling(count, step, max_ratio, corner_angle)
    ends, angle = np.array([0, len(contour)]), np.radians(corner_angle)
    points, _, _, refused = sampled(contour.cubics(), ends, step or 0.0, count or 0, max_ratio, angle, MOST_VERTICES)
    if refused[0]:
        raise GlyphsplineError(f"sampling takes more than {MOST_VERTICES} vertices")
    return points


def check_sampling(count: int | None, step: float | None, max_ratio: float, corner_angle: float) -> None:
    """Validate the parameters of :func:`sample`.

    Raises:
        OptionError: neither or both of ``count`` and ``step``, or a value out of range.
    """
    if (count is None) == (step is None):
        raise OptionError("sample by count or by step")
    if count is not None and not 3 <= count <= MOST_VERTICES:
        raise OptionError(f"count is 3 to {MOST_VERTICES}, not {count}")
    if step is not None and not 0 < step < np.inf:
        raise OptionError(f"step is a positive length, not {step}")
    if not 2 <= max_ratio < np.inf:
        raise OptionError(f"max_ratio is 2 or more, not {max_ratio}")
    if not 0 < corner_angle <= 180:
        raise OptionError(f"corner_angle is an angle up to 180 degrees, not {corner_angle}")
