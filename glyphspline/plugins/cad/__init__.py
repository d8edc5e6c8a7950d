"""Formats for machines: DXF with one spline a contour, and polylines as JSON and CSV.

Needs no other plug-in. In: results; out: files. Read first: :mod:`.dxf`.
"""

from __future__ import annotations

from ...hooks import Plugin

PLUGIN = Plugin(
    formats={
        "polyline": ".formats:POLYLINE",
        "polyline-csv": ".formats:POLYLINE_CSV",
        "dxf": ".formats:DXF",
    },
)
