"""Readers: files to outlines."""

from .open import open_source
from .opentype.font import Font, open_font
from .selection import Selection
from .source import Source

__all__ = ["Font", "Selection", "Source", "open_font", "open_source"]
