"""What a font stores of some glyphs: curves, points, kinks, jumps of curvature, and bytes of its outlines' table."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...checks.kinds import JUMP, KINK, THRESHOLDS
from ...outlines.contour_arrays import ContourArrays, joined
from ...outlines.outline import Outline
from ...readers import Font, Source

BATCH = 500
"""Glyphs read at once."""


class Stored(NamedTuple):
    """The facts of some glyphs; bytes are those of the table, None if there is none."""

    curves: int = 0
    points: int = 0
    kinks: int = 0
    jumps: int = 0
    bytes: int | None = None


def stored_facts(source: Source, gids: Sequence[int]) -> Stored:
    """What a font stores of the glyphs with these indices; glyphs that cannot be read do not count."""
    from ...checks.segments import WHAT, Segments, joint_findings  # imports the compiler
    from ...outlines.segments import all_cubics

    names, curves, points, found = source.glyph_names, 0, 0, np.zeros(2, dtype=np.int64)
    for first in range(0, len(gids), BATCH):
        read = source.outlines([names[gid] for gid in gids[first : first + BATCH]], errors="return")
        arrays = [outline.arrays for outline in read if isinstance(outline, Outline)]
        if not any(each.num_contours for each in arrays):
            continue
        contours = joined(arrays)
        curves += int(np.count_nonzero(contours.degrees > 1))
        points += len(contours.points) - implied(contours)
        segments = Segments.of(all_cubics(contours), contours)
        kinds = joint_findings(segments, THRESHOLDS.limits(source.metrics.units_per_em))[:, WHAT]
        found += [np.count_nonzero(kinds == kind) for kind in (KINK, JUMP)]
    size = None
    if isinstance(source, Font):
        tables = source.tables().reader.tables
        size = next((tables[tag].length for tag in ("glyf", "CFF ", "CFF2") if tag in tables), None)
    return Stored(curves, points, int(found[0]), int(found[1]), size)


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


def compared(before: Stored, after: Stored) -> str:
    """Both in words."""
    pairs = zip(Stored._fields, before, after, strict=True)
    return ", ".join(f"{name} {a:,} → {b:,}" for name, a, b in pairs if a is not None and b is not None)
