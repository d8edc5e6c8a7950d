"""The sharp mode: contours cut at corners and straight lines, with one spline of variant 2 in between, or cubics.

:mod:`.cutting` cuts the contours and fits the pieces, :mod:`.assembly` puts them together; this file makes sure that
the result is within the tolerance, and measures it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from ...curves.bspline import Spline
from ...errors import PolygonError
from ...interpolation.api import interpolate_many
from ...interpolation.result import Interpolation
from ...outlines.contour_arrays import ContourArrays, Polylines, offsets_of
from ...outlines.segments import all_cubics
from ...types import BoolArray, FloatArray, IntArray, Views
from ..certified_distance import SHARPNESS
from ..measures import Columns, distance_columns
from ..options import Options
from ..refit import Fits
from ..results import ConvertedContours
from .assembly import certify, put_together
from .cutting import choose, cut_again, cut_all, source_pieces
from .pieces import CLOSED, CONTOUR, SPANS, Pieces, part
from .search_settings import MOST_SPANS, SEARCHES
from .spline_search import fit_splines
from .split_contours import Settings, SplitContours

TRIES = (1.0, 0.5, 0.25, 0.1)
"""Shares of the tolerance that are tried."""

LONG_LINE = 0.02
"""Share of the em from which straight lines stay lines."""

SHARE = 0.97
"""Share of the tolerance that the fit may use. The rest is for what its samples miss; the certificate decides."""

STRIDE = {"fast": 2, "best": 1}
"""Cubics of ``continuity="g1"`` end at every so many smooth joints of the source."""

ROUNDS = {"fast": 4, "best": 6}
"""Most Gauss-Newton steps of such a cubic."""

RETRIES = {"c2": ((0.9, False), (0.75, False), (1.0, True)), "g1": ((0.8, False),)}
"""What is tried for pieces that fail the certificate: a share of the samples' tolerance, and whether to cut at all
corners. In the end the source's own segments take their place.
"""


def sharp_fits(options: Options, tolerance: float, em: float) -> Fits:
    """Fits within ``tolerance``, and then closer; it and ``em`` are in font units."""

    def fit(contours: ContourArrays, attempt: int) -> ConvertedContours:
        return _converted(contours, options, tolerance, TRIES[attempt], em)

    return Fits(len(TRIES), fit, keeps_crossing=True)


def _converted(source: ContourArrays, options: Options, tolerance: float, share: float, em: float) -> ConvertedContours:
    """Contours fitted to within a share of the tolerance, and measured."""
    fit = fit_sharp(source, options, share * tolerance, em)
    where, starts, vertices = fit.pieces.where, fit.pieces.starts, fit.pieces.vertices[0]
    # Where two pieces meet, the vertex belongs to the second one.
    open_ends = starts[1:][where[:, CLOSED] == 0] - 1
    counts = np.add.reduceat(np.maximum(where[:, SPANS], 1), fit.offsets[:-1])
    closed = np.ones(source.num_contours, dtype=np.bool_)
    polygons = Polylines(np.delete(vertices, open_ends, axis=0), offsets_of(counts), closed)
    first = fit.offsets[:-1]
    bounds, gaps = np.maximum.reduceat(fit.bounds, first), np.maximum.reduceat(fit.gaps, first)
    arcs = np.flatnonzero(where[:, SPANS])
    return ConvertedContours(
        source,
        fit.curve,
        polygons,
        Views(len(arcs), fit.interpolations),
        fit.controls,
        np.searchsorted(arcs, fit.offsets),
        _solved_columns(fit) | distance_columns(gaps.tolist(), bounds.tolist(), tolerance),
    )


def _solved_columns(fit: SharpFit) -> Columns:
    """Of several arcs the worst counts, and the most iterations. In arcs of one span nothing is iterated."""
    spans, first = fit.pieces.where[:, SPANS], fit.offsets[:-1]
    segments = np.add.reduceat(np.maximum(spans, 1), first)
    numbers = np.add.reduceat(np.where(spans > 0, 2 * spans + 4 * (fit.pieces.where[:, CLOSED] == 0), 2), first)
    arcs: list[list[Interpolation]] = [[] for _ in first]
    for q, arc in fit.splines.items():
        arcs[fit.pieces.where[q, CONTOUR]].append(arc)
    return {
        "vertices": segments.tolist(),
        "segments": segments.tolist(),
        "numbers": numbers.tolist(),
        "iterations": [max((arc.iterations for arc in own), default=None) for own in arcs],
        "residual": [max((arc.max_error for arc in own), default=None) for own in arcs],
        "converged": [all(arc.converged for arc in own) if own else None for own in arcs],
        "rate_bound": [max((arc.rate_bound for arc in own), default=None) for own in arcs],
        "fallbacks": [sum(arc.fallbacks for arc in own) if own else None for own in arcs],
    }


@dataclass(frozen=True, eq=False)
class SharpFit:
    """Contours as lines and arcs.

    Attributes:
        pieces: the lines and arcs of all contours.
        offsets: (C + 1,) where in ``pieces`` each contour begins.
        splines: the interpolations of those arcs that have more than one span, by their piece.
        curve: the contours they make, before rounding. controls: the control polygons of all arcs.
        bounds, gaps: (P,) certified distance of each piece, as written, from the source, and the largest one seen.
    """

    pieces: Pieces
    offsets: IntArray
    splines: dict[int, Interpolation]
    curve: ContourArrays
    controls: Polylines
    bounds: FloatArray
    gaps: FloatArray

    def interpolations(self) -> list[Interpolation]:
        """All arcs; one of a single span interpolates its two ends as it is."""
        arcs = np.flatnonzero(self.pieces.where[:, SPANS]).tolist()
        first, points = self.controls.offsets.tolist(), self.controls.points
        return [
            self.splines[q] if q in self.splines else _single_span(points[i : i + 4])
            for q, i in zip(arcs, first[:-1], strict=True)
        ]


def _single_span(controls: FloatArray) -> Interpolation:
    (x0, y0), _, _, (x1, y1) = controls.tolist()
    knots = np.array([0.0, np.hypot(x1 - x0, y1 - y0)])
    return Interpolation(
        spline=Spline.trusted(controls, knots, 3, False),
        parameters=knots,
        intervals=knots.repeat(2).reshape(2, 2),
        iterations=0,
        residuals=np.zeros(1),
        converged=True,
        fallbacks=0,
        rate_bound=0.0,
        merged=np.empty(0, dtype=np.int64),
        uncertified=0,
    )


def fit_sharp(contours: ContourArrays, options: Options, tolerance: float, em: float) -> SharpFit:
    """Lines and arcs within ``tolerance`` of contours, certified after rounding to ``options.precision``.

    Pieces that miss it although their samples were near enough are fitted again more closely, and in the end become
    the source's own segments, of which each is an arc of one span.
    """
    settings = Settings(
        near=max(SHARE * tolerance - 10.0**-options.precision, tolerance / 4),
        angle=float(np.radians(options.corner_angle)), line=LONG_LINE * em, c2=options.continuity == "c2",
        search=SEARCHES[options.effort](
            margin=float(options.margin), residual=options.solver_tolerance, most=MOST_SPANS[options.continuity]
        ),
        rounds=ROUNDS[options.effort], stride=STRIDE[options.effort],
    )  # fmt: skip
    split, pieces, stretches = cut_all(all_cubics(contours)[None], contours, settings)
    if len(stretches.piece):
        pieces = fit_splines(pieces, stretches, settings.near, settings.search, False)
    fit = _certified(split, choose(split, pieces, settings.near), options, tolerance)
    tries = RETRIES[options.continuity]
    for attempt in range(len(tries) + 1):
        poor = fit.bounds > tolerance
        if not poor.any():
            break
        fit = _certified(split, refitted(split, fit.pieces, poor, tries[attempt:], settings), options, tolerance)
    return fit


def refitted(
    contours: SplitContours, pieces: Pieces, poor: BoolArray, tries: Sequence[tuple[float, bool]], settings: Settings
) -> Pieces:
    """Pieces with others in the place of poor ones: fitted more closely, or else the source's own segments."""
    parts, done = [], 0
    for q in np.flatnonzero(poor).tolist():
        parts.append(part(pieces, done, q))
        parts.append(_refitted_piece(contours, part(pieces, q, q + 1), tries, settings))
        done = q + 1
    parts.append(part(pieces, done, len(poor)))
    where, places, errors = (np.concatenate([own[k] for own in parts]) for k in (0, 3, 5))
    vertices, tangents = (np.concatenate([own[k] for own in parts], axis=1) for k in (2, 4))
    starts = offsets_of(np.maximum(where[:, SPANS], 1) + 1 - where[:, CLOSED])
    return Pieces(where, starts, vertices, places, tangents, errors)


def _refitted_piece(
    contours: SplitContours, piece: Pieces, tries: Sequence[tuple[float, bool]], settings: Settings
) -> Pieces:
    """What takes the place of a single piece."""
    for share, cut in tries:
        near = share * settings.near
        found, stretches = cut_again(contours, piece, cut, settings)
        if len(stretches.piece):
            found = fit_splines(found, stretches, near, settings.search, not cut)
        if found.errors.max() <= near:
            return choose(contours, found, near)
    return source_pieces(contours, piece)


def _certified(split: SplitContours, pieces: Pieces, options: Options, tolerance: float) -> SharpFit:
    """The pieces with curves put through them, measured against the source."""
    count = len(split.flipped)
    splines = _interpolated(pieces, options)
    assembly = put_together(pieces, count, *_splines(splines.values()))
    curves = assembly.curves
    written = curves.rounded(options.precision)
    bounds, gaps = certify(split, pieces, assembly, written, SHARPNESS * tolerance, tolerance)
    offsets = np.searchsorted(pieces.where[:, CONTOUR], np.arange(count + 1))
    return SharpFit(pieces, offsets, splines, curves, assembly.controls, bounds, gaps)


def _splines(arcs: Iterable[Interpolation]) -> tuple[FloatArray, FloatArray]:
    """All knots and all control points."""
    splines = [arc.spline for arc in arcs]
    if not splines:
        return np.empty(0), np.empty((0, 2))
    return np.concatenate([s.knots for s in splines]), np.concatenate([s.control_points for s in splines])


def _interpolated(pieces: Pieces, options: Options) -> dict[int, Interpolation]:
    """The splines of more than one span, in order. Lemma 2 has an interval for all of their vertices."""
    where, starts, vertices, tangents = pieces.where, pieces.starts, pieces.vertices[0], pieces.tangents[0]
    spans, closed = where[:, SPANS], where[:, CLOSED] > 0
    arcs: dict[int, Interpolation] = {}
    for which in (closed, (spans > 1) & ~closed):
        chosen = np.flatnonzero(which).tolist()
        if not chosen:
            continue
        ring = bool(closed[chosen[0]])
        try:
            found = interpolate_many(
                [vertices[starts[q] : starts[q + 1]] for q in chosen], options.variant,
                end_tangents=None if ring else [(t[0], t[1]) for t in tangents[chosen]], threads=1,
                margin=options.margin, residual_tolerance=options.solver_tolerance,
                max_iterations=options.max_iterations, closed=ring,
            )  # fmt: skip
        except PolygonError as error:
            error.contour = int(where[chosen[error.contour or 0], CONTOUR])
            raise
        arcs |= zip(chosen, found, strict=True)
    return dict(sorted(arcs.items()))
