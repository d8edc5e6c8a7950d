"""The smooth fit: closed C2 curves within a tolerance.

In: cubics of contours; out: closed splines, certified. Read first: :mod:`.smooth_fit`.
"""
