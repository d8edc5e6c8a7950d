"""The formats, as runs and texts write them."""

from __future__ import annotations

from ...writers.formats import Format
from .dxf import write
from .polyline_files import polyline_csv, polyline_json

POLYLINE = Format("polyline", ".json", polyline_json)
POLYLINE_CSV = Format("polyline-csv", ".csv", polyline_csv)
DXF = Format("dxf", ".dxf", write, extra="cad")
