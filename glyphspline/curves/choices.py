"""Which splines there are: their degrees, and how their vertices get parameters.

What checks options imports this, and no NumPy with it: a command starts its workers before it imports libraries.
"""

from __future__ import annotations

from typing import Literal, TypeAlias

DEGREES = range(2, 7)
"""Degrees whose uniform basis functions rise above 1/2, as the method needs (end of the paper's Section 1)."""

Parametrisation: TypeAlias = Literal["chord", "uniform", "centripetal"]

CHORD_EXPONENT: dict[str, float] = {"chord": 1.0, "centripetal": 0.5, "uniform": 0.0}
