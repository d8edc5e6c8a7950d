"""Files in, outlines out."""

from .fonts import Font, open_font
from .opening import AnySource, open_source
from .selection import Selection
from .source import Source
from .tables import Axis

__all__ = ["AnySource", "Axis", "Font", "Selection", "Source", "open_font", "open_source"]
