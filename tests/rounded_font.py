"""A font of strokes with rounded ends and corners, at any angle, in whole units: short handles beside long lines."""

from __future__ import annotations

import random
from math import cos, pi, sin, tan
from pathlib import Path

import numpy as np
from fontTools.fontBuilder import FontBuilder
from fontTools.pens.basePen import AbstractPen
from fontTools.pens.cu2quPen import Cu2QuPen
from fontTools.pens.t2CharStringPen import T2CharStringPen
from fontTools.pens.ttGlyphPen import TTGlyphPen

from glyphspline.types import FloatArray


def rounded_font(path: Path, count: int, seed: int) -> Path:
    """Write a font of so many glyphs: of cubics, or of quadratics near these if its name ends with "ttf"."""
    is_ttf, rng = path.suffix == ".ttf", random.Random(seed)
    names = [".notdef", *(f"rounded{k}" for k in range(count))]
    builder = FontBuilder(1000, isTTF=is_ttf)
    builder.setupGlyphOrder(names)
    builder.setupCharacterMap({0x4E00 + k: name for k, name in enumerate(names[1:])})
    glyphs = {}
    for name in names:
        contours = [stroke(rng) for _ in range(0 if name == ".notdef" else rng.randint(3, 8))]
        if is_ttf:
            collected = TTGlyphPen(None)
            draw(contours, Cu2QuPen(collected, 1.0, reverse_direction=True))
            glyphs[name] = collected.glyph()
        else:
            pen = T2CharStringPen(1000, None)
            draw(contours, pen)
            glyphs[name] = pen.getCharString()
    if is_ttf:
        builder.setupGlyf(glyphs)
    else:
        builder.setupCFF("Rounded", {}, glyphs, {})
    builder.setupHorizontalMetrics(dict.fromkeys(names, (1000, 0)))
    builder.setupHorizontalHeader(ascent=880, descent=-120)
    builder.setupNameTable({"familyName": "Rounded", "styleName": "Regular"})
    builder.setupOS2()
    builder.setupPost()
    builder.save(path)
    return path


def stroke(rng: random.Random) -> list[FloatArray]:
    """The cubics (4, 2) of a stroke: a straight one that tapers or not, with corners of any radius, or a bent one."""
    centre, width = np.array([rng.uniform(200, 800), rng.uniform(0, 700)]), rng.uniform(24, 110)
    if rng.random() < 0.3:
        start, bend, radius = rng.uniform(0, 2 * pi), rng.uniform(0.3, 1.2), rng.uniform(150, 600)
        ends = [centre + radius * np.array([cos(a), sin(a)]) for a in (start, start + bend)]
        return [
            *arc(centre, radius + width / 2, start, start + bend),
            *arc(ends[1], width / 2, start + bend, start + bend + pi),
            *arc(centre, radius - width / 2, start + bend, start),
            *arc(ends[0], width / 2, start + pi, start + 2 * pi),
        ]
    angle = rng.uniform(0, 2 * pi) if rng.random() < 0.7 else rng.choice([0.0, pi / 2])
    along, across = np.array([cos(angle), sin(angle)]), np.array([-sin(angle), cos(angle)])
    half, taper = rng.uniform(30, 700) / 2, rng.choice([1.0, 1.0, rng.uniform(0.4, 1.0)])
    corners = [(-half, -width / 2), (half, -width / 2 * taper), (half, width / 2 * taper), (-half, width / 2)]
    round_ends = rng.random() < 0.4
    radii = [width / 2 if round_ends else rng.uniform(2, 60) for _ in corners]
    return rounded([centre + u * along + v * across for u, v in corners], radii)


def rounded(corners: list[FloatArray], radii: list[float]) -> list[FloatArray]:
    """The arcs in place of the corners of a polygon, each no longer than half of its sides."""
    arcs = []
    for k, (corner, radius) in enumerate(zip(corners, radii, strict=True)):
        a, b = corners[k - 1] - corner, corners[(k + 1) % len(corners)] - corner
        one, two = np.hypot(*a), np.hypot(*b)
        half = np.arccos(np.clip(a @ b / (one * two), -1, 1)) / 2
        reach = min(radius / tan(half), 0.499 * one, 0.499 * two)
        handle = 4 / 3 * tan((pi / 2 - half) / 2) * reach * tan(half)
        a, b = a / one, b / two
        arcs.append(corner + np.array([reach * a, (reach - handle) * a, (reach - handle) * b, reach * b]))
    return arcs


def arc(centre: FloatArray, radius: float, start: float, end: float) -> list[FloatArray]:
    """Cubics near an arc from one angle to another, each of a right angle at most."""
    angles = np.linspace(start, end, max(1, int(np.ceil(abs(end - start) / (pi / 2) - 1e-9))) + 1)
    ways = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    handles = 4 / 3 * np.tan(np.diff(angles)[0] / 4) * ways[:, ::-1] * (-1, 1)
    return [
        centre + radius * np.array([p, p + u, q - v, q])
        for p, u, q, v in zip(ways[:-1], handles[:-1], ways[1:], handles[1:], strict=True)
    ]


def draw(contours: list[list[FloatArray]], pen: AbstractPen) -> None:
    """Draw closed contours of cubics in whole units, with lines between those that are apart."""
    for contour in contours:
        cubics = [[(float(x), float(y)) for x, y in np.rint(cubic)] for cubic in contour]
        here = cubics[0][0]
        pen.moveTo(here)
        for first, *rest in cubics:
            if first != here:
                pen.lineTo(first)
            if any(point != first for point in rest):
                pen.curveTo(*rest)
            here = rest[-1]
        pen.closePath()
