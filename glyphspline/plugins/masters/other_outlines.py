"""A variable font with outlines of the other kind: CFF2 as glyf with gvar, or glyf as CFF2, at every location.

Outlines alone are others, and hints gone: axes, names, advances, kerning and features stay. Composites become simple
glyphs. Quadratics are raised exactly. Cubics become quadratics by :mod:`.quadratic_masters` in runs for fonts; else,
and where no glyph was fitted so, here.
"""

from __future__ import annotations

import logging
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from fontTools.cffLib import VarStoreData
from fontTools.fontBuilder import FontBuilder
from fontTools.misc.psCharStrings import T2CharString
from fontTools.ttLib import TTFont
from fontTools.ttLib.tables._g_l_y_f import Glyph
from fontTools.varLib.builder import buildVarData, buildVarRegionList, buildVarStore
from fontTools.varLib.hvar import add_HVAR

from ...errors import GlyphsplineError
from ...fitting.first_good import first_good
from ...outlines.masters import Masters
from ...readers import Font
from ...readers.source import reusing
from ...types import MadeOnDemand
from ..fonts.tables.font_file import HINTS, become, drop
from ..fonts.tables.font_glyphs import Flavour
from ..fonts.tables.master_deltas import axes_of, region_key
from .new_variable_font import add_advances, opened
from .quadratic_contours import unchanged
from .redrawn import Redrawn, bound_of, oriented
from .variable_font import VariableSummary, to_variable_font

log = logging.getLogger("glyphspline")


def to_other_outlines(
    source: Font, redrawn: Mapping[str, Redrawn], flavour: Flavour, *, tolerance: float, rest: float,
    family: str | None = None,
) -> tuple[bytes, VariableSummary]:  # fmt: skip
    """The font as a file's bytes, with outlines of the other kind; the same input gives the same bytes.

    Args:
        source, redrawn, flavour, tolerance, family: see :func:`.variable_font.to_variable_font`; the flavour is not
            the source's.
        rest: how far quadratics may be from the cubics they are made of.

    Raises:
        GlyphsplineError: the font has no such glyph, or is broken.
    """
    every, said = dict.fromkeys(source.glyph_names), set[str]()
    masters: Mapping[str, Masters] = MadeOnDemand(every, lambda name: _masters(source, name, said))
    as_is = MadeOnDemand(every, lambda name: oriented(unchanged(masters[name]), flavour))
    near = tolerance if flavour == "otf" else rest
    with reusing(source.path, source.kind):
        empty = blank(source, masters, flavour)
    if any(new.tally is not None for new in redrawn.values()):  # then all are as they are stored
        for name in source.glyph_names:
            if name not in redrawn and masters[name].contours:
                log.warning("%s, glyph %r: not fitted: left empty in the written font", source.path, name)
        drawn = MadeOnDemand(dict.fromkeys(redrawn), lambda name: oriented(redrawn[name], flavour))
        return to_variable_font(empty, drawn, flavour, family=family)
    plain, kept = to_variable_font(empty, as_is, flavour, tolerance=near)
    for name, reason in kept.left.items():
        log.warning("%s, glyph %r: %s: left empty in the written font", source.path, name, reason)
    written = Font(source.path, plain, 0, None)

    def fonts() -> Iterator[tuple[bytes, VariableSummary, int]]:
        left = dict[str, str]()
        while True:
            wanted = [name for name in redrawn if name not in left]
            drawn = MadeOnDemand(wanted, lambda name: oriented(redrawn[name], flavour))
            data, facts = to_variable_font(written, drawn, flavour, tolerance=near, family=family)
            far = [name for name, glyph in facts.glyphs.items() if bound_of(glyph, redrawn[name]) > tolerance]
            yield data, replace(facts, left={**facts.left, **left}), len(far)
            left |= dict.fromkeys(far, "its quadratics in whole units would be beyond the tolerance")

    data, facts, _ = first_good(fonts(), lambda font: font[2:])
    return data, facts


def _masters(source: Font, name: str, said: set[str]) -> Masters:
    """A glyph, empty if it cannot be read, which is said once."""
    try:
        return source.masters(name)
    except GlyphsplineError as error:
        if name not in said:
            log.warning("%s: left empty in the written font", error)
        said.add(name)
        return Masters(name, axes=source.axes, regions=np.empty((0, len(source.axes), 3)), metrics=source.metrics)


def blank(source: Font, masters: Mapping[str, Masters], flavour: Flavour) -> Font:
    """The font with glyphs of the other kind that are empty, and take those of these masters."""
    font = source.tables()
    names = font.getGlyphOrder()
    given = dict(zip(names, source.glyph_names, strict=True))
    if "HVAR" not in font and "gvar" in font:
        for stored, name in given.items():
            if not len(masters[name].regions):  # nor is read what is beyond the limits of masters
                font["gvar"].variations[stored] = []
        add_HVAR(font)  # advances vary in gvar, which goes
    drop(font, *HINTS, "gvar", "VARC", "VORG", "DSIG")
    font.flavor = font.flavorData = None
    if flavour == "ttf":
        _set_bearings(font, {stored: masters[name] for stored, name in given.items()} if "vmtx" in font else {})
        become(font, "ttf", {name: Glyph() for name in names}, source.family)
        add_advances(font, MadeOnDemand(dict.fromkeys(names), lambda stored: masters[given[stored]]))
    else:
        _become_cff2(font, masters.values())
    return opened(font, source.path)


def _set_bearings(font: TTFont, masters: Mapping[str, Masters]) -> None:
    """Bearings of empty glyphs: those of the new ones follow from their bounds."""
    metrics = font["hmtx"].metrics
    for name, (advance, _) in metrics.items():
        metrics[name] = (advance, 0)
    for name, glyph in masters.items():
        height, top = font["vmtx"].metrics[name]
        ink = [contour.points[0, :, 1].max() for contour in glyph.contours]
        font["vmtx"].metrics[name] = (height, top + round(float(max(ink, default=0.0))))


def _become_cff2(font: TTFont, masters: Iterable[Masters]) -> None:
    """Empty char strings in place of ``glyf``, and a store with an item for each set of regions."""
    drop(font, "glyf", "loca")
    builder = FontBuilder(font=font)
    builder.isTTF = False
    builder.setupMaxp()
    builder.setupCFF2({name: T2CharString(program=[]) for name in font.getGlyphOrder()})
    items: dict[Any, list[Any]] = {}
    for glyph in masters:
        if len(glyph.regions):
            items.setdefault(tuple(sorted(map(region_key, glyph.regions))), glyph.regions.tolist())
    tags = [axis.axisTag for axis in font["fvar"].axes]
    regions: dict[Any, dict[str, Any]] = {}
    numbers = []
    for item in items.values():
        keys = [tuple(map(tuple, region)) for region in item]
        for key in keys:
            regions.setdefault(key, axes_of(tags, key))
        numbers.append([[*regions].index(key) for key in keys])
    if not regions:
        return
    varied = [buildVarData(each, None, optimize=False) for each in numbers]
    store = buildVarStore(buildVarRegionList([*regions.values()], tags), varied)
    top = font["CFF2"].cff.topDictIndex[0]
    top.VarStore = VarStoreData(otVarStore=store)
    for each in top.FDArray:
        each.Private.vstore = top.VarStore
