"""The shell: ``glyphspline convert | atlas | info | report | view | demo``."""

from .commands import app, main

__all__ = ["app", "main"]
