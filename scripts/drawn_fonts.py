"""Two small TrueType fonts drawn point by point: what real fonts contain now and then, and readers trip over."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, TypeAlias

from fontTools.fontBuilder import FontBuilder
from fontTools.pens.ttGlyphPen import TTGlyphPointPen
from fontTools.ttLib import TTFont
from fontTools.ttLib.tables.TupleVariation import TupleVariation

DATE = 3_566_073_600  # 2017-01-01, in the seconds since 1904 of a head table: file dates must not vary
UNITS_PER_EM, ASCENDER, DESCENDER = 1000, 800, -200

Point: TypeAlias = tuple[int, int]
Placed: TypeAlias = tuple[str, tuple[float, float, float, float, int, int]]


@dataclass(frozen=True)
class Path:
    """A TrueType contour: its points, on the curve or (``off``, by index) not."""

    points: tuple[Point, ...]
    off: frozenset[int] = frozenset()


@dataclass(frozen=True)
class Drawing:
    """A glyph: paths, or else other glyphs placed by an affine map (xx, xy, yx, yy, dx, dy)."""

    advance: int
    paths: tuple[Path, ...] = ()
    components: tuple[Placed, ...] = ()


def polygon(*points: Point) -> Path:
    """Straight lines from point to point and back."""
    return Path(points)


def box(left: int, bottom: int, right: int, top: int) -> Path:
    """A rectangle, clockwise as TrueType has outer contours."""
    return polygon((left, bottom), (left, top), (right, top), (right, bottom))


def disc(x: int, y: int, radius: int, *, hole: bool = False, on_curve: bool = False) -> Path:
    """Nearly a circle, by eight control points around it; with no point on the curve unless asked."""
    reach = radius / math.cos(math.pi / 8)
    angles = [(k + 0.5) * math.pi / 4 for k in range(8)]
    around = [(round(x + reach * math.cos(a)), round(y + reach * math.sin(a))) for a in angles]
    if not hole:
        around.reverse()
    if not on_curve:
        return Path(tuple(around), frozenset(range(8)))
    first = ((around[0][0] + around[7][0]) // 2, (around[0][1] + around[7][1]) // 2)
    return Path((first, *around), frozenset(range(1, 9)))


def weighted(stem: int) -> dict[str, Drawing]:
    """The glyphs of the variable font at one weight, given by the width of the stem."""
    middle, width = 300 + stem // 2, 200 + stem
    upright = (1, 0, 0, 1)
    return {
        ".notdef": Drawing(500, (box(50, 0, 450, 700), polygon((100, 50), (400, 50), (400, 650), (100, 650)))),
        "space": Drawing(200 + stem // 2),
        "o": Drawing(
            600 + stem,
            (disc(middle, 250, 250, on_curve=True), disc(middle, 250, 250 - stem, hole=True, on_curve=True)),
        ),
        "dot": Drawing(width, (disc(100 + stem // 2, 600, stem // 2 + 20),)),
        "stem": Drawing(width, (box(100, 0, 100 + stem, 500),)),
        "i": Drawing(width, components=(("stem", (*upright, 0, 0)), ("dot", (*upright, 0, stem // 4)))),
        "ii": Drawing(2 * width, components=(("i", (*upright, 0, 0)), ("i", (1, 0, 0.25, 0.5, width, 0)))),
        "mirror": Drawing(600 + stem, components=(("o", (-1, 0, 0, 0.75, 600 + stem, -40)),)),
    }


def variable() -> TTFont:
    """One axis, weight 400 to 900: composites (nested, slanted, mirrored), an off-curve-only contour, no HVAR."""
    light, bold = weighted(60), weighted(200)
    builder = _built(light, "Drawn Variable", {" ": "space", "o": "o", "i": "i", "l": "stem", ".": "dot"})
    builder.setupFvar([("wght", 400, 400, 900, "Weight")], [])
    peak = {"wght": (0.0, 1.0, 1.0)}
    builder.setupGvar({name: [TupleVariation(peak, _deltas(light[name], bold[name]))] for name in light})
    return builder.font


def edge_cases() -> TTFont:
    """Names that need escaping, degenerate contours, contours that overlap or cross themselves."""
    bar, square = box(100, 0, 200, 700), box(100, 0, 600, 500)
    in_place = (1, 0, 0, 1, 0, 0)
    glyphs = {
        ".notdef": Drawing(500, (box(50, 0, 450, 700),)),
        "space": Drawing(250),
        "a": Drawing(700, (disc(350, 250, 250), disc(350, 250, 120, hole=True))),
        "A": Drawing(700, (polygon((50, 0), (350, 700), (650, 0), (500, 0), (350, 350), (200, 0)),)),
        'quote"amp&lt<': Drawing(300, (bar,)),
        "CON": Drawing(300, (bar,)),
        "n" * 200: Drawing(300, (bar,)),
        "repeated": Drawing(700, (_each_twice(square), _each_twice(disc(350, 250, 100, hole=True, on_curve=True)))),
        "onepoint": Drawing(700, (square, polygon((350, 800)))),
        "twopoints": Drawing(700, (polygon((0, 0), (300, 300)), square)),
        "flat": Drawing(700, (polygon((0, 0), (100, 100), (500, 500), (200, 200)),)),
        "overlap": Drawing(900, (square, box(400, 200, 800, 700))),
        "eight": Drawing(700, (polygon((100, 0), (600, 700), (100, 700), (600, 0)),)),
        "fold": Drawing(700, (Path(((100, 0), (350, 900), (600, 0), (350, 500)), frozenset({1, 3})),)),
        "loop": Drawing(900, (Path(((100, 0), (100, 600), (800, 600), (800, 100), (50, 100)), frozenset({2, 3})),)),
        "huge": Drawing(20000, (disc(0, 0, 15000),)),
        "tiny": Drawing(10, (polygon((0, 0), (0, 1), (1, 0)),)),
        "twice": Drawing(700, components=(("a", in_place), ("a", in_place))),
        "hollow": Drawing(700, components=(("space", in_place),)),
    }
    return _built(
        glyphs,
        "Drawn Edge Cases",
        {" ": "space", "a": "a", "A": "A", "\N{GREEK SMALL LETTER ALPHA}": "a", "8": "eight"},
    ).font


def _each_twice(path: Path) -> Path:
    """Every point on the curve written two times running."""
    doubled = [(p, k in path.off) for k, p in enumerate(path.points) for _ in range(1 if k in path.off else 2)]
    return Path(tuple(p for p, _ in doubled), frozenset(k for k, (_, off) in enumerate(doubled) if off))


def _built(glyphs: dict[str, Drawing], family: str, characters: dict[str, str]) -> FontBuilder:
    builder = FontBuilder(UNITS_PER_EM, isTTF=True)
    builder.setupHead(unitsPerEm=UNITS_PER_EM, created=DATE, modified=DATE, fontRevision=1.0)
    builder.setupGlyphOrder(list(glyphs))
    builder.setupCharacterMap({ord(character): name for character, name in characters.items()})
    builder.setupGlyf({name: _glyph(drawing, glyphs) for name, drawing in glyphs.items()})
    outlines = builder.font["glyf"]
    metrics = {name: (drawing.advance, getattr(outlines[name], "xMin", 0)) for name, drawing in glyphs.items()}
    builder.setupHorizontalMetrics(metrics)
    builder.setupHorizontalHeader(ascent=ASCENDER, descent=DESCENDER)
    builder.setupNameTable({"familyName": family, "styleName": "Regular", "psName": family.replace(" ", "")})
    builder.setupOS2(sTypoAscender=ASCENDER, sTypoDescender=DESCENDER, usWinAscent=ASCENDER, usWinDescent=-DESCENDER)
    builder.setupPost()
    return builder


def _glyph(drawing: Drawing, glyphs: dict[str, Drawing]) -> Any:
    pen = TTGlyphPointPen(glyphs)
    for path in drawing.paths:
        pen.beginPath()
        for k, point in enumerate(path.points):
            pen.addPoint(point, None if k in path.off else "line")
        pen.endPath()
    for name, transformation in drawing.components:
        pen.addComponent(name, transformation)
    return pen.glyph()


def _deltas(light: Drawing, bold: Drawing) -> list[Point]:
    """What gvar adds at the full weight, to points (components: to offsets) and then the four phantom points."""
    deltas = [(q[0] - p[0], q[1] - p[1]) for p, q in zip(_movable(light), _movable(bold), strict=True)]
    return [*deltas, (0, 0), (bold.advance - light.advance, 0), (0, 0), (0, 0)]


def _movable(drawing: Drawing) -> list[Point]:
    points = [point for path in drawing.paths for point in path.points]
    return points + [transformation[4:] for _, transformation in drawing.components]
