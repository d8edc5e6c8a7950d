"""Settings of writers of drawings besides the result: looks, scale and flatness."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

from ..errors import is_positive, require
from ..fields import LOOK, WRITTEN, check, option, positive
from .svg.appearance import PLAIN, Appearance, Whose

if TYPE_CHECKING:
    from ..outlines.outline import FontMetrics

DxfKind = Literal["spline", "polyline"]

RELATIVE_FLATNESS = 1 / 2000
"""Flatness of polylines where none is given, in em."""


@dataclass(frozen=True)
class Settings:
    """Settings of a writer of drawings.

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
    flatness: float | None = option(
        None, "Keep polylines within this distance of their curves, in font units. Without it, 1/2000 em.",
        WRITTEN, "UNITS", rule=positive("distance in font units"),
    )  # fmt: skip
    dxf: DxfKind = option("spline", "Write contours in a DXF as splines, which are exact, or as polylines.", WRITTEN)

    def __post_init__(self) -> None:
        require(is_positive(self.scale), "scale is a positive number", self.scale)
        check(self)

    def flatness_for(self, units_per_em: float) -> float:
        """The flatness in font units."""
        return units_per_em * RELATIVE_FLATNESS if self.flatness is None else self.flatness

    def scaled(self, metrics: FontMetrics) -> Settings:
        """The settings with the scale of ``look``: its size is from ascender to descender. Without a size: 1, no unit.

        A font whose ascender is not above its descender is scaled by its em.
        """
        height = metrics.ascender - metrics.descender
        found = self.look.scale(height if height > 0 else metrics.units_per_em, metrics.units_per_em)
        scale, unit = found or (1.0, None)
        return replace(self, scale=scale, unit=unit)


@dataclass(frozen=True)
class Maps:
    """What curvature maps show: combs of the result or of the source, and teeth where a result turns about a corner.

    Raises:
        OptionError: ``comb`` is neither "result" nor "source", or ``corner_teeth`` is no bool.
    """

    comb: Whose = option("result", "Show the curvature of the result, or of the source outline, which is exact.", LOOK)
    corner_teeth: bool = option(False, "Draw teeth of a smooth result's comb also in the turn of a corner.", LOOK)

    def __post_init__(self) -> None:
        check(self)
