"""The sharp mode: contours cut at corners and straight lines, with one spline of variant 2 in between.

:mod:`.cutting` cuts the contours and fits the pieces, :mod:`.assembly` puts them together; this file makes sure that
the result is within the tolerance, and measures it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...curves.bspline import Spline
from ...curves.pairing import SHARPNESS
from ...curves.spline_beziers import spline_beziers
from ...interpolation.result import Interpolation
from ...outlines.contour_arrays import ContourArrays, Polylines, offsets_of
from ...outlines.segments import all_cubics
from ...types import BoolArray, FloatArray, IntArray, Views
from ..faithful import Fits
from ..first_good import first_good
from ..ladders import RETRIES, SHARP_TRIES
from ..measures import distance_columns
from ..options import Options
from ..results import ConvertedContours
from .arcs import Arcs, arc_columns, in_order, interpolated
from .assembly import certify, put_together
from .cutting import Chains, fit_contours, refit
from .pieces import Pieces, chord_lengths
from .settings import EFFORTS, LONG_LINE

SHARES = {"plain": 0.97, "masters": 0.94}
"""Share of the tolerance that the fit of a plain outline, and of masters, may use. The rest is for rounding, and what
its samples miss; the certificate decides."""


def sharp_fits(options: Options, tolerance: float, em: float) -> Fits:
    """Fits within ``tolerance``, and then closer; it and ``em`` are in font units."""

    def fit(contours: ContourArrays, attempt: int) -> ConvertedContours:
        return _converted(contours, options, tolerance, SHARP_TRIES[attempt], em)

    return Fits(len(SHARP_TRIES), fit, keeps_crossing=True)


def _converted(source: ContourArrays, options: Options, tolerance: float, share: float, em: float) -> ConvertedContours:
    """Contours fitted to within a share of the tolerance, and measured."""
    fit = fit_sharp(source, all_cubics(source)[None], None, options, share * tolerance, em)
    pieces, first = fit.pieces, fit.offsets[:-1]
    # Where two pieces meet, the vertex belongs to the second one.
    open_ends = pieces.starts[1:][pieces.closed == 0] - 1
    counts = np.add.reduceat(np.maximum(pieces.spans, 1), first)
    closed = np.ones(source.num_contours, dtype=np.bool_)
    polygons = Polylines(np.delete(pieces.vertices[:, 0], open_ends, axis=0), offsets_of(counts), closed)
    bounds, gaps = np.maximum.reduceat(fit.bounds, first), np.maximum.reduceat(fit.gaps, first)
    drawn = np.flatnonzero(pieces.spans)
    return ConvertedContours(
        source,
        fit.curves[0],
        polygons,
        Views(len(drawn), fit.interpolations),
        fit.controls[0],
        np.searchsorted(drawn, fit.offsets),
        arc_columns(fit.arcs, pieces, source.num_contours)
        | distance_columns(gaps.tolist(), bounds.tolist(), tolerance),
    )


@dataclass(frozen=True, eq=False)
class SharpFit:
    """Contours as lines and arcs.

    Attributes:
        pieces: the lines and arcs of all contours.
        offsets: (C + 1,) where in ``pieces`` each contour begins.
        arcs: those of more than one span.
        curves: the contours they make in each master, before rounding. controls: the control polygons of all arcs.
        bounds: (P,) certified distance of each piece from the source: of a plain outline as it is written, and of
            masters, unrounded, in the whole design space. gaps: (P,) the largest one seen; 0 for masters.
        regular: (P,) whether the curves of masters have speed everywhere, in the whole design space.
    """

    pieces: Pieces
    offsets: IntArray
    arcs: Arcs
    curves: tuple[ContourArrays, ...]
    controls: tuple[Polylines, ...]
    bounds: FloatArray
    gaps: FloatArray
    regular: BoolArray

    @cached_property
    def splines(self) -> dict[int, Interpolation]:
        """The interpolations of arcs of more than one span, by their piece."""
        return dict(zip(self.arcs.piece.tolist(), self.arcs.results, strict=True))

    def interpolations(self) -> list[Interpolation]:
        """All arcs of a single master; one of a single span interpolates its two ends as it is."""
        drawn = np.flatnonzero(self.pieces.spans).tolist()
        first, points = self.controls[0].offsets.tolist(), self.controls[0].points
        return [
            self.splines[q] if q in self.splines else _single_span(points[i : i + 4])
            for q, i in zip(drawn, first[:-1], strict=True)
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
    the source's own segments, each an arc of one span.

    Args:
        source: the contours' degrees and offsets. cubics: (K, m, 4, 2) their segments in each of K masters.
        mixes: (V, K) weights of the masters at the corners of the design space's grid; None for a plain outline.
    """
    kind = "plain" if mixes is None else "masters"
    settings = EFFORTS[options.effort](
        near=SHARES[kind] * tolerance,
        angle=float(np.radians(options.corner_angle)), line=LONG_LINE * em, c2=True, margin=float(options.margin),
        residual=options.solver_tolerance,
    )  # fmt: skip
    shares = RETRIES[kind]

    def fits() -> Iterator[SharpFit]:
        chains, pieces = fit_contours(cubics, source, settings)
        fit, same = None, np.full(len(pieces.spans), -1)
        for attempt in range(len(shares) + 2):
            fit = _certified(chains, pieces, mixes, options, tolerance, fit, same)
            yield fit
            if attempt <= len(shares):
                pieces, same = refit(chains, fit.pieces, fit.bounds > tolerance, np.array(shares[attempt:]), settings)

    return first_good(fits(), lambda fit: (int((fit.bounds > tolerance).sum()),))


def _certified(
    chains: Chains, pieces: Pieces, mixes: FloatArray | None, options: Options, tolerance: float,
    before: SharpFit | None, same: IntArray,
) -> SharpFit:  # fmt: skip
    """The pieces with curves put through them, certified; ``same``: (P,) their numbers in the fit ``before``, or -1."""
    count, masters = len(chains.flipped), len(chains.cubics)
    kept = np.flatnonzero(same >= 0)
    parts = [*interpolated(pieces, same < 0, options)]
    if before is not None:
        now = np.full(len(before.pieces.spans), -1)
        now[same[kept]] = kept
        piece = now[before.arcs.piece]
        parts.append(before.arcs.chosen(np.flatnonzero(piece >= 0), piece[piece >= 0]))
    arcs, several, lengths = in_order(parts, masters), pieces.spans > 1, chords(pieces)
    controls = arcs.controls.reshape(-1, masters, 2) * np.sqrt(masters)
    beziers = spline_beziers(controls, arcs.knots, pieces.spans[several], pieces.closed[several] > 0)
    beziers, controls = (np.ascontiguousarray(each.swapaxes(0, 1)) for each in (beziers, controls))
    made = [put_together(pieces, v, count, beziers[v], controls[v], lengths) for v in range(masters)]
    curves, segments = tuple(each.curves for each in made), made[0].segments
    known = np.full(len(same), np.nan)
    if before is not None:
        known[kept] = before.bounds[same[kept]]
    cubics = np.stack([all_cubics(curve.rounded(options.precision) if mixes is None else curve) for curve in curves])
    bounds, gaps, regular = certify(
        chains, pieces, segments, cubics, curves[0].offsets, mixes, SHARPNESS * tolerance if mixes is None else 0.0,
        tolerance, known,
    )  # fmt: skip
    if before is not None:
        gaps[kept], regular[kept] = before.gaps[same[kept]], before.regular[same[kept]]
    offsets = np.searchsorted(pieces.contour, np.arange(count + 1))
    return SharpFit(pieces, offsets, arcs, curves, tuple(each.controls for each in made), bounds, gaps, regular)


def chords(pieces: Pieces) -> FloatArray:
    """(P,) distance of each piece's first two vertices, see :func:`.pieces.chord_lengths`."""
    first = pieces.starts[:-1]
    return chord_lengths(pieces.vertices[first + 1] - pieces.vertices[first])
