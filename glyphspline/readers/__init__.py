"""Readers: files to outlines, and characters to glyphs.

In: fonts and sources; out: :class:`.Outline`, by name, index or character. Read first:
:mod:`.source`, then :mod:`.open`.
"""

from .open import open_source
from .opentype.font import Font, open_font
from .selection import Selection
from .source import Source

__all__ = ["Font", "Selection", "Source", "open_font", "open_source"]
