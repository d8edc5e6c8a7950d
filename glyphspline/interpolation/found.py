"""What the compiled driver reads of a method, and writes of many polygons."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..compiled import inlined
from ..types import FloatArray, IntArray


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
    """The rule that is in :attr:`.Method.numbers`."""
    return Rule(numbers[0] > 0.0, int(numbers[1]), numbers[2], numbers[3], numbers[4], numbers[5], int(numbers[6]))


class Found(NamedTuple):
    """Results for K polygons with N vertices, which the compiled driver writes; parts as the polygons' ``offsets``.

    Of polygon k the knots begin at its offset, plus k if closed; its control points at its offset, plus 2 k if open.
    Where duplicates were merged, or a polygon was refused, the rest of its part is undefined.

    Attributes:
        knots, controls, parameters, bounds: as :class:`.Interpolation` has them.
        kept: indices of the vertices that were not merged.
        whole: (K, 6) status (0 fine, 1 bad polygon, 2 bad knots), vertices kept, iterations, fallbacks, the
            footpoints that took a full search, and those that are not certified.
        rates, tolerances: (K,) rate bounds, and residual tolerances.
    """

    knots: FloatArray
    controls: FloatArray
    parameters: FloatArray
    bounds: FloatArray
    kept: IntArray
    whole: IntArray
    rates: FloatArray
    tolerances: FloatArray


def room_for(total: int, count: int, closed: bool, d: int) -> tuple[FloatArray, IntArray]:
    """The two arrays in which :func:`laid_out` finds a :class:`Found`: they are made and handed over in less time."""
    numbers = total * (d + 4) + count * (3 if closed else 2 + 2 * d)
    return np.empty(numbers), np.empty(total + 6 * count, np.int64)


@inlined
def laid_out(numbers: FloatArray, whole: IntArray, total: int, count: int, closed: bool, d: int) -> Found:
    """Results for ``count`` polygons with ``total`` vertices in R^d, as views of arrays of :func:`room_for`."""
    more, ends = total + count if closed else total, total if closed else total + 2 * count
    a, b, c = 2 * count, 2 * count + more, 2 * count + more + total
    return Found(
        numbers[a:b], numbers[c + 2 * total :].reshape((ends, d)), numbers[b:c],
        numbers[c : c + 2 * total].reshape((total, 2)), whole[6 * count :], whole[: 6 * count].reshape((count, 6)),
        numbers[:count], numbers[count:a],
    )  # fmt: skip
