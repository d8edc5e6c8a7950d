"""Curvature of a glyph along an axis of a variable font: how far smooth joints turn, and how much energy arcs have."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..curves.integrals import integrals
from ..errors import GlyphsplineError
from ..outlines.masters import DesignAxis, Masters
from ..outlines.outline import Outline
from ..outlines.sampling import CORNER_ANGLE
from ..types import FloatArray
from .kinks import AxisKinks, Kink, kinks_along
from .turns import LEAST


@dataclass(frozen=True, eq=False)
class AlongAxis:
    """Curvature of one glyph along one axis.

    Attributes:
        masters: the glyph. location: user-space values of the other axes.
        found: its smooth joints; see :func:`.kinks.kinks`.
        energies: (v,) bending energy of the arcs, in 1/em, at the values of the axis; infinite at a cusp.
    """

    masters: Masters
    location: Mapping[str, float]
    found: AxisKinks
    energies: FloatArray

    @property
    def axis(self) -> DesignAxis:
        """Which axis."""
        return self.found.axis

    @property
    def values(self) -> FloatArray:
        """(v,) user-space values of the axis, ascending: even steps, and where joints turn most."""
        values: FloatArray = self.found.profile[:, 0]
        return values

    @property
    def turns(self) -> FloatArray:
        """(v,) the largest turn of a smooth joint there, in degrees."""
        turns: FloatArray = self.found.profile[:, 1]
        return turns

    @property
    def worst(self) -> Kink | None:
        """The joint that turns most along the axis; None if no joint is smooth."""
        return self.found[0] if len(self.found) else None

    def instance(self, value: float) -> Outline:
        """The glyph at a user-space value of the axis."""
        return self.masters.instance({**self.location, self.axis.tag: value})


def along_axis(
    masters: Masters, tag: str, location: Mapping[str, float] | None = None, *, corner_angle: float = CORNER_ANGLE
) -> AlongAxis:
    """Measure a glyph along an axis. Nothing is fitted.

    Args:
        masters: the glyph. tag: of the axis. location: user-space values of the other axes; without it, their defaults.
        corner_angle: degrees of turn from which a joint is a corner.

    Raises:
        GlyphsplineError: there is no such axis.
    """
    location = location or {}
    chosen = [k for k, axis in enumerate(masters.axes) if axis.tag == tag]
    if not chosen:
        raise GlyphsplineError(f"no axis {tag!r}", glyph=masters.name)
    (found,) = kinks_along([masters], masters.axes, location, chosen, corner_angle)
    at = np.array([masters.normalised({**location, tag: float(value)}) for value in found.profile[:, 0]])
    weights = masters.weights_at(at)
    energies = np.zeros(len(at))
    for contour in masters.contours:
        arcs = contour.cubics()[:, contour.degrees > 1]
        for k, cubics in enumerate(np.tensordot(weights, arcs, axes=1)):
            lasts = np.abs(cubics - cubics[:, :1]).max(axis=(1, 2)) > LEAST  # it may have a length elsewhere only
            energies[k] += integrals(cubics[lasts])[1]
    return AlongAxis(masters, location, found, energies * masters.metrics.units_per_em)


def places_along(along: AlongAxis, count: int) -> list[float]:
    """Values of the axis at which to look: its masters, where the glyph's worst joint turns most, and between.

    Args:
        along: of the source. count: of values; of more masters, some are left out evenly.

    Returns:
        User-space values, ascending.
    """
    worst = along.worst
    values = sorted({*along.found.positions, along.axis.minimum, along.axis.maximum})
    if worst is not None and worst.turn > 0:
        values = sorted({*values, worst.location[worst.axis]})
    if len(values) > count:
        return [values[round(k)] for k in np.linspace(0, len(values) - 1, count)]
    while 1 < len(values) < count:
        gaps = np.diff(values)
        k = int(gaps.argmax())
        if not gaps[k] > 0:
            break
        values.insert(k + 1, (values[k] + values[k + 1]) / 2)
    return values
