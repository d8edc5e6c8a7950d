"""The compiled core against the plain reference, polygon by polygon: iteration counts and control points.

Where they may differ: rounding errors are not the same in both, and a run that does not converge carries them on from
step to step instead of shrinking them. Seen with near-duplicates (neighbours 1e-9 of the extent apart) under uniform
knots and in variant 0, where control points differ by some 3e-9 after 30 or 120 passes. Counts may differ by one where
an error falls within rounding of the tolerance. Such a case is told apart by asking the reference itself: it counts as
rounding if the reference moves by a hundredth as much, or by a pass, when the polygon's coordinates are changed in
their last bits.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))
from tests.agreement import TOLERANCE, compare, sensitivity
from tests.polygons import polygon


def check(number: int) -> tuple[str, int, float, int, bool]:
    """Kind, number, difference of the control points and of the iterations of a polygon; if any, is it rounding?"""
    kind, points = polygon(number, scale=2)
    found = compare(points, number)
    differs = found.iterations != 0 or not found.difference <= TOLERANCE
    if not differs:
        return kind, number, found.difference, 0, False
    moved, passes = sensitivity(points, number)
    rounding = found.difference <= max(TOLERANCE, 100 * moved) and abs(found.iterations) <= passes
    return kind, number, found.difference, found.iterations, rounding


def main() -> int:
    """Compare ``--count`` polygons; list those that differ; exit status 1 if any does."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=5000)
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()
    kinds: Counter[str] = Counter()
    worst: dict[str, float] = {}
    bad, rounded = 0, 0
    with ProcessPoolExecutor(arguments.jobs) as pool:
        for kind, number, difference, iterations, rounding in pool.map(check, range(arguments.count), chunksize=20):
            kinds[kind] += 1
            worst[kind] = max(worst.get(kind, 0.0), difference)
            if iterations or not difference <= TOLERANCE:
                bad, rounded = bad + (not rounding), rounded + rounding
                why = ", as the reference does from rounding" if rounding else ""
                print(f"{kind} {number}: control points differ by {difference:.1e}, iterations by {iterations}{why}")
    for kind, count in kinds.items():
        print(f"{kind:12} {count:5} polygons, control points within {worst[kind]:.1e} of the extent")
    print(f"{bad} of {arguments.count} differ, {rounded} more by rounding")
    return min(bad, 1)


if __name__ == "__main__":
    sys.exit(main())
