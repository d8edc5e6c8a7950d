"""What people are told of the measures: a label, a unit and a sentence each, and curvature in units of the em."""

from __future__ import annotations

from typing import Any, NamedTuple

from .results import MEASURES

PER_EM = "1/em"
"""Unit of all curvature that people look at: a measure in 1/unit, times the units per em."""


class Quantity(NamedTuple):
    """A measure as it is shown; ``unit`` is "" for numbers without any."""

    label: str
    unit: str
    about: str


QUANTITIES = {
    "vertices": Quantity("vertices", "", "points of the outline that the curve passes through"),
    "segments": Quantity("segments", "", "Bézier segments of the result"),
    "numbers": Quantity("numbers to store", "", "coordinates that a file of splines stores"),
    "iterations": Quantity("iterations", "", "updates until the curve passes through all vertices"),
    "residual": Quantity("residual", "units", "largest distance left between a vertex and its footpoint on the curve"),
    "converged": Quantity("converged", "", "whether the residual is below the solver's tolerance"),
    "rate_bound": Quantity("rate bound", "", "certified factor by which the largest error shrinks at every step"),
    "fallbacks": Quantity("fallbacks", "", "vertices for which Lemma 2 has no interval"),
    "deviation": Quantity("deviation", "units", "largest distance seen between paired points of result and source"),
    "deviation_bound": Quantity("deviation, certified", "units", "bound that the distance is proven to be within"),
    "within_tolerance": Quantity("within tolerance", "", "whether that bound is within the tolerance asked for"),
    "overshoot": Quantity("overshoot", "units", "largest distance of the curve outside the hull of its polygon"),
    "length": Quantity("length", "units", "arc length of the result"),
    "area_change": Quantity("change of area", "units²", "area of the result less that of the source"),
    "bending_energy": Quantity("bending energy", PER_EM, "integral of squared curvature: less is rounder"),
    "max_curvature": Quantity("largest curvature", PER_EM, "of the sharpest bend: 1/radius, with the em as the unit"),
    "curvature_extrema": Quantity("curvature extrema", "", "where curvature peaks between corners; an ellipse has 4"),
    "source_curvature_extrema": Quantity("curvature extrema, source", "", "the same of the source outline"),
    "new_crossings": Quantity(
        "new crossings", "", "crossings of contours, with themselves and others, beyond the source's"
    ),
    "collapsed": Quantity("collapsed", "", "whether a contour has lost its area, or runs the other way round"),
    "source_kept": Quantity(
        "source kept", "", "whether a contour is the source's own, as every fit crosses or collapses"
    ),
}
"""By the name of the measure, in the order of :class:`.results.Measures`. Lengths are in font units."""

assert tuple(QUANTITIES) == MEASURES


def shown(name: str, value: Any, units_per_em: float) -> Any:
    """A measure's value in the unit that is shown; None stays None."""
    return value * units_per_em if value is not None and QUANTITIES[name].unit == PER_EM else value
