"""The command line: ``glyphspline convert``, the pipeline's other commands, and those of plug-ins.

In: words of a command line; out: runs, lines of text, an exit status. Read first: :mod:`.app`, then :mod:`.convert`.
"""

from __future__ import annotations

import gc


def main() -> None:
    """Run the command. Imports happen here because worker processes import this module again without needing them."""
    gc.disable()  # imports make no garbage; commands collect it from where they begin
    from . import app

    app.main()
