"""The sharp mode: contours cut at corners and straight lines, with one spline of variant 2 in between, or cubics.

:mod:`.cutting` cuts the contours and fits the pieces, :mod:`.assembly` puts them together; this file makes sure that
the result is within the tolerance, and measures it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...curves.bspline import Spline
from ...curves.pairing import SHARPNESS
from ...errors import PolygonError
from ...interpolation.api import interpolate_many
from ...interpolation.result import Interpolation
from ...outlines.contour_arrays import ContourArrays, Polylines, offsets_of
from ...outlines.segments import all_cubics
from ...types import BoolArray, FloatArray, IntArray, Views
from ..faithful import Fits
from ..ladders import MOST_SPANS, MOVED, RETRIES, RETRIES_OF_MASTERS, SEARCHES, SHARP_TRIES
from ..measures import Columns, distance_columns
from ..options import Options
from ..results import ConvertedContours
from .assembly import certify, certify_masters, put_together
from .corners import Joints
from .cutting import choose, cut_again, cut_all, joints_again, source_pieces
from .pieces import CLOSED, CONTOUR, SPANS, Pieces, of_master, part
from .spline_search import fit_splines
from .split_contours import Settings, SplitContours

LONG_LINE = 0.02
"""Share of the em from which straight lines stay lines."""

SHARE = 0.97
"""Share of the tolerance that the fit may use. The rest is for what its samples miss; the certificate decides."""

STRIDE = {"fast": 2, "best": 1}
"""Cubics of ``continuity="g1"`` end at every so many smooth joints of the source."""

ROUNDS = {"fast": 4, "best": 6}
"""Most Gauss-Newton steps of such a cubic."""


def sharp_fits(options: Options, tolerance: float, em: float) -> Fits:
    """Fits within ``tolerance``, and then closer; it and ``em`` are in font units."""

    def fit(contours: ContourArrays, attempt: int) -> ConvertedContours:
        return _converted(contours, options, tolerance, SHARP_TRIES[attempt], em)

    return Fits(len(SHARP_TRIES), fit, keeps_crossing=True)


def _converted(source: ContourArrays, options: Options, tolerance: float, share: float, em: float) -> ConvertedContours:
    """Contours fitted to within a share of the tolerance, and measured."""
    fit = fit_sharp(source, all_cubics(source)[None], None, options, share * tolerance, em)
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
        fit.curves[0],
        polygons,
        Views(len(arcs), fit.interpolations),
        fit.controls[0],
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
        curves: the contours they make in each master, before rounding. controls: the control polygons of all arcs.
        bounds: (P,) certified distance of each piece from the source: of a plain outline as it is written, and of
            masters, unrounded, in the whole design space. gaps: (P,) the largest one seen; NaN for masters.
        regular: (P,) whether the curves of masters have speed everywhere, in the whole design space; None for a plain
            outline.
    """

    pieces: Pieces
    offsets: IntArray
    splines: dict[int, Interpolation]
    curves: tuple[ContourArrays, ...]
    controls: tuple[Polylines, ...]
    bounds: FloatArray
    gaps: FloatArray
    regular: BoolArray | None

    def interpolations(self) -> list[Interpolation]:
        """All arcs of a single master; one of a single span interpolates its two ends as it is."""
        arcs = np.flatnonzero(self.pieces.where[:, SPANS]).tolist()
        first, points = self.controls[0].offsets.tolist(), self.controls[0].points
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


def fit_sharp(
    source: ContourArrays, cubics: FloatArray, mixes: FloatArray | None, options: Options, tolerance: float, em: float
) -> SharpFit:
    """Lines and arcs within ``tolerance`` of contours, certified: a plain outline after rounding to the precision of
    the options, masters in the whole design space.

    Pieces that miss it although their samples were near enough are fitted again more closely, and in the end become
    the source's own segments, of which each is an arc of one span.

    Args:
        source: the contours' degrees and offsets. cubics: (K, m, 4, 2) their segments in each of K masters.
        mixes: (V, K) weights of the masters at the corners of the design space's grid; None for a plain outline.
    """
    sharp = options.corners == "sharp"  # or else no joint is hard, and every contour is one closed curve
    settings = Settings(
        near=max(SHARE * tolerance - 10.0**-options.precision, tolerance / 4),
        angle=float(np.radians(options.corner_angle)) if sharp else np.inf, line=LONG_LINE * em if sharp else np.inf,
        c2=options.continuity == "c2",
        search=SEARCHES[options.effort](
            margin=float(options.margin), residual=options.solver_tolerance, most=MOST_SPANS[options.continuity],
            lays=int(not sharp),
        ),
        rounds=ROUNDS[options.effort], stride=STRIDE[options.effort],
    )  # fmt: skip
    split, pieces, stretches = cut_all(cubics, source, settings)
    if len(stretches.piece):
        pieces = fit_splines(pieces, stretches, settings.near, settings.search, False)
    pieces = choose(split, pieces, settings.near)
    fit = _certified(split, pieces, mixes, options, tolerance, None, np.full(len(pieces.where), -1))
    tries = RETRIES[options.continuity] if mixes is None else RETRIES_OF_MASTERS
    joints: dict[int, Joints] = {}
    for attempt in range(len(tries) + 1):
        poor = fit.bounds > tolerance
        if not poor.any():
            break
        pieces, same = refitted(split, fit.pieces, poor, tries[attempt:], settings, joints)
        fit = _certified(split, pieces, mixes, options, tolerance, fit, same)
    return fit


def _joined(parts: Sequence[Pieces]) -> Pieces:
    """Pieces after each other."""
    where, places, errors = (np.concatenate([own[k] for own in parts]) for k in (0, 3, 5))
    vertices, tangents = (np.concatenate([own[k] for own in parts], axis=1) for k in (2, 4))
    starts = offsets_of(np.maximum(where[:, SPANS], 1) + 1 - where[:, CLOSED])
    return Pieces(where, starts, vertices, places, tangents, errors)


def refitted(
    contours: SplitContours, pieces: Pieces, poor: BoolArray, tries: Sequence[tuple[float, bool]], settings: Settings,
    joints: dict[int, Joints],
) -> tuple[Pieces, IntArray]:  # fmt: skip
    """Pieces with others in the place of poor ones: fitted more closely, or else the source's own segments.

    Args:
        joints: those of contours looked at before; receives others.

    Returns:
        The pieces, and which of the given ones each is; -1 for others.
    """
    parts, same, done = [], [], 0
    for q in [*np.flatnonzero(poor).tolist(), len(poor)]:
        parts.append(part(pieces, done, q))
        same.append(np.arange(done, q))
        if q < len(poor):
            parts.append(_refitted_piece(contours, part(pieces, q, q + 1), tries, settings, joints))
            same.append(np.full(len(parts[-1].where), -1))
        done = q + 1
    return _joined(parts), np.concatenate(same)


def _refitted_piece(
    contours: SplitContours, piece: Pieces, tries: Sequence[tuple[float, bool]], settings: Settings,
    joints: dict[int, Joints],
) -> Pieces:  # fmt: skip
    """What takes the place of a single piece."""
    c = int(piece.where[0, CONTOUR])
    for share, cut in tries:
        near = share * settings.near
        if c not in joints:
            joints[c] = joints_again(contours, c, settings)
        found, stretches = cut_again(contours, piece, joints[c], cut, settings)
        if len(stretches.piece):
            begun = not cut and len(contours.cubics) == 1  # slip may rule out where masters' vertices are now
            lays = 2 if settings.search.lays and share < MOVED else settings.search.lays
            found = fit_splines(found, stretches, near, settings.search._replace(lays=lays), begun)
        if found.errors.max() <= near:
            return choose(contours, found, near)
    return source_pieces(contours, piece)


def _certified(
    split: SplitContours, pieces: Pieces, mixes: FloatArray | None, options: Options, tolerance: float,
    before: SharpFit | None, same: IntArray,
) -> SharpFit:  # fmt: skip
    """The pieces with curves put through them, measured against the source.

    Args:
        before: a fit of which some of the pieces are. same: (P,) which; -1 for the others.
    """
    count, masters = len(split.flipped), len(split.cubics)
    known = {} if before is None else {q: before.splines[n] for q, n in enumerate(same.tolist()) if n in before.splines}
    splines = dict(sorted((known | _interpolated(pieces, same < 0, options)).items()))
    knots = np.concatenate([np.empty(0), *(arc.spline.knots for arc in splines.values())])
    stacked = np.concatenate([np.empty((0, 2 * masters)), *(arc.spline.control_points for arc in splines.values())])
    controls = np.ascontiguousarray(stacked.reshape(-1, masters, 2).swapaxes(0, 1)) * np.sqrt(masters)
    lengths = chords(pieces)
    made = [put_together(of_master(pieces, v), count, knots, controls[v], lengths) for v in range(masters)]
    curves, segments = tuple(each.curves for each in made), made[0].segments
    regular = None
    if mixes is None:
        written = curves[0].rounded(options.precision)
        bounds, gaps = certify(split, pieces, segments, written, SHARPNESS * tolerance, tolerance)
    else:
        cubics = np.stack([all_cubics(curve) for curve in curves])
        bounds, regular = np.full(len(same), np.nan), np.zeros(len(same), dtype=np.bool_)
        if before is not None:
            assert before.regular is not None
            bounds[same >= 0], regular[same >= 0] = before.bounds[same[same >= 0]], before.regular[same[same >= 0]]
        certify_masters(split, pieces, segments, cubics, curves[0].offsets, mixes, tolerance, bounds, regular)
        gaps = np.full(len(bounds), np.nan)
    offsets = np.searchsorted(pieces.where[:, CONTOUR], np.arange(count + 1))
    return SharpFit(pieces, offsets, splines, curves, tuple(each.controls for each in made), bounds, gaps, regular)


def chords(pieces: Pieces) -> FloatArray:
    """(P,) distance of each piece's first two vertices, the root mean square of those in the masters."""
    first = pieces.starts[:-1]
    steps = np.diff(pieces.vertices[:, first[:, None] + [0, 1]], axis=2)[:, :, 0]
    squares: FloatArray = (np.hypot(steps[..., 0], steps[..., 1]) ** 2).mean(axis=0)
    return np.sqrt(squares)


def _interpolated(pieces: Pieces, wanted: BoolArray, options: Options) -> dict[int, Interpolation]:
    """The splines of more than one span among the (P,) pieces wanted. Lemma 2 has an interval at all their vertices.

    K masters are one curve in R^{2K}, whose lengths are root mean squares of those in the masters.
    """
    where, starts, masters = pieces.where, pieces.starts, len(pieces.vertices)
    size = np.sqrt(masters)
    vertices = pieces.vertices.swapaxes(0, 1).reshape(-1, 2 * masters) / size
    tangents = pieces.tangents.transpose(1, 2, 0, 3).reshape(-1, 2, 2 * masters) / size
    spans, closed = where[:, SPANS], where[:, CLOSED] > 0
    arcs: dict[int, Interpolation] = {}
    for which in (closed, (spans > 1) & ~closed):
        chosen = np.flatnonzero(which & wanted).tolist()
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
    return arcs
