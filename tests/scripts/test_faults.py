"""Faults are planted where a program can go wrong, and nowhere else."""

from __future__ import annotations

import ast

from scripts.faults import Text, drawn, faults_of, rooms
from scripts.house import MODULES, room
from tests.places import ROOT

PROGRAM = '''
LIMIT = 3

def near(points, at: int = 7) -> "list[int]":
    """Of 5 points."""
    if not points or len(points) <= at:
        raise ValueError(f"{at + 1} points")
    found: "tuple[2]" = points[-1] * 0.5  # é
    return (found) - points[1:-2]
'''


def test_operators_signs_comparisons_bounds_and_constants_of_bodies_are_changed() -> None:
    text = PROGRAM.encode()
    found = list(Text("near.py", text).faults())
    changed = [(fault.line, fault.before, fault.after) for fault in found]
    assert sorted(changed) == [
        (6, "<=", "<"), (6, "not", ""), (6, "or", "and"),
        (8, "*", "/"), (8, "-", ""), (8, "0.5", "1.0"), (8, "1", "2"),
        (9, "-", ""), (9, "-", "+"), (9, "1", "2"), (9, "2", "3"),
    ]  # fmt: skip
    for fault in found:
        assert ast.dump(ast.parse(fault.planted(text))) != ast.dump(ast.parse(text))


def test_each_room_has_tests_and_faults_and_a_seed_draws_the_same() -> None:
    package = set(map(room, MODULES))
    assert rooms().keys() <= package
    assert {"interpolation", "plugins.checks"} <= rooms().keys()
    assert all((ROOT / test).exists() for tests in rooms().values() for test in tests)
    few = drawn(3, 1)
    assert few == drawn(3, 1) != drawn(3, 2)
    assert len({name for name, _ in few}) == 3
    assert all(fault in faults_of(name) for name, fault in few)
