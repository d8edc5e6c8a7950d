"""From an outline to a result: contours fitted by tolerance, step or count, and measured.

In: an :class:`.Outline` and :class:`.Options`; out: a :class:`.GlyphResult`. Read first: :mod:`.convert`.
"""
