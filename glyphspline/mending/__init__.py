"""Outlines mended: the smallest moves of their points after which a check no longer finds what it found."""
