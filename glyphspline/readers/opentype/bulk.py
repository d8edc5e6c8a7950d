"""Outlines of many glyphs in one pass, from HarfBuzz's callbacks to contours end to end.

HarfBuzz calls functions that record its drawing operations as numbers in a buffer: the kind (0 move, 1 line,
2 quadratic, 3 cubic) and the points after the current one. They are compiled, or else Python's, which HarfBuzz hands a
:class:`Drawing`. A pass over the buffer makes contours of them, by the rules of
:class:`~glyphspline.readers.pens.ContourPen`. Glyphs that are too large, or whose drawing is incomplete,
are drawn again with that pen by fontTools, which reports what is wrong. HarfBuzz leaves out what it cannot read without
an error.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from functools import cache, cached_property, partial
from itertools import pairwise
from pathlib import Path
from threading import Lock
from typing import Any

import numpy as np
import uharfbuzz as hb

from ...compiled import callback, compiled, inlined
from ...outlines.contour_arrays import ContourArrays
from ...outlines.open_paths import without_area
from ...outlines.outline import Contours, FontMetrics, Outline
from ...outlines.segments import keep_lasting
from ...types import BoolArray, FloatArray, Head, IntArray
from ..pens import COINCIDENT, MAX_COMPONENTS, MAX_SEGMENTS, ContourPen, drawn_by, notes_of
from ..source import OutlineOrError, attempt
from .routes import Face

USED, CAPACITY, FIRST = 0, 1, 2
"""Indices in the buffer: of the count of numbers in use, of the capacity, and of the first operation."""

PASS = 1 << 18
"""Numbers in the buffer after which contours are made of them: 2 MB."""

LONGEST = 7
"""Numbers of the longest operation, a cubic."""

SIZE = PASS + 8 * MAX_SEGMENTS
"""Capacity of the buffer: a glyph with all the segments allowed fits. Memory that no glyph needs is never touched."""

UNUSUAL, UNCOUNTED = -1, -2
"""In place of a number of contours: fontTools has to read the glyph; the number is unknown."""


def _drawing(points: int) -> str:
    """The types of a drawing operation: functions, buffer, state, coordinates, user data."""
    coordinates = ", ".join(["float32"] * (2 * points))
    return f"void(intp, CPointer(double), intp, {coordinates}, intp)"


@compiled
def _record(buffer: Any, kind: int, coordinates: Any) -> None:
    """Write an operation into the buffer, nothing beyond the capacity; a full buffer remains full."""
    used = int(buffer[USED])
    if used + LONGEST < buffer[CAPACITY]:
        buffer[used] = kind
        for k in range(len(coordinates)):
            buffer[used + 1 + k] = coordinates[k]
        buffer[USED] = used + 1 + len(coordinates)
    else:
        buffer[USED] = buffer[CAPACITY]


@callback(_drawing(1))
def _point(functions: int, buffer: Any, state: int, x: float, y: float, user: int) -> None:
    """A move (user data 1) or a line (2)."""
    _record(buffer, user - 1, (x, y))


@callback(_drawing(2))
def _quadratic(functions: int, buffer: Any, state: int, ax: float, ay: float, x: float, y: float, user: int) -> None:
    _record(buffer, 2, (ax, ay, x, y))


@callback(_drawing(3))
def _cubic(
    functions: int, buffer: Any, state: int, ax: float, ay: float, bx: float, by: float, x: float, y: float, user: int
) -> None:
    _record(buffer, 3, (ax, ay, bx, by, x, y))


CALLBACKS = _point, _point, _quadratic, _cubic
"""What HarfBuzz calls for an operation of each kind. There is none for closing a path, as every path is closed."""


class Recording:
    """The buffer as the callbacks of plain Python get it. HarfBuzz's bindings swallow what these raise: it is kept."""

    def __init__(self, buffer: FloatArray) -> None:
        self._buffer = buffer
        self._error: BaseException | None = None

    def record(self, kind: int, coordinates: tuple[float, ...]) -> None:
        """Write an operation into the buffer."""
        try:
            _record(self._buffer, kind, coordinates)
        except BaseException as error:
            self._error = error

    def check(self) -> None:
        """Raise what a callback has raised."""
        if self._error is not None:
            error, self._error = self._error, None
            raise error


def _recorder(kind: int) -> Callable[..., None]:
    """A callback in Python: the drawing comes last, after the coordinates."""
    return lambda *arguments: arguments[-1].record(kind, arguments[:-1])


def _capsule(address: int | None) -> Any:
    make = ctypes.pythonapi.PyCapsule_New
    make.restype, make.argtypes = ctypes.py_object, [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p]
    return make(address, None, None)


def _are_compiled() -> bool:
    """Whether HarfBuzz can call compiled functions."""
    return all(one.address is not None for one in CALLBACKS)


@cache
def _functions(are_compiled: bool) -> Any:
    """The callbacks for HarfBuzz."""
    functions = hb.DrawFuncs()
    calls: list[Any] = [(_recorder(kind),) for kind in range(4)]
    if are_compiled:  # user data tells moves and lines apart
        calls = [(_capsule(one.address), _capsule(kind + 1)) for kind, one in enumerate(CALLBACKS)]
    functions.set_move_to_func(*calls[0])
    functions.set_line_to_func(*calls[1])
    functions.set_quadratic_to_func(*calls[2])
    functions.set_cubic_to_func(*calls[3])
    return functions


@compiled
def _contours(
    buffer: FloatArray, places: IntArray, expected: IntArray
) -> tuple[FloatArray, IntArray, IntArray, IntArray, IntArray, IntArray, IntArray, BoolArray, FloatArray]:
    """Contours of glyphs from their drawing operations.

    Args:
        buffer: the operations. places: (k + 1,) where in it each glyph begins, and the end.
        expected: (k,) the number of contours of each glyph, or ``UNUSUAL``, or ``UNCOUNTED``.

    Returns:
        Points, degrees, offsets and starts as in :class:`ContourArrays`; offsets and starts count from 0 in each glyph,
        and are one more than contours in each. Repeats of points, see :class:`.Contours`, after the offsets.
        Numbers of the flat contours, which are left out. (k + 1, 4) the
        contours, segments, points and contours left out before each glyph. (k,) which glyphs are unusual. (k,)
        how far points were snapped: see :class:`.Outline`.
    """
    count = len(expected)
    room = (places[-1] - places[0]) // 2 + 1  # an operation of 1 + 2n numbers adds at most n points; a move at most one
    points, degrees, repeats = np.empty((room, 2)), np.empty(room, dtype=np.int64), np.empty(room, dtype=np.int64)
    offsets, starts = np.empty(room + count, dtype=np.int64), np.empty(room + count, dtype=np.int64)
    left_out = np.empty(room, dtype=np.int64)
    before, unusual = np.zeros((count + 1, 4), dtype=np.int64), np.zeros(count, dtype=np.bool_)
    snapped = np.zeros(count)
    for g in range(count):
        at, stop = places[g], places[g + 1]
        odd = expected[g] == UNUSUAL or stop >= buffer[CAPACITY]
        c, m, p, left = before[g]
        first, segments = c + g, 0
        offsets[first] = starts[first] = 0
        while at < stop and not odd:
            points[p, 0], points[p, 1] = buffer[at + 1], buffer[at + 2]
            at += 3
            q, s = p + 1, m
            while at < stop and buffer[at] > 0.0:
                kind = int(buffer[at])
                for k in range(kind):
                    points[q + k, 0], points[q + k, 1] = buffer[at + 1 + 2 * k], buffer[at + 2 + 2 * k]
                degrees[s] = kind
                at, q, s = at + 1 + 2 * kind, q + kind, s + 1
            degrees[s] = 1  # the closing line
            drawn = points[p:q].reshape(1, q - p, 2)
            repeats[m : s + 1] = 0
            more_points, more, distance = keep_lasting(drawn, degrees[m : s + 1], repeats[m : s + 1], COINCIDENT, True)
            snapped[g] = max(snapped[g], distance)
            segments += s - m
            odd = more_points < 0 or segments > MAX_SEGMENTS
            if more_points > 0:
                m, p, c = m + more, p + more_points, c + 1
                offsets[c + g], starts[c + g] = m - before[g, 1], p - before[g, 2]
            elif not odd:
                left_out[left] = c - before[g, 0] + left - before[g, 3]
                left += 1
        found = c - before[g, 0] + left - before[g, 3]
        unusual[g] = odd or (expected[g] >= 0 and found != expected[g])
        if unusual[g]:
            c, m, p, left = before[g]
        before[g + 1, 0], before[g + 1, 1], before[g + 1, 2], before[g + 1, 3] = c, m, p, left
    return points, degrees, offsets, starts, repeats[:m], left_out, before, unusual, snapped


def _may_be_strokes(points: FloatArray, starts: IntArray, before: IntArray) -> BoolArray:
    """(k,) whether a glyph has a contour without area, or nothing but contours that were left out.

    Args:
        points, starts, before: of :func:`_contours`.
    """
    counts, _, _, left_out = np.diff(before, axis=0).T
    found: BoolArray = (counts == 0) & (left_out > 0)
    glyphs = np.repeat(np.arange(len(counts)), counts)
    if len(glyphs):
        first, end = starts[np.arange(len(glyphs)) + glyphs] + before[glyphs, 2], before[-1, 2]
        found[glyphs[without_area(points[:end], np.append(first, end))]] = True
    return found


def _replay(operations: FloatArray, pen: ContourPen) -> None:
    """Draw a glyph's operations once more."""
    draw, at = (pen.moveTo, pen.lineTo, pen.qCurveTo, pen.curveTo), 0
    while at < len(operations):
        kind = int(operations[at])
        end = at + 1 + 2 * max(kind, 1)
        draw[kind](*map(tuple, operations[at + 1 : end].reshape(-1, 2).tolist()))
        at = end


@compiled
def _expected(glyf: Any, loca: IntArray, gids: IntArray) -> IntArray:
    """Number of contours of each glyph by its record, components included; ``UNUSUAL`` where fontTools has to look.

    Args:
        glyf: (B,) bytes of the table. loca: where in it records begin, and the end. gids: (k,) of the glyphs.
    """
    found, pending = np.empty(len(gids), dtype=np.int64), np.empty(MAX_COMPONENTS + 1, dtype=np.int64)
    for k in range(len(gids)):
        found[k] = _expected_of(glyf, loca, gids[k], pending)
    return found


@inlined
def _word(glyf: Any, at: int) -> Any:
    """A number of two bytes. NumPy's own shift would keep one."""
    return np.int64(glyf[at]) << 8 | np.int64(glyf[at + 1])


@compiled
def _expected_of(glyf: Any, loca: IntArray, gid: int, pending: IntArray) -> int:
    """The number for one glyph: ``UNUSUAL`` if a record is broken, or it has too many components, as in a loop."""
    pending[0], count, components, total = gid, 1, 0, 0
    while count > 0:
        count -= 1
        record = pending[count]
        if record + 1 >= len(loca):
            return UNUSUAL
        at, end = loca[record], min(loca[record + 1], len(glyf))
        if at >= loca[record + 1]:
            continue
        if at + 10 > end:
            return UNUSUAL
        contours = _word(glyf, at)
        at += 10
        more = contours >= 0x8000
        if not more:
            total += contours
            if total > MAX_SEGMENTS or at + 2 * contours > end:
                return UNUSUAL
            last = -1
            for j in range(at, at + 2 * contours, 2):
                point = _word(glyf, j)
                if point <= last:
                    return UNUSUAL
                last = point
        while more:
            components += 1
            if at + 4 > end or components > MAX_COMPONENTS:
                return UNUSUAL
            flags = _word(glyf, at)
            pending[count] = _word(glyf, at + 2)
            count += 1
            at += 8 if flags & 0x01 else 6
            at += 2 if flags & 0x08 else 4 if flags & 0x40 else 8 if flags & 0x80 else 0
            more = flags & 0x20 != 0
    return total


def load_compiled() -> None:
    """Load the compiled code, which takes some tenths of a second, before a font is opened."""
    _are_compiled()
    _record(np.zeros(LONGEST), 0, (0.0, 0.0))  # for Python: the callbacks have code of their own
    none = np.empty(0, dtype=np.int64)
    _contours(np.zeros(FIRST), np.array([FIRST]), none)
    _expected(np.frombuffer(bytes(1), dtype=np.uint8), np.zeros(2, dtype=np.int64), none)


class BulkReader:
    """Reader of many glyphs of one face at one location; thread-safe.

    Args:
        path: of the font, for errors. face: the face at its location. size: numbers in the buffer that end a pass.
    """

    def __init__(self, path: Path, face: Face, size: int = PASS) -> None:
        self._path, self._face, self._size = path, face, size
        self._buffer = np.zeros(SIZE)
        self._buffer[CAPACITY] = SIZE
        self._pointer, self._drawing = _capsule(self._buffer.ctypes.data), Recording(self._buffer)
        self._lock = Lock()

    def outlines(self, heads: Sequence[Head], metrics: FontMetrics) -> list[OutlineOrError]:
        """Read glyphs; the result has an error in place of each broken glyph.

        Args:
            heads: name, glyph index and code points of each glyph. metrics: of the font at the location.
        """
        advance = self._face.font.get_glyph_h_advance
        found: list[OutlineOrError] = []
        while len(found) < len(heads):
            left = heads[len(found) :]
            with self._lock:
                places, expected = self._draw([head.gid for head in left])
                points, degrees, offsets, starts, repeats, left_out, before, unusual, snapped = _contours(
                    self._buffer, places, expected
                )
                flat = np.flatnonzero(_may_be_strokes(points, starts, before) & ~unusual).tolist()
                again = {g: drawn_by(partial(_replay, self._buffer[places[g] : places[g + 1]])) for g in flat}
            glyphs = zip(left, unusual.tolist(), snapped.tolist(), pairwise(before.tolist()), strict=False)
            for g, (head, odd, moved, ((c, m, p, a), (d, n, q, b))) in enumerate(glyphs):
                if odd:
                    found.append(attempt(self._path, head.name, partial(self._face.by_fonttools, head, metrics)))
                    continue
                own = ContourArrays(points[p:q], degrees[m:n], offsets[c + g : d + g + 1], starts[c + g : d + g + 1])
                contours, notes = Contours(own, repeats[m:n]), notes_of(left_out[a:b].tolist()) if b > a else ()
                if g in again:
                    contours, notes, moved = again[g].contours, again[g].notes, again[g].snapped
                name, gid, unicodes = head
                made = Outline.trusted(
                    name=name, gid=gid, unicodes=unicodes, advance=float(advance(gid)), contours=contours,
                    metrics=metrics, notes=notes, snapped=moved, unread=() if d > c else self._face.unread(gid),
                )  # fmt: skip
                found.append(made)
        return found

    def _draw(self, gids: Sequence[int]) -> tuple[IntArray, IntArray]:
        """Draw glyphs into the buffer until a pass is full.

        Returns:
            (k + 1,) where in the buffer each of the k glyphs drawn begins, and the end; (k,) expected numbers of
            contours. k is at least 1; a glyph that does not fit ends at the capacity.
        """
        expected = np.full(len(gids), UNCOUNTED, dtype=np.int64)
        if self._records is not None:
            expected = _expected(*self._records, np.array(gids, dtype=np.int64))
        draw, used, are_compiled = self._face.font.draw_glyph, self._buffer.data, _are_compiled()
        functions, to = _functions(are_compiled), self._pointer if are_compiled else self._drawing
        used[USED] = FIRST
        places: list[float] = [FIRST]
        for gid, count in zip(gids, expected.tolist(), strict=True):
            if count > 0 or count == UNCOUNTED:
                draw(gid, functions, to)
                self._drawing.check()
            places.append(used[USED])
            if used[USED] > self._size:
                break
        expected = expected[: len(places) - 1]
        if not self._face.has_records:
            extents = self._face.font.get_glyph_extents  # none of a faulty char string, which is drawn in part
            expected[[extents(gid) is None for gid in gids[: len(expected)]]] = UNUSUAL
        return np.array(places, dtype=np.int64), expected

    @cached_property
    def _records(self) -> tuple[Any, IntArray] | None:
        """The ``glyf`` table and the offsets of its records."""
        face = self._face.face
        if not self._face.has_records:
            return None
        head, loca = face.reference_table("head").data, face.reference_table("loca").data
        kind, size = (">u2", 2) if head[50:52] == b"\0\0" else (">u4", 1)
        offsets = np.frombuffer(loca, kind, count=len(loca) // np.dtype(kind).itemsize).astype(np.int64) * size
        return np.frombuffer(face.reference_table("glyf").data, dtype=np.uint8), offsets
