"""A small variable font with cubic outlines in a CFF2 table: two axes, named instances, metrics that vary."""

from __future__ import annotations

from typing import Any

from drawn_fonts import ASCENDER, DATE, DESCENDER, UNITS_PER_EM
from fontTools import varLib
from fontTools.designspaceLib import AxisDescriptor, DesignSpaceDocument, InstanceDescriptor, SourceDescriptor
from fontTools.fontBuilder import FontBuilder
from fontTools.pens.t2CharStringPen import T2CharStringPen
from fontTools.ttLib import TTFont

FAMILY = "Drawn Cubic Variable"
AXES = {"wght": ("Weight", 400, 400, 900), "wdth": ("Width", 75, 100, 100)}
MASTERS = [{"wght": 400, "wdth": 100}, {"wght": 900, "wdth": 100}, {"wght": 400, "wdth": 75}]
INSTANCES = {"Regular": MASTERS[0], "Bold": {"wght": 700, "wdth": 100}, "Bold Condensed": {"wght": 700, "wdth": 75}}
HANDLE = 0.5523  # of the radius: the cubic nearest to a quarter of a circle
CHARACTERS = {" ": "space", "o": "o", "l": "l", "n": "n"}


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
        document.addInstance(InstanceDescriptor(familyName=FAMILY, styleName=style, location=location))
    font, _, _ = varLib.build(document)
    font.recalcTimestamp = False
    font["head"].created = font["head"].modified = DATE
    return font


def master(weight: int, width: int) -> TTFont:
    """One end of the design space, as CFF."""
    stem, half = 60 + (weight - 400) * 140 // 500, 250 * width // 100
    advances = {".notdef": 500, "space": 2 * half // 2, "o": 2 * half + 100, "l": stem + 120, "n": 2 * half + 60}
    builder = FontBuilder(UNITS_PER_EM, isTTF=False)
    builder.setupHead(unitsPerEm=UNITS_PER_EM, created=DATE, modified=DATE, fontRevision=1.0)
    builder.setupGlyphOrder(list(advances))
    builder.setupCharacterMap({ord(character): name for character, name in CHARACTERS.items()})
    pens = {name: T2CharStringPen(advance, None) for name, advance in advances.items()}
    box(pens[".notdef"], 50, 0, 450, 700)
    ellipse(pens["o"], 50 + half, 250, half, 250)
    ellipse(pens["o"], 50 + half, 250, -(half - stem), 250 - stem)
    box(pens["l"], 60, 0, 60 + stem, 700 + stem // 4)
    arch(pens["n"], 60, 2 * half, stem)
    strings = {name: pen.getCharString(optimize=False) for name, pen in pens.items()}
    builder.setupCFF(FAMILY.replace(" ", ""), {"FamilyName": FAMILY, "FullName": FAMILY}, strings, {})
    builder.setupHorizontalMetrics({name: (advance, bearing(strings[name])) for name, advance in advances.items()})
    ascender = ASCENDER + (weight - 400) // 10
    builder.setupHorizontalHeader(ascent=ascender, descent=DESCENDER)
    builder.setupNameTable({"familyName": FAMILY, "styleName": "Regular", "psName": FAMILY.replace(" ", "")})
    builder.setupOS2(sTypoAscender=ascender, sTypoDescender=DESCENDER, usWinAscent=900, usWinDescent=-DESCENDER)
    builder.setupPost()
    return builder.font


def bearing(string: Any) -> int:
    """The left side bearing of a char string that has no subroutines."""
    bounds = string.calcBounds(None)
    return round(bounds[0]) if bounds else 0


def box(pen: Any, left: int, bottom: int, right: int, top: int) -> None:
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
