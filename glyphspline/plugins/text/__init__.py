"""The command ``text``: text shaped, broken into lines, and put in place, as drawings.

Needs no other plug-in. In: a source and a text; out: a layout, a drawing. Read first: :mod:`.lay_out`.
"""

from __future__ import annotations

from ...hooks import Listed, Plugin

PLUGIN = Plugin(
    commands={
        "text": Listed(
            ".command:text", "Set a text: shaped by HarfBuzz, on one line or several, as SVG, DXF and other drawings."
        )
    },
    services={"layout": ".lay_out:layout", "text_document": ".drawing:text_document"},
)
