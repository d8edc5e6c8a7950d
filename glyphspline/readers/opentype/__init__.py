"""TrueType and OpenType fonts, through HarfBuzz and fontTools.

In: bytes of a font; out: outlines at a location. Read first: :mod:`.font`.
"""
