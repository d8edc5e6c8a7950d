"""SVG drawings and curvature maps.

In: a result; out: text. Read first: :mod:`.document`, then :mod:`.curvature_map`.
"""
