"""Fitting to a tolerance in "smooth": a leaf of two cubics that meet in corners."""

from __future__ import annotations

from ...convert import convert
from ...glyph import Options
from ...outline import Outline
from ...writers.svg import to_svg
from . import LEAF, SQUARE

to_svg(convert(Outline("leaf", contours=(LEAF, SQUARE)), Options(corners="smooth")))
