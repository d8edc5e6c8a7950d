"""Unlike outlines made alike: contours paired, aligned and cut, so that they are masters of one glyph.

In: outlines; out: :class:`.Masters`. Read first: :mod:`.match`.
"""
