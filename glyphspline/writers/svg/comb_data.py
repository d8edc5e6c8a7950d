"""Curvature combs as path data: those of many glyphs in one call, from the Béziers of all."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import isnan
from typing import NamedTuple

import numpy as np

from ...fitting.results import GlyphResult, joined_results
from ...outlines.open_paths import are_open, paths
from ..settings import Combs, Whose
from .comb import TOOTH, corners_left_out, shown_by
from .path_data import Box, comb_precision

STROKE = 3
"""Width of a map's outline in 1/1000 em. It would hide teeth of less than half of it, so these are left out."""


class GlyphComb(NamedTuple):
    """The comb of a glyph in a map.

    Attributes:
        paths: path data of the teeth by colour class, of the line through the tips, and of the marks of cut teeth; none
            where there are no teeth.
        box: around feet and tips, in font units; None where there are none.
        cut: the number of teeth that are cut. corners: that of corners in whose turn teeth are left out.
    """

    paths: list[str]
    box: Box | None
    cut: int
    corners: int


def combs_data(
    results: Sequence[GlyphResult], combs: Combs, scale: float, *, in_corners: bool = False
) -> list[dict[Whose, GlyphComb]]:
    """The combs that maps of glyphs of one em show.

    Args:
        combs, in_corners: see :func:`.curvature_map.to_curvature_svg`. scale: the curvature of a full tooth, in 1/unit.
    """
    wanted: tuple[Whose, ...] = ("result", "source") if combs == "both" else (shown_by(combs),)
    every = [_of_batch(results, whose, scale, in_corners) for whose in wanted]
    return [dict(zip(wanted, own, strict=True)) for own in zip(*every, strict=True)]


def _of_batch(results: Sequence[GlyphResult], whose: Whose, scale: float, in_corners: bool) -> list[GlyphComb]:
    from .path_text import combs_text  # here and not above: the package opens without a compiler

    em = float(results[0].outline.metrics.units_per_em)
    precision, least = comb_precision(em), 0.5 * STROKE / 1000 / TOOTH
    arrays, glyphs = joined_results(results)
    curves = arrays.curves if whose == "result" else arrays.source
    opened, corners = are_open(curves), corners_left_out(arrays.source, results[0].options, whose, in_corners)
    text, ends, boxes, cut = combs_text(
        paths(curves, opened), curves, opened, glyphs, corners, (em, float(scale), least), precision
    )
    drawn, numbers = text.tobytes().decode("ascii"), np.diff(corners[1][glyphs]).tolist()
    found = []
    for own, box, *counts in zip(ends.tolist(), (boxes / 10.0**precision).tolist(), cut.tolist(), numbers, strict=True):
        some = not isnan(box[0])
        texts = [drawn[a:b] for a, b in pairwise(own)] if some else []
        found.append(GlyphComb(texts, tuple(box) if some else None, *(counts if some else (0, 0))))
    return found
