#!/usr/bin/env python3
"""Rebuild every font in fonts_test/, to the same bytes each time.

    python scripts/make_test_fonts.py --kouzan DIR

Two brush fonts of the public domain are cut down to a few characters and converted to the other formats;
DIR is where they are, by default where Debian's package puts them. To get it without installing it:

    apt-get download fonts-kouzan-mouhitsu && dpkg-deb -x fonts-kouzan-mouhitsu_*.deb kouzan
    python scripts/make_test_fonts.py --kouzan kouzan/usr/share/fonts/truetype/kouzan-mouhitsu

Three more fonts are drawn point by point (drawn_fonts.py); ``--drawn-only`` makes just these,
without the package.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import drawn_fonts
from fontTools.pens.reverseContourPen import ReverseContourPen
from fontTools.pens.t2CharStringPen import T2CharStringPen
from fontTools.subset import Options, Subsetter
from fontTools.ttLib import TTCollection, TTFont, newTable

KOUZAN = Path("/usr/share/fonts/truetype/kouzan-mouhitsu")
FACES = {"gyosho": "kouzan-mouhitsu-gyosho.ttf", "kaisho": "kouzan-mouhitsu.ttf"}
CHARACTERS = "龍好善永あいうのをAaBOg&8 "
LEFT_OUT = ["GSUB", "mort", "GlyphOrder", "gasp", "vhea", "vmtx"]


def main() -> None:
    """Write the fonts."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kouzan", type=Path, default=KOUZAN, metavar="DIR", help=f"the brush fonts ({KOUZAN})")
    parser.add_argument("--drawn-only", action="store_true", help="only the fonts that need no package")
    parser.add_argument("--out", type=Path, default=Path(__file__).parent.parent / "fonts_test", metavar="DIR")
    args = parser.parse_args()
    missing = [file for file in FACES.values() if not (args.kouzan / file).exists()]
    if missing and not args.drawn_only:
        parser.error(f"no {missing[0]} in {args.kouzan}: see --help for how to get it, or use --drawn-only")
    args.out.mkdir(parents=True, exist_ok=True)
    drawn_fonts.variable().save(args.out / "variable.ttf")
    drawn_fonts.variable_cff2().save(args.out / "variable-cff2.otf")
    drawn_fonts.edge_cases().save(args.out / "edge-cases.ttf")
    if not args.drawn_only:
        write_kouzan(args.kouzan, args.out)
    for path in sorted(args.out.glob("*.[otw]*")):
        print(f"{path.stat().st_size:8d} {path.name}")


def write_kouzan(source: Path, out: Path) -> None:
    """Both faces as TTF and together as TTC; gyosho also as OTF and WOFF2."""
    for style, file in FACES.items():
        subset(source / file, style).save(out / f"kouzan-{style}.ttf")
    gyosho = out / "kouzan-gyosho.ttf"
    as_cff(TTFont(gyosho)).save(out / "kouzan-gyosho.otf")
    as_woff2 = TTFont(gyosho, recalcTimestamp=False)
    as_woff2.flavor = "woff2"
    as_woff2.save(out / "kouzan-gyosho.woff2")
    collection = TTCollection()
    collection.fonts = [TTFont(out / f"kouzan-{style}.ttf", recalcTimestamp=False) for style in FACES]
    collection.save(out / "kouzan.ttc")


def subset(path: Path, style: str) -> TTFont:
    """The face with CHARACTERS only, without hints and layout, under a name of its own."""
    options = Options(hinting=False, notdef_outline=True, glyph_names=True)
    options.drop_tables += LEFT_OUT
    font = TTFont(path, recalcTimestamp=False)
    font["head"].created = font["head"].modified = drawn_fonts.DATE
    subsetter = Subsetter(options)
    subsetter.populate(text=CHARACTERS)
    subsetter.subset(font)
    set_names(font, f"Kouzan {style.capitalize()} Subset")
    return font


def set_names(font: TTFont, family: str) -> None:
    """A new family name: a changed font should not pass for the one it came from."""
    names = [
        "Kouzan Aoyagi; released to the public domain", family, "Regular", f"{family} Regular", family, "Version 1.0",
        family.replace(" ", ""),
    ]  # fmt: skip
    font["name"] = newTable("name")
    font["name"].names = []
    for name_id, text in enumerate(names):
        font["name"].setName(text, name_id, 3, 1, 0x409)


def as_cff(font: TTFont) -> TTFont:
    """The same outlines as CFF: quadratics raised to cubics, rounded to whole units, run the other way."""
    glyphs = font.getGlyphSet()
    builder = drawn_fonts.begun(font.getGlyphOrder(), font.getBestCmap(), cubic=True, em=font["head"].unitsPerEm)
    char_strings = {}
    for name in font.getGlyphOrder():
        pen = T2CharStringPen(glyphs[name].width, glyphs)
        glyphs[name].draw(ReverseContourPen(pen))
        char_strings[name] = pen.getCharString(optimize=False)  # the optimiser joins lines that double back
    family = font["name"].getBestFamilyName()
    builder.setupCFF(family.replace(" ", ""), {"FamilyName": family, "FullName": family}, char_strings, {})
    builder.setupHorizontalMetrics(font["hmtx"].metrics)
    builder.setupHorizontalHeader(ascent=font["hhea"].ascent, descent=font["hhea"].descent)
    builder.font["name"] = font["name"]
    builder.font["OS/2"] = font["OS/2"]
    builder.setupPost()
    return builder.font


if __name__ == "__main__":
    main()
