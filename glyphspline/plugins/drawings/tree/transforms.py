"""Transforms: the attribute, the property, and the origin of either, as (3, 3) matrices."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from typing import TypeAlias

import numpy as np

from ....types import FloatArray
from .lengths import LENGTH, Lengths, numbers

Box: TypeAlias = tuple[float, float, float, float]
"""Left, top, width and height."""

ANGLES = {"deg": 1.0, "grad": 0.9, "rad": 180 / math.pi, "turn": 360.0, "": 1.0}
"""Degrees of each unit."""

CALL = re.compile(r"\s*,?\s*([a-zA-Z0-9]+)\s*\(([^()]*(?:\([^()]*\)[^()]*)*)\)")
COUNTS = {"matrix": (6,), "translate": (1, 2), "scale": (1, 2), "rotate": (1, 3), "skewx": (1,), "skewy": (1,)}
"""How many numbers each function takes in an attribute."""

SHARES = {"left": 0.0, "top": 0.0, "center": 0.5, "right": 1.0, "bottom": 1.0}


def translation(x: float, y: float) -> FloatArray:
    """The matrix of a move."""
    return np.array([[1.0, 0.0, x], [0.0, 1.0, y], [0.0, 0.0, 1.0]])


def _matrix(name: str, of: Sequence[float]) -> FloatArray:
    """The matrix of a function of the attribute, by its lower-case name, with angles in degrees."""
    if name == "matrix":
        return np.array([[of[0], of[2], of[4]], [of[1], of[3], of[5]], [0.0, 0.0, 1.0]])
    if name == "translate":
        return translation(of[0], of[1] if len(of) > 1 else 0.0)
    if name == "scale":
        return np.diag([of[0], of[-1], 1.0])
    if name == "rotate":
        cos, sin = _turn(of[0])
        turn = np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
        return turn if len(of) == 1 else translation(of[1], of[2]) @ turn @ translation(-of[1], -of[2])
    return _skew(*((of[0], 0.0) if name == "skewx" else (0.0, of[0])))


def _skew(x: float, y: float) -> FloatArray:
    """The matrix of a skew by angles in degrees."""
    return np.array([[1.0, math.tan(math.radians(x)), 0.0], [math.tan(math.radians(y)), 1.0, 0.0], [0.0, 0.0, 1.0]])


def _turn(degrees: float) -> tuple[float, float]:
    """Cosine and sine, exact at quarter turns."""
    quarters = {0.0: (1.0, 0.0), 90.0: (0.0, 1.0), 180.0: (-1.0, 0.0), 270.0: (0.0, -1.0)}
    angle = degrees % 360.0
    return quarters.get(angle) or (math.cos(math.radians(degrees)), math.sin(math.radians(degrees)))


def attribute_matrix(text: str) -> FloatArray | None:
    """The matrix of a transform attribute; None if it is none."""
    return _product(text, lambda name, inside: _of_numbers(name, inside), fold=False)


def _of_numbers(name: str, inside: str) -> FloatArray | None:
    found, whole = numbers(inside)
    known = {"skewX": "skewx", "skewY": "skewy"}.get(name, name)
    if not whole or len(found) not in COUNTS.get(known, ()):
        return None
    return _matrix(known, found)


def property_matrix(text: str, box: Box, lengths: Lengths) -> FloatArray | None:
    """The matrix of the property, with units; ``box`` is what percentages refer to. None if it is none in a plane."""
    if text.strip().lower() == "none":
        return np.eye(3)
    return _product(text, lambda name, inside: _of_units(name, inside, box, lengths), fold=True)


def _product(text: str, each: Callable[[str, str], FloatArray | None], fold: bool) -> FloatArray | None:
    matrix, at, text = np.eye(3), 0, text.strip()
    while at < len(text):
        call = CALL.match(text, at)
        found = None if call is None else each(call[1].lower() if fold else call[1], call[2])
        if call is None or found is None:
            return None
        matrix, at = matrix @ found, call.end()
    return matrix if np.isfinite(matrix).all() else None


def _of_units(name: str, inside: str, box: Box, lengths: Lengths) -> FloatArray | None:
    """The matrix of a function of the property."""
    parts = [part.strip() for part in inside.split(",")]
    if name in ("translate", "translatex", "translatey"):
        moves = [_along(part, box, lengths, "y" if k or name[-1] == "y" else "x") for k, part in enumerate(parts)]
        found = [move for move in moves if move is not None]
        if len(found) != len(parts) or len(parts) > (2 if name == "translate" else 1):
            return None
        return translation(0.0, found[0]) if name == "translatey" else _matrix("translate", found)
    values, angular = list[float](), name in ("rotate", "skew", "skewx", "skewy", "rotatez")
    for part in parts:
        found_one = LENGTH.fullmatch(part)
        unit = found_one[2].lower() if found_one else ""
        if found_one is None or (unit not in ANGLES if angular else unit not in ("", "%")):
            return None
        values.append(float(found_one[1]) * (ANGLES[unit] if angular else 0.01 if unit else 1.0))
    if name == "skew" and len(values) in (1, 2):
        return _skew(values[0], (*values, 0.0)[1])
    if name in ("scalex", "scaley") and len(values) == 1:
        return np.diag([values[0], 1.0, 1.0] if name == "scalex" else [1.0, values[0], 1.0])
    known = "rotate" if name == "rotatez" else name
    allowed = (1,) if known == "rotate" else COUNTS.get(known, ())
    return _matrix(known, values) if len(values) in allowed else None


def _along(text: str, box: Box, lengths: Lengths, side: str) -> float | None:
    """A length; a percentage of a box's side."""
    if text.endswith("%"):
        found = LENGTH.fullmatch(text)
        return None if found is None else float(found[1]) / 100 * (box[2] if side == "x" else box[3])
    found = LENGTH.fullmatch(text)
    if found is not None and not found[2] and float(found[1]):
        return None  # style sheets have no lengths without units
    return lengths.of(text, side)


def origin(text: str, box: Box, lengths: Lengths) -> tuple[float, float] | None:
    """The point that ``transform-origin`` says; None if it is none."""
    words = text.lower().replace(",", " ").split()
    if not words or len(words) > 3:
        return None
    across, down = (*words, "center")[:2]
    if across in ("top", "bottom") or down in ("left", "right"):
        across, down = down, across
    found = []
    for word, side, start, size in ((across, "x", box[0], box[2]), (down, "y", box[1], box[3])):
        if word in SHARES:
            value: float | None = SHARES[word] * size
        else:
            value = lengths.of(word, side) if not word.endswith("%") else _along(word, box, lengths, side)
        if value is None:
            return None
        found.append(start + value)
    return found[0], found[1]
