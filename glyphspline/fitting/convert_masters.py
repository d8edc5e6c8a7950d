"""From the masters of a glyph to one curve for all of them: every instance is as smooth as the masters.

The K masters of an arc are one curve in R^{2K}, interpolated there by variant 2 on one knot vector. An instance is a
linear combination of the masters, and so a C2 spline on the same knots. The certificate holds at every location: see
:mod:`.stacked_distance`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..errors import GlyphsplineError, OptionError
from ..outlines.contour_arrays import ContourArrays, offsets_of
from ..outlines.masters import MasterContour, Masters
from ..outlines.outline import Contour, Contours, Outline
from ..types import BoolArray, FloatArray, IntArray, counted, rounded_up
from .options import Options

SHARP = Options(corners="sharp")

NO_HANDLE = 1e-9
"""Handles up to this long, in font units, give no tangent."""


@dataclass(frozen=True, eq=False)
class MastersContourResult:
    """One contour of a glyph in all masters.

    Attributes:
        source: the contour as the font has it. curve: the result, lines and cubics, in the source's direction.
        inner: (m,) whether segment j of the result begins inside an arc: no instance has a kink or a jump of curvature
            there.
        places: (m + 1,) places of the source near which the segments of the result begin, and the first a lap later.
        iterations: of variant 2, the most of all arcs; None if no arc has two spans.
        rate_bound: largest certified factor a step; None likewise.
        deviation_bound: certified bound of the two-sided distance to the source at every location, in font units.
        within_tolerance: whether it is within the tolerance.
        kept: segments that are the source's own, as no curve through all masters was certified there: they meet as the
            source has it.
        regular: whether the curve is proven to have speed everywhere, at every location. It may lack it where the
            source's contour collapses.
    """

    source: MasterContour
    curve: MasterContour
    inner: BoolArray
    places: FloatArray
    iterations: int | None
    rate_bound: float | None
    deviation_bound: float
    within_tolerance: bool
    kept: int
    regular: bool


@dataclass(frozen=True, eq=False)
class MastersResult:
    """A glyph converted in all masters at once.

    Attributes:
        masters: the source. options: how it was converted. contours: results of its contours.
        notes: what a user should know.
    """

    masters: Masters
    options: Options
    contours: tuple[MastersContourResult, ...]
    notes: tuple[str, ...] = ()

    def __repr__(self) -> str:
        segments = sum(len(contour.curve) for contour in self.contours)
        bound = rounded_up(max((contour.deviation_bound for contour in self.contours), default=0.0), 3)
        counts = f"{counted(len(self.masters), 'master')}, {counted(len(self.contours), 'contour')}"
        return f"<MastersResult {self.masters.name!r}: {counts}, {segments} segments, certified within {bound:g} units>"

    def instance(self, location: Mapping[str, float]) -> Outline:
        """The result at a location, axis tag to user-space value: an outline that every function of outlines takes."""
        return self.mixed(self.masters.weights(location))

    def turn(self, location: Mapping[str, float]) -> float:
        """The largest turn at an inner joint of the instance at a location, in degrees: rounding's alone."""
        from ..curves.cubics import turns

        found = 0.0
        for contour, drawn in zip(self.contours, self.instance(location).contours, strict=True):
            own = np.abs(np.degrees(turns(drawn.cubics(), NO_HANDLE)))[contour.inner]
            found = max(found, float(own.max(initial=0.0)))
        return found

    def energy_ratio(self, location: Mapping[str, float]) -> float | None:
        """Bending energy of the result's arcs at a location by that of the source's; None if the source has none.

        A kink has no bending energy, and a curve within the tolerance of it has: where the source kinks, the ratio says
        what smoothness cost.
        """
        weights = self.masters.weights(location)
        ours = sum(_energy(contour.curve.mixed(weights)) for contour in self.contours)
        given = sum(_energy(contour.source.mixed(weights)) for contour in self.contours)
        return ours / given if given > 0 else None

    def mixed(self, weights: FloatArray) -> Outline:
        """The result with (K,) weights of the masters."""
        m = self.masters
        contours = [contour.curve.mixed(weights) for contour in self.contours]
        return Outline(m.name, m.gid, m.unicodes, float(m.advances @ weights), contours, m.metrics, self.notes)


def convert_masters(masters: Masters, options: Options = SHARP) -> MastersResult:
    """Put one curve through all masters of a glyph.

    With ``corners="smooth"`` it is one closed C2 curve a contour; with "sharp" arcs end at corners and lines.

    Args:
        masters: of the glyph; see :meth:`.Source.masters`. options: how; the tolerance holds at every location.

    Raises:
        GlyphsplineError: a contour that cannot be interpolated, or a design space with too many grid corners; it names
            the glyph.
        OptionError: options that are for single outlines.
    """
    from .sharp.pieces import CLOSED, SPANS
    from .sharp.sharp_fit import Source, fit_sharp

    if options.is_fixed or options.continuity != "c2" or options.remove_overlaps:
        raise OptionError('masters are converted by tolerance, with continuity="c2", and keep their overlaps')
    em = masters.metrics.units_per_em
    tolerance = options.tolerance_for(em)
    kept = [c for c, contour in enumerate(masters.contours) if _encloses(contour)]
    notes = [
        f"contour {c} has fewer than three distinct points and is left out"
        for c in range(len(masters.contours))
        if c not in kept
    ]
    if not kept:
        return MastersResult(masters, options, (), tuple(notes))
    sources = [masters.contours[c] for c in kept]
    degrees = np.concatenate([source.degrees for source in sources])
    offsets = offsets_of([len(source) for source in sources])
    starts = offsets_of([source.points.shape[1] for source in sources])
    points = np.concatenate([source.points[0] for source in sources])
    cubics = np.concatenate([source.cubics() for source in sources], axis=1)
    try:
        for k in range(len(masters)):
            _check(sources, kept, k)
        mixes = np.unique(masters.weights_at(masters.grid()).round(12), axis=0)
        source = Source(ContourArrays(points, degrees, offsets, starts), cubics, mixes)
        fit = fit_sharp(source, options, tolerance, em)
    except GlyphsplineError as error:
        raise error.locate(glyph=masters.name) from error.__cause__
    results = []
    for c in range(len(kept)):
        a, b = fit.offsets[c], fit.offsets[c + 1]
        kept_ones = (fit.pieces.where[a:b, SPANS] == 1) & (fit.pieces.errors[a:b] == 0.0)
        arcs = [fit.splines[q] for q in range(a, b) if q in fit.splines]
        bound = float(fit.bounds[a:b].max())
        counts = np.maximum(fit.pieces.where[a:b, SPANS], 1)
        inner = np.ones(int(counts.sum()), dtype=np.bool_)
        if not fit.pieces.where[a, CLOSED]:
            inner[np.cumsum(counts) - counts] = False
        first = fit.pieces.starts[a:b]
        places = np.concatenate([fit.pieces.places[s : s + n] for s, n in zip(first, counts, strict=True)])
        results.append(
            MastersContourResult(
                sources[c],
                MasterContour(np.stack([_part(curve, c)[0] for curve in fit.curves]), _part(fit.curves[0], c)[1]),
                inner,
                np.append(places, places[0] + len(sources[c])),
                max((arc.iterations for arc in arcs), default=None),
                max((arc.rate_bound for arc in arcs), default=None),
                bound,
                bound <= tolerance,
                int(kept_ones.sum()),
                bool(fit.regular[a:b].all()),
            )
        )
        if results[-1].kept:
            notes.append(f"{counted(results[-1].kept, 'segment')} of contour {c} stay as the source has them")
        if not results[-1].within_tolerance:
            notes.append(f"contour {c} is certified to {rounded_up(bound, 3):g} units, not to {tolerance:g}")
    return MastersResult(masters, options, tuple(results), tuple(notes))


def _check(sources: Sequence[MasterContour], numbers: Sequence[int], k: int) -> None:
    """Refuse coordinates of master k that are not finite, or too large."""
    from .measures import check_coordinates

    for c, source in zip(numbers, sources, strict=True):
        try:
            check_coordinates(Contours([Contour(source.points[k], source.degrees)]).arrays)
        except GlyphsplineError as error:
            raise GlyphsplineError(f"master {k}: {error.message}", contour=c) from None


def _energy(contour: Contour) -> float:
    """The bending energy of a contour's curved segments, in 1/unit."""
    from ..curves.integrals import integrals

    return float(integrals(np.ascontiguousarray(contour.cubics()[contour.degrees > 1]))[1])


def _part(contours: ContourArrays, c: int) -> tuple[FloatArray, IntArray]:
    part = contours.part(c, c + 1)
    return part.points, part.degrees


def _encloses(contour: MasterContour) -> bool:
    """Whether three of a contour's points are distinct in some master."""
    return any(len(np.unique(points, axis=0)) >= 3 for points in contour.points)
