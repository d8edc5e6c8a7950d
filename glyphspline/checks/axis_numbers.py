"""Kinks along an axis in numbers: those of glyphs add up to those of their font."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class AxisNumbers:
    """The smooth joints of some glyphs along one axis; see :class:`.axis_kinks.Kink`.

    Attributes:
        axis: its tag. joints: how many there are. masters: user-space values of the masters on the axis, ascending.
        largest_turn, largest_turn_at_masters, largest_made: in degrees; None without joints.
        turns_over_1, made_over_1: number of joints with more than a degree.
        jumps_over_10_percent: number of joints where curvature jumps by more.
    """

    axis: str
    joints: int
    masters: tuple[float, ...]
    largest_turn: float | None = None
    largest_turn_at_masters: float | None = None
    largest_made: float | None = None
    turns_over_1: int = 0
    made_over_1: int = 0
    jumps_over_10_percent: int = 0

    def __add__(self, other: AxisNumbers) -> AxisNumbers:
        """Those of the glyphs of both, along the same axis."""
        return AxisNumbers(
            self.axis, self.joints + other.joints, tuple(sorted({*self.masters, *other.masters})),
            _larger(self.largest_turn, other.largest_turn),
            _larger(self.largest_turn_at_masters, other.largest_turn_at_masters),
            _larger(self.largest_made, other.largest_made), self.turns_over_1 + other.turns_over_1,
            self.made_over_1 + other.made_over_1, self.jumps_over_10_percent + other.jumps_over_10_percent,
        )  # fmt: skip


def _larger(a: float | None, b: float | None) -> float | None:
    return max([value for value in (a, b) if value is not None], default=None)
