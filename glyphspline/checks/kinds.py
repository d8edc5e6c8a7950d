"""What is looked for in an outline: each kind of finding with its level, its unit, and the limits from which it counts.

The numbers are made in compiled code, :mod:`.joints`, :mod:`.single_segments`, :mod:`.bends` and :mod:`.enclosed`; what
they mean is said here.
"""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Callable
from dataclasses import dataclass, field, fields
from math import radians
from typing import TYPE_CHECKING, Any, Literal

from ..errors import is_positive, require

Level = Literal["WARN", "INFO"]
LEVELS: tuple[Level, ...] = ("INFO", "WARN")

(
    KINK, JUMP, LUMP, INFLECTION, STRAIGHT, SLANTED, EXTREMUM, SHORT, HANDLES, OVERLAP, DIRECTION, DOUBLED, CROSSING,
) = range(13)  # fmt: skip
"""Numbers of the kinds in compiled code: their places in ``KINDS``."""


@dataclass(frozen=True)
class Kind:
    """A kind of finding.

    Attributes:
        name: as in tables, JSON and baselines. level: how serious it is. unit: of the finding's value.
        sentence: what it says of a finding; ``{value}`` has its unit, ``{detail}`` is the second number, and
            ``{other}`` the other contour, "contour 3", or "itself".
    """

    name: str
    level: Level
    unit: str
    sentence: str


KINDS = (
    Kind("kink", "WARN", "°", "turns by {value} at a joint meant to be smooth"),
    Kind("jump", "INFO", "/em", "curvature jumps by {value} ({detail:.0%}) at a smooth joint"),
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
)


DEGREES, SHARE, PER_EM, THOUSANDTHS = "degrees", "share", "1/em", "em/1000"
"""Units of thresholds."""


def _in(unit: str, value: float) -> Any:
    """A threshold's default in its unit, which :meth:`Thresholds.limits` converts."""
    return field(default=value, metadata={"unit": unit})


@dataclass(frozen=True)
class Thresholds:
    """From which value on each kind counts.

    Attributes:
        kink: degrees of turn at a joint; from ``corner_angle`` degrees on it is a corner, and meant; of two lines from
            line_angle degrees on: the chamfer of a serif is no kink.
        jump: of curvature at a smooth joint, in 1/em; relative_jump: and as a share of the larger curvature.
        lump: share by which a curvature exceeds the extrema beside it, if that moves the curve by lump_height,
            in thousandths of an em.
        inflection: degrees by which a segment bends back.
        straight: thousandths of an em that a curve may leave its chord and still be called straight, if the chord is as
            long as straight_length, in thousandths too.
        slanted: degrees off the horizontal or vertical up to which a line is nearly so, from slanted_offset on, in
            thousandths of an em between its ends; of one whole unit only if the line is as long as slanted_length.
        extremum: thousandths of an em by which a curve passes the ends of its segment.
        short: thousandths of an em below which a segment is very short.
        handles: share by which a handle reaches beyond the place where both meet.
        doubled: thousandths of an em for which a contour lies on itself or on another one.
    """

    kink: float = _in(DEGREES, 0.5)
    corner_angle: float = _in(DEGREES, 12.0)
    line_angle: float = _in(DEGREES, 3.0)
    jump: float = _in(PER_EM, 1.0)
    relative_jump: float = _in(SHARE, 0.25)
    lump: float = _in(SHARE, 0.25)
    lump_height: float = _in(THOUSANDTHS, 0.3)
    inflection: float = _in(DEGREES, 1.0)
    straight: float = _in(THOUSANDTHS, 0.5)
    straight_length: float = _in(THOUSANDTHS, 20.0)
    slanted: float = _in(DEGREES, 0.5)
    slanted_offset: float = _in(THOUSANDTHS, 0.25)
    slanted_length: float = _in(THOUSANDTHS, 100.0)
    extremum: float = _in(THOUSANDTHS, 1.0)
    short: float = _in(THOUSANDTHS, 3.0)
    handles: float = _in(SHARE, 0.01)
    doubled: float = _in(THOUSANDTHS, 5.0)

    def __post_init__(self) -> None:
        for each in fields(self):
            value = getattr(self, each.name)
            require(is_positive(value, 1e6), f"the threshold {each.name} is above 0 and up to a million", value)

    def limits(self, units_per_em: float, outer: int = 0) -> Limits:
        """In font units and radians, of a font whose outer contours have the direction ``outer``."""
        unit = units_per_em / 1000
        of_unit: dict[str, Callable[[float], float]] = {
            DEGREES: radians,
            SHARE: float,
            PER_EM: lambda value: value / units_per_em,
            THOUSANDTHS: lambda value: value * unit,
        }
        own = {each.name: of_unit[each.metadata["unit"]](getattr(self, each.name)) for each in fields(self)}
        return Limits(**own, unit=unit, outer=outer)


if TYPE_CHECKING:

    @dataclass(frozen=True)
    class Limits(Thresholds):
        """Thresholds in font units and radians, as compiled code takes them: a named tuple.

        Attributes:
            unit: a thousandth of an em. outer: direction of outer contours, as in :attr:`.Source.outer`.
        """

        unit: float = 1.0
        outer: int = 0
else:
    Limits = namedtuple("Limits", [*(each.name for each in fields(Thresholds)), "unit", "outer"])
