"""Curvature maps, and the source drawings beside them: those of a leaf of two cubics."""

from __future__ import annotations

from ...fitting.convert import convert
from ...fitting.options import Options
from ...outlines.outline import Outline
from ...writers.svg.curvature_map import to_curvature_svg
from ...writers.svg.source_drawing import to_source_svg
from . import LEAF

leaf = convert(Outline("leaf", contours=(LEAF,)), Options(step=20.0))
to_curvature_svg(leaf)
to_source_svg(leaf)
