"""Small fonts with what shaping needs: kerning, ligatures, joined Arabic letters, marks, vertical forms."""

from __future__ import annotations

from pathlib import Path

from fontTools.feaLib.builder import addOpenTypeFeaturesFromString
from fontTools.fontBuilder import FontBuilder
from fontTools.pens.ttGlyphPen import TTGlyphPen

CHARACTERS = {
    "space": 0x20,
    "parenleft": 0x28,
    "parenright": 0x29,
    "hyphen": 0x2D,
    "one": 0x31,
    "two": 0x32,
    "A": 0x41,
    "V": 0x56,
    "a": 0x61,
    "f": 0x66,
    "i": 0x69,
    "acutecomb": 0x301,
    "alef-hb": 0x5D0,
    "bet-hb": 0x5D1,
    "beh": 0x628,
    "seen": 0x633,
    "quoteleft-cjk": 0x300C,
    "a-hira": 0x3042,
}
OTHERS = (".notdef", "f_i", "beh.init", "beh.medi", "beh.fina", "seen.init", "seen.medi", "seen.fina", "quoteleft.vert")
WIDTHS = {
    "acutecomb": 0,
    "space": 250,
    "hyphen": 300,
    "f_i": 700,
    "a-hira": 1000,
    "quoteleft-cjk": 1000,
    "quoteleft.vert": 1000,
}

FEATURES = """
languagesystem DFLT dflt;
languagesystem latn dflt;
languagesystem arab dflt;
languagesystem kana dflt;
markClass acutecomb <anchor 120 520> @TOP;
feature liga { sub f i by f_i; } liga;
feature smcp { sub a by A; } smcp;
feature kern { pos A V -80; pos V A -70; } kern;
feature init { sub [beh seen] by [beh.init seen.init]; } init;
feature medi { sub [beh seen] by [beh.medi seen.medi]; } medi;
feature fina { sub [beh seen] by [beh.fina seen.fina]; } fina;
feature mark { pos base a <anchor 260 540> mark @TOP; } mark;
feature vert { sub quoteleft-cjk by quoteleft.vert; } vert;
table GDEF { GlyphClassDef [A V a f i], , [acutecomb], ; } GDEF;
"""


def advance(name: str) -> int:
    """The width of a glyph, different for each."""
    return WIDTHS.get(name, 400 + 11 * sorted([*CHARACTERS, *OTHERS]).index(name))


def text_font(path: Path, em: int = 1000, without: str = "", family: str = "Text Test") -> Path:
    """Write a font; ``without`` the characters of a string, and their glyphs stay."""
    names = [".notdef", *CHARACTERS, *OTHERS[1:]]
    builder = FontBuilder(em, isTTF=True)
    builder.setupGlyphOrder(names)
    builder.setupCharacterMap({code: name for name, code in CHARACTERS.items() if chr(code) not in without})
    builder.setupGlyf({name: _square(advance(name) * em // 1000, em, name == "space") for name in names})
    builder.setupHorizontalMetrics({name: (advance(name) * em // 1000, 0) for name in names})
    builder.setupHorizontalHeader(ascent=em * 8 // 10, descent=-em * 2 // 10, lineGap=em // 10)
    builder.setupVerticalMetrics(dict.fromkeys(names, (em, em // 10)))
    builder.setupVerticalHeader(ascent=em // 2, descent=-em // 2)
    builder.setupNameTable({"familyName": family, "styleName": "Regular"})
    builder.setupOS2(sTypoAscender=em * 8 // 10, sTypoDescender=-em * 2 // 10, sTypoLineGap=em // 10)
    builder.setupPost()
    addOpenTypeFeaturesFromString(builder.font, FEATURES)
    builder.save(path)
    return path


def _square(width: int, em: int, empty: bool) -> object:
    pen = TTGlyphPen(None)
    if not empty:
        right, top = max(width, em // 5) - em // 20, em // 2 + width // 4
        for place in [(em // 20, 0), (em // 20, top), (right, top), (right, 0)]:
            (pen.moveTo if place == (em // 20, 0) else pen.lineTo)(place)
        pen.closePath()
    return pen.glyph()
