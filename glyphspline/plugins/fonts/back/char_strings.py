"""The contours of a glyph in ``CFF`` and ``CFF2``: the numbers of its char string change, and hints stay.

Points are rounded, and steps from point to point are their differences: rounded alone, these would add up to a contour
that ends beside where it begins.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from fontTools.cffLib import maxStackLimit
from fontTools.cffLib.specializer import commandsToProgram, specializeCommands
from fontTools.misc.psCharStrings import T2CharString
from fontTools.ttLib import TTFont

from ....errors import GlyphsplineError
from ....outlines.masters import MasterContour, Masters
from ....types import FloatArray, IntArray
from ..tables.font_glyphs import FINE, on_grid, put_string
from ..tables.master_deltas import blend, order_of, regions_of
from .programs import Command, Program
from .stored import NEAR, OTHERWISE, REGIONS, StoredContours, matched

STACK = 48
"""Most numbers on the stack of a ``CFF`` char string, by the format."""


class CharStringContours(StoredContours):
    """The contours of a char string. Operators that draw what changes are written anew, with the subroutines that have
    them; all others stay.

    Args:
        name: the glyph's in the font. glyph: as it was read.
    """

    def __init__(self, font: TTFont, name: str, glyph: Masters) -> None:
        self._name, self._glyph, self._is_cff2 = name, glyph, "CFF2" in font
        self._strings = char_strings(font)
        self._program = program = Program(self._strings[name])
        regions = regions_of(font)[program.vsIndex] if program.numRegions else []
        order, self._read = order_of(regions, glyph) if regions else [], list[Read]()
        try:
            self._commands, self._spans = program.commands(len(regions))
        except ValueError:
            super().__init__(why=dict.fromkeys(range(len(glyph.contours)), OTHERWISE))
            return
        if order is None:
            super().__init__(why=dict.fromkeys(range(len(glyph.contours)), REGIONS))
            return
        self._order = [0, *order]
        self._read = drawn_by(self._commands, len(regions))
        scalars = glyph.at_peaks[:, self._order]
        stored = [closed(np.einsum("kj,njc->knc", scalars, points), degrees) for _, points, degrees in self._read]
        super().__init__(*matched(glyph, stored))

    def masters(self, new: Masters) -> Masters:
        """See :meth:`.StoredContours.masters`: coordinates and deltas are multiples of 1/65536."""
        contours = list(new.contours)
        for c, steps in self._steps(new):
            index = self.owns[c]
            assert index is not None
            old = self._glyph.contours[index]
            moves = np.einsum("kj,njc->knc", self._glyph.at_peaks[:, self._order], steps[: old.points.shape[1]])
            contours[index] = MasterContour(old.points + moves, old.degrees)
        return replace(new, contours=contours)

    def put(self, new: Masters) -> None:
        """See :meth:`.StoredContours.put`. The new char string is not compiled: :func:`.programs.share` is to read it.

        Raises:
            GlyphsplineError: a point moves in a master whose region the char string has not.
        """
        points = [points for _, points, _ in self._read]
        for c, steps in self._steps(new):
            points[c] = points[c] + steps
        changed = with_points(self._commands, [(*each, now) for each, now in zip(self._read, points, strict=True)])
        old = self._strings[self._name]
        program = self._program.with_others(dict(self._written(changed)))
        made = T2CharString(program=program, private=old.private, globalSubrs=old.globalSubrs)
        put_string(self._strings, self._name, made)

    def _steps(self, new: Masters) -> Iterator[tuple[int, FloatArray]]:
        """Of stored contours that are others in ``new`` the number, and (n, 1 + R, 2) by how much points move."""
        varies = np.linalg.inv(self._glyph.at_peaks)
        for c, ((_, points, _), index) in enumerate(zip(self._read, self.owns, strict=True)):
            if index is None or new.contours[index] is self._glyph.contours[index]:
                continue
            moves = new.contours[index].points - self._glyph.contours[index].points
            change = np.einsum("kj,jnc->nkc", varies, moves)
            if np.abs(np.delete(change, self._order, axis=1)).max(initial=0.0) > NEAR:
                raise GlyphsplineError(REGIONS, glyph=self._glyph.name)
            # A contour that ends where it begins has that point twice.
            again = np.arange(len(points)) % moves.shape[1]
            yield c, on_grid(points + change[again][:, self._order], FINE) - points

    def _written(self, changed: Sequence[int]) -> Iterator[tuple[int, tuple[int, list[Any]]]]:
        """The operators of commands that changed, as tokens: of each run of them the tokens in whose place they are."""
        operators = sorted({self._spans[number] for number in changed})
        firsts = [k for k, (first, _) in enumerate(operators) if k == 0 or operators[k - 1][1] != first]
        stack = maxStackLimit if self._is_cff2 else STACK
        for a, b in zip(firsts, [*firsts[1:], len(operators)], strict=True):
            first, behind = operators[a][0], operators[b - 1][1]
            pairs = zip(self._commands, self._spans, strict=True)
            own = [command for command, (start, end) in pairs if first <= start and end <= behind]
            commands = specializeCommands(own, generalizeFirst=False, preserveTopology=True, maxstack=stack)
            yield first, (behind, commandsToProgram(commands))


def char_strings(font: TTFont) -> Any:
    """The char strings of a font, by the names of its glyphs."""
    return font["CFF2" if "CFF2" in font else "CFF "].cff.topDictIndex[0].CharStrings


Read = tuple[list[tuple[int, int]], FloatArray, list[int]]
"""Of a contour the places of its points, command and number of the first argument; (n, 1 + R, 2) points as a default
and deltas; and the degrees of the segments."""


def drawn_by(commands: Sequence[Command], regions: int) -> list[Read]:
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


def with_points(commands: list[Command], contours: Sequence[tuple[Any, FloatArray, Any, FloatArray]]) -> list[int]:
    """Put other points into the commands that :func:`drawn_by` read; the numbers of those that change.

    Args:
        contours: what it read, each with the new points behind.
    """
    changed, none = list[int](), np.zeros_like(contours[0][1][:1]) if contours else np.empty(0)
    ends = none, none
    for places, old, _, new in contours:
        steps = [np.diff(points, axis=0, prepend=end) for points, end in zip((old, new), ends, strict=True)]
        ends = old[-1:], new[-1:]
        for k in np.flatnonzero((steps[0] != steps[1]).any(axis=(1, 2))).tolist():
            number, at = places[k]
            commands[number][1][at : at + 2] = [blend(steps[1][k, :, axis].tolist()) for axis in (0, 1)]
            changed.append(number)
    return changed
