"""The method as compiled functions read it: numbers."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..compiled import inlined
from ..types import FloatArray


class Rule(NamedTuple):
    """What compiled functions read of a :class:`.Method`.

    Attributes:
        exponent: of the chord length in the knots, or ``method.GIVEN``.
        tolerance: of residuals; NaN: the one of ``method.RELATIVE_TOLERANCE``.
        peak_share: ``method.PEAK_SHARE`` with ``fallback="peak"``, else 0.
    """

    closed: bool
    variant: int
    margin: float
    exponent: float
    tolerance: float
    peak_share: float
    max_iterations: int


@inlined
def rule_of(numbers: FloatArray) -> Rule:
    """The rule that :func:`in_numbers` made numbers of."""
    return Rule(numbers[0] > 0.0, int(numbers[1]), numbers[2], numbers[3], numbers[4], numbers[5], int(numbers[6]))


def in_numbers(rule: Rule) -> FloatArray:
    """(7,) a rule as an array, which is handed over in less time than a named tuple."""
    return np.array(rule, dtype=np.float64)
