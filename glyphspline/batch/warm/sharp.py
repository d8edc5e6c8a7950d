"""Conversion to a tolerance, with corners."""

from ...fitting.options import Options
from . import converted

converted(Options(corners="sharp"))
