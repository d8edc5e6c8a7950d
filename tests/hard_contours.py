"""Contours whose crossings are hard to judge: tangles, and rings, loops and hairs thinner than a tolerance.

All coordinates are multiples of 1/64, so that floats hold them exactly.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from math import cos, pi, sin

import numpy as np

import glyphspline as gs
from tests.topology import Drawing, Piece, Vector

UNIT = 64

Points = Sequence[tuple[float, float]]
"""Points of a contour, three to a cubic: start and handles; or start twice for a line."""


def hard_contour(rng: random.Random) -> tuple[str, Drawing]:
    """A glyph of one or two contours, and the name of its kind."""
    draw = rng.choice([tangle, tangle, tangle, ring, loop, hair, hair, back, lens])
    return draw.__name__, draw(rng)


def outline_of(name: str, drawing: Drawing) -> gs.Outline:
    """A drawing as the package has it."""
    contours = [
        gs.Contour.from_segments([np.array(piece, dtype=np.float64) / drawing.unit for piece in pieces])
        for pieces in drawing.contours
    ]
    return gs.Outline(name, contours=tuple(contours))


def _drawing(*contours: Points) -> Drawing:
    """Contours of cubics; a cubic whose handles are its start is a line."""
    found = []
    for points in contours:
        whole = [(round(UNIT * x), round(UNIT * y)) for x, y in points]
        pieces: list[Piece] = []
        for k in range(0, len(whole), 3):
            start, one, two, end = (*whole[k : k + 3], whole[(k + 3) % len(whole)])
            piece = (start, end) if start == one == two else (start, one, two, end)
            if len(set(piece)) > 1:
                pieces.append(piece)
        found.append(pieces)
    return Drawing(UNIT, found)


def _line(*points: tuple[float, float]) -> list[tuple[float, float]]:
    return [point for point in points for _ in range(3)]


def _there_and_back(there: Points, width: float) -> Drawing:
    """A strand of cubics, given with its end, and back beside it; cubics end at its ends."""
    middle = np.array(there, dtype=np.float64)
    way = np.gradient(middle, axis=0)
    aside = width / 2 * np.stack([-way[:, 1], way[:, 0]], axis=1) / np.maximum(np.hypot(*way.T), 1e-9)[:, None]
    left, right = (middle + aside).tolist(), (middle - aside).tolist()[::-1]
    ends = [_line(tuple(side[-1])) for side in (left, right)]  # the caps
    return _drawing([*map(tuple, left[:-1]), *ends[0], *map(tuple, right[:-1]), *ends[1]])


def _curve(rng: random.Random, pieces: int) -> list[tuple[float, float]]:
    """A strand of cubics that is smooth where they join."""
    x, y, angle = rng.uniform(0, 300), rng.uniform(0, 1000), rng.uniform(-0.5, 0.5)
    points = [(x, y)]
    for _ in range(pieces):
        long, turn = rng.uniform(60, 300), rng.uniform(-1.2, 1.2)
        points.append((x + long * cos(angle) / 3, y + long * sin(angle) / 3))
        x, y = x + long * cos(angle + turn / 2), y + long * sin(angle + turn / 2)
        angle += turn
        points += [(x - long * cos(angle) / 3, y - long * sin(angle) / 3), (x, y)]
    return points


def tangle(rng: random.Random) -> Drawing:
    """6 to 30 random points in a square of 1,000 units, with handles of up to 300."""
    points: list[tuple[float, float]] = []
    joints = [(rng.uniform(0, 1000), rng.uniform(0, 1000)) for _ in range(rng.randint(6, 30))]
    for k, (x, y) in enumerate(joints):
        if rng.random() < 0.2:
            points += _line((x, y))
            continue
        points.append((x, y))
        for x, y in (joints[k], joints[(k + 1) % len(joints)]):
            size, angle = rng.uniform(0, 300), rng.uniform(0, 2 * pi)
            points.append((x + size * cos(angle), y + size * sin(angle)))
    return _drawing(points)


def _circle(x: float, y: float, across: float, up: float) -> list[tuple[float, float]]:
    k = 0.5522847498
    return [
        (x + across * a, y + up * b)
        for a, b in [
            (1, 0), (1, k), (k, 1), (0, 1), (-k, 1), (-1, k), (-1, 0), (-1, -k), (-k, -1), (0, -1), (k, -1), (1, -k),
        ]
    ]  # fmt: skip


def ring(rng: random.Random) -> Drawing:
    """A ring of 0.25 to 2 units' width, of two contours."""
    across, up = rng.uniform(5, 400), rng.uniform(5, 400)
    x, y, width = rng.uniform(-1, 1), rng.uniform(-1, 1), rng.choice([0.25, 0.5, 0.5, 1, 2])
    dx, dy = rng.choice([0, width / 2]), rng.choice([0, width / 2])
    inner = _circle(x + dx, y + dy, across - width, up - width)
    return _drawing(_circle(x, y, across, up), [inner[0], *inner[:0:-1]])


def loop(rng: random.Random) -> Drawing:
    """A rectangle, or a circle, with loops of 0.5 to 4 units on it."""
    points: list[tuple[float, float]] = []
    for x, y, angle in ((0, 0, 0.0), (500, 0, pi / 2), (500, 300, pi), (0, 300, -pi / 2)):
        points += _line((x, y))
        for along in [rng.uniform(50, 140), rng.uniform(150, 250)][: rng.randint(0, 2)]:
            size, across = rng.choice([0.5, 2, 2, 4]), rng.uniform(-1, 1)
            a, b = cos(angle), sin(angle)
            at = [(along, 0.0), (along + size, across * size), (along - size, across * size)]
            points += [(x + a * u - b * v, y + b * u + a * v) for u, v in at]
            points += _line((x + a * (along + rng.choice([0, size / 4])), y + b * along))
    return _drawing(points)


def hair(rng: random.Random) -> Drawing:
    """A strand and back beside it."""
    return _there_and_back(_curve(rng, rng.randint(1, 4)), rng.choice([0.1, 0.25, 0.5, 1, 2]))


def back(rng: random.Random) -> Drawing:
    """A strand, back on it exactly, and a detour at its end that has an area."""
    there = _curve(rng, rng.randint(1, 3))
    x, y = there[-1]
    detour = _line((x + 100, y), (x + 100, y + rng.choice([-80, 80])))
    return _drawing([*there[:-1], *_line((x, y)), *detour, (x, y), *there[-2:0:-1]][: 3 * 40])


def lens(rng: random.Random) -> Drawing:
    """Two arcs between two points, 0.05 to 2 units apart."""
    long, width, bow = rng.uniform(50, 900), rng.choice([0.05, 0.1, 0.3, 1, 2]), rng.choice([0, 0, 40, 200])
    ends: list[Vector] = [(0, 0), (long, rng.uniform(-200, 200))]
    rise = ends[1][1]
    up, down = ([(long / 3, rise / 3 + bow + d), (2 * long / 3, 2 * rise / 3 + bow + d)] for d in (width, -width))
    return _drawing([ends[0], *up, ends[1], *down[::-1]])
