"""The contours of a glyph in ``CFF`` and ``CFF2``: the numbers of its char string change, and hints stay."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from fontTools.cffLib import maxStackLimit
from fontTools.cffLib.specializer import commandsToProgram, generalizeCommands, programToCommands, specializeCommands
from fontTools.cffLib.transforms import desubroutinizeCharString
from fontTools.misc.psCharStrings import T2CharString
from fontTools.ttLib import TTFont

from ...errors import GlyphsplineError
from ...outlines.masters import Masters
from ...readers.opentype.variations import executed
from ...types import FloatArray, IntArray
from ..font.font_glyphs import put_string
from ..font.master_deltas import order_of
from ..font.variable_font import CharStrings2, blend
from .stored import NEAR, OTHERWISE, REGIONS, Stored, matched

STACK = 48
"""Most numbers on the stack of a ``CFF`` char string, by the format."""


class CharStringContours(Stored):
    """The contours of a char string, of which its subroutines become part.

    Args:
        name: the glyph's in the font. glyph: as it was read.
    """

    def __init__(self, font: TTFont, name: str, glyph: Masters) -> None:
        self._name, self._glyph, self._is_cff2 = name, glyph, "CFF2" in font
        self._strings = font["CFF2" if self._is_cff2 else "CFF "].cff.topDictIndex[0].CharStrings
        self._commands, regions = commands_of(font, self._strings[name])
        order = order_of(regions, glyph) if regions else []
        if self._commands is None or order is None:
            why = OTHERWISE if self._commands is None else REGIONS
            super().__init__(why=dict.fromkeys(range(len(glyph.contours)), why))
            return
        self._order = [0, *order]
        self._read = drawn_by(self._commands, len(regions))
        scalars = glyph.at_peaks[:, self._order]
        stored = [closed(np.einsum("kj,njc->knc", scalars, points), degrees) for _, points, degrees in self._read]
        super().__init__(*matched(glyph, stored))

    def put(self, new: Masters) -> None:
        """See :meth:`.Stored.put`.

        Raises:
            GlyphsplineError: a point moves in a master whose region the char string has not.
        """
        assert self._commands is not None
        varies = np.linalg.inv(self._glyph.at_peaks)
        whole = [(places, points.copy()) for places, points, _ in self._read]
        for (_, points), index in zip(whole, self.owns, strict=True):
            if index is None:
                continue
            moves = new.contours[index].points - self._glyph.contours[index].points
            change = np.einsum("kj,jnc->nkc", varies, moves)
            if np.abs(np.delete(change, self._order, axis=1)).max(initial=0.0) > NEAR:
                raise GlyphsplineError(REGIONS, glyph=self._glyph.name)
            count = moves.shape[1]
            points[:count] += change[:, self._order]
            points[count:] += change[:1, self._order]  # a contour that ends where it begins
        with_points(self._commands, whole)
        old = self._strings[self._name]
        stack = maxStackLimit if self._is_cff2 else STACK
        commands = specializeCommands(self._commands, generalizeFirst=False, preserveTopology=True, maxstack=stack)
        made = T2CharString(program=commandsToProgram(commands), private=old.private, globalSubrs=old.globalSubrs)
        made.compile(isCFF2=self._is_cff2)
        put_string(self._strings, self._name, made)


def commands_of(font: TTFont, old: Any) -> tuple[list[Any] | None, list[FloatArray]]:
    """A char string as single moves, lines and curves, and its regions; None if a number of its operators is wrong."""
    private = old.private
    copy = T2CharString(bytecode=old.bytecode, program=old.program, private=private, globalSubrs=old.globalSubrs)
    desubroutinizeCharString(copy)
    reader = executed(copy)
    regions = CharStrings2(font).regions[reader.vsIndex] if getattr(reader, "numRegions", None) else []
    start = getattr(private, "vsindex", 0) or 0
    commands = programToCommands(copy.program, lambda _: len(regions), vsIndex=start)
    try:
        return [each for command in generalizeCommands(commands) for each in unflexed(*command)], regions
    except ValueError:
        return None, regions


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
            pair = [arg[:-1] if isinstance(arg, list) else [arg, *[0.0] * regions] for arg in args[k : k + 2]]
            at = at + np.array(pair, dtype=np.float64).T
            contours[-1][0].append((number, k))
            contours[-1][1].append(at)
        if name != "rmoveto":
            contours[-1][2].append(len(args) // 2)
    return [(places, np.array(points), degrees) for places, points, degrees in contours]


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
