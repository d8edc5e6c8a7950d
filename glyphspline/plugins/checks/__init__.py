"""The command ``check``: what may be wrong with outlines as a font stores them. Nothing is fitted.

Needs no other plug-in. In: outlines; out: findings, tables, a page. Read first: :mod:`.check`.
"""

from __future__ import annotations

from ...hooks import Listed, Plugin

PLUGIN = Plugin(
    commands={
        "check": Listed(
            ".command:check",
            "Find what may be wrong with outlines as fonts have them: kinks, jumps of curvature, lumps and the like.",
        )
    },
    work={"checks": ".work:checks"},
)
