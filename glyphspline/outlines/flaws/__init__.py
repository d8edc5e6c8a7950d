"""What may be wrong at joints, in segments and in bends of an outline, and from which value each counts.

In: contours as arrays; out: rows of a table. Read first: :mod:`.kinds`, then :mod:`.joints`.
"""
