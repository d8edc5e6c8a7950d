"""The sharp mode: contours split at corners into lines and clamped splines.

In: cubics of contours; out: splines between corners, certified. Read first: :mod:`.sharp_fit`, then :mod:`.cutting`.
"""
