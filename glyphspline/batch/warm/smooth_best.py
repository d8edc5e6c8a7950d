"""Conversion to a tolerance, smooth, with the best effort."""

from ...fitting.options import Options
from . import converted

converted(Options(corners="smooth", effort="best"))
