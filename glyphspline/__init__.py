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
    from .datasets.dataset_run import dataset as dataset
    from .datasets.dataset_spec import DatasetSpec as DatasetSpec
    from .datasets.loading import Loaded as Loaded
    from .datasets.loading import load as load
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

_ON_DEMAND = {
    "Apart": ".comparing.difference",
    "AxisKinks": ".checks.kinks",
    "Contour": ".outlines.outline",
    "ContourResult": ".fitting.results",
    "DatasetSpec": ".datasets.dataset_spec",
    "DesignAxis": ".outlines.masters",
    "Difference": ".comparing.difference",
    "Finding": ".checks.finding",
    "Font": ".readers",
    "FontError": ".errors",
    "FontMetrics": ".outlines.outline",
    "GlyphResult": ".fitting.results",
    "GlyphsplineError": ".errors",
    "Interpolation": ".interpolation.api",
    "Kink": ".checks.kinks",
    "KinkReport": ".checks.kinks",
    "Layout": ".typesetting.placed",
    "Loaded": ".datasets.loading",
    "MasterContour": ".outlines.masters",
    "Masters": ".outlines.masters",
    "MastersContourResult": ".fitting.convert_masters",
    "MastersResult": ".fitting.convert_masters",
    "Measures": ".fitting.results",
    "OptionError": ".errors",
    "Options": ".fitting.options",
    "Outline": ".outlines.outline",
    "OutputError": ".errors",
    "Path": ".typesetting.path",
    "PolygonError": ".errors",
    "Spline": ".curves.bspline",
    "Thresholds": ".checks.kinds",
    "Turn": ".comparing.difference",
    "along": ".typesetting.along_path",
    "bend": ".typesetting.bent",
    "check": ".checks.check",
    "compare": ".comparing.compare",
    "convert": ".fitting.convert",
    "convert_many": ".fitting.convert",
    "convert_masters": ".fitting.convert_masters",
    "dataset": ".datasets.dataset_run",
    "interpolate": ".interpolation.api",
    "interpolate_many": ".interpolation.api",
    "interpolate_vertex": ".interpolation.api",
    "kinks": ".checks.kinks",
    "layout": ".typesetting.lay_out",
    "load": ".datasets.loading",
    "open_font": ".readers",
    "open_path": ".typesetting.path_file",
    "open_source": ".readers",
    "plot": ".notebook",
    "sample": ".outlines.sampling",
    "to_curvature_svg": ".writers.svg.curvature_map",
    "to_dxf": ".writers.dxf",
    "to_json": ".writers.json_file",
    "to_polylines": ".writers.polyline_files",
    "to_svg": ".writers.svg.document",
    "write_font": ".writers.font.font_file",
    "write_table": ".writers.parquet",
    "write_ufo": ".writers.ufo_folder",
}
"""Modules of the public names, imported on first use: a command or a worker imports what it needs and nothing else."""


def __getattr__(name: str) -> Any:
    if name not in _ON_DEMAND:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    import_module(".notebook", __name__).install()
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
