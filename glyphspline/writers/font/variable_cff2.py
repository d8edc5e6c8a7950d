"""Char strings of a variable font with cubic outlines (CFF2), one for all masters, in fractions of a unit."""

from __future__ import annotations

from typing import Any

import numpy as np
from fontTools.cffLib import maxStackLimit
from fontTools.cffLib.specializer import commandsToProgram, specializeCommands
from fontTools.misc.psCharStrings import SimpleT2Decompiler, T2CharString
from fontTools.ttLib import TTFont

from ...errors import GlyphsplineError
from ...outlines.masters import MasterContour
from ...types import BoolArray, FloatArray, IntArray
from .font_glyphs import LIMIT
from .master_deltas import Redrawn, as_drawn, check_steps, region_key, rounded_deltas

PARTS = 1 << 16
"""Parts of a unit to which coordinates are rounded. The format's numbers are 16.16, so that such fractions, and sums
of them, are exact. Any fraction takes five bytes."""

LONGEST = 65535
"""Bytes of the longest char string that readers have to take."""


class CharStrings2:
    """The char strings of a font, to be replaced one by one. Those of other glyphs keep their bytes."""

    def __init__(self, font: TTFont) -> None:
        self._font = font
        top = font["CFF2"].cff.topDictIndex[0]
        self._strings = top.CharStrings
        self._data: list[list[FloatArray]] = []
        if "VarStore" in top.rawDict:
            store = top.VarStore.otVarStore
            axes = font["fvar"].axes
            supports = [region.get_support(axes) for region in store.VarRegionList.Region]
            regions = [np.array([support.get(axis.axisTag, (0, 0, 0)) for axis in axes]) for support in supports]
            self._data = [[regions[index] for index in data.VarRegionIndex] for data in store.VarData]

    def replace(self, name: str, redrawn: Redrawn) -> tuple[tuple[MasterContour, ...], tuple[BoolArray, ...], float]:
        """Replace a glyph; returns its contours as stored, their inner joints, and the largest distance.

        Raises:
            GlyphsplineError: its regions are not those of any item of the font's store, or it is too long.
        """
        masters = redrawn.masters
        old = self._strings[name]
        contours = [cubic(contour) for contour in redrawn.contours]
        steps = [rounded_deltas(masters, contour.points, PARTS) for contour in contours]
        for each in steps:
            check_steps(each, PARTS, name)
        varies = any(each[1:].any() for each in steps)
        index, order = self._place(masters.regions, old) if varies else (0, [])
        commands = drawing([each[[0, *(1 + k for k in order)]] for each in steps], contours, name)
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
        if self._strings.charStringsAreIndexed:
            self._strings.charStringsIndex[self._strings.charStrings[name]] = new
        else:
            self._strings[name] = new
        drawn = [as_drawn(masters, each, PARTS) for each in steps]
        stored = tuple(MasterContour(points, c.degrees) for points, c in zip(drawn, contours, strict=True))
        # Convex, and multilinear between the corners of the grid: largest at one of them, and at a control point.
        corners = masters.weights_at(masters.grid())
        moved = [corners @ (now - c.points).reshape(len(masters), -1) for now, c in zip(drawn, contours, strict=True)]
        far = [float(np.hypot(each[:, ::2], each[:, 1::2]).max(initial=0.0)) for each in moved]
        return stored, redrawn.inner, max(far, default=0.0)

    def _place(self, regions: FloatArray, old: Any) -> tuple[int, list[int]]:
        """The index of the item of the store that has just these regions, and their indices in its order."""
        private = old.private
        copy = T2CharString(bytecode=old.bytecode, private=private, globalSubrs=old.globalSubrs)
        reader = SimpleT2Decompiler(getattr(private, "Subrs", []), old.globalSubrs, private)
        reader.execute(copy)
        known = {region_key(region): k for k, region in enumerate(regions)}
        for index in (reader.vsIndex, *range(len(self._data))):
            if index < len(self._data):
                keys = [region_key(region) for region in self._data[index]]
                if len(keys) == len(known) and set(keys) == known.keys():
                    return index, [known[key] for key in keys]
        raise GlyphsplineError(f"no item of the font's variation store has just its {len(regions)} regions")


def cubic(contour: MasterContour) -> MasterContour:
    """The contour with lines and cubics alone: quadratics raised, exactly."""
    if not (contour.degrees == 2).any():
        return contour
    raised = contour.cubics()
    degrees = np.where(contour.degrees == 1, 1, 3)
    points = [raised[:, j, : 3 if degree == 3 else 1] for j, degree in enumerate(degrees.tolist())]
    return MasterContour(np.concatenate(points, axis=1), degrees)


def drawing(steps: list[IntArray], contours: list[MasterContour], name: str) -> list[tuple[str, list[Any]]]:
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
        blended = [[_argument(column) for column in point] for point in moves.transpose(1, 2, 0).tolist()]
        commands.append(("rmoveto", blended[0]))
        offset = 1
        last = len(contour) - 1
        for j, degree in enumerate(contour.degrees.tolist()):
            if degree == 3:
                commands.append(("rrcurveto", [*blended[offset], *blended[offset + 1], *blended[offset + 2]]))
            elif j < last:  # the line back to the start is drawn by the end of the contour
                commands.append(("rlineto", blended[offset]))
            offset += degree
        at = each[:, -1:] if contour.degrees[-1] == 1 else each[:, :1]
    return commands


def _argument(column: list[int]) -> Any:
    """A number, or a list of the default, the deltas and 1, which the specialiser takes for a blend."""
    values = [step // PARTS if step % PARTS == 0 else step / PARTS for step in column]
    return [*values, 1] if any(column[1:]) else values[0]
