"""Writers: from a :class:`~glyphspline.fitting.results.GlyphResult` to the content of files.

In: a result and :class:`.Settings`; out: bytes or text. Read first: :mod:`.formats`.
"""
