"""What is looked for in an outline: kinds of findings, their levels and units, and from which value each counts."""

from __future__ import annotations

from collections import namedtuple
from dataclasses import dataclass, fields
from math import radians
from typing import TYPE_CHECKING, Any, Literal

from ...errors import OptionError, is_positive
from ...fields import Condition, check, option, options_of

Level = Literal["WARN", "INFO"]
LEVELS: tuple[Level, ...] = ("INFO", "WARN")

(
    KINK, JUMP, LUMP, INFLECTION, STRAIGHT, SLANTED, EXTREMUM, SHORT, HANDLES, OVERLAP, DIRECTION, DOUBLED, CROSSING,
    REPEATED, LEFTOVER, SPIKE, RETRACTED, UNLEVEL, TURN, COVERED, OPEN, MISS, MIXED, CANCELLING,
) = range(24)  # fmt: skip
"""Numbers of the kinds in tables of findings: their places in ``KINDS``."""


@dataclass(frozen=True)
class Kind:
    """A kind of finding.

    Attributes:
        name: as in tables, JSON and baselines. level: how serious it is. unit: of the finding's value.
        sentence: what it says of a finding; ``{value}`` has its unit, ``{detail}`` is the second number, ``{along}``
            the length along which it is seen, and ``{other}`` the other contour, "contour 3", or "itself".
    """

    name: str
    level: Level
    unit: str
    sentence: str


KINDS = (
    Kind("kink", "WARN", "°", "turns by {value} at a joint meant to be smooth"),
    Kind("jump", "INFO", "/em", "curvature jumps by {value} ({detail:.0%}) at a smooth joint, beside {along}"),
    Kind("lump", "INFO", "%", "curvature swells by {value} where the bend needs no more maxima"),
    Kind("inflection", "INFO", "°", "bends back by {value} inside a segment that else bends one way"),
    Kind("straight", "INFO", "units", "a curve within {value} of a straight line"),
    Kind("slanted", "INFO", "°", "a line {value} off the horizontal or vertical"),
    Kind("extremum", "INFO", "units", "no point at an extremum, {value} beyond its ends"),
    Kind("short", "INFO", "units", "a segment of {value}"),
    Kind("handles", "INFO", "%", "a handle reaches {value} beyond where the two handles meet"),
    Kind("overlap", "INFO", "places", "crosses {other}"),
    Kind("direction", "INFO", "units²", "runs in the wrong direction"),
    Kind("doubled", "INFO", "units", "lies on {other} for {value}"),
    Kind("crossing", "INFO", "places", "crosses {other}"),
    Kind("repeated", "INFO", "points", "a point that is there more than once"),
    Kind("leftover", "INFO", "units", "a point between two lines, {value} off a line in their place"),
    Kind("spike", "INFO", "units", "a spike of {value}"),
    Kind("retracted", "INFO", "units", "a handle of no length, of a curve of {value}"),
    Kind("unlevel", "INFO", "units", "handles at an extreme point {value} off level"),
    Kind("turn", "INFO", "°", "turns by {value}, of two lines or beside a short segment or handle"),
    Kind("covered", "INFO", "units²", "draws nothing, with ink on both sides: runs like {other} around it"),
    Kind("open contour", "INFO", "segments", "is an open path of {value}: fonts fill it or draw nothing"),
    Kind("alignment miss", "INFO", "units", "{value} off the height {detail:g}"),
    Kind("mixed outlines", "INFO", "segments", "quadratics and cubics in one glyph: {value} of the other kind"),
    Kind("cancelling component", "INFO", "units", "cancels {other}: white along {value} where they overlap"),
)

MENDED = ("kink", "jump", "handles", "extremum", "unlevel", "slanted", "repeated", "straight", "short", "direction")
"""Names of the kinds that :func:`glyphspline.mend` mends, in this order."""

MENDED_UNASKED = ("kink",)
"""Those of them that it mends unless others are asked for: none of the others is a fault for certain."""

ABOVE_ZERO = Condition("above 0 and up to a million", lambda value: is_positive(value, 1e6))


def _threshold(default: float, unit: str, help: str) -> Any:
    """A threshold, with its unit as people give it."""
    return option(default, help, metavar=unit, rule=ABOVE_ZERO)


@dataclass(frozen=True)
class Thresholds:
    """From which value on each kind counts; thousandths are of an em."""

    kink: float = _threshold(0.5, "degrees", "Turn of a joint meant to be smooth.")
    corner_angle: float = _threshold(12.0, "degrees", "Turn from which a joint is a corner, and meant.")
    line_angle: float = _threshold(3.0, "degrees", "The same for two lines: the chamfer of a serif is no kink.")
    kink_height: float = _threshold(
        0.75, "thousandths", "By which such a turn moves the far end of the shorter segment beside it."
    )
    turn: float = _threshold(2.0, "degrees", "Turn of a joint that is less, or that rounding to whole units may make.")
    rounding: float = _threshold(
        3.0, "deviations", "Standard deviations of that rounding; kinks and jumps beyond are not made by it."
    )
    jump: float = _threshold(1.0, "1/em", "Difference of the curvatures on both sides of a smooth joint.")
    relative_jump: float = _threshold(0.25, "share", "The same as a share of the larger curvature.")
    lump: float = _threshold(0.25, "share", "By which a curvature exceeds the extrema beside it.")
    lump_height: float = _threshold(0.3, "thousandths", "By which that moves the curve.")
    inflection: float = _threshold(1.0, "degrees", "By which a segment bends back.")
    straight: float = _threshold(0.5, "thousandths", "By which a straight curve may leave its chord.")
    straight_length: float = _threshold(20.0, "thousandths", "Shortest chord of a curve that is called straight.")
    slanted: float = _threshold(0.5, "degrees", "Off the horizontal or vertical, up to which a line is nearly so.")
    slanted_offset: float = _threshold(0.25, "thousandths", "Between the ends of such a line, from which it counts.")
    slanted_length: float = _threshold(100.0, "thousandths", "Shortest such line that is off by one whole unit only.")
    extremum: float = _threshold(1.0, "thousandths", "By which a curve passes the ends of its segment.")
    short: float = _threshold(3.0, "thousandths", "Below which a segment is very short.")
    handles: float = _threshold(0.01, "share", "By which a handle reaches beyond the place where both meet.")
    doubled: float = _threshold(5.0, "thousandths", "For which a contour lies on itself or on another one.")
    spike: float = _threshold(3.0, "thousandths", "Between the sides of a spike, at most.")
    leftover: float = _threshold(0.75, "thousandths", "Off a line in place of two, up to which their joint is one.")
    unlevel: float = _threshold(0.6, "thousandths", "By which a handle at an extreme point is off level.")
    unlevel_most: float = _threshold(4.0, "thousandths", "The same, beyond which it is meant.")

    def __post_init__(self) -> None:
        try:
            check(self)
        except OptionError as error:
            raise OptionError(f"the threshold {error}") from None

    def limits(self, units_per_em: float) -> Limits:
        """The thresholds in font units and radians, as passes take them."""
        converted = []
        for name, _, about in options_of(Thresholds):
            value: float = getattr(self, name)
            of_unit = {
                "degrees": radians(value),
                "share": value,
                "deviations": value,
                "1/em": value / units_per_em,
                "thousandths": value * (units_per_em / 1000),
            }
            converted.append(of_unit[about.metavar or ""])
        return Limits(*converted)


THRESHOLDS = Thresholds()

if TYPE_CHECKING:
    Limits = Thresholds
else:
    Limits = namedtuple("Limits", [each.name for each in fields(Thresholds)])  # compiled code takes named tuples
