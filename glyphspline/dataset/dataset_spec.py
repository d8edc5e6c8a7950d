"""What a data set holds: its rows, their points, and which fonts and glyphs are taken."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

from ..errors import OptionError, is_positive, require, require_choice
from ..fitting.options import Options

Rows: TypeAlias = Literal["glyph", "contour"]
Normalise: TypeAlias = Literal["em", "units"]
Instances: TypeAlias = Literal["default", "named"]

MOST_POINTS = 4096
"""Points of a contour, and pixels of a raster's side."""


FIT = Options(corners="sharp")
"""The fit of a data set: as type has it."""


@dataclass(frozen=True)
class DatasetSpec:
    """What a data set holds.

    Attributes:
        rows: one row a glyph, or one a contour.
        points: points of each contour, at equal arc lengths of its source outline, or of the fitted curve if there is
            one; None: the polygon of the fit, or without a fit the points on the curve.
        normalise: coordinates in em, or in font units.
        options: of the fit; None: nothing is fitted, and the columns of splines and measures are null.
        raster: height and width in pixels of a grey picture of the glyph; None: there is none.
        characters, scripts, licences: only glyphs of these characters, scripts (ISO 15924), and fonts whose licence
            (SPDX identifier, or "unknown") is one of these; empty: all.
        instances: where the outlines of a variable font are taken: at its default, or at each of its named instances.
        coverage: share of ``characters`` that a font needs to be taken, 0 to 1.
        seed: of the split. validation, test: shares of the families in these splits; the rest is for training.
    """

    rows: Rows = "glyph"
    points: int | None = 64
    normalise: Normalise = "em"
    options: Options | None = FIT
    raster: int | None = None
    characters: str = ""
    scripts: tuple[str, ...] = ()
    licences: tuple[str, ...] = ()
    instances: Instances = "default"
    coverage: float = 0.0
    seed: int = 0
    validation: float = 0.1
    test: float = 0.1

    @property
    def glyph_bytes(self) -> int:
        """About what points, tangents, curvature and pixels of a glyph with eight contours need in memory."""
        return 8 * 20 * (self.points or 64) + (self.raster or 0) ** 2

    def __post_init__(self) -> None:
        require_choice("rows", self.rows, get_args(Rows))
        require_choice("normalise", self.normalise, get_args(Normalise))
        require_choice("instances", self.instances, get_args(Instances))
        for name, least in (("points", 3), ("raster", 8)):
            value = getattr(self, name)
            good = value is None or (isinstance(value, int) and least <= value <= MOST_POINTS)
            require(good, f"{name} is a whole number from {least} to {MOST_POINTS}", value)
        require(self.options is None or isinstance(self.options, Options), "options are Options, or None", self.options)
        for name in ("coverage", "validation", "test"):
            value = getattr(self, name)
            require(value == 0 or (is_positive(value) and value <= 1), f"{name} is from 0 to 1", value)
        if self.validation + self.test > 1:
            raise OptionError("validation and test are more than all families together")
