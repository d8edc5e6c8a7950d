"""Outlines of a font: contours, their canonical order, sampling, joins and overlaps.

In: points and degrees of segments; out: contours, polygons. Read first: :mod:`.outline`.
"""
