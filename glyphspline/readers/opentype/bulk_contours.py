"""Outlines of many glyphs as one flat array of drawing operations, from HarfBuzz through compiled callbacks."""

# numba's decorators and HarfBuzz's capsules have no types.
# mypy: disable-error-code="no-untyped-def, no-untyped-call"

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import uharfbuzz as hb
from numba import cfunc, types

from ...compiled import compiled
from ...outlines.outline import Contour
from ...types import BoolArray, FloatArray, IntArray
from ..pens import COINCIDENT, MAX_SEGMENTS

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


@compiled
def cubics_of(buffer, starts):
    """Cubic segments of glyphs drawn end to end.

    Args:
        buffer: the operations. starts: (k + 1,) where each glyph begins.

    Returns:
        (M, 4, 2) cubics of all contours; (K + 1,) where contours begin; (k + 1,) contours before each glyph;
        (k,) whether a glyph is odd: not finite, or too large. Lines and quadratics are raised to cubics, segments of
        no length dropped, open contours closed by a line, contours left out whose points are all on one line.
        Then the segments as drawn: (P, 2) points and (M,) degrees in the way of
        :class:`~glyphspline.outlines.outline.Contour`, and (K + 1,) where the contours' points begin.
    """
    room = (starts[-1] - starts[0]) // 3 + 16
    cubics = np.empty((room, 4, 2))
    offsets = np.zeros(room + 1, dtype=np.int64)
    before = np.zeros(len(starts), dtype=np.int64)
    odd = np.zeros(len(starts) - 1, dtype=np.bool_)
    own, degrees, owns = np.empty((3 * room, 2)), np.empty(room, dtype=np.int64), np.zeros(room + 1, dtype=np.int64)
    contours = 0
    for glyph in range(len(starts) - 1):
        at, stop = starts[glyph], starts[glyph + 1]
        first = contours
        odd[glyph] = stop >= buffer[1] or (stop - at) // 3 > MAX_SEGMENTS
        open_contour = False
        sx = sy = x = y = 0.0
        m, p = offsets[contours], owns[contours]
        while at < stop and not odd[glyph]:
            kind = int(buffer[at])
            if kind == 0 or kind == 4:
                if open_contour:
                    contours = _closed(cubics, offsets, own, degrees, owns, contours, m, p, x, y, sx, sy)
                    m, p = offsets[contours], owns[contours]
                    open_contour = False
                if kind == 0:
                    sx, sy = x, y = buffer[at + 1], buffer[at + 2]
                    open_contour = True
                    if not (abs(x) < 1e12 and abs(y) < 1e12):
                        odd[glyph] = True
                at += 3 if kind == 0 else 1
                continue
            moves = False
            for k in range(kind):
                ex, ey = buffer[at + 1 + 2 * k], buffer[at + 2 + 2 * k]
                moves = moves or abs(ex - x) > COINCIDENT or abs(ey - y) > COINCIDENT
                if not (abs(ex) < 1e12 and abs(ey) < 1e12):
                    odd[glyph] = True
            if moves:
                degrees[m] = kind
                own[p, 0], own[p, 1] = x, y
                for k in range(1, kind):
                    own[p + k, 0], own[p + k, 1] = buffer[at + 2 * k - 1], buffer[at + 2 * k]
                p += kind
                _raise(cubics[m], kind, x, y, buffer[at + 1 : at + 1 + 2 * kind])
                m += 1
                x, y = ex, ey
            at += 1 + 2 * kind
        if open_contour:
            contours = _closed(cubics, offsets, own, degrees, owns, contours, m, p, x, y, sx, sy)
        if odd[glyph]:
            contours = first
        before[glyph + 1] = contours
    segments, points = offsets[contours], owns[contours]
    return (
        cubics[:segments], offsets[: contours + 1], before, odd, own[:points], degrees[:segments], owns[: contours + 1],
    )  # fmt: skip


@compiled
def _raise(cubic, kind, x, y, to):
    """Write a line, quadratic or cubic from (x, y) as a cubic."""
    for axis in range(2):
        a = x if axis == 0 else y
        if kind == 1:
            b = to[axis]
            middle = 0.5 * a + 0.5 * b  # raised twice, as elsewhere: a + (b - a) / 3 would round differently
            cubic[0, axis], cubic[3, axis] = a, b
            cubic[1, axis] = a / 3.0 + middle * (2.0 / 3.0)
            cubic[2, axis] = middle * (2.0 / 3.0) + b / 3.0
        elif kind == 2:
            c, b = to[axis], to[2 + axis]
            cubic[0, axis], cubic[3, axis] = a, b
            cubic[1, axis] = a / 3.0 + c * (2.0 / 3.0)
            cubic[2, axis] = c * (2.0 / 3.0) + b / 3.0
        else:
            cubic[0, axis], cubic[1, axis] = a, to[axis]
            cubic[2, axis], cubic[3, axis] = to[2 + axis], to[4 + axis]


@compiled
def _closed(cubics, offsets, own, degrees, owns, contours, m, p, x, y, sx, sy):
    """End a contour after m segments of p points: the number of contours, which is one more if it encloses anything."""
    start = offsets[contours]
    if abs(x - sx) > COINCIDENT or abs(y - sy) > COINCIDENT:
        end = np.array([sx, sy])
        _raise(cubics[m], 1, x, y, end)
        degrees[m] = 1
        own[p, 0], own[p, 1] = x, y
        m, p = m + 1, p + 1
    elif m > start:
        cubics[m - 1, 3, 0], cubics[m - 1, 3, 1] = sx, sy
    if m == start or _collinear(cubics[start:m]):
        return contours
    offsets[contours + 1], owns[contours + 1] = m, p
    return contours + 1


@compiled
def _collinear(cubics):
    """Whether all control points lie within ``COINCIDENT`` of the line from the first to the farthest."""
    ox, oy = cubics[0, 0, 0], cubics[0, 0, 1]
    far, fx, fy = -1.0, 0.0, 0.0
    for j in range(cubics.shape[0]):
        for k in range(4):
            dx, dy = cubics[j, k, 0] - ox, cubics[j, k, 1] - oy
            if dx * dx + dy * dy > far:
                far, fx, fy = dx * dx + dy * dy, dx, dy
    bound = COINCIDENT * np.sqrt(far)
    for j in range(cubics.shape[0]):
        for k in range(4):
            dx, dy = cubics[j, k, 0] - ox, cubics[j, k, 1] - oy
            if abs(dx * fy - dy * fx) > bound:
                return False
    return True


class Read(NamedTuple):
    """What is drawn of a glyph: its advance and contours, as an outline has them."""

    advance: float
    contours: tuple[Contour, ...]


def read_chunk(reader: BulkReader, gids: Sequence[int]) -> list[Read | None]:
    """Read glyphs; None where something is unusual, or nothing is drawn, and the font's own reader has to look."""
    buffer, starts, advances, broken = reader.read(gids)
    _, segments, before, strange, points, degrees, owns = cubics_of(buffer, starts)
    contours = [
        Contour(points[owns[k] : owns[k + 1]], degrees[segments[k] : segments[k + 1]]) for k in range(len(owns) - 1)
    ]
    left = (broken | strange).tolist()
    each = zip(left, advances, pairwise(before.tolist()), strict=True)
    return [None if odd or a == b else Read(float(advance), tuple(contours[a:b])) for odd, advance, (a, b) in each]
