"""How a block of vertices lies in memory: ``LANES`` of them, two more at either end, one field after another.

The stride of a field is a constant, as that is what lets the compiler prove that fields do not overlap.
"""

from __future__ import annotations

LANES = 128
HALO = 2
STRIDE = 136
"""At least LANES + 2 HALO, and such that the fields of a lane fall into different sets of a cache."""

# What a vertex keeps from pass to pass: control point, vertex, rates and weights of lanes.py, interval and footpoint
# (relative to its knot), error p - C(t) and its square.
PX, PY, QX, QY, RATE, LAMBDA, MOVE_A, MOVE_B, HALF, THIRD, LOW, HIGH, X, EX, EY, DD = (k * STRIDE for k in range(16))
FIELDS = 16
