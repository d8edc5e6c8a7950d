"""Tables of fonts: outlines in ``glyf`` and ``CFF``.

In: results; out: a font. Read first: :mod:`.font_file`.
"""
