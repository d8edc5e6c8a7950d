"""Data sets: the glyphs of many fonts as one table of curves and points."""
