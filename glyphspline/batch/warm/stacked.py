"""Masters as one curve, with arcs that fail the certificate at first and one that ends on a slanted line."""

import numpy as np

from ...fitting.convert_masters import convert_masters
from ...fitting.options import Options
from ...outlines.masters import DesignAxis, MasterContour, Masters
from . import DISC

REGIONS = np.array([[[0.0, 1.0, 1.0]]])
AXES = (DesignAxis("wght", "Weight", 0, 0, 1),)

BOW = np.array([[100, 0], [100, 500], [100, 700], [500, 650], [500, 400], [500, 0]], dtype=np.float64)
BOLD = np.array([[100, 0], [220, 500], [250, 625], [500, 650], [500, 300], [500, 0]], dtype=np.float64)

ROUND = MasterContour(np.stack([DISC.points * 3, DISC.points[:, ::-1] * [2.0, -5.0]]), DISC.degrees)
SLANTED = MasterContour(np.stack([BOW, BOLD]), np.array([1, 3, 1, 1]))

masters = Masters("shapes", axes=AXES, regions=REGIONS, contours=(ROUND, SLANTED), advances=np.ones(2))
result = convert_masters(masters, Options(corners="sharp", tolerance=0.3))
result.energy_ratio({"wght": 0.5})
result.turn({"wght": 0.5})
