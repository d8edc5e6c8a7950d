"""A path that text runs along: a chain of cubics, open or closed, measured by arc length."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, get_args

import numpy as np
from numpy.typing import ArrayLike

from ..curves.bezier import as_cubic, cross, cubic_approximation, derivative_points, split
from ..curves.bspline import Spline
from ..curves.integrals import NODES, WEIGHTS
from ..errors import GlyphsplineError, OptionError, is_positive, require, require_choice
from ..outlines.outline import Contour
from ..outlines.sampling import CORNER_ANGLE
from ..types import FloatArray, IntArray, counted
from .setting import Place

COINCIDENT, SMOOTH = 1e-9, 1e-7
"""Share of the path's extent below which its ends meet. Radians of turn up to which a joint is smooth: rounding."""

SMALLEST, LARGEST = 1e-50, 1e50
"""Extents of a path; squares of others would under- or overflow."""

INNER_NODES, INNER_WEIGHTS = np.polynomial.legendre.leggauss(4)
"""For lengths inside a part; those of whole parts take the 16 nodes of other curves."""


class Table(NamedTuple):
    """Parts of the path, in order: short enough that chord and control polygon are of almost one length.

    Attributes:
        cubics: (n, 4, 2). velocities: (n, 3, 2) coefficients of 1, x and x² in the first derivative.
        segment: (n,) that a part is of. first, width: (n,) where it begins there and how far it goes, in the segment's
            parameter.
        ends: (n + 1,) arc length where each part begins, and the length of the path.
        error: bound of the error of any arc length.
    """

    cubics: FloatArray
    velocities: FloatArray
    segment: IntArray
    first: FloatArray
    width: FloatArray
    ends: FloatArray
    error: float


class Frame(NamedTuple):
    """The path at some arc lengths: points and unit tangents (..., 2), signed curvature (...), left is positive."""

    points: FloatArray
    tangents: FloatArray
    curvature: FloatArray


@dataclass(frozen=True, eq=False)
class Path:
    """A curve that text runs along, y up.

    Attributes:
        cubics: (m, 4, 2) its segments; each begins where its predecessor ends. Segments without length are dropped.
        closed: whether it also ends where it begins.
        name: what errors call it: a file and an id, or "the path".
        moved: how far, at most, it lies from the curve given, since :meth:`rounded`.

    Raises:
        GlyphsplineError: coordinates that are not finite, no length, or a gap between segments.

    Example:
        >>> from glyphspline import Path
        >>> path = Path.of([[0, 0], [30, 0], [30, 40]])
        >>> path
        <Path: open, 2 segments, length 70>
        >>> points, tangents = path.at([10, 50])
        >>> points.round(9).tolist(), tangents.round(9).tolist()[0]
        ([[10.0, 0.0], [30.0, 20.0]], [1.0, 0.0])
    """

    cubics: FloatArray
    closed: bool = False
    name: str = "the path"
    moved: float = 0.0

    def __post_init__(self) -> None:
        cubics = np.array(self.cubics, dtype=np.float64)
        if cubics.ndim != 3 or cubics.shape[1:] != (4, 2):
            raise GlyphsplineError(
                f"a path is a polyline (n, 2) or cubics (m, 4, 2), not {cubics.shape}", font=self.name
            )
        if not np.isfinite(cubics).all():
            raise GlyphsplineError("coordinates of the path are not finite", font=self.name)
        if np.abs(cubics).max(initial=0.0) > LARGEST:
            raise GlyphsplineError(f"coordinates of the path above {LARGEST:g}", font=self.name)
        extent = float(np.ptp(cubics.reshape(-1, 2), axis=0).max()) if len(cubics) else 0.0
        least = COINCIDENT * extent
        cubics = cubics[np.abs(cubics[:, 1:] - cubics[:, :1]).max(axis=(1, 2)) > least]
        if not len(cubics) or extent < SMALLEST:
            raise GlyphsplineError("the path has no length", font=self.name)
        gaps = np.abs(cubics[:, 0] - np.roll(cubics[:, 3], 1, axis=0)).max(axis=1)[0 if self.closed else 1 :]
        if len(gaps) and gaps.max() > 100 * least:
            raise GlyphsplineError(f"a gap of {gaps.max():.4g} between two segments of the path", font=self.name)
        object.__setattr__(self, "cubics", cubics)

    @classmethod
    def of(cls, curve: Path | Contour | Spline | ArrayLike, *, closed: bool | None = None, name: str = "") -> Path:
        """A path from a curve.

        Args:
            curve: a contour; a spline in the plane, of degree 4 and more to 1e-9 of its extent; the vertices (n, 2) of
                a polyline; or cubics (m, 4, 2).
            closed: only for an array. None: closed if the ends meet; True closes a polyline by a line.

        Raises:
            GlyphsplineError: coordinates that are not finite, no length, a gap, or another shape of array.
        """
        name = name or "the path"
        if isinstance(curve, Path):
            return curve
        if isinstance(curve, Contour):
            return cls(curve.cubics(), True, name)
        if isinstance(curve, Spline):
            if curve.control_points.shape[1] != 2:
                raise OptionError(f"a path is a spline in the plane, not in R^{curve.control_points.shape[1]}")
            pieces = curve.to_bezier()
            if curve.degree > 3:
                extent = float(np.ptp(curve.control_points, axis=0).max())
                return cls(cubic_approximation(pieces, COINCIDENT * extent or 1.0), curve.closed, name)
            return cls(np.array([as_cubic(piece) for piece in pieces]), curve.closed, name)
        array = np.asarray(curve, dtype=np.float64)
        if array.ndim == 2 and array.shape[1] == 2 and len(array):
            if closed and (array[0] != array[-1]).any():
                array = np.concatenate([array, array[:1]])
            share = (np.arange(4) / 3)[:, None]
            with np.errstate(invalid="ignore"):
                array = array[:-1, None] * (1 - share) + array[1:, None] * share
            array[:-1, 3] = array[1:, 0]
        if closed is None and array.shape[1:] == (4, 2) and len(array):
            extent = np.ptp(array.reshape(-1, 2), axis=0).max()
            closed = bool(np.abs(array[-1, 3] - array[0, 0]).max() <= COINCIDENT * extent)
        return cls(array, bool(closed), name)

    @classmethod
    def circle(cls, diameter: float, at: Place = "top") -> Path:
        """A circle about the origin, for text whose middle is at its top, clockwise, or at its bottom, the other way.

        It begins opposite, so that text aligned to its center stands upright there: at the top on the outside, at the
        bottom on the inside. It is of 24 cubics, with an error of 6e-9 of the radius.

        Raises:
            OptionError: the diameter is not a positive number, or the place is another.
        """
        require(is_positive(diameter), "the diameter of a circle is a positive number", diameter)
        require_choice("at", at, get_args(Place))
        way = -1.0 if at == "top" else 1.0
        angles = way * np.linspace(np.pi / 2, 5 * np.pi / 2, 25)
        points = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        points[-1] = points[0]
        handles = way * 4 / 3 * np.tan(np.pi / 48) * np.stack([-points[:, 1], points[:, 0]], axis=1)
        cubics = np.stack([points[:-1], (points + handles)[:-1], (points - handles)[1:], points[1:]], axis=1)
        return cls(cubics * (diameter / 2), True, "the circle")

    def __repr__(self) -> str:
        kind = "closed" if self.closed else "open"
        return f"<Path: {kind}, {counted(len(self.cubics), 'segment')}, length {self.length:.6g}>"

    @property
    def length(self) -> float:
        """Arc length."""
        return float(self.table.ends[-1])

    @property
    def length_error(self) -> float:
        """Proven bound of the error of ``length``, but for rounding.

        No curve is shorter than its chord or longer than its control polygon; this sums what they differ by.
        """
        return self.table.error

    @cached_property
    def table(self) -> Table:
        """The path in short parts. Their lengths are integrals of the speed by 16 Gauss nodes."""
        parts, segment = self.cubics, np.arange(len(self.cubics))
        first, width = np.zeros(len(parts)), np.ones(len(parts))
        while True:
            legs = np.hypot(*np.moveaxis(np.diff(parts, axis=1), -1, 0))
            polygon = legs.sum(axis=1)
            gap = polygon - np.hypot(*(parts[:, 3] - parts[:, 0]).T)
            # A part of the table is halved while its control polygon is longer than its chord by more than this share.
            # A part is halved, too, while its control polygon's longest leg is more than 1.1 times its shortest.
            long = (gap > 2e-7 * polygon) | (legs.max(axis=1) > 1.1 * legs.min(axis=1))
            # No part shorter than this share of the path is halved, as next to a cusp.
            long &= polygon > 1e-10 * polygon.sum()
            # Limit of parts of the table; ``length_error`` tells what they miss.
            if not long.any() or len(parts) + int(long.sum()) > 1 << 20:
                break
            left, right = split(parts[long])
            counts = 1 + long
            halves = (np.cumsum(counts) - 1)[long]  # where the second ones come
            width = np.repeat(width / counts, counts)
            parts, segment = np.repeat(parts, counts, axis=0), np.repeat(segment, counts)
            first = np.repeat(first, counts)
            parts[halves - 1], parts[halves] = left, right
            first[halves] += width[halves]
        d = derivative_points(parts)
        velocities = np.stack([d[:, 0], 2 * (d[:, 1] - d[:, 0]), d[:, 2] - 2 * d[:, 1] + d[:, 0]], axis=1)
        a, b, c = np.moveaxis(velocities[:, :, None], 1, 0)
        lengths = _norm(a, b, c, (NODES + 1) / 2) @ WEIGHTS / 2
        ends = np.concatenate([[0.0], np.cumsum(lengths)])
        return Table(parts, velocities, segment, first, width, ends, float(gap.sum()))

    @cached_property
    def joints(self) -> tuple[IntArray, FloatArray, FloatArray]:
        """Where segments join: parts that begin there, turns of the tangent in radians, and jumps of the curvature.

        The first point of an open path is not a joint.
        """
        parts = np.flatnonzero(self.table.first == 0)
        parts = parts if self.closed else parts[1:]
        before = _frame(self.table.cubics[parts - 1], self.table.velocities[parts - 1], np.ones(len(parts)))
        after = _frame(self.table.cubics[parts], self.table.velocities[parts], np.zeros(len(parts)))
        turn = np.arctan2(cross(before.tangents, after.tangents), (before.tangents * after.tangents).sum(axis=-1))
        return parts, turn, after.curvature - before.curvature

    def at(self, s: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Points and unit tangents at arc lengths s: each of shape ``s.shape + (2,)``.

        A closed path goes on round; an open one is continued straight beyond its ends. At a corner the tangent is
        the one after it.

        Raises:
            OptionError: an s that is not finite.
        """
        return self.frame(s)[:2]

    def frame(self, s: ArrayLike, side: ArrayLike = 0) -> Frame:
        """Points, unit tangents and signed curvature at arc lengths s, as for :meth:`at`.

        Args:
            side: for a place at a joint, 1 for the segment after it and -1 for the one before.
        """
        s = np.asarray(s, dtype=np.float64)
        if not np.isfinite(s).all():
            raise OptionError("arc lengths are finite numbers")
        flat, length = s.ravel(), self.length
        aside = np.broadcast_to(np.asarray(side), s.shape).ravel() * (COINCIDENT * length)
        part, x, beyond = self._located(flat, aside)
        points, tangents, curvature = _frame(self.table.cubics[part], self.table.velocities[part], x)
        if not self.closed:
            points = points + beyond[:, None] * tangents
            nudged = flat + aside
            curvature = np.where((nudged < 0) | (nudged > length), 0.0, curvature)
        return Frame(points.reshape(*s.shape, 2), tangents.reshape(*s.shape, 2), curvature.reshape(s.shape))

    def _located(self, s: FloatArray, aside: FloatArray) -> tuple[IntArray, FloatArray, FloatArray]:
        """Part and parameter there of (k,) arc lengths, and how far they lie beyond the ends of an open path."""
        table, length = self.table, self.length
        within = s + aside
        within = np.mod(within, length) if self.closed else within
        part = np.clip(np.searchsorted(table.ends, within, side="right") - 1, 0, len(table.ends) - 2)
        target, whole = within - aside - table.ends[part], table.ends[part + 1] - table.ends[part]
        target = np.clip(target, 0.0, whole)
        x = target / whole
        a, b, c = np.moveaxis(table.velocities[part], 1, 0)
        # To a parameter from an arc length: within a part the speed is almost constant.
        for _ in range(2):
            places = x[:, None] * ((INNER_NODES + 1) / 2)
            before = _norm(a[:, None], b[:, None], c[:, None], places) @ INNER_WEIGHTS * x / 2
            speed = _norm(a, b, c, x)
            x = np.clip(x + (target - before) / np.where(speed > 0, speed, np.inf), 0.0, 1.0)
        x = np.where(target <= 0, 0.0, np.where(target >= whole, 1.0, x))
        return part, x, s - np.clip(s, 0.0, length)

    def scaled(self, k: float) -> Path:
        """The path k times as large about the origin: k font units for each unit of a drawing.

        Raises:
            OptionError: k is not a positive number.
        """
        require(is_positive(k), "the scale of a path is a positive number", k)
        return Path(self.cubics * k, self.closed, self.name, self.moved * k)

    def reversed(self) -> Path:
        """The path in the opposite direction, from its end; a closed one from its start."""
        return Path(self.cubics[::-1, ::-1], self.closed, self.name, self.moved)

    def rounded(self, radius: float, corner_angle: float = CORNER_ANGLE) -> Path:
        """The path with a cubic in the place of each small kink, so that its tangent turns without a jump.

        Drawings have such kinks where coordinates were rounded. The cubic begins and ends at the distance where an
        arc of ``radius`` would touch straight neighbours, or half-way to the next joint if that is nearer. Turns of
        ``corner_angle`` degrees and more are corners and stay. ``moved`` says how far the path moves at most.

        Raises:
            OptionError: the radius is not a positive number.
        """
        require(is_positive(radius), "the radius of a rounding is a positive number", radius)
        parts, turn, _ = self.joints
        kink = (np.abs(turn) > SMOOTH) & (np.abs(turn) < np.radians(corner_angle))
        if not kink.any():
            return self
        m, table = len(self.cubics), self.table
        starts = np.append(table.ends[:-1][table.first == 0], self.length)
        lengths = np.diff(starts)
        reach = np.zeros(m)  # of the cubic round the joint that segment j begins at
        joint = table.segment[parts[kink]]
        least = np.minimum(lengths[joint], lengths[joint - 1]) / 2
        reach[joint] = np.minimum(radius * np.tan(np.abs(turn[kink]) / 2), least)
        after = np.roll(reach, -1)
        first, last = (self._parameters(starts[:-1] + reach, 1), self._parameters(starts[1:] - after, -1))
        first, last = np.where(reach > 0, first, 0.0), np.where(after > 0, last, 1.0)
        left, kept = split(self.cubics, first[:, None, None])
        kept, right = split(kept, ((last - first) / (1 - first))[:, None, None])
        arriving = self.frame(starts[:-1] + reach, 1).tangents  # of the cubics between
        leaving = self.frame(starts[1:] - after, -1).tangents
        chain, moved = [], 0.0
        for j in range(m):
            if reach[j] > 0:
                cubic = _joined(kept[j - 1][3], kept[j][0], leaving[j - 1], arriving[j])
                moved = max(moved, _spread(cubic, right[j - 1], left[j]))
                chain.append(cubic)
            chain.append(kept[j])
        if reach[0] > 0:  # the path begins, as before, in the middle of its first joint
            before, after = split(chain[0])
            chain = [after, *chain[1:], before]
        return Path(np.array(chain), self.closed, self.name, self.moved + moved)

    def _parameters(self, s: FloatArray, side: int) -> FloatArray:
        """(k,) parameters, on the segments that they lie on, of (k,) arc lengths from 0 to the length."""
        part, x, _ = self._located(s, np.full(len(s), side * COINCIDENT * self.length))
        return self.table.first[part] + x * self.table.width[part]


def _frame(cubics: FloatArray, velocities: FloatArray, x: FloatArray) -> Frame:
    """Each cubic (k, 4, 2) at its own parameter; at a cusp the tangent is the direction in which it goes on."""
    a, b, c = np.moveaxis(velocities, 1, 0)
    z = x[:, None]
    points = cubics[:, 0] + z * (a + z * (b / 2 + z * (c / 3)))
    points = np.where(z == 1, cubics[:, 3], points)
    first, second = a + z * (b + z * c), b + 2 * z * c
    speed = np.sqrt((first * first).sum(axis=1))
    still = speed <= COINCIDENT * np.abs(cubics - cubics[:, :1]).max(axis=(1, 2))
    if still.any():
        ahead = np.where(z < 1, second, -second)
        ahead = np.where(np.abs(ahead).max(axis=1, keepdims=True) > 0, ahead, c)
        first = np.where(still[:, None], ahead, first)
    tangents = first / np.hypot(first[:, 0], first[:, 1])[:, None]
    curvature = cross(tangents, second) / np.where(still, 1.0, speed) ** 2
    return Frame(points, tangents, np.where(still, np.inf, curvature))


def _norm(a: FloatArray, b: FloatArray, c: FloatArray, x: FloatArray) -> FloatArray:
    """Lengths (...) of vectors a + b x + c x² (..., 2)."""
    u = a[..., 0] + x * (b[..., 0] + x * c[..., 0])
    v = a[..., 1] + x * (b[..., 1] + x * c[..., 1])
    return np.sqrt(u * u + v * v)


def _joined(start: FloatArray, end: FloatArray, first: FloatArray, last: FloatArray) -> FloatArray:
    """(4, 2) the cubic between two points with these unit tangents, near an arc."""
    angle = np.arctan2(cross(first, last), first @ last)
    handle = np.hypot(*(end - start)) / 3 / np.cos(angle / 4) ** 2
    return np.array([start, start + handle * first, end - handle * last, end])


def _spread(*cubics: FloatArray) -> float:
    """Bound of the distance of a cubic from two others that join the same ends.

    All run forward along the chord, so at each place of it they differ by no more than their hulls are thick.
    """
    chord = cubics[0][3] - cubics[0][0]
    heights = cross(chord / np.hypot(*chord), np.concatenate(cubics) - cubics[0][0])
    return float(np.ptp(heights))
