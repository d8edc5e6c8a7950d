"""What ``check`` needs."""

from ...checks.check import check
from . import SHAPES

check(SHAPES)
