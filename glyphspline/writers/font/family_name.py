"""Another family name for a variable font: licences reserve that of the source."""

from __future__ import annotations

from fontTools.ttLib import TTFont

from .font_file import postscript

TRADEMARK, STYLES = 7, (17, 2)
FAMILY, WITH_STYLE, POSTSCRIPT = (1, 16, 21), (3, 4, 18), (6, 20)
PREFIX = 25
"""Of the PostScript names of instances."""


def replace_family(font: TTFont, family: str) -> None:
    """Replace the family name in all names that have it, those of named instances too; the trademark is removed.

    Styles, and whatever else axes, instances and features are called, stay.
    """
    if "name" not in font:
        return
    names = font["name"]
    old = names.getBestFamilyName() or ""
    style = next((name for name in map(names.getDebugName, STYLES) if name), "Regular")
    names.removeNames(nameID=TRADEMARK)
    styles = dict.fromkeys((*WITH_STYLE, *POSTSCRIPT), style)
    for instance in font["fvar"].instances if "fvar" in font else ():
        if instance.postscriptNameID != 0xFFFF:
            styles[instance.postscriptNameID] = names.getDebugName(instance.subfamilyNameID) or style
    known = {*FAMILY, PREFIX, *styles}
    for record in [each for each in names.names if each.nameID in known]:
        text, identity = record.toUnicode(errors="replace"), record.nameID
        if identity in FAMILY:
            new = text.replace(old, family, 1) if old and old in text else family
        elif identity == PREFIX:
            new = postscript(family)
        elif identity in WITH_STYLE:
            new = text.replace(old, family, 1) if old and old in text else f"{family} {styles[identity]}"
        else:
            new = postscript(f"{family}-{styles[identity]}")
        names.setName(new, identity, record.platformID, record.platEncID, record.langID)
