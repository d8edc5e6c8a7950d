"""Outlines put back into fonts and sources: fits as fonts store them, and writers of tables, UFO and Glyphs files.

Needs no other plug-in. In: results, or outlines; out: fonts and sources. Read first: :mod:`.fit.fit`.
"""

from __future__ import annotations

from ...hooks import Plugin

PLUGIN = Plugin(
    work={"g2": ".work:outlines", "quadratics": ".work:quadratics"},
)
