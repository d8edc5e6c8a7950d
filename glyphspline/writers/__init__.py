"""From a :class:`~glyphspline.fitting.results.GlyphResult` to what is written in a file; nothing here opens one."""
