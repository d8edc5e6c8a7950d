"""Conversion to a tolerance, with corners."""

from ...fitting.options import Options
from . import converted

converted(Options(corners="sharp", tolerance=0.3))  # pieces fail the certificate
