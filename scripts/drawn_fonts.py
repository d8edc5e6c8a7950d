"""Three small fonts drawn point by point: what real fonts contain now and then, and readers trip over.

Two are TrueType fonts. One is variable and has cubic outlines in a CFF2 table: two axes, named instances, metrics that
vary.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, TypeAlias

from fontTools import varLib
from fontTools.designspaceLib import AxisDescriptor, DesignSpaceDocument, InstanceDescriptor, SourceDescriptor
from fontTools.fontBuilder import FontBuilder
from fontTools.pens.t2CharStringPen import T2CharStringPen
from fontTools.pens.ttGlyphPen import TTGlyphPointPen
from fontTools.ttLib import TTFont
from fontTools.ttLib.tables.TupleVariation import TupleVariation

DATE = 3_566_073_600  # 2017-01-01, in the seconds since 1904 of a head table: file dates must not vary
UNITS_PER_EM, ASCENDER, DESCENDER = 1000, 800, -200

Point: TypeAlias = tuple[int, int]
Metrics: TypeAlias = dict[str, tuple[int, int]]
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


def box(left: int, bottom: int, right: int, top: int) -> Path:
    """A rectangle, clockwise as TrueType has outer contours."""
    return Path(((left, bottom), (left, top), (right, top), (right, bottom)))


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
        ".notdef": Drawing(500, (box(50, 0, 450, 700), Path(((100, 50), (400, 50), (400, 650), (100, 650))))),
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
    font = _built(light, "Drawn Variable", {" ": "space", "o": "o", "i": "i", "l": "stem", ".": "dot"})
    builder = FontBuilder(font=font)
    builder.setupFvar([("wght", 400, 400, 900, "Weight")], [])
    peak = {"wght": (0.0, 1.0, 1.0)}
    builder.setupGvar({name: [TupleVariation(peak, _deltas(light[name], bold[name]))] for name in light})
    return font


def edge_cases() -> TTFont:
    """Names that need escaping, degenerate contours, contours that overlap or cross themselves."""
    bar, square = box(100, 0, 200, 700), box(100, 0, 600, 500)
    in_place = (1, 0, 0, 1, 0, 0)
    glyphs = {
        ".notdef": Drawing(500, (box(50, 0, 450, 700),)),
        "space": Drawing(250),
        "a": Drawing(700, (disc(350, 250, 250), disc(350, 250, 120, hole=True))),
        "A": Drawing(700, (Path(((50, 0), (350, 700), (650, 0), (500, 0), (350, 350), (200, 0))),)),
        'quote"amp&lt<': Drawing(300, (bar,)),
        "CON": Drawing(300, (bar,)),
        "n" * 200: Drawing(300, (bar,)),
        "repeated": Drawing(700, (_each_twice(square), _each_twice(disc(350, 250, 100, hole=True, on_curve=True)))),
        "onepoint": Drawing(700, (square, Path(((350, 800),)))),
        "twopoints": Drawing(700, (Path(((0, 0), (300, 300))), square)),
        "flat": Drawing(700, (Path(((0, 0), (100, 100), (500, 500), (200, 200))),)),
        "overlap": Drawing(900, (square, box(400, 200, 800, 700))),
        "eight": Drawing(700, (Path(((100, 0), (600, 700), (100, 700), (600, 0))),)),
        "fold": Drawing(700, (Path(((100, 0), (350, 900), (600, 0), (350, 500)), frozenset({1, 3})),)),
        "loop": Drawing(900, (Path(((100, 0), (100, 600), (800, 600), (800, 100), (50, 100)), frozenset({2, 3})),)),
        "huge": Drawing(20000, (disc(0, 0, 15000),)),
        "tiny": Drawing(10, (Path(((0, 0), (0, 1), (1, 0))),)),
        "twice": Drawing(700, components=(("a", in_place), ("a", in_place))),
        "hollow": Drawing(700, components=(("space", in_place),)),
    }
    return _built(
        glyphs,
        "Drawn Edge Cases",
        {" ": "space", "a": "a", "A": "A", "\N{GREEK SMALL LETTER ALPHA}": "a", "8": "eight"},
    )


def _each_twice(path: Path) -> Path:
    """Every point on the curve written two times running."""
    doubled = [(p, k in path.off) for k, p in enumerate(path.points) for _ in range(1 if k in path.off else 2)]
    return Path(tuple(p for p, _ in doubled), frozenset(k for k, (_, off) in enumerate(doubled) if off))


def begun(names: Iterable[str], characters: dict[int, str], *, cubic: bool, em: int = UNITS_PER_EM) -> FontBuilder:
    """A font with its glyph order and character map."""
    builder = FontBuilder(em, isTTF=not cubic)
    builder.setupHead(unitsPerEm=em, created=DATE, modified=DATE, fontRevision=1.0)
    builder.setupGlyphOrder(list(names))
    builder.setupCharacterMap(characters)
    return builder


def ended(
    builder: FontBuilder, metrics: Metrics, family: str, ascender: int = ASCENDER, highest: int = ASCENDER
) -> TTFont:
    """The font with metrics and names."""
    builder.setupHorizontalMetrics(metrics)
    builder.setupHorizontalHeader(ascent=ascender, descent=DESCENDER)
    builder.setupNameTable({"familyName": family, "styleName": "Regular", "psName": family.replace(" ", "")})
    builder.setupOS2(sTypoAscender=ascender, sTypoDescender=DESCENDER, usWinAscent=highest, usWinDescent=-DESCENDER)
    builder.setupPost()
    return builder.font


def _built(glyphs: dict[str, Drawing], family: str, characters: dict[str, str]) -> TTFont:
    builder = begun(glyphs, {ord(character): name for character, name in characters.items()}, cubic=False)
    builder.setupGlyf({name: _glyph(drawing, glyphs) for name, drawing in glyphs.items()})
    outlines = builder.font["glyf"]
    metrics = {name: (drawing.advance, getattr(outlines[name], "xMin", 0)) for name, drawing in glyphs.items()}
    return ended(builder, metrics, family)


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


CUBIC_FAMILY = "Drawn Cubic Variable"
AXES = {"wght": ("Weight", 400, 400, 900), "wdth": ("Width", 75, 100, 100)}
MASTERS = [{"wght": 400, "wdth": 100}, {"wght": 900, "wdth": 100}, {"wght": 400, "wdth": 75}]
INSTANCES = {"Regular": MASTERS[0], "Bold": {"wght": 700, "wdth": 100}, "Bold Condensed": {"wght": 700, "wdth": 75}}
HANDLE = 0.5523  # of the radius: the cubic nearest to a quarter of a circle
CUBIC_CHARACTERS = {" ": "space", "o": "o", "l": "l", "n": "n"}


def variable_cff2() -> TTFont:
    """The font, merged from its masters."""
    document = DesignSpaceDocument()
    for tag, (name, low, default, high) in AXES.items():
        document.addAxis(AxisDescriptor(tag=tag, name=name, minimum=low, default=default, maximum=high))
    for at in MASTERS:
        location = {AXES[tag][0]: value for tag, value in at.items()}
        document.addSource(SourceDescriptor(font=master(at["wght"], at["wdth"]), location=location))
    for style, at in INSTANCES.items():
        location = {AXES[tag][0]: value for tag, value in at.items()}
        document.addInstance(InstanceDescriptor(familyName=CUBIC_FAMILY, styleName=style, location=location))
    font, _, _ = varLib.build(document)
    font.recalcTimestamp = False
    font["head"].created = font["head"].modified = DATE
    return font


def master(weight: int, width: int) -> TTFont:
    """One end of the design space, as CFF."""
    stem, half = 60 + (weight - 400) * 140 // 500, 250 * width // 100
    advances = {".notdef": 500, "space": 2 * half // 2, "o": 2 * half + 100, "l": stem + 120, "n": 2 * half + 60}
    characters = {ord(character): name for character, name in CUBIC_CHARACTERS.items()}
    builder = begun(advances, characters, cubic=True)
    pens = {name: T2CharStringPen(advance, None) for name, advance in advances.items()}
    cubic_box(pens[".notdef"], 50, 0, 450, 700)
    ellipse(pens["o"], 50 + half, 250, half, 250)
    ellipse(pens["o"], 50 + half, 250, -(half - stem), 250 - stem)
    cubic_box(pens["l"], 60, 0, 60 + stem, 700 + stem // 4)
    arch(pens["n"], 60, 2 * half, stem)
    strings = {name: pen.getCharString(optimize=False) for name, pen in pens.items()}
    builder.setupCFF(CUBIC_FAMILY.replace(" ", ""), {"FamilyName": CUBIC_FAMILY, "FullName": CUBIC_FAMILY}, strings, {})
    metrics = {name: (advance, bearing(strings[name])) for name, advance in advances.items()}
    return ended(builder, metrics, CUBIC_FAMILY, ASCENDER + (weight - 400) // 10, 900)


def bearing(string: Any) -> int:
    """The left side bearing of a char string that has no subroutines."""
    bounds = string.calcBounds(None)
    return round(bounds[0]) if bounds else 0


def cubic_box(pen: Any, left: int, bottom: int, right: int, top: int) -> None:
    """A rectangle, counter-clockwise as CFF has outer contours."""
    pen.moveTo((left, bottom))
    for point in ((right, bottom), (right, top), (left, top)):
        pen.lineTo(point)
    pen.closePath()


def ellipse(pen: Any, x: int, y: int, across: int, up: int) -> None:
    """Four cubics, counter-clockwise; clockwise with ``across`` negative."""
    a, b = round(HANDLE * across), round(HANDLE * up)
    pen.moveTo((x + across, y))
    pen.curveTo((x + across, y + b), (x + a, y + up), (x, y + up))
    pen.curveTo((x - a, y + up), (x - across, y + b), (x - across, y))
    pen.curveTo((x - across, y - b), (x - a, y - up), (x, y - up))
    pen.curveTo((x + a, y - up), (x + across, y - b), (x + across, y))
    pen.closePath()


def arch(pen: Any, left: int, right: int, stem: int) -> None:
    """Two legs under a vault: lines and curves in one contour."""
    middle = (left + right) // 2
    pen.moveTo((left, 0))
    pen.lineTo((left + stem, 0))
    pen.curveTo((left + stem, 300), (middle - 40, 500 - stem), (middle, 500 - stem))
    pen.curveTo((middle + 40, 500 - stem), (right - stem, 300), (right - stem, 0))
    pen.lineTo((right, 0))
    pen.curveTo((right, 380), (middle + 120, 520), (middle, 520))
    pen.curveTo((middle - 120, 520), (left, 380), (left, 0))
    pen.closePath()
