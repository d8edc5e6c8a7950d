"""From an outline to a :class:`~glyphspline.fitting.results.GlyphResult`."""
