"""A variable font with glyphs drawn anew in all masters; everything else stays as it was.

Only outlines are replaced: the font keeps its axes, advances, kerning, features, names and every other glyph. Fonts
with cubic outlines (CFF2) get one char string a glyph, in fractions of a unit; fonts with quadratic ones (glyf) get
quadratics in whole units, which meet inside an arc midway between their control points and so without a kink.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from io import BytesIO

import numpy as np

from ...errors import GlyphsplineError, OutputError
from ...outlines.masters import MasterContour
from ...readers import Font
from ...types import BoolArray
from .font_glyphs import Flavour
from .master_deltas import Redrawn
from .variable_cff2 import CharStrings2
from .variable_glyf import Quadratics, parts_of

OUTLINES = {"CFF2": "otf", "glyf": "ttf"}
"""The tables whose glyphs can be replaced, and the format of the font that has them."""


@dataclass(frozen=True, eq=False)
class StoredGlyph:
    """A glyph as a font stores it.

    Attributes:
        contours: what is drawn, numbers rounded, in the masters of :class:`.master_deltas.Redrawn`; none if they were
            not asked for.
        inner: for each contour (m,) whether segment j begins inside an arc; in glyf, at an implied point.
        distance: the largest from the contours that were given, in font units, at the corners of the design space and
            in between. In CFF2 a bound; in glyf from dense samples.
        shortest_leg: in glyf, the least distance of an implied point from its control points, in font units and at the
            same places. Where it is 0 the curve has a corner there; where it is below a unit, renderers' single
            precision turns it by some thousandths of a degree. None if there is no such point.
    """

    contours: tuple[MasterContour, ...]
    inner: tuple[BoolArray, ...]
    distance: float
    shortest_leg: float | None = None


@dataclass(frozen=True, eq=False)
class VariableSummary:
    """The facts of a written variable font.

    Attributes:
        glyphs: those that were replaced.
        composites: those asked for that are made of components, all of them replaced.
        left: why the others have their old outlines.
    """

    glyphs: dict[str, StoredGlyph] = field(default_factory=dict)
    composites: tuple[str, ...] = ()
    left: dict[str, str] = field(default_factory=dict)

    @property
    def largest_distance(self) -> float | None:
        """The largest distance of any glyph; None if there is none."""
        return max((glyph.distance for glyph in self.glyphs.values()), default=None)


def to_variable_font(
    source: Font,
    redrawn: Mapping[str, Redrawn],
    flavour: Flavour,
    *,
    tolerance: float = 0.5,
    with_contours: bool = True,
) -> tuple[bytes, VariableSummary]:
    """The font as a file's bytes; the same input gives the same bytes.

    Args:
        source: a variable font.
        redrawn: glyph name to its new contours, read one by one. Composites stay so: redraw their components, see
            :func:`components`.
        flavour: "otf" for a font with CFF2 outlines, "ttf" for one with glyf.
        tolerance: for "ttf", how far the quadratics, rounded, may be from the contours given, in font units. A glyph
            that cannot be so close is written as close as it was found: see ``distance``.
        with_contours: whether the summary has what is drawn, which is much of a large font.

    Raises:
        OutputError: the font is not variable, or has the other kind of outlines.
        GlyphsplineError: the font has no such glyph.
    """
    check_flavour(source, flavour)
    font = source.tables()
    font.recalcBBoxes = False
    if "DSIG" in font and getattr(font["DSIG"], "signatureRecords", None):
        del font["DSIG"]  # a signature of the bytes as they were
    names = font.getGlyphOrder()
    gids = {name: gid for gid, name in enumerate(source.glyph_names)}
    glyphs: dict[str, StoredGlyph] = {}
    composites, left = [], {}
    strings = CharStrings2(font) if flavour == "otf" else None
    quadratics = Quadratics(font) if flavour == "ttf" else None
    made = set(font["VARC"].table.Coverage.glyphs) if "VARC" in font else set()
    for name, new in redrawn.items():
        if name not in gids:
            raise GlyphsplineError("the font has no such glyph", font=str(source.path), glyph=name)
        stored = names[gids[name]]
        if stored in made:
            left[name] = "made of variable components (VARC)"
            continue
        if quadratics and font["glyf"][stored].isComposite():
            parts = [source.glyph_names[font.getGlyphID(part)] for part in parts_of(font, stored)]
            old = [part for part in parts if part not in redrawn]
            if old:
                left[name] = f"its component {old[0]} keeps its outline"
            else:
                composites.append(name)
            continue
        try:
            if strings:
                found = StoredGlyph(*strings.replace(stored, new))
            else:
                assert quadratics
                found = StoredGlyph(*quadratics.replace(stored, new, tolerance))
            glyphs[name] = found if with_contours else replace(found, contours=(), inner=())
        except GlyphsplineError as error:
            left[name] = error.message
        except np.linalg.LinAlgError:
            left[name] = "no quadratics could be fitted to its curves"
    if quadratics:
        quadratics.finish()
    file = BytesIO()
    font.save(file, reorderTables=False)
    return file.getvalue(), VariableSummary(glyphs, tuple(composites), left)


def check_flavour(source: Font, flavour: Flavour) -> None:
    """Refuse to write outlines of the other kind.

    Raises:
        OutputError: the font is not variable, or has other outlines.
    """
    if not source.axes:
        raise OutputError("is not variable: it has no masters", font=str(source.path))
    tables = source.tables()
    table = next((tag for tag in OUTLINES if tag in tables), None)
    if table is None:
        raise OutputError("has neither CFF2 nor glyf outlines", font=str(source.path))
    if OUTLINES[table] != flavour:
        article = "an" if flavour == "otf" else "a"
        possible = f"its masters can be written as {OUTLINES[table]}, which replaces them, or as ufo"
        raise OutputError(f"has {table} outlines, not those of {article} {flavour}: {possible}", font=str(source.path))


def components(source: Font, names: tuple[str, ...]) -> tuple[str, ...]:
    """The glyphs to redraw, so that those named are: components, at any depth, in place of composites."""
    font = source.tables()
    if "glyf" not in font:
        return tuple(dict.fromkeys(names))
    gids = {name: gid for gid, name in enumerate(source.glyph_names)}
    order = font.getGlyphOrder()
    found = [part for name in names for part in parts_of(font, order[gids[name]])]
    return tuple(dict.fromkeys(source.glyph_names[font.getGlyphID(part)] for part in found))
