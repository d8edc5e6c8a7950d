"""Experiments as the paper makes them, on any character: variants and peers through one polygon, figures and tables.

Needs no other plug-in. In: outlines, or clicked points; out: sheets, tables and a page. Read first: :mod:`.api`.
"""

from __future__ import annotations

from ...hooks import Listed, Plugin

VARIANTS = tuple(f"variant {v}" for v in range(5))
"""Names of the variants; see Table 1 of the paper."""

PEERS = ("PIA", "splprep", "make_interp_spline", "centripetal")
"""Progressive iterative approximation, whose limit is variant 3's; and SciPy's periodic cubics, by chord lengths or,
the last one, their square roots."""

PLUGIN = Plugin(
    commands={
        "experiment": Listed(
            ".command:experiment",
            "Make the paper's figures and tables for any characters: variants side by side, and peers.",
        ),
    },
    services={"experiment": ".command:demonstrate"},
)
