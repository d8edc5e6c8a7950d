"""Small runs that call all compiled functions of this plug-in, for the types of arguments that it has."""

from __future__ import annotations

from ...outlines.outline import Outline
from ...runs.small_runs import KNOT, SHAPES


def checks() -> None:
    """Checks of outlines."""
    from .check import check

    check(SHAPES)
    check(Outline("twice", contours=(KNOT, KNOT)))
