"""Outlines as fonts store them: cubics and quadratics on the grid, G2 where their source is smooth.

In: contours; out: curves that a font stores, certified. Read first: :mod:`.fit`.
"""
