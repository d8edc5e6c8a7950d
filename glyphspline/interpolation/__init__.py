"""Geometric interpolation of Xiong, Li and Mao (2012): from a polygon to a closed or clamped B-spline.

In: vertices; out: a :class:`.Spline` with footpoints and residuals. Read first: :mod:`.api`, and :mod:`.reference`, the
readable form.
"""
