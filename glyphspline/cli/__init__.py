"""The command line: ``glyphspline convert | dataset | check | diff | atlas | info | report | view | demo | warm``."""

from __future__ import annotations

import gc


def main() -> None:
    """Run the command. Imports happen here because worker processes import this module again without needing them."""
    gc.disable()  # imports make no garbage; commands collect it from where they begin
    from . import app

    app.main()
