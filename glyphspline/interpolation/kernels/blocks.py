"""How a block of vertices lies in memory: ``LANES`` of them, two more at either end, one field after another.

The stride of a field is a constant, as that is what lets the compiler prove that fields do not overlap.

A block is a long polygon's share of consecutive vertices or holds several short ones, *side by side*: vertex i of the
k-th of ``step`` polygons is at lane (2 + i) step + k, so that the neighbours of a vertex are ``step`` lanes away and
loops over lanes are long whatever the polygons are. With step 1 that is the block of a single polygon. The first vertex
is at lane 2 step, ``first``, which says what kind of block it is.
"""

from __future__ import annotations

LANES = 128
HALO = 2
STRIDE = 136
"""At least LANES + 2 HALO, and such that the fields of a lane fall into different sets of a cache."""

SHORT, LESS_SHORT = STRIDE // 8 - 2 * HALO, STRIDE // 4 - 2 * HALO
"""The most vertices of a polygon of which 8, or 4, fit into a block side by side."""

# What a vertex keeps from pass to pass: control point, vertex, rates and weights of lanes.py, interval and footpoint
# (relative to its knot), error p - C(t) and its square.
PX, PY, QX, QY, RATE, LAMBDA, MOVE_A, MOVE_B, HALF, THIRD, LOW, HIGH, X, EX, EY, DD = (k * STRIDE for k in range(16))
FIELDS = 16
BLOCK = FIELDS * STRIDE
SCRATCH = 21
"""Fields of the scratch block, of which ``lemma2`` needs the most."""
