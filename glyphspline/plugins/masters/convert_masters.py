"""From the masters of a glyph to one curve for all of them: every instance is as smooth as the masters.

The K masters of an arc are one curve in R^{2K}, interpolated there by variant 2 on one knot vector. An instance is a
linear combination of the masters, and so a C2 spline on the same knots. With ``continuity="g2"`` the masters have the
cubics that fonts store instead, with the same nodes in all (:mod:`.fonts.fit.contours`). The certificate holds at every
location: see :mod:`..curves.pairing`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...errors import GlyphsplineError, OptionError
from ...fitting.convert import enclosing
from ...fitting.ladders import SHARP_TRIES
from ...fitting.options import Options
from ...outlines.contour_arrays import ContourArrays, joined
from ...outlines.masters import MasterContour, Masters
from ...outlines.open_paths import are_open
from ...outlines.outline import Contour, Contours, Outline
from ...readers.source import Source, tags_of
from ...types import BoolArray, FloatArray, IntArray, counted, rounded_up

if TYPE_CHECKING:
    from ...fitting.sharp.sharp_fit import SharpFit
    from ...fitting.topology import Changes
    from ..fonts.fit.fit import FontCurve

DEFAULTS = Options()

NO_HANDLE = 1e-9
"""Handles up to this long, in font units, give no tangent."""


@dataclass(frozen=True, eq=False)
class MastersContourResult:
    """One contour of a glyph in all masters.

    Attributes:
        source: the contour as the font has it. curve: the result, lines and cubics, in the source's direction.
        inner: (m,) whether segment j of the result begins inside an arc: no instance has a kink or a jump of curvature
            there. With "g2" no kink that its source has not.
        iterations: of variant 2, the most of all arcs; None if no arc has two spans, or with "g2".
        rate_bound: largest certified factor a step; None likewise.
        deviation_bound: certified bound of the two-sided distance to the source at every location, in font units.
        within_tolerance: whether it is within the tolerance.
        kept: segments that are the source's own, as no curve through all masters was certified there: they meet as the
            source has it.
        regular: whether the curve is proven to have speed everywhere, at every location. It may lack it where the
            source's contour collapses.
        new_crossings: most crossings, with itself and others, that the source does not have, at a corner of the design
            space's grid; masters are among the corners. None where strands lie on each other in such numbers that they
            are not counted. Between the corners crossings are not looked for.
        collapsed: whether its area has gone, or changed its sign, at a corner.
    """

    source: MasterContour
    curve: MasterContour
    inner: BoolArray
    iterations: int | None
    rate_bound: float | None
    deviation_bound: float
    within_tolerance: bool
    kept: int
    regular: bool
    new_crossings: int | None = None
    collapsed: bool | None = None


@dataclass(frozen=True, eq=False)
class MastersResult:
    """A glyph converted in all masters at once.

    Attributes:
        masters: the source. options: how it was converted. contours: results of its contours.
        notes: what a user should know.
        tally: (3, 2) points, kinks, and kinks between masters, before and after, of what ``glyf`` stores; else None.
    """

    masters: Masters
    options: Options
    contours: tuple[MastersContourResult, ...]
    notes: tuple[str, ...] = ()
    tally: IntArray | None = None

    def __repr__(self) -> str:
        segments = sum(len(contour.curve) for contour in self.contours)
        counts = f"{counted(len(self.masters), 'master')}, {counted(len(self.contours), 'contour')}"
        said = f"<MastersResult {self.masters.name!r}: {counts}, {counted(segments, 'segment')}"
        if not self.contours:
            return f"{said}>"
        bound = rounded_up(max(contour.deviation_bound for contour in self.contours), 3)
        return f"{said}, certified within {bound:g} units>"

    def instance(self, location: Mapping[str, float]) -> Outline:
        """The result at a location, axis tag to user-space value: an outline that every function of outlines takes."""
        return self.mixed(self.masters.weights(location))

    def turn(self, location: Mapping[str, float]) -> float:
        """The largest turn at an inner joint of the instance at a location, in degrees: rounding's alone."""
        from ...curves.cubics import turns

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


Fit = Callable[[Sequence[int], float], "list[MastersContourResult]"]
"""Fits contours of a glyph, by their numbers in its masters, within a share of the tolerance."""


def convert_masters(masters: Masters, options: Options = DEFAULTS, *, fit: Fit | None = None) -> MastersResult:
    """Put one curve through all masters of a glyph.

    Arcs end at corners and lines; with ``corners="smooth"`` it is one closed C2 curve a contour. With
    ``continuity="g2"`` there are no more cubics than the source has, and each master is on the grid of ``precision``.

    Args:
        masters: of the glyph; see :meth:`.Source.masters`. options: how; the tolerance holds at every location.
        fit: what fits contours, in place of cubics.

    Raises:
        GlyphsplineError: a contour that cannot be interpolated, or a design space with too many grid corners; it names
            the glyph.
        OptionError: options that are for single outlines.
    """
    from ...fitting.measures import check_coordinates

    check_options(options)
    options = options.for_em(masters.metrics.units_per_em)
    every = [masters.master(k).arrays for k in range(len(masters))]
    opened = are_open(every[0])
    encloses = np.any([opened, *(enclosing(arrays) for arrays in every)], axis=0)
    left_out = tuple(
        f"contour {c} has fewer than three distinct points and is left out" for c in np.flatnonzero(~encloses).tolist()
    )
    paths = {c: _as_it_is(masters.contours[c]) for c in np.flatnonzero(opened).tolist()}
    left_out += tuple(f"contour {c} is an open path, and stays as it was" for c in paths)
    kept = np.flatnonzero(encloses & ~opened).tolist()
    if not kept:
        return MastersResult(masters, options, tuple(paths.values()), left_out)
    outlines = [arrays.chosen(kept) for arrays in every]
    try:
        for k, arrays in enumerate(outlines):
            try:
                check_coordinates(arrays, options.tolerance_for(masters.metrics.units_per_em))
            except GlyphsplineError as error:
                where = None if error.contour is None else kept[error.contour]
                raise GlyphsplineError(f"master {k}: {error.message}", contour=where) from None
        corners = masters.grid()
        mixes, which = np.unique(masters.weights_at(corners).round(12), axis=0, return_index=True)
        fits = _Fits(masters, kept, outlines, mixes, corners[which], options, fit)
        results, found = fits.faithful()
    except GlyphsplineError as error:
        raise error.locate(glyph=masters.name) from error.__cause__
    every_one = sorted({**dict(zip(kept, results, strict=True)), **paths}.items())
    contours = tuple(result for _, result in every_one)
    return MastersResult(masters, options, contours, (*left_out, *fits.remarks(results, found)))


def _as_it_is(contour: MasterContour) -> MastersContourResult:
    """An open path, which is not fitted."""
    inner = np.zeros(len(contour), dtype=np.bool_)
    return MastersContourResult(contour, contour, inner, None, None, 0.0, True, 0, True)


class _Fits(NamedTuple):
    """Fits of a glyph's contours.

    Attributes:
        numbers: of the contours in the masters. outlines: these contours in each master.
        mixes: (V, K) weights of the masters at corners (V, A) of the design space's grid, normalised.
    """

    masters: Masters
    numbers: Sequence[int]
    outlines: Sequence[ContourArrays]
    mixes: FloatArray
    corners: FloatArray
    options: Options
    fit: Fit | None

    @property
    def tolerance(self) -> float:
        return self.options.tolerance_for(self.masters.metrics.units_per_em)

    def faithful(self) -> tuple[list[MastersContourResult], Changes]:
        """Results of all contours, and what changed at each corner, (2, V, C).

        Contours that cross or collapse at a corner where their source does not are fitted more closely, as those of
        single outlines are.
        """
        from ...fitting.faithful import GlyphTrial, tries
        from ...fitting.first_good import first_good

        def judged(results: Sequence[MastersContourResult]) -> GlyphTrial[MastersContourResult]:
            return GlyphTrial(results, changes_at(self.mixes, results))

        first = judged(self.fitted(range(len(self.numbers)), SHARP_TRIES[0]))
        closer = [partial(self.fitted, share=share) for share in SHARP_TRIES[1:]]
        best = first_good(
            tries(first, closer, judged), lambda trial: trial.wrong(lambda result: not result.within_tolerance)
        )
        new, collapsed = best.found
        most = [None if (own < 0).any() else int(own.max()) for own in new.T]
        measured = [
            replace(result, new_crossings=count, collapsed=lost)
            for result, count, lost in zip(best.results, most, collapsed.any(axis=0).tolist(), strict=True)
        ]
        return measured, best.found

    def fitted(self, which: Sequence[int], share: float) -> list[MastersContourResult]:
        """Contours fitted within a share of the tolerance."""
        from ...outlines.segments import all_cubics

        if self.fit is not None:
            return self.fit([self.numbers[c] for c in which], share)
        chosen = [arrays.chosen(which) for arrays in self.outlines]
        sources = [self.masters.contours[self.numbers[c]] for c in which]
        em = self.masters.metrics.units_per_em
        if self.options.is_for_fonts:
            from ..fonts.fit.fit import fit_for_fonts

            looks = self.masters.weights_at(self.masters.places())
            found = fit_for_fonts(chosen, self.mixes, looks, self.options, self.tolerance, share, em)
            return [self.stored(source, each) for source, each in zip(sources, found, strict=True)]
        cubics, near = np.stack([all_cubics(arrays) for arrays in chosen]), share * self.tolerance
        try:
            if self.options.corners == "smooth":
                from ...fitting.smooth.smooth_fit import fit_smooth_masters

                offsets, first = chosen[0].offsets, share == SHARP_TRIES[0]
                curves = fit_smooth_masters(cubics, offsets, self.mixes, self.options, near, first)
                return [
                    self.result(
                        source, curve, np.ones(len(curve), dtype=bool), bound, len(source), 0, iterations, rate_bound
                    )
                    for source, (curve, bound, iterations, rate_bound) in zip(sources, curves, strict=True)
                ]
            from ...fitting.sharp.sharp_fit import fit_sharp

            fit = fit_sharp(chosen[0], cubics, self.mixes, self.options, near, em)
        except GlyphsplineError as error:
            error.contour = None if error.contour is None else self.numbers[which[error.contour]]
            raise
        in_all = zip(*(Contours(curve) for curve in fit.curves), strict=True)
        return [
            _contour_result(source, k, fit, each, self.tolerance)
            for k, (source, each) in enumerate(zip(sources, in_all, strict=True))
        ]

    def stored(self, source: MasterContour, found: FontCurve) -> MastersContourResult:
        """The result of a contour as fonts store it."""
        precision, degrees = self.options.precision, found.curves[0].degrees
        curve = MasterContour(np.stack([each.rounded(precision).points for each in found.curves]), degrees)
        first = found.anchors[:-1, 1].astype(np.int64) % len(source)
        apart = np.abs(curve.cubics() - source.cubics()[:, first]).max(axis=(0, 2, 3))
        kept = int(((apart < NO_HANDLE) & (degrees > 1)).sum())
        return self.result(source, curve, found.inner, found.bound, int((source.degrees > 1).sum()), kept)

    def result(
        self, source: MasterContour, curve: MasterContour, inner: BoolArray, bound: float, curves: int, kept: int,
        iterations: int | None = None, rate_bound: float | None = None,
    ) -> MastersContourResult:  # fmt: skip
        """A contour with a curve, or as it is where the curve is not within the tolerance.

        Args:
            curves: how many segments of the source count as such that no curve was found for. kept: how many of the
                source's the curve has.
        """
        if not bound <= self.tolerance:
            curve, inner, bound = source, np.zeros(len(source), dtype=bool), 0.0
            kept, iterations, rate_bound = curves, None, None
        regular = is_regular(curve, self.mixes)
        return MastersContourResult(source, curve, inner, iterations, rate_bound, bound, True, kept, regular)

    def remarks(self, results: Sequence[MastersContourResult], found: Changes) -> Iterator[str]:
        """Remarks on contours that are partly the source's, miss the tolerance, or enclose something else."""
        for c, result in enumerate(results):
            if result.kept:
                yield f"{counted(result.kept, 'segment')} of contour {c} stay as the source has them"
            if not result.within_tolerance:
                bound = rounded_up(result.deviation_bound, 3)
                yield f"contour {c} is certified to {bound:g} units, not to {self.tolerance:g}"
            new, lost = found[..., c]
            if (new > 0).any():
                more = f"{new.max()} times more than its source"
                yield f"contour {c} crosses itself or others, {more}, {self.where(np.maximum(new, 0))}"
            elif (new < 0).any():
                yield f"crossings of contour {c} are not counted: too many strands lie on each other"
            if lost.any():
                how = "has lost its area, or runs the other way round than its source,"
                yield f"contour {c} {how} {self.where(lost)}"

    def where(self, values: IntArray) -> str:
        """At how many corners (V,) values are not 0, and one at which they are largest, in user space."""
        count = f"at {np.count_nonzero(values)} of {counted(len(values), 'corner')} of the design space"
        user = self.masters.user(self.corners[int(values.argmax())])
        return f"{count}, as at {','.join(f'{tag}={value:g}' for tag, value in user.items())}" if user else count


def changes_at(mixes: FloatArray, results: Sequence[MastersContourResult]) -> Changes:
    """What a glyph's C contours enclose otherwise than their sources, with each of (V, K) weights: (2, V, C)."""
    from ...fitting.topology import changes

    source, written = (
        joined([Contours([each.mixed(weights) for each in contours]).arrays for weights in mixes])
        for contours in ([result.source for result in results], [result.curve for result in results])
    )
    return changes(source, written, np.arange(len(mixes) + 1) * len(results)).reshape(2, len(mixes), -1)


def check_options(options: Options) -> None:
    """Raise an OptionError if masters cannot be converted with these options."""
    if options.is_fixed or options.remove_overlaps:
        raise OptionError("masters are converted by tolerance, and keep their overlaps")


def _contour_result(
    source: MasterContour, c: int, fit: SharpFit, curves: Sequence[Contour], tolerance: float
) -> MastersContourResult:
    """The result of contour c of a fit: its curve, a contour for each master, and what its pieces have measured."""
    own = slice(fit.offsets[c], fit.offsets[c + 1])
    spans = fit.pieces.spans[own]
    segments = np.maximum(spans, 1)
    inner = np.ones(int(segments.sum()), dtype=np.bool_)
    if not fit.pieces.closed[own.start]:  # every piece begins at the end of another
        inner[np.cumsum(segments) - segments] = False
    arcs = [fit.splines[q] for q in range(own.start, own.stop) if q in fit.splines]
    bound = float(fit.bounds[own].max())
    return MastersContourResult(
        source,
        MasterContour(np.stack([curve.points for curve in curves]), curves[0].degrees),
        inner,
        iterations=max((arc.iterations for arc in arcs), default=None),
        rate_bound=max((arc.rate_bound for arc in arcs), default=None),
        deviation_bound=bound,
        within_tolerance=bound <= tolerance,
        kept=int(((spans == 1) & (fit.pieces.errors[own] == 0.0)).sum()),
        regular=bool(fit.regular[own].all()),
    )


def is_regular(curve: MasterContour, mixes: FloatArray) -> bool:
    """Whether a contour is proven to have speed everywhere between corners of the design space, (V, K) weights."""
    from ...curves.slip import regular

    return bool(regular(np.einsum("vk,kmpc->mvpc", mixes, curve.cubics())).all())


def _energy(contour: Contour) -> float:
    """The bending energy of a contour's curved segments, in 1/unit."""
    from ...curves.integrals import integrals

    return float(integrals(np.ascontiguousarray(contour.cubics()[contour.degrees > 1]))[1])


def check_axis(source: Source, axis: str, options: Options) -> None:
    """Raise if a font has no such axis, or cannot be converted in all masters with these options.

    Raises:
        GlyphsplineError: the font is not variable, or has no such axis. OptionError: of options.
    """
    tags_of(source, axis)
    check_options(options)
