"""From a :class:`~glyphspline.glyph.GlyphResult` to what is written in a file; nothing here opens one."""
