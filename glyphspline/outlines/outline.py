"""Outlines: contours of line, quadratic and cubic Bézier segments, y up, in font units."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from ..curves.bezier import evaluate
from ..errors import GlyphsplineError
from ..types import FloatArray, IntArray, Views, counted
from .contour_arrays import ContourArrays, end_to_end
from .open_paths import are_open


@dataclass(frozen=True, eq=False)
class Contour:
    """A closed chain of Bézier segments.

    Attributes:
        points: (N, 2) the control points of all segments in order, each shared end once.
        degrees: (m,) the degree of each segment: 1 (line), 2 or 3, so that ``N == degrees.sum()``.

    Segment j has the ``degrees[j] + 1`` points that begin at ``offsets[j]``; the last segment ends on
    ``points[0]``. An open path is a contour that goes along it and back: see :mod:`.open_paths`.
    """

    points: FloatArray
    degrees: IntArray

    def __post_init__(self) -> None:
        points = np.ascontiguousarray(self.points, dtype=np.float64)
        degrees = np.ascontiguousarray(self.degrees, dtype=np.int64)
        if points.shape != (int(degrees.sum()), 2):
            raise ValueError(f"degrees ask for ({int(degrees.sum())}, 2) points, not {points.shape}")
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "degrees", degrees)

    @classmethod
    def trusted(cls, points: FloatArray, degrees: IntArray) -> Contour:
        """A contour without the checks, for callers whose arrays are right by construction."""
        contour = cls.__new__(cls)
        contour.__dict__.update(points=points, degrees=degrees)
        return contour

    @classmethod
    def from_segments(cls, segments: Iterable[FloatArray]) -> Contour:
        """Join segments of shape (degree + 1, 2); each must begin where its predecessor ends."""
        parts = [np.asarray(segment, dtype=np.float64) for segment in segments]
        points = np.concatenate([part[:-1] for part in parts]) if parts else np.empty((0, 2))
        return cls(points, np.array([len(part) - 1 for part in parts], dtype=np.int64))

    @cached_property
    def offsets(self) -> IntArray:
        """(m,) first index in ``points`` of each segment."""
        return np.cumsum(self.degrees) - self.degrees

    @cached_property
    def is_open(self) -> bool:
        """Whether it is an open path, along which it goes and then back."""
        if len(self) % 2 or not len(self) or (self.points[1] != self.points[-1]).any():
            return False  # of most contours, at once
        return bool(are_open(end_to_end([(self.points, self.degrees)]))[0])

    def __len__(self) -> int:
        return len(self.degrees)

    def __repr__(self) -> str:
        kinds = zip(("line", "quadratic", "cubic"), np.bincount(self.degrees, minlength=4)[1:].tolist(), strict=True)
        return f"<Contour: {', '.join([counted(count, kind) for kind, count in kinds if count]) or 'empty'}>"

    def segments(self) -> Iterator[FloatArray]:
        """The segments in order, each (degree + 1, 2)."""
        closed = np.concatenate([self.points, self.points[:1]])
        for offset, degree in zip(self.offsets, self.degrees, strict=True):
            yield closed[offset : offset + degree + 1]

    def drawn(self) -> list[FloatArray]:
        """The segments as they are drawn: of an open path those of the way there."""
        segments = list(self.segments())
        return segments[: len(segments) // 2] if self.is_open else segments

    def cubics(self) -> FloatArray:
        """(m, 4, 2) all segments as cubic Béziers, by exact degree elevation."""
        from .segments import contour_cubics  # imported here, so that the package opens without a compiler

        return contour_cubics(end_to_end([(self.points, self.degrees)]), 0)

    def at(self, places: FloatArray) -> FloatArray:
        """(k, 2) points at (k,) places: j + x is local parameter x of segment j, and places wrap at ``len(self)``."""
        segments = np.floor(places).astype(np.int64)
        return evaluate(self.cubics()[segments % len(self)], places - segments)

    def rounded(self, digits: int) -> Contour:
        """The contour with coordinates rounded to ``digits`` decimals."""
        return Contour(np.round(self.points, digits) + 0.0, self.degrees)

    def reversed(self) -> Contour:
        """The contour in the opposite direction from the same start point."""
        return Contour(np.roll(self.points[::-1], 1, axis=0), self.degrees[::-1])

    def draw(self, pen: Any, closing: bool = True, stays_open: bool = True) -> None:
        """Draw with any fontTools segment pen.

        Args:
            closing: with a last line, which ``closePath`` implies.
            stays_open: an open path ends with ``endPath``; else it is drawn there and back, as in fonts.
        """
        closed = [tuple(point) for point in np.concatenate([self.points, self.points[:1]]).tolist()]
        pen.moveTo(closed[0])
        drawn = len(self) - (not closing and len(self) > 1 and self.degrees[-1] == 1)
        opens = stays_open and self.is_open
        drawn = len(self) // 2 if opens else drawn
        for offset, degree in zip(self.offsets[:drawn].tolist(), self.degrees[:drawn].tolist(), strict=True):
            to = closed[offset + 1 : offset + degree + 1]
            (pen.lineTo, pen.qCurveTo, pen.curveTo)[degree - 1](*to)
        (pen.endPath if opens else pen.closePath)()


class Contours(Views[Contour]):
    """The contours of a glyph: a sequence of :class:`Contour`, which are views of ``arrays``.

    Attributes:
        arrays: the contours end to end. repeats: (m,) how many more times the font has the point where each segment
            begins: readers leave out segments of no length.
    """

    __slots__ = ("arrays", "repeats")

    def __init__(self, contours: Iterable[Contour] | ContourArrays = (), repeats: IntArray | None = None) -> None:
        if isinstance(contours, ContourArrays):
            self.arrays = contours
            super().__init__(contours.num_contours, lambda: _views(contours))
        else:
            given = tuple(contours)
            self.arrays = end_to_end([(contour.points, contour.degrees) for contour in given])
            super().__init__(len(given), lambda: given)
        self.repeats = np.zeros(len(self.arrays.degrees), dtype=np.int64) if repeats is None else repeats


def _views(contours: ContourArrays) -> list[Contour]:
    points, degrees, offsets, starts = contours
    ends = zip(pairwise(starts.tolist()), pairwise(offsets.tolist()), strict=True)
    return [Contour.trusted(points[a:b], degrees[i:j]) for (a, b), (i, j) in ends]


@dataclass(frozen=True)
class FontMetrics:
    """The font's em and vertical metrics, in font units."""

    units_per_em: float = 1000.0
    ascender: float = 800.0
    descender: float = -200.0


@dataclass(frozen=True, eq=False)
class Outline:
    """A glyph as its font stores it.

    Attributes:
        name: the glyph's name; gid: its index in the font; unicodes: its code points, ascending.
        advance: horizontal advance in font units.
        contours: its contours in the font's order; any iterable is accepted; empty for a space.
        metrics: units per em, ascender and descender of its font.
        notes: one sentence for each part that the reader left out.
        snapped: how far, at most, the contours are from what the font draws, in font units: a reader drops segments
            that are shorter than a thousandth of a unit, and closes gaps of that size.
        unread: one phrase for each thing that shows in the source and is not in the contours, such as strokes or text.
    """

    name: str
    gid: int = 0
    unicodes: tuple[int, ...] = ()
    advance: float = 0.0
    contours: Sequence[Contour] = ()
    metrics: FontMetrics = field(default_factory=FontMetrics)
    notes: tuple[str, ...] = ()
    snapped: float = 0.0
    unread: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if not isinstance(self.contours, Contours):
            object.__setattr__(self, "contours", Contours(self.contours))

    @classmethod
    def trusted(cls, **fields: Any) -> Outline:
        """An outline whose fields, all of them, are of their types already: made in half the time."""
        outline = cls.__new__(cls)
        outline.__dict__.update(fields)
        return outline

    @property
    def arrays(self) -> ContourArrays:
        """The contours end to end."""
        assert isinstance(self.contours, Contours)
        return self.contours.arrays

    @property
    def repeats(self) -> IntArray:
        """Of points that the font has more than once; see :class:`Contours`."""
        assert isinstance(self.contours, Contours)
        return self.contours.repeats

    def __repr__(self) -> str:
        codes = "".join([f" U+{code:04X}" for code in self.unicodes])
        parts = [counted(len(self.contours), "contour"), counted(len(self.arrays.degrees), "segment")]
        size = f"advance {self.advance:g}, {self.metrics.units_per_em:g} units per em"
        return f"<Outline {self.name!r} gid {self.gid}{codes}: {', '.join(parts)}, {size}>"

    def draw(self, pen: Any) -> None:
        """Draw with any fontTools segment pen."""
        for contour in self.contours:
            contour.draw(pen)


def partly_read(unread: Sequence[str]) -> GlyphsplineError | None:
    """What a source shows and a glyph has not, as an error; None: it has all."""
    return GlyphsplineError(f"not read in full: {'; '.join(unread)}") if unread else None
