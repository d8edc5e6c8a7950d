"""SVG drawings as sources, each file a glyph; and drawings whose paths are rewritten.

Needs no other plug-in. In: SVG files; out: outlines, and SVG files. Read first: :mod:`.svg`.
"""

from __future__ import annotations

from ...hooks import Plugin

PLUGIN = Plugin(
    readers={"drawings": ".svg:READER"},
    work={"distances": ".work:distances"},
    services={"refit_drawings": ".job:refit_drawings"},
)
