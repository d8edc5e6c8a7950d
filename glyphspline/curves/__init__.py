"""A curve as such: Bézier pieces, B-splines, plane cubics and what can be measured of them.

In: control points and knots; out: points, curvatures, crossings, certified distances. Read first: :mod:`.bspline`.
"""

DEGREES = range(2, 7)
"""Degrees of splines whose uniform basis functions rise above 1/2, as the method needs (end of the paper's Section 1).

They are here because a command checks its options before it imports NumPy.
"""
