"""Small runs that call all compiled functions of this plug-in, for the types of arguments that it has."""

from __future__ import annotations

from ...outlines.outline import Contour, Outline
from ...runs.small_runs import DISC, LEAF, SHAPES, SQUARE


def comparisons() -> None:
    """Outlines compared: one that lacks a contour, one with a contour turned round, so that it has other ink."""
    from .compare import compare

    compare(SHAPES, Outline("shapes", contours=(LEAF.reversed(), SQUARE, DISC)))
    ring, filled = ((DISC, Contour(0.5 * inner.points, inner.degrees)) for inner in (DISC.reversed(), DISC))
    compare(Outline("ring", contours=ring), Outline("filled", contours=filled))
