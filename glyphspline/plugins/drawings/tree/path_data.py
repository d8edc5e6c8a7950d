"""Path data: subpaths of lines, quadratics and cubics, up to the first error, as browsers draw them."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np

Point: TypeAlias = tuple[float, float]

ARC = 45.0
"""Degrees of an elliptic arc that become one cubic, with an error of 4e-6 of the radius."""

NUMBER = re.compile(r"[ \t\r\n\f]*,?[ \t\r\n\f]*([+-]?+(?:[0-9]*+\.[0-9]++|[0-9]++(?!\.))(?:[eE][+-]?[0-9]+)?+)")
FLAG = re.compile(r"[ \t\r\n\f]*,?[ \t\r\n\f]*([01])")
COMMAND = re.compile(r"[ \t\r\n\f]*([MmZzLlHhVvCcSsQqTtAa])")
END = re.compile(r"[ \t\r\n\f]*$")

ARGUMENTS = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7}
FLAGS = (3, 4)
"""Which of the numbers of an arc are flags, a character each."""


@dataclass
class Subpath:
    """A start, and the points that each segment of degree 1, 2 or 3 adds; closed or open.

    ``written``: how many segments were written, with a line that closes it: an arc may be several cubics.
    """

    points: list[Point]
    degrees: list[int] = field(default_factory=list)
    closed: bool = False
    written: int = 0


Path: TypeAlias = list[Subpath]


class DrawnPath:
    """A path as it is drawn."""

    def __init__(self) -> None:
        self.path: Path = []
        self.here = self._start = (0.0, 0.0)
        self._is_open = False

    def move(self, to: Point) -> None:
        """Begin a subpath."""
        self.path.append(Subpath([to]))
        self.here, self._start, self._is_open = to, to, True

    def add(self, *to: Point) -> None:
        """Add a segment by its further points; after a closed subpath another one begins where that did."""
        if not self._is_open:
            self.move(self.here)
        last = self.path[-1]
        last.points.extend(to)
        last.degrees.append(len(to))
        last.written += 1
        self.here = to[-1]

    def arc(self, rx: float, ry: float, turn: float, large: bool, sweep: bool, to: Point) -> None:
        """Add an elliptic arc, which is a line without a radius, and nothing without a length."""
        rx, ry = abs(rx), abs(ry)
        if to == self.here:
            return
        if not (rx and ry):
            self.add(to)
            return
        from svgpathtools import Arc  # imports SciPy, which most drawings do not need

        try:
            with np.errstate(all="ignore"):
                arc = Arc(complex(*self.here), complex(rx, ry), turn, large, sweep, complex(*to))
                cubics = [[(p.real, p.imag) for p in map(complex, each)] for each in arc_cubics(arc)]
        except (ArithmeticError, ValueError, AssertionError):
            cubics = []
        if not cubics or not np.isfinite(cubics).all():
            self.add(to)  # too flat or too far for doubles
            return
        cubics[-1][-1] = to
        for each in cubics:
            self.add(*each)
        self.path[-1].written -= len(cubics) - 1

    def close(self) -> None:
        """End a subpath where it began."""
        if self._is_open:
            self.path[-1].closed = True
            self.path[-1].written += self.here != self._start
        self.here, self._is_open = self._start, False


def arc_cubics(arc: Any) -> Iterator[list[complex]]:
    """The three points that each cubic of an elliptic arc adds."""
    pieces = max(1, int(np.ceil(abs(arc.delta) / ARC)))
    handle = 4 / 3 * np.tan(np.radians(arc.delta) / pieces / 4) / np.radians(arc.delta)
    for k in range(pieces):
        t0, t1 = k / pieces, (k + 1) / pieces
        start, end = arc.point(t0), arc.point(t1)
        yield [start + handle * arc.derivative(t0), end - handle * arc.derivative(t1), end]


def parsed_path(data: str) -> tuple[Path, int | None]:
    """The subpaths of path data up to the first error, and at which character that is; None without one."""
    drawn, at, command = DrawnPath(), 0, ""
    control: tuple[int, Point] = (0, (0.0, 0.0))  # degree and last control point of the segment before
    while not END.match(data, at):
        if found := COMMAND.match(data, at):
            command, at = found[1], found.end()
            if not drawn.path and command not in "Mm":
                return drawn.path, found.start(1)
            if command in "Zz":
                drawn.close()
                control = (0, drawn.here)
                continue
        elif command in ("", "Z", "z"):
            return drawn.path, at
        numbers, end = _arguments(data, at, command.upper())
        if numbers is None:
            return drawn.path, end
        at = end
        control = _segment(drawn, command, numbers, control)
        command = {"M": "L", "m": "l"}.get(command, command)
    return drawn.path, None


def _arguments(data: str, at: int, command: str) -> tuple[list[float] | None, int]:
    """The numbers of a segment and where they end; None if there are not so many."""
    numbers = list[float]()
    for k in range(ARGUMENTS[command]):
        found = (FLAG if command == "A" and k in FLAGS else NUMBER).match(data, at)
        if found is None or (data[at - 1].isalpha() and "," in data[at : found.start(1)]):
            return None, at
        value = float(found[1])
        if not math.isfinite(value):
            return None, at
        numbers.append(value)
        at = found.end()
    return numbers, at


def _segment(drawn: DrawnPath, command: str, numbers: list[float], control: tuple[int, Point]) -> tuple[int, Point]:
    """Draw a segment; returns its degree and last control point, if it is a quadratic or cubic."""
    kind, (x, y) = command.upper(), drawn.here
    dx, dy = (x, y) if command.islower() else (0.0, 0.0)
    if kind == "A":
        rx, ry, turn, large, sweep, *_ = numbers
        drawn.arc(rx, ry, turn, bool(large), bool(sweep), (numbers[5] + dx, numbers[6] + dy))
        return 0, drawn.here
    if kind in "HV":
        drawn.add((numbers[0] + dx, y) if kind == "H" else (x, numbers[0] + dy))
        return 0, drawn.here
    points = [(a + dx, b + dy) for a, b in zip(numbers[::2], numbers[1::2], strict=True)]
    if kind == "M":
        drawn.move(points[0])
        return 0, drawn.here
    if kind in "ST":
        degree, (a, b) = control
        mirrored = (2 * x - a, 2 * y - b) if degree == (3 if kind == "S" else 2) else (x, y)
        points = [mirrored, *points]
    drawn.add(*points)
    return (len(points), points[-2]) if len(points) > 1 else (0, drawn.here)
