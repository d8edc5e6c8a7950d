"""What a writer of drawings is told besides the result: looks, scale and flatness."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, get_args

from ..errors import is_positive, require, require_choice
from .svg.appearance import PLAIN, Appearance

if TYPE_CHECKING:
    from ..outlines.outline import FontMetrics

DxfKind = Literal["spline", "polyline"]

RELATIVE_FLATNESS = 1 / 2000
"""Flatness of polylines where none is given, in em."""


@dataclass(frozen=True)
class Settings:
    """What a writer is told besides the result.

    Attributes:
        look: of drawings. scale: length of a font unit in the drawing, in ``unit``.
        unit: "mm", "cm", "in", "pt", "pc" or "px"; None: a font unit.
        flatness: largest distance of a polyline from its curve, in font units; None: 1/2000 em.
        dxf: contours as splines, or flattened.

    Raises:
        OptionError: a scale or flatness that is not positive, or an unknown kind of DXF.
    """

    look: Appearance = PLAIN
    scale: float = 1.0
    unit: str | None = None
    flatness: float | None = None
    dxf: DxfKind = "spline"

    def __post_init__(self) -> None:
        require(is_positive(self.scale), "scale is a positive number", self.scale)
        given = self.flatness is None or is_positive(self.flatness)
        require(given, "flatness is a positive distance in font units", self.flatness)
        require_choice("dxf", self.dxf, get_args(DxfKind))

    def flatness_for(self, units_per_em: float) -> float:
        """The flatness in font units."""
        return units_per_em * RELATIVE_FLATNESS if self.flatness is None else self.flatness


def settings_for(
    look: Appearance, metrics: FontMetrics, flatness: float | None = None, dxf: DxfKind = "spline"
) -> Settings:
    """Settings of the scale that ``look`` says: its size is from ascender to descender. Without a size: 1 and no unit.

    A font whose ascender is not above its descender is scaled by its em.
    """
    height = metrics.ascender - metrics.descender
    found = look.scale(height if height > 0 else metrics.units_per_em, metrics.units_per_em)
    scale, unit = found or (1.0, None)
    return Settings(look, scale, unit, flatness, dxf)
