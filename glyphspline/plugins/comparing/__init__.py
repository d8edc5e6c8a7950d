"""The command ``diff``: two outlines of one glyph, how far they are from each other, and what came and went.

Needs no other plug-in. In: two sources; out: differences, a page. Read first: :mod:`.compare`.
"""

from __future__ import annotations

from ...hooks import Listed, Plugin

PLUGIN = Plugin(
    commands={
        "diff": Listed(
            ".command:diff",
            "Compare two fonts glyph by glyph: a certified distance of the outlines, advances, contours and kinks.",
        )
    },
    work={"comparing": ".work:comparisons"},
)
