"""Bézier pieces as arrays of shape (..., degree + 1, 2), the form that all curves share."""

from __future__ import annotations

import numpy as np

from ..types import FloatArray

AT_END = 1e-9
"""Parameter distance within which a root is an end of its piece, but for rounding."""


def evaluate(pieces: FloatArray, x: FloatArray) -> FloatArray:
    """Evaluate each piece at its own local parameter, by de Casteljau: (m, degree + 1, k) and (m,) give (m, k)."""
    x = x[:, None, None]
    while pieces.shape[1] > 1:
        pieces = (1 - x) * pieces[:, :-1] + x * pieces[:, 1:]
    return pieces[:, 0]


def derivative_points(pieces: FloatArray, order: int = 1) -> FloatArray:
    """Bézier points of the derivative with respect to the local parameter, (..., degree + 1 - order, k)."""
    for _ in range(order):
        pieces = (pieces.shape[-2] - 1) * np.diff(pieces, axis=-2)
    return pieces


def split(pieces: FloatArray, x: float | FloatArray = 0.5) -> tuple[FloatArray, FloatArray]:
    """Both parts of each piece, cut at local parameter x: one, or (m, 1, 1) of m pieces."""
    left, right = [pieces[..., 0, :]], [pieces[..., -1, :]]
    while pieces.shape[-2] > 1:
        pieces = (1 - x) * pieces[..., :-1, :] + x * pieces[..., 1:, :]
        left.append(pieces[..., 0, :])
        right.append(pieces[..., -1, :])
    return np.stack(left, axis=-2), np.stack(right[::-1], axis=-2)


def roots_inside(a: FloatArray, b: FloatArray, c: FloatArray) -> FloatArray:
    """(..., 2) the roots of a t² + b t + c inside (0, 1), ascending; NaN for those that there are not, and double ones.

    Such a root of a derivative is an inflection, not an extremum. Within ``AT_END`` of an end a root is that end.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.sqrt(b * b - 4 * a * c)
        q = -0.5 * (b + np.where(b >= 0, root, -root))
        roots = np.stack([c / q, q / a], axis=-1)  # one is infinite where the equation is linear
    roots[~((root > 0)[..., None] & (roots > AT_END) & (roots < 1 - AT_END))] = np.nan
    return np.sort(roots, axis=-1)


def cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """The z component of the product of plane vectors (..., 2): positive if b lies to the left of a."""
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def normal_part(first: FloatArray, second: FloatArray) -> FloatArray:
    """(..., d) curvature vector, of length |κ|, from first and second derivatives (..., d); NaN at zero speed."""
    with np.errstate(invalid="ignore", divide="ignore"):
        speed = np.linalg.norm(first, axis=-1, keepdims=True)
        along, bend = first / speed, second / speed
        return (bend - (bend * along).sum(axis=-1, keepdims=True) * along) / speed


def signed_curvature(first: FloatArray, second: FloatArray) -> FloatArray:
    """Curvature from first and second derivatives (..., 2): positive turns left; infinite at zero speed."""
    speed = np.hypot(first[..., 0], first[..., 1])
    moving = speed > 0
    safe = np.where(moving, speed, 1.0)
    # Three divisions by the speed, not one by its cube: tiny and huge curves do not under- or overflow.
    return np.where(moving, cross(first / safe[..., None], second / safe[..., None]) / safe, np.inf)


def cubic_approximation(pieces: FloatArray, tolerance: float) -> FloatArray:
    """Cubics (k, 4, 2) within ``tolerance`` of pieces of any degree, compared at equal parameters.

    Each cubic matches ends and end derivatives. The largest Bézier coefficient of the difference bounds its error; a
    piece is halved until the bound is small enough.
    """
    d = pieces.shape[1] - 1
    result, todo = [], list(pieces[::-1])
    while todo:
        part = todo.pop()
        inner = part[1] - part[0], part[-1] - part[-2]
        cubic = np.array([part[0], part[0] + inner[0] * d / 3, part[-1] - inner[1] * d / 3, part[-1]])
        raised = cubic
        while len(raised) < len(part):
            raised = elevate(raised)
        if np.hypot(*(raised - part).T).max() <= tolerance:
            result.append(cubic)
        else:
            todo += reversed(split(part))
    return np.array(result)


def elevate(piece: FloatArray) -> FloatArray:
    """A piece with its degree raised by one: (degree + 1, k) gives (degree + 2, k)."""
    d = len(piece)
    weight = np.arange(1, d)[:, None] / d
    inner = weight * piece[:-1] + (1 - weight) * piece[1:]
    return np.concatenate([piece[:1], inner, piece[-1:]])


def as_cubic(piece: FloatArray) -> FloatArray:
    """A piece of degree 1, 2 or 3, (degree + 1, 2), as a cubic, (4, 2)."""
    while len(piece) < 4:
        piece = elevate(piece)
    return piece
