"""Outlines put back into fonts and sources: fits as fonts store them, and writers of tables and UFOs.

Needs no other plug-in. In: results, or outlines; out: fonts and sources. Read first: :mod:`.fit.fit`.
"""

from __future__ import annotations

from ...hooks import Listed, Plugin

PLUGIN = Plugin(
    commands={
        "refit": Listed(
            ".command:refit",
            "Put fitted outlines back into fonts, sources and drawings: the fewest points, smooth to the curvature.",
        )
    },
    whole={"otf": ".formats:OTF", "ttf": ".formats:TTF", "ufo": ".formats:UFO"},
    services={"g2_fits": ".fit.fit:font_fits"},
    work={"g2": ".work:outlines", "quadratics": ".work:quadratics"},
)
