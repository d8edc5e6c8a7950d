"""Fitting to a tolerance in "smooth": a leaf of two cubics that meet in corners."""

from __future__ import annotations

from ...fitting.convert import convert
from ...fitting.options import Options
from ...outlines.outline import Outline
from ...writers.svg.document import to_svg
from . import LEAF, SQUARE

to_svg(convert(Outline("leaf", contours=(LEAF, SQUARE)), Options(corners="smooth")))
