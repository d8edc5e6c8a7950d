"""Conversion by step."""

from ...fitting.options import Options
from . import converted

converted(Options(step=20.0))
