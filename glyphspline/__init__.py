"""Font glyph outlines as closed C2 B-splines, by the geometric interpolation of Xiong, Li and Mao (2012)."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from . import notebook as display
from ._version import __version__
from .checks.axis_kinks import AxisKinks, Kink, KinkReport, kinks
from .checks.check import check
from .checks.finding import Finding
from .checks.kinds import Thresholds
from .comparing.compare import compare
from .comparing.difference import Apart, Difference, Turn
from .curves.bspline import Spline
from .dataset.dataset_spec import DatasetSpec
from .errors import FontError, GlyphsplineError, OptionError, OutputError, PolygonError
from .fitting.convert import convert, convert_many
from .fitting.convert_masters import MastersContourResult, MastersResult, convert_masters
from .fitting.options import Options
from .fitting.results import ContourResult, GlyphResult, Measures
from .interpolation.api import Interpolation, interpolate, interpolate_many, interpolate_vertex
from .layout.lay_out import layout
from .notebook import plot
from .outlines.masters import DesignAxis, MasterContour, Masters
from .outlines.outline import Contour, FontMetrics, Outline
from .outlines.sampling import sample

display.install()
globals().pop("dataset")  # the package of that name: the attribute is the function, imported on demand

if TYPE_CHECKING:
    from .dataset.dataset_run import dataset as dataset
    from .dataset.loading import Loaded as Loaded
    from .dataset.loading import load as load
    from .layout.along_path import along as along
    from .layout.bent import bend as bend
    from .layout.path import Path as Path
    from .layout.path_file import open_path as open_path
    from .layout.placed import Layout as Layout
    from .readers import Font as Font
    from .readers import open_font as open_font
    from .readers import open_source as open_source
    from .writers.dxf import to_dxf as to_dxf
    from .writers.font.font_file import write_font as write_font
    from .writers.json_file import to_json as to_json
    from .writers.parquet import write_table as write_table
    from .writers.polyline_files import to_polylines as to_polylines
    from .writers.svg.curvature_map import to_curvature_svg as to_curvature_svg
    from .writers.svg.document import to_svg as to_svg
    from .writers.ufo_folder import write_ufo as write_ufo

_ON_DEMAND = {
    "Font": ".readers",
    "Layout": ".layout.placed",
    "Loaded": ".dataset.loading",
    "Path": ".layout.path",
    "along": ".layout.along_path",
    "bend": ".layout.bent",
    "dataset": ".dataset.dataset_run",
    "load": ".dataset.loading",
    "open_path": ".layout.path_file",
    "open_font": ".readers",
    "open_source": ".readers",
    "to_curvature_svg": ".writers.svg.curvature_map",
    "to_dxf": ".writers.dxf",
    "to_json": ".writers.json_file",
    "to_polylines": ".writers.polyline_files",
    "to_svg": ".writers.svg.document",
    "write_font": ".writers.font.font_file",
    "write_table": ".writers.parquet",
    "write_ufo": ".writers.ufo_folder",
}
"""Names whose modules import font or drawing libraries; the curve core does not need those."""


def __getattr__(name: str) -> Any:
    if name not in _ON_DEMAND:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(_ON_DEMAND[name], __name__), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return __all__


__all__ = [
    "Apart",
    "AxisKinks",
    "Contour",
    "ContourResult",
    "DatasetSpec",
    "DesignAxis",
    "Difference",
    "Finding",
    "Font",
    "FontError",
    "FontMetrics",
    "GlyphResult",
    "GlyphsplineError",
    "Interpolation",
    "Kink",
    "KinkReport",
    "Layout",
    "Loaded",
    "MasterContour",
    "Masters",
    "MastersContourResult",
    "MastersResult",
    "Measures",
    "OptionError",
    "Options",
    "Outline",
    "OutputError",
    "Path",
    "PolygonError",
    "Spline",
    "Thresholds",
    "Turn",
    "__version__",
    "along",
    "bend",
    "check",
    "compare",
    "convert",
    "convert_many",
    "convert_masters",
    "dataset",
    "interpolate",
    "interpolate_many",
    "interpolate_vertex",
    "kinks",
    "layout",
    "load",
    "open_font",
    "open_path",
    "open_source",
    "plot",
    "sample",
    "to_curvature_svg",
    "to_dxf",
    "to_json",
    "to_polylines",
    "to_svg",
    "write_font",
    "write_table",
    "write_ufo",
]
