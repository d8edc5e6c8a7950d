"""Points moved in a TTF or OTF, static or variable: the glyphs' own records change, and nothing else in the font.

In ``glyf`` the coordinates of a glyph change, and in ``gvar`` the deltas of its points, in whole units: flags,
instructions and all other points stay. In ``CFF`` and ``CFF2`` the numbers of a glyph's char string change, of which
subroutines become part; hints stay. Bounds follow, and left side bearings where a glyph's left edge moved.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from io import BytesIO
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from fontTools.cffLib import maxStackLimit
from fontTools.cffLib.specializer import commandsToProgram, generalizeCommands, programToCommands, specializeCommands
from fontTools.cffLib.transforms import desubroutinizeCharString
from fontTools.misc.psCharStrings import T2CharString
from fontTools.ttLib.tables._g_l_y_f import Glyph, GlyphCoordinates, flagOnCurve
from fontTools.ttLib.tables.DefaultTable import DefaultTable
from fontTools.ttLib.tables.TupleVariation import TupleVariation
from fontTools.varLib.iup import iup_delta

from ...errors import GlyphsplineError, OutputError
from ...files import write_whole
from ...outlines.masters import MasterContour, Masters, quadratics
from ...readers import Font
from ...readers.opentype.variations import executed
from ...types import BoolArray, FloatArray, IntArray
from ..font.font_glyphs import put_string
from ..font.master_deltas import region_key, rounded_deltas
from ..font.quadratic_contours import PHANTOMS
from ..font.variable_font import CharStrings2, blend
from ..font.variable_glyf import Gvar, placed_by_points, put_glyphs

NEAR = 2e-3
"""Units within which a contour as it is stored is the one that was read."""

OUTLINES = ("glyf", "loca", "gvar", "CFF ", "CFF2")
BOUNDS = ("head", "hmtx", "vmtx", "hhea", "vhea", "maxp")
"""Tables that hold outlines, and those that follow where bounds change."""

OTHERWISE = "is read otherwise than it is stored"
REGIONS = "varies in regions that its masters have not"


@dataclass(frozen=True, eq=False)
class Stored:
    """The contours of a glyph that a font stores in its record.

    Attributes:
        owns: the number that each has in the outline; None of one left out there. why: why others of the outline's
            contours cannot be written, by number.
        masters: what the font makes of the glyph with other points: numbers rounded.
        put: put such a glyph into the font.
    """

    owns: Sequence[int | None]
    why: Mapping[int, str]
    masters: Callable[[Masters], Masters]
    put: Callable[[Masters], None]


@lru_cache(maxsize=1)
def edit_of(source: Font) -> FontEdit:
    """The edit of a font, opened once in a process."""
    return FontEdit(source)


class FontEdit:
    """A font whose points are moved, glyph by glyph.

    Raises:
        OutputError: it is one of a collection.
    """

    def __init__(self, source: Font) -> None:
        if source.num_faces > 1:
            raise OutputError("is one of a collection of fonts, which are not mended", font=str(source.path))
        self.source = source
        self.font = font = source.tables()
        font.recalcBBoxes = False
        self._names = dict(zip(source.glyph_names, font.getGlyphOrder(), strict=True))
        self._new: dict[str, Glyph] = {}
        if "glyf" in font:
            self._gvar = Gvar(font) if "gvar" in font else None
            self._counted = placed_by_points(font)

    def stored(self, glyph: Masters) -> Stored:
        """A glyph, as it was read, in the font."""
        name = self._names[glyph.name]
        if "glyf" in self.font:
            return self._of_glyf(name, glyph)
        return self._of_char_string(name, glyph)

    def written(self) -> bytes:
        """The font as a file's bytes; tables that hold no outlines are as they were."""
        font, source = self.font, self.source
        is_glyf = "glyf" in font
        follows = put_glyphs(font, self._new) if is_glyf else False
        if is_glyf and self._gvar is not None:
            self._gvar.store(font)
        if getattr(font.get("DSIG"), "signatureRecords", None):
            del font["DSIG"]  # a signature of the bytes as they were
        for tag in font.reader.keys() if font.reader else ():
            if tag in font.tables and tag not in OUTLINES and not (tag == "head" or (follows and tag in BOUNDS)):
                raw = DefaultTable(tag)
                raw.data = font.reader[tag]
                font.tables[tag] = raw
        font.flavor = {"WOFF": "woff", "WOFF2": "woff2"}.get(source.format)
        file = BytesIO()
        font.save(file, reorderTables=False)
        return file.getvalue()

    def _of_glyf(self, name: str, glyph: Masters) -> Stored:
        glyf, font = self.font["glyf"], self.font
        record = glyf[name]
        if record.isComposite() or not record.numberOfContours:
            return Stored((), {}, lambda new: new, _no)
        coordinates, control = glyf._getCoordinatesAndControls(name, font["hmtx"].metrics)
        on = np.array([bool(flag & flagOnCurve) for flag in control.flags])
        given = self._gvar.variations(name) if self._gvar is not None else []
        keys = {region_key(region): 1 + k for k, region in enumerate(glyph.regions)}
        numbers = [keys.get(region_key(self._gvar.region(each)), 0) for each in given] if self._gvar else []
        deltas = np.zeros((len(glyph), len(coordinates), 2))
        deltas[0] = coordinates
        for k, variation in zip(numbers, given, strict=True):
            deltas[k] += np.array(iup_delta(variation.coordinates, coordinates, control.endPts)) if k else 0.0
        scalars = glyph.scalars(glyph.peaks)
        drawn = np.einsum("kj,jnc->knc", scalars, deltas)
        lefts = drawn[:, -PHANTOMS, 0].copy()
        points = drawn[:, :-PHANTOMS]
        points[:, :, 0] -= lefts[:, None]
        ends = [end + 1 for end in control.endPts]
        parts = [(a, b, quadratics(points[:, a:b], on[a:b])[:2]) for a, b in pairwise([0, *ends])]
        owns, why = _matched(glyph, [part[2] for part in parts])
        if name in self._counted:
            why = dict.fromkeys(range(len(glyph.contours)), f"has points by which {self._counted[name]} is composed")
        elif 0 in numbers or len(set(numbers)) < len(numbers):
            why = dict.fromkeys(range(len(glyph.contours)), REGIONS)

        def moved(new: Masters) -> tuple[IntArray, list[list[tuple[int, int] | None]]]:
            """(n, 2) the default's coordinates, and of each variation the deltas."""
            whole, changed = points.copy(), np.zeros(len(on), dtype=bool)
            for (a, b, _), index in zip(parts, owns, strict=True):
                if index is not None and not np.array_equal(new.contours[index].points, glyph.contours[index].points):
                    whole[:, a:b] = as_points(new.contours[index].points, on[a:b])
                    changed[a:b] = (np.abs(whole[:, a:b] - points[:, a:b]) > NEAR).any(axis=(0, 2))
            whole[:, :, 0] += lefts[:, None]
            wanted = np.einsum("kj,jnc->knc", np.linalg.inv(scalars), whole)
            steps = rounded_deltas(glyph, whole, 1)
            default = np.where(changed[:, None], steps[0], np.array(coordinates)[:-PHANTOMS]).astype(np.int64)
            found = []
            for k, variation in zip(numbers, given, strict=True):
                own = list(variation.coordinates)
                for a, b in pairwise([0, *ends]):
                    if changed[a:b].any():
                        own[a:b] = given_deltas(own[a:b], changed[a:b], steps[k, a:b], wanted[k, a:b], default[a:b])
                found.append(own)
            return default, found

        def masters(new: Masters) -> Masters:
            default, found = moved(new)
            whole = deltas.copy()
            whole[0, :-PHANTOMS] = default
            every = [*map(tuple, default.tolist()), *coordinates[-PHANTOMS:]]
            for k, own in zip(numbers, found, strict=True):
                whole[k] = np.array(iup_delta(own, every, control.endPts))
            drawn = np.einsum("kj,jnc->knc", scalars, whole)[:, :-PHANTOMS]
            drawn[:, :, 0] -= lefts[:, None]
            contours = list(new.contours)
            for (a, b, _), index in zip(parts, owns, strict=True):
                if index is not None and contours[index] is not glyph.contours[index]:
                    contours[index] = MasterContour(*quadratics(drawn[:, a:b], on[a:b])[:2])
            return replace(new, contours=contours)

        def put(new: Masters) -> None:
            default, found = moved(new)
            record.coordinates = GlyphCoordinates(default.tolist())
            self._new[name] = record
            if self._gvar is not None:
                changed = [TupleVariation(each.axes, own) for each, own in zip(given, found, strict=True)]
                self._gvar.put(font.getGlyphID(name), changed)

        return Stored(owns, why, masters, put)

    def _of_char_string(self, name: str, glyph: Masters) -> Stored:
        font = self.font
        table = "CFF2" if "CFF2" in font else "CFF "
        strings = font[table].cff.topDictIndex[0].CharStrings
        old = strings[name]
        why = dict.fromkeys(range(len(glyph.contours)), OTHERWISE)
        commands, order = self._commands(old, glyph)
        if commands is None:
            return Stored((), why, lambda new: new, _no)
        if order is None:
            return Stored((), dict.fromkeys(why, REGIONS), lambda new: new, _no)
        read = drawn_by(commands, len(order))
        scalars = glyph.scalars(glyph.peaks)[:, [0, *order]]
        owns, why = _matched(glyph, [closed(np.einsum("kj,njc->knc", scalars, p), d) for _, p, d in read])
        varies = np.linalg.inv(glyph.scalars(glyph.peaks))

        def put(new: Masters) -> None:
            whole = [(places, points.copy()) for places, points, _ in read]
            for (_, points), index in zip(whole, owns, strict=True):
                if index is None:
                    continue
                moves = new.contours[index].points - glyph.contours[index].points
                change = np.einsum("kj,jnc->nkc", varies, moves)
                if np.abs(np.delete(change, [0, *order], axis=1)).max(initial=0.0) > NEAR:
                    raise GlyphsplineError(REGIONS, glyph=glyph.name)
                count = moves.shape[1]
                points[:count] += change[:, [0, *order]]
                points[count:] += change[:1, [0, *order]]  # a contour that ends where it begins
            with_points(commands, whole)
            # Type 2 char strings of CFF have a stack of 48.
            stack = maxStackLimit if table == "CFF2" else 48
            program = commandsToProgram(
                specializeCommands(commands, generalizeFirst=False, preserveTopology=True, maxstack=stack)
            )
            made = T2CharString(program=program, private=old.private, globalSubrs=old.globalSubrs)
            made.compile(isCFF2=table == "CFF2")
            put_string(strings, name, made)

        return Stored(owns, why, lambda new: new, put)

    def _commands(self, old: Any, glyph: Masters) -> tuple[list[Any] | None, list[int] | None]:
        """A char string as single moves, lines and curves, and the masters of its regions in order; None if unlike."""
        private = old.private
        copy = T2CharString(bytecode=old.bytecode, program=old.program, private=private, globalSubrs=old.globalSubrs)
        desubroutinizeCharString(copy)
        reader = executed(copy)
        order: list[int] | None = []
        regions: list[FloatArray] = []
        if getattr(reader, "numRegions", None):
            regions = CharStrings2(self.font).regions[reader.vsIndex]
            known = {region_key(region): 1 + k for k, region in enumerate(glyph.regions)}
            keys = [region_key(region) for region in regions]
            order = [known[key] for key in keys] if set(keys) == known.keys() and len(keys) == len(known) else None
        start = getattr(private, "vsindex", 0) or 0
        commands = programToCommands(copy.program, lambda _: len(regions), vsIndex=start)
        try:
            found = [each for command in generalizeCommands(commands) for each in unflexed(*command)]
        except ValueError:  # more or fewer numbers than an operator takes
            return None, order
        return found, order


def _no(_: Masters) -> None:
    raise AssertionError("a glyph without contours of its own has nothing to put")


def _matched(glyph: Masters, stored: Sequence[tuple[FloatArray, IntArray]]) -> tuple[list[int | None], dict[int, str]]:
    """The numbers of stored contours in the outline, and the contours of that which are none of them."""
    owns: list[int | None] = []
    at = 0
    for points, degrees in stored:
        own = glyph.contours[at] if at < len(glyph.contours) else None
        alike = own is not None and own.points.shape == points.shape and np.array_equal(own.degrees, degrees)
        if alike and own is not None and np.allclose(own.points, points, rtol=0, atol=NEAR):
            owns.append(at)
            at += 1
        else:
            owns.append(None)
    return owns, dict.fromkeys(range(at, len(glyph.contours)), OTHERWISE)


def as_points(whole: FloatArray, on: BoolArray) -> FloatArray:
    """(K, n, 2) the points of a contour of ``glyf`` from those of :func:`.masters.quadratics`."""
    turned = on[-1] and not on[0]
    kinds = np.roll(on, 1) if turned else on
    places = np.arange(len(on)) + np.cumsum(~kinds & ~np.roll(kinds, 1))
    found: FloatArray = whole[:, places]
    return np.roll(found, -1, axis=1) if turned else found


def given_deltas(
    old: Sequence[tuple[int, int] | None], changed: BoolArray, steps: IntArray, wanted: FloatArray, points: IntArray
) -> list[tuple[int, int] | None]:
    """The deltas of a contour in a variation; None where they are inferred, as they were, and are still near enough.

    Args:
        old: as they were. changed: (n,) points that moved. steps, wanted: (n, 2) deltas, rounded and not.
        points: (n, 2) of the default.
    """
    whole = [(int(x), int(y)) for x, y in steps.tolist()]
    found: list[tuple[int, int] | None] = [
        new if moved else was for was, new, moved in zip(old, whole, changed.tolist(), strict=True)
    ]
    every = [*map(tuple, points.tolist()), *[(0, 0)] * PHANTOMS]
    while None in found:
        inferred = np.array(iup_delta([*found, *[(0, 0)] * PHANTOMS], every, [len(found) - 1]))[:-PHANTOMS]
        # Units by which a point whose delta a font leaves to be inferred may be off: what rounding may make of one
        # given.
        far = np.abs(inferred - wanted).max(axis=1) > 0.5
        more = [k for k, delta in enumerate(found) if delta is None and far[k]]
        if not more:
            break
        for k in more:
            found[k] = whole[k]
    return found


def unflexed(name: str, args: list[Any]) -> list[tuple[str, list[Any]]]:
    """Two curves in the place of a flex; any other command as it is.

    Raises:
        ValueError: the flex varies.
    """
    if "flex" not in name:
        return [(name, args)]
    if any(isinstance(arg, list) for arg in args):
        raise ValueError(name)
    if name == "flex":
        first, second = args[:6], args[6:12]
    elif name == "hflex":
        a, b, c, d, e, f, g = args
        first, second = [a, 0, b, c, d, 0], [e, 0, f, -c, g, 0]
    elif name == "hflex1":
        a, b, c, d, e, f, g, h, i = args
        first, second = [a, b, c, d, e, 0], [f, 0, g, h, i, -(b + d + h)]
    else:
        x, y = sum(args[0:10:2]), sum(args[1:10:2])
        last = [args[10], -y] if abs(x) > abs(y) else [-x, args[10]]
        first, second = args[:6], [*args[6:10], *last]
    return [("rrcurveto", first), ("rrcurveto", second)]


Read = tuple[list[tuple[int, int]], FloatArray, list[int]]
"""Of a contour the places of its points, command and number of the first argument; (n, 1 + R, 2) points as a default
and deltas; and the degrees of the segments."""


def drawn_by(commands: Sequence[tuple[str, list[Any]]], regions: int) -> list[Read]:
    """The contours that single moves, lines and curves draw."""
    contours: list[Any] = []
    at = np.zeros((1 + regions, 2))
    for number, (name, args) in enumerate(commands):
        if name == "rmoveto":
            contours.append(([], [], []))
        elif name not in ("rlineto", "rrcurveto"):
            continue
        for k in range(0, len(args), 2):
            at = at + np.stack([_column(arg, regions) for arg in args[k : k + 2]], axis=1)
            contours[-1][0].append((number, k))
            contours[-1][1].append(at)
        if name != "rmoveto":
            contours[-1][2].append(len(args) // 2)
    return [(places, np.array(points), degrees) for places, points, degrees in contours]


def _column(arg: Any, regions: int) -> FloatArray:
    """(1 + R,) a number, blended or not, as a default and deltas."""
    found = np.zeros(1 + regions)
    if isinstance(arg, list):
        found[: len(arg) - 1] = arg[:-1]
    else:
        found[0] = arg
    return found


def closed(points: FloatArray, degrees: Sequence[int]) -> tuple[FloatArray, IntArray]:
    """(K, n, 2) points of a path closed as readers do it: by a line, unless it ends where it begins."""
    if points.shape[1] > 1 and np.abs(points[:, -1] - points[:, 0]).max() < NEAR:
        return points[:, :-1], np.array(degrees)
    return points, np.array([*degrees, 1])


def with_points(commands: list[tuple[str, list[Any]]], contours: Sequence[tuple[Any, FloatArray]]) -> None:
    """Put other points into the commands that :func:`drawn_by` read."""
    at = None
    for places, points in contours:
        for (number, k), point in zip(places, points, strict=True):
            step = point - (np.zeros_like(point) if at is None else at)
            commands[number][1][k : k + 2] = [blend(step[:, axis].tolist()) for axis in (0, 1)]
            at = point


def write_points(
    source: Font, glyphs: Sequence[tuple[Masters, Masters]], *, copy: Path | None = None, dry: bool = False
) -> list[str]:
    """Write glyphs of which points moved, as they were and as they are, into a font or a copy of it.

    Args:
        copy: the file of the copy; None writes into the font itself. dry: write nothing.

    Returns:
        The names of glyphs that changed.

    Raises:
        OutputError: the font is one of a collection. OSError: it cannot be written.
    """
    edit = FontEdit(source)
    for old, new in glyphs:
        edit.stored(old).put(new)
    if not dry and (glyphs or copy is not None):
        write_whole(str(copy or source.path), edit.written(), durable=True)
    return [new.name for _, new in glyphs]
