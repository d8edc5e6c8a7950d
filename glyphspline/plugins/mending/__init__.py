"""The command ``mend``: the smallest moves of points after which a check no longer finds what it found.

Needs checks, fonts and masters. In: sources; out: the same, mended, and a page. Read first: :mod:`.mend`.
"""

from __future__ import annotations

from ...hooks import Listed, Plugin

PLUGIN = Plugin(
    commands={
        "mend": Listed(
            ".command:mend",
            "Mend what check finds in sources: points move as little as it takes, in all masters.",
        )
    },
    work={"mending": ".work:mending"},
)
