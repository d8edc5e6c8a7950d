"""Outlines of many glyphs as one flat array of drawing operations, from HarfBuzz through compiled callbacks."""

# numba's decorators and HarfBuzz's capsules have no types.
# mypy: disable-error-code="no-untyped-def, no-untyped-call"

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import uharfbuzz as hb
from numba import cfunc, types

from ...types import BoolArray, FloatArray, IntArray

MOVE, LINE, QUADRATIC, CUBIC, CLOSE = range(5)

USED, CAPACITY, HEAD = 0, 1, 2
"""The first numbers of a buffer: how many are in use, how many there is room for, and where operations begin."""

ROOM = 2_000_000
"""Numbers in a buffer: 16 MB. A glyph that does not fit is left to the long way, which has limits of its own."""

LONGEST = 7
"""Numbers of the longest operation, a cubic."""

_HEADER = (types.intp, types.CPointer(types.double), types.intp)
_PAIR = (types.float32, types.float32)


# One function an operation: (functions, buffer, state, coordinates ..., user data). Nothing is written beyond the
# capacity, however much a font draws; a buffer that is full stays full.
@cfunc(types.void(*_HEADER, *_PAIR, types.intp), cache=True)
def _move(functions, buffer, state, x, y, user):
    used = int(buffer[0])
    if used + 7 < buffer[1]:
        buffer[used], buffer[used + 1], buffer[used + 2] = 0.0, x, y
        buffer[0] = used + 3
    else:
        buffer[0] = buffer[1]


@cfunc(types.void(*_HEADER, *_PAIR, types.intp), cache=True)
def _line(functions, buffer, state, x, y, user):
    used = int(buffer[0])
    if used + 7 < buffer[1]:
        buffer[used], buffer[used + 1], buffer[used + 2] = 1.0, x, y
        buffer[0] = used + 3
    else:
        buffer[0] = buffer[1]


@cfunc(types.void(*_HEADER, *_PAIR, *_PAIR, types.intp), cache=True)
def _quadratic(functions, buffer, state, ax, ay, x, y, user):
    used = int(buffer[0])
    if used + 7 < buffer[1]:
        buffer[used], buffer[used + 1], buffer[used + 2] = 2.0, ax, ay
        buffer[used + 3], buffer[used + 4] = x, y
        buffer[0] = used + 5
    else:
        buffer[0] = buffer[1]


@cfunc(types.void(*_HEADER, *_PAIR, *_PAIR, *_PAIR, types.intp), cache=True)
def _cubic(functions, buffer, state, ax, ay, bx, by, x, y, user):
    used = int(buffer[0])
    if used + 7 < buffer[1]:
        buffer[used], buffer[used + 1], buffer[used + 2] = 3.0, ax, ay
        buffer[used + 3], buffer[used + 4], buffer[used + 5], buffer[used + 6] = bx, by, x, y
        buffer[0] = used + 7
    else:
        buffer[0] = buffer[1]


@cfunc(types.void(*_HEADER, types.intp), cache=True)
def _close(functions, buffer, state, user):
    used = int(buffer[0])
    if used + 7 < buffer[1]:
        buffer[used] = 4.0
        buffer[0] = used + 1
    else:
        buffer[0] = buffer[1]


def _capsule(address: int | None) -> Any:
    make = ctypes.pythonapi.PyCapsule_New
    make.restype, make.argtypes = ctypes.py_object, [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p]
    return make(address, None, None)


@cache
def _functions() -> Any:
    functions = hb.DrawFuncs()
    functions.set_move_to_func(_capsule(_move.address))
    functions.set_line_to_func(_capsule(_line.address))
    functions.set_quadratic_to_func(_capsule(_quadratic.address))
    functions.set_cubic_to_func(_capsule(_cubic.address))
    functions.set_close_path_func(_capsule(_close.address))
    return functions


class BulkReader:
    """A font face, for drawing many of its glyphs into one array."""

    def __init__(self, path: Path, face_index: int) -> None:
        self._font = hb.Font(hb.Face(hb.Blob.from_file_path(str(path)), face_index))
        self._buffer = np.zeros(ROOM)
        self._pointer = _capsule(self._buffer.ctypes.data)

    def read(self, gids: Sequence[int]) -> tuple[FloatArray, IntArray, list[int], BoolArray]:
        """Draw glyphs one after the other.

        Returns:
            The buffer, which the next call overwrites; (k + 1,) where in it each glyph begins and the last ends;
            advances; and (k,) which glyphs break off. One for which there was no room ends at the buffer's end.
        """
        buffer, font, functions, pointer = self._buffer, self._font, _functions(), self._pointer
        buffer[USED], buffer[CAPACITY] = HEAD, ROOM
        starts = [HEAD]
        for gid in gids:
            font.draw_glyph(gid, functions, pointer)
            starts.append(int(buffer[USED]))
        broken = np.array([font.get_glyph_extents(gid) is None for gid in gids], dtype=np.bool_)
        return buffer, np.array(starts, dtype=np.int64), [font.get_glyph_h_advance(gid) for gid in gids], broken
