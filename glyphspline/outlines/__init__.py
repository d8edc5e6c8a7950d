"""Outlines of a font: contours, their canonical order, sampling, joins and overlaps."""
