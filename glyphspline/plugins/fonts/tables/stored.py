"""What a font stores of some glyphs: curves, points, kinks, jumps of curvature, and bytes of its outlines' table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ....outlines.contour_arrays import ContourArrays, joined
from ....outlines.flaws.kinds import JUMP, KINK, THRESHOLDS
from ....outlines.outline import Outline
from ....readers import Font, Source

BATCH = 500
"""Glyphs read at once."""

COUNTED = replace(THRESHOLDS, rounding=1e-9)
"""What is counted: rounding explains nothing, as a font of decimals has none, and handles are not as long in both."""


class StoredFacts(NamedTuple):
    """The facts of some glyphs, each counted so that those of a font of cubics and of quadratics can be compared.

    Attributes:
        curves, points: segments that bend; points as stored, without those that TrueType implies.
        kinks: joints meant to be smooth that turn, by rounding to whole units too: ``check`` lets pass what that makes
            beside short handles, and is stricter where points have decimals.
        jumps: of curvature where cubics meet, by rounding too; None if there are quadratics, as a chain of these has
            one at each point.
        bytes: of the tables of outlines, uncompressed; None if there are none.
    """

    curves: int = 0
    points: int = 0
    kinks: int = 0
    jumps: int | None = 0
    bytes: int | None = None


def stored_facts(source: Source, gids: Sequence[int]) -> StoredFacts:
    """What a font stores of the glyphs with these indices; glyphs that cannot be read do not count."""
    from ....outlines.flaws.joints import WHAT, Segments, joint_findings  # imports the compiler
    from ....outlines.segments import all_cubics

    names, curves, points, found, quadratic = source.glyph_names, 0, 0, np.zeros(2, dtype=np.int64), False
    limits = COUNTED.limits(source.metrics.units_per_em)
    for first in range(0, len(gids), BATCH):
        read = source.outlines([names[gid] for gid in gids[first : first + BATCH]], errors="return")
        arrays = [outline.arrays for outline in read if isinstance(outline, Outline)]
        if not any(each.num_contours for each in arrays):
            continue
        contours = joined(arrays)
        curves += int(np.count_nonzero(contours.degrees > 1))
        points += len(contours.points) - implied(contours)
        segments = Segments.of(all_cubics(contours), contours)
        kinds = joint_findings(segments, limits)[:, WHAT]
        quadratic = quadratic or bool((contours.degrees == 2).any())
        found += [np.count_nonzero(kinds == kind) for kind in (KINK, JUMP)]
    size = None
    if isinstance(source, Font):
        tables = source.tables().reader.tables
        own = [tables[tag] for tag in ("glyf", "loca", "CFF ", "CFF2") if tag in tables]
        size = sum(getattr(each, "origLength", each.length) for each in own) or None  # in WOFF, length is compressed
    return StoredFacts(curves, points, int(found[0]), None if quadratic else int(found[1]), size)


def implied(contours: ContourArrays) -> int:
    """The number of points between quadratics that TrueType need not store: midway between control points."""
    points, degrees, count = contours.points, contours.degrees, 0
    for c in range(contours.num_contours):
        own, kinds = points[contours.starts[c] : contours.starts[c + 1]], degrees[slice(*contours.offsets[c : c + 2])]
        joints = np.cumsum(kinds) - kinds
        curved = joints[(kinds == 2) & (np.roll(kinds, 1) == 2)]
        middle = (own[curved - 1] + own[(curved + 1) % len(own)]) / 2
        count += int((np.abs(middle - own[curved]) < 1e-3).all(axis=1).sum())
    return count


def compared(before: StoredFacts, after: StoredFacts) -> str:
    """Both in words: what both have, and that there are more points if there are."""
    into_cubics = before.jumps is None and after.jumps is not None
    more = " (more: a cubic has two off the curve, a quadratic one)" if into_cubics else " (more)"
    return ", ".join(
        f"{name} {a:,} → {b:,}{more if name == 'points' and b > a else ''}"
        for name, a, b in zip(StoredFacts._fields, before, after, strict=True)
        if a is not None and b is not None
    )
