"""Font glyph outlines as closed C2 B-splines, by the geometric interpolation of Xiong, Li and Mao (2012)."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from ._version import __version__

if TYPE_CHECKING:
    from .checks.check import check as check
    from .checks.finding import Finding as Finding
    from .checks.kinds import Thresholds as Thresholds
    from .checks.kinks import AxisKinks as AxisKinks
    from .checks.kinks import Kink as Kink
    from .checks.kinks import KinkReport as KinkReport
    from .checks.kinks import kinks as kinks
    from .comparing.compare import compare as compare
    from .comparing.difference import Apart as Apart
    from .comparing.difference import Difference as Difference
    from .comparing.difference import Turn as Turn
    from .curves.bspline import Spline as Spline
    from .datasets.load import Loaded as Loaded
    from .datasets.load import load as load
    from .datasets.run import dataset as dataset
    from .datasets.spec import DatasetSpec as DatasetSpec
    from .errors import FontError as FontError
    from .errors import GlyphsplineError as GlyphsplineError
    from .errors import OptionError as OptionError
    from .errors import OutputError as OutputError
    from .errors import PolygonError as PolygonError
    from .fitting.convert import convert as convert
    from .fitting.convert import convert_many as convert_many
    from .fitting.convert_masters import MastersContourResult as MastersContourResult
    from .fitting.convert_masters import MastersResult as MastersResult
    from .fitting.convert_masters import convert_masters as convert_masters
    from .fitting.options import Options as Options
    from .fitting.results import ContourResult as ContourResult
    from .fitting.results import GlyphResult as GlyphResult
    from .fitting.results import Measures as Measures
    from .interpolation.api import Interpolation as Interpolation
    from .interpolation.api import interpolate as interpolate
    from .interpolation.api import interpolate_many as interpolate_many
    from .interpolation.api import interpolate_vertex as interpolate_vertex
    from .mending.mend import mend as mend
    from .mending.state import Change as Change
    from .notebook import plot as plot
    from .outlines.masters import DesignAxis as DesignAxis
    from .outlines.masters import MasterContour as MasterContour
    from .outlines.masters import Masters as Masters
    from .outlines.outline import Contour as Contour
    from .outlines.outline import FontMetrics as FontMetrics
    from .outlines.outline import Outline as Outline
    from .outlines.sampling import sample as sample
    from .readers import Font as Font
    from .readers import open_font as open_font
    from .readers import open_source as open_source
    from .typesetting.along_path import along as along
    from .typesetting.bent import bend as bend
    from .typesetting.lay_out import layout as layout
    from .typesetting.path import Path as Path
    from .typesetting.path_file import open_path as open_path
    from .typesetting.placed import Layout as Layout
    from .writers.dxf import to_dxf as to_dxf
    from .writers.font.font_file import write_font as write_font
    from .writers.json_file import to_json as to_json
    from .writers.parquet import write_table as write_table
    from .writers.polyline_files import to_polylines as to_polylines
    from .writers.svg.curvature_map import to_curvature_svg as to_curvature_svg
    from .writers.svg.document import to_svg as to_svg
    from .writers.ufo_folder import write_ufo as write_ufo

_HOMES = {
    ".checks.check": "check",
    ".checks.finding": "Finding",
    ".checks.kinds": "Thresholds",
    ".checks.kinks": "AxisKinks Kink KinkReport kinks",
    ".comparing.compare": "compare",
    ".comparing.difference": "Apart Difference Turn",
    ".curves.bspline": "Spline",
    ".datasets.run": "dataset",
    ".datasets.spec": "DatasetSpec",
    ".datasets.load": "Loaded load",
    ".errors": "FontError GlyphsplineError OptionError OutputError PolygonError",
    ".fitting.convert": "convert convert_many",
    ".fitting.convert_masters": "MastersContourResult MastersResult convert_masters",
    ".fitting.options": "Options",
    ".fitting.results": "ContourResult GlyphResult Measures",
    ".interpolation.api": "Interpolation interpolate interpolate_many interpolate_vertex",
    ".mending.mend": "mend",
    ".mending.state": "Change",
    ".notebook": "plot",
    ".outlines.masters": "DesignAxis MasterContour Masters",
    ".outlines.outline": "Contour FontMetrics Outline",
    ".outlines.sampling": "sample",
    ".readers": "Font open_font open_source",
    ".typesetting.along_path": "along",
    ".typesetting.bent": "bend",
    ".typesetting.lay_out": "layout",
    ".typesetting.path": "Path",
    ".typesetting.path_file": "open_path",
    ".typesetting.placed": "Layout",
    ".writers.dxf": "to_dxf",
    ".writers.font.font_file": "write_font",
    ".writers.json_file": "to_json",
    ".writers.parquet": "write_table",
    ".writers.polyline_files": "to_polylines",
    ".writers.svg.curvature_map": "to_curvature_svg",
    ".writers.svg.document": "to_svg",
    ".writers.ufo_folder": "write_ufo",
}
"""The public names by module, imported on first use: a command or a worker imports what it needs and nothing else."""

_ON_DEMAND = {name: module for module, names in _HOMES.items() for name in names.split()}

__all__ = ["__version__", *_ON_DEMAND]


def __getattr__(name: str) -> Any:
    if name not in _ON_DEMAND:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    import_module(".notebook", __name__).install()
    value = getattr(import_module(_ON_DEMAND[name], __name__), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return __all__
