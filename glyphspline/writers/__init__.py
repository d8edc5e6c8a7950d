"""Writers: from a :class:`~glyphspline.fitting.results.GlyphResult` to the content of files."""
