"""Conversion to a tolerance, with corners and cubics between them."""

from ...fitting.options import Options
from . import converted

converted(Options(corners="sharp", continuity="g1"))
