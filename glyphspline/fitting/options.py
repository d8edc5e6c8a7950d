"""How glyphs are converted: :class:`Options`, checked where they are made."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from math import ceil, log10
from typing import Any, ClassVar, Literal

from ..errors import OptionError
from ..fields import CLOSENESS, CORNERS, METHOD, WRITTEN, check, checked, option, positive, whole
from ..interpolation.method import Fallback, Method
from ..outlines.sampling import CORNER_ANGLE, MAX_RATIO, check_sampling

Corners = Literal["smooth", "sharp"]
Effort = Literal["fast", "best"]
Continuity = Literal["c2", "g2"]
Preset = Literal["paper", "type", "brush"]

PRESETS: dict[str, dict[str, Any]] = {
    "paper": {"corners": "smooth", "margin": 0.0, "hold_corners": False},
    "type": {"corners": "sharp", "effort": "best"},
    "brush": {"corners": "smooth", "thousandths": 3.0},
}
"""Options set together: one smooth curve a contour as the paper has it; corners for type; and one smooth
curve a contour, further from the noise of traced outlines, for brush."""


@dataclass(frozen=True)
class Options:
    """How glyphs are converted. Lengths are in font units.

    Attributes:
        variant: 0 to 4 (the paper's Table 1).
        tolerance: two-sided distance allowed between the result and the source outline; None is ``thousandths``.
        thousandths: the same in thousandths of the em.
        step, count: sample by arc length or by number instead of by tolerance.
        corners: "sharp" splits at corners, "smooth" is one closed C2 curve a contour (the paper). None is "sharp", with
            ``step`` or ``count`` "smooth"; it is replaced by what it stands for.
        hold_corners: in "smooth", hold the control point of each corner at the corner: the curve passes it on the
            inside and bends once there, so that no rings stand beside it. False interpolates every vertex, as the
            paper does.
        corner_angle: the turn in degrees from which a join of segments is a corner: a vertex in "smooth", where arcs
            end in "sharp".
        continuity: of "sharp" between corners: "c2" is one spline of variant 2; "g2" cubics as fonts store them, no
            more than the source has, with points where it has them, whose tangents and curvatures meet on the grid of
            ``precision``: variant 2 does not run.
        effort: "fast" takes few fits, "best" seeks the fewest vertices.
        margin: c of Lemma 2, 0 to 0.5, by which search intervals shrink: larger ones guarantee a better rate of
            convergence. fallback: what footpoints do where chords are too uneven for Lemma 2 to have an interval,
            "knot" or "peak".
        max_ratio: bound on the ratio of adjacent chords.
        precision: decimals written, 0 to 9. None is as many as the tolerance tells apart, of continuity "g2" none: see
            :meth:`for_em`. Results have the number in the place of None.
        residual_tolerance: the solver's, in font units; None is 1/20 of the last decimal written.
        max_iterations: of the interpolation, for each contour.
        measure: also measure distance, length and curvature where fitting does not need them (``step``, ``count``).
        remove_overlaps: unite overlapping contours before sampling.

    Raises:
        OptionError: a value out of its range or of the wrong kind, or options that contradict each other.

    Example:
        >>> from glyphspline import Options
        >>> Options(tolerance=2.0).words
        'variant 2, margin 0.02, corners sharp, tolerance 2, effort fast'
        >>> Options(step=20.0).corners
        'smooth'
        >>> Options(step=20.0, count=9)
        Traceback (most recent call last):
        glyphspline.errors.OptionError: give one of tolerance, step and count, not step and count
    """

    presets: ClassVar = PRESETS

    variant: int = option(Method.variant, "Choose how footpoints are sought (Table 1).", METHOD, "0…4")
    tolerance: float | None = option(
        None, "Keep the curve within this distance of its source, in font units. Without it, 1/1000 em.",
        CLOSENESS, "UNITS", rule=positive("distance"),
    )  # fmt: skip
    thousandths: float = option(
        1.0, "Keep the curve within this number of thousandths of the em of its source.",
        CLOSENESS, "N", rule=positive("number"),
    )  # fmt: skip
    step: float | None = option(
        None, "Place a point every UNITS font units of the outline, instead of by tolerance.", CLOSENESS, "UNITS"
    )
    count: int | None = option(
        None, "Place this number of points on each contour, instead of by tolerance.", CLOSENESS, "N"
    )
    corners: Corners = option(
        None,
        "Keep corners (sharp), or draw one curve a contour (smooth), for brush and traced outlines. --step and --count "
        "are for smooth, their default.",
        CORNERS,
    )  # fmt: skip
    corner_angle: float = option(CORNER_ANGLE, "Set how sharp a turn counts as a corner.", CORNERS, "DEGREES")
    hold_corners: bool = checked(True)
    continuity: Continuity = option(
        "c2",
        "Fit between corners one C2 spline (c2), or the fewest cubics whose tangents and curvatures meet, as fonts "
        "store them (g2), of quadratics with more points.",
        CORNERS,
    )  # fmt: skip
    effort: Effort = option("fast", "Find the fewest points, which takes longer (best), or few (fast).", CLOSENESS)
    margin: float = 0.02
    fallback: Fallback = "peak"
    max_ratio: float = MAX_RATIO
    precision: int = option(
        None,
        "Write this number of decimals, 0 to 9. Without it, as many as the tolerance tells apart: 1 for an em of 1000; "
        "0 of curves as fonts store them.",
        WRITTEN, "N", rule=whole(0, 9),
    )  # fmt: skip
    residual_tolerance: float | None = None
    max_iterations: int = Method.max_iterations
    measure: bool = option(False, "Measure distance, length and curvature with --step and --count too.", CLOSENESS)
    remove_overlaps: bool = option(False, "Unite overlapping contours first.", WRITTEN)

    def __post_init__(self) -> None:
        if self.corners is None:
            object.__setattr__(self, "corners", "smooth" if self.is_fixed else "sharp")
        Method(
            self.variant, margin=self.margin, fallback=self.fallback, residual_tolerance=self.residual_tolerance,
            max_iterations=self.max_iterations,
        )  # fmt: skip
        check_sampling(self.count, self.step, self.max_ratio, self.corner_angle)
        check(self)
        given = [name for name in ("tolerance", "step", "count") if getattr(self, name) is not None]
        if len(given) > 1:
            raise OptionError(f"give one of tolerance, step and count, not {' and '.join(given)}")
        if self.corners == "sharp" and self.is_fixed:
            raise OptionError(
                'step and count sample whole contours, which corners="sharp" cuts: take "smooth", or give a tolerance'
            )

    @property
    def is_fixed(self) -> bool:
        """Whether vertices are placed by ``step`` or ``count``, whatever the distance from the source."""
        return self.step is not None or self.count is not None

    @property
    def is_for_fonts(self) -> bool:
        """Whether the result is what fonts store, on their grid, with points where they have them."""
        return self.corners == "sharp" and self.continuity == "g2"

    @property
    def words(self) -> str:
        """What a caption says of a conversion, in the words of the command line; only what made a difference."""
        method = [f"variant {self.variant}", f"margin {self.margin:g}", f"corners {self.corners}"]
        said = [f"corners {self.corners}", f"continuity {self.continuity}"] if self.is_for_fonts else method
        given = [name for name in ("tolerance", "step", "count") if getattr(self, name) is not None]
        said += [f"{name} {getattr(self, name):g}" for name in given] or [f"tolerance {self.thousandths:g}/1000 em"]
        said += [] if self.is_fixed else [f"effort {self.effort}"]
        return ", ".join(said)

    def facts(self) -> dict[str, Any]:
        """As JSON data, for files that say how they were made; ``thousandths`` only where it is not 1."""
        return {name: value for name, value in asdict(self).items() if (name, value) != ("thousandths", 1.0)}

    def tolerance_for(self, units_per_em: float) -> float:
        """The geometric tolerance in font units."""
        return units_per_em * self.thousandths / 1000 if self.tolerance is None else self.tolerance

    def for_em(self, units_per_em: float) -> Options:
        """The options with their number of decimals: the fewest whose rounding is within 1/20 of the tolerance.

        Curves as fonts store them have none, whatever the tolerance.

        Example:
            >>> [Options().for_em(em).precision for em in (24, 1000, 2048)]
            [3, 1, 1]
        """
        if self.precision is not None:
            return self
        decimals = ceil(1.0 - log10(self.tolerance_for(units_per_em)) - 1e-9)
        return replace(self, precision=0 if self.is_for_fonts else min(max(decimals, 0), 9))

    @property
    def solver_tolerance(self) -> float:
        """The solver's tolerance in font units."""
        return 0.05 / 10.0**self.precision if self.residual_tolerance is None else self.residual_tolerance
