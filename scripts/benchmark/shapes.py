"""The polygons that are timed."""

from __future__ import annotations

import numpy as np

import glyphspline as gs
from glyphspline.types import FloatArray

SHARE = 2e-7
"""The residual tolerance in all rows, as a share of the polygon's extent."""


def random_polygon(n: int, seed: int = 0) -> FloatArray:
    """The paper's: uniform in [0, 5]²."""
    return 5 * np.random.default_rng([n, seed]).random((n, 2))


def smooth_polygon(n: int) -> FloatArray:
    """A wavy round."""
    a = 2 * np.pi * np.arange(n) / n
    r = 1 + 0.2 * np.cos(3 * a) + 0.05 * np.sin(7 * a)
    return np.stack([r * np.cos(a), r * np.sin(a)], axis=1)


def glyph_polygons(count: int) -> list[FloatArray]:
    """Contours of DejaVu Sans, which Matplotlib brings along, in chords of 1/25 em and graded."""
    from matplotlib import get_data_path

    font = gs.open_font(f"{get_data_path()}/fonts/ttf/DejaVuSans.ttf")
    found: list[FloatArray] = []
    for name in font.glyph_names:
        found += [gs.sample(contour, step=font.metrics.units_per_em / 25) for contour in font.outline(name).contours]
        if len(found) >= count:
            break
    return [p for p in found if len(p) > 4][:count]
