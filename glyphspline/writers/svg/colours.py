"""A diverging colour map for signed curvature, made in OKLCh (Ottosson 2020) at one lightness."""

from __future__ import annotations

from functools import cache

import numpy as np

from ...types import FloatArray, IntArray

SIDES = 7
"""Colour classes on each side of zero. More cannot be distinguished on thin teeth, and each adds a path."""

LIGHTNESS = 0.66
"""OKLab lightness of all colours: contrast of about 3:1 with white and 6:1 with black, so both themes can show it."""

# Hue in degrees from flat to strongly curved: convex ink green-blue to violet, concave yellow to red.
_CONVEX, _CONCAVE = (215.0, 300.0), (80.0, 20.0)
_CHROMA = (0.06, 0.2)


def colour_classes(relative: FloatArray) -> IntArray:
    """Class -SIDES to SIDES of curvature in units of the scale; ±1 and all beyond are the outermost."""
    return np.clip(np.rint(relative * SIDES), -SIDES, SIDES).astype(np.int64)


@cache
def class_colour(index: int) -> str:
    """The colour of a class as "#rrggbb"; 0 is grey."""
    strength = abs(index) / SIDES
    start, end = _CONVEX if index > 0 else _CONCAVE
    chroma = 0.0 if index == 0 else _CHROMA[0] + (_CHROMA[1] - _CHROMA[0]) * strength
    return oklch(LIGHTNESS, chroma, start + (end - start) * strength)


def oklch(lightness: float, chroma: float, hue: float) -> str:
    """An OKLCh colour as sRGB "#rrggbb", clipped to the gamut channel by channel."""
    a, b = chroma * np.cos(np.radians(hue)), chroma * np.sin(np.radians(hue))
    lms = (
        np.array(
            [[1, 0.3963377774, 0.2158037573], [1, -0.1055613458, -0.0638541728], [1, -0.0894841775, -1.2914855480]]
        )
        @ np.array([lightness, a, b])
    ) ** 3
    linear = (
        np.array(
            [
                [4.0767416621, -3.3077115913, 0.2309699292],
                [-1.2684380046, 2.6097574011, -0.3413193965],
                [-0.0041960863, -0.7034186147, 1.7076147010],
            ]
        )
        @ lms
    )
    linear = np.clip(linear, 0, 1)
    encoded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return "#" + "".join(f"{round(255 * value):02x}" for value in encoded.tolist())
