"""How the ink of outlines differs: shapes of known areas, islands and counters, turned by any angle."""

from __future__ import annotations

import numpy as np
import pytest

from glyphspline.outlines.outline import Contour, Outline
from glyphspline.outlines.regions import InkDifference, ink_difference

ANGLES = (0.0, 1e-6, 0.1, 0.7, np.pi / 4, 2.0)

TURNED = pytest.mark.parametrize("angle", ANGLES)


def box(x: float, y: float, width: float, height: float, turn: int = 1) -> Contour:
    """Counter-clockwise, or clockwise for ``turn`` -1."""
    corners = np.array([(x, y), (x + width, y), (x + width, y + height), (x, y + height)], dtype=np.float64)
    return Contour(corners[::turn], np.ones(4, dtype=np.int64))


RING = [box(0, 0, 100, 100), box(20, 20, 20, 20, -1)]


def difference(before: list[Contour], after: list[Contour], angle: float) -> InkDifference:
    way = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    both = [[Contour(each.points @ way, each.degrees) for each in contours] for contours in (before, after)]
    one, other = (Outline("a", contours=each).arrays for each in both)
    return ink_difference(one, other, 0.02)


@TURNED
@pytest.mark.parametrize(
    ("before", "after", "area", "lost", "gained"),
    [
        pytest.param([], RING, 9600, 0, 2, id="from nothing"),
        pytest.param(RING, [box(0, 0, 100, 100), box(20, 20, 20, 20)], 400, 1, 0, id="a counter filled"),
        pytest.param(RING, [RING[0], box(21, 20, 20, 20, -1)], 40, 0, 0, id="a counter moved"),
        pytest.param(RING, [RING[0], box(60, 60, 20, 20, -1)], 800, 1, 1, id="a counter elsewhere"),
        pytest.param(RING, [RING[0], box(-5, 20, 45, 20, -1)], 500, 0, 1, id="a counter that pokes out"),
        pytest.param(RING, [*RING, box(25, 25, 5, 5)], 25, 0, 1, id="an island in a counter"),
        pytest.param(RING, [*RING, box(100, 10, 30, 30)], 900, 0, 0, id="one that abuts"),
        pytest.param(RING, [*RING, box(101, 10, 30, 30)], 900, 0, 1, id="one beside it"),
        pytest.param(RING, [*RING, box(50, 50, 20, 20)], 0, 0, 0, id="a patch on ink"),
        pytest.param(RING, [*RING, box(100, 100, 20, 20)], 400, 0, 1, id="corner to corner"),
        pytest.param(RING, [each.reversed() for each in RING], 0, 0, 0, id="turned round"),
        pytest.param([box(0, 0, 40, 40), box(30, 0, 40, 40)], [box(0, 0, 70, 40)], 0, 0, 0, id="an overlap gone"),
        pytest.param([RING[0], box(70, 0, 60, 90)], [RING[0], box(70, 0, 60, 90, -1)], 2700, 0, 1, id="cut in two"),
    ],
)  # fmt: skip
def test_areas_islands_and_counters_that_differ(
    before: list[Contour], after: list[Contour], area: float, lost: int, gained: int, angle: float
) -> None:
    found = difference(before, after, angle)
    assert (found.lost, found.gained) == (lost, gained)
    assert found.area == pytest.approx(area, rel=1e-6, abs=1e-3)
    back = difference(after, before, angle)
    assert (back.lost, back.gained) == (gained, lost)
    assert back.area == pytest.approx(area, rel=1e-6, abs=1e-3)
