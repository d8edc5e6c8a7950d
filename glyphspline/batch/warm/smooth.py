"""Conversion to a tolerance, smooth."""

from ...fitting.options import Options
from . import converted

converted(Options())
