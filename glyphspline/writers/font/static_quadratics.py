"""Glyphs as TrueType stores them, of continuity "g2": from outlines of quadratics, or of cubics."""

from __future__ import annotations

import numpy as np

from ...curves.cubics import turns
from ...curves.pairing import SHARPNESS, pair_stretches
from ...fitting.results import GlyphResult
from ...fitting.sharp.font_fit import of_points, quadratic_points
from ...outlines.masters import quadratics
from ...outlines.outline import Contour
from ...types import BoolArray, FloatArray, IntArray
from .font_glyphs import (
    QUADRATIC_SHARE,
    ROUNDING,
    Drawn,
    bounds_of,
    check_size,
    oriented,
    quadratic_glyph,
    simple_glyph,
)
from .implied_quadratics import fit
from .quadratic_contours import cut

SMOOTH = np.radians(12.0)
"""Turn up to which a joint of cubics is inside an arc of quadratics."""

TRIES = (0.85, 0.6, 0.3)
"""Shares of the tolerance for quadratics whose certificate fails at the one before."""


def quadratic_result(result: GlyphResult, tolerance: float) -> Drawn:
    """A glyph as quadratics with as few points as follow it.

    Outlines of lines and quadratics keep what need not change. Arcs of cubics become quadratics with implied points;
    where whole units do not have these near enough, each cubic becomes some by itself.
    """
    outline = result.outline
    found = quadratic_points(outline.arrays, result.options, tolerance, outline.metrics.units_per_em)
    if found is None:
        source = [contour for contour in oriented(outline.contours, "ttf") if len(contour)]
        drawn = [approximated(contour, tolerance) for contour in source]
        if any(far > tolerance for *_, far in drawn):
            step = max(tolerance - ROUNDING, QUADRATIC_SHARE * tolerance)
            data = quadratic_glyph(source, step, outline.name)
            return Drawn(data, bounds_of(data, []), ROUNDING + step + outline.snapped)
        found = [(points, on) for points, on, _ in drawn], max((far for *_, far in drawn), default=0.0)
    contours, distance = found
    points = np.concatenate([np.empty((0, 2)), *(points for points, _ in contours)]).astype(np.int64)
    check_size(points.tolist(), outline.name)
    on = np.concatenate([np.empty(0, dtype=np.bool_), *(on for _, on in contours)])
    data = simple_glyph(points, on, (np.cumsum([len(on) for _, on in contours]) - 1).tolist(), False)
    return Drawn(data, bounds_of(data, []), distance + outline.snapped)


def approximated(contour: Contour, tolerance: float) -> tuple[FloatArray, BoolArray, float]:
    """Points (N, 2) of a contour's quadratics, whether each is on the curve, and a bound of their distance from it.

    They are within the tolerance where whole units have that.
    """
    cubics, line = contour.cubics(), contour.degrees == 1
    inner = (np.abs(turns(cubics, 1e-6)) < SMOOTH) & ~line & ~np.roll(line, 1)
    if inner.all():  # a contour keeps a point on the curve
        inner[int(cubics[:, 0, 1].argmin())] = False
    starts = np.flatnonzero(~inner)
    best: tuple[FloatArray, BoolArray, float] | None = None
    for share in TRIES:
        points, on = arcs_of(cubics, contour.degrees, inner, max(share * tolerance, 0.5 * ROUNDING))
        made = of_points(points, on)
        stored = Contour(made.points, made.degrees).cubics()
        _, _, implied = quadratics(points[None], on)
        # Arcs and lines follow each other in both; each begins where the other does.
        rows = np.column_stack([np.flatnonzero(~implied), starts]).astype(np.float64)
        rows = np.vstack([rows, [len(stored), starts[0] + len(cubics)]])
        bounds, _ = pair_stretches(
            stored, np.array([0, len(stored)]), cubics, np.array([0, len(cubics)]), rows, np.array([0, len(rows)]),
            SHARPNESS * tolerance, tolerance,
        )  # fmt: skip
        if best is None or bounds.max() < best[2]:
            best = points, on, float(bounds.max())
        if best[2] <= tolerance:
            break
    assert best is not None
    return best


def arcs_of(cubics: FloatArray, degrees: IntArray, inner: BoolArray, tolerance: float) -> tuple[FloatArray, BoolArray]:
    """Points of the lines and arcs of a contour, and which are on the curve: the ends of these."""

    def rounded(points: FloatArray, metric: FloatArray | None = None) -> FloatArray:
        return np.asarray(np.rint(points))

    points, on = [np.empty((0, 2))], list[bool]()
    for arc in cut(cubics[None], degrees, inner, rounded):
        points.append(arc.ends[0, :1])
        on.append(True)
        if not arc.straight and (found := fit(arc, np.ones((1, 1)), tolerance, rounded)):
            points.append(found.controls[0])
            on += [False] * found.controls.shape[1]
    return np.concatenate(points), np.array(on)
