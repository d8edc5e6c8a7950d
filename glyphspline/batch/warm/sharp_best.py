"""Conversion to a tolerance, with corners, with the best effort."""

from ...fitting.options import Options
from . import converted

converted(Options(corners="sharp", effort="best"))
