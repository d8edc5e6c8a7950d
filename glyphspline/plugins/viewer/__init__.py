"""Ways to look: the live page of ``view``, the PDF of ``atlas``, and results in notebooks.

Needs no other plug-in. In: a source; out: pages. Read first: :mod:`.app`.
"""

from __future__ import annotations

from ...hooks import Listed, Plugin

PLUGIN = Plugin(
    commands={
        "atlas": Listed(
            ".command:atlas",
            "Draw the curvature of many glyphs as a PDF: combs on one scale, and κ(s) of chosen contours.",
        ),
        "view": Listed(
            ".command:view",
            "Look at a font live: a page, for this machine only, on which sliders move and curves follow.",
        ),
    },
    services={"notebook": ".notebook:install"},
)
