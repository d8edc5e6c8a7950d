"""B-spline curves, closed (periodic) or open (clamped): evaluation, exact Bézier form; curvature in the plane."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from ..errors import OptionError
from ..types import FloatArray, IntArray, counted
from . import DEGREES
from .bezier import cubic_approximation, derivative_points, evaluate, normal_part, signed_curvature

Side: TypeAlias = Literal["left", "right"]
"""From where a derivative is taken at a knot."""


@dataclass(frozen=True, eq=False)
class Spline:
    """A B-spline curve in the plane, or in R^d. Drawing is for the plane.

    A knot may be repeated up to ``degree`` times: with multiplicity k the curve has degree - k continuous derivatives
    there. At a cubic's triple knot it has a corner, in a control point.

    Attributes:
        control_points: (n, d) if closed, d ≥ 2, where row i belongs to vertex p_i; (m + degree - 1, d) if open.
        knots: (n + 1,) from 0 to the period if closed; the m break points if open, where the ends have multiplicity
            degree + 1. They do not decrease. A multiple knot at the seam of a closed curve may stand in part at the
            end: with 0, 0, …, T, T the knot 0 is triple, and the control point 0 in the middle of it.
        degree: 2 to 6. closed: periodic; otherwise clamped at both ends.

    Raises:
        ValueError: another number of control points, a degree or knots that are none.

    Example:
        >>> from glyphspline import Spline
        >>> round_square = Spline([[0, 0], [1, 0], [1, 1], [0, 1]], [0, 1, 2, 3, 4])
        >>> round_square
        <Spline: closed, degree 3, 4 control points, t from 0 to 4>
        >>> round_square([0.5, 4.5]).round(3).tolist()  # the period is 4
        [[0.5, 0.042], [0.5, 0.042]]
        >>> bool(round_square.curvature(0.5) > 0)  # it turns left
        True
        >>> round_square.to_bezier().shape
        (4, 4, 2)
    """

    control_points: FloatArray
    knots: FloatArray
    degree: int = 3
    closed: bool = True

    def __post_init__(self) -> None:
        P = np.ascontiguousarray(self.control_points, dtype=np.float64)
        u = np.ascontiguousarray(self.knots, dtype=np.float64)
        if self.degree not in DEGREES:
            raise ValueError(f"degree is 2 to 6, not {self.degree}")
        expected = len(u) - 1 if self.closed else len(u) + self.degree - 1
        if P.ndim != 2 or len(P) != expected or P.shape[1] < 2:
            raise ValueError(f"{len(u)} knots ask for ({expected}, d) control points with d >= 2, not {P.shape}")
        full = full_knots(u, self.degree, self.closed)
        inner = full if self.closed else full[1:-1]  # the ends of an open curve have one more
        rising = np.isfinite(u).all() and (np.diff(u) >= 0.0).all() and u[0] < u[-1]
        if not (rising and (inner[self.degree :] > inner[: -self.degree]).all()):
            raise ValueError(f"knots are finite, do not decrease, and have multiplicity {self.degree} at most")
        object.__setattr__(self, "control_points", P)
        object.__setattr__(self, "knots", u)

    @classmethod
    def trusted(cls, control_points: FloatArray, knots: FloatArray, degree: int, closed: bool) -> Spline:
        """A spline without the checks, for callers whose arrays are right by construction."""
        spline = cls.__new__(cls)
        spline.__dict__.update(control_points=control_points, knots=knots, degree=degree, closed=closed)
        return spline

    def __repr__(self) -> str:
        kind, d = "closed" if self.closed else "open", self.control_points.shape[1]
        kind = f"{kind}, in R^{d}" if d > 2 else kind
        points, (first, last) = counted(len(self.control_points), "control point"), self.knots[[0, -1]].tolist()
        return f"<Spline: {kind}, degree {self.degree}, {points}, t from {first:g} to {last:.6g}>"

    @property
    def period(self) -> float:
        """Length of the parameter range: T for a closed curve."""
        return float(self.knots[-1] - self.knots[0])

    @cached_property
    def full_knots(self) -> FloatArray:
        """The knots with ``degree`` more at each end: continued periodically, or the ends repeated."""
        return full_knots(self.knots, self.degree, self.closed)

    @cached_property
    def spans(self) -> IntArray:
        """(pieces,) index in ``knots`` of where each span begins; between equal knots there is none."""
        return np.flatnonzero(np.diff(self.knots))

    @cached_property
    def span_controls(self) -> IntArray:
        """(pieces, degree + 1) indices of the control points of each span."""
        return span_controls(len(self.knots) - 1, self.degree, self.closed)[self.spans]

    @cached_property
    def _bezier(self) -> FloatArray:
        return bezier_pieces(self.full_knots, self.control_points[self.span_controls], self.spans)

    def to_bezier(self) -> FloatArray:
        """The curve as Bézier pieces, one per knot span, in curve order: (pieces, degree + 1, d)."""
        return self._bezier.copy()

    def _locate(self, t: FloatArray, side: Side = "right") -> tuple[IntArray, FloatArray, FloatArray]:
        """Piece, local parameter in [0, 1] and span length for each t (wrapped if closed, clamped if open)."""
        u, spans = self.knots, self.spans
        if side not in ("left", "right"):
            raise OptionError(f"a side is left or right, not {side!r}")
        if self.closed:
            t = u[0] + np.mod(t - u[0], self.period)
            t = np.where(t == u[0], u[-1], t) if side == "left" else t
        t = np.clip(t, u[0], u[-1])
        piece = np.clip(np.searchsorted(u[spans], t, side=side) - 1, 0, len(spans) - 1)
        a = u[spans[piece]]
        h = u[spans[piece] + 1] - a
        return piece, (t - a) / h, h

    def __call__(self, t: ArrayLike, derivative: int = 0, side: Side = "right") -> FloatArray:
        """The curve or one of its derivatives at t: shape ``t.shape + (d,)``.

        The domain is from ``knots[0]`` to ``knots[-1]``. Beyond it a closed curve repeats itself with its
        :attr:`period`; an open one stays at the point of the nearer end, with the derivatives there.

        Args:
            t: parameters, of any shape. derivative: 0 for points, 1 for the first derivative by t, and so on.
            side: of a knot where the derivative jumps, the one from which it is taken.

        Example:
            >>> from glyphspline import Spline
            >>> corner = Spline([[0, 0], [1, 0], [2, 0], [2, 1], [2, 2]], [0, 1, 1, 2], 2, closed=False)
            >>> corner(1, derivative=1).tolist(), corner(1, derivative=1, side="left").tolist()
            ([0.0, 2.0], [2.0, 0.0])
        """
        t = np.asarray(t, dtype=np.float64)
        if derivative > self.degree:
            return np.zeros((*t.shape, self.control_points.shape[1]))
        span, x, h = self._locate(t.ravel(), side)
        values = evaluate(derivative_points(self._bezier, derivative)[span], x) / h[:, None] ** derivative
        return values.reshape(*t.shape, self.control_points.shape[1])

    def curvature(self, t: ArrayLike, side: Side = "right") -> FloatArray:
        """Curvature at t, in 1/unit, infinite where the speed is zero.

        It is positive where a curve in the plane turns left, and has no sign in more dimensions. The domain, what lies
        beyond it, and the side are as for calling the spline.
        """
        first, second = self(t, 1, side), self(t, 2, side)
        if self.control_points.shape[1] == 2:
            return signed_curvature(first, second)
        found: FloatArray = np.linalg.norm(normal_part(first, second), axis=-1)
        return np.where(np.isnan(found), np.inf, found)

    def torsion(self, t: ArrayLike, side: Side = "right") -> FloatArray:
        """Torsion at t of a curve in R^3, in 1/unit: positive for a right-handed screw, NaN where it has no curvature.

        Raises:
            OptionError: the spline is not in R^3.

        Example:
            >>> import numpy as np
            >>> from glyphspline import interpolate
            >>> t = np.linspace(0, 6, 25)
            >>> screw = interpolate(np.stack([np.cos(t), np.sin(t), t], axis=1), closed=False).spline
            >>> screw.curvature(4).round(1).item(), screw.torsion(4).round(1).item()
            (0.5, 0.5)
        """
        if self.control_points.shape[1] != 3:
            raise OptionError(f"torsion needs a spline in R^3, not in R^{self.control_points.shape[1]}")
        first, second, third = (self(t, order, side) for order in (1, 2, 3))
        with np.errstate(invalid="ignore", divide="ignore"):
            axis = np.cross(first, second)
            return np.asarray((axis * third).sum(axis=-1) / (axis * axis).sum(axis=-1))

    def project(self, weights: ArrayLike) -> Spline:
        """The planar spline of a blend of masters, for a spline of K masters side by side: x_1, y_1, x_2, y_2, …

        Args:
            weights: (K,) of the masters, d = 2K; (1, 0, …, 0) is the first one.

        Raises:
            OptionError: weights of another shape, or not finite.

        Example:
            >>> from glyphspline import Spline
            >>> light, bold = [[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 0], [3, 0], [3, 1], [0, 1]]
            >>> both = Spline([[*a, *b] for a, b in zip(light, bold)], [0, 1, 2, 3, 4])
            >>> both
            <Spline: closed, in R^4, degree 3, 4 control points, t from 0 to 4>
            >>> both.project([0.5, 0.5]).control_points.tolist()
            [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]
        """
        given, d = np.asarray(weights, dtype=np.float64), self.control_points.shape[1]
        if d % 2 or given.shape != (d // 2,) or not np.isfinite(given).all():
            raise OptionError(
                f"a spline in R^2K is projected by K finite weights, one in R^{d} not by {given.tolist()}"
            )
        controls = np.einsum("nkc,k->nc", self.control_points.reshape(len(self.control_points), -1, 2), given)
        return Spline(controls, self.knots, self.degree, self.closed)

    def basis_rows(self, t: ArrayLike) -> tuple[IntArray, FloatArray]:
        """(len(t), degree + 1) which basis functions are not zero at t, by control point, and their values there."""
        span, x, _ = self._locate(np.asarray(t, dtype=np.float64).ravel())
        d = self.degree
        identity = np.broadcast_to(np.eye(d + 1), (len(self.spans), d + 1, d + 1))
        local = bezier_pieces(self.full_knots, identity, self.spans)
        return self.span_controls[span], evaluate(local[span], x)

    def basis(self, t: ArrayLike) -> FloatArray:
        """(len(t), control points) the collocation matrix: every basis function at every t."""
        columns, values = self.basis_rows(t)
        rows = np.zeros((len(columns), len(self.control_points)))
        np.add.at(rows, (np.arange(len(columns))[:, None], columns), values)
        return rows

    def draw(self, pen: Any, tolerance: float | None = None) -> None:
        """Draw with a fontTools segment pen: degrees 2 and 3 exactly.

        Other degrees become cubics within ``tolerance`` of the curve, compared at equal parameters (default: 1e-5 of
        the control polygon's extent).

        Raises:
            OptionError: the spline is not in the plane.
        """
        pieces, d = self._bezier, self.control_points.shape[1]
        if d != 2:
            raise OptionError(f"drawing needs a spline in the plane, not in R^{d}; project(weights) gives one")
        if self.degree > 3:
            extent = float(np.ptp(self.control_points, axis=0).max())
            pieces = cubic_approximation(pieces, tolerance or 1e-5 * extent)
        points = [[tuple(p) for p in piece] for piece in pieces.tolist()]
        if self.closed:
            points[-1][-1] = points[0][0]
        pen.moveTo(points[0][0])
        for piece in points:
            (pen.qCurveTo if self.degree == 2 else pen.curveTo)(*piece[1:])
        (pen.closePath if self.closed else pen.endPath)()

    def clamped(self) -> Spline:
        """The same curve as an open spline whose ends meet, as programs without periodic splines read it.

        The first knot is inserted at both ends until it has multiplicity degree + 1 there: no point of the curve moves,
        and all derivatives agree across the ends as before. Only ``degree - 1`` control points at either end are new.
        An open spline is returned as it is.

        Example:
            >>> from glyphspline import Spline
            >>> clamped = Spline([[0, 0], [1, 0], [1, 1], [0, 1]], [0, 1, 2, 3, 4]).clamped()
            >>> clamped
            <Spline: open, degree 3, 7 control points, t from 0 to 4>
            >>> clamped.control_points[[0, -1]].round(3).tolist()  # both where t = 0
            [[0.167, 0.167], [0.167, 0.167]]
        """
        if not self.closed:
            return self
        d, u = self.degree, self.knots
        knots = u[self.spans[0] : self.spans[-1] + 2]  # the seam once at both ends
        target = full_knots(knots, d, False)
        index = np.arange(len(knots) + d - 1)
        piece = np.searchsorted(u[self.spans], target[index + d + 1]) - 1  # the last one with a share of point i
        arguments = [target[index + r] for r in range(1, d + 1)]
        own = self.control_points[self.span_controls[piece]]
        controls = _blossom(self.full_knots, own, self.spans[piece], arguments)
        controls[-1] = controls[0]
        return Spline(controls, knots, d, closed=False)

    def to_scipy(self) -> Any:
        """The same curve as a ``scipy.interpolate.BSpline``, periodic if closed."""
        from scipy.interpolate import BSpline

        d, controls = self.degree, self.control_points
        if self.closed:
            controls = np.take(controls, np.arange(len(controls) + d) - d + (d + 1) // 2, axis=0, mode="wrap")
        return BSpline(self.full_knots, controls, d, extrapolate="periodic" if self.closed else False)


def full_knots(knots: FloatArray, degree: int, closed: bool) -> FloatArray:
    """Knots with ``degree`` more at each end: continued with period T, or the ends repeated."""
    if not closed:
        return np.concatenate([np.full(degree, knots[0]), knots, np.full(degree, knots[-1])])
    n = len(knots) - 1
    index = np.arange(-degree, n + degree + 1)
    return knots[index % n] + (index // n) * (knots[-1] - knots[0])


def span_controls(spans: int, degree: int, closed: bool) -> IntArray:
    """(spans, degree + 1) indices of the control points whose basis functions are not zero on each span.

    On a closed curve B_i is centred on p_i, so span k = [u_k, u_(k+1)] of a cubic uses k-1 to k+2, modulo n.
    """
    index = np.arange(spans)[:, None] + np.arange(degree + 1)
    return (index - degree + (degree + 1) // 2) % spans if closed else index


def bezier_pieces(full: FloatArray, controls: FloatArray, span: IntArray | None = None) -> FloatArray:
    """Exact Bézier points of every knot span, by blossoming.

    Args:
        full: knots of :func:`full_knots`. controls: (pieces, degree + 1, k) of each span.
        span: (pieces,) where each begins in the knots; None if no knot is multiple.

    Returns:
        (pieces, degree + 1, k): Bézier point j of span [a, b] is the blossom at a (degree - j times) and b (j times).
    """
    d = controls.shape[1] - 1
    span = np.arange(len(controls)) if span is None else span
    a, b = full[span + d], full[span + d + 1]
    return np.stack([_blossom(full, controls, span, [a] * (d - j) + [b] * j) for j in range(d + 1)], axis=1)


def _blossom(full: FloatArray, controls: FloatArray, span: IntArray, arguments: Sequence[FloatArray]) -> FloatArray:
    """(m, k) the blossom of some spans at ``degree`` arguments (m,); ``controls`` (m, degree + 1, k) are theirs."""
    d = controls.shape[1] - 1
    D = np.array(controls, dtype=np.float64)
    for r, x in enumerate(arguments, 1):
        for i in range(d, r - 1, -1):
            left, right = full[span + i], full[span + i + d + 1 - r]
            weight = ((x - left) / (right - left))[:, None]
            D[:, i] = (1 - weight) * D[:, i - 1] + weight * D[:, i]
    return D[:, d]
