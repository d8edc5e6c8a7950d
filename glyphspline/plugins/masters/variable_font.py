"""A variable font with glyphs drawn anew in all masters; everything else stays as it was.

Only outlines are replaced: the font keeps its axes, advances, kerning, features, names and every other glyph. Fonts
with cubic outlines (CFF2) get one char string a glyph, in fractions of a unit; fonts with quadratic ones (glyf) get
quadratics in whole units, which meet inside an arc midway between their control points and so without a kink.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import islice
from typing import Any

import numpy as np
from fontTools.cffLib import maxStackLimit
from fontTools.cffLib.specializer import commandsToProgram, specializeCommands
from fontTools.misc.psCharStrings import T2CharString
from fontTools.ttLib import TTFont

from ...errors import GlyphsplineError, OutputError
from ...outlines.contour_arrays import lines_and_cubics
from ...outlines.masters import MasterContour, Masters
from ...readers import Font
from ...readers.source import reusing
from ...types import Head, IntArray, counted
from ..fonts.tables.font_file import drop_signature, replace_family, saved, stored_names
from ..fonts.tables.font_glyphs import LIMIT, Flavour, drop_endless, parts_of, put_string, scales
from ..fonts.tables.master_deltas import PARTS, blend, check_steps, order_of, regions_of, rounded_deltas
from .quadratic_glyphs import Quadratics
from .redrawn import Redrawn, StoredGlyph, displaced
from .stretches import NOTHING_NEW, StretchPlan, fewest, settle, tally
from .variations import Variations, executed

LONGEST = 65535
"""Bytes of the longest char string that readers have to take."""

OUTLINES: dict[str, Flavour] = {"CFF2": "otf", "glyf": "ttf"}
"""The tables whose glyphs can be replaced, and the format of the font that has them."""


@dataclass(frozen=True, eq=False)
class VariableSummary:
    """The facts of a written variable font.

    Attributes:
        glyphs: those that were replaced. composed: of composites of these, certified bounds of the distances from the
            source, where they are known.
        left: why others have their old outlines; not composites whose components were all replaced.
    """

    glyphs: dict[str, StoredGlyph] = field(default_factory=dict)
    left: dict[str, str] = field(default_factory=dict)
    composed: dict[str, float] = field(default_factory=dict)

    @property
    def tally(self) -> IntArray | None:
        """Of all glyphs replaced; None where they were not compared."""
        found = [glyph.tally for glyph in self.glyphs.values() if glyph.tally is not None]
        return np.sum(found, axis=0) if found else None


def to_variable_font(
    source: Font,
    redrawn: Mapping[str, Redrawn],
    flavour: Flavour,
    *,
    tolerance: float = 0.5,
    family: str | None = None,
) -> tuple[bytes, VariableSummary]:
    """The font as a file's bytes; the same input gives the same bytes.

    Args:
        source: a variable font.
        redrawn: glyph name to its new contours, read one by one. Composites stay so: redraw their components, see
            :func:`components`.
        flavour: "otf" for a font with CFF2 outlines, "ttf" for one with glyf.
        tolerance: for "ttf", how far the quadratics, rounded, may be from the contours given, in font units; of
            contours with bounds, how far from their source. A glyph that cannot be so close is written as close as it
            was found, see ``distance``, or where it has bounds stays as it is.
        family: its new family name; None keeps the source's.

    Raises:
        OutputError: the font is not variable, or has the other kind of outlines.
        GlyphsplineError: the font has no such glyph.
    """
    if (own := flavour_of(source)) != flavour:
        raise OutputError(f"has the outlines of {own}, not of {flavour}", font=str(source.path))
    glyphs, left = dict[str, StoredGlyph](), dict[str, str]()
    with reusing(source.path, source.kind):
        font = source.tables()
        font.recalcBBoxes = False
        drop_signature(font)
        if "glyf" in font:
            drop_endless(font)
        names = stored_names(source, font)
        quadratics = Quadratics(font) if flavour == "ttf" else None
        write = partial(quadratics.replace, tolerance=tolerance) if quadratics else CharStrings2(font).replace
        made = set(font["VARC"].table.Coverage.glyphs) if "VARC" in font else set()
        for name, new in redrawn.items():
            if name not in names:
                raise GlyphsplineError("the font has no such glyph", font=str(source.path), glyph=name)
            stored = names[name]
            if stored in made:
                left[name] = "made of variable components (VARC)"
                continue
            if quadratics and font["glyf"][stored].isComposite():
                parts = [source.glyph_names[font.getGlyphID(part)] for part in parts_of(font, stored)]
                old = [part for part in parts if part not in redrawn]
                if old:
                    left[name] = f"its component {old[0]} keeps its outline"
                continue
            try:
                glyphs[name] = write(stored, new)
            except GlyphsplineError as error:
                left[name] = error.message
            except np.linalg.LinAlgError:
                left[name] = "no quadratics could be fitted to its curves"
        if quadratics:
            quadratics.finish()
        if family is not None:
            replace_family(font, family)
        data = saved(font)
        composed = _composed(font, names, glyphs, redrawn) if quadratics else {}
    return data, VariableSummary(glyphs, left, composed)


def _composed(
    font: TTFont, names: Mapping[str, str], glyphs: Mapping[str, StoredGlyph], redrawn: Mapping[str, Redrawn]
) -> dict[str, float]:
    """Bounds of the composites among the glyphs that were to be redrawn: of their components, as large as these are."""
    given, found = {stored: name for name, stored in names.items()}, dict[str, float]()
    for name in redrawn:
        if font["glyf"][names[name]].isComposite():
            parts = [(given[part], scale) for part, scale in scales(font, names[name]).items()]
            bounds = [(scale, glyphs[part].bound) for part, scale in parts if part in glyphs]
            if known := [scale * bound for scale, bound in bounds if bound is not None]:
                found[name] = max(known)
    return found


def flavour_of(source: Font) -> Flavour:
    """Which outlines a variable font has.

    Raises:
        OutputError: the font is not variable, or has neither.
    """
    if not source.axes:
        raise OutputError("is not variable: it has no masters", font=str(source.path))
    tables = source.tables()
    table = next((tag for tag in OUTLINES if tag in tables), None)
    if table is None:
        raise OutputError("has neither CFF2 nor glyf outlines", font=str(source.path))
    return OUTLINES[table]


def components(source: Font, names: tuple[str, ...]) -> tuple[str, ...]:
    """The glyphs to redraw, so that those named are: components, at any depth, in place of composites."""
    font = source.tables()
    if "glyf" not in font:
        return tuple(dict.fromkeys(names))
    stored, found = stored_names(source, font), list[str]()
    for name in names:
        with suppress(Exception):  # of a broken composite, which is an error when it is read
            found += parts_of(font, stored[name])
    return tuple(dict.fromkeys(source.glyph_names[font.getGlyphID(part)] for part in found))


class CharStrings2:
    """The char strings of a font, to be replaced one by one. Those of other glyphs keep their bytes."""

    def __init__(self, font: TTFont) -> None:
        self._font, self._regions = font, regions_of(font)
        self._strings = font["CFF2"].cff.topDictIndex[0].CharStrings

    def replace(self, name: str, redrawn: Redrawn) -> StoredGlyph:
        """Replace a glyph.

        Raises:
            GlyphsplineError: its regions are not those of any item of the font's store, or it is too long.
        """
        masters = redrawn.masters
        old = self._strings[name]
        contours, inner, tallied = redrawn.contours, redrawn.inner, None
        if redrawn.bounds:
            plans = [StretchPlan(redrawn, c) for c in range(len(contours))]
            if redrawn.fewest:
                fewest(plans)
            turning = settle(masters, lambda: [plan.stored() for plan in plans], lambda c, own: plans[c].retreat(own))
            if plans and all(plan.is_own for plan in plans):
                raise GlyphsplineError(NOTHING_NEW, glyph=name)
            contours, inner = tuple(plan.stored() for plan in plans), tuple(plan.inside() for plan in plans)
            before, after = sum(map(len, masters.contours)), sum(map(len, contours))
            if redrawn.fewest and after > before:
                raise GlyphsplineError(f"it would have {counted(after, 'point')}, not {before}")
            tallied = tally((before, after), turning)
        contours = tuple(cubic(contour) for contour in contours)
        if (points := sum(len(contour.points[0]) for contour in contours)) > LONGEST:  # of a byte each at least
            raise GlyphsplineError(f"{points} points, more than fit into a char string", glyph=name)
        steps = [rounded_deltas(masters, contour.points, PARTS) for contour in contours]
        for each in steps:
            check_steps(each, PARTS, name)
        varies = any(each[1:].any() for each in steps)
        index, order = self._place(masters, old) if varies else (0, [])
        commands = drawing([each[[0, *order]] for each in steps], contours, name)
        program = commandsToProgram(
            specializeCommands(commands, generalizeFirst=False, preserveTopology=True, maxstack=maxStackLimit)
        )
        if varies and index != getattr(old.private, "vsindex", 0):
            program = [index, "vsindex", *program]
        new = T2CharString(program=program, private=old.private, globalSubrs=old.globalSubrs)
        new.compile(isCFF2=True)
        if len(new.bytecode) > LONGEST:
            raise GlyphsplineError(
                f"its char string would have {len(new.bytecode)} bytes, more than {LONGEST}", glyph=name
            )
        put_string(self._strings, name, new)
        reader = Variations(self._font, masters.axes, masters.metrics)
        read = reader.masters(Head(name, self._font.getGlyphID(name), ()))
        far = displaced(read, replace(masters, contours=contours))
        bound = max(redrawn.bounds) + far if redrawn.bounds else None
        return StoredGlyph(inner, far, bound, tallied)

    def _place(self, masters: Masters, old: Any) -> tuple[int, list[int]]:
        """The index of the item of the store that has just their regions, and the numbers of masters in its order."""
        reader = executed(T2CharString(bytecode=old.bytecode, private=old.private, globalSubrs=old.globalSubrs))
        for index in (reader.vsIndex, *range(len(self._regions))):
            if index < len(self._regions) and (order := order_of(self._regions[index], masters)) is not None:
                return index, order
        raise GlyphsplineError(f"no item of the font's variation store has just its {len(masters) - 1} regions")


def cubic(contour: MasterContour) -> MasterContour:
    """The contour with lines and cubics alone: quadratics raised, exactly."""
    if not (contour.degrees == 2).any():
        return contour
    return MasterContour(*lines_and_cubics(contour.cubics(), contour.degrees == 1))


def drawing(steps: list[IntArray], contours: Sequence[MasterContour], name: str) -> list[tuple[str, list[Any]]]:
    """The commands that draw contours of default and deltas, (K, N, 2) in steps, each of whose arguments is blended.

    All masters are in one command, so that no master has another operator than the others.
    """
    commands: list[tuple[str, list[Any]]] = []
    at = np.zeros((len(steps[0]) if steps else 1, 1, 2), dtype=np.int64)
    for each, contour in zip(steps, contours, strict=True):
        path = np.concatenate([at, each, each[:, :1]], axis=1)
        moves = np.diff(path, axis=1)
        if moves.size and np.abs(moves).max() > LIMIT * PARTS:
            raise GlyphsplineError(f"steps beyond {LIMIT} do not fit into a font", glyph=name)
        blended = [[blend(column) for column in point] for point in (moves.transpose(1, 2, 0) / PARTS).tolist()]
        commands.append(("rmoveto", blended[0]))
        rest = iter(blended[1:])
        for degree in contour.degrees.tolist():
            own = [arg for point in islice(rest, degree) for arg in point]
            commands.append(("rrcurveto" if degree == 3 else "rlineto", own))
        if contour.degrees[-1] == 1:
            commands.pop()  # the line back to the start is drawn by the end of the contour
        at = each[:, -1:] if contour.degrees[-1] == 1 else each[:, :1]
    return commands
