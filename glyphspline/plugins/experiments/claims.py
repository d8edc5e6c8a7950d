"""What the paper says of its variants, and what the contours of these fonts say."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from . import VARIANTS
from .report import Tally

LARGE = 40
"""Vertices above which the paper's variant 0 hardly ever converges."""

HARDLY, ALIKE, BEYOND = 0.05, 0.1, 1.2
"""Share that is hardly any; relative difference of curvature maps that are close; ratio from which more is seen."""

Found = tuple[str, bool]
"""What was measured, in words, and whether that agrees."""


class Claim(NamedTuple):
    """A claim of the paper: where, in words; the variants that decide it; how."""

    source: str
    words: str
    variants: tuple[int, ...]
    found: Callable[[Tally], Found | None]


def verdicts(tally: Tally) -> list[tuple[str, str, str, str]]:
    """Of each claim that can be decided: source, claim, what was measured, and "reproduced" or "differs"."""
    rows = []
    for claim in CLAIMS:
        if all(VARIANTS[v] in tally.columns for v in claim.variants) and (found := claim.found(tally)):
            rows.append((claim.source, claim.words, found[0], "reproduced" if found[1] else "differs"))
    return rows


def _converge(tally: Tally) -> Found:
    own = {m: tally.of(m, "converged") for m in VARIANTS[1:] if m in tally.columns}
    words = ", ".join(f"{m}: {int(c.sum())} of {len(c)}" for m, c in own.items())
    return words, all(c.all() for c in own.values())


def _variant_0(tally: Tally) -> Found | None:
    large = tally.of(VARIANTS[0], "vertices") > LARGE
    if not large.any():
        return None
    share = float(tally.of(VARIANTS[0], "converged")[large].mean())
    return f"{share:.0%} of {int(large.sum())} contours of more than {LARGE} vertices, in 100 steps", share <= HARDLY


def _means(tally: Tally, *variants: int) -> list[float]:
    return [float(tally.of(VARIANTS[v], "iterations").mean()) for v in variants]


def _most_steps(tally: Tally) -> Found:
    others = [v for v in (1, 2, 4) if VARIANTS[v] in tally.columns]
    means = _means(tally, 3, *others)
    words = ", ".join(f"variant {v}: {mean:.3g}" for v, mean in zip((3, *others), means, strict=True))
    return f"mean iterations, {words}", means[0] > max(means[1:])


def _ahead(tally: Tally) -> Found:
    one, two = _means(tally, 1, 2)
    return f"mean iterations, variant 1: {one:.4g}, variant 2: {two:.4g}", one < two


def _intervals(tally: Tally) -> Found:
    missing, vertices = (int(tally.of(VARIANTS[2], name).sum()) for name in ("fallbacks", "vertices"))
    return f"{missing} of {vertices} vertices without an interval", missing <= HARDLY * vertices


def _maps(tally: Tally) -> Found | None:
    one, two, three = (tally.of(VARIANTS[v], "curvature_variation") for v in (1, 2, 3))
    known = two > 0
    if not known.any():
        return None
    ratios = [float(np.nanmedian(own[known] / two[known])) for own in (one, three)]
    words = f"∫(dκ/ds)² ds over that of variant 2, in the median: variant 1 {ratios[0]:.3g}, variant 3 {ratios[1]:.3g}"
    return words, abs(ratios[0] - 1) < ALIKE and ratios[1] > 1


def _overshoots(tally: Tally) -> Found:
    most = [float(np.nanmax(tally.of(VARIANTS[v], "bulge"))) for v in (1, 2, 3)]
    words = ", ".join(f"variant {v}: {far:.3g}" for v, far in zip((1, 2, 3), most, strict=True))
    return f"largest bulge in 1/1000 em, {words}", most[2] > BEYOND * max(most[:2])


CLAIMS = (
    Claim("Section 4.1", "Variants 1 to 4 converge on all polygons.", (), _converge),
    Claim("Fig. 2", "Variant 0 converges on almost no polygon of more than 40 vertices.", (0,), _variant_0),
    Claim("Fig. 3", "Variant 3 needs the most iterations.", (2, 3), _most_steps),
    Claim("Section 4.2", "Variant 1 is slightly ahead of variant 2.", (1, 2), _ahead),
    Claim("Section 4.4", "Vertices without an interval are extreme cases.", (2,), _intervals),
    Claim("Figs. 6 and 7", "Curvature maps of variants 1 and 2 are close, variant 3's the worst.", (1, 2, 3), _maps),
    Claim("Figs. 8 and 9", "Variant 3 overshoots at some corners; variants 1 and 2 do not.", (1, 2, 3), _overshoots),
)
