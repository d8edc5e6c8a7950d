"""The interpolation of a polygon by itself, in all its kinds."""

import numpy as np

from ...interpolation.api import interpolate, interpolate_many, interpolate_vertex
from . import SQUARE

interpolate(SQUARE.points)
interpolate_many([SQUARE.points])
interpolate(SQUARE.points, closed=False, finish="solve")
interpolate(SQUARE.points, 4)
interpolate(SQUARE.points, degree=4)
interpolate(SQUARE.points, knots=np.arange(5.0))
interpolate_vertex(SQUARE.points, 0)
interpolate(np.eye(4), finish="solve")
