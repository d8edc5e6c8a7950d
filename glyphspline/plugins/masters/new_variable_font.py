"""A variable font built from single fonts, whose glyphs were matched and drawn in all masters.

The default font gives all tables; quadratic outlines and the advances of the matched glyphs vary, nothing else does.
Kerning, features, vertical metrics and all other glyphs are the default's at every location.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from io import BytesIO
from pathlib import Path

import numpy as np
from fontTools.fontBuilder import FontBuilder
from fontTools.otlLib.builder import buildStatTable
from fontTools.ttLib import TTFont
from fontTools.ttLib.tables.TupleVariation import TupleVariation
from fontTools.varLib import set_default_weight_width_slant
from fontTools.varLib.hvar import add_HVAR
from fontTools.varLib.instancer import setMacOverlapFlags

from ...errors import GlyphsplineError, OutputError
from ...outlines.masters import DesignAxis, Masters
from ...readers import Font, Source
from ...types import MadeOnDemand
from ..fonts.tables.font_file import postscript, saved, stored_names, to_font
from ..fonts.tables.font_glyphs import decomposed, users
from ..fonts.tables.master_deltas import axes_of, check_steps, rounded_deltas
from ..fonts.tables.variable_glyf import PHANTOMS
from .redrawn import Redrawn, oriented
from .single_fonts import axis_of
from .variable_font import VariableSummary, to_variable_font

ELIDABLE = "Regular"
"""The style that is left out of the names of others."""


def to_new_variable_font(
    sources: Sequence[Source],
    axis: str,
    redrawn: Mapping[str, Redrawn],
    *,
    tolerance: float = 0.5,
    family: str | None = None,
) -> tuple[bytes, VariableSummary]:
    """The font as a TTF's bytes; the same input gives the same bytes.

    Args:
        sources: single fonts, UFOs or drawings, the default first; of at least two. Its named instances are these.
        axis: like "wght=300:700", a value a font.
        redrawn: name of a glyph in the default to its contours in all masters, read one by one. The masters are those
            of :func:`.single_fonts.masters_of_fonts` for the same fonts and axis. Composites are written as
            simple glyphs. All others look as in the default everywhere.
        tolerance: how far the quadratics, rounded, may be from the contours given, in units of the default.
        family: its name; None is the default's with "Spline".

    Raises:
        FontError: the axis is none for these fonts, or the default cannot become a font.
        OutputError: no glyph varies, or masters belong to another axis.
        GlyphsplineError: the default has no such glyph.
    """
    design, values = axis_of(axis, len(sources))
    default = sources[0]
    _check(default, design, redrawn)
    font = TTFont(BytesIO(to_font(default, (), "ttf", family=family)[0]), recalcTimestamp=False)
    names = stored_names(default, font)
    given = {names[name]: name for name in redrawn}
    styles = _styles(sources, values)
    _add_axis(font, design, dict(zip(styles, values, strict=True)), family or f"{default.family} Spline")
    add_advances(font, MadeOnDemand(given, lambda stored: redrawn[given[stored]].masters))
    drawn = MadeOnDemand(given, lambda stored: _as_new(redrawn[given[stored]]))
    data, summary = to_variable_font(opened(font, default.path), drawn, "ttf", tolerance=tolerance)
    glyphs = {given[stored]: glyph for stored, glyph in summary.glyphs.items()}
    left = {given[stored]: reason for stored, reason in summary.left.items()}
    return _finished(data, list(summary.left)), replace(summary, glyphs=glyphs, left=left)


def _as_new(new: Redrawn) -> Redrawn:
    """A glyph of which the font in the making holds no contour: what it has there is the default's."""
    return replace(oriented(new, "ttf"), numbers=(-1,) * len(new.contours))


def _check(default: Source, design: DesignAxis, redrawn: Mapping[str, Redrawn]) -> None:
    if not redrawn:
        raise OutputError("no glyph varies", font=str(default.path))
    known = set(default.glyph_names)
    for name, new in redrawn.items():
        if name not in known:
            raise GlyphsplineError("the font has no such glyph", font=str(default.path), glyph=name)
        if new.masters.axes != (design,):
            raise OutputError(f"its masters are not along {design.tag} alone", font=str(default.path), glyph=name)


def _styles(sources: Sequence[Source], values: Sequence[float]) -> list[str]:
    """Names of the instances: the styles of the fonts, with the values where fonts have the same style."""
    styles = [source.style for source in sources]
    if len(set(styles)) == len(styles):
        return styles
    return [f"{style} {value:g}" for style, value in zip(styles, values, strict=True)]


def _add_axis(font: TTFont, design: DesignAxis, instances: Mapping[str, float], family: str) -> None:
    """Axis, instances and their names: ``fvar`` and ``STAT``, and the default's place in ``OS/2``."""
    font["name"].setName(postscript(family), 25, 3, 1, 0x409)  # PostScript names of instances begin so
    builder = FontBuilder(font=font)
    axes = [(design.tag, design.minimum, design.default, design.maximum, design.name)]
    places = [{"location": {design.tag: value}, "stylename": style} for style, value in instances.items()]
    builder.setupFvar(axes, places)
    named = [
        {"value": value, "name": style, "flags": 0x2 if style == ELIDABLE else 0}
        for style, value in sorted(instances.items(), key=lambda pair: pair[1])
    ]
    stat = [{"tag": design.tag, "name": design.name, "values": named}]
    buildStatTable(font, stat, elidedFallbackName=ELIDABLE, macNames=False)
    set_default_weight_width_slant(font, {design.tag: design.default})


def add_advances(font: TTFont, masters: Mapping[str, Masters]) -> None:
    """``gvar`` with the advances of glyphs, and points that do not move yet; the glyphs are simple afterwards."""
    glyf, metrics = font["glyf"], font["hmtx"].metrics
    # What has a component that varies would vary with it.
    simple = {name: decomposed(glyf, name) for name in users(font, masters) if glyf[name].isComposite()}
    for name, glyph in simple.items():
        glyf[name] = glyph
        glyph.recalcBounds(glyf)
    setMacOverlapFlags(glyf)  # contours that are apart in one master may overlap in another
    variations: dict[str, list[TupleVariation]] = {}
    for name, glyph in masters.items():
        advances = np.stack([glyph.advances, np.zeros(len(glyph))], axis=1)[:, None]
        steps = rounded_deltas(glyph, advances, 1)
        check_steps(steps, 1, name)
        metrics[name] = (int(steps[0, 0, 0]), metrics[name][1])
        count = len(getattr(glyf[name], "coordinates", ())) + PHANTOMS
        variations[name] = []
        for region, delta in zip(glyph.regions.tolist(), steps[1:, 0].tolist(), strict=True):
            deltas = [(0, 0)] * count
            deltas[1 - PHANTOMS] = tuple(delta)
            axes = axes_of([axis.tag for axis in glyph.axes], region)
            variations[name].append(TupleVariation(axes, deltas))
    FontBuilder(font=font).setupGvar(variations)


def opened(font: TTFont, path: Path) -> Font:
    """A font that is being built, as a source."""
    return Font(path, saved(font), 0, None)


def _finished(data: bytes, static: Sequence[str]) -> bytes:
    """The font with ``HVAR``, and without variations of the glyphs that kept their outlines."""
    font = TTFont(BytesIO(data), recalcBBoxes=False, recalcTimestamp=False)
    for name in static:
        font["gvar"].variations[name] = []
    add_HVAR(font)
    return saved(font)
