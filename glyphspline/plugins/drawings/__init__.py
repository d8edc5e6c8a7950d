"""SVG drawings as sources: each file a glyph.

Needs no other plug-in. In: SVG files; out: outlines. Read first: :mod:`.svg`.
"""

from __future__ import annotations

from ...hooks import Plugin

PLUGIN = Plugin(
    readers={"drawings": ".svg:READER"},
)
