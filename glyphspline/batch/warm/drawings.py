"""Curvature maps, and what the gallery shows."""

from ...fitting.options import Options
from ...fitting.results import as_glyph
from ...writers.svg.curvature_map import to_curvature_svg
from ...writers.svg.polygon_drawing import to_polygon_svg
from . import SHAPES, converted

to_curvature_svg(as_glyph(SHAPES))  # without a conversion: another process may be compiling that
to_curvature_svg(converted(Options(step=20.0)))
to_polygon_svg(converted(Options(step=20.0)))
