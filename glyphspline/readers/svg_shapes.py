"""Draws the shapes of an SVG document with a pen. svgpathtools parses the path data; transforms are applied."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from svgpathtools import Arc, CubicBezier, Line, QuadraticBezier, parse_path
from svgpathtools.parser import parse_transform
from svgpathtools.svg_to_paths import rect2pathd

from ..errors import GlyphsplineError
from ..types import FloatArray

DEEPEST = 200
"""Limit of nested groups, far above any real drawing."""

ARC = 45.0
"""Degrees of an elliptic arc that become one cubic, with an error of 4e-6 of the radius."""

NOT_DRAWN = {"defs", "clipPath", "mask", "symbol", "pattern", "marker", "metadata", "title", "desc", "style", "text"}
LEFT_OUT = {"use": "clones (use)", "image": "images", "text": "text"}

FLIP = np.diag([1.0, -1.0, 1.0])


def draw_shapes(root: Any, pen: Any) -> tuple[str, ...]:
    """Draw filled shapes in document order, (x, y) as (x, -y); returns a note on each kind left out."""
    left_out: Counter[str] = Counter()
    for element, matrix, filled in shapes(root, FLIP, True, left_out):
        if filled:
            draw_path(path_data(element), matrix, pen)
        else:
            left_out["shapes without fill (strokes are not read)"] += 1
    return tuple(f"{count} {kind} left out" for kind, count in left_out.items())


def shapes(
    element: Any, matrix: FloatArray, filled: bool, left_out: Counter[str], depth: int = 0, everywhere: bool = False
) -> Iterator[tuple[Any, FloatArray, bool]]:
    """Each shape with the (3, 3) matrix to font space, and whether it is filled.

    Those that are only defined or not displayed, and lines, are among them with ``everywhere``.
    """
    if depth > DEEPEST:
        raise GlyphsplineError(f"groups nested more than {DEEPEST} deep")
    if not isinstance(element.tag, str):
        return  # a comment
    tag, style = element.tag.rpartition("}")[2], styles(element)
    if tag in LEFT_OUT:
        left_out[LEFT_OUT[tag]] += 1
    if not everywhere and (tag in NOT_DRAWN or style.get("display") == "none"):
        return
    if element.get("transform"):
        matrix = matrix @ np.asarray(parse_transform(element.get("transform")), dtype=np.float64)
    filled = style["fill"] not in ("none", "transparent") if "fill" in style else filled
    if tag in ("path", "rect", "circle", "ellipse", "polygon", "polyline") or (everywhere and tag == "line"):
        yield element, matrix, filled
    for child in element:
        yield from shapes(child, matrix, filled, left_out, depth + 1, everywhere)


def styles(element: Any) -> dict[str, str]:
    """``fill`` and ``display`` from the style attribute, else from the attributes of these names."""
    found = {name: element.get(name).strip() for name in ("fill", "display") if element.get(name)}
    for item in (element.get("style") or "").split(";"):
        name, colon, value = item.partition(":")
        if colon and name.strip() in ("fill", "display"):
            found[name.strip()] = value.strip()
    return found


def path_data(element: Any) -> str:
    """A shape as path data, which begins and runs as SVG 2 has it for the shape."""
    tag = element.tag.rpartition("}")[2]
    if tag == "path":
        return str(element.get("d") or "")
    if tag == "rect":
        return str(rect2pathd(dict(element.attrib)))
    if tag in ("circle", "ellipse"):
        cx, cy = float(element.get("cx", 0)), float(element.get("cy", 0))
        rx, ry = (float(element.get(key)) for key in (("r", "r") if tag == "circle" else ("rx", "ry")))
        ends = ((cx, cy + ry), (cx - rx, cy), (cx, cy - ry), (cx + rx, cy))
        return f"M{cx + rx!r},{cy!r}" + "".join([f"A{rx!r},{ry!r} 0 0 1 {x!r},{y!r}" for x, y in ends]) + "Z"
    if tag == "line":
        return "M{},{}L{},{}".format(*[element.get(key, 0) for key in ("x1", "y1", "x2", "y2")])
    points = element.get("points") or ""
    return f"M{points}{'Z' if tag == 'polygon' else ''}" if points.strip() else ""


def draw_path(data: str, matrix: FloatArray, pen: Any, arc: float = ARC) -> None:
    """Draw path data subpath by subpath: svgpathtools would join two that meet in a point.

    An open subpath ends with ``endPath``. ``arc``: degrees of an elliptic arc that become one cubic.
    """
    here = 0j
    for subpath in re.findall(r"[Mm][^Mm]*", data):
        start = moved_to(subpath, here)
        path = parse_path(subpath, current_pos=here)
        pen.moveTo(placed([start], matrix)[0])
        end = start
        for segment in path:
            draw_segment(segment, matrix, pen, arc)
            end = segment.end
        closed = subpath.rstrip(" \t\r\n\f,").endswith(("Z", "z"))
        (pen.closePath if closed else pen.endPath)()
        here = start if closed else end


def moved_to(subpath: str, here: complex) -> complex:
    """The start point of a subpath."""
    numbers = re.findall(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?", subpath)
    if len(numbers) < 2:
        raise GlyphsplineError("path data that begins nowhere")
    point = complex(float(numbers[0]), float(numbers[1]))
    return here + point if subpath[0] == "m" else point


def draw_segment(segment: Any, matrix: FloatArray, pen: Any, arc: float) -> None:
    """Draw a line, quadratic, cubic or arc from the current point."""
    if isinstance(segment, Line | QuadraticBezier | CubicBezier):
        points = placed(segment.bpoints()[1:], matrix)
        (pen.lineTo, pen.qCurveTo, pen.curveTo)[len(points) - 1](*points)
    elif isinstance(segment, Arc):
        for cubic in arc_cubics(segment, arc):
            pen.curveTo(*placed(cubic, matrix))
    else:
        raise GlyphsplineError(f"a path segment of an unknown kind, {type(segment).__name__}")


def arc_cubics(arc: Any, degrees: float) -> Iterator[list[complex]]:
    """The three points that each cubic of an elliptic arc adds, one for so many degrees."""
    pieces = max(1, int(np.ceil(abs(arc.delta) / degrees)))
    handle = 4 / 3 * np.tan(np.radians(arc.delta) / pieces / 4) / np.radians(arc.delta)
    for k in range(pieces):
        t0, t1 = k / pieces, (k + 1) / pieces
        start, end = arc.point(t0), arc.point(t1)
        yield [start + handle * arc.derivative(t0), end - handle * arc.derivative(t1), end]


def placed(points: Sequence[complex], matrix: FloatArray) -> list[tuple[float, float]]:
    """Points of the drawing in font space."""
    (a, b, x), (c, d, y) = matrix[:2].tolist()
    return [(a * p.real + b * p.imag + x, c * p.real + d * p.imag + y) for p in map(complex, points)]
